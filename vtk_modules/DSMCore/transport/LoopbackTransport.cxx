// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/transport/LoopbackTransport.h"

#include "DSMCore/base/Error.h"

#include <atomic>
#include <deque>
#include <mutex>
#include <string>
#include <utility>

namespace dsm
{

struct LoopbackTransport::Group
{
  struct Member
  {
    std::mutex Guard;
    std::deque<Message> Mailbox;
    /// Payload that this member posted and that lies in mailboxes.
    std::atomic<std::size_t> UnsentBytes{ 0 };
  };

  explicit Group(int size)
    : Members(static_cast<std::size_t>(size))
  {
  }
  std::vector<Member> Members;
};

std::vector<std::unique_ptr<Transport>> LoopbackTransport::CreateGroup(int size)
{
  if (size < 1)
  {
    throw Error(
      "Invalid loopback group of " + std::to_string(size) + " ranks. Use at least one rank.");
  }
  const auto group = std::make_shared<Group>(size);
  std::vector<std::unique_ptr<Transport>> transports;
  for (int rank = 0; rank < size; ++rank)
  {
    transports.emplace_back(new LoopbackTransport(group, rank));
  }
  return transports;
}

LoopbackTransport::LoopbackTransport(std::shared_ptr<Group> group, int rank)
  : Members(std::move(group))
  , Rank(rank)
{
}

LoopbackTransport::~LoopbackTransport() = default;

int LoopbackTransport::GetRank() const
{
  return this->Rank;
}

int LoopbackTransport::GetSize() const
{
  return static_cast<int>(this->Members->Members.size());
}

void LoopbackTransport::Post(int destination, Message message)
{
  if (destination < 0 || destination >= this->GetSize())
  {
    throw Error("Invalid destination: a message for rank " + std::to_string(destination) +
      " was posted, but there are " + std::to_string(this->GetSize()) + " ranks.");
  }
  message.Source = this->Rank;
  const std::size_t bytes = message.Payload.size();
  Group::Member& receiver = this->Members->Members[destination];
  const std::lock_guard<std::mutex> lock(receiver.Guard);
  receiver.Mailbox.push_back(std::move(message));
  this->Members->Members[this->Rank].UnsentBytes += bytes; // the receiver cannot take it yet
}

bool LoopbackTransport::Progress(const Deliver& deliver)
{
  Group::Member& self = this->Members->Members[this->Rank];
  std::size_t count;
  {
    const std::lock_guard<std::mutex> lock(self.Guard);
    count = self.Mailbox.size();
  }
  // Messages that `deliver` posts to this rank wait for the next Progress; otherwise two handlers
  // could keep each other busy forever.
  for (std::size_t i = 0; i < count; ++i)
  {
    Message* message = nullptr; // stays where it is, whatever is put behind it
    {
      const std::lock_guard<std::mutex> lock(self.Guard);
      message = &self.Mailbox.front();
    }
    std::atomic<std::size_t>& unsent = this->Members->Members[message->Source].UnsentBytes;
    const std::size_t bytes = message->Payload.size();
    deliver(std::move(*message)); // when it throws, the message is still there
    unsent -= bytes;
    const std::lock_guard<std::mutex> lock(self.Guard);
    self.Mailbox.pop_front();
  }
  return count > 0;
}

std::size_t LoopbackTransport::GetUnsentBytes() const
{
  return this->Members->Members[this->Rank].UnsentBytes;
}

bool LoopbackTransport::HasUnsent(MessageKind) const
{
  return false;
}

} // namespace dsm
