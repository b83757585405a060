// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/memory/HostMemory.h"

#include <gtest/gtest.h>

namespace
{

TEST(HostMemory, IsKnownOnLinux)
{
  const std::uint64_t available = dsm::GetAvailableHostMemory();
  EXPECT_GT(available, std::uint64_t(1) << 20);
  EXPECT_LT(available, std::uint64_t(1) << 50);
}

} // namespace
