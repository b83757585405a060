// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_BlockRequests_h
#define dsm_BlockRequests_h

#include "DSMCore/base/Block.h"
#include "DSMCore/fetch/BlockSource.h"
#include "DSMCore/publish/BlockSegment.h"
#include "DSMCore/transport/Message.h"
#include "DSMCore/transport/Messenger.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <vector>

namespace dsm
{

/// How a store asks the owners for blocks, and answers others: the messages, their checks, and what
/// is under way. Requests to one owner that are ready at the same time travel in one message.
/// Communication thread.
///
/// Every message names the session of the asker's frame: what belongs to a frame that was cancelled is
/// dropped, for its segments may be gone.
class BlockRequests final : public BlockSource
{
public:
  /// Functions of the store that this class calls, within Messenger::Progress.
  struct Callbacks
  {
    /// A published segment by its number, or null.
    std::function<const BlockSegment*(std::uint32_t number)> Find;
    /// The bytes of a block that this rank owns; null when they are not in memory.
    std::function<const std::byte*(const BlockWant& block)> FindOwned;
    /// Begins to bring such a block to memory; then Answer is called.
    std::function<void(const BlockWant& block)> Bring;
    /// Takes in a block that was asked for: copies its bytes. It is pending until this has returned.
    std::function<void(const BlockWant& block, const std::byte* bytes)> Take;
  };

  /// Default limit in bytes for replies that have not been sent (see SetReplyBytes).
  static constexpr std::size_t MostReplyBytes = std::size_t(8) << 20;

  BlockRequests(Messenger& messenger, Callbacks callbacks);

  /// Sets the limit in bytes for replies that have not been sent; further replies wait. A single
  /// reply is always sent, whatever its size. Call between frames.
  void SetReplyBytes(std::size_t bytes) { this->ReplyBytes = bytes; }

  /// Collective in order: from now on this rank serves others, and may ask.
  void BeginFrame();
  void EndFrame();

  /// Makes the block pending; the next Submit requests it from its owner. Messenger::Progress delivers the reply,
  /// without a copy of the message.
  void Begin(const BlockWant& block) override;
  bool Submit() override;
  bool Poll(const Deliver&) override { return false; }
  /// Answers to what is pending, and those that this rank owes, are dropped, for the rest of the frame.
  void Abandon() noexcept override;
  std::size_t GetPendingCount() const { return this->Pending.size(); }

  /// Sends a block that has come to the memory of this rank, its owner, to the ranks that requested it.
  void Answer(const BlockWant& block, const std::byte* bytes);
  /// To be called often: sends answers that had to wait until other replies left. Returns whether it did anything.
  bool AnswerLater();
  /// Returns whether other ranks asked for blocks that were not in memory. Any thread.
  bool HasDebts() const { return this->DebtCount.load() != 0; }
  /// Blocks may have come to memory without Answer: sends them to the ranks that requested them, and begins to read
  /// the others.
  void AnswerDebts();

  /// Messages that asked for blocks, in this frame.
  std::uint64_t GetCount() const { return this->Count; }
  /// Bytes of blocks, in this frame.
  std::uint64_t GetBytesSent() const { return this->BytesSent; }
  std::uint64_t GetBytesReceived() const { return this->BytesReceived; }
  /// Returns the bytes of blocks received from this owner, in this frame.
  std::uint64_t GetBytesFrom(int owner) const
  {
    return this->BytesFrom[static_cast<std::size_t>(owner)];
  }

private:
  /// On the wire: a request has one or more; a reply has one, behind the bytes.
  struct BlockName
  {
    std::uint32_t Segment;
    std::uint32_t FrameSession;
    BlockId Id;
  };

  /// A rank that is still to be answered.
  struct Debt
  {
    BlockWant Block;
    int Asker;
  };

  void AddDebt(const Debt& debt);
  /// With the bytes, or, where these are null, when the block is in memory again. May wait for other
  /// replies to leave.
  void ReplyWhenPossible(const Debt& debt, const std::byte* bytes);
  bool HasRoomFor(const BlockWant& block) const;
  void Reply(const Debt& debt, const std::byte* bytes);
  BlockWant Find(const BlockName& name, int source, const char* deed) const;
  void Serve(const Message& message);
  void Receive(Message& message);

  Messenger& Messages;
  Callbacks Store;
  std::vector<BlockWant> Pending;
  std::vector<BlockWant> Unsent; ///< those of Pending that Submit has not seen
  std::vector<Debt> Debts;       ///< their blocks are not in memory
  std::atomic<std::size_t> DebtCount{ 0 };
  std::deque<Debt> Deferred; ///< wait for other replies to leave
  std::size_t ReplyBytes = MostReplyBytes;
  bool Abandoned = false;
  std::uint32_t FrameSession = 0;
  std::uint64_t Count = 0;
  std::uint64_t BytesSent = 0;
  std::uint64_t BytesReceived = 0;
  std::vector<std::uint64_t> BytesFrom; ///< each owner
};

} // namespace dsm

#endif
