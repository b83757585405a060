// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/memory/HostMemory.h"
#include "DSMCore/memory/HostTurn.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

namespace
{

TEST(HostMemory, IsKnownOnLinux)
{
  const std::uint64_t available = dsm::GetAvailableHostMemory();
  EXPECT_GT(available, std::uint64_t(1) << 20);
  EXPECT_LT(available, std::uint64_t(1) << 50);
}

TEST(HostMemory, IsTakenByOneAtATime)
{
  std::atomic<int> inTurn{ 0 };
  std::atomic<int> most{ 0 };
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 4; ++thread)
  {
    threads.emplace_back(
      [&]
      {
        for (int turns = 0; turns < 50; ++turns)
        {
          const dsm::HostTurn turn;
          most = std::max(most.load(), ++inTurn);
          std::this_thread::yield();
          --inTurn;
        }
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_EQ(most, 1);
}

TEST(HostMemory, IsNotWaitedForWithoutEnd)
{
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds patience(50);
  const dsm::HostTurn turn;
  const Clock::time_point begin = Clock::now();
  const dsm::HostTurn other(patience);
  EXPECT_GE(Clock::now() - begin, patience);
}

/// Any user can lock the folder.
TEST(HostMemory, IsNotHeldUpByLocksOfOtherUsers)
{
  using Clock = std::chrono::steady_clock;
  const int folder = open("/dev/shm", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  flock(folder, LOCK_EX | LOCK_NB);
  const Clock::time_point begin = Clock::now();
  {
    const dsm::HostTurn turn;
  }
  EXPECT_LT(Clock::now() - begin, std::chrono::seconds(10));
  close(folder);
}

} // namespace
