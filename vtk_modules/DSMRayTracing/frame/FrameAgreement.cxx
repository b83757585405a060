// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/FrameAgreement.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace rt
{

namespace
{

std::vector<std::byte> ToBytes(const std::string& text)
{
  std::vector<std::byte> bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  return bytes;
}

std::string ToText(const std::vector<std::byte>& bytes, std::size_t first)
{
  return { reinterpret_cast<const char*>(bytes.data()) + first, bytes.size() - first };
}

} // namespace

FrameAgreement::FrameAgreement(dsm::Messenger& messenger, std::function<void()> failureSeen)
  : Messenger(messenger)
  , FailureSeen(std::move(failureSeen))
  , Missing(messenger.GetSize())
{
  if (messenger.GetRank() == 0)
  {
    messenger.SetHandler(dsm::MessageKind::FrameDone,
      [this](dsm::Message&& message)
      { this->Collect(message.Source, ToText(message.Payload, 0)); });
  }
  else
  {
    messenger.SetHandler(dsm::MessageKind::FrameEnd,
      [this](dsm::Message&& message) { this->End(std::move(message)); });
  }
}

FrameAgreement::~FrameAgreement()
{
  this->Messenger.SetHandler(dsm::MessageKind::FrameDone, {});
  this->Messenger.SetHandler(dsm::MessageKind::FrameEnd, {});
}

void FrameAgreement::ReportDone(const std::string& cause)
{
  this->Reported = true;
  if (this->Messenger.GetRank() == 0)
  {
    this->Collect(0, cause);
  }
  else
  {
    this->Messenger.Post(0, dsm::MessageKind::FrameDone, ToBytes(cause));
  }
}

void FrameAgreement::Collect(int source, const std::string& cause)
{
  if (!cause.empty())
  {
    // The lowest failing rank speaks for all, whichever was heard first.
    if (this->Outcome.IsOk() || source < this->Outcome.FailedRank)
    {
      this->Outcome = { source, cause };
    }
    this->FailureSeen();
  }
  if (--this->Missing > 0)
  {
    return;
  }
  auto payload = dsm::Encode<std::int32_t>(this->Outcome.FailedRank);
  const auto text = ToBytes(this->Outcome.Cause);
  payload.insert(payload.end(), text.begin(), text.end());
  for (int rank = 1; rank < this->Messenger.GetSize(); ++rank)
  {
    this->Messenger.Post(rank, dsm::MessageKind::FrameEnd, payload);
  }
  this->Over = true;
}

void FrameAgreement::End(dsm::Message&& message)
{
  this->Outcome.FailedRank =
    dsm::Decode<std::int32_t>(message, dsm::MessageKind::FrameEnd, /*exact=*/false);
  this->Outcome.Cause = ToText(message.Payload, sizeof(std::int32_t));
  this->Over = true;
}

} // namespace rt
