// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_BlockReader_h
#define dsm_BlockReader_h

#include "DSMCore/base/Block.h"

#include <cstddef>
#include <vector>

namespace dsm
{

/// Makes blocks out of what is on a disk. Any thread, several at a time.
class BlockReader
{
public:
  virtual ~BlockReader() = default;

  /// Fills `block` (its `bytes` are those of the directory; aligned for any number) with what the block
  /// is, always the same. May take long. Throws Error, which names the file and the place in it.
  virtual void Read(BlockId id, std::byte* block, std::size_t bytes) const = 0;
  /// The same if it takes no longer than a copy, because the block was read ahead. Otherwise returns false,
  /// and has no effect.
  virtual bool TryRead(BlockId, std::byte*, std::size_t) const { return false; }
  /// The same if all required data are in memory, including the system's cache: the block may have to be
  /// unpacked, but the call does not wait. Otherwise, and if reading fails, returns false; then `block` is
  /// undefined.
  virtual bool ReadWithoutWaiting(BlockId id, std::byte* block, std::size_t bytes) const
  {
    return this->TryRead(id, block, bytes);
  }
  /// Returns whether ReadWithoutWaiting is likely to succeed if Prefetch was called some time
  /// before.
  virtual bool MayPrefetch() const { return false; }
  /// These blocks will probably be read soon: the system may bring what they take to its own cache, in one piece
  /// where they lie near one another. Does not wait for it. Throws nothing.
  virtual void Prefetch(const std::vector<BlockId>&) const {}
  /// A block that was read by the reader before this one is still in use, and need not be read again: it is
  /// what this one would read, too.
  virtual void NoteKept(BlockId, std::size_t /*bytes*/) const {}
};

} // namespace dsm

#endif
