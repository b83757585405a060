// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_Counters_h
#define dsm_Counters_h

#include <algorithm>
#include <cstdint>

namespace dsm
{

/// Store activity of one worker during one frame. Plain numbers: only that worker writes them.
struct WorkerCounters
{
  std::uint64_t Accesses = 0;
  std::uint64_t Hits = 0;
  std::uint64_t Misses = 0;
  /// Misses that joined a request which was already under way; counted among Misses.
  std::uint64_t Joins = 0;
  std::uint64_t WaitNanoseconds = 0;

  WorkerCounters& operator+=(const WorkerCounters& other)
  {
    this->Accesses += other.Accesses;
    this->Hits += other.Hits;
    this->Misses += other.Misses;
    this->Joins += other.Joins;
    this->WaitNanoseconds += other.WaitNanoseconds;
    return *this;
  }
};

/// Activity of one rank's store during one frame, and the memory that it holds.
struct StoreCounters
{
  WorkerCounters Workers; ///< sum over the rank's workers
  std::uint64_t Evictions = 0;
  /// Blocks that were asked for before anybody needed them; those that came to be needed before they
  /// were evicted and the frame was over, which is known at its end.
  std::uint64_t Prefetches = 0;
  std::uint64_t PrefetchesUsed = 0;
  std::uint64_t Requests = 0; ///< messages that asked other ranks for blocks, one or several
  std::uint64_t BytesReceived = 0;
  std::uint64_t BytesSent = 0;
  std::uint64_t ResidentBytes = 0; ///< blocks this rank owns
  /// Blocks of other ranks of the host that are read in place; they take no memory of this rank.
  std::uint64_t SharedBytes = 0;
  /// Copies for good of other ranks' blocks, in this rank's memory (ReplicatedStore).
  std::uint64_t ReplicaBytes = 0;
  /// Memory on this rank for finding blocks: tables, directories, and the publishers' indices.
  std::uint64_t TableBytes = 0;
  /// Memory that remote blocks take now: those held, those evicted whose memory is not free yet, and
  /// the room set aside for those requested. Never more than CacheCapacity.
  std::uint64_t CachedBytes = 0;
  std::uint64_t PeakCachedBytes = 0; ///< the most during the frame
  std::uint64_t CacheCapacity = 0;
  /// Memory limit of the rank for all of these (see BlockStore); 0 if none was set.
  std::uint64_t MemoryBudget = 0;
  /// How often something was cut into bricks, since the ranks came together.
  std::uint64_t Publications = 0;
  /// Bytes that this rank has put into blocks that it owns while they were published, since the ranks came
  /// together.
  std::uint64_t BytesPublished = 0;

  /// Adds the activity of an earlier part of the frame.
  void AddActivity(const StoreCounters& earlier)
  {
    this->Workers += earlier.Workers;
    this->Evictions += earlier.Evictions;
    this->Prefetches += earlier.Prefetches;
    this->PrefetchesUsed += earlier.PrefetchesUsed;
    this->Requests += earlier.Requests;
    this->BytesReceived += earlier.BytesReceived;
    this->BytesSent += earlier.BytesSent;
    this->PeakCachedBytes = std::max(this->PeakCachedBytes, earlier.PeakCachedBytes);
  }
};

} // namespace dsm

#endif
