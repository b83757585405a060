// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_FetchingStore_h
#define dsm_FetchingStore_h

#include "DSMCore/base/Counters.h"
#include "DSMCore/fetch/FetchWorkers.h"
#include "DSMCore/publish/BlockSegment.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace dsm
{

class BlockFetcher;

/// Base of the stores that fetch blocks (ObjectStore, PagedStore): the course of a frame.
class FetchingStore
{
public:
  FetchingStore(const FetchingStore&) = delete;
  FetchingStore& operator=(const FetchingStore&) = delete;

  /// Collective, between frames, after SegmentUpdate has changed the blocks of a segment for which `changed`
  /// is true: drops this rank's cached copies; they are fetched again on demand. Throws the same Error on
  /// every rank.
  void Refresh(
    std::string_view what, const BlockSegment& segment, const std::vector<bool>& changed);

  /// Local, between frames: whether BeginFrame will do without an agreement of the ranks when this
  /// holds on all of them.
  bool MayBeginFrame() const;

  /// Collective. Resets the counters of the frame; from now on workers may Acquire, and this rank
  /// serves others. Throws Error, on every rank alike, when a rank's cache cannot hold its largest
  /// block. `agreed`: the ranks have told one another that MayBeginFrame; no message is sent.
  void BeginFrame(bool agreed = false);
  /// Communication thread, often: sends what the workers miss, hands arrived blocks to them,
  /// reclaims memory. Returns whether it did anything. (Serving others happens in
  /// Messenger::Progress, through handlers.)
  bool Service();
  /// Communication thread: from now on every Acquire that would wait throws Error(cause).
  void Cancel(const std::string& cause);
  /// Communication thread, often after this rank's workers have stopped: gives up blocks that Prefetch queued and
  /// that were not requested yet. Returns whether all others have come. Only then may the rank report that it is
  /// done, since no answer may be under way to a rank that has left the frame. True after Cancel, behind which all
  /// ranks wait for one another anyway.
  bool Drain();
  /// Communication thread, after all ranks' workers have stopped.
  void EndFrame();

  /// Communication thread: whether Prefetch does anything, with the settings and what is published.
  bool MayPrefetch() const;
  /// The worker: how often it has waited for a block in this frame.
  std::uint64_t GetMisses(const FetchWorker& worker) const;
  /// Returns the counters of the frame so far; after EndFrame, those of the last frame.
  /// Communication thread.
  StoreCounters GetCounters() const;
  /// Returns the bytes of blocks received from this owner, in the same frame.
  std::uint64_t GetBytesFrom(int owner) const;
  /// Per worker of the last frame.
  std::vector<WorkerCounters> GetWorkerCounters() const;

protected:
  FetchingStore() = default;
  ~FetchingStore() = default;

  BlockFetcher* Fetcher = nullptr; ///< the store's own; set once
};

} // namespace dsm

#endif
