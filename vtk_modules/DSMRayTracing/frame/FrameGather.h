// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_FrameGather_h
#define rt_FrameGather_h

#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/frame/Frame.h"

#include <cstdint>
#include <vector>

namespace rt
{

/// A whole frame; layers as in Tile.
struct Picture : Channels
{
  int Width = 0;
  int Height = 0;
  int Layers = 1; ///< as many as show anything, and one at least

  /// Nothing is shown in it.
  static Picture Create(int width, int height, int layers = 1, ChannelSet channels = {});
};

/// Local: this rank's tiles; the rest is transparent and infinitely far away.
Picture AssembleTiles(const Frame& frame);

/// Collective: every rank gets the whole picture out of the ranks' tiles. Throws dsm::Error, on
/// every rank, when tiles are missing (other than Frame::Left) or stand twice.
Picture GatherFrame(dsm::Messenger& messenger, const Frame& frame);

/// Collective: adds to AssembleTiles the pixels of the other ranks' tiles that their first layer covers in part. Throws
/// dsm::Error on every rank.
void AddEdges(dsm::Messenger& messenger, const Frame& frame, Picture& picture);

} // namespace rt

#endif
