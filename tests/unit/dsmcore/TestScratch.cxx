// SPDX-License-Identifier: BSD-3-Clause
// Blocks that do not fit the memory go to a scratch directory, in every memory organization: the same bytes, within
// the memory, and what is wrong with the directory is said on every rank.
#include "DSMCore/fetch/ReadingSource.h"
#include "DSMCore/store/BlockStore.h"
#include "DSMCore/store/ScratchBlocks.h"
#include "tests/unit/dsmcore/StoreScenarios.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include <sys/resource.h>

namespace
{

using Place = dsm::BlockStore::Place;
using ScratchParameters = std::tuple<dsm::MemoryOrganization, int>;

constexpr std::uint32_t ScratchBytes = 4096; // a page
constexpr std::size_t BlocksOfRank = 40;

/// A directory that is empty at the end, whatever happened: the files in it have no names.
class Directory
{
public:
  Directory()
  {
    std::string name = (std::filesystem::temp_directory_path() / "dsm-test-XXXXXX").string();
    EXPECT_NE(mkdtemp(name.data()), nullptr);
    this->Path = name;
  }
  ~Directory()
  {
    EXPECT_TRUE(std::filesystem::is_empty(this->Path));
    std::filesystem::remove_all(this->Path);
  }

  /// Writes one wrong byte to every file that was made here.
  void Damage() const
  {
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd"))
    {
      std::error_code gone;
      const std::string target = std::filesystem::read_symlink(entry.path(), gone).string();
      if (target.find(this->Path) == 0)
      {
        std::fstream file(entry.path(), std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(5 * ScratchBytes + 123);
        const auto old = static_cast<char>(file.peek());
        file.seekp(5 * ScratchBytes + 123);
        file.put(static_cast<char>(old + 1));
      }
    }
  }

  std::string Path;
};

dsm::BlockStore::Settings MakeSettings(dsm::Messenger& messenger,
  dsm::MemoryOrganization organization, std::size_t blocks, const std::string& scratch)
{
  const int ranks = messenger.GetSize();
  auto directory =
    dsm_test::MakeDirectory(ranks, BlocksOfRank * static_cast<std::size_t>(ranks), ScratchBytes);
  // What is on its way from and to the disk.
  directory.AddIndexBytes(dsm::ReadingSource::MostReads * ScratchBytes +
    dsm::ScratchBlocks::CountTableBytes(directory, ranks));
  dsm::BlockStore::Settings settings;
  settings.Organization = organization;
  settings.MemoryBytes = (blocks + (ranks == 1 ? 0 : 2)) * ScratchBytes +
    (organization == dsm::MemoryOrganization::PageBased
        ? dsm::PagedStore::Segment::CountTableBytes(directory)
        : dsm::BlockTable::CountTableBytes(directory));
  settings.Workers = 2;
  settings.HostSharing = false;
  settings.ScratchDirectory = scratch;
  return settings;
}

std::shared_ptr<dsm::BlockSegment> Publish(
  dsm::Messenger& messenger, dsm::BlockStore& store, Place place)
{
  const int ranks = messenger.GetSize();
  const auto directory =
    dsm_test::MakeDirectory(ranks, BlocksOfRank * static_cast<std::size_t>(ranks), ScratchBytes);
  dsm_test::PatternSource source(
    directory, messenger.GetRank(), ranks, dsm_test::Spread::EveryRankASlice, 1000);
  dsm_test::PatternSink sink;
  double told = 0.0;
  auto segment = store.Publish(
    "Publishing", directory, source, sink,
    [&](double part)
    {
      EXPECT_GE(part, told);
      told = part;
    },
    place);
  EXPECT_EQ(told, 1.0);
  EXPECT_EQ(sink.Absorbed, sink.Expected);
  EXPECT_EQ(sink.Begun, sink.Finished);
  return segment;
}

void ReadAll(dsm::Messenger& messenger, dsm::BlockStore& store, const dsm::BlockSegment& segment)
{
  if (!store.IsSettled())
  {
    store.Settle();
  }
  std::atomic<std::size_t> wrong{ 0 };
  store.Visit(
    [&](auto& blocks)
    {
      using Blocks = std::decay_t<decltype(blocks)>;
      dsm_test::RunFrame<Blocks>(messenger, blocks,
        [&](typename Blocks::Worker& worker, int index)
        {
          const dsm::BlockId count = segment.GetDirectory().GetCount();
          for (dsm::BlockId id = 0; id < count; ++id)
          {
            const dsm::BlockId shifted = (id + static_cast<dsm::BlockId>(7 * index)) % count;
            wrong += dsm_test::Visit(blocks, worker, segment, shifted);
            blocks.Quiesce(worker);
          }
        });
    });
  EXPECT_EQ(wrong, 0u);
}

class Scratch : public testing::TestWithParam<ScratchParameters>
{
protected:
  void Run(const std::function<void(dsm::Messenger&, dsm::MemoryOrganization)>& rank)
  {
    dsm_test::RunRanks(std::get<1>(this->GetParam()),
      [&](dsm::Messenger& messenger) { rank(messenger, std::get<0>(this->GetParam())); });
  }

