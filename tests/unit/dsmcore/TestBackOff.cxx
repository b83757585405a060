// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/transport/BackOff.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

namespace
{

using Clock = std::chrono::steady_clock;

TEST(BackOff, FirstWaitsAreShortLaterOnesSleep)
{
  dsm::BackOff backOff;
  for (int i = 0; i < 40; ++i)
  {
    backOff.Wait();
  }
  const auto start = Clock::now();
  for (int i = 0; i < 10; ++i)
  {
    backOff.Wait();
  }
  // 20 + 40 + 80 + 160 + 6 x 200 microseconds.
  EXPECT_GE(Clock::now() - start, std::chrono::microseconds(1500));
}

TEST(BackOff, LongPatienceDoesNotSleepBeforeOthersHaveWokenUp)
{
  const auto measure = [](dsm::BackOff::Patience patience)
  {
    int most = 0; // of many tries: the host may take its core away
    for (int attempt = 0; attempt < 200; ++attempt)
    {
      dsm::BackOff backOff;
      backOff.Reset(patience);
      int waits = 0;
      const auto start = Clock::now();
      while (Clock::now() - start < std::chrono::microseconds(400))
      {
        backOff.Wait();
        ++waits;
      }
      most = std::max(most, waits);
    }
    return most;
  };
  EXPECT_LT(measure(dsm::BackOff::Patience::Short), 50) << "it polls 40 times, and sleeps";
  EXPECT_GT(measure(dsm::BackOff::Patience::Long), 60);
  dsm::BackOff backOff;
  backOff.Reset(dsm::BackOff::Patience::Long);
  const auto start = Clock::now();
  int waits = 0;
  while (Clock::now() - start < std::chrono::milliseconds(50))
  {
    backOff.Wait();
    ++waits;
  }
  const auto late = Clock::now();
  for (int i = 0; i < 10; ++i)
  {
    backOff.Wait();
  }
  EXPECT_GE(Clock::now() - late, std::chrono::microseconds(1500)) << "in the end it sleeps";
}

TEST(BackOff, WakeUpBeforeASleepEndsIt)
{
  dsm::BackOff backOff;
  for (int i = 0; i < 50; ++i)
  {
    backOff.Wait();
  }
  int quick = 0;
  for (int i = 0; i < 20; ++i)
  {
    backOff.WakeUp();
    const auto start = Clock::now();
    for (int wait = 0; wait < 5; ++wait)
    {
      backOff.Wait(); // the first finds the notice and starts over; the others only poll
    }
    quick += Clock::now() - start < std::chrono::microseconds(200) ? 1 : 0;
    for (int wait = 0; wait < 50; ++wait)
    {
      backOff.Wait();
    }
  }
  // A busy host may delay some.
  EXPECT_GE(quick, 10);
}

} // namespace
