// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMRankWatch.h"

#include "vtkPVDSMClientWatch.h"

#include "vtkCommand.h"
#include "vtkMultiProcessController.h"
#include "vtkMultiProcessStream.h"
#include "vtkPVProgressHandler.h"
#include "vtkProcessModule.h"

#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace
{

/// Signals by which a process ends, as a rule.
constexpr std::array<int, 6> Deadly = { SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTERM };

/// Seconds after which a server without one of its ranks ends, if MPI has not ended it.
constexpr std::chrono::seconds Patience(10);
/// Seconds for a rank's connection to the first.
constexpr int ConnectionSeconds = 5;
/// When the first rank is to end, it waits at most so long for the report that another rank has ended before.
constexpr int Turns = 30;
constexpr int TurnMilliseconds = 10;

constexpr std::size_t MostClients = 16;
constexpr int Goodbye = -1; ///< in place of a signal

/// The first that a rank sends.
struct Hello
{
  std::uint64_t Token; ///< of the server: others may connect, too
  int Rank;
  int Process;
  char Host[256];
};

/// Only subclasses know the tag of what the client shows. None is ever made.
struct ShownHandler : vtkPVProgressHandler
{
  static constexpr int Tag = MESSAGE_EVENT_TAG;
};

/// Where the first rank is.
struct Place
{
  std::uint64_t Token;
  int Port; ///< 0: it cannot be reached
  char Host[256];
};

// For the handlers of signals, which must not call much.
std::array<std::atomic<int>, MostClients> Clients;
std::array<std::vector<char>, Deadly.size()>
  OwnEnd; ///< what the first rank sends when it ends by a signal
std::array<struct sigaction, Deadly.size()> Before;
std::atomic<bool> HasTold{ false };
int ToFirst = -1; ///< connection of another rank

void GetHost(char (&host)[256])
{
  std::memset(host, 0, sizeof(host));
  gethostname(host, sizeof(host) - 1);
}

bool SendAll(int connection, const void* data, std::size_t bytes)
{
  const char* next = static_cast<const char*>(data);
  while (bytes > 0)
  {
    const ssize_t sent = send(connection, next, bytes, MSG_NOSIGNAL);
    if (sent <= 0)
    {
      return false;
    }
    next += sent;
    bytes -= static_cast<std::size_t>(sent);
  }
  return true;
}

/// The first call sends to all clients.
void Tell(const std::vector<char>& message)
{
  if (HasTold.exchange(true))
  {
    return;
  }
  for (const std::atomic<int>& client : Clients)
  {
    if (client >= 0)
    {
      SendAll(client, message.data(), message.size());
    }
  }
}

/// The bytes that ParaView's client shows as an error, whatever it waits for (vtkPVProgressHandler::RefreshMessage):
/// tag, length and content, as vtkSocketCommunicator sends them.
std::vector<char> Encode(const std::string& text)
{
  vtkMultiProcessStream stream;
  stream << text << static_cast<int>(vtkCommand::ErrorEvent);
  const std::vector<unsigned char> content = stream.GetRawData();
  const int header[2] = { ShownHandler::Tag, static_cast<int>(content.size()) };
  std::vector<char> bytes(sizeof(header) + content.size());
  std::memcpy(bytes.data(), header, sizeof(header));
  std::copy(content.begin(), content.end(), bytes.begin() + sizeof(header));
  return bytes;
}

/// `signal`: 0 if unknown.
std::string Describe(const Hello& rank, int signal)
{
  const std::string name = "Rank " + std::to_string(rank.Rank) + " of the server (host " +
    rank.Host + ", process " + std::to_string(rank.Process) + ")";
  std::string reason =
    " ended without a message: its host failed, or the system ended it, most often for lack of "
    "memory (dmesg on that host says so).";
  if (signal == SIGTERM)
  {
    reason = " was told to end (signal 15), as when the time of a job is over.";
  }
  else if (signal > 0)
  {
    reason = " ended by signal " + std::to_string(signal) + " (" + strsignal(signal) + ").";
  }
  return "DSM Ray Tracer: " + name + reason +
    " The server cannot continue without it. Start a new server, connect to it, and load the "
    "state.";
}

void OnSignal(int signal)
{
  const auto at =
    static_cast<std::size_t>(std::find(Deadly.begin(), Deadly.end(), signal) - Deadly.begin());
  if (ToFirst >= 0)
  {
    SendAll(ToFirst, &signal, sizeof(signal));
  }
  else
  {
    // MPI ends all ranks when one has ended: that one is to be named.
    for (int turn = 0; signal == SIGTERM && turn < Turns && !HasTold; ++turn)
    {
      poll(nullptr, 0, TurnMilliseconds);
    }
    Tell(OwnEnd[at]);
  }
  sigaction(signal, &Before[at], nullptr);
  raise(signal); // when this handler has returned
}

/// A rank that ends as it should.
void SayGoodbye()
{
  HasTold = true;
  if (ToFirst >= 0)
  {
    SendAll(ToFirst, &Goodbye, sizeof(Goodbye));
  }
}

/// The first rank's thread, until the process ends.
class Watcher
{
public:
  Watcher(int listener, std::uint64_t token)
    : Listener(listener)
    , Token(token)
  {
  }

  void Run()
  {
    while (true)
    {
      std::vector<pollfd> sockets = { { this->Listener, POLLIN, 0 } };
      for (const Rank& rank : this->Ranks)
      {
        sockets.push_back({ rank.Connection, POLLIN, 0 });
      }
      if (poll(sockets.data(), sockets.size(), -1) < 0)
      {
        continue;
      }
      // From the last one, as some may be dropped.
      for (std::size_t at = this->Ranks.size(); at > 0; --at)
      {
        if (sockets[at].revents != 0)
        {
          this->Hear(at - 1);
        }
      }
      if (sockets.front().revents != 0)
      {
        this->Accept();
      }
    }
  }

private:
  struct Rank
  {
    Hello Who;
    int Connection;
    int Signal; ///< that it ends by
  };

  void Accept()
  {
    const int connection = accept(this->Listener, nullptr, nullptr);
    const timeval patience{ ConnectionSeconds, 0 };
    Hello hello;
    if (connection < 0)
    {
      return;
    }
    setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
    if (recv(connection, &hello, sizeof(hello), MSG_WAITALL) == sizeof(hello) &&
      hello.Token == this->Token)
    {
      hello.Host[sizeof(hello.Host) - 1] = '\0';
      this->Ranks.push_back({ hello, connection, 0 });
    }
    else
    {
      close(connection);
    }
  }

  void Hear(std::size_t at)
  {
    Rank& rank = this->Ranks[at];
    int signal = 0;
    if (recv(rank.Connection, &signal, sizeof(signal), MSG_WAITALL) == sizeof(signal) &&
      signal != Goodbye)
    {
      rank.Signal = signal; // it is not over yet
      return;
    }
    const Rank ended = rank;
    close(rank.Connection);
    this->Ranks.erase(this->Ranks.begin() + static_cast<std::ptrdiff_t>(at));
    if (signal != Goodbye && !HasTold)
    {
      const std::string text = Describe(ended.Who, ended.Signal);
      Tell(Encode(text));
      std::fprintf(stderr, "%s\n", text.c_str());
      std::this_thread::sleep_for(Patience);
      kill(getpid(), SIGKILL); // the main thread may wait for that rank
    }
  }

  int Listener;
  std::uint64_t Token;
  std::vector<Rank> Ranks;
};

/// On the first rank.
Place Listen()
{
  Place place{};
  GetHost(place.Host);
  std::random_device random;
  place.Token = (std::uint64_t{ random() } << 32) | random();
  const int listener = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  socklen_t size = sizeof(address);
  if (listener >= 0 && bind(listener, reinterpret_cast<sockaddr*>(&address), size) == 0 &&
    listen(listener, SOMAXCONN) == 0 &&
    getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size) == 0)
  {
    place.Port = ntohs(address.sin_port);
    std::thread([watcher = Watcher(listener, place.Token)]() mutable { watcher.Run(); }).detach();
  }
  else if (listener >= 0)
  {
    close(listener);
  }
  return place;
}