  Directory Disk;
};

INSTANTIATE_TEST_SUITE_P(OrganizationsAndRanks, Scratch,
  testing::Combine(
    testing::Values(dsm::MemoryOrganization::Automatic, dsm::MemoryOrganization::ObjectBased,
      dsm::MemoryOrganization::PageBased, dsm::MemoryOrganization::Replicated),
    testing::Values(1, 3)));

TEST_P(Scratch, HoldsWhatDoesNotFitTheMemory)
{
  this->Run(
    [this](dsm::Messenger& messenger, dsm::MemoryOrganization organization)
    {
      dsm::BlockStore store(messenger, MakeSettings(messenger, organization, 6, this->Disk.Path));
      const std::string refused =
        dsm_test::GetErrorText([&] { Publish(messenger, store, Place::Memory); });
      EXPECT_NE(refused.find("(DSMScratchDirectory)"), std::string::npos) << refused;

      const auto segment = Publish(messenger, store, Place::Scratch);
      const std::string& text = store.GetExplanation();
      EXPECT_NE(text.find("are in scratch files"), std::string::npos) << text;
      EXPECT_TRUE(store.LacksMemory());
      for (int frame = 0; frame < 2; ++frame)
      {
        ReadAll(messenger, store, *segment);
        const auto counters = store.GetCounters();
        EXPECT_EQ(counters.ResidentBytes, 0u);
        EXPECT_GT(counters.Evictions, 0u);
        EXPECT_LE(counters.TableBytes + counters.PeakCachedBytes, counters.MemoryBudget);
      }
      std::size_t count = 0;
      segment->ForEachResident(
        [&](dsm::BlockId id, const std::byte* block, std::size_t bytes)
        {
          ++count;
          EXPECT_EQ(dsm_test::CountWrongBytes(id, block, bytes), 0u);
        });
      EXPECT_EQ(count, BlocksOfRank);
      store.Retire(segment);
    });
}

/// What is wrong with the disk is every rank's error, at once, and over when the disk is well again.
TEST_P(Scratch, FaultsAreToldAndPass)
{
  const auto expect = [&](const std::string& scratch, const char* said)
  {
    this->Run(
      [&](dsm::Messenger& messenger, dsm::MemoryOrganization organization)
      {
        auto settings = MakeSettings(messenger, organization, 6, scratch);
        dsm::BlockStore store(messenger, settings);
        for (int attempt = 0; attempt < 2; ++attempt)
        {
          const std::string text =
            dsm_test::GetErrorText([&] { Publish(messenger, store, Place::Scratch); });
          EXPECT_NE(
            text.find("directory '" + scratch + "' (DSMScratchDirectory)"), std::string::npos)
            << text;
          EXPECT_NE(
            text.find(std::to_string(BlocksOfRank * ScratchBytes) + " bytes"), std::string::npos)
            << text;
          EXPECT_NE(text.find(said), std::string::npos) << text;
        }
        settings.ScratchDirectory = this->Disk.Path;
        if (scratch != this->Disk.Path)
        {
          store.SetSettings(settings);
          const auto segment = Publish(messenger, store, Place::Scratch);
          ReadAll(messenger, store, *segment);
        }
      });
  };
  expect(this->Disk.Path + "/nowhere", "No such file or directory");
  expect("/proc", "");
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
  rlimit low = limit;
  low.rlim_cur = BlocksOfRank * ScratchBytes - 1;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &low), 0);
  expect(this->Disk.Path, "File too large. Free space on its disk");
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
}

