// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Frame_h
#define rt_Frame_h

#include "DSMCore/base/Counters.h"
#include "DSMCore/store/MemoryOrganization.h"
#include "DSMRayTracing/base/PixelVector.h"
#include "DSMRayTracing/frame/Channels.h"
#include "DSMRayTracing/look/PackedNormal.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace rt
{

class BeamHistory;

/// The pixels of one finished tile; where surfaces are kept apart, the nearest is in the first layer. Colors of layers
/// are what each contributes to the pixel through those before it: their sum is the pixel.
struct Tile : Channels
{
  int X = 0; ///< lower left pixel in the frame
  int Y = 0;
  int Width = 0;
  int Height = 0;
  int Index = 0; ///< row-major number of the tile in the frame
  int Layers = 1;
  int Samples = 0;          ///< that Sum has at most
  bool IsNew = false;       ///< another rank traced it in the last frame
  std::uint64_t Misses = 0; ///< that its tracing waited for
  double Seconds = 0.0;     ///< processor time of tracing it, in seconds
  /// Shadow and occlusion rays that were traced for it.
  std::uint64_t LightRays = 0;
  /// Premultiplied colors, summed over the samples so far, in order: what further samples are
  /// added to.
  PixelVector<glm::vec4> Sum;
  /// The same of channels on request, which are there only if they were asked for.
  std::vector<glm::vec4> AlbedoSum;
  std::vector<glm::vec3> NormalSum;
  /// For LightFilter, if they were asked for (ChannelSet::Light): colors as in Sum, of light rays that nothing stops;
  /// the squares of the parts of them that arrive; the normals that sample 0 meets.
  PixelVector<glm::vec3> OpenSum;
  PixelVector<float> ArrivingSquares;
  PixelVector<PackedNormal> Normals;
  /// If a tolerance was asked for (FrameRequest::Tolerance): the samples of each pixel, fewer than Samples where they
  /// are enough, and the sums of the squares of their colors. Else empty.
  PixelVector<std::uint32_t> Counts;
  PixelVector<float> Squares;

  int CountSamples(std::size_t pixel) const
  {
    return this->Counts.empty() ? this->Samples : static_cast<int>(this->Counts[pixel]);
  }
};

/// Part of a frame on this rank: the tiles that it traced. Together the ranks have all tiles.
struct Frame
{
  int Width = 0;
  int Height = 0;
  int TileSize = 0;
  ChannelSet Channels; ///< channels of the tiles
  std::vector<Tile> Tiles;
  /// Number of the frame in its group of ranks: the same on every rank. 0: there is no frame.
  std::uint32_t Number = 0;
  bool IsAborted = false; ///< on every rank; tiles, or samples of tiles, are missing
  /// Numbers of the tiles that no rank has, ascending: of a first sample that was aborted. The same on every rank.
  std::vector<int> Left;
  double BusySeconds = 0.0; ///< from the start to the end of this rank's last tile
  /// Seconds from the collective start to the collective end. If adding samples was aborted and resumed, the
  /// sum over all parts.
  double Seconds = 0.0;
  /// How the bricks were kept; never Automatic.
  dsm::MemoryOrganization Organization = dsm::MemoryOrganization::ObjectBased;
  std::string Explanation; ///< a sentence: why they are kept so
  dsm::StoreCounters Counters;
  std::vector<dsm::WorkerCounters> WorkerCounters;
  /// Beams by which the next frame of the view prefetches bricks; null if blocks are not fetched.
  std::shared_ptr<const BeamHistory> Beams;
  /// Reports of all ranks, in rank order; see FrameRenderer::Records. An aborted frame has them, too.
  std::vector<std::vector<std::byte>> Reports;
  /// Time in which threads had nothing to trace before this rank's last tile was done, summed over the threads.
  std::uint64_t IdleNanoseconds = 0;
};

} // namespace rt

#endif
