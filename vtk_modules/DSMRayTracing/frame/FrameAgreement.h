// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_FrameAgreement_h
#define rt_FrameAgreement_h

#include "DSMCore/Error.h"
#include "DSMCore/Messenger.h"

#include <functional>
#include <string>

namespace rt
{

/// How the ranks of a frame come to its common end: each reports to rank 0 that its workers are
/// through, and how it fared; when all have, rank 0 tells all. Communication thread only.
class FrameAgreement
{
public:
  /// `failureSeen` is called on rank 0 as soon as any rank reports a failure.
  FrameAgreement(dsm::Messenger& messenger, std::function<void()> failureSeen);
  ~FrameAgreement();

  /// This rank's workers have stopped; `cause` is empty when all went well. Once a frame.
  void ReportDone(const std::string& cause);
  bool HasReported() const { return this->Reported; }

  /// Whether all ranks have stopped.
  bool IsOver() const { return this->Over; }
  /// The frame's outcome, the same on every rank; valid once it is over.
  const dsm::Status& GetOutcome() const { return this->Outcome; }

private:
  void Collect(int source, const std::string& cause);
  void End(dsm::Message&& message);

  dsm::Messenger& Messenger;
  std::function<void()> FailureSeen;
  int Missing;
  bool Reported = false;
  bool Over = false;
  dsm::Status Outcome;
};

} // namespace rt

#endif
