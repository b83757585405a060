// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/WorkerPool.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <thread>

TEST(WorkerPool, EveryIndexOnceAndAllFinish)
{
  rt::WorkerPool pool;
  // More, fewer, and again more threads than before.
  for (const int count : { 1, 5, 2, 8, 1, 8 })
  {
    std::array<std::atomic<int>, 8> calls{};
    std::atomic<int> finished{ 0 };
    pool.Start(
      count, [&](int index) { ++calls.at(index); }, [&] { ++finished; });
    pool.Wait();
    EXPECT_EQ(pool.GetRunning(), 0);
    for (int index = 0; index < 8; ++index)
    {
      EXPECT_EQ(calls.at(index), index < count ? 1 : 0);
    }
    EXPECT_EQ(finished, count);
  }
}

TEST(WorkerPool, ManyShortRuns)
{
  rt::WorkerPool pool;
  std::atomic<int> calls{ 0 };
  for (int run = 0; run < 2000; ++run)
  {
    pool.Start(
      3, [&](int) { ++calls; }, [] {});
    pool.Wait();
  }
  EXPECT_EQ(calls, 6000);
}

TEST(WorkerPool, NeverStarted)
{
  rt::WorkerPool pool;
  pool.Wait();
  EXPECT_EQ(pool.GetRunning(), 0);
}

/// What `finished` uses is gone when the frame that waited has returned.
TEST(WorkerPool, WaitsUntilTheLastHasCalledFinished)
{
  rt::WorkerPool pool;
  std::atomic<int> through{ 0 };
  std::atomic<int> sawNoneAtWork{ 0 };
  pool.Start(
    2, [](int) {},
    [&]
    {
      sawNoneAtWork += pool.GetRunning() == 0 ? 1 : 0;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      ++through;
    });
  pool.Wait();
  EXPECT_EQ(through, 2);
  EXPECT_GE(sawNoneAtWork, 1) << "who is woken by the last one must find that none is at work";
}
