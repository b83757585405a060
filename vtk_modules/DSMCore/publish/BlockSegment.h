// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_BlockSegment_h
#define dsm_BlockSegment_h

#include "DSMCore/base/Block.h"
#include "DSMCore/publish/BlockDirectory.h"

#include <cstdint>
#include <functional>
#include <utility>

namespace dsm
{

class Messenger;

/// Blocks that were published together: their directory and this rank's share of them. Each store
/// derives its own, with what it needs to find a block. Immutable after Seal, but for SegmentUpdate.
/// Communication thread.
class BlockSegment
{
public:
  BlockSegment(std::uint32_t number, BlockDirectory directory)
    : Number(number)
    , Directory(std::move(directory))
  {
  }
  virtual ~BlockSegment() = default;
  BlockSegment(const BlockSegment&) = delete;
  BlockSegment& operator=(const BlockSegment&) = delete;

  /// Names the segment in messages; the same on every rank.
  std::uint32_t GetNumber() const { return this->Number; }
  /// Grows when blocks get other contents; the same on every rank.
  std::uint32_t GetVersion() const { return this->Version; }
  void CountUpdate() { ++this->Version; }
  const BlockDirectory& GetDirectory() const { return this->Directory; }

  /// Visits the blocks that this rank owns, in ascending order of id. Blocks that are not permanently in
  /// memory are read for it one by one, which may take long, and may throw.
  using Visit = std::function<void(BlockId, const std::byte*, std::size_t)>;
  virtual void ForEachResident(const Visit& visit) const = 0;
  virtual std::uint64_t GetResidentBytes() const = 0;

  // -- For the publisher (SegmentPublisher) --

  /// Returns the address of a block that this rank owns. The block is zero until it is filled.
  virtual std::byte* GetOwned(BlockId id) const = 0;
  /// Collective, when all ranks have set out their memory: they may look at one another's. If a rank lacks memory
  /// for that, Seal throws.
  virtual void Meet(Messenger&) {}
  /// Local, when all blocks that this rank owns are complete. May throw.
  virtual void Seal() = 0;
  /// Local, when all ranks have sealed.
  virtual void Open() {}
  /// Local: until Reseal, the blocks that this rank owns may be written. May throw.
  virtual void Unseal() {}
  virtual void Reseal() {}

private:
  std::uint32_t Number;
  std::uint32_t Version = 0;
  BlockDirectory Directory;
};

} // namespace dsm

#endif
