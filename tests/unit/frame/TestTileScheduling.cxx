// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/FrameAgreement.h"
#include "DSMRayTracing/frame/TileGrid.h"
#include "DSMRayTracing/frame/WorkerPool.h"
#include "DSMRayTracing/schedule/CentralQueueScheduler.h"
#include "DSMRayTracing/schedule/WorkStealingScheduler.h"

#include "tests/support/LoopbackCluster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace
{

/// Frames whose tiles are only waited for.
class Cluster
{
public:
  Cluster(dsm::Messenger& messenger, rt::TileScheduling scheduling, int workers)
    : Messenger(messenger)
    , Workers(workers)
  {
    if (scheduling == rt::TileScheduling::CentralQueue)
    {
      this->Scheduler = std::make_unique<rt::CentralQueueScheduler>(messenger);
    }
    else
    {
      this->Scheduler = std::make_unique<rt::WorkStealingScheduler>(messenger);
    }
  }

  /// Collective. `trace(tile)` stands for the tracing of a tile, by workers. Returns this rank's
  /// tiles.
  template <class Trace>
  std::vector<int> RunFrame(const rt::TilePlan& plan, const Trace& trace, bool cancels = false)
  {
    std::mutex guard;
    std::vector<int> mine;
    dsm::WorkerSlots slots;
    slots.BeginFrame(this->Workers);
    this->Messenger.Barrier();
    this->Scheduler->Begin(plan, this->Workers);
    rt::FrameAgreement agreement(this->Messenger, [this] { this->Scheduler->Cancel(); });
    this->Messenger.BeginSession();
    this->Pool.Start(
      this->Workers,
      [&](int)
      {
        const dsm::WorkerSlots::Hold slot(slots);
        while (const std::optional<int> tile = this->Scheduler->Pop(slots))
        {
          trace(*tile);
          const std::lock_guard<std::mutex> lock(guard);
          mine.push_back(*tile);
        }
      },
      [this] { this->Messenger.WakeUp(); });
    this->Messenger.ProgressUntil([&] { return agreement.IsOver(); },
      [&]
      {
        bool any = this->Scheduler->Service();
        if (cancels)
        {
          this->Scheduler->Cancel();
          agreement.ReportFailure("cancelled for the test");
        }
        if (!agreement.IsDone() && this->Pool.GetRunning() == 0)
        {
          agreement.ReportDone();
          any = true;
        }
        return any;
      });
    this->Pool.Wait();
    this->Scheduler->End();
    this->Messenger.ProgressUntil([this] { return this->Messenger.GetUnsentBytes() == 0; });
    if (!agreement.GetOutcome().IsOk())
    {
      this->Messenger.Barrier();
      mine.clear();
    }
    return mine;
  }

  /// Collective: each of these tiles was traced once, and no other.
  void ExpectTilesOnce(const std::vector<int>& mine, const std::vector<int>& tiles)
  {
    std::vector<std::byte> bytes;
    for (const int tile : mine)
    {
      dsm::AttachTail(bytes, tile);
    }
    std::vector<int> all;
    for (const auto& part : this->Messenger.AllGather(bytes))
    {
      const auto* first = reinterpret_cast<const int*>(part.data());
      all.insert(all.end(), first, first + part.size() / sizeof(int));
    }
    std::sort(all.begin(), all.end());
    ASSERT_TRUE(all == tiles) << all.size() << " tiles of " << tiles.size();
  }

  dsm::Messenger& Messenger;

private:
  const int Workers;
  std::unique_ptr<rt::TileScheduler> Scheduler;
  rt::WorkerPool Pool;
};

rt::TilePlan CreatePlan(int columns, int tiles)
{
  rt::TilePlan plan;
  plan.Columns = columns;
  plan.Tiles = tiles;
  plan.Left.resize(static_cast<std::size_t>(tiles));
  std::iota(plan.Left.begin(), plan.Left.end(), 0);
  return plan;
}

/// The part of a plan that is left after each `step`-th tile was traced.
rt::TilePlan LeaveOut(const rt::TilePlan& plan, int step)
{
  rt::TilePlan rest = plan;
  const auto isTraced = [=](int tile) { return tile % step == 0; };
  for (std::vector<int>* tiles : { &rest.Left, &rest.Mine })
  {
    tiles->erase(std::remove_if(tiles->begin(), tiles->end(), isTraced), tiles->end());
  }
  return rest;
}

void Spin(double microseconds)
{
  const auto end =
    std::chrono::steady_clock::now() + std::chrono::duration<double, std::micro>(microseconds);
  while (std::chrono::steady_clock::now() < end)
  {
  }
}

/// How many tiles the ranks of a cluster have begun, for workers that wait for one another instead of for the clock.
class Progress
{
public:
  explicit Progress(int ranks)
    : Begun(ranks)
  {
  }

  void Begin(int rank) { ++this->Begun[rank]; }
  int Get(int rank) const { return this->Begun[rank]; }

  int GetLeast() const { return *std::min_element(this->Begun.begin(), this->Begun.end()); }
  int GetSum() const
  {
    int sum = 0;
    for (const std::atomic<int>& begun : this->Begun)
    {
      sum += begun;
    }
    return sum;
  }

  /// Waits for a condition; without end it would hide that a test fails.
  template <class Condition>
  static void WaitFor(const Condition& condition)
  {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!condition() && std::chrono::steady_clock::now() < end)
    {
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
    EXPECT_TRUE(condition());
  }

private:
  std::vector<std::atomic<int>> Begun;
};

struct Case
{
  rt::TileScheduling Scheduling;
  int Ranks;
  int Frames;
};

class TileScheduling : public testing::TestWithParam<Case>
{
};

std::string GetName(const testing::TestParamInfo<Case>& info)
{
  return (info.param.Scheduling == rt::TileScheduling::CentralQueue ? "Queue" : "Stealing") +
    std::to_string(info.param.Ranks);
}

INSTANTIATE_TEST_SUITE_P(Schedulers, TileScheduling,
  testing::Values(Case{ rt::TileScheduling::CentralQueue, 2, 3000 },
    Case{ rt::TileScheduling::CentralQueue, 3, 3000 },
    Case{ rt::TileScheduling::CentralQueue, 4, 4000 },
    Case{ rt::TileScheduling::WorkStealing, 1, 500 },
    Case{ rt::TileScheduling::WorkStealing, 2, 3000 },
    Case{ rt::TileScheduling::WorkStealing, 3, 3000 },
    Case{ rt::TileScheduling::WorkStealing, 4, 4000 }),
  GetName);

} // namespace

