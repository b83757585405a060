// SPDX-License-Identifier: BSD-3-Clause
// The messages of ranks that wait, and what happens to ranks that stay silent.
#include "DSMCore/transport/MessengerInternals.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <string>

namespace dsm
{

namespace
{

/// Signs of life in the time that a rank may be silent, and the most seconds between two.
constexpr double SignsInLimit = 8.0;
constexpr double LongestInterval = 5.0;

} // namespace

double Messenger::Internals::GetInterval() const
{
  return std::min(this->SilenceLimit / SignsInLimit, LongestInterval);
}

void Messenger::Internals::Watch()
{
  const int size = this->Carrier->GetSize();
  if (size == 1 || this->SilenceLimit == 0.0)
  {
    return;
  }
  this->ThrowIfLost();
  const auto secondsSince = [now = Clock::now()](Clock::time_point then)
  { return std::chrono::duration<double>(now - then).count(); };
  const double listened = secondsSince(this->LastLook);
  const double interval = this->GetInterval();
  if (listened < 0.25 * interval)
  {
    return;
  }
  this->LastLook = Clock::now();
  const bool isFirst = this->Carrier->GetRank() == 0;
  // Not more than that: a rank that was stopped must not take it for the silence of the others.
  const int silent = this->Others.Listen(
    std::min(listened, interval), this->SilenceLimit, isFirst ? 1 : 0, isFirst ? size : 1);
  if (silent >= 0)
  {
    this->GiveUp({ Life::Lost, silent });
    this->ThrowIfLost();
  }
  if (this->Tells && secondsSince(this->LastSign) >= interval &&
    this->Tell({ Life::Waiting }, false))
  {
    this->LastSign = Clock::now();
    this->HasTold = true;
  }
}

bool Messenger::Internals::Tell(Sign sign, bool all) noexcept
{
  const int own = this->Carrier->GetRank();
  bool isTold = true;
  for (int rank = 0; rank < (all || own == 0 ? this->Carrier->GetSize() : 1); ++rank)
  {
    try
    {
      if (rank != own)
      {
        this->Post(rank, MessageKind::SignOfLife, Encode(sign));
      }
    }
    catch (...)
    {
      isTold = false; // there will be another one
    }
  }
  return isTold;
}

void Messenger::Internals::TakeSign(const Message& message)
{
  const auto sign = Decode<Sign>(message, MessageKind::SignOfLife);
  switch (sign.Says)
  {
    case Life::Lost:
      this->Loss = this->Loss.LostRank < 0 ? sign : this->Loss;
      break;
    case Life::Waiting:
      this->Others.Expect(message.Source, true);
      break;
    case Life::Leaving:
      // Not when it came to serve since.
      if (Distance(this->ServingSince, message.Session) >= 0)
      {
        this->Others.Expect(message.Source, false);
      }
      break;
  }
}

void Messenger::Internals::GiveUp(Sign loss)
{
  this->Loss = loss;
  this->Tell(loss, true);
}

void Messenger::Internals::GiveUpThisRank()
{
  this->GiveUp({ Life::Lost, this->Carrier->GetRank(), 1 });
}

void Messenger::Internals::ThrowIfLost()
{
  const int rank = this->Loss.LostRank;
  if (rank < 0)
  {
    return;
  }
  std::optional<StepAborted> lost;
  this->Insist(
    [&]
    {
      char seconds[32];
      std::snprintf(seconds, sizeof(seconds), "%g", this->SilenceLimit);
      const std::string name = "Rank " + std::to_string(rank);
      const std::string what = this->Loss.IsStuck != 0
        ? name + " is stuck: its tracing threads made no progress for " + seconds + " s."
        : name + " did not respond for " + seconds +
          " s: it is stopped, hangs, or its host failed.";
      lost.emplace(Status{ rank,
        what +
          " The other ranks stopped waiting. Restart the program (pvserver, if connected to a "
          "server) to draw again. To wait longer, raise the limit (DSMSilenceLimit; 0 waits "
          "forever).",
        false });
    });
  throw *lost;
}

void Messenger::Internals::ServeAll(bool doServe)
{
  this->IsServing = doServe;
  this->ServingSince = this->Session;
  this->Others.ExpectAll(doServe);
}

void Messenger::SetSilenceLimit(double seconds)
{
  this->Self->SilenceLimit = std::max(seconds, 0.0);
}

double Messenger::GetSilenceLimit() const
{
  return this->Self->SilenceLimit;
}

void Messenger::GiveUpThisRank()
{
  this->Self->GiveUpThisRank();
}

void Messenger::BeginServing()
{
  this->Self->ServeAll(true);
}

void Messenger::EndServing()
{
  this->Self->ServeAll(false);
}

} // namespace dsm
