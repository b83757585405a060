// SPDX-License-Identifier: BSD-3-Clause
// Blocks of a segment get other contents, in every memory organization: all ranks read the new bytes, only what
// changed moves, and what fails on one rank fails on all, and leaves room for the next.
#include "DSMCore/publish/FragmentDigests.h"
#include "DSMCore/store/BlockStore.h"
#include "tests/unit/dsmcore/StoreScenarios.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

namespace
{

using UpdateParameters = std::tuple<dsm::MemoryOrganization, int>;

constexpr std::uint32_t UpdateBytes = 4096; // a page
constexpr dsm::BlockId Blocks = 60;

/// Every byte of a block, by its contents' number.
std::byte GetValue(dsm::BlockId id, int contents)
{
  return static_cast<std::byte>(id * 7 + static_cast<dsm::BlockId>(contents) * 31 + 1);
}

/// Each rank yields a slice of the blocks of which `chosen` says so. May fail behind some.
class Source final : public dsm::FragmentSource
{
public:
  Source(dsm::Messenger& messenger, const std::vector<int>& contents,
    const std::vector<bool>& chosen, bool fails = false)
    : Rank(messenger.GetRank())
    , Ranks(messenger.GetSize())
    , Contents(contents)
    , Chosen(chosen)
    , Fails(fails)
  {
  }

  bool Next(dsm::Fragment& fragment) override
  {
    while (this->Id < Blocks && !this->Chosen[this->Id])
    {
      ++this->Id;
    }
    if (this->Fails && this->Id > Blocks / 2)
    {
      throw dsm::Error("the source is dry");
    }
    if (this->Id == Blocks)
    {
      return false;
    }
    const std::uint64_t first = UpdateBytes * static_cast<std::uint64_t>(this->Rank) / this->Ranks;
    const std::uint64_t last =
      UpdateBytes * static_cast<std::uint64_t>(this->Rank + 1) / this->Ranks;
    fragment.Block = this->Id;
    fragment.Bytes.assign(
      sizeof(first) + last - first, GetValue(this->Id, this->Contents[this->Id]));
    std::memcpy(fragment.Bytes.data(), &first, sizeof(first));
    ++this->Id;
    return true;
  }
  double GetProgress() const override { return static_cast<double>(this->Id) / Blocks; }

private:
  int Rank;
  int Ranks;
  const std::vector<int>& Contents;
  const std::vector<bool>& Chosen;
  bool Fails;
  dsm::BlockId Id = 0;
};

dsm::BlockStore::Settings MakeSettings(dsm::MemoryOrganization organization, bool sharing)
{
  dsm::BlockStore::Settings settings;
  settings.Organization = organization;
  settings.MemoryBytes = std::uint64_t(8) << 20;
  settings.Workers = 2;
  settings.HostSharing = sharing;
  return settings;
}

/// All ranks read all blocks.
void Check(dsm::Messenger& messenger, dsm::BlockStore& store, const dsm::BlockSegment& segment,
  const std::vector<int>& contents)
{
  std::atomic<std::size_t> wrong{ 0 };
  store.Visit(
    [&](auto& blocks)
    {
      using Store = std::decay_t<decltype(blocks)>;
      dsm_test::RunFrame<Store>(messenger, blocks,
        [&](typename Store::Worker& worker, int)
        {
          for (dsm::BlockId id = 0; id < Blocks; ++id)
          {
            const typename Store::Pin pin = blocks.Acquire(worker, segment, id);
            for (std::size_t place = 0; place < UpdateBytes; place += 64)
            {
              wrong += pin.GetData()[place] != GetValue(id, contents[id]) ? 1 : 0;
            }
          }
        });
    });
  EXPECT_EQ(wrong, 0u);
}

class SegmentUpdate : public testing::TestWithParam<UpdateParameters>
{
protected:
  void Run(bool sharing, const std::function<void(dsm::Messenger&, dsm::BlockStore&)>& rank)
  {
    dsm_test::RunRanks(std::get<1>(this->GetParam()),
      [&](dsm::Messenger& messenger)
      {
        dsm::BlockStore store(messenger, MakeSettings(std::get<0>(this->GetParam()), sharing));
        rank(messenger, store);
      });
  }

  static std::shared_ptr<dsm::BlockSegment> Publish(
    dsm::Messenger& messenger, dsm::BlockStore& store, const std::vector<int>& contents)
  {
    const std::vector<bool> all(Blocks, true);
    Source source(messenger, contents, all);
    dsm_test::PatternSink sink;
    return store.Publish("Publishing",
      dsm_test::MakeDirectory(messenger.GetSize(), Blocks, UpdateBytes), source, sink);
  }

