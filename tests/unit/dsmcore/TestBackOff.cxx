// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/transport/BackOff.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include <sys/resource.h>

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

/// How often this thread has given its core away to wait for something.
long CountSleeps()
{
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nvcsw;
}

TEST(BackOff, LongPatienceDoesNotSleepBeforeOthersHaveWokenUp)
{
  long before = CountSleeps();
  dsm::BackOff hasty;
  for (int wait = 0; wait < 60; ++wait)
  {
    hasty.Wait();
  }
  EXPECT_GT(CountSleeps(), before) << "it polls 40 times, and sleeps";

  long fewest = 1;
  for (int attempt = 0; attempt < 200; ++attempt) // the host may take its core away for long
  {
    dsm::BackOff patient;
    patient.Reset(dsm::BackOff::Patience::Long);
    before = CountSleeps();
    const auto start = Clock::now();
    while (Clock::now() - start < std::chrono::microseconds(400))
    {
      patient.Wait();
    }
    fewest = std::min(fewest, CountSleeps() - before);
  }
  EXPECT_EQ(fewest, 0);

  dsm::BackOff backOff;
  backOff.Reset(dsm::BackOff::Patience::Long);
  const auto start = Clock::now();
  while (Clock::now() - start < std::chrono::milliseconds(50))
  {
    backOff.Wait();
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
