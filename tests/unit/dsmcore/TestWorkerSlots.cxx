// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/base/WorkerSlots.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

namespace
{

void SleepMilliseconds(int count)
{
  std::this_thread::sleep_for(std::chrono::milliseconds(count));
}

} // namespace

TEST(TestWorkerSlots, AsManyAsThereAreSlotsRunAtATime)
{
  dsm::WorkerSlots slots;
  slots.BeginFrame(3);
  std::atomic<int> running{ 0 };
  std::atomic<int> most{ 0 };
  std::atomic<int> done{ 0 };
  const auto run = [&](int change)
  {
    const int now = running += change;
    for (int known = most; now > known && !most.compare_exchange_weak(known, now);)
    {
    }
  };
  std::vector<std::thread> workers;
  for (int worker = 0; worker < 11; ++worker)
  {
    workers.emplace_back(
      [&, worker]
      {
        const dsm::WorkerSlots::Hold slot(slots);
        for (int step = 0; step < 2000; ++step)
        {
          run(1);
          while (most < 3) // the first three wait for one another
          {
            std::this_thread::yield();
          }
          run(-1);
          if ((step + worker) % 3 == 0)
          {
            slots.Give(); // as when a block is missed
            slots.Resume();
          }
          slots.LetOthersResume();
          ++done;
        }
      });
  }
  for (std::thread& worker : workers)
  {
    worker.join();
  }
  EXPECT_EQ(done, 11 * 2000);
  EXPECT_EQ(most, 3);
}

TEST(TestWorkerSlots, WhatWasBegunGoesFirst)
{
  dsm::WorkerSlots slots;
  slots.BeginFrame(1);
  slots.Take();
  std::atomic<int> order{ 0 };
  int placeOfNew = 0;
  int placeOfBegun = 0;
  std::thread beginner(
    [&]
    {
      const dsm::WorkerSlots::Hold slot(slots);
      placeOfNew = ++order;
    });
  SleepMilliseconds(50);
  std::thread returner(
    [&]
    {
      slots.Resume();
      placeOfBegun = ++order;
      slots.Give();
    });
  SleepMilliseconds(50);
  slots.Give();
  beginner.join();
  returner.join();
  EXPECT_EQ(placeOfBegun, 1);
  EXPECT_EQ(placeOfNew, 2);
}

TEST(TestWorkerSlots, CountsTheTimeThatSlotsAreFree)
{
  dsm::WorkerSlots slots;
  slots.BeginFrame(2);
  slots.Take();
  SleepMilliseconds(20); // one of two is free
  slots.Give();
  SleepMilliseconds(20); // both are
  slots.Take();
  slots.Give();
  const auto idle = slots.GetIdleNanoseconds();
  EXPECT_GE(idle, 60u * 1000 * 1000);
  SleepMilliseconds(20); // nothing follows
  EXPECT_EQ(slots.GetIdleNanoseconds(), idle);
  slots.BeginFrame(2);
  EXPECT_EQ(slots.GetIdleNanoseconds(), 0u);
}
