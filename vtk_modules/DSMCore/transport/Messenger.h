// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_Messenger_h
#define dsm_Messenger_h

#include "DSMCore/base/Error.h"
#include "DSMCore/transport/Message.h"
#include "DSMCore/transport/Transport.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace dsm
{

/// Dispatches the messages of one transport to their handlers and offers the collectives that are
/// built on them. One per process and communicator; shared by all that use the communicator. All
/// but WakeUp is for the communication thread alone.
///
/// Collective steps are numbered: every rank calls BeginSession in the same order, so equal numbers
/// mean the same step everywhere. A message of a later session than the current one is kept until
/// that session begins; one of the current session is kept until its kind has a handler; one of an
/// earlier session is handed over as long as a handler stands (a block request is valid at any
/// time; other handlers look at Message::Session) and dropped otherwise. Messages of one rank and
/// kind are handed over in the order in which they were posted.
///
/// Handlers may Post and SetHandler, but not Progress nor call collectives.
class Messenger
{
public:
  using Handler = std::function<void(Message&&)>;

  explicit Messenger(std::unique_ptr<Transport> transport);
  ~Messenger();
  Messenger(const Messenger&) = delete;
  Messenger& operator=(const Messenger&) = delete;

  int GetRank() const;
  int GetSize() const;

  /// Ranks that run on this rank's host, itself included. The first call is collective: it compares
  /// host names and boot identities; later ones answer from memory.
  int GetRanksOnHost();

  /// The cores of this rank's host divided by the ranks on it, at least 1: threads that each of them
  /// may have. Collective the first time.
  int GetCoresPerRank();

  /// For every rank the lowest rank of its host. Collective like GetRanksOnHost.
  const std::vector<int>& GetHosts();

  /// Enters the next collective step; the next Progress delivers what arrived early for it.
  /// Collective in order; does not wait. Returns the session's number.
  std::uint32_t BeginSession();

  /// The number of the session that was begun last; 0 before the first.
  std::uint32_t GetSession() const;

  /// Replaces the handler of a kind; an empty one removes it. Collective messages are the
  /// messenger's own.
  void SetHandler(MessageKind kind, Handler handler);

  /// Posts in the current session.
  void Post(int destination, MessageKind kind, std::vector<std::byte> payload);

  /// Moves messages once; returns whether anything happened. Rethrows what a handler threw; the
  /// messages behind are kept for the next call. Throws Error for a message of no known kind.
  bool Progress();

  /// Progress, and `work` (which returns whether it did anything), until `done` holds; backs off to
  /// short sleeps while nothing happens, so that a rank that waits does not starve the tracing
  /// threads of a host that it shares. WakeUp ends a sleep early.
  void ProgressUntil(const std::function<bool()>& done, const std::function<bool()>& work = {});

  /// ProgressUntil for what other ranks rely on: an exception, such as of a message that is lost or
  /// rejected, is this rank's failure, told to `fail` by its text, and this rank goes on serving.
  void ServeUntil(const std::function<bool()>& done, const std::function<bool()>& work,
    const std::function<void(const std::string&)>& fail);

  /// Any thread: there is something to do for the communication thread.
  void WakeUp();

  std::size_t GetUnsentBytes() const;

  /// See Transport::HasUnsent.
  bool HasUnsent(MessageKind kind) const;

  // -- Collectives; each begins a session of its own -----------------------------------------------
  // What another handler throws while a collective waits is rethrown when the collective is
  // complete, so that no other rank is left waiting for this one.

  /// Every rank's bytes, in rank order, on every rank.
  std::vector<std::vector<std::byte>> AllGather(std::vector<std::byte> mine);

  /// Rank 0's bytes on every rank.
  std::vector<std::byte> Broadcast(std::vector<std::byte> fromRankZero);

  void Barrier();

  /// All ranks learn of the lowest rank that failed, and why. `cause` empty means success.
  Status Agree(const std::string& cause);

  /// Runs `step` on this rank, turns whatever it throws (bad_alloc too) into a cause, agrees, and
  /// throws the same Error on every rank when any failed: collectives fail collectively. Its text
  /// is "`what`: Rank 2: cause", without the rank when every rank failed for the same reason.
  void RunTogether(const std::string& what, const std::function<void()>& step);

  /// The text for the exception that is being handled; for use in a catch block.
  static std::string DescribeException();

  /// Every rank's value, in rank order.
  template <class T>
  std::vector<T> AllGatherValue(const T& mine)
  {
    std::vector<T> values;
    for (const auto& bytes : this->AllGather(Encode(mine)))
    {
      if (bytes.size() != sizeof(T))
      {
        throw Error("A rank gave " + std::to_string(bytes.size()) + " bytes where " +
          std::to_string(sizeof(T)) + " were expected. Do all ranks run the same build?");
      }
      T value;
      std::memcpy(&value, bytes.data(), sizeof(T));
      values.push_back(value);
    }
    return values;
  }

private:
  class Internals;
  std::unique_ptr<Internals> Self;
};

} // namespace dsm

#endif
