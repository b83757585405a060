// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/publish/BlockStream.h"

#include <exception>
#include <utility>

namespace dsm
{

namespace
{

/// Behind the bytes.
struct BlockTail
{
  BlockId Block;
};

} // namespace

BlockStream::BlockStream(Messenger& messenger, Take take)
  : Messages(messenger)
  , Sink(take)
  , Session(messenger.GetSession())
{
  this->Messages.SetHandler(
    MessageKind::Fragment, [this](Message&& message) { this->Receive(std::move(message)); });
  this->Messages.SetHandler(MessageKind::PublishDone,
    [this](Message&& message) { this->Finished += message.Session == this->Session ? 1 : 0; });
}

BlockStream::~BlockStream()
{
  this->Messages.SetHandler(MessageKind::Fragment, {});
  this->Messages.SetHandler(MessageKind::PublishDone, {});
}

void BlockStream::Post(int destination, BlockId id, std::vector<std::byte>&& bytes)
{
  AttachTail(bytes, BlockTail{ id });
  this->Messages.Post(destination, MessageKind::Fragment, std::move(bytes));
}

FirstFailure BlockStream::Run(FunctionRef<bool()> feed)
{
  this->Messages.ServeUntil([this] { return this->IsOver(); }, [&] { return this->Work(feed); },
    [this](std::exception_ptr failure) { this->Failure.Keep(failure); });
  return this->Failure;
}

bool BlockStream::Work(FunctionRef<bool()> feed)
{
  if (this->IsDry)
  {
    return this->TellEnd();
  }
  if (this->Messages.GetUnsentBytes() >= MaximumUnsentBytes)
  {
    return false;
  }
  bool more = false;
  if (this->Failure.IsEmpty())
  {
    this->Failure.Try([&] { more = feed(); });
  }
  this->IsDry = !more;
  return more || this->TellEnd();
}

/// Behind the last message to each. Called again after it has thrown, it notifies the ranks that were not reached
/// yet; returns whether there was anything to do.
bool BlockStream::TellEnd()
{
  const int size = this->Messages.GetSize();
  if (this->Told == size)
  {
    return false;
  }
  for (; this->Told < size; ++this->Told)
  {
    if (this->Told != this->Messages.GetRank())
    {
      this->Messages.Post(this->Told, MessageKind::PublishDone, {});
    }
  }
  ++this->Finished;
  return true;
}

/// This rank's messages must have been sent, too: ranks that wait for them get no help from this
/// rank while it does something else.
bool BlockStream::IsOver() const
{
  return this->Finished == this->Messages.GetSize() &&
    !this->Messages.HasUnsent(MessageKind::Fragment) &&
    !this->Messages.HasUnsent(MessageKind::PublishDone);
}

void BlockStream::Receive(Message&& message)
{
  if (message.Session != this->Session || !this->Failure.IsEmpty())
  {
    return;
  }
  this->Failure.Try(
    [&]
    {
      const auto tail = DetachTail<BlockTail>(message, MessageKind::Fragment);
      this->Sink(message.Source, tail.Block, message.Payload.data(), message.Payload.size());
    });
}

} // namespace dsm
