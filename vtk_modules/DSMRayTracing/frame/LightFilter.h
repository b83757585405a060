// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LightFilter_h
#define rt_LightFilter_h

#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/frame/Frame.h"
#include "DSMRayTracing/frame/LightKernel.h"
#include "DSMRayTracing/frame/WorkerPool.h"
#include "DSMRayTracing/scene/Scene.h"

#include <glm/mat4x4.hpp>

#include <cstdint>

namespace rt
{

/// Takes the noise of soft shadows and ambient occlusion out of a picture of few samples. It filters the part of a
/// pixel's light that arrives: the color over that without shadows and occlusion. Hard shadows have no noise, and count
/// as colors. So edges, colors and shading stay as they are. Passes over pixels farther and farther apart (Dammertz et
/// al., Edge-Avoiding A-Trous Wavelet Transform, 2010) take those which are alike in normal, plane and light. The
/// light's variance says how much it may differ (Schied et al., Spatiotemporal Variance-Guided Filtering, 2017). Light
/// of media is not filtered.
class LightFilter
{
public:
  /// Returns whether the light of a scene has noise that can be filtered.
  static bool IsNoisy(const Scene& scene);

  /// Channels that FrameRequest must ask for.
  static constexpr std::uint32_t Channels = ChannelSet::Light;

  /// Keeps references. Its memory, at most about 85 MiB for a picture that is 1920 pixels wide, stays for the next
  /// picture.
  LightFilter(dsm::Messenger& messenger, WorkerPool& pool)
    : Messenger(messenger)
    , Pool(pool)
  {
  }

  /// Collective; communication thread, between frames. `frame`: this rank's tiles of a frame of one layer, with these
  /// channels; tiles may be left. `worldToClip`: as in its request. Returns colors and depths of some rows, the
  /// filtered ones, as tiles: together, the ranks have the picture, the same bits on any number of them. `workers`
  /// threads work at a time. Throws dsm::Error on every rank.
  Frame Apply(int workers, const glm::dmat4& worldToClip, const Frame& frame);

private:
  dsm::Messenger& Messenger;
  WorkerPool& Pool;
  LightPlanes Planes;
};

} // namespace rt

#endif
