// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_BlockRequests_h
#define dsm_BlockRequests_h

#include "DSMCore/base/Block.h"
#include "DSMCore/publish/BlockSegment.h"
#include "DSMCore/transport/Message.h"
#include "DSMCore/transport/Messenger.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace dsm
{

/// A block that a store wants from its owner.
struct BlockWant
{
  const BlockSegment* From;
  BlockId Id;
};

/// How a store asks the owners for blocks, and answers others: the messages, their checks, and what
/// is under way. Requests to one owner that are ready at the same time travel in one message.
/// Communication thread.
///
/// Every message names the asker's frame: what belongs to a frame that was cancelled is dropped, for
/// its segments may be gone.
class BlockRequests
{
public:
  /// What the store does for it; called within Messenger::Progress.
  struct Callbacks
  {
    /// A published segment by its number, or null.
    std::function<const BlockSegment*(std::uint32_t number)> Find;
    /// The bytes of a block that this rank owns.
    std::function<const std::byte*(const BlockWant& block)> GetOwned;
    /// Takes in a block that was asked for. It is pending until this has returned.
    std::function<void(const BlockWant& block, const std::byte* bytes)> Take;
  };

  BlockRequests(Messenger& messenger, Callbacks callbacks);

  /// Collective in order: from now on this rank serves others, and may ask.
  void BeginFrame();
  void EndFrame();

  /// The next Send asks for the block; it is pending from now on, unless this throws.
  void Add(const BlockWant& want);
  /// Asks the owners for what was added since the last call. Returns whether there was anything.
  bool Send();
  std::size_t GetPendingCount() const { return this->Pending.size(); }

  /// Returns what is pending; answers to it are dropped, for the rest of the frame.
  std::vector<BlockWant> Abandon();

  /// Messages that asked for blocks, in this frame.
  std::uint64_t GetCount() const { return this->Count; }
  /// Bytes of blocks, in this frame.
  std::uint64_t GetBytesSent() const { return this->BytesSent; }
  std::uint64_t GetBytesReceived() const { return this->BytesReceived; }

private:
  /// On the wire: a request has one or more; a reply has one, behind the bytes.
  struct BlockName
  {
    std::uint32_t Segment;
    std::uint32_t Frame;
    BlockId Id;
  };

  BlockWant Find(const BlockName& name, int source, const char* deed) const;
  void Serve(const Message& message);
  void Receive(Message& message);

  Messenger& Messages;
  Callbacks Store;
  std::vector<BlockWant> Pending;
  std::vector<BlockWant> Unsent; ///< those of Pending that Send has not seen
  bool Abandoned = false;
  std::uint32_t FrameSession = 0;
  std::uint64_t Count = 0;
  std::uint64_t BytesSent = 0;
  std::uint64_t BytesReceived = 0;
};

} // namespace dsm

#endif
