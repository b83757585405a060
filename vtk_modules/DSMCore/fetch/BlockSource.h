// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_BlockSource_h
#define dsm_BlockSource_h

#include "DSMCore/base/Block.h"
#include "DSMCore/base/Error.h"
#include "DSMCore/memory/BlockMemory.h"
#include "DSMCore/publish/BlockSegment.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace dsm
{

/// A block that a store wants from its source.
struct BlockWant
{
  const BlockSegment* From;
  BlockId Id;

  friend bool operator==(const BlockWant& a, const BlockWant& b)
  {
    return a.From == b.From && a.Id == b.Id;
  }
};

/// Source of blocks that are not in this rank's memory: other ranks (BlockRequests), or a reader
/// that can bring a rank's own blocks again after they have left memory. No function waits: reads
/// begin, and are polled. An exception becomes the frame's error on all ranks.
///
/// Within frames, on the communication thread. A source may have threads of its own, which call
/// Messenger::WakeUp when there is something to Poll; they touch nothing of the store.
class BlockSource
{
public:
  /// Called for a block when its bytes are complete, with the memory that they are in: the store's from
  /// then on.
  using Deliver = std::function<void(const BlockWant& block, BlockMemory memory)>;

  virtual ~BlockSource() = default;

  /// A block is to be read, to memory of the source's own. Not one that is under way. When it throws, the
  /// read has not begun.
  virtual void Begin(const BlockWant& block) = 0;
  /// No more reads are to begin right now: the source may put those begun so far on their way together.
  /// Returns whether there were any.
  virtual bool Submit() = 0;
  /// Delivers what has come, in any order; does not wait. Returns whether anything has. Throws what
  /// makes a read fail.
  virtual bool Poll(const Deliver& deliver) = 0;
  /// Gives up all that is under way: when it returns, nothing of it will be delivered.
  virtual void Abandon() noexcept = 0;

  /// Any thread, for itself: reads a block of any rank, if the call does not have to wait. Otherwise, and if
  /// it fails, returns false: the regular read that follows reports the error.
  virtual bool ReadWithoutWaiting(BlockId, std::byte* /*block*/, std::size_t /*bytes*/) const
  {
    return false;
  }

  /// Returns whether that is likely to succeed if Prefetch was called some time before. Any thread.
  virtual bool MayPrefetch() const { return false; }
  /// Any thread: these blocks will probably be read; the system may bring what they take to its own cache
  /// meanwhile. Does not wait for it. May throw.
  virtual void Prefetch(std::vector<BlockId>) {}

  /// Between frames: other contents are to be brought from now on, but this block, which is in use, has not
  /// changed, and will not be asked for.
  virtual void NoteKept(const BlockWant&) {}

  /// Reads one block right now; between frames, any thread. Throws Error; always, where the blocks come
  /// from other ranks.
  virtual void Read(BlockId, std::byte*, std::size_t) const
  {
    throw Error("Blocks that are available only during frames were read outside a frame. This is a "
                "bug in the program.");
  }
  /// The blocks of one owner, in ascending order of id, one at a time.
  void ForEach(const BlockDirectory& directory, int owner, const BlockSegment::Visit& visit) const
  {
    std::vector<std::byte> block;
    for (BlockId id = 0; id < directory.GetCount(); ++id)
    {
      if (directory.GetOwner(id) == owner)
      {
        block.resize(directory.GetBytes(id));
        this->Read(id, block.data(), block.size());
        visit(id, block.data(), block.size());
      }
    }
  }
};

} // namespace dsm

#endif
