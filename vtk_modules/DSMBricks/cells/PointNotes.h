// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_PointNotes_h
#define bricks_PointNotes_h

#include "DSMCore/memory/BlockArena.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <thread>

namespace bricks
{

/// Notes on points, for threads that go through chunks of cells twice (ForEachShownCell). The first time they note a
/// number of 32 bits for each corner, and which chunks have it. The second time they add to what belongs to the
/// points: without a lock where one chunk alone has the point, as most points are where cells beside one another
/// follow one another. Takes 8 bytes a point.
class PointNotes
{
public:
  /// Throws std::bad_alloc.
  explicit PointNotes(std::size_t points)
    : Count(points)
    , Memory(points * sizeof(Note))
    , Notes(reinterpret_cast<Note*>(this->Memory.GetData()))
  {
  }

  std::size_t GetCount() const { return this->Count; }

  /// Notes that a chunk has a point, and makes its number, 0 at first, what raise(number) returns. The order of calls
  /// must not matter. Any thread.
  template <class Raise>
  void Add(std::uint64_t point, std::size_t chunk, const Raise& raise)
  {
    Note& note = this->Notes[point];
    std::uint64_t known = note.load(std::memory_order_relaxed);
    const std::uint64_t mine = ToOwner(chunk);
    while (true)
    {
      const std::uint64_t owner = known & OwnerBits;
      const std::uint64_t joined = owner == 0 || owner == mine ? mine : OwnerBits;
      const std::uint64_t raised = joined | raise(static_cast<std::uint32_t>(known));
      if (raised == known || note.compare_exchange_weak(known, raised, std::memory_order_relaxed))
      {
        return;
      }
    }
  }

  std::uint32_t Get(std::uint64_t point) const
  {
    return static_cast<std::uint32_t>(this->Notes[point].load(std::memory_order_relaxed));
  }
  /// One thread alone.
  void Set(std::uint64_t point, std::uint32_t number)
  {
    Note& note = this->Notes[point];
    note.store(
      (note.load(std::memory_order_relaxed) & OwnerBits) | number, std::memory_order_relaxed);
  }

  /// Runs step(number), which does not throw and takes nanoseconds, while no other thread runs one for the same point.
  /// Add was called for the chunk and the point. Any thread.
  template <class Step>
  void Run(std::uint64_t point, std::size_t chunk, const Step& step)
  {
    Note& note = this->Notes[point];
    std::uint64_t known = note.load(std::memory_order_relaxed);
    if ((known & OwnerBits) == ToOwner(chunk))
    {
      step(static_cast<std::uint32_t>(known));
      return;
    }
    for (known = note.fetch_or(LockBit, std::memory_order_acquire); (known & LockBit) != 0;
         known = note.fetch_or(LockBit, std::memory_order_acquire))
    {
      std::this_thread::yield();
    }
    step(static_cast<std::uint32_t>(known));
    note.store(known, std::memory_order_release);
  }

private:
  using Note = std::atomic<std::uint64_t>;
  static constexpr std::uint64_t LockBit = std::uint64_t(1) << 63;
  /// All of them: several chunks. None: no chunk.
  static constexpr std::uint64_t OwnerBits = LockBit - (std::uint64_t(1) << 32);

  static std::uint64_t ToOwner(std::size_t chunk) { return std::uint64_t(chunk + 1) << 32; }

  std::size_t Count;
  dsm::BlockArena Memory; ///< in large pages, since points are met in any order
  Note* Notes;            ///< all are 0 at first
};

} // namespace bricks

#endif
