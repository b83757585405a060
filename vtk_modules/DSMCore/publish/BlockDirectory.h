// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_BlockDirectory_h
#define dsm_BlockDirectory_h

#include "DSMCore/base/BlockAssigner.h"

#include <cstdint>
#include <vector>

namespace dsm
{

/// Size in bytes and owner of every block of a segment, and whether the owner has them in memory for
/// good; the same on every rank.
class BlockDirectory
{
public:
  /// `indexBytes`: bytes of the publisher's own index of the blocks, on every rank.
  BlockDirectory(
    std::vector<std::uint32_t> bytes, BlockAssigner assigner, std::uint64_t indexBytes = 0);

  BlockId GetCount() const { return this->Bytes.size(); }
  std::uint32_t GetBytes(BlockId id) const { return this->Bytes[id]; }
  int GetOwner(BlockId id) const { return this->Assigner.GetOwner(id); }

  /// The blocks leave memory, since a source can bring them again (BlockSource).
  void SetFromSource() { this->FromSource = true; }
  bool IsFromSource() const { return this->FromSource; }
  /// That source is a disk of the owner's, which no other rank can read.
  void SetOnOwnersDisk() { this->FromSource = this->OnOwnersDisk = true; }
  bool IsOnOwnersDisk() const { return this->OnOwnersDisk; }
  /// A worker reads each of its blocks together with one of another segment, as the values of cells with their
  /// topology: AcquirePair of the stores.
  void SetPaired() { this->Paired = true; }
  bool IsPaired() const { return this->Paired; }
  /// The largest block; 0 when there is none.
  std::uint32_t GetLargest() const { return this->Largest; }
  /// Returns the bytes that stay in the owner's memory permanently: the sum over its blocks, each
  /// rounded up to a multiple of `unit`.
  std::uint64_t GetResidentBytes(int owner, std::size_t unit = BlockAlignment) const;
  std::uint64_t GetTotalBytes() const;
  /// Adds to the bytes that the publisher keeps on every rank.
  void AddIndexBytes(std::uint64_t bytes) { this->IndexBytes += bytes; }
  /// Its blocks are read through a cache that all such sources share: BlockStore::Settings::SourceCacheBytes.
  void SetReadThroughCache() { this->ReadThroughCache = true; }
  bool IsReadThroughCache() const { return this->ReadThroughCache; }
  /// Level of detail of the blocks' data, which a debug view shows; 0 is the finest.
  void SetLevel(int level) { this->Level = level; }
  int GetLevel() const { return this->Level; }
  /// Returns the bytes of the directory and of the publishers' indices, on every rank.
  std::uint64_t GetOwnBytes() const
  {
    return this->GetCount() * sizeof(std::uint32_t) + this->IndexBytes;
  }
  /// Equal directories have equal ones.
  std::uint64_t GetFingerprint() const;

private:
  std::vector<std::uint32_t> Bytes;
  std::uint32_t Largest; ///< largest block, in bytes: needed for every brick that is prefetched
  BlockAssigner Assigner;
  std::uint64_t IndexBytes = 0;
  int Level = 0;
  bool FromSource = false;
  bool ReadThroughCache = false;
  bool OnOwnersDisk = false;
  bool Paired = false;
};

} // namespace dsm

#endif
