// SPDX-License-Identifier: BSD-3-Clause
// Steps that all ranks take together, and that fail on all if they fail on one.
#include "DSMCore/transport/MessengerInternals.h"

#include "DSMCore/base/FirstFailure.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

namespace dsm
{

namespace
{

/// Largest length of a rank's error text that is sent to all others.
constexpr std::size_t LongestCause = std::size_t(16) << 10;

} // namespace

Status Messenger::Agree(const std::string& cause)
{
  std::vector<std::byte> mine;
  this->Insist(
    [&]
    {
      const auto* const bytes = reinterpret_cast<const std::byte*>(cause.data());
      mine.assign(bytes, bytes + std::min(cause.size(), LongestCause));
    });
  return this->Gather(
               std::move(mine), cause.empty() ? Faring::Well : Faring::Failed, Receivers::All)
    .Outcome;
}

std::vector<std::byte> Messenger::ToCause(const FirstFailure& failure)
{
  std::vector<std::byte> bytes;
  this->Insist(
    [&]
    {
      std::string cause;
      try
      {
        failure.Throw();
      }
      catch (...)
      {
        cause = DescribeException();
      }
      const auto* const first = reinterpret_cast<const std::byte*>(cause.data());
      bytes.assign(first, first + std::min(cause.size(), LongestCause));
    });
  return bytes;
}

/// For this rank alone.
Status Messenger::ToStatus(const FirstFailure& failure)
{
  Status status;
  if (!failure.IsEmpty())
  {
    const std::vector<std::byte> cause = this->ToCause(failure);
    status.FailedRank = this->GetRank();
    status.IsEverywhere = this->GetSize() == 1;
    this->Insist(
      [&] { status.Cause.assign(reinterpret_cast<const char*>(cause.data()), cause.size()); });
  }
  return status;
}

Status Messenger::RunStep(FunctionRef<void()> step, const bool& isOver)
{
  FirstFailure failure;
  try
  {
    try
    {
      step();
    }
    catch (const StepAborted&)
    {
      throw;
    }
    catch (...)
    {
      failure.Keep(std::current_exception());
    }
    if (isOver)
    {
      return this->ToStatus(failure);
    }
    return failure.IsEmpty()
      ? this->Exchange({}, Faring::Well, Receivers::All).Outcome
      : this->Exchange(this->ToCause(failure), Faring::Left, Receivers::All).Outcome;
  }
  catch (const StepAborted& aborted)
  {
    Status status;
    this->Insist([&] { status = Status{ aborted.GetFailedRank(), aborted.what(), false }; });
    return status;
  }
}

void Messenger::RunTogether(std::string_view what, FunctionRef<void()> step)
{
  this->GatherTogether(what,
    [&]
    {
      step();
      return std::vector<std::byte>();
    });
}

std::vector<std::vector<std::byte>> Messenger::GatherTogether(
  std::string_view what, FunctionRef<std::vector<std::byte>()> make)
{
  return this->GatherMade(what, make, Receivers::All);
}

std::vector<std::vector<std::byte>> Messenger::GatherOnRankZero(
  std::string_view what, FunctionRef<std::vector<std::byte>()> make)
{
  return this->GatherMade(what, make, Receivers::RankZero);
}

std::vector<std::vector<std::byte>> Messenger::GatherMade(
  std::string_view what, FunctionRef<std::vector<std::byte>()> make, Receivers receivers)
{
  std::vector<std::byte> mine;
  FirstFailure failure;
  failure.Try([&] { mine = make(); });
  const Faring faring = failure.IsEmpty() ? Faring::Well : Faring::Failed;
  Gathered gathered =
    this->Gather(failure.IsEmpty() ? std::move(mine) : this->ToCause(failure), faring, receivers);
  const Status& status = gathered.Outcome;
  if (!status.IsOk())
  {
    std::optional<Error> error;
    this->Insist(
      [&]
      {
        error.emplace(std::string(what) + ": " +
          (status.IsEverywhere ? std::string()
                               : "Rank " + std::to_string(status.FailedRank) + ": ") +
          status.Cause);
      });
    throw *error;
  }
  return std::move(gathered.Parts);
}

} // namespace dsm
