// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/publish/FragmentExchange.h"

#include <algorithm>
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
  Messenger& messenger, const BlockDirectory& directory, Locate locate)
  : Messages(messenger)
  , Directory(directory)
  , Find(std::move(locate))
{
}

FragmentExchange::~FragmentExchange()
{
  this->Messages.SetHandler(MessageKind::Fragment, {});
  this->Messages.SetHandler(MessageKind::PublishDone, {});
}

std::string FragmentExchange::Run(
  FragmentSource& source, FragmentSink& sink, const std::function<void(double)>& progress)
{
  this->Session = this->Messages.GetSession();
  this->Messages.SetHandler(MessageKind::Fragment,
    [this, &sink](Message&& message) { this->Receive(std::move(message), sink); });
  this->Messages.SetHandler(MessageKind::PublishDone,
    [this](Message&& message) { this->Finished += message.Session == this->Session ? 1 : 0; });

  double shown = -1.0;
  const auto done = [&]
  {
    // The own messages must have left: whoever waits for them gets no help from this rank while it
    // finishes its blocks.
    return this->Finished == this->Messages.GetSize() &&
      !this->Messages.HasUnsent(MessageKind::Fragment) &&
      !this->Messages.HasUnsent(MessageKind::PublishDone);
  };
  const auto work = [&]
  {
    const bool fed = this->Feed(source, sink);
    if (progress && fed && this->Cause.empty())
    {
      this->Try(
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
  this->Messages.ServeUntil(done, work, [this](const std::string& cause) { this->Fail(cause); });
  return this->Cause;
}

bool FragmentExchange::Feed(FragmentSource& source, FragmentSink& sink)
{
  if (this->SourceIsDry || this->Messages.GetUnsentBytes() >= MaximumUnsentBytes)
  {
    return false;
  }
  Fragment fragment;
  bool more = false;
  if (this->Cause.empty())
  {
    this->Try(
      [&]
      {
        more = source.Next(fragment);
        if (more && fragment.Block >= this->Directory.GetCount())
        {
          throw Error("A fragment was produced for block " + std::to_string(fragment.Block) +
            ", but there are only " + std::to_string(this->Directory.GetCount()) + ".");
        }
      });
  }
  if (!this->Cause.empty() || !more)
  {
    this->SourceIsDry = true;
    for (int rank = 0; rank < this->Messages.GetSize(); ++rank)
    {
      if (rank != this->Messages.GetRank())
      {
        this->Messages.Post(rank, MessageKind::PublishDone, {});
      }
    }
    ++this->Finished;
    return true;
  }
  const int owner = this->Directory.GetOwner(fragment.Block);
  if (owner == this->Messages.GetRank())
  {
    this->Absorb(sink, fragment.Block, fragment.Bytes.data(), fragment.Bytes.size());
  }
  else
  {
    this->Try(
      [&]
      {
        AttachTail(fragment.Bytes, FragmentTail{ fragment.Block });
        this->Messages.Post(owner, MessageKind::Fragment, std::move(fragment.Bytes));
      });
  }
  return true;
}

void FragmentExchange::Receive(Message&& message, FragmentSink& sink)
{
  if (message.Session != this->Session)
  {
    return;
  }
  this->Try(
    [&]
    {
      const auto tail = DetachTail<FragmentTail>(message, MessageKind::Fragment);
      if (tail.Block >= this->Directory.GetCount() ||
        this->Directory.GetOwner(tail.Block) != this->Messages.GetRank())
      {
        throw Error("Rank " + std::to_string(message.Source) + " sent a fragment of block " +
          std::to_string(tail.Block) +
          ", which this rank does not own. Do all ranks run the same " + "build?");
      }
      this->Absorb(sink, tail.Block, message.Payload.data(), message.Payload.size());
    });
}

void FragmentExchange::Absorb(
  FragmentSink& sink, BlockId id, const std::byte* bytes, std::size_t count)
{
  if (this->Cause.empty())
  {
    this->Try([&] { sink.Absorb(id, this->Find(id), this->Directory.GetBytes(id), bytes, count); });
  }
}

void FragmentExchange::Try(const std::function<void()>& step)
{
  try
  {
    step();
  }
  catch (...)
  {
    this->Fail(Messenger::DescribeException());
  }
}

void FragmentExchange::Fail(const std::string& cause)
{
  if (this->Cause.empty())
  {
    this->Cause = cause;
  }
}

} // namespace dsm
