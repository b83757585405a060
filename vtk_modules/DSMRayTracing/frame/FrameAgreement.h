// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_FrameAgreement_h
#define rt_FrameAgreement_h

#include "DSMCore/base/Error.h"
#include "DSMCore/transport/Messenger.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace rt
{

/// How the ranks of a frame come to its common end. Each reports to rank 0 that its workers are done, and the
/// result. When all have, rank 0 sends all reports to all ranks, along a tree. When one fails, rank 0 notifies the
/// others at once, since they may be waiting for messages that the rank will never send. Rank 0 may also abort the
/// frame, which does not count as a failure: all ranks finish what they have begun. A rank without memory sends and
/// receives the same (Messenger::Insist). Communication thread only.
class FrameAgreement
{
public:
  /// `failureSeen` is called once, as soon as this rank hears that another one has failed.
  /// `abortSeen` likewise, on every rank, when the frame is aborted.
  FrameAgreement(dsm::Messenger& messenger, std::function<void()> failureSeen,
    std::function<void()> abortSeen = {});
  ~FrameAgreement();

  /// This rank has failed, for a cause that is not empty; the first one counts. Before or after it is
  /// done: it may fail while it serves the others.
  void ReportFailure(const std::string& cause);
  /// Returns whether this rank has reported a failure.
  bool HasFailed() const { return this->Failed; }
  /// Rank 0, before the frame is over: no rank begins anything more.
  void Abort();
  /// This rank's workers have stopped. Once a frame. `report`: bytes for all ranks; few, for rank 0 gets those of all.
  void ReportDone(std::vector<std::byte> report = {});
  bool IsDone() const { return this->Done; }

  /// Returns whether all ranks have stopped.
  bool IsOver() const { return this->Over; }
  /// The frame's outcome, the same on every rank; valid once it is over. Failures after the last rank is done do
  /// not count.
  const dsm::Status& GetOutcome() const { return this->Outcome; }
  /// Returns, likewise, whether the frame was aborted.
  bool IsAborted() const { return this->Aborted; }
  /// Returns, likewise, every rank's report, in rank order. There are none for a frame that failed or was
  /// aborted.
  std::vector<std::vector<std::byte>> TakeReports() { return std::move(this->Reports); }

private:
  enum class Tale : std::uint32_t
  {
    Failure,
    Done
  };
  void Tell(Tale tale, std::vector<std::byte>&& bytes);
  void Collect(int source, Tale tale, std::vector<std::byte>&& bytes);
  void CollectCause(int source, std::vector<std::byte>&& cause);
  void TellEnd();
  void SpreadEnd(const std::vector<std::byte>& bytes);
  void Post(int rank, dsm::MessageKind kind, const std::vector<std::byte>& payload);
  void Stop();
  void Cease();
  void End(std::vector<std::byte>&& bytes);
  void Unpack(std::vector<std::byte>& bytes);

  dsm::Messenger& Messenger;
  std::function<void()> FailureSeen;
  std::function<void()> AbortSeen;
  int Missing;
  bool Failed = false;
  bool Done = false;
  bool Stopped = false;
  bool Aborted = false;
  bool Over = false;
  std::vector<int> Children;    ///< this rank hands the end on to them
  std::vector<std::byte> Cause; ///< rank 0: of the lowest rank that has failed so far
  std::vector<std::vector<std::byte>> Reports;
  dsm::Status Outcome;
};

} // namespace rt

#endif
