// SPDX-License-Identifier: BSD-3-Clause
// Runs the tests of one executable on every rank. What fails on one rank fails the run on all.
#include "DSMCore/transport/Messenger.h"
#include "DSMCore/transport/MpiTransport.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>

namespace
{

/// A rank that leaves a test early (a fatal failure, an exception) would keep the others waiting in
/// a collective. It ends the process instead, without MPI_Finalize, upon which mpirun ends the job.
class EndJobOnFatalFailure final : public testing::EmptyTestEventListener
{
  void OnTestPartResult(const testing::TestPartResult& result) override
  {
    if (result.fatally_failed())
    {
      std::cout << "A fatal failure ends the job: " << result.message() << std::endl;
      std::fflush(nullptr);
      std::_Exit(EXIT_FAILURE);
    }
  }
};

} // namespace

int main(int argc, char** argv)
{
  const dsm::MpiTransport::Environment environment(argc, argv);
  testing::InitGoogleTest(&argc, argv);
  testing::UnitTest::GetInstance()->listeners().Append(new EndJobOnFatalFailure);
  int result = RUN_ALL_TESTS();
  if (auto transport = dsm::MpiTransport::Create(nullptr))
  {
    dsm::Messenger messenger(std::move(transport));
    const dsm::Status status = messenger.Agree(result == 0 ? "" : "a test failed");
    if (!status.IsOk())
    {
      std::cout << "Rank " << messenger.GetRank() << " knows: rank " << status.FailedRank
                << " failed a test." << std::endl;
      result = EXIT_FAILURE;
    }
  }
  return result;
}