TEST_P(TileScheduling, NeitherHangsNorLosesNorDoublesATile)
{
  const Case& setting = this->GetParam();
  RunOnCluster(setting.Ranks,
    [&](dsm::Messenger& messenger)
    {
      Cluster cluster(messenger, setting.Scheduling, 2);
      std::mt19937 common(1);
      std::mt19937 own(static_cast<std::mt19937::result_type>(100 + messenger.GetRank()));
      const auto pick = [](std::mt19937& from, int least, int most)
      { return std::uniform_int_distribution<int>(least, most)(from); };
      rt::TilePlan plan;
      for (int frame = 0; frame < setting.Frames; ++frame)
      {
        if (frame == 0 || pick(common, 0, 9) == 0) // a resize
        {
          const int columns = pick(common, 1, 9);
          plan = CreatePlan(columns, columns * pick(common, 1, 7));
        }
        // A rank is late; tiles cost differently; now and then a rank gives up.
        if (pick(own, 0, 19) == 0)
        {
          std::this_thread::sleep_for(std::chrono::microseconds(pick(own, 1, 500)));
        }
        const int longest = pick(own, 0, 15);
        const bool fails = pick(common, 0, 49) == 0;
        const int failing = pick(common, 0, messenger.GetSize() - 1);
        const auto seed = static_cast<unsigned>(frame);
        const bool isRest = plan.Tiles > 1 && pick(common, 0, 3) == 0; // an aborted frame goes on
        const rt::TilePlan left = isRest ? LeaveOut(plan, pick(common, 2, 9)) : plan;
        const std::vector<int> mine = cluster.RunFrame(
          left,
          [=](int tile)
          { Spin((seed * 31u + static_cast<unsigned>(tile) * 17u) % 8 * longest * 0.1); },
          fails && failing == messenger.GetRank());
        if (fails)
        {
          plan.HasHistory = false;
          plan.Slowest = plan.Fastest = -1;
          continue;
        }
        cluster.ExpectTilesOnce(mine, left.Left);
        if (isRest)
        {
          continue;
        }
        plan.Mine = mine;
        plan.HasHistory = true;
        if (messenger.GetSize() > 1 && pick(common, 0, 1) == 0)
        {
          plan.Slowest = pick(common, 0, messenger.GetSize() - 1);
          plan.Fastest = (plan.Slowest + 1) % messenger.GetSize();
        }
        else
        {
          plan.Slowest = plan.Fastest = -1;
        }
      }
    });
}

TEST(TestTileScheduling, TheFirstCutIsFairAndWhole)
{
  for (const int ranks : { 1, 2, 3, 7, 64 })
  {
    rt::TilePlan plan = CreatePlan(13, 13 * 9);
    std::set<int> all;
    for (int rank = 0; rank < ranks; ++rank)
    {
      const auto cut = rt::WorkStealingScheduler::CutInitially(plan, rank, ranks);
      EXPECT_GE(static_cast<int>(cut.size()), plan.Tiles / ranks);
      EXPECT_LE(static_cast<int>(cut.size()), plan.Tiles / ranks + 1);
      all.insert(cut.begin(), cut.end());
    }
    EXPECT_EQ(static_cast<int>(all.size()), plan.Tiles);
  }
}