/// On another rank. Returns the connection to the first; negative if there is none.
int Connect(const Place& place, int rank)
{
  Hello hello{ place.Token, rank, static_cast<int>(getpid()), {} };
  GetHost(hello.Host);
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const bool isHere = std::strcmp(hello.Host, place.Host) == 0;
  if (getaddrinfo(
        isHere ? "127.0.0.1" : place.Host, std::to_string(place.Port).c_str(), &hints, &found) != 0)
  {
    return -1;
  }
  const int connection = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  // It limits a connection's beginning, too.
  const timeval patience{ ConnectionSeconds, 0 };
  setsockopt(connection, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof(patience));
  const bool isThere = connection >= 0 &&
    connect(connection, found->ai_addr, found->ai_addrlen) == 0 &&
    SendAll(connection, &hello, sizeof(hello));
  freeaddrinfo(found);
  if (!isThere && connection >= 0)
  {
    close(connection);
  }
  return isThere ? connection : -1;
}

void HandleSignals()
{
  struct sigaction own
  {
  };
  own.sa_handler = &OnSignal;
  sigemptyset(&own.sa_mask);
  for (std::size_t at = 0; at < Deadly.size(); ++at)
  {
    sigaction(Deadly[at], &own, &Before[at]);
  }
  std::atexit(&SayGoodbye);
}

void NoteClients()
{
  const std::vector<int> connections = vtkPVDSMClientWatch::ListConnections();
  for (std::size_t at = 0; at < MostClients; ++at)
  {
    Clients[at] = at < connections.size() ? connections[at] : -1;
  }
}

} // namespace

void vtkPVDSMRankWatch::Start()
{
  static bool hasStarted = false;
  const auto type = vtkProcessModule::GetProcessType();
  auto* const ranks = vtkMultiProcessController::GetGlobalController();
  if (!ranks ||
    (type != vtkProcessModule::PROCESS_SERVER && type != vtkProcessModule::PROCESS_RENDER_SERVER))
  {
    return;
  }
  const int rank = ranks->GetLocalProcessId();
  if (rank == 0)
  {
    NoteClients();
  }
  if (std::exchange(hasStarted, true))
  {
    return;
  }
  Place place{};
  if (rank == 0)
  {
    Hello own{ 0, 0, static_cast<int>(getpid()), {} };
    GetHost(own.Host);
    for (std::size_t at = 0; at < Deadly.size(); ++at)
    {
      OwnEnd[at] = Encode(Describe(own, Deadly[at]));
    }
    place = Listen();
  }
  if (ranks->GetNumberOfProcesses() > 1)
  {
    ranks->Broadcast(reinterpret_cast<char*>(&place), sizeof(place), 0);
  }
  if (rank != 0 && place.Port != 0)
  {
    ToFirst = Connect(place, rank);
  }
  if (rank == 0 || ToFirst >= 0)
  {
    HandleSignals();
  }
}
