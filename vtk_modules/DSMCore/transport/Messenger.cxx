// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/transport/Messenger.h"

#include "DSMCore/transport/BackOff.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <deque>
#include <exception>
#include <fstream>
#include <iterator>
#include <new>
#include <thread>
#include <utility>

namespace dsm
{

namespace
{

constexpr std::size_t Kinds = static_cast<std::size_t>(MessageKind::Last) + 1;

std::size_t IndexOf(MessageKind kind)
{
  const std::size_t index = static_cast<std::size_t>(kind);
  if (index == 0 || index >= Kinds)
  {
    throw Error(
      "There is no message kind " + std::to_string(index) + ". Do all ranks run the same build?");
  }
  return index;
}

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

class Messenger::Internals
{
public:
  explicit Internals(std::unique_ptr<Transport> transport)
    : Carrier(std::move(transport))
  {
    this->Handlers[IndexOf(MessageKind::Collective)] = [this](Message&& message)
    {
      // Older ones were left behind by a collective that failed here.
      if (message.Session == this->Session)
      {
        this->Received.push_back(std::move(message));
      }
    };
  }

  void Post(int destination, MessageKind kind, std::vector<std::byte> payload)
  {
    IndexOf(kind);
    Message message;
    message.Kind = kind;
    message.Session = this->Session;
    message.Source = this->Carrier->GetRank();
    message.Payload = std::move(payload);
    this->Carrier->Post(destination, std::move(message));
  }

  bool Progress()
  {
    if (this->Dispatching)
    {
      throw Error("A message handler waited for messages; only the code around it may.");
    }
    const bool moved = this->Carrier->Progress(
      [this](Message&& message)
      {
        this->Inbox.push_back(std::move(message));
        this->Changed = true;
      });
    return this->Dispatch() || moved;
  }

