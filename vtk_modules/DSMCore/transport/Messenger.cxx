// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/transport/MessengerInternals.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <new>
#include <optional>
#include <thread>
#include <utility>

namespace dsm
{

namespace
{

/// For what needs little memory when there is none; see Insist.
constexpr std::size_t ReserveBytes = std::size_t(1) << 20;
constexpr int MostAttempts = 1000;
constexpr std::chrono::milliseconds AttemptPause(10);

/// Of a collective, on their way out before a rank makes more.
constexpr std::size_t MaximumUnsentBytes = std::size_t(8) << 20;

/// Signs of life in the time that a rank may be silent, and the most seconds between two.
constexpr double SignsInLimit = 8.0;
constexpr double LongestInterval = 5.0;

/// Sessions are compared by distance, so that their number may wrap around.
std::int32_t Distance(std::uint32_t from, std::uint32_t to)
{
  return static_cast<std::int32_t>(to - from);
}

/// Equal exactly for ranks on one running machine: names repeat between containers and clusters,
/// the boot identity does not.
std::string GetHostIdentity()
{
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  std::string boot;
  std::ifstream("/proc/sys/kernel/random/boot_id") >> boot;
  return std::string(name.data()) + " " + boot;
}

} // namespace

// -- Internals -------------------------------------------------------------------------------------

Messenger::Internals::Internals(std::unique_ptr<Transport> transport, std::size_t pieceBytes)
  : Carrier(std::move(transport))
  , PieceBytes(pieceBytes)
  , Others(this->Carrier->GetSize())
{
}

std::size_t Messenger::Internals::IndexOf(MessageKind kind)
{
  const std::size_t index = static_cast<std::size_t>(kind);
  if (index == 0 || index > static_cast<std::size_t>(MessageKind::Last))
  {
    throw Error(
      "There is no message kind " + std::to_string(index) + ". Do all ranks run the same build?");
  }
  return index;
}

void Messenger::Internals::Post(int destination, MessageKind kind, std::vector<std::byte> payload)
{
  IndexOf(kind);
  Message message;
  message.Kind = kind;
  message.Session = this->Session;
  message.Source = this->Carrier->GetRank();
  message.Payload = std::move(payload);
  this->Carrier->Post(destination, std::move(message));
}

bool Messenger::Internals::Progress()
{
  if (this->Dispatching)
  {
    throw Error("A message handler waited for messages; only the code around it may.");
  }
  if (this->Deferred)
  {
    std::rethrow_exception(std::exchange(this->Deferred, nullptr));
  }
  return this->Move();
}

bool Messenger::Internals::Move()
{
  const bool moved = this->Carrier->Progress(
    [this](Message&& message)
    {
      this->Others.Hear(message.Source);
      if (message.Kind == MessageKind::SignOfLife)
      {
        this->TakeSign(message);
        return;
      }
      this->Inbox.push_back(std::move(message));
      this->Changed = true;
    });
  return this->Dispatch() || moved;
}

/// Hands over what is due, oldest first, and drops what has become useless.
bool Messenger::Internals::Dispatch()
{
  bool any = false;
  while (this->Changed)
  {
    this->Changed = false;
    std::list<Message> arrived;
    arrived.swap(this->Inbox);
    while (!arrived.empty())
    {
      std::list<Message> message;
      message.splice(message.begin(), arrived, arrived.begin());
      try
      {
        any |= this->Treat(message);
      }
      catch (...)
      {
        if (!this->Deferring)
        {
          // Keep the order: what waits already, then what was not looked at yet.
          this->Inbox.splice(this->Inbox.end(), arrived);
          this->Changed = true;
          throw;
        }
        this->Keep(std::current_exception());
      }
    }
  }
  return any;
}

bool Messenger::Internals::Treat(std::list<Message>& list)
{
  Message& message = list.front();
  const bool isCollective = message.Kind == MessageKind::Collective;
  const Handler& handler = this->Handlers[IndexOf(message.Kind)];
  const std::int32_t ahead = Distance(this->Session, message.Session);
  if (ahead > 0 || (ahead == 0 && !handler && !isCollective))
  {
    this->Inbox.splice(this->Inbox.end(), list);
    return false;
  }
  if (isCollective && ahead == 0)
  {
    this->Received.splice(this->Received.end(), list);
    return true;
  }
  if (!handler)
  {
    return false;
  }
  const Handler keep = handler; // it may replace itself
  this->Dispatching = true;
  try
  {
    keep(std::move(message));
  }
  catch (...)
  {
    this->Dispatching = false;
    throw;
  }
  this->Dispatching = false;
  return true;
}

void Messenger::Internals::Keep(std::exception_ptr failure)
{
  this->Deferred = this->Deferred ? this->Deferred : failure;
}

void Messenger::Internals::ProgressUntil(FunctionRef<bool()> done, FunctionRef<bool()> work)
{
  const Wait wait(*this, !work || this->IsServing); // other work may take its time
  this->Idle.Reset();
  while (!done())
  {
    bool any = this->Progress();
    this->Watch();
    if (work)
    {
      any |= work();
    }
    if (any)
    {
      this->Idle.Reset();
    }
    else
    {
      this->Idle.Wait();
    }
  }
}

void Messenger::Internals::Insist(FunctionRef<void()> step)
{
  if (!this->Reserve)
  {
    this->Reserve.reset(new (std::nothrow) std::byte[ReserveBytes]);
  }
  for (int attempt = 1;; ++attempt)
  {
    try
    {
      step();
      return;
    }
    catch (...)
    {
      if (attempt == MostAttempts)
      {
        throw;
      }
    }
    if (!this->Reserve)
    {
      std::this_thread::sleep_for(AttemptPause);
    }
    this->Reserve.reset();
  }
}

void Messenger::Internals::RunCollective(FunctionRef<void()> exchange)
{
  ++this->Session;
  this->Changed = true;
  this->Received.clear();
  this->ThrowIfLost();
  exchange();
  this->Await([this] { return !this->Carrier->HasUnsent(MessageKind::Collective); });
}

void Messenger::Internals::Await(FunctionRef<bool()> done, FunctionRef<bool()> work)
{
  const auto move = [&]
  {
    bool any = false;
    this->Deferring = true;
    try
    {
      any = this->Move();
    }
    catch (const std::bad_alloc&)
    {
      // Of the transport; it has lost nothing, and takes it in the next time.
    }
    catch (...)
    {
      this->Keep(std::current_exception());
    }
    this->Deferring = false;
    return any;
  };
  const Wait wait(*this, true);
  this->Idle.Reset();
  while (!done())
  {
    bool any = move();
    this->Watch();
    if (work)
    {
      any |= work();
    }
    if (any)
    {
      this->Idle.Reset();
    }
    else
    {
      this->Idle.Wait();
    }
  }
}

void Messenger::Internals::PostCopy(int destination, const std::byte* bytes, std::size_t count)
{
  constexpr std::size_t headerRoom = 64; // the transport's
  this->Insist(
    [&]
    {
      std::vector<std::byte> copy;
      copy.reserve(count + headerRoom);
      copy.assign(bytes, bytes + count);
      this->Post(destination, MessageKind::Collective, std::move(copy));
    });
}

// -- Signs of life ---------------------------------------------------------------------------------

Messenger::Internals::Wait::Wait(Internals& self, bool tells)
  : Self(self)
{
  self.Tells = tells;
  self.LastLook = self.LastSign = Clock::now();
}

Messenger::Internals::Wait::~Wait()
{
  if (this->Self.HasTold)
  {
    // Should it not get through, this rank may be given up too early, if it computes for very long.
    this->Self.HasTold = !this->Self.Tell({ Life::Leaving }, false);
  }
}

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
        ? name + " is stuck: none of its tracing threads has done anything for " + seconds + " s."
        : name + " has given no sign of life for " + seconds +
          " s: it is stopped, hangs, or its host is gone.";
      lost.emplace(Status{ rank,
        what +
          " The other ranks do not wait for it any longer; nothing can be drawn until the program "
          "(of a server: pvserver) is restarted. Where ranks may take longer, raise the limit "
          "(DSMSilenceLimit; 0: none).",
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

bool Messenger::Internals::MaySend() const
{
  return this->Carrier->GetUnsentBytes() < MaximumUnsentBytes;
}

// -- Messenger -------------------------------------------------------------------------------------

Messenger::Messenger(std::unique_ptr<Transport> transport, std::size_t pieceBytes)
{
  if (!transport)
  {
    throw Error("A messenger needs a transport. Without MPI, use a loopback group of one.");
  }
  this->Self = std::make_unique<Internals>(std::move(transport), pieceBytes);
}

Messenger::~Messenger() = default;

int Messenger::GetRank() const
{
  return this->Self->Carrier->GetRank();
}

int Messenger::GetSize() const
{
  return this->Self->Carrier->GetSize();
}

int Messenger::GetRanksOnHost()
{
  const std::vector<int>& hosts = this->GetHosts();
  const int mine = hosts[static_cast<std::size_t>(this->GetRank())];
  return static_cast<int>(std::count(hosts.begin(), hosts.end(), mine));
}

int Messenger::GetCoresPerRank()
{
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  return std::max(1, cores / this->GetRanksOnHost());
}

const std::vector<int>& Messenger::GetHosts()
{
  if (this->Self->Hosts.empty())
  {
    std::vector<std::byte> mine;
    this->Insist(
      [&]
      {
        const std::string name = GetHostIdentity();
        const auto* const bytes = reinterpret_cast<const std::byte*>(name.data());
        mine.assign(bytes, bytes + name.size());
      });
    const auto all = this->AllGather(std::move(mine));
    this->Insist([&] { this->Self->Hosts.reserve(all.size()); });
    for (const auto& identity : all)
    {
      this->Self->Hosts.push_back(
        static_cast<int>(std::find(all.begin(), all.end(), identity) - all.begin()));
    }
  }
  return this->Self->Hosts;
}

std::uint32_t Messenger::BeginSession()
{
  this->Self->Changed = true;
  return ++this->Self->Session;
}

std::uint32_t Messenger::GetSession() const
{
  return this->Self->Session;
}

void Messenger::SetHandler(MessageKind kind, Handler handler)
{
  if (kind == MessageKind::Collective)
  {
    throw Error("Collective messages are the messenger's own.");
  }
  this->Self->Handlers[Internals::IndexOf(kind)] = std::move(handler);
  this->Self->Changed = true;
}

void Messenger::Post(int destination, MessageKind kind, std::vector<std::byte> payload)
{
  this->Self->Post(destination, kind, std::move(payload));
}

bool Messenger::Progress()
{
  return this->Self->Progress();
}

void Messenger::ProgressUntil(FunctionRef<bool()> done, FunctionRef<bool()> work)
{
  this->Self->ProgressUntil(done, work);
}

void Messenger::ServeUntil(
  FunctionRef<bool()> done, FunctionRef<bool()> work, FunctionRef<void(std::exception_ptr)> fail)
{
  while (!done())
  {
    try
    {
      this->ProgressUntil(done, work);
    }
    catch (const StepAborted&)
    {
      fail(std::current_exception());
      throw;
    }
    catch (...)
    {
      fail(std::current_exception());
    }
  }
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

void Messenger::Flush()
{
  this->Self->Await([this] { return this->Self->Carrier->GetUnsentBytes() == 0; });
}

void Messenger::Insist(FunctionRef<void()> step)
{
  this->Self->Insist(step);
}

void Messenger::WakeUp()
{
  this->Self->Idle.WakeUp();
}

std::size_t Messenger::GetUnsentBytes() const
{
  return this->Self->Carrier->GetUnsentBytes();
}

bool Messenger::HasUnsent(MessageKind kind) const
{
  return this->Self->Carrier->HasUnsent(kind);
}

std::string Messenger::DescribeException()
{
  try
  {
    throw;
  }
  catch (const std::bad_alloc&)
  {
    return "out of memory. Use more ranks or more hosts, so that each rank holds fewer bytes, or "
           "a smaller cache.";
  }
  catch (const std::exception& exception)
  {
    const std::string text = exception.what();
    return text.empty() ? "an exception without a text" : text;
  }
  catch (...)
  {
    return "an exception of unknown type";
  }
}

} // namespace dsm
