// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_Messenger_h
#define dsm_Messenger_h

#include "DSMCore/base/Error.h"
#include "DSMCore/base/FirstFailure.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/transport/Message.h"
#include "DSMCore/transport/Transport.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
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

  /// Largest number of bytes in one message of a collective; more data are sent in pieces. It is
  /// smaller than the buffer that a transport keeps for a rank without memory.
  static constexpr std::size_t DefaultPieceBytes = std::size_t(1) << 19;

  /// `pieceBytes`: the same on every rank.
  explicit Messenger(
    std::unique_ptr<Transport> transport, std::size_t pieceBytes = DefaultPieceBytes);
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

  // -- Ranks that are stopped, hang, or are gone -------------------------------------------------- A rank that
  // does nothing but wait reports it to rank 0, and rank 0 to all, now and then, and when the wait ends; in
  // ProgressUntil with work, only while all serve. If a rank that must report (Attendance) is silent for too long,
  // all treat it as failed: every wait, and every collective step from then on, throws a StepAborted that names the
  // rank and the remedy.

  static constexpr double DefaultSilenceLimit = 60.0;
  /// Seconds that a rank may be silent; 0: for ever. Between steps; the same on every rank.
  void SetSilenceLimit(double seconds);
  double GetSilenceLimit() const;
  /// Reports that this rank cannot continue: all ranks, itself included, treat it as failed.
  void GiveUpThisRank();

  /// From here on every rank serves the others, and computes nothing for long, until EndServing. Each
  /// rank by itself, when it knows that all are there, or will be at once.
  void BeginServing();
  void EndServing();

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
  void ProgressUntil(FunctionRef<bool()> done, FunctionRef<bool()> work = {});

  /// ProgressUntil for what other ranks rely on: an exception, such as of a message that is lost or rejected, is
  /// this rank's failure; `fail` gets it, and this rank continues to serve. A StepAborted is passed to `fail` and
  /// thrown.
  void ServeUntil(
    FunctionRef<bool()> done, FunctionRef<bool()> work, FunctionRef<void(std::exception_ptr)> fail);

  /// Waits until all that was posted has left this rank. Fails only as a collective step does.
  void Flush();

  /// Runs a step between two agreements, which other ranks count on and which needs but little memory: when it
  /// throws, it is tried again with the memory of a reserve, and then until there is some. If it still throws after
  /// ten seconds, so does Insist.
  void Insist(FunctionRef<void()> step);

  /// The ranks that this one hands on to what comes from rank 0, so that it reaches all along a tree.
  std::vector<int> GetChildren() const;

  /// Any thread: there is something to do for the communication thread.
  void WakeUp();

  std::size_t GetUnsentBytes() const;

  /// See Transport::HasUnsent.
  bool HasUnsent(MessageKind kind) const;

  // -- Collectives; each begins sessions of its own ----------------------------------------------- They throw the
  // same on every rank, or on none: a rank without memory takes part with a reserve (Insist), and what a larger
  // result takes is set aside by all, or by none. StepAborted, too: see RunStep. Results may have any size. If a
  // handler throws while a collective waits, the next Progress rethrows it.

  /// Every rank's bytes, in rank order, on every rank.
  std::vector<std::vector<std::byte>> AllGather(std::vector<std::byte> mine);

  /// Rank 0's bytes on every rank.
  std::vector<std::byte> Broadcast(std::vector<std::byte> fromRankZero);

  /// Makes each number the sum of those of all ranks, which must have as many. Takes no more memory than
  /// a few pieces.
  void Sum(std::vector<std::uint64_t>& numbers);

  /// The same with `combine(value, other)` in place of the sum, which changes the first, and does not throw. Values
  /// are combined along a tree in any order, on which the result must not depend.
  template <class T, class Combine>
  void Reduce(std::vector<T>& values, const Combine& combine)
  {
    static_assert(std::is_trivially_copyable_v<T>);
    this->ReduceBytes(reinterpret_cast<std::byte*>(values.data()), values.size(), sizeof(T),
      [&](std::size_t first, const std::byte* others, std::size_t count)
      {
        for (std::size_t index = 0; index < count; ++index)
        {
          T other;
          std::memcpy(&other, others + index * sizeof(T), sizeof(T));
          combine(values[first + index], other);
        }
      });
  }

  void Barrier();

  /// All ranks learn of the lowest rank that failed, and why. `cause` empty means success.
  Status Agree(const std::string& cause);

  /// Runs `step` on this rank, turns whatever it throws (bad_alloc too) into a cause, agrees, and
  /// throws the same Error on every rank when any failed: collectives fail collectively. Its text
  /// is "`what`: Rank 2: cause", without the rank when every rank failed for the same reason.
  void RunTogether(std::string_view what, FunctionRef<void()> step);

  /// Runs a step that the ranks do together, and returns how it went, the same on every rank. An exception of
  /// `step` ends it for all, also if only one rank throws: ranks that wait for that rank in another collective
  /// leave it by a StepAborted, which `step` must let through. Between the collectives of a step anything may be
  /// thrown, except where the next thing is BeginSession. `isOver`: `step` sets it when the ranks have just agreed
  /// that all went well, and what is left needs no memory. Then nothing more is exchanged. An exception that `step`
  /// throws after that is the outcome of this rank alone, which reports it in the next step.
  Status RunStep(FunctionRef<void()> step, const bool& isOver = false);

  /// AllGather of what `make` returns; what it throws is treated as by RunTogether.
  std::vector<std::vector<std::byte>> GatherTogether(
    std::string_view what, FunctionRef<std::vector<std::byte>()> make);

  /// The same for rank 0 alone; the others get empty bytes. Large messages go to rank 0 only.
  std::vector<std::vector<std::byte>> GatherOnRankZero(
    std::string_view what, FunctionRef<std::vector<std::byte>()> make);

  /// The text for the exception that is being handled; for use in a catch block.
  static std::string DescribeException();

  /// Every rank's value, in rank order.
  template <class T>
  std::vector<T> AllGatherValue(const T& mine)
  {
    std::vector<std::byte> bytes;
    this->Insist([&] { bytes = Encode(mine); });
    return this->DecodeParts<T>(this->AllGather(std::move(bytes)));
  }

  /// The values that `make` returns, likewise; what it throws is treated as by RunTogether.
  template <class Make>
  auto GatherValueTogether(std::string_view what, const Make& make)
  {
    return this->DecodeParts<decltype(make())>(
      this->GatherTogether(what, [&] { return Encode(make()); }));
  }

