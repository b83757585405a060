// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/publish/FragmentExchange.h"

#include "DSMCore/base/Error.h"

#include <algorithm>
#include <exception>
#include <string>
#include <utility>

namespace dsm
{

namespace
{

/// Behind a fragment's bytes.
struct FragmentTail
{
  BlockId Block;
};

/// Smallest advance that is worth to be shown.
constexpr double ProgressStep = 0.01;

} // namespace

FragmentExchange::FragmentExchange(
  Messenger& messenger, const BlockSegment& segment, FragmentSink& sink)
  : Messages(messenger)
  , Segment(segment)
  , Sink(sink)
  , End(messenger, MessageKind::Fragment)
{
  this->Messages.SetHandler(
    MessageKind::Fragment, [this](Message&& message) { this->Receive(std::move(message)); });
}

FragmentExchange::~FragmentExchange() = default;

void FragmentExchange::Run(FragmentSource& source, FunctionRef<void(double)> progress)
{
  double shown = -1.0;
  const auto work = [&]
  {
    const bool fed = this->Feed(source);
    if (progress && fed && this->Failure.IsEmpty())
    {
      this->Failure.Try(
        [&]
        {
          const double part = std::clamp(source.GetProgress(), 0.0, 1.0);
          if (part >= shown + ProgressStep && part < 1.0) // all is not done yet
          {
            shown = part;
            progress(part);
          }
        });
    }
    return fed;
  };
  this->Messages.ServeUntil([this] { return this->End.IsReached(); }, work,
    [this](std::exception_ptr failure) { this->Failure.Keep(failure); });
}

bool FragmentExchange::Feed(FragmentSource& source)
{
  if (this->SourceIsDry)
  {
    return this->End.Tell();
  }
  if (this->Messages.GetUnsentBytes() >= MaximumUnsentBytes)
  {
    return false;
  }
  bool more = false;
  if (this->Failure.IsEmpty())
  {
    this->Failure.Try(
      [&]
      {
        Fragment fragment;
        if (source.Next(fragment))
        {
          this->Send(fragment);
          more = true;
        }
      });
  }
  this->SourceIsDry = !more;
  return more || this->End.Tell();
}

void FragmentExchange::Send(Fragment& fragment)
{
  const BlockDirectory& directory = this->Segment.GetDirectory();
  if (fragment.Block >= directory.GetCount())
  {
    throw Error("A fragment was produced for block " + std::to_string(fragment.Block) +
      ", but there are only " + std::to_string(directory.GetCount()) + ".");
  }
  const int owner = directory.GetOwner(fragment.Block);
  if (owner == this->Messages.GetRank())
  {
    this->Absorb(fragment.Block, fragment.Bytes.data(), fragment.Bytes.size());
    return;
  }
  AttachTail(fragment.Bytes, FragmentTail{ fragment.Block });
  this->Messages.Post(owner, MessageKind::Fragment, std::move(fragment.Bytes));
}

void FragmentExchange::Receive(Message&& message)
{
  if (message.Session != this->End.GetSession() || !this->Failure.IsEmpty())
  {
    return;
  }
  this->Failure.Try(
    [&]
    {
      const auto tail = DetachTail<FragmentTail>(message, MessageKind::Fragment);
      const BlockDirectory& directory = this->Segment.GetDirectory();
      if (tail.Block >= directory.GetCount() ||
        directory.GetOwner(tail.Block) != this->Messages.GetRank())
      {
        throw Error("Rank " + std::to_string(message.Source) + " sent a fragment of block " +
          std::to_string(tail.Block) +
          ", which this rank does not own. Do all ranks run the same build?");
      }
      this->Absorb(tail.Block, message.Payload.data(), message.Payload.size());
    });
}

void FragmentExchange::Absorb(BlockId id, const std::byte* bytes, std::size_t count)
{
  this->Sink.Absorb(
    id, this->Segment.GetOwned(id), this->Segment.GetDirectory().GetBytes(id), bytes, count);
}

} // namespace dsm
