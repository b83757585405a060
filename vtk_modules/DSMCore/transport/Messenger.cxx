// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/transport/MessengerInternals.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <new>
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

/// Limit of unsent bytes of a collective; above it, a rank posts no further messages.
constexpr std::size_t MaximumUnsentBytes = std::size_t(8) << 20;

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
    throw Error("A message handler must not wait for messages. This is a bug in the program.");
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
  this->MoveUntil(
    done, [this] { return this->Progress(); }, work, BackOff::Patience::Short);
}

void Messenger::Internals::MoveUntil(FunctionRef<bool()> done, FunctionRef<bool()> move,
  FunctionRef<bool()> work, BackOff::Patience patience)
{
  this->Idle.Reset(patience);
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
      this->Idle.Reset(patience);
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
      // The transport has no memory. It has lost nothing, and receives the message the next time.
    }
    catch (...)
    {
      this->Keep(std::current_exception());
    }
    this->Deferring = false;
    return any;
  };
  const Wait wait(*this, true);
  this->MoveUntil(done, move, work, work ? BackOff::Patience::Short : BackOff::Patience::Long);
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
    throw Error("Only the messenger can handle collective messages.");
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
    return "out of memory. Use more ranks, more hosts, or a smaller cache.";
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
