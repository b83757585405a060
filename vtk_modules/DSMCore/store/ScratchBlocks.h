// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_ScratchBlocks_h
#define dsm_ScratchBlocks_h

#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/fetch/BlockReader.h"
#include "DSMCore/memory/ScratchFile.h"
#include "DSMCore/publish/BlockDirectory.h"
#include "DSMCore/publish/Publication.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace dsm
{

/// The blocks that a rank owns, in a scratch file: first put together out of fragments, which come in any
/// order, with a few blocks in memory at a time; then read, any number of times, each compared with the
/// checksum of what was written.
class ScratchBlocks final : public BlockReader
{
public:
  /// In memory while they are put together.
  static constexpr std::size_t MostInMemory = 16;

  /// For the blocks of `rank` among `ranks`, to which they are dealt in turn.
  ScratchBlocks(const BlockDirectory& directory, int rank, int ranks);

  /// Returns the bytes of the tables, without blocks, on the rank that needs most.
  static std::uint64_t CountTableBytes(const BlockDirectory& directory, int ranks);

  // -- While they are put together, on the communication thread, in this order; all throw Error --

  /// Makes the file.
  void Open(const std::string& directory);
  void Absorb(BlockId id, const std::byte* fragment, std::size_t bytes, FragmentSink& sink);
  /// Completes every block. `progress` may be empty.
  void Finish(FragmentSink& sink, FunctionRef<void(double)> progress);

  // -- Later --

  void Read(BlockId id, std::byte* block, std::size_t bytes) const override;
  bool ReadWithoutWaiting(BlockId id, std::byte* block, std::size_t bytes) const override;
  bool MayPrefetch() const override { return this->CanTell; }
  void Prefetch(const std::vector<BlockId>& ids) const override;

private:
  struct Entry
  {
    std::uint64_t Offset = 0;
    std::uint64_t Checksum = 0;
    std::uint32_t Bytes = 0;
    bool Begun = false; ///< something of it is in the file, or in memory
  };
  struct Slot
  {
    BlockId Id = 0;
    std::uint64_t LastUse = 0; ///< 0: free
    std::vector<std::byte> Bytes;
  };

  Entry& GetEntry(BlockId id) { return this->Entries[id / this->Ranks]; }
  /// Brings a block to memory, in place of the one that was used the longest ago.
  std::byte* Load(BlockId id, FragmentSink& sink);
  void Write(const Slot& slot);

  BlockId Rank;
  BlockId Ranks;
  std::vector<Entry> Entries; ///< this rank's blocks, in ascending order
  std::uint64_t FileBytes = 0;
  std::unique_ptr<ScratchFile> File;
  std::vector<Slot> Slots;
  std::uint64_t Uses = 0;
  mutable std::atomic<bool> CanTell{ true }; ///< the file system, what is in memory
};

} // namespace dsm

#endif