  static void Update(dsm::Messenger& messenger, dsm::BlockStore& store,
    const std::shared_ptr<dsm::BlockSegment>& segment, const std::vector<int>& contents,
    const std::vector<bool>& chosen, bool fails = false)
  {
    Source source(messenger, contents, chosen, fails);
    dsm_test::PatternSink sink;
    store.Update("Updating", segment, chosen, source, sink);
  }
};

INSTANTIATE_TEST_SUITE_P(OrganizationsAndRanks, SegmentUpdate,
  testing::Combine(
    testing::Values(dsm::MemoryOrganization::Automatic, dsm::MemoryOrganization::ObjectBased,
      dsm::MemoryOrganization::PageBased, dsm::MemoryOrganization::Replicated),
    testing::Values(1, 3)));

TEST_P(SegmentUpdate, AllRanksReadWhatChanged)
{
  for (const bool sharing : { false, true })
  {
    this->Run(sharing,
      [](dsm::Messenger& messenger, dsm::BlockStore& store)
      {
        std::vector<int> contents(Blocks, 0);
        const auto segment = Publish(messenger, store, contents);
        Check(messenger, store, *segment, contents);
        ASSERT_TRUE(store.MayUpdate(segment));
        for (int step = 1; step <= 4; ++step)
        {
          std::vector<bool> chosen(Blocks);
          std::uint64_t mine = 0;
          for (dsm::BlockId id = static_cast<dsm::BlockId>(step); id < Blocks;
               id += static_cast<dsm::BlockId>(10 / step))
          {
            chosen[id] = true;
            contents[id] = step;
            mine += segment->GetDirectory().GetOwner(id) == messenger.GetRank() ? 1 : 0;
          }
          const std::uint64_t before = store.GetCounters().BytesPublished;
          const std::uint32_t version = segment->GetVersion();
          Update(messenger, store, segment, contents, chosen);
          EXPECT_GT(segment->GetVersion(), version);
          const std::uint64_t moved = store.GetCounters().BytesPublished - before;
          const std::uint64_t heads = mine * static_cast<std::uint64_t>(messenger.GetSize()) * 8;
          EXPECT_EQ(moved, mine * UpdateBytes + heads);
          Check(messenger, store, *segment, contents);
          EXPECT_LE(
            store.GetCounters().BytesReceived, (Blocks / 10 + 1) * 10 * (UpdateBytes + 100));
        }
        store.Retire(segment);
      });
  }
}

/// A block that is made again, and is what it was, stays in the caches of others.
TEST_P(SegmentUpdate, WhatIsEqualIsNotFetchedAgain)
{
  this->Run(false,
    [](dsm::Messenger& messenger, dsm::BlockStore& store)
    {
      std::vector<int> contents(Blocks, 0);
      const auto segment = Publish(messenger, store, contents);
      Check(messenger, store, *segment, contents);
      contents[5] = 1;
      Update(messenger, store, segment, contents, std::vector<bool>(Blocks, true));
      Check(messenger, store, *segment, contents);
      EXPECT_LE(store.GetCounters().BytesReceived, UpdateBytes + 100) << "one block at most";
    });
}

TEST_P(SegmentUpdate, FailsOnAllRanksAndLeavesRoomForTheNext)
{
  this->Run(false,
    [](dsm::Messenger& messenger, dsm::BlockStore& store)
    {
      std::vector<int> contents(Blocks, 0);
      const auto segment = Publish(messenger, store, contents);
      Check(messenger, store, *segment, contents);
      contents.assign(Blocks, 1);
      const std::vector<bool> all(Blocks, true);
      const std::string text = dsm_test::GetErrorText(
        [&]
        {
          Update(messenger, store, segment, contents, all,
            messenger.GetRank() == messenger.GetSize() - 1);
        });
      EXPECT_NE(text.find("the source is dry"), std::string::npos) << text;
      store.Retire(segment);
      EXPECT_FALSE(store.MayUpdate(segment));
      const auto again = Publish(messenger, store, contents);
      Check(messenger, store, *again, contents);
    });
}

TEST(FragmentDigests, TellFragmentsApart)
{
  dsm::Fragment fragment;
  fragment.Bytes.assign(1000, std::byte{ 3 });
  const auto digest = [&](std::size_t place, std::byte value)
  {
    dsm::FragmentDigests digests(1);
    const std::byte old = fragment.Bytes[place];
    fragment.Bytes[place] = value;
    digests.Add(fragment);
    fragment.Bytes[place] = old;
    return digests;
  };
  const dsm::FragmentDigests same = digest(0, std::byte{ 3 });
  for (std::size_t place = 0; place < fragment.Bytes.size(); ++place)
  {
    EXPECT_TRUE(same.IsSame(digest(place, std::byte{ 3 }), 0));
    EXPECT_FALSE(same.IsSame(digest(place, std::byte{ 4 }), 0));
    EXPECT_FALSE(same.IsSame(digest(place, std::byte{ 131 }), 0)) << "the highest bit";
  }
  dsm::FragmentDigests twice = digest(0, std::byte{ 3 });
  twice.Add(fragment);
  EXPECT_FALSE(same.IsSame(twice, 0));
  fragment.Bytes.push_back(std::byte{ 0 });
  EXPECT_FALSE(same.IsSame(digest(0, std::byte{ 3 }), 0)) << "a zero behind";
}

} // namespace
