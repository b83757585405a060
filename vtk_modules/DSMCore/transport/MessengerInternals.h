// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_MessengerInternals_h
#define dsm_MessengerInternals_h

#include "DSMCore/transport/Attendance.h"
#include "DSMCore/transport/BackOff.h"
#include "DSMCore/transport/Messenger.h"

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <list>
#include <memory>
#include <vector>

namespace dsm
{

/// Sessions are compared by distance, so that their number may wrap around.
inline std::int32_t Distance(std::uint32_t from, std::uint32_t to)
{
  return static_cast<std::int32_t>(to - from);
}

/// Received messages that have not been processed, and their handlers. Messages are kept in lists,
/// so that moving one needs no memory: a message that has arrived cannot be lost for lack of
/// memory.
class Messenger::Internals
{
public:
  Internals(std::unique_ptr<Transport> transport, std::size_t pieceBytes);

  static std::size_t IndexOf(MessageKind kind);

  void Post(int destination, MessageKind kind, std::vector<std::byte> payload);
  bool Progress();
  void ProgressUntil(FunctionRef<bool()> done, FunctionRef<bool()> work);
  void Insist(FunctionRef<void()> step);

  void ServeAll(bool doServe);
  void GiveUpThisRank();

  // -- For collectives --

  /// Begins a session, runs `exchange` in it, and leaves when the own messages have left too.
  void RunCollective(FunctionRef<void()> exchange);
  /// ProgressUntil that throws only what `work` throws: what handlers throw waits for Progress, and
  /// what does not get through for the lack of memory is tried again.
  void Await(FunctionRef<bool()> done, FunctionRef<bool()> work = {});
  /// The loop of both: `move` moves messages, and returns whether any moved.
  void MoveUntil(FunctionRef<bool()> done, FunctionRef<bool()> move, FunctionRef<bool()> work,
    BackOff::Patience patience);
  /// Posts a copy.
  void PostCopy(int destination, const std::byte* bytes, std::size_t count);
  /// Rank 0's bytes to all, along a binomial tree.
  void SpreadFromRankZero(std::vector<std::byte>& bytes);
  /// Returns whether there is room for one more outgoing piece.
  bool MaySend() const;

  std::unique_ptr<Transport> Carrier;
  std::array<Handler, static_cast<std::size_t>(MessageKind::Last) + 1> Handlers;
  std::size_t PieceBytes;
  double SilenceLimit = DefaultSilenceLimit; ///< seconds
  std::uint32_t Session = 0;
  std::list<Message> Received; ///< messages of the current collective
  bool Changed = false;        ///< true if a message in the inbox may have become due
  std::vector<int> Hosts;      ///< empty: not compared yet
  BackOff Idle;

private:
  using Clock = std::chrono::steady_clock;

  /// Content of a heartbeat message.
  enum class Life : std::int32_t
  {
    Waiting,
    Leaving, ///< no longer waits
    Lost     ///< a rank is treated as failed
  };
  struct Sign
  {
    Life Says = Life::Waiting;
    std::int32_t LostRank = -1;
    std::int32_t IsStuck = 0; ///< it says so itself
  };

  /// In scope while this rank waits. `tells`: and does nothing else for long.
  class Wait
  {
  public:
    Wait(Internals& self, bool tells);
    ~Wait();
    Wait(const Wait&) = delete;
    Wait& operator=(const Wait&) = delete;

  private:
    Internals& Self;
  };

  /// Seconds between signs of life.
  double GetInterval() const;
  void Watch();
  void TakeSign(const Message& message);
  void GiveUp(Sign loss);
  /// To those that count on this rank. Returns whether it was possible.
  bool Tell(Sign sign, bool all) noexcept;
  void ThrowIfLost();

  bool Move();
  bool Dispatch();
  bool Treat(std::list<Message>& message);
  void Keep(std::exception_ptr failure);

  std::list<Message> Inbox;
  bool Dispatching = false;
  bool Deferring = false;
  Attendance Others;
  bool IsServing = false;
  std::uint32_t ServingSince = 0; ///< session
  Sign Loss;                      ///< once a rank is lost
  bool Tells = false;             ///< while it waits
  bool HasTold = false;           ///< that it does
  Clock::time_point LastLook;
  Clock::time_point LastSign;
  std::exception_ptr Deferred;
  std::unique_ptr<std::byte[]> Reserve; ///< untouched
};

/// Contributions of the ranks; empty if any rank has failed.
struct Messenger::Gathered
{
  Status Outcome;
  bool IsStepOver = false;
  std::vector<std::vector<std::byte>> Parts;
};

} // namespace dsm

#endif
