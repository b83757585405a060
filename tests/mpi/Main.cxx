// SPDX-License-Identifier: BSD-3-Clause
// Runs the tests of one executable on every rank; each rank reports and returns for itself, and
// mpirun fails when any of them does.
#include "DSMCore/MpiTransport.h"

#include <gtest/gtest.h>

int main(int argc, char** argv)
{
  const dsm::MpiTransport::Environment environment(argc, argv);
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
