// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/FrameAgreement.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
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

std::string ToText(const std::vector<std::byte>& bytes)
{
  return { reinterpret_cast<const char*>(bytes.data()), bytes.size() };
}

/// How a frame ended, behind all ranks' reports and the 64 bits for the size of each, or behind the text of a failure.
struct Ending
{
  std::int32_t FailedRank;
  std::int32_t IsAborted;
};

/// Takes the value off that AttachTail has put there.
template <class T>
T TakeTail(std::vector<std::byte>& bytes)
{
  if (bytes.size() < sizeof(T))
  {
    throw dsm::Error("The report on a frame has " + std::to_string(bytes.size()) + " bytes, but " +
      std::to_string(sizeof(T)) + " were expected. Do all ranks run the same build?");
  }
  T value;
  std::memcpy(&value, bytes.data() + bytes.size() - sizeof(T), sizeof(T));
  bytes.resize(bytes.size() - sizeof(T));
  return value;
}

} // namespace

FrameAgreement::FrameAgreement(
  dsm::Messenger& messenger, std::function<void()> failureSeen, std::function<void()> abortSeen)
  : Messenger(messenger)
  , FailureSeen(std::move(failureSeen))
  , AbortSeen(std::move(abortSeen))
  , Missing(messenger.GetSize())
{
  messenger.Insist(
    [&]
    {
      this->Children = messenger.GetChildren();
      this->Reports.resize(static_cast<std::size_t>(messenger.GetSize()));
    });
  if (messenger.GetRank() == 0)
  {
    messenger.SetHandler(dsm::MessageKind::FrameDone,
      [this](dsm::Message&& message)
      {
        const Tale tale = dsm::DetachTail<Tale>(message, dsm::MessageKind::FrameDone);
        this->Collect(message.Source, tale, std::move(message.Payload));
      });
  }
  else
  {
    messenger.SetHandler(dsm::MessageKind::FrameStop, [this](dsm::Message&&) { this->Stop(); });
    messenger.SetHandler(dsm::MessageKind::FrameAbort, [this](dsm::Message&&) { this->Cease(); });
    messenger.SetHandler(dsm::MessageKind::FrameEnd,
      [this](dsm::Message&& message) { this->End(std::move(message.Payload)); });
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
    std::vector<std::byte> bytes;
    this->Messenger.Insist([&] { bytes = ToBytes(cause); });
    this->Tell(Tale::Failure, std::move(bytes));
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

void FrameAgreement::ReportDone(std::vector<std::byte> report)
{
  this->Tell(Tale::Done, std::move(report));
  this->Done = true;
}

void FrameAgreement::Post(int rank, dsm::MessageKind kind, const std::vector<std::byte>& payload)
{
  this->Messenger.Insist([&] { this->Messenger.Post(rank, kind, payload); });
}

void FrameAgreement::Tell(Tale tale, std::vector<std::byte>&& bytes)
{
  if (this->Messenger.GetRank() == 0)
  {
    this->Collect(0, tale, std::move(bytes));
    return;
  }
  const std::size_t size = bytes.size();
  this->Messenger.Insist(
    [&]
    {
      bytes.resize(size);
      dsm::AttachTail(bytes, tale);
    });
  this->Post(0, dsm::MessageKind::FrameDone, bytes);
}

void FrameAgreement::Collect(int source, Tale tale, std::vector<std::byte>&& bytes)
{
  if (tale == Tale::Failure)
  {
    this->CollectCause(source, std::move(bytes));
    return;
  }
  this->Reports[static_cast<std::size_t>(source)] = std::move(bytes);
  if (--this->Missing == 0)
  {
    this->TellEnd();
  }
}

void FrameAgreement::CollectCause(int source, std::vector<std::byte>&& cause)
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
}

void FrameAgreement::TellEnd()
{
  const bool isWhole = this->Outcome.IsOk() && !this->Aborted;
  std::vector<std::byte> payload;
  this->Messenger.Insist(
    [&]
    {
      this->Outcome.Cause = ToText(this->Cause);
      payload = this->Cause;
      for (std::size_t rank = 0; isWhole && rank < this->Reports.size(); ++rank)
      {
        payload.insert(payload.end(), this->Reports[rank].begin(), this->Reports[rank].end());
      }
      for (std::size_t rank = 0; isWhole && rank < this->Reports.size(); ++rank)
      {
        dsm::AttachTail(payload, static_cast<std::uint64_t>(this->Reports[rank].size()));
      }
      dsm::AttachTail(payload, Ending{ this->Outcome.FailedRank, this->Aborted ? 1 : 0 });
    });
  this->SpreadEnd(payload);
  if (!isWhole)
  {
    this->Reports.clear();
  }
  this->Over = true;
}

void FrameAgreement::SpreadEnd(const std::vector<std::byte>& bytes)
{
  for (const int child : this->Children)
  {
    this->Post(child, dsm::MessageKind::FrameEnd, bytes);
  }
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

void FrameAgreement::End(std::vector<std::byte>&& bytes)
{
  this->SpreadEnd(bytes);
  const auto ending = TakeTail<Ending>(bytes);
  this->Outcome.FailedRank = ending.FailedRank;
  this->Aborted = ending.IsAborted != 0;
  if (!this->Outcome.IsOk())
  {
    this->Messenger.Insist([&] { this->Outcome.Cause = ToText(bytes); });
  }
  if (this->Outcome.IsOk() && !this->Aborted)
  {
    this->Unpack(bytes);
  }
  else
  {
    this->Reports.clear();
  }
  this->Over = true;
}

/// Out of what SpreadEnd carries.
void FrameAgreement::Unpack(std::vector<std::byte>& bytes)
{
  const std::size_t tail = this->Reports.size() * sizeof(std::uint64_t);
  std::size_t end = bytes.size() - std::min(bytes.size(), tail);
  for (std::size_t rank = this->Reports.size(); rank > 0; --rank)
  {
    const auto count = static_cast<std::size_t>(TakeTail<std::uint64_t>(bytes));
    if (count > end)
    {
      throw dsm::Error("The report of rank " + std::to_string(rank - 1) +
        " on a frame is incomplete. Do all ranks run the same build?");
    }
    const auto last = bytes.begin() + static_cast<std::ptrdiff_t>(end);
    this->Messenger.Insist(
      [&] { this->Reports[rank - 1].assign(last - static_cast<std::ptrdiff_t>(count), last); });
    end -= count;
  }
}

} // namespace rt
