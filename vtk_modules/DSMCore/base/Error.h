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
  /// What went wrong there; empty when nothing did.
  std::string Cause;
  /// Whether every rank failed for this reason.
  bool IsEverywhere = false;

  bool IsOk() const { return this->FailedRank < 0; }
};

/// Another rank has failed where this one was not asked how it fares: all ranks give up what they do
/// together (Messenger::RunStep). Not an Error, which may be the failure of a part: this is to be let
/// through.
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
