// SPDX-License-Identifier: BSD-3-Clause
// Blocks that are read from a disk when they are needed, in every memory organization: within a memory that
// does not hold them all, with disks that are slow, fail, or hang.
#include "tests/unit/dsmcore/DiskScenarios.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <tuple>
#include <type_traits>
#include <vector>

namespace
{

using dsm_test::DiskStore;
using dsm_test::NoBlock;
constexpr std::uint32_t DiskBytes = dsm_test::DiskBlockBytes;

using DiskParameters = std::tuple<dsm::MemoryOrganization, int>;

class BlocksOnDisk : public testing::TestWithParam<DiskParameters>
{
protected:
  void Run(const std::function<void(dsm::Messenger&, dsm::MemoryOrganization)>& rank)
  {
    dsm_test::RunRanks(std::get<1>(this->GetParam()),
      [&](dsm::Messenger& messenger) { rank(messenger, std::get<0>(this->GetParam())); });
  }
};

INSTANTIATE_TEST_SUITE_P(OrganizationsAndRanks, BlocksOnDisk,
  testing::Combine(
    testing::Values(dsm::MemoryOrganization::Automatic, dsm::MemoryOrganization::ObjectBased,
      dsm::MemoryOrganization::PageBased, dsm::MemoryOrganization::Replicated),
    testing::Values(1, 3)));

TEST_P(BlocksOnDisk, LeaveMemoryAndComeBack)
{
  this->Run(
    [](dsm::Messenger& messenger, dsm::MemoryOrganization organization)
    {
      DiskStore disks(messenger, organization, 4);
      for (int frame = 0; frame < 3; ++frame)
      {
        disks.ReadAll();
        const auto counters = disks.Store.GetCounters();
        EXPECT_EQ(counters.ResidentBytes, 0u);
        EXPECT_EQ(counters.CacheCapacity, 4 * DiskBytes);
        EXPECT_LE(counters.PeakCachedBytes, counters.CacheCapacity);
        EXPECT_GT(counters.Evictions, 0u);
      }
      EXPECT_GT(disks.Disk->Reads, 2 * DiskStore::BlocksOfRank) << "they have come back";
    });
}

/// There is room for one block of the rank's own, and for one of others.
TEST_P(BlocksOnDisk, LeastMemory)
{
  this->Run(
    [](dsm::Messenger& messenger, dsm::MemoryOrganization organization)
    {
      const std::size_t least = messenger.GetSize() > 1 ? 2 : 1;
      DiskStore disks(messenger, organization, least);
      disks.ReadAll();
      disks.ReadAll();
      auto settings = disks.Store.GetSettings();
      settings.MemoryBytes -= 1;
      disks.Store.SetSettings(settings);
      const std::string text = dsm_test::GetErrorText([&] { disks.Store.Settle(); });
      EXPECT_NE(text.find("Raise the memory per rank (DSMMemory)"), std::string::npos) << text;
      EXPECT_EQ(text.find("DSMScratchDirectory"), std::string::npos)
        << "they are on a disk: " << text;
    });
}

TEST_P(BlocksOnDisk, AreReadOnceWhereThereIsRoom)
{
  this->Run(
    [](dsm::Messenger& messenger, dsm::MemoryOrganization organization)
    {
      const auto ranks = static_cast<std::size_t>(messenger.GetSize());
      DiskStore disks(messenger, organization, (DiskStore::BlocksOfRank + 2) * ranks + 2);
      const bool byAll = organization == dsm::MemoryOrganization::Replicated;
      for (int frame = 0; frame < 2; ++frame)
      {
        disks.ReadAll();
        EXPECT_EQ(disks.Disk->Reads, DiskStore::BlocksOfRank * (byAll ? ranks : 1));
      }
      EXPECT_EQ(disks.Store.GetCounters().Workers.Misses, 0u);
      const std::string& text = disks.Store.GetExplanation();
      EXPECT_NE(text.find(byAll ? "by each rank" : "once for all ranks"), std::string::npos)
        << text;
      EXPECT_FALSE(disks.Store.LacksMemory());
    });
}

TEST_P(BlocksOnDisk, FailureIsTheFramesErrorAndTheNextFrameWorks)
{
  this->Run(
    [](dsm::Messenger& messenger, dsm::MemoryOrganization organization)
    {
      const int last = messenger.GetSize() - 1;
      DiskStore disks(messenger, organization, 6);
      const dsm::BlockId bad = static_cast<dsm::BlockId>(5 * messenger.GetSize() + last);
      disks.Disk->Bad = bad;
      for (int frame = 0; frame < 2; ++frame)
      {
        const std::string text = dsm_test::GetErrorText([&] { disks.ReadAll(); });
        EXPECT_NE(
          text.find("chunk " + std::to_string(bad) + " of the file is damaged"), std::string::npos)
          << text;
      }
      disks.Disk->Bad = NoBlock;
      disks.ReadAll();
    });
}

/// A read that does not come back keeps nobody from giving up the frame, nor the blocks, nor from going on
/// with others.
TEST_P(BlocksOnDisk, HangingReadIsGivenUp)
{
  this->Run(
    [](dsm::Messenger& messenger, dsm::MemoryOrganization organization)
    {
      DiskStore disks(messenger, organization, 6);
      const auto own = static_cast<dsm::BlockId>(messenger.GetRank());
      const auto size = static_cast<dsm::BlockId>(messenger.GetSize());
      disks.Disk->SetStuck(own);
      disks.Store.Visit(
        [&](auto& blocks)
        {
          blocks.BeginFrame();
          std::string cause;
          std::thread tracer(
            [&]
            {
              auto& worker = blocks.GetWorker(0);
              blocks.Enter(worker);
              EXPECT_EQ(dsm_test::Visit(blocks, worker, *disks.Segment, own + size), 0u);
              cause = dsm_test::GetErrorText(
                [&] { dsm_test::Visit(blocks, worker, *disks.Segment, own); });
              blocks.Leave(worker);
            });
          while (disks.Disk->Reads < 2)
          {
            blocks.Service();
          }
          blocks.Cancel("the user gave up");
          tracer.join();
          blocks.EndFrame();
          EXPECT_EQ(cause, "the user gave up");
        });
      const auto disk = disks.Disk;
      const auto segment = disks.Segment;
      messenger.Barrier();
      disks.Store.Retire(segment);
      disks.Segment.reset();
      disk->SetStuck(NoBlock);
    });
}

/// What is in memory for good is shared out while something is on a disk, and copied again afterwards.
TEST(BlocksOnDiskBesideOthers, OrganizationFollows)
{
  dsm_test::RunRanks(2,
    [](dsm::Messenger& messenger)
    {
      DiskStore disks(messenger, dsm::MemoryOrganization::Automatic, 40);
      const auto stays =
        dsm_test::PublishPattern(messenger, disks.Store, dsm_test::MakeDirectory(2, 8, DiskBytes));
      EXPECT_EQ(disks.Store.GetOrganization(), dsm::MemoryOrganization::ObjectBased);
      disks.ReadAll();
      EXPECT_GT(disks.Store.GetCounters().ResidentBytes, 0u);
      disks.Store.Retire(disks.Segment);
      disks.Store.Settle();
      EXPECT_EQ(disks.Store.GetOrganization(), dsm::MemoryOrganization::Replicated);
      disks.Segment = stays;
      disks.ReadAll();
    });
}

/// No thread reads; more blocks than are delivered at once.
TEST_P(BlocksOnDisk, WhatWasReadAheadNeedsNoRead)
{
  this->Run(
    [](dsm::Messenger& messenger, dsm::MemoryOrganization organization)
    {
      DiskStore disks(messenger, organization, 6);
      disks.Disk->AtHand = true;
      disks.ReadAll();
      EXPECT_EQ(disks.Disk->Reads, 0u);
      disks.Disk->AtHand = false;
      disks.ReadAll();
      EXPECT_GT(disks.Disk->Reads, 0u);
    });
}

/// Nobody is asked, and no thread but the worker's reads, where all is in the memory of the system that the ranks
/// have in common; of ranks elsewhere, each reads what it owns.
TEST_P(BlocksOnDisk, WorkersReadWhatIsInMemory)
{
  this->Run(
    [](dsm::Messenger& messenger, dsm::MemoryOrganization organization)
    {
      const auto ranks = static_cast<std::size_t>(messenger.GetSize());
      const bool isPaged = organization == dsm::MemoryOrganization::PageBased;
      const bool byAll = organization == dsm::MemoryOrganization::Replicated;
      for (const bool shares : { true, false })
      {
        DiskStore disks(messenger, organization, (DiskStore::BlocksOfRank + 2) * ranks + 2, shares);
        disks.Disk->OneInMemory = 1;
        // One before another rank may ask for it.
        disks.RunFirstWorker(
          [&](auto& blocks, auto& worker)
          {
            const auto mine = static_cast<dsm::BlockId>(messenger.GetRank());
            EXPECT_EQ(dsm_test::Visit(blocks, worker, *disks.Segment, mine), 0u);
          });
        const std::uint64_t first = disks.Disk->AtOnce;
        disks.ReadAll();
        const auto counters = disks.Store.GetCounters();
        if (isPaged)
        {
          EXPECT_EQ(disks.Disk->AtOnce, 0u) << "a page lands on the communication thread";
          continue;
        }
        const bool isAll = shares || byAll || ranks == 1;
        EXPECT_EQ(counters.Requests == 0, isAll);
        EXPECT_EQ(counters.BytesReceived == 0, isAll);
        if (isAll)
        {
          EXPECT_EQ(disks.Disk->Reads, 0u);
          EXPECT_EQ(disks.Disk->AtOnce, DiskStore::BlocksOfRank * ranks);
          EXPECT_EQ(counters.Workers.Misses - counters.Workers.Joins, disks.Disk->AtOnce - first);
        }
        else
        {
          // What another rank asks for is read by a thread, unless a worker has been there before.
          EXPECT_EQ(disks.Disk->Reads + disks.Disk->AtOnce, DiskStore::BlocksOfRank);
        }
        EXPECT_EQ(first, 1u);
        disks.ReadAll();
        EXPECT_EQ(disks.Store.GetCounters().Workers.Misses, 0u);
      }
    });
}

/// What workers prefetch of it is not read by others: the system is advised.
TEST_P(BlocksOnDisk, SystemIsAdvisedOfWhatWorkersPrefetch)
{
  this->Run(
    [](dsm::Messenger& messenger, dsm::MemoryOrganization organization)
    {
      if (organization == dsm::MemoryOrganization::PageBased)
      {
        return;
      }
      DiskStore disks(messenger, organization, 40);
      disks.Disk->OneInMemory = 1;
      const dsm::BlockId ids[] = { static_cast<dsm::BlockId>(messenger.GetRank()),
        static_cast<dsm::BlockId>(messenger.GetRank() + messenger.GetSize()) };
      const auto look = [&](std::uint64_t used)
      {
        disks.RunFirstWorker(
          [&](auto& blocks, auto& worker)
          {
            blocks.Prefetch(*disks.Segment, ids, 2);
            blocks.Prefetch(*disks.Segment, ids, 2);
            for (std::uint64_t block = 0; block < used; ++block)
            {
              EXPECT_EQ(dsm_test::Visit(blocks, worker, *disks.Segment, ids[block]), 0u);
            }
          });
        const auto counters = disks.Store.GetCounters();
        EXPECT_EQ(counters.Prefetches, used) << "what was read of it";
        EXPECT_EQ(counters.PrefetchesUsed, used);
        EXPECT_EQ(counters.Workers.Misses, used);
        EXPECT_EQ(counters.Workers.Joins, used);
        EXPECT_EQ(disks.Disk->Reads, 0u);
      };
      look(0); // forgotten with the frame
      look(2);
      while (disks.Disk->Told < 4) // the threads do it when they come to it
      {
        std::this_thread::yield();
      }
      EXPECT_EQ(disks.Disk->Told, 4u) << "once in each frame";
    });
}

/// The system is advised of neighbors, too, once in a frame.
TEST_P(BlocksOnDisk, SystemIsAdvisedOfNeighbors)
{
  this->Run(
    [](dsm::Messenger& messenger, dsm::MemoryOrganization organization)
    {
      DiskStore disks(messenger, organization, 4 * DiskStore::BlocksOfRank);
      disks.Disk->OneInMemory = 1;
      const auto find = [&](std::size_t number)
      { return static_cast<dsm::BlockId>(messenger.GetRank() + number * messenger.GetSize()); };
      const dsm::BlockId none = disks.Segment->GetDirectory().GetCount();
      const dsm::BlockId ids[] = { find(0), find(1), none };
      disks.RunFirstWorker(
        [&](auto& blocks, auto&)
        {
          for (int call = 0; call < 2; ++call)
          {
            blocks.Prefetch(*disks.Segment, ids, 3,
              [&](dsm::BlockId id, std::vector<dsm::BlockId>& neighbors)
              {
                EXPECT_NE(id, none);
                neighbors.insert(neighbors.end(), { find(0), find(2), none });
              });
          }
        });
      const std::uint64_t told = organization == dsm::MemoryOrganization::PageBased ? 0 : 3;
      for (int attempt = 0; attempt < 2000 && disks.Disk->Told < told; ++attempt)
      {
        std::this_thread::sleep_for(std::chrono::milliseconds(5)); // a thread does it
      }
      EXPECT_EQ(disks.Disk->Told, told);
    });
}

/// A frame that is given up while a worker reads leaves nothing behind.
TEST_P(BlocksOnDisk, WorkerReadsWhileTheFrameIsGivenUp)
{
  this->Run(
    [](dsm::Messenger& messenger, dsm::MemoryOrganization organization)
    {
      if (organization == dsm::MemoryOrganization::PageBased)
      {
        return;
      }
      DiskStore disks(messenger, organization, 6);
      const auto own = static_cast<dsm::BlockId>(messenger.GetRank());
      disks.Disk->OneInMemory = 1;
      disks.Disk->SetStuck(own);
      disks.Store.Visit(
        [&](auto& blocks)
        {
          blocks.BeginFrame();
          std::string causes[2];
          std::vector<std::thread> tracers;
          for (int index = 0; index < 2; ++index) // one reads, the other waits for it
          {
            tracers.emplace_back(
              [&, index]
              {
                auto& worker = blocks.GetWorker(index);
                blocks.Enter(worker);
                causes[index] = dsm_test::GetErrorText(
                  [&] { dsm_test::Visit(blocks, worker, *disks.Segment, own); });
                blocks.Leave(worker);
              });
          }
          while (disks.Disk->AtOnce == 0)
          {
            blocks.Service();
          }
          blocks.Cancel("the user gave up");
          disks.Disk->SetStuck(NoBlock);
          for (std::thread& tracer : tracers)
          {
            tracer.join();
          }
          blocks.EndFrame();
          EXPECT_EQ(causes[0], "the user gave up");
          EXPECT_EQ(causes[1], "the user gave up");
          EXPECT_EQ(blocks.GetCounters().CachedBytes, 0u);
        });
      messenger.Barrier();
      disks.ReadAll();
    });
}

/// As from one time step to the next: what has not changed is not read again.
TEST_P(BlocksOnDisk, GetOtherContents)
{
  this->Run(
    [](dsm::Messenger& messenger, dsm::MemoryOrganization organization)
    {
      const auto ranks = static_cast<std::size_t>(messenger.GetSize());
      DiskStore disks(messenger, organization, (DiskStore::BlocksOfRank + 2) * ranks + 2);
      disks.Disk->OfEveryThird = std::byte(0);
      const dsm::BlockId count = disks.Segment->GetDirectory().GetCount();
      const std::size_t wrong = disks.CountWrong();
      EXPECT_GT(wrong, 0u);
      EXPECT_EQ(wrong % ((count + 2) / 3 * DiskBytes), 0u) << "the same to each worker";

      EXPECT_TRUE(disks.Store.MayRefresh(disks.Segment));
      EXPECT_FALSE(disks.Store.MayUpdate(disks.Segment));
      const auto next = std::make_shared<dsm_test::PatternDisk>();
      disks.Source->SetReader(next, "the next step's disk");
      const bool byAll = organization == dsm::MemoryOrganization::Replicated;
      std::vector<bool> changed(count);
      std::size_t mine = 0;
      std::size_t mineChanged = 0;
      for (dsm::BlockId id = 0; id < count; ++id)
      {
        changed[id] = id % 3 == 0;
        const bool isMine =
          byAll || disks.Segment->GetDirectory().GetOwner(id) == messenger.GetRank();
        mine += isMine ? 1 : 0;
        mineChanged += isMine && changed[id] ? 1 : 0;
      }
      disks.Store.Refresh("The next step", disks.Segment, changed);
      EXPECT_EQ(next->Kept, mine - mineChanged);
      disks.ReadAll();
      EXPECT_EQ(next->Reads, mineChanged);
      disks.ReadAll();
      EXPECT_EQ(next->Reads, mineChanged);
    });
}

TEST_P(BlocksOnDisk, RandomAccess)
{
  for (const bool shares : { false, true })
  {
    this->Run([&](dsm::Messenger& messenger, dsm::MemoryOrganization organization)
      { dsm_test::RandomAccessToADisk(messenger, organization, 5, 4, shares); });
  }
}

/// All that a rank owns can be looked through, wherever it is.
TEST_P(BlocksOnDisk, CanBeLookedThrough)
{
  this->Run(
    [](dsm::Messenger& messenger, dsm::MemoryOrganization organization)
    {
      DiskStore disks(messenger, organization, 4);
      std::size_t count = 0;
      disks.Segment->ForEachResident(
        [&](dsm::BlockId id, const std::byte* block, std::size_t bytes)
        {
          ++count;
          EXPECT_EQ(disks.Segment->GetDirectory().GetOwner(id), messenger.GetRank());
          EXPECT_EQ(dsm_test::CountWrongBytes(id, block, bytes), 0u);
        });
      EXPECT_EQ(count, DiskStore::BlocksOfRank);
    });
}

} // namespace