  void ProgressUntil(const std::function<bool()>& done, const std::function<bool()>& work)
  {
    this->Idle.Reset();
    while (!done())
    {
      bool any = this->Progress();
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

  /// Collective: begins a session, runs `exchange` in it, and leaves when the own messages have
  /// left too. An exception of a handler waits until then.
  void RunCollective(const std::function<void()>& exchange)
  {
    ++this->Session;
    this->Changed = true;
    this->Received.clear();
    this->Deferring = true;
    try
    {
      exchange();
      this->ProgressUntil(
        [this] { return !this->Carrier->HasUnsent(MessageKind::Collective); }, {});
    }
    catch (...)
    {
      this->Deferring = false;
      throw;
    }
    this->Deferring = false;
    if (this->Deferred)
    {
      std::rethrow_exception(std::exchange(this->Deferred, nullptr));
    }
  }

  /// Rank 0's bytes to all along a binomial tree: rank r hears from r without its lowest bit.
  void SpreadFromRankZero(std::vector<std::byte>& bytes)
  {
    const int rank = this->Carrier->GetRank();
    const int size = this->Carrier->GetSize();
    const int lowest = rank == 0 ? size : (rank & -rank);
    if (rank != 0)
    {
      this->ProgressUntil([this] { return !this->Received.empty(); }, {});
      bytes = std::move(this->Received.front().Payload);
      this->Received.clear();
    }
    for (int step = 1; step < lowest && rank + step < size; step *= 2)
    {
      this->Post(rank + step, MessageKind::Collective, bytes);
    }
  }

  std::unique_ptr<Transport> Carrier;
  std::array<Handler, Kinds> Handlers;
  std::uint32_t Session = 0;
  std::vector<Message> Received; ///< of the collective under way
  bool Changed = false;          ///< whether a message in the inbox may have become due
  std::vector<int> Hosts;        ///< empty: not compared yet
  BackOff Idle;

private:
  /// Hands over what is due, oldest first, and drops what has become useless.
  bool Dispatch()
  {
    bool any = false;
    while (this->Changed)
    {
      this->Changed = false;
      std::deque<Message> arrived;
      arrived.swap(this->Inbox);
      while (!arrived.empty())
      {
        Message message = std::move(arrived.front());
        arrived.pop_front();
        try
        {
          any |= this->Treat(std::move(message));
        }
        catch (...)
        {
          if (!this->Deferring)
          {
            // Keep the order: what waits already, then what was not looked at yet.
            std::move(arrived.begin(), arrived.end(), std::back_inserter(this->Inbox));
            this->Changed = true;
            throw;
          }
          if (!this->Deferred)
          {
            this->Deferred = std::current_exception();
          }
        }
      }
    }
    return any;
  }

  bool Treat(Message&& message)
  {
    Handler& handler = this->Handlers[IndexOf(message.Kind)];
    const std::int32_t ahead = Distance(this->Session, message.Session);
    if (ahead > 0 || (ahead == 0 && !handler))
    {
      this->Inbox.push_back(std::move(message));
      return false;
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

  std::deque<Message> Inbox;
  bool Dispatching = false;
  bool Deferring = false;
  std::exception_ptr Deferred;
};

Messenger::Messenger(std::unique_ptr<Transport> transport)
{
  if (!transport)
  {
    throw Error("A messenger needs a transport. Without MPI, use a loopback group of one.");
  }
  this->Self = std::make_unique<Internals>(std::move(transport));
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
    const std::string mine = GetHostIdentity();
    const auto* bytes = reinterpret_cast<const std::byte*>(mine.data());
    const auto all = this->AllGather(std::vector<std::byte>(bytes, bytes + mine.size()));
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
  this->Self->Handlers[IndexOf(kind)] = std::move(handler);
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

void Messenger::ProgressUntil(const std::function<bool()>& done, const std::function<bool()>& work)
{
  this->Self->ProgressUntil(done, work);
}

void Messenger::ServeUntil(const std::function<bool()>& done, const std::function<bool()>& work,
  const std::function<void(const std::string&)>& fail)
{
  while (!done())
  {
    try
    {
      this->ProgressUntil(done, work);
    }
    catch (...)
    {
      fail(DescribeException());
    }
  }
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

std::vector<std::vector<std::byte>> Messenger::AllGather(std::vector<std::byte> mine)
{
  const std::size_t size = static_cast<std::size_t>(this->GetSize());
  std::vector<std::vector<std::byte>> parts(size);
  if (size == 1)
  {
    this->BeginSession();
    parts[0] = std::move(mine);
    return parts;
  }
  // Packed: the size of every part as 64 bits, then the parts.
  std::vector<std::byte> packed;
  this->Self->RunCollective(
    [&]
    {
      if (this->GetRank() == 0)
      {
        this->Self->ProgressUntil([&] { return this->Self->Received.size() == size - 1; }, {});
        parts[0] = std::move(mine);
        for (Message& message : this->Self->Received)
        {
          parts[message.Source] = std::move(message.Payload);
        }
        for (const auto& part : parts)
        {
          AttachTail(packed, static_cast<std::uint64_t>(part.size()));
        }
        for (const auto& part : parts)
        {
          packed.insert(packed.end(), part.begin(), part.end());
        }
      }
      else
      {
        this->Post(0, MessageKind::Collective, std::move(mine));
      }
      this->Self->SpreadFromRankZero(packed);
    });
  if (this->GetRank() != 0)
  {
    std::vector<std::uint64_t> sizes(size);
    std::memcpy(sizes.data(), packed.data(), size * sizeof(std::uint64_t));
    auto next = packed.begin() + static_cast<std::ptrdiff_t>(size * sizeof(std::uint64_t));
    for (std::size_t rank = 0; rank < size; ++rank)
    {
      parts[rank].assign(next, next + static_cast<std::ptrdiff_t>(sizes[rank]));
      next += static_cast<std::ptrdiff_t>(sizes[rank]);
    }
  }
  return parts;
}

std::vector<std::byte> Messenger::Broadcast(std::vector<std::byte> fromRankZero)
{
  this->Self->RunCollective([&] { this->Self->SpreadFromRankZero(fromRankZero); });
  return fromRankZero;
}

void Messenger::Barrier()
{
  this->AllGather({});
}

Status Messenger::Agree(const std::string& cause)
{
  const auto* bytes = reinterpret_cast<const std::byte*>(cause.data());
  const auto causes = this->AllGather(std::vector<std::byte>(bytes, bytes + cause.size()));
  Status status;
  for (std::size_t rank = 0; rank < causes.size(); ++rank)
  {
    if (!causes[rank].empty())
    {
      status.FailedRank = static_cast<int>(rank);
      status.Cause.assign(reinterpret_cast<const char*>(causes[rank].data()), causes[rank].size());
      status.IsEverywhere = std::all_of(
        causes.begin(), causes.end(), [&](const auto& other) { return other == causes[rank]; });
      break;
    }
  }
  return status;
}

void Messenger::RunTogether(const std::string& what, const std::function<void()>& step)
{
  std::string cause;
  try
  {
    step();
  }
  catch (...)
  {
    cause = DescribeException();
  }
  const Status status = this->Agree(cause);
  if (!status.IsOk())
  {
    throw Error(what + ": " +
      (status.IsEverywhere ? std::string() : "Rank " + std::to_string(status.FailedRank) + ": ") +
      status.Cause);
  }
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
