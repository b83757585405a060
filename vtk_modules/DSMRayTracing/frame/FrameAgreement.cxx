// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/FrameAgreement.h"

#include <cstdint>
#include <utility>

namespace rt
{

namespace
{

std::vector<std::byte> ToBytes(const std::string& text)
{
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  return { first, first + text.size() };
}

std::string ToText(const std::vector<std::byte>& bytes, std::size_t first)
{
  return { reinterpret_cast<const char*>(bytes.data()) + first, bytes.size() - first };
}

/// How a frame ended; the text of a failure follows.
struct Ending
{
  std::int32_t FailedRank;
  std::int32_t IsAborted;
};

} // namespace

FrameAgreement::FrameAgreement(
  dsm::Messenger& messenger, std::function<void()> failureSeen, std::function<void()> abortSeen)
  : Messenger(messenger)
  , FailureSeen(std::move(failureSeen))
  , AbortSeen(std::move(abortSeen))
  , Missing(messenger.GetSize())
{
  if (messenger.GetRank() == 0)
  {
    messenger.SetHandler(dsm::MessageKind::FrameDone,
      [this](dsm::Message&& message)
      { this->Collect(message.Source, std::move(message.Payload)); });
  }
  else
  {
    messenger.SetHandler(dsm::MessageKind::FrameStop, [this](dsm::Message&&) { this->Stop(); });
    messenger.SetHandler(dsm::MessageKind::FrameAbort, [this](dsm::Message&&) { this->Cease(); });
    messenger.SetHandler(dsm::MessageKind::FrameEnd,
      [this](dsm::Message&& message) { this->End(std::move(message)); });
  }
}

FrameAgreement::~FrameAgreement()
{
  this->Messenger.SetHandler(dsm::MessageKind::FrameDone, {});
  this->Messenger.SetHandler(dsm::MessageKind::FrameStop, {});
  this->Messenger.SetHandler(dsm::MessageKind::FrameAbort, {});
  this->Messenger.SetHandler(dsm::MessageKind::FrameEnd, {});
}

void FrameAgreement::ReportFailure(const std::string& cause)
{
  if (!this->Failed)
  {
    this->Tell(cause);
    this->Failed = true;
  }
}

void FrameAgreement::Abort()
{
  for (int rank = 1; !this->Aborted && rank < this->Messenger.GetSize(); ++rank)
  {
    this->Post(rank, dsm::MessageKind::FrameAbort, {});
  }
  this->Cease();
}

void FrameAgreement::ReportDone()
{
  this->Tell({});
  this->Done = true;
}

void FrameAgreement::Post(int rank, dsm::MessageKind kind, const std::vector<std::byte>& payload)
{
  this->Messenger.Insist([&] { this->Messenger.Post(rank, kind, payload); });
}

/// An empty cause says that this rank is done.
void FrameAgreement::Tell(const std::string& cause)
{
  std::vector<std::byte> bytes;
  this->Messenger.Insist([&] { bytes = ToBytes(cause); });
  if (this->Messenger.GetRank() == 0)
  {
    this->Collect(0, std::move(bytes));
  }
  else
  {
    this->Post(0, dsm::MessageKind::FrameDone, bytes);
  }
}

void FrameAgreement::Collect(int source, std::vector<std::byte>&& cause)
{
  if (!cause.empty())
  {
    // The lowest failing rank speaks for all, whichever was heard first.
    if (this->Missing > 0 && (this->Cause.empty() || source < this->Outcome.FailedRank))
    {
      this->Outcome.FailedRank = source;
      this->Cause = std::move(cause);
    }
    for (int rank = 1; !this->Stopped && rank < this->Messenger.GetSize(); ++rank)
    {
      this->Post(rank, dsm::MessageKind::FrameStop, {});
    }
    this->Stop();
    return;
  }
  if (--this->Missing > 0)
  {
    return;
  }
  std::vector<std::byte> payload;
  this->Messenger.Insist(
    [&]
    {
      this->Outcome.Cause = ToText(this->Cause, 0);
      payload = dsm::Encode(Ending{ this->Outcome.FailedRank, this->Aborted ? 1 : 0 });
      payload.insert(payload.end(), this->Cause.begin(), this->Cause.end());
    });
  for (int rank = 1; rank < this->Messenger.GetSize(); ++rank)
  {
    this->Post(rank, dsm::MessageKind::FrameEnd, payload);
  }
  this->Over = true;
}

void FrameAgreement::Stop()
{
  if (!this->Stopped)
  {
    this->Stopped = true;
    this->FailureSeen();
  }
}

void FrameAgreement::Cease()
{
  if (!this->Aborted)
  {
    this->Aborted = true;
    if (this->AbortSeen)
    {
      this->AbortSeen();
    }
  }
}

void FrameAgreement::End(dsm::Message&& message)
{
  const auto ending = dsm::Decode<Ending>(message, dsm::MessageKind::FrameEnd, /*exact=*/false);
  this->Outcome.FailedRank = ending.FailedRank;
  this->Messenger.Insist([&] { this->Outcome.Cause = ToText(message.Payload, sizeof(Ending)); });
  this->Aborted = ending.IsAborted != 0;
  this->Over = true;
}

} // namespace rt
