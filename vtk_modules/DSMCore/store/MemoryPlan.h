// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_MemoryPlan_h
#define dsm_MemoryPlan_h

#include "DSMCore/publish/BlockDirectory.h"
#include "DSMCore/publish/HostGroups.h"
#include "DSMCore/store/MemoryOrganization.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace dsm
{

/// Decides, from numbers that all ranks have, how the published data are kept within the memory that
/// each rank may take. Pure, so every rank comes to the same result.
class MemoryPlan
{
public:
  /// Memory limits of one rank.
  struct Budget
  {
    /// Requested limit, or the default.
    std::uint64_t Bytes = 0;
    /// Limit that applies if the resident set needs more than Bytes; equal to Bytes if that was
    /// requested.
    std::uint64_t Limit = 0;
  };

  /// Beyond this many ranks none is recommended.
  static constexpr int MostRanks = 1 << 20;

  /// `segments`: of all that is published, what comes next included. `budgets`: by rank.
  /// `page`: blocks take multiples of it in the page based organization. `sourceCache`: bytes, counted once where
  /// any segment is read through it.
  MemoryPlan(std::vector<const BlockDirectory*> segments, const HostGroups& groups,
    std::vector<Budget> budgets, std::size_t page, std::uint64_t sourceCache = 0);

  /// `wanted`, or what Automatic comes to. Where sources bring blocks, what would be replicated is object
  /// based, too. Throws MemoryShortage when a rank's memory does not suffice, with
  /// the number needed and, of the organizations that share the data out, the number of ranks that
  /// would do.
  MemoryOrganization Decide(MemoryOrganization wanted) const;

  /// A sentence: what was chosen, and why.
  std::string Explain(MemoryOrganization wanted, MemoryOrganization chosen) const;

  /// Returns whether lack of memory keeps the blocks from being replicated: some are in scratch
  /// files, or Automatic has not replicated them.
  bool LacksMemory(MemoryOrganization wanted, MemoryOrganization chosen) const
  {
    return this->AnyOnOwnersDisk ||
      (!this->AnyFromSource && wanted == MemoryOrganization::Automatic &&
        chosen != MemoryOrganization::Replicated);
  }

  /// Returns the bytes that a rank needs: its resident set (or all blocks, if replicated) and the
  /// tables. If blocks are fetched, also a cache of one block, a reply with one block, and one
  /// block that has just arrived. If sources bring blocks, also one of the rank's own.
  std::uint64_t GetNeed(MemoryOrganization organization, int rank) const;

  /// Memory of a rank that remains after its own blocks and the tables.
  struct Room
  {
    std::uint64_t CacheBytes = 0;
    /// For replies that have not left yet.
    std::uint64_t ReplyBytes = 0;
  };
  Room GetRoom(MemoryOrganization organization, int rank) const;

  /// The least number of ranks whose need the smallest budget meets, or 0 when there is none.
  int FindRankCount(MemoryOrganization organization) const;

private:
  /// Returns the number of blocks that there must be room for where they are fetched: in the cache, in a reply to
  /// another rank, and in a message that has come and is being put into the cache; one more in the cache if workers
  /// read pairs, and one of the rank's own if sources bring blocks. Without other ranks: in the cache only.
  std::uint64_t GetLeastBlocks(bool isAlone) const
  {
    const std::uint64_t cached = this->AnyPaired ? 2 : 1;
    return isAlone ? cached : cached + 2 + (this->AnyFromSource ? 1 : 0);
  }

  /// Sizes of the blocks in memory, in units of BlockAlignment or of pages.
  struct Sums
  {
    explicit Sums(std::size_t unit)
      : Unit(unit)
    {
    }
    std::uint64_t GetFootprint(std::uint64_t bytes) const
    {
      return (bytes + this->Unit - 1) / this->Unit * this->Unit;
    }
    std::size_t Unit;
    std::uint64_t Largest = 0;
    std::uint64_t Total = 0;
    std::uint64_t Tables = 0;            ///< on every rank, to find them
    std::vector<std::uint64_t> Resident; ///< by rank
  };

  const Sums& GetSums(MemoryOrganization organization) const
  {
    return organization == MemoryOrganization::PageBased ? this->Pages : this->Blocks;
  }
  void Count(Sums& sums) const;
  void CountCopies(const HostGroups& groups);
  /// In bytes.
  std::uint64_t GetLeastRoom(const Sums& sums) const;
  /// Returns whether any block may have to be fetched from another rank.
  bool Fetches(MemoryOrganization organization) const;
  /// The rank that lacks most; -1 when all have enough.
  int FindPoorest(MemoryOrganization organization) const;
  [[noreturn]] void Refuse(MemoryOrganization organization, int rank) const;

  std::vector<const BlockDirectory*> Segments;
  std::vector<Budget> Budgets;
  bool OneGroup;
  bool AnyFromSource;
  bool AnyOnOwnersDisk;
  bool AnyPaired;
  std::size_t LargestGroup = 0; ///< the most ranks that share a host's memory
  Sums Blocks;
  Sums Pages;
  std::vector<std::uint64_t> Copies; ///< by rank: of blocks of others, when replicated
};

} // namespace dsm

#endif
