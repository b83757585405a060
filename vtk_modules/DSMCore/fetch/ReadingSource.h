// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_ReadingSource_h
#define dsm_ReadingSource_h

#include "DSMCore/fetch/BlockReader.h"
#include "DSMCore/fetch/BlockSource.h"
#include "DSMCore/transport/Messenger.h"

#include <chrono>
#include <cstddef>
#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace dsm
{

/// Brings a rank's own blocks by a BlockReader, on the process's ReaderThreads. The thread that reads a block
/// allocates its memory, which is handed on when it is complete. So the program never waits for an abandoned read,
/// however long the disk takes. Blocks that the reader can give without waiting need no thread. If a block was not
/// read for PartOfSilence of the time that ranks may be silent (Messenger::SetSilenceLimit), the frame fails,
/// before the ranks that wait for the block treat its owner as failed.
class ReadingSource final : public BlockSource
{
public:
  /// The messenger must outlive the source, or the last frame that reads from it. `name`: what is read, for
  /// errors ("the file '...'").
  ReadingSource(Messenger& messenger, std::shared_ptr<const BlockReader> reader, std::string name);
  ~ReadingSource() override;

  void Begin(const BlockWant& block) override;
  bool Submit() override;
  bool Poll(const Deliver& deliver) override;
  void Abandon() noexcept override;
  bool ReadWithoutWaiting(BlockId id, std::byte* block, std::size_t bytes) const override;
  bool MayPrefetch() const override { return this->Reader->MayPrefetch(); }
  void Prefetch(std::vector<BlockId> ids) override;
  void NoteKept(const BlockWant& block) override;
  void Read(BlockId id, std::byte* block, std::size_t bytes) const override;

  /// Between frames: replaces the contents, for blocks of the same sizes, and their name in errors. The
  /// caller has to drop copies of the old blocks (BlockStore::Refresh).
  void SetReader(std::shared_ptr<const BlockReader> reader, std::string name)
  {
    this->Reader = std::move(reader);
    this->Name = std::move(name);
  }

  /// Reads that are with the threads, or have come back and were not delivered: what they take of the
  /// memory, and of the communication thread's time at once, is bounded.
  static constexpr std::size_t MostReads = 16;

  static constexpr double PartOfSilence = 0.75;

private:
  struct Shared;
  struct Wanted
  {
    BlockWant Block;
    double Since; ///< as of Seconds
  };
  struct Ready
  {
    BlockWant Block;
    BlockMemory Memory;
  };

  void HandOver();
  bool TryRead(const BlockWant& block);
  /// Throws when the one that is wanted for the longest time is so for too long.
  void CheckDisk();

  std::shared_ptr<const BlockReader> Reader;
  std::string Name;
  std::shared_ptr<Shared> State;
  std::deque<Wanted> Waiting;  ///< not with the threads yet
  std::vector<Wanted> Reading; ///< with the threads, or done and not delivered; in order
  std::vector<Ready> AtHand;   ///< that needed no thread, and are not delivered
  BlockMemory Spare;           ///< for the next one of these, of so many bytes
  std::size_t SpareBytes = 0;
  double Seconds =
    0.0; ///< in which this process polled, or might have: not those when it was stopped
  std::chrono::steady_clock::time_point LastPoll;
};

} // namespace dsm

#endif