TEST_P(Scratch, DamageIsSeenAndTheNextFrameWorks)
{
  this->Run(
    [this](dsm::Messenger& messenger, dsm::MemoryOrganization organization)
    {
      dsm::BlockStore store(messenger, MakeSettings(messenger, organization, 6, this->Disk.Path));
      const auto segment = Publish(messenger, store, Place::Scratch);
      messenger.Barrier();
      if (messenger.GetRank() == 0)
      {
        this->Disk.Damage();
      }
      messenger.Barrier();
      const std::string text = dsm_test::GetErrorText([&] { ReadAll(messenger, store, *segment); });
      EXPECT_NE(text.find("Brick "), std::string::npos) << text;
      EXPECT_NE(text.find("has a wrong checksum"), std::string::npos) << text;
      messenger.Barrier();
      store.Retire(segment);
      const auto again = Publish(messenger, store, Place::Scratch);
      ReadAll(messenger, store, *again);
    });
}

/// A brick is put together with a few in memory: what comes late finds it on the disk.
TEST(ScratchBlocks, FragmentsComeInAnyOrder)
{
  const Directory disk;
  const auto directory = dsm_test::MakeDirectory(1, BlocksOfRank, ScratchBytes);
  dsm::ScratchBlocks blocks(directory, 0, 1);
  dsm_test::PatternSink sink;
  blocks.Open(disk.Path);
  for (std::uint64_t first = 0; first < ScratchBytes; first += ScratchBytes / 4)
  {
    for (dsm::BlockId id = 0; id < BlocksOfRank; ++id)
    {
      std::vector<std::byte> fragment(sizeof(first) + ScratchBytes / 4);
      std::memcpy(fragment.data(), &first, sizeof(first));
      for (std::uint64_t place = 0; place < ScratchBytes / 4; ++place)
      {
        fragment[sizeof(first) + place] = dsm_test::GetPattern(id, first + place);
      }
      blocks.Absorb(id, fragment.data(), fragment.size(), sink);
    }
  }
  blocks.Finish(sink, {});
  std::vector<std::byte> block(ScratchBytes);
  for (dsm::BlockId id = 0; id < BlocksOfRank; ++id)
  {
    blocks.Read(id, block.data(), block.size());
    EXPECT_EQ(dsm_test::CountWrongBytes(id, block.data(), block.size()), 0u);
  }
  // It is in the system's memory now.
  for (dsm::BlockId id = 0; id < BlocksOfRank; ++id)
  {
    blocks.Prefetch({ id });
    std::fill(block.begin(), block.end(), std::byte(0));
    const bool isRead = blocks.ReadWithoutWaiting(id, block.data(), block.size());
    EXPECT_EQ(isRead, blocks.MayPrefetch()) << "unless the file system cannot tell";
    EXPECT_EQ(!isRead, dsm_test::CountWrongBytes(id, block.data(), block.size()) != 0u);
  }
  disk.Damage();
  EXPECT_FALSE(blocks.ReadWithoutWaiting(5, block.data(), block.size())) << "its checksum is wrong";
  EXPECT_THROW(blocks.Read(5, block.data(), block.size()), dsm::Error);
}

} // namespace