private:
  /// Combines `count` values of another rank with this rank's from the first on.
  using Combination =
    FunctionRef<void(std::size_t first, const std::byte* others, std::size_t count)>;
  void ReduceBytes(
    std::byte* values, std::size_t count, std::size_t valueBytes, Combination combine);

  template <class T>
  std::vector<T> DecodeParts(const std::vector<std::vector<std::byte>>& parts)
  {
    std::vector<T> values;
    this->Insist([&] { values.resize(parts.size()); });
    for (std::size_t rank = 0; rank < parts.size(); ++rank)
    {
      if (parts[rank].size() != sizeof(T))
      {
        throw Error("A rank gave " + std::to_string(parts[rank].size()) + " bytes where " +
          std::to_string(sizeof(T)) + " were expected. Do all ranks run the same build?");
      }
      std::memcpy(&values[rank], parts[rank].data(), sizeof(T));
    }
    return values;
  }

  enum class Faring : std::uint64_t
  {
    Well,
    Failed, ///< so do all in this collective
    Left    ///< this rank is somewhere else: all end the step
  };
  enum class Receivers
  {
    All,
    RankZero
  };
  struct Gathered;
  std::vector<std::byte> ToCause(const FirstFailure& failure);
  Status ToStatus(const FirstFailure& failure);
  Gathered Exchange(std::vector<std::byte>&& mine, Faring faring, Receivers receivers);
  Gathered Gather(std::vector<std::byte>&& mine, Faring faring, Receivers receivers);
  std::vector<std::vector<std::byte>> GatherPieces(
    std::vector<std::byte>&& mine, std::vector<std::uint64_t> sizes, Receivers receivers);
  std::vector<std::vector<std::byte>> GatherMade(
    std::string_view what, FunctionRef<std::vector<std::byte>()> make, Receivers receivers);

  class Internals;
  std::unique_ptr<Internals> Self;
};

} // namespace dsm

#endif
