// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/transport/MpiTransport.h"

#include <gtest/gtest.h>

namespace
{

/// The builtin GUI never initializes MPI; it must get along without.
TEST(MpiTransport, IsAbsentUnlessMpiWasInitialised)
{
  EXPECT_EQ(dsm::MpiTransport::Create(nullptr), nullptr);
}

} // namespace
