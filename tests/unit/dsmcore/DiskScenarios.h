// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_test_DiskScenarios_h
#define dsm_test_DiskScenarios_h

#include "DSMCore/fetch/ReadingSource.h"
#include "DSMCore/store/BlockStore.h"
#include "tests/unit/dsmcore/StoreScenarios.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <random>
#include <string>
#include <thread>

namespace dsm_test
{

constexpr std::uint32_t DiskBlockBytes = 4096; // a page
constexpr dsm::BlockId NoBlock = ~dsm::BlockId(0);

/// A disk with the pattern on it.
class PatternDisk final : public dsm::BlockReader
{
public:
  ~PatternDisk() override { EXPECT_EQ(this->Hanging, 0); }

  void Read(dsm::BlockId id, std::byte* block, std::size_t bytes) const override
  {
    ++this->Reads;
    std::this_thread::sleep_for(this->Delay.load());
    if (id == this->Bad)
    {
      throw dsm::Error("chunk " + std::to_string(id) + " of the file is damaged");
    }
    {
      std::unique_lock<std::mutex> lock(this->Guard);
      ++this->Hanging;
      this->Changed.wait(lock, [&] { return id != this->Stuck; });
      --this->Hanging;
    }
    this->Fill(id, block, bytes);
  }

  bool ReadWithoutWaiting(dsm::BlockId id, std::byte* block, std::size_t bytes) const override
  {
    if (this->OneInMemory == 0 || this->Looks++ % this->OneInMemory != 0)
    {
      std::fill_n(block, bytes / 2, std::byte(0xaa)); // it was begun
      return false;
    }
    std::unique_lock<std::mutex> lock(this->Guard);
    ++this->AtOnce;
    this->Changed.wait(lock, [&] { return id != this->Stuck; });
    this->Fill(id, block, bytes);
    return true;
  }

  bool MayPrefetch() const override { return this->OneInMemory != 0; }
  void Prefetch(const std::vector<dsm::BlockId>& ids) const override { this->Told += ids.size(); }

  void NoteKept(dsm::BlockId, std::size_t bytes) const override
  {
    EXPECT_EQ(bytes, DiskBlockBytes);
    ++this->Kept;
  }

  bool TryRead(dsm::BlockId id, std::byte* block, std::size_t bytes) const override
  {
    for (std::size_t place = 0; this->AtHand && place < bytes; ++place)
    {
      block[place] = GetPattern(id, place);
    }
    return this->AtHand;
  }

  void SetStuck(dsm::BlockId id)
  {
    {
      const std::lock_guard<std::mutex> lock(this->Guard);
      this->Stuck = id;
    }
    this->Changed.notify_all();
  }

  std::atomic<std::chrono::microseconds> Delay{ std::chrono::microseconds(30) };
  std::atomic<dsm::BlockId> Bad{ NoBlock };
  std::atomic<bool> AtHand{ false }; ///< all was read ahead
  /// Of so many blocks one is in the system's memory whenever it is looked for; 0: none ever is.
  std::atomic<unsigned> OneInMemory{ 0 };
  /// The pattern, unless something else is set: then each byte of every third block is wrong.
  std::atomic<std::byte> OfEveryThird{ std::byte(0xff) };
  mutable std::atomic<std::uint64_t> Reads{ 0 };
  mutable std::atomic<std::uint64_t> Kept{ 0 };
  mutable std::atomic<std::uint64_t> AtOnce{ 0 }; ///< read without waiting
  mutable std::atomic<std::uint64_t> Told{ 0 };

private:
  void Fill(dsm::BlockId id, std::byte* block, std::size_t bytes) const
  {
    for (std::size_t place = 0; place < bytes; ++place)
    {
      block[place] =
        id % 3 == 0 ? ~GetPattern(id, place) ^ this->OfEveryThird : GetPattern(id, place);
    }
  }

  mutable std::atomic<unsigned> Looks{ 0 };
  dsm::BlockId Stuck = NoBlock;
  mutable int Hanging = 0;
  mutable std::mutex Guard;
  mutable std::condition_variable Changed;
};

/// A rank's store, with as many blocks on its disk for each rank as `BlocksOfRank`.
class DiskStore
{
public:
  /// `shares`: ranks of one host know one another.
  DiskStore(dsm::Messenger& messenger, dsm::MemoryOrganization organization,
    std::size_t blocksInMemory, bool shares = false)
    : Messages(messenger)
    , Store(messenger, Make(messenger, organization, blocksInMemory, shares))
    , Disk(std::make_shared<PatternDisk>())
    , Source(std::make_shared<dsm::ReadingSource>(messenger, this->Disk, "the test's disk"))
    , Segment(this->Store.Publish("Opening the file", CreateDirectory(messenger), this->Source))
  {
  }

