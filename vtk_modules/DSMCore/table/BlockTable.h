// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_BlockTable_h
#define dsm_BlockTable_h

#include "DSMCore/base/Block.h"
#include "DSMCore/fetch/BlockSource.h"
#include "DSMCore/memory/HostSharedMemory.h"
#include "DSMCore/publish/BlockDirectory.h"
#include "DSMCore/publish/BlockSegment.h"
#include "DSMCore/publish/HostGroups.h"
#include "DSMCore/table/BlockLine.h"
#include "DSMCore/transport/Messenger.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

namespace dsm
{

/// A segment as the object based and the replicated store have it: a table of entries, the memory of
/// the blocks that this rank owns, and views of what the ranks of its group have (HostGroups). While
/// it is replicated, also copies of what other groups own, each once a group. It passes from one
/// store to the other as it is (see BlockStore). Communication thread.
class BlockTable final : public BlockSegment
{
public:
  /// Sets out zeroed memory for the blocks of `rank`. Throws std::bad_alloc.
  BlockTable(std::uint32_t number, BlockDirectory directory, int rank, HostGroups groups);

  /// As above, but `source` brings the blocks of `rank` on demand; no memory is shared.
  BlockTable(std::uint32_t number, BlockDirectory directory, int rank, int ranks,
    std::shared_ptr<BlockSource> source);

  void ForEachResident(const Visit& visit) const override;
  std::uint64_t GetResidentBytes() const override { return this->ResidentBytes; }

  std::byte* GetOwned(BlockId id) const override;
  /// Maps the group's memory. Blocks that cannot be mapped stay absent.
  void Meet(Messenger& messenger) override;
  void Seal() override;
  void Open() override;
  /// Between frames, of blocks that a source brings; the same on every rank: whether each rank has its own
  /// source read what it needs. Else the owner reads a block, once for all.
  void SetReadByAll(bool all) { this->ReadByAll = all; }
  /// Returns the address of a block on this host; null if it is absent.
  const std::byte* Find(BlockId id) const
  {
    return this->Lines[id].Address.load(std::memory_order_acquire);
  }
  /// Returns whether any of these blocks is absent; ids out of range are ignored. Any thread. Takes
  /// no lock, because usually all blocks are present.
  bool IsAnyAbsent(const BlockId* ids, std::size_t count) const
  {
    return std::any_of(ids, ids + count,
      [this](BlockId id)
      {
        return id < this->GetDirectory().GetCount() &&
          !this->Lines[id].Address.load(std::memory_order_relaxed);
      });
  }

  /// Returns the bytes of other ranks' memory in the group that is mapped here: blocks that they
  /// own, and copies.
  std::uint64_t GetSharedBytes() const { return this->SharedBytes + this->SharedCopyBytes; }

  /// Returns whether all blocks are on this host, so that none must be fetched.
  bool IsWhole() const { return this->Missing == 0; }

  /// Returns the bytes that the tables for finding the blocks take on every rank.
  static std::uint64_t CountTableBytes(const BlockDirectory& directory)
  {
    return directory.GetCount() * sizeof(BlockLine) + directory.GetOwnBytes();
  }
  /// Returns the bytes that replication takes on `rank`, beyond the blocks that it owns.
  static std::uint64_t CountReplicaBytes(
    const BlockDirectory& directory, const HostGroups& groups, int rank);
  /// Collective, when the blocks are complete and nothing is cached: from now on every block is
  /// here. Throws the same Error, which begins with `what`, on every rank; then nothing has changed.
  void Replicate(Messenger& messenger, std::string_view what);
  /// Collective, while it is replicated: copies these blocks again. Throws the same Error on every rank; then
  /// only some of the copies are new.
  void UpdateReplicas(
    Messenger& messenger, std::string_view what, const std::vector<bool>& changed) const;
  /// Local: releases the copies.
  void DropReplicas();
  bool IsReplicated() const { return this->Replicated; }
  /// Copies in this rank's memory.
  std::uint64_t GetReplicaBytes() const { return this->ReplicaBytes; }

private:
  friend class ObjectStore;
  friend class ReplicatedStore;

  void Place(BlockId id, LineState state, const std::byte* address);
  /// Collective: maps what the group's other ranks have as `own`. Needs no memory.
  void OpenAll(Messenger& messenger, const HostSharedMemory& own,
    std::vector<HostSharedMemory::View>& views) const;
  /// Throws Error when a view is missing.
  void CheckViews() const;

  std::unique_ptr<BlockLine[]> Lines;
  HostGroups Groups;
  int Rank = 0;
  std::shared_ptr<BlockSource> Source; ///< null: own blocks stay
  bool ReadByAll = false;
  HostSharedMemory Resident;
  std::vector<HostSharedMemory::View> Views; ///< by rank
  HostSharedMemory Copies;
  std::vector<HostSharedMemory::View> CopyViews; ///< by rank
  std::uint64_t ResidentBytes = 0;
  std::uint64_t SharedBytes = 0;
  std::uint64_t SharedCopyBytes = 0;
  std::uint64_t ReplicaBytes = 0;
  BlockId Missing = 0; ///< blocks that are neither owned, shared nor copied
  bool Replicated = false;
};

} // namespace dsm

#endif
