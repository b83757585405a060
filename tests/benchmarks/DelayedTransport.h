// SPDX-License-Identifier: BSD-3-Clause
#ifndef DelayedTransport_h
#define DelayedTransport_h

#include "DSMCore/transport/Transport.h"

#include <chrono>
#include <deque>
#include <memory>
#include <utility>

/// Holds every message that arrives for a while, as a slower network would: where the ranks of one
/// machine stand for those of many.
class DelayedTransport final : public dsm::Transport
{
public:
  explicit DelayedTransport(std::unique_ptr<dsm::Transport> carrier)
    : Carrier(std::move(carrier))
  {
  }

  /// Of messages that arrive from now on; seconds.
  void SetLatency(double seconds)
  {
    this->Latency =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  }

  int GetRank() const override { return this->Carrier->GetRank(); }
  int GetSize() const override { return this->Carrier->GetSize(); }
  void Post(int destination, dsm::Message message) override
  {
    this->Carrier->Post(destination, std::move(message));
  }
  bool Progress(const Deliver& deliver) override
  {
    const auto now = Clock::now();
    bool any = this->Carrier->Progress(
      [&](dsm::Message&& message) {
        this->Held.push_back({ now + this->Latency, std::move(message) });
      });
    while (!this->Held.empty() && this->Held.front().Due <= now)
    {
      dsm::Message message = std::move(this->Held.front().Content);
      this->Held.pop_front();
      deliver(std::move(message));
      any = true;
    }
    return any;
  }
  std::size_t GetUnsentBytes() const override { return this->Carrier->GetUnsentBytes(); }
  bool HasUnsent(dsm::MessageKind kind) const override { return this->Carrier->HasUnsent(kind); }

private:
  using Clock = std::chrono::steady_clock;

  struct Letter
  {
    Clock::time_point Due;
    dsm::Message Content;
  };

  std::unique_ptr<dsm::Transport> Carrier;
  Clock::duration Latency{ 0 };
  std::deque<Letter> Held;
};

#endif