  static dsm::BlockDirectory CreateDirectory(dsm::Messenger& messenger)
  {
    return dsm_test::MakeDirectory(messenger.GetSize(),
      BlocksOfRank * static_cast<std::size_t>(messenger.GetSize()), DiskBlockBytes);
  }

  /// Besides the blocks, what a rank needs for tables and messages.
  static dsm::BlockStore::Settings Make(dsm::Messenger& messenger,
    dsm::MemoryOrganization organization, std::size_t blocks, bool shares)
  {
    const auto directory = CreateDirectory(messenger);
    const bool alone = messenger.GetSize() == 1;
    dsm::BlockStore::Settings settings;
    settings.Organization = organization;
    settings.MemoryBytes = (blocks + (alone ? 0 : 2)) * DiskBlockBytes +
      (organization == dsm::MemoryOrganization::PageBased
          ? dsm::PagedStore::Segment::CountTableBytes(directory)
          : dsm::BlockTable::CountTableBytes(directory));
    settings.Workers = 2;
    settings.HostSharing = shares;
    return settings;
  }

  void ReadAll() { EXPECT_EQ(this->CountWrong(), 0u); }

  /// Every worker reads every block; bytes that are not the pattern's.
  std::size_t CountWrong()
  {
    if (!this->Store.IsSettled())
    {
      this->Store.Settle();
    }
    std::atomic<std::size_t> wrong{ 0 };
    this->Store.Visit(
      [&](auto& blocks)
      {
        using Blocks = std::decay_t<decltype(blocks)>;
        RunFrame<Blocks>(this->Messages, blocks,
          [&](typename Blocks::Worker& worker, int index)
          {
            const dsm::BlockId count = this->Segment->GetDirectory().GetCount();
            for (dsm::BlockId id = 0; id < count; ++id)
            {
              const dsm::BlockId shifted = (id + static_cast<dsm::BlockId>(7 * index)) % count;
              wrong += Visit(blocks, worker, *this->Segment, shifted);
              blocks.Quiesce(worker);
            }
          });
      });
    return wrong;
  }

  /// A frame in which `work(blocks, worker)` is what each rank's first worker does; the others do nothing.
  template <class Work>
  void RunFirstWorker(const Work& work)
  {
    this->Store.Visit(
      [&](auto& blocks)
      {
        using Blocks = std::decay_t<decltype(blocks)>;
        RunFrame<Blocks>(this->Messages, blocks,
          [&](typename Blocks::Worker& worker, int index)
          {
            if (index == 0)
            {
              work(blocks, worker);
            }
          });
      });
  }

  static constexpr std::size_t BlocksOfRank = 12;

  dsm::Messenger& Messages;
  dsm::BlockStore Store;
  std::shared_ptr<PatternDisk> Disk;
  std::shared_ptr<dsm::ReadingSource> Source;
  std::shared_ptr<dsm::BlockSegment> Segment;
};

/// Frames in which workers that take turns read at random, look ahead, and now and then read what others
/// have just read, through a memory of a few blocks.
inline void RandomAccessToADisk(dsm::Messenger& messenger, dsm::MemoryOrganization organization,
  std::size_t blocks, int frames, bool shares)
{
  DiskStore disks(messenger, organization, blocks, shares);
  disks.Disk->Delay = std::chrono::microseconds(0);
  for (int frame = 0; frame < frames; ++frame)
  {
    disks.Disk->OneInMemory =
      static_cast<unsigned>(frame % 4); // none, all, every second, every third
    std::atomic<std::size_t> wrong{ 0 };
    disks.Store.GetSlots().BeginFrame(disks.Store.GetSettings().Workers);
    disks.Store.Visit(
      [&](auto& store)
      {
        using Blocks = std::decay_t<decltype(store)>;
        RunFrame<Blocks>(messenger, store,
          [&](typename Blocks::Worker& worker, int index)
          {
            const dsm::WorkerSlots::Hold slot(disks.Store.GetSlots());
            std::mt19937 random(
              static_cast<unsigned>(1000 * frame + 10 * index + messenger.GetRank()));
            const dsm::BlockId count = disks.Segment->GetDirectory().GetCount();
            for (int access = 0; access < 60; ++access)
            {
              const dsm::BlockId ids[] = { random() % count, random() % count, random() % count };
              store.Prefetch(*disks.Segment, ids, 2);
              for (const dsm::BlockId id : ids)
              {
                wrong += Visit(store, worker, *disks.Segment, id);
              }
              store.Quiesce(worker);
              if (access % 8 == 7)
              {
                store.Leave(worker);
                disks.Store.GetSlots().LetOthersResume();
                store.Enter(worker);
              }
            }
          });
      });
    EXPECT_EQ(wrong, 0u);
  }
}

} // namespace dsm_test

#endif
