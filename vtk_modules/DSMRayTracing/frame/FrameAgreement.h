// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_FrameAgreement_h
#define rt_FrameAgreement_h

#include "DSMCore/base/Error.h"
#include "DSMCore/transport/Messenger.h"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace rt
{

/// How the ranks of a frame come to its common end: each reports to rank 0 that its workers are
/// through, and how it fared; when all have, rank 0 tells all. When one fails, rank 0 tells the others
/// at once, since they may be waiting for what that rank will never send. Rank 0 may also abort the
/// frame, which is no failure: all ranks finish what they have begun. A rank without memory tells, and
/// hears, the same (Messenger::Insist). Communication thread only.
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
  /// Whether this rank has said so.
  bool HasFailed() const { return this->Failed; }
  /// Rank 0, before the frame is over: no rank begins anything more.
  void Abort();
  /// This rank's workers have stopped. Once a frame.
  void ReportDone();
  bool IsDone() const { return this->Done; }

  /// Whether all ranks have stopped.
  bool IsOver() const { return this->Over; }
  /// The frame's outcome, the same on every rank; valid once it is over. What fails when the last rank
  /// is done counts no more.
  const dsm::Status& GetOutcome() const { return this->Outcome; }
  /// Likewise: whether it was aborted.
  bool IsAborted() const { return this->Aborted; }

private:
  void Tell(const std::string& cause);
  void Collect(int source, std::vector<std::byte>&& cause);
  void Post(int rank, dsm::MessageKind kind, const std::vector<std::byte>& payload);
  void Stop();
  void Cease();
  void End(dsm::Message&& message);

  dsm::Messenger& Messenger;
  std::function<void()> FailureSeen;
  std::function<void()> AbortSeen;
  int Missing;
  bool Failed = false;
  bool Done = false;
  bool Stopped = false;
  bool Aborted = false;
  bool Over = false;
  std::vector<std::byte> Cause; ///< rank 0: of the lowest rank that has failed so far
  dsm::Status Outcome;
};

} // namespace rt

#endif
