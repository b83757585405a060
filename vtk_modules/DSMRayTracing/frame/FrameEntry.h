// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_FrameEntry_h
#define rt_FrameEntry_h

#include "DSMCore/store/BlockStore.h"
#include "DSMRayTracing/frame/Frame.h"
#include "DSMRayTracing/frame/FrameRequest.h"
#include "DSMRayTracing/scene/Scene.h"
#include "DSMRayTracing/schedule/TileScheduler.h"

#include <cstdint>
#include <vector>

namespace rt
{

/// State of a rank before a frame, sent to all ranks. Plain, for messages.
struct FrameEntry
{
  /// Everything that must be equal on all ranks for a frame to make sense.
  struct Digest
  {
    std::uint64_t Scene; ///< with the camera
    std::int64_t FirstSample;
    std::int64_t Samples;
    std::int64_t Scheduling;
  };

  Digest Request;
  std::uint64_t Settled;    ///< 1 if the rank's store is settled
  std::uint64_t MayBegin;   ///< 1 if its store may begin the frame without asking others
  std::uint64_t LastNumber; ///< number of the last frame, if it had the same tiles; else 0
  std::uint64_t LastTiles;  ///< that the rank traced of it
  double LastBusySeconds;

  /// Local. `last`: the view's last frame; may be null.
  static FrameEntry Create(
    dsm::BlockStore& store, const Scene& scene, const FrameRequest& request, const Frame* last);

  /// Throws dsm::Error, on every rank alike, when the ranks were asked for different frames, or for an
  /// impossible one. `entries`: of all ranks, in rank order.
  static void Check(const std::vector<FrameEntry>& entries, const FrameRequest& request);

  /// The error for a rank whose frame is another than rank 0's.
  [[noreturn]] static void Refuse(std::size_t rank);

  /// Creates the plan from the ranks' common knowledge of the last frame, and the tiles of it that
  /// this rank traced. Empty without `last`.
  static TilePlan CreatePlan(
    const std::vector<FrameEntry>& entries, const FrameRequest& request, const Frame* last);
};

} // namespace rt

#endif
