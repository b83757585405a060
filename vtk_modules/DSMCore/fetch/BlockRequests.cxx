// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/fetch/BlockRequests.h"

#include "DSMCore/base/Error.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace dsm
{

BlockRequests::BlockRequests(Messenger& messenger, Callbacks callbacks)
  : Messages(messenger)
  , Store(std::move(callbacks))
  , BytesFrom(static_cast<std::size_t>(messenger.GetSize()))
{
}

void BlockRequests::BeginFrame()
{
  this->Pending.clear();
  this->Unsent.clear();
  this->Debts.clear();
  this->DebtCount = 0;
  this->Deferred.clear();
  this->Abandoned = false;
  this->Count = 0;
  this->BytesSent = 0;
  this->BytesReceived = 0;
  std::fill(this->BytesFrom.begin(), this->BytesFrom.end(), 0);
  this->Messages.SetHandler(
    MessageKind::BlockRequest, [this](Message&& message) { this->Serve(message); });
  this->Messages.SetHandler(
    MessageKind::BlockReply, [this](Message&& message) { this->Receive(message); });
  this->FrameSession = this->Messages.BeginSession();
}

void BlockRequests::EndFrame()
{
  this->Messages.SetHandler(MessageKind::BlockRequest, {});
  this->Messages.SetHandler(MessageKind::BlockReply, {});
}

void BlockRequests::Begin(const BlockWant& want)
{
  this->Unsent.push_back(want);
  try
  {
    this->Pending.push_back(want);
  }
  catch (...)
  {
    this->Unsent.pop_back();
    throw;
  }
}

bool BlockRequests::Submit()
{
  if (this->Unsent.empty())
  {
    return false;
  }
  std::map<int, std::vector<std::byte>> requests; // by owner
  for (const BlockWant& want : this->Unsent)
  {
    AttachTail(requests[want.From->GetDirectory().GetOwner(want.Id)],
      BlockName{ want.From->GetNumber(), this->FrameSession, want.Id });
  }
  this->Unsent.clear();
  for (auto& [owner, request] : requests)
  {
    this->Messages.Post(owner, MessageKind::BlockRequest, std::move(request));
    ++this->Count;
  }
  return true;
}

void BlockRequests::Abandon() noexcept
{
  this->Abandoned = true;
  this->Unsent.clear();
  this->Pending.clear();
  this->Debts.clear();
  this->DebtCount = 0;
  this->Deferred.clear();
}

BlockWant BlockRequests::Find(const BlockName& name, int source, const char* deed) const
{
  const BlockSegment* const segment = this->Store.Find(name.Segment);
  if (!segment || name.Id >= segment->GetDirectory().GetCount() ||
    name.FrameSession != this->FrameSession)
  {
    throw Error("Rank " + std::to_string(source) + " " + deed + " block " +
      std::to_string(name.Id) + " of segment " + std::to_string(name.Segment) + " in session " +
      std::to_string(name.FrameSession) + ", but rank " + std::to_string(this->Messages.GetRank()) +
      " has no such block. Do all ranks run the same build?");
  }
  return { segment, name.Id };
}

void BlockRequests::Serve(const Message& message)
{
  for (const BlockName& name : DecodeSeveral<BlockName>(message, MessageKind::BlockRequest))
  {
    if (name.FrameSession < this->FrameSession)
    {
      continue;
    }
    const BlockWant block = this->Find(name, message.Source, "requested");
    const BlockDirectory& directory = block.From->GetDirectory();
    if (directory.GetOwner(name.Id) != this->Messages.GetRank())
    {
      throw Error("Rank " + std::to_string(message.Source) + " requested block " +
        std::to_string(name.Id) + " from rank " + std::to_string(this->Messages.GetRank()) +
        ", but rank " + std::to_string(directory.GetOwner(name.Id)) +
        " owns it. Do all ranks run the same build?");
    }
    this->ReplyWhenPossible({ block, message.Source }, this->Store.FindOwned(block));
  }
}

void BlockRequests::ReplyWhenPossible(const Debt& debt, const std::byte* bytes)
{
  if (bytes && this->Deferred.empty() && this->HasRoomFor(debt.Block))
  {
    this->Reply(debt, bytes);
  }
  else if (this->Abandoned)
  {
    return;
  }
  else if (bytes)
  {
    this->Deferred.push_back(debt);
  }
  else
  {
    this->AddDebt(debt);
  }
}

void BlockRequests::AddDebt(const Debt& debt)
{
  this->Debts.push_back(debt);
  this->DebtCount = this->Debts.size();
  this->Store.Bring(debt.Block);
}

bool BlockRequests::HasRoomFor(const BlockWant& block) const
{
  const std::size_t unsent = this->Messages.GetUnsentBytes();
  const std::size_t bytes = block.From->GetDirectory().GetBytes(block.Id) + sizeof(BlockName);
  return unsent == 0 || unsent + bytes <= this->ReplyBytes;
}

bool BlockRequests::AnswerLater()
{
  bool any = false;
  while (!this->Deferred.empty() && this->HasRoomFor(this->Deferred.front().Block))
  {
    const Debt debt = this->Deferred.front();
    if (const std::byte* const bytes = this->Store.FindOwned(debt.Block))
    {
      this->Reply(debt, bytes);
    }
    else // it has left memory in the meantime
    {
      this->AddDebt(debt);
    }
    this->Deferred.pop_front();
    any = true;
  }
  return any;
}

void BlockRequests::Answer(const BlockWant& block, const std::byte* bytes)
{
  const auto isOther = [&](const Debt& debt) { return !(debt.Block == block); };
  const auto first = std::partition(this->Debts.begin(), this->Debts.end(), isOther);
  const std::vector<Debt> due(first, this->Debts.end());
  this->Debts.erase(first, this->Debts.end());
  this->DebtCount = this->Debts.size();
  for (const Debt& debt : due)
  {
    this->ReplyWhenPossible(debt, bytes);
  }
}

void BlockRequests::AnswerDebts()
{
  const std::vector<Debt> debts = std::exchange(this->Debts, {});
  this->DebtCount = 0;
  for (const Debt& debt : debts)
  {
    this->ReplyWhenPossible(debt, this->Store.FindOwned(debt.Block));
  }
}

void BlockRequests::Reply(const Debt& debt, const std::byte* bytes)
{
  const BlockWant& block = debt.Block;
  const std::uint32_t count = block.From->GetDirectory().GetBytes(block.Id);
  std::vector<std::byte> reply;
  reply.reserve(count + 3 * sizeof(BlockName)); // the transport puts its header behind
  reply.assign(bytes, bytes + count);
  AttachTail(reply, BlockName{ block.From->GetNumber(), this->FrameSession, block.Id });
  this->Messages.Post(debt.Asker, MessageKind::BlockReply, std::move(reply));
  this->BytesSent += count;
}

void BlockRequests::Receive(Message& message)
{
  const auto name = DetachTail<BlockName>(message, MessageKind::BlockReply);
  if (name.FrameSession < this->FrameSession || this->Abandoned)
  {
    return;
  }
  const BlockWant block = this->Find(name, message.Source, "sent");
  const BlockDirectory& directory = block.From->GetDirectory();
  const std::uint32_t bytes = directory.GetBytes(name.Id);
  const auto asked = std::find_if(this->Pending.begin(), this->Pending.end(),
    [&](const BlockWant& want) { return want == block; });
  if (asked == this->Pending.end() || message.Payload.size() != bytes ||
    message.Source != directory.GetOwner(name.Id))
  {
    throw Error("Rank " + std::to_string(message.Source) + " sent " +
      std::to_string(message.Payload.size()) + " bytes as block " + std::to_string(name.Id) +
      ", but rank " + std::to_string(this->Messages.GetRank()) +
      " did not request it, or expects " + std::to_string(bytes) +
      " bytes. Do all ranks run the same build?");
  }
  // When it throws, the block is still pending: who abandons the frame sets it free.
  this->Store.Take(block, message.Payload.data());
  this->Pending.erase(asked);
  this->BytesReceived += bytes;
  this->BytesFrom[static_cast<std::size_t>(message.Source)] += bytes;
}

} // namespace dsm
