// SPDX-License-Identifier: BSD-3-Clause
// Blocks that their owner's source brings when they are needed: they leave memory like those of others,
// and come back, here and for ranks that ask.
#include "DSMCore/fetch/BlockSource.h"

#include "tests/unit/dsmcore/StoreScenarios.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace
{

/// Stands for a file of blocks: a thread of its own reads one after the other, slowly.
class PatternFile final : public dsm::BlockSource
{
public:
  PatternFile(dsm::Messenger& messenger, std::chrono::microseconds delay)
    : Messages(messenger)
    , Delay(delay)
    , Reader([this] { this->Run(); })
  {
  }
  ~PatternFile() override
  {
    {
      const std::lock_guard<std::mutex> lock(this->Guard);
      this->IsOver = true;
    }
    this->Changed.notify_all();
    this->Reader.join();
  }

  void Begin(const dsm::BlockWant& block) override
  {
    this->Begun.push_back(block);
    ++this->Reads;
  }
  bool Submit() override
  {
    const bool any = !this->Begun.empty();
    {
      const std::lock_guard<std::mutex> lock(this->Guard);
      this->Queue.insert(this->Queue.end(), this->Begun.begin(), this->Begun.end());
    }
    this->Begun.clear();
    this->Changed.notify_all();
    return any;
  }
  bool Poll(const Deliver& deliver) override
  {
    std::vector<Read> come;
    {
      const std::lock_guard<std::mutex> lock(this->Guard);
      come.swap(this->Done);
    }
    for (Read& read : come)
    {
      if (read.Block.Id == this->Bad)
      {
        throw dsm::Error("chunk " + std::to_string(read.Block.Id) + " of the file is damaged");
      }
      deliver(read.Block, std::move(read.Memory));
    }
    return !come.empty();
  }
  void Abandon() noexcept override
  {
    std::unique_lock<std::mutex> lock(this->Guard);
    this->Begun.clear();
    this->Queue.clear();
    this->Changed.wait(lock, [this] { return !this->IsReading; });
    this->Done.clear();
  }

  static constexpr dsm::BlockId NoBlock = ~dsm::BlockId(0);
  dsm::BlockId Bad = NoBlock;
  std::uint64_t Reads = 0;

private:
  struct Read
  {
    dsm::BlockWant Block;
    dsm::BlockMemory Memory;
  };

  void Run()
  {
    std::unique_lock<std::mutex> lock(this->Guard);
    while (true)
    {
      this->Changed.wait(lock, [this] { return this->IsOver || !this->Queue.empty(); });
      if (this->IsOver)
      {
        return;
      }
      const dsm::BlockWant block = this->Queue.front();
      this->Queue.pop_front();
      this->IsReading = true;
      lock.unlock();
      std::this_thread::sleep_for(this->Delay);
      const std::size_t bytes = block.From->GetDirectory().GetBytes(block.Id);
      Read read{ block, dsm::AllocateBlock(bytes) };
      for (std::size_t i = 0; i < bytes; ++i)
      {
        read.Memory.get()[i] = dsm_test::GetPattern(block.Id, i);
      }
      lock.lock();
      this->IsReading = false;
      this->Done.push_back(std::move(read));
      this->Changed.notify_all();
      this->Messages.WakeUp();
    }
  }

  dsm::Messenger& Messages;
  std::chrono::microseconds Delay;
  std::vector<dsm::BlockWant> Begun; ///< communication thread only
  std::mutex Guard;
  std::condition_variable Changed;
  std::deque<dsm::BlockWant> Queue;
  std::vector<Read> Done;
  bool IsReading = false;
  bool IsOver = false;
  std::thread Reader;
};

constexpr std::uint32_t SourceBytes = 1000;
constexpr std::size_t Footprint = 1024;

/// A rank's store of blocks that are in its file only.
class FileStore
{
public:
  FileStore(dsm::Messenger& messenger, std::size_t cachedBlocks, int workers,
    std::chrono::microseconds delay = std::chrono::microseconds(50))
    : Messages(messenger)
    , Store(messenger, dsm_test::MakeSettings(cachedBlocks * Footprint, workers))
    , File(std::make_shared<PatternFile>(messenger, delay))
    , Segment(this->Store.Publish("Opening the file",
        dsm_test::MakeDirectory(
          messenger.GetSize(), BlocksOfRank * messenger.GetSize(), SourceBytes),
        this->File))
  {
  }

  void ReadAll()
  {
    std::atomic<std::size_t> wrong{ 0 };
    dsm_test::RunFrame<dsm::ObjectStore>(this->Messages, this->Store,
      [&](dsm::ObjectStore::Worker& worker, int index)
      {
        const dsm::BlockId count = this->Segment->GetDirectory().GetCount();
        for (dsm::BlockId id = 0; id < count; ++id)
        {
          const dsm::BlockId shifted = (id + static_cast<dsm::BlockId>(7 * index)) % count;
          wrong += dsm_test::Visit(this->Store, worker, *this->Segment, shifted);
          this->Store.Quiesce(worker);
        }
      });
    EXPECT_EQ(wrong, 0u);
  }

  static constexpr std::size_t BlocksOfRank = 12;

  dsm::Messenger& Messages;
  dsm::ObjectStore Store;
  std::shared_ptr<PatternFile> File;
  std::shared_ptr<dsm::BlockSegment> Segment;
};

class BlockSourceOnRanks : public testing::TestWithParam<int>
{
};

INSTANTIATE_TEST_SUITE_P(Ranks, BlockSourceOnRanks, testing::Values(1, 3));

TEST_P(BlockSourceOnRanks, OwnBlocksLeaveMemoryAndComeBack)
{
  dsm_test::RunRanks(this->GetParam(),
    [](dsm::Messenger& messenger)
    {
      FileStore files(messenger, 3, 2);
      for (int frame = 0; frame < 3; ++frame)
      {
        files.ReadAll();
        const auto counters = files.Store.GetCounters();
        EXPECT_EQ(counters.ResidentBytes, 0u);
        EXPECT_LE(counters.PeakCachedBytes, 3 * Footprint);
        EXPECT_GT(counters.Evictions, 0u);
        EXPECT_EQ(counters.BytesReceived > 0, messenger.GetSize() > 1);
      }
      EXPECT_GT(files.File->Reads, 2 * FileStore::BlocksOfRank) << "they have come back";
    });
}

/// All workers want different blocks, other ranks ask, and there is room for one of each sort only.
TEST_P(BlockSourceOnRanks, CacheHoldsOneBlockOfOwnAndOneOfOthers)
{
  dsm_test::RunRanks(this->GetParam(),
    [](dsm::Messenger& messenger)
    {
      const std::size_t blocks = messenger.GetSize() > 1 ? 2 : 1;
      FileStore files(messenger, blocks, 4, std::chrono::microseconds(0));
      for (int frame = 0; frame < 5; ++frame)
      {
        files.ReadAll();
        EXPECT_LE(files.Store.GetCounters().PeakCachedBytes, blocks * Footprint);
      }
      files.Store.SetSettings(dsm_test::MakeSettings(blocks * Footprint - 1, 4));
      const std::string text = dsm_test::GetErrorText([&] { files.ReadAll(); });
      EXPECT_NE(text.find("smaller than one brick"), std::string::npos) << text;
    });
}

/// Replies that must wait for others to leave find their blocks gone again.
TEST_P(BlockSourceOnRanks, RepliesOneAtATime)
{
  dsm_test::RunRanks(this->GetParam(),
    [](dsm::Messenger& messenger)
    {
      FileStore files(messenger, 2, 4, std::chrono::microseconds(0));
      auto settings = dsm_test::MakeSettings(2 * Footprint, 4);
      settings.ReplyBytes = 0;
      files.Store.SetSettings(settings);
      for (int frame = 0; frame < 5; ++frame)
      {
        files.ReadAll();
      }
    });
}

TEST_P(BlockSourceOnRanks, EachBlockIsReadOnceWhereThereIsRoom)
{
  dsm_test::RunRanks(this->GetParam(),
    [](dsm::Messenger& messenger)
    {
      const int size = messenger.GetSize();
      FileStore files(messenger, FileStore::BlocksOfRank * static_cast<std::size_t>(size), 3);
      files.ReadAll();
      EXPECT_EQ(files.File->Reads, FileStore::BlocksOfRank);
      files.ReadAll();
      EXPECT_EQ(files.File->Reads, FileStore::BlocksOfRank);
      EXPECT_EQ(files.Store.GetCounters().Workers.Misses, 0u);
    });
}

TEST_P(BlockSourceOnRanks, FailureIsTheFramesErrorAndTheNextFrameWorks)
{
  dsm_test::RunRanks(this->GetParam(),
    [](dsm::Messenger& messenger)
    {
      const int last = messenger.GetSize() - 1;
      FileStore files(messenger, 3, 2);
      const dsm::BlockId bad = static_cast<dsm::BlockId>(5 * messenger.GetSize() + last);
      files.File->Bad = messenger.GetRank() == last ? bad : PatternFile::NoBlock;
      for (int frame = 0; frame < 2; ++frame)
      {
        const std::string text = dsm_test::GetErrorText([&] { files.ReadAll(); });
        EXPECT_NE(
          text.find("chunk " + std::to_string(bad) + " of the file is damaged"), std::string::npos)
          << text;
      }
      files.File->Bad = PatternFile::NoBlock;
      files.ReadAll();
      EXPECT_LE(files.Store.GetCounters().PeakCachedBytes, 3 * Footprint);
    });
}

/// What is foreseen is read ahead, and used.
TEST_P(BlockSourceOnRanks, OwnBlocksAreForeseen)
{
  dsm_test::RunRanks(this->GetParam(),
    [](dsm::Messenger& messenger)
    {
      FileStore files(messenger, 40, 1);
      const int size = messenger.GetSize();
      const dsm::BlockId own = static_cast<dsm::BlockId>(messenger.GetRank());
      EXPECT_TRUE(files.Store.MayPrefetch());
      dsm_test::RunFrame<dsm::ObjectStore>(messenger, files.Store,
        [&](dsm::ObjectStore::Worker& worker, int)
        {
          const std::vector<dsm::BlockId> ids{ own, own + static_cast<dsm::BlockId>(size) };
          EXPECT_TRUE(files.Store.Prefetch(*files.Segment, ids.data(), ids.size()));
          for (const dsm::BlockId id : ids)
          {
            EXPECT_EQ(dsm_test::Visit(files.Store, worker, *files.Segment, id), 0u);
          }
        });
      const auto counters = files.Store.GetCounters();
      EXPECT_EQ(counters.Prefetches + counters.Workers.Misses - counters.Workers.Joins, 2u);
      EXPECT_EQ(files.File->Reads, 2u);
    });
}

/// Reads under way when the frame is cancelled leave nothing behind.
TEST_P(BlockSourceOnRanks, CancelGivesReadsUp)
{
  dsm_test::RunRanks(this->GetParam(),
    [](dsm::Messenger& messenger)
    {
      FileStore files(messenger, 2, 1, std::chrono::milliseconds(20));
      const dsm::BlockId own = static_cast<dsm::BlockId>(messenger.GetRank());
      files.Store.BeginFrame();
      std::string cause;
      std::thread tracer(
        [&]
        {
          dsm::ObjectStore::Worker& worker = files.Store.GetWorker(0);
          files.Store.Enter(worker);
          cause = dsm_test::GetErrorText(
            [&] { dsm_test::Visit(files.Store, worker, *files.Segment, own); });
          files.Store.Leave(worker);
        });
      while (files.File->Reads == 0)
      {
        files.Store.Service();
      }
      files.Store.Cancel("the user gave up");
      tracer.join();
      files.Store.EndFrame();
      EXPECT_EQ(cause, "the user gave up");
      EXPECT_EQ(files.Store.GetCounters().CachedBytes, 0u);
      messenger.Barrier();
      files.ReadAll();
    });
}

} // namespace
