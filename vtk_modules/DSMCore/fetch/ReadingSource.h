// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_ReadingSource_h
#define dsm_ReadingSource_h

#include "DSMCore/fetch/BlockReader.h"
#include "DSMCore/fetch/BlockSource.h"
#include "DSMCore/transport/Messenger.h"

#include <cstddef>
#include <deque>
#include <memory>

namespace dsm
{

/// Brings a rank's own blocks by a BlockReader, on the process's ReaderThreads. A block is read to memory
/// of the source's own, and copied where it belongs when it is complete: so nobody ever waits for a read
/// that is given up, however long the disk takes.
class ReadingSource final : public BlockSource
{
public:
  /// The messenger must outlive the source, or the last frame that reads from it.
  ReadingSource(Messenger& messenger, std::shared_ptr<const BlockReader> reader);
  ~ReadingSource() override;

  void Begin(const BlockWant& block, std::byte* place) override;
  bool Submit() override;
  bool Poll(const Deliver& deliver) override;
  void Abandon() noexcept override;
  void Read(BlockId id, std::byte* block, std::size_t bytes) const override;

  /// Reads that are with the threads, or have come back and were not delivered: what they take of the
  /// memory is bounded.
  static constexpr std::size_t MostReads = 16;

private:
  struct Shared;

  void HandOver();

  std::shared_ptr<const BlockReader> Reader;
  std::shared_ptr<Shared> State;
  std::deque<BlockWant> Waiting; ///< not with the threads yet
  std::size_t Reads = 0;         ///< with the threads, or done and not delivered
};

} // namespace dsm

#endif
