// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Resolution_h
#define rt_Resolution_h

#include "DSMRayTracing/frame/FrameRequest.h"
#include "DSMRayTracing/scene/Scene.h"

#include <cstdint>
#include <vector>

namespace rt
{

/// How coarse pictures are that must be there soon: while the camera moves, and at rest first after a change. At edge
/// e, one pixel is traced for a square of e x e pixels, which it fills. Local, but all ranks choose the same, because
/// they use only numbers that they have agreed on.
struct Resolution
{
  static constexpr int CoarsestEdge = 16;
  static constexpr double MediumErrors = 16.0; ///< LightTransport, of all such pictures

  /// The picture that a view has shown last, and what it shows next. Plain, for messages.
  struct Shown
  {
    std::uint64_t Content = 0; ///< GetContent; 0: nothing
    std::int64_t Edge = 1;
    double SecondsPerPixel = 0.0; ///< for each pixel that was traced; 0: unknown
    bool MayDraft = true; ///< false: the next picture is a step of an animation, which has no draft
    std::uint64_t Begun = 0; ///< GetContent of a picture that was aborted; 0: none
    std::int64_t BegunEdge = 1;
  };

  struct Try
  {
    int Edge;
    double Seconds; ///< after which it is abandoned; infinite: never
  };

  /// Returns a number that pictures share that show the same at any edge, even if the camera only passed there.
  /// `request`: of edge 1.
  static std::uint64_t GetContent(Scene& scene, const FrameRequest& request);

  /// Returns the edge for a camera that moves. `request`: of edge 1; `least`: the smallest edge that is allowed.
  static int GetMovingEdge(const FrameRequest& request, double secondsPerPixel, int least);

  /// Returns the pictures to try for a view at rest, up to the first that is not abandoned. One of an edge larger than
  /// 1 is a draft, which a finer one is to replace. `request`: of edge 1.
  static std::vector<Try> GetTries(
    const Shown& shown, std::uint64_t content, const FrameRequest& request);

  /// Returns the request of that edge for one of edge 1.
  static FrameRequest Reduce(const FrameRequest& request, int edge);
};

} // namespace rt

#endif
