// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/publish/BlockSpread.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/publish/FragmentExchange.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace dsm
{

namespace
{

/// Behind a block's bytes.
struct BlockTail
{
  BlockId Block;
};

} // namespace

BlockSpread::BlockSpread(Messenger& messenger, const BlockDirectory& directory,
  const HostGroups& groups, Source source, Destination destination)
  : Messages(messenger)
  , Directory(directory)
  , Groups(groups)
  , From(std::move(source))
  , To(std::move(destination))
{
}

BlockSpread::~BlockSpread()
{
  this->Messages.SetHandler(MessageKind::Fragment, {});
  this->Messages.SetHandler(MessageKind::PublishDone, {});
}

std::string BlockSpread::Run()
{
  this->Session = this->Messages.GetSession();
  this->Messages.SetHandler(
    MessageKind::Fragment, [this](Message&& message) { this->Receive(std::move(message)); });
  this->Messages.SetHandler(MessageKind::PublishDone,
    [this](Message&& message) { this->Finished += message.Session == this->Session ? 1 : 0; });
  // The own messages must have left, as in FragmentExchange.
  const auto done = [this]
  {
    return this->Finished == this->Messages.GetSize() &&
      !this->Messages.HasUnsent(MessageKind::Fragment) &&
      !this->Messages.HasUnsent(MessageKind::PublishDone);
  };
  this->Messages.ServeUntil(
    done, [this] { return this->Feed(); }, [this](const std::string& cause) { this->Fail(cause); });
  return this->Cause;
}

bool BlockSpread::Feed()
{
  if (this->Told || this->Messages.GetUnsentBytes() >= FragmentExchange::MaximumUnsentBytes)
  {
    return false;
  }
  const int rank = this->Messages.GetRank();
  try
  {
    while (this->Next < this->Directory.GetCount())
    {
      const BlockId id = this->Next;
      const int group = this->NextGroup;
      const bool last = group + 1 >= this->Groups.GetGroupCount();
      this->NextGroup = last ? 0 : group + 1;
      this->Next += last ? 1 : 0;
      if (this->Directory.GetOwner(id) != rank)
      {
        this->NextGroup = 0;
        this->Next = id + 1;
      }
      else if (group != this->Groups.GetGroup(rank))
      {
        const std::byte* const bytes = this->From(id);
        std::vector<std::byte> payload;
        payload.reserve(
          this->Directory.GetBytes(id) + 4 * sizeof(BlockTail)); // the transport's too
        payload.assign(bytes, bytes + this->Directory.GetBytes(id));
        AttachTail(payload, BlockTail{ id });
        this->Messages.Post(
          this->Groups.GetHolder(id, rank, group), MessageKind::Fragment, std::move(payload));
        return true;
      }
    }
  }
  catch (...)
  {
    this->Fail(Messenger::DescribeException());
  }
  for (int other = 0; other < this->Messages.GetSize(); ++other)
  {
    if (other != rank)
    {
      this->Messages.Post(other, MessageKind::PublishDone, {});
    }
  }
  this->Told = true;
  ++this->Finished;
  return true;
}

void BlockSpread::Receive(Message&& message)
{
  if (message.Session != this->Session)
  {
    return;
  }
  try
  {
    const auto tail = DetachTail<BlockTail>(message, MessageKind::Fragment);
    const int rank = this->Messages.GetRank();
    if (tail.Block >= this->Directory.GetCount() ||
      this->Directory.GetOwner(tail.Block) != message.Source ||
      this->Groups.AreTogether(rank, message.Source) ||
      this->Groups.GetHolder(tail.Block, message.Source, this->Groups.GetGroup(rank)) != rank ||
      this->Directory.GetBytes(tail.Block) != message.Payload.size())
    {
      throw Error("Rank " + std::to_string(message.Source) + " sent " +
        std::to_string(message.Payload.size()) + " bytes as a copy of block " +
        std::to_string(tail.Block) +
        ", which this rank does not expect. Do all ranks run the same build?");
    }
    std::copy(message.Payload.begin(), message.Payload.end(), this->To(tail.Block));
  }
  catch (...)
  {
    this->Fail(Messenger::DescribeException());
  }
}

void BlockSpread::Fail(const std::string& cause)
{
  if (this->Cause.empty())
  {
    this->Cause = cause;
  }
}

} // namespace dsm
