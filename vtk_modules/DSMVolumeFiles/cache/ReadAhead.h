// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ReadAhead_h
#define vol_ReadAhead_h

#include "DSMCore/base/Block.h"
#include "DSMCore/fetch/BlockReader.h"
#include "DSMVolumeFiles/cache/ChunkCache.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

namespace vol
{

/// Reads bricks of the time step that will probably be shown next, one after the other, on one of the
/// process's ReaderThreads, while no other reads are pending, and keeps them until they are taken. They count
/// as part of a chunk cache, and take at most half of its room; the system is advised of further bricks.
/// Unreadable bricks are skipped, because their reader will report the error. Any thread.
class ReadAhead
{
  struct Shared;

public:
  /// How to come by the bricks of a step.
  struct Way
  {
    std::shared_ptr<const dsm::BlockReader> Reader;
    /// Returns whether a brick is equal to that of the previous step, so that it will not be taken. Called by one
    /// thread at a time. May be empty: then no brick is known to be equal.
    std::function<bool(dsm::BlockId)> IsSame;
  };

  /// Bricks of one step of one array, cut by one lattice.
  class Step
  {
  public:
    Step(ChunkCache& cache, Way way);
    ~Step();
    Step(const Step&) = delete;
    Step& operator=(const Step&) = delete;

    /// Gives the bytes of a brick away, if they are here.
    bool Take(dsm::BlockId id, std::byte* block, std::size_t bytes);

  private:
    friend struct ReadAhead::Shared;
    struct Contents;

    std::unique_ptr<Contents> Self;
  };

  /// With the cache that all files of the process share.
  static ReadAhead& GetShared();

  /// The cache must outlive the read that is under way, and the steps.
  explicit ReadAhead(ChunkCache& cache);

  /// Returns the bricks read ahead for the step with this `key`; null if there are none.
  std::shared_ptr<Step> Find(std::uint64_t key) const;
  /// The same, ready to take in more. Throws std::bad_alloc, as Add does.
  std::shared_ptr<Step> Open(std::uint64_t key, Way way);
  /// A brick of a step will probably be wanted; not one that was added before.
  void Add(const std::shared_ptr<Step>& step, dsm::BlockId id, std::size_t bytes);
  /// Drops steps without users: call it when possible users have had time to take over.
  void Tidy();

  /// As long as there is one, and for a moment afterwards, no read begins: a frame is being made.
  class Pause
  {
  public:
    explicit Pause(ReadAhead& ahead);
    ~Pause();
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;

  private:
    ReadAhead& Ahead;
  };

private:
  /// State that pending reads share.
  std::shared_ptr<Shared> State;
};

} // namespace vol

#endif
