// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/publish/BlockSpread.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/publish/FragmentExchange.h"

#include <algorithm>
#include <exception>
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
  , End(messenger, MessageKind::Fragment)
{
  this->Messages.SetHandler(
    MessageKind::Fragment, [this](Message&& message) { this->Receive(std::move(message)); });
}

BlockSpread::~BlockSpread() = default;

void BlockSpread::Run()
{
  this->Messages.ServeUntil([this] { return this->End.IsReached(); },
    [this] { return this->Feed(); },
    [this](std::exception_ptr failure) { this->Failure.Keep(failure); });
}

bool BlockSpread::Feed()
{
  if (this->Next < this->Directory.GetCount() &&
    this->Messages.GetUnsentBytes() >= FragmentExchange::MaximumUnsentBytes)
  {
    return false;
  }
  bool sent = false;
  this->Failure.Try([&] { sent = this->SendNext(); });
  if (!this->Failure.IsEmpty())
  {
    this->Next = this->Directory.GetCount();
  }
  return sent || this->End.Tell();
}

bool BlockSpread::SendNext()
{
  const int rank = this->Messages.GetRank();
  while (this->Next < this->Directory.GetCount())
  {
    const BlockId id = this->Next;
    const int group = this->NextGroup;
    const bool last =
      this->Directory.GetOwner(id) != rank || group + 1 >= this->Groups.GetGroupCount();
    this->NextGroup = last ? 0 : group + 1;
    this->Next += last ? 1 : 0;
    if (this->Directory.GetOwner(id) == rank && group != this->Groups.GetGroup(rank))
    {
      const std::byte* const bytes = this->From(id);
      std::vector<std::byte> payload;
      payload.reserve(this->Directory.GetBytes(id) + 4 * sizeof(BlockTail)); // the transport's too
      payload.assign(bytes, bytes + this->Directory.GetBytes(id));
      AttachTail(payload, BlockTail{ id });
      this->Messages.Post(
        this->Groups.GetHolder(id, rank, group), MessageKind::Fragment, std::move(payload));
      return true;
    }
  }
  return false;
}

void BlockSpread::Receive(Message&& message)
{
  if (message.Session != this->End.GetSession())
  {
    return;
  }
  this->Failure.Try(
    [&]
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
    });
}

} // namespace dsm
