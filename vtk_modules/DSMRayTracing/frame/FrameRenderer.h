// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_FrameRenderer_h
#define rt_FrameRenderer_h

#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/store/BlockStore.h"
#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/frame/Frame.h"
#include "DSMRayTracing/frame/FrameEntry.h"
#include "DSMRayTracing/frame/FrameRequest.h"
#include "DSMRayTracing/frame/KeptHits.h"
#include "DSMRayTracing/frame/LightFilter.h"
#include "DSMRayTracing/frame/WorkerPool.h"
#include "DSMRayTracing/scene/FieldReader.h"
#include "DSMRayTracing/scene/Scene.h"
#include "DSMRayTracing/schedule/CentralQueueScheduler.h"
#include "DSMRayTracing/schedule/WorkStealingScheduler.h"

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace rt
{

class TileSource;

/// Traces frames: the workers trace tiles while the calling thread, which alone may call MPI, carries their
/// requests for bricks and tiles and serves the other ranks (the paper's communication thread, section 3). After
/// its last tile a rank continues to serve until all have finished.
class FrameRenderer
{
public:
  explicit FrameRenderer(dsm::Messenger& messenger);
  ~FrameRenderer();

  /// The ranks exchange two records for a frame: their entries before it, and its results after it. Callers may add
  /// their own data to these.
  struct Records
  {
    /// Entries of all ranks, in rank order, if they have been exchanged already: FrameEntry::Create
    /// for the frame's content, or for the part of it that is not agreed otherwise. Empty: the
    /// renderer gathers them.
    std::vector<FrameEntry> Entries;
    /// Local: called when this rank has traced its part of the frame, before the ranks agree on how it went. Its
    /// result comes to all ranks (Frame::Reports); its exception is the frame's failure. It is not always called if
    /// the frame fails; if it is aborted, it is called when all have ended.
    dsm::FunctionRef<std::vector<std::byte>(const Frame&)> Report;
  };

  /// Collective; always from the same thread. Every rank passes the same request and scene. Settles
  /// the store first.
  /// `store.GetSettings().Workers` threads trace at a time. Returns the tiles that this rank traced. Throws
  /// the same dsm::Error on every rank when any rank fails, or when the requests differ; the next
  /// frame is not affected.
  /// `last`: the view's last frame, if there is one; with work stealing, a rank begins with the tiles
  /// that it traced then; it also tells which bricks the tiles will probably need.
  /// A frame that was aborted (SetWatch) has the tiles that were traced until then.
  Frame Render(dsm::BlockStore& store, const Scene& scene, const FrameRequest& request,
    const Frame* last = nullptr, const Records& records = {});

  /// Goes on with a frame whose Render, or Resume, was aborted, with the same request and scene: traces the tiles that
  /// are left. Otherwise as Render; a failure leaves the frame without tiles.
  void Resume(dsm::BlockStore& store, const Scene& scene, const FrameRequest& request, Frame& frame,
    const Frame* last = nullptr, const Records& records = {});

  /// Adds the request's samples to a frame that has all samples before them: each rank continues with the tiles
  /// that it has, and their channels. Collective; as Render, but that a failure leaves the frame without tiles. A
  /// frame that was aborted while it got samples has to get the same ones again, before others: then only tiles
  /// that lack them are traced.
  void Refine(dsm::BlockStore& store, const Scene& scene, const FrameRequest& request, Frame& frame,
    const Records& records = {});

  /// Collective, between frames; settles the store first. Calls `read` on one thread of this rank, while all ranks
  /// serve one another. If it throws on any rank, every rank throws the same dsm::Error, whose text begins with
  /// `what`.
  void Read(const char* what, dsm::BlockStore& store, dsm::FunctionRef<void(FieldReader&)> read);

  /// Sets a function that rank 0's calling thread calls repeatedly during a frame. `part`: the approximate
  /// part of the frame that is traced, 0 to 1, estimated from rank 0's own tiles. The function returns
  /// whether to abort the frame. The ranks then finish their current tiles, and every rank's frame is marked
  /// as aborted: Resume or Refine continue it.
  void SetWatch(std::function<bool(double part)> watch) { this->Watch = std::move(watch); }

  /// Collective, between frames. Returns the frame with filtered light: see LightFilter::Apply.
  Frame FilterLight(
    const dsm::BlockStore& store, const glm::dmat4& worldToClip, const Frame& frame);

private:
  void RenderLeft(dsm::BlockStore& store, const Scene& scene, const FrameRequest& request,
    std::vector<int> left, const Frame* last, const Records& records, Frame& frame);
  void RenderTiles(dsm::BlockStore& store, const Scene& scene, const FrameRequest& request,
    const Frame* last, const Records& records, TileSource& tiles, Frame& frame);

  dsm::Messenger& Messenger;
  CentralQueueScheduler Queue;
  WorkStealingScheduler Stealing;
  WorkerPool Pool;
  LightFilter Filter;
  KeptHits Hits; ///< of any pictures
  std::function<bool(double)> Watch;
};

} // namespace rt

#endif
