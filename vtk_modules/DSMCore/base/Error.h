// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_Error_h
#define dsm_Error_h

#include <stdexcept>
#include <string>

namespace dsm
{

/// A failure that the user can act upon: its text names what is wrong and what to do about it.
class Error : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// The memory that may be taken does not suffice for what is to be kept; the same on every rank. Nothing has
/// changed yet.
class MemoryShortage : public Error
{
public:
  using Error::Error;
};

/// How one rank, or all of them, fared in a collective step.
struct Status
{
  /// The first failing rank, or -1 when every rank succeeded.
  int FailedRank = -1;
  /// Reason of the failure on that rank; empty if the rank did not fail.
  std::string Cause;
  /// True if every rank failed for this reason.
  bool IsEverywhere = false;

  bool IsOk() const { return this->FailedRank < 0; }
};

/// Thrown when another rank has failed at a point where this rank was not waiting for its status: all ranks
/// abandon their common step (Messenger::RunStep). It is not an Error, which may be the failure of a part:
/// callers have to let it pass.
class StepAborted : public std::runtime_error
{
public:
  explicit StepAborted(const Status& outcome)
    : std::runtime_error(outcome.Cause)
    , Rank(outcome.FailedRank)
  {
  }
  int GetFailedRank() const { return this->Rank; }

private:
  int Rank;
};

} // namespace dsm

#endif