TEST(TestTileScheduling, WithoutNeedARankKeepsItsTiles)
{
  Progress progress(2);
  RunOnCluster(2,
    [&progress](dsm::Messenger& messenger)
    {
      Cluster cluster(messenger, rt::TileScheduling::WorkStealing, 1);
      rt::TilePlan plan = CreatePlan(8, 64);
      plan.HasHistory = true;
      for (int tile = messenger.GetRank(); tile < plan.Tiles; tile += 2)
      {
        plan.Mine.push_back(tile);
      }
      // Equal ranks: neither is more than a tile ahead of the other, so that few are left to steal at the end.
      const int rank = messenger.GetRank();
      const auto mine = cluster.RunFrame(plan,
        [&](int)
        {
          progress.Begin(rank);
          Progress::WaitFor(
            [&] {
              return progress.Get(1 - rank) + 1 >= progress.Get(rank) ||
                progress.GetSum() >= plan.Tiles;
            });
        });
      const auto changed = std::count_if(
        mine.begin(), mine.end(), [&](int tile) { return tile % 2 != messenger.GetRank(); });
      EXPECT_LE(changed, 2);
      cluster.ExpectTilesOnce(mine, plan.Left);
    });
}

TEST(TestTileScheduling, PeekTellsWhatPopGivesLater)
{
  RunOnCluster(1,
    [](dsm::Messenger& messenger)
    {
      for (const auto scheduling :
        { rt::TileScheduling::CentralQueue, rt::TileScheduling::WorkStealing })
      {
        constexpr int tiles = 20;
        std::unique_ptr<rt::TileScheduler> scheduler;
        if (scheduling == rt::TileScheduling::CentralQueue)
        {
          scheduler = std::make_unique<rt::CentralQueueScheduler>(messenger);
        }
        else
        {
          scheduler = std::make_unique<rt::WorkStealingScheduler>(messenger);
        }
        dsm::WorkerSlots slots;
        slots.BeginFrame(1);
        const dsm::WorkerSlots::Hold slot(slots);
        const rt::TilePlan plan = CreatePlan(5, tiles);
        scheduler->Begin(plan, 1);
        std::vector<std::optional<int>> foretold;
        for (int ahead = 0; ahead < tiles + 2; ++ahead)
        {
          foretold.push_back(scheduler->Peek(ahead));
        }
        for (int number = 0; number < tiles + 2; ++number)
        {
          EXPECT_EQ(scheduler->Peek(0), foretold[number]);
          EXPECT_EQ(scheduler->Pop(slots), foretold[number]);
        }
        EXPECT_TRUE(foretold[tiles - 1].has_value());
        EXPECT_FALSE(foretold[tiles].has_value());
        scheduler->End();
      }
    });
}

TEST(TestTileScheduling, AnIdleRankSteals)
{
  Progress progress(3);
  RunOnCluster(3,
    [&progress](dsm::Messenger& messenger)
    {
      Cluster cluster(messenger, rt::TileScheduling::WorkStealing, 1);
      rt::TilePlan plan = CreatePlan(30, 300);
      plan.HasHistory = true;
      for (int tile = 0; messenger.GetRank() == 0 && tile < plan.Tiles; ++tile)
      {
        plan.Mine.push_back(tile);
      }
      // A rank that has had a tenth waits until the others have, too: without stealing, none of them would.
      constexpr int tenth = 30;
      const auto mine = cluster.RunFrame(plan,
        [&](int)
        {
          progress.Begin(messenger.GetRank());
          if (progress.Get(messenger.GetRank()) > tenth)
          {
            Progress::WaitFor([&] { return progress.GetLeast() > tenth; });
          }
        });
      EXPECT_GT(mine.size(), static_cast<std::size_t>(tenth)) << "all had something to do";
      cluster.ExpectTilesOnce(mine, plan.Left);
    });
}

TEST(TestTileScheduling, TheSlowestGivesToTheFastest)
{
  RunOnCluster(3,
    [](dsm::Messenger& messenger)
    {
      Cluster cluster(messenger, rt::TileScheduling::WorkStealing, 1);
      rt::TilePlan plan = CreatePlan(2, 2);
      plan.HasHistory = true;
      plan.Slowest = 0;
      plan.Fastest = 2;
      if (messenger.GetRank() == 0)
      {
        plan.Mine = { 0, 1 };
      }
      // The last tile of a rank is not stolen, so only what is given changes hands.
      const auto mine = cluster.RunFrame(plan, [](int) {});
      EXPECT_EQ(mine.size(), messenger.GetRank() == 1 ? 0u : 1u);
      cluster.ExpectTilesOnce(mine, plan.Left);
    });
}
