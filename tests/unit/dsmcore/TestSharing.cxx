// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/memory/HostMemory.h"
#include "DSMCore/memory/HostSharedMemory.h"
#include "DSMCore/publish/HostGroups.h"
#include "DSMCore/table/BlockTable.h"
#include "tests/unit/dsmcore/PairScenarios.h"
#include "tests/unit/dsmcore/SharingScenarios.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

namespace
{

class SharingOnLoopback : public testing::TestWithParam<int>
{
};

INSTANTIATE_TEST_SUITE_P(Ranks, SharingOnLoopback, testing::Values(1, 3));

#define RUN_SCENARIO(scenario)                                                                     \
  TEST_P(SharingOnLoopback, scenario)                                                              \
  {                                                                                                \
    dsm_test::RunRanks(this->GetParam(), dsm_test::scenario);                                      \
  }

RUN_SCENARIO(EveryRankHasEveryBlock)
RUN_SCENARIO(EveryHostHasEveryBlockOnce)
RUN_SCENARIO(SharedBlocksAreHits)
RUN_SCENARIO(SharedMemoryOutlivesItsOwner)
RUN_SCENARIO(CopiesOnceAGroup)
RUN_SCENARIO(AutomaticFollowsTheData)
RUN_SCENARIO(OrganizationsChangeUnderTheData)
RUN_SCENARIO(TooLittleMemoryIsRefusedWithNumbers)

TEST(SharingOnLoopback, GroupsOfManyRanks)
{
  dsm_test::RunRanks(7, dsm_test::CopiesOnceAGroup);
}

/// As long as it lives, the process can open no more files.
class NoMoreFiles
{
public:
  NoMoreFiles()
  {
    getrlimit(RLIMIT_NOFILE, &this->Before);
    rlimit limit = this->Before;
    const int next = open("/dev/null", O_RDONLY | O_CLOEXEC);
    close(next);
    limit.rlim_cur = static_cast<rlim_t>(next);
    setrlimit(RLIMIT_NOFILE, &limit);
  }
  ~NoMoreFiles() { setrlimit(RLIMIT_NOFILE, &this->Before); }

private:
  rlimit Before{};
};

/// Whoever cannot map the others' memory gets their blocks by messages.
TEST(HostSharing, FallsBackToMessages)
{
  const NoMoreFiles limit;
  dsm_test::RunRanks(3,
    [](dsm::Messenger& messenger)
    {
      const auto directory = dsm_test::MakeOddDirectory(3);
      dsm::ObjectStore::Settings settings;
      settings.HostSharing = true;
      dsm::ObjectStore store(messenger, settings);
      const auto segment = dsm_test::PublishPattern(messenger, store, directory);
      dsm_test::ReadEverything(messenger, store, *segment);
      EXPECT_GT(store.GetCounters().Workers.Misses, 0u);
      EXPECT_EQ(store.GetCounters().SharedBytes, 0u);
      dsm::ReplicatedStore::Settings everywhere;
      everywhere.HostSharing = true;
      dsm::ReplicatedStore replicated(messenger, everywhere);
      const auto copied = dsm_test::PublishPattern(messenger, replicated, directory);
      dsm_test::ReadEverything(messenger, replicated, *copied);
      EXPECT_GT(replicated.GetCounters().ReplicaBytes, 0u);
      EXPECT_EQ(replicated.GetCounters().SharedBytes, 0u);
    });
}

/// The trial succeeded, but then there is no memory to share.
TEST(HostSharing, MemoryThatCannotBeMappedStaysRemote)
{
  const NoMoreFiles limit;
  dsm_test::RunRanks(2,
    [](dsm::Messenger& messenger)
    {
      dsm::BlockTable table(messenger.BeginSession(), dsm_test::MakeDirectory(2, 4, 100),
        messenger.GetRank(), dsm::HostGroups({ 0, 0 }));
      table.Meet(messenger);
      table.Seal();
      EXPECT_EQ(table.GetSharedBytes(), 0u);
      EXPECT_FALSE(table.IsWhole());
      EXPECT_EQ(table.Find(static_cast<dsm::BlockId>(1 - messenger.GetRank())), nullptr);
      const std::string text =
        dsm_test::GetErrorText([&] { table.Replicate(messenger, "Copying"); });
      EXPECT_EQ(text.find("Copying: Rank 0: Cannot map the memory of rank 1"), 0u) << text;
      EXPECT_NE(text.find("DSMHostSharing"), std::string::npos) << text;
      EXPECT_FALSE(table.IsReplicated());
    });
}

/// One rank that does not share keeps to itself; the others share.
TEST(HostSharing, RankThatDoesNotWantToShareIsLeftOut)
{
  dsm_test::RunRanks(3,
    [](dsm::Messenger& messenger)
    {
      const auto groups = dsm::HostGroups::Find(messenger, messenger.GetRank() != 1);
      EXPECT_EQ(groups->GetGroupCount(), 2);
      EXPECT_TRUE(groups->AreTogether(0, 2));
      EXPECT_FALSE(groups->AreTogether(0, 1));
      EXPECT_EQ(groups->GetMembers(2), (std::vector<int>{ 0, 2 }));
      EXPECT_EQ(groups->GetMembers(1), (std::vector<int>{ 1 }));
    });
}

TEST(HostGroups, HoldersTakeTurns)
{
  const dsm::HostGroups groups({ 0, 0, 2, 2, 2 });
  EXPECT_EQ(groups.GetGroupCount(), 2);
  std::vector<int> held(5, 0);
  for (dsm::BlockId id = 0; id < 300; ++id)
  {
    const int owner = static_cast<int>(id % 5);
    EXPECT_EQ(groups.GetHolder(id, owner, groups.GetGroup(owner)), owner);
    ++held[static_cast<std::size_t>(groups.GetHolder(id, owner, 1 - groups.GetGroup(owner)))];
  }
  EXPECT_EQ(held, (std::vector<int>{ 90, 90, 40, 40, 40 }));

  // Also of the blocks of one owner, whose numbers, of four ranks, are all even.
  const dsm::HostGroups four({ 0, 0, 2, 2 });
  std::vector<int> heldOfOne(2, 0);
  for (dsm::BlockId id = 2; id < 200; id += 4)
  {
    ++heldOfOne[static_cast<std::size_t>(four.GetHolder(id, 2, four.GetGroup(0)))];
  }
  EXPECT_EQ(heldOfOne, (std::vector<int>{ 25, 25 }));
}

// -- HostSharedMemory ------------------------------------------------------------------------------

/// `ulimit -f` holds for memory that is shared, too, and exceeding it would end the process by a signal.
TEST(HostSharedMemory, IsNotSharedBeyondTheLimitOfFiles)
{
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit low = before;
  low.rlim_cur = rlim_t(1) << 20;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &low), 0);
  const dsm::HostSharedMemory small(std::size_t(1) << 16, true);
  const dsm::HostSharedMemory large(std::size_t(2) << 20, true);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  EXPECT_GE(small.GetTicket().File, 0);
  EXPECT_LT(large.GetTicket().File, 0);
  EXPECT_NE(large.GetData(), nullptr);
}

TEST(HostSharedMemory, IsZeroedAndSeenByOthers)
{
  for (const std::size_t bytes :
    { std::size_t(0), std::size_t(1), std::size_t(4096), std::size_t(4097), std::size_t(5) << 20 })
  {
    dsm::HostSharedMemory memory(bytes, true);
    const auto ticket = memory.GetTicket();
    ASSERT_GE(ticket.File, 0);
    std::byte* const data = memory.GetData();
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(data) % dsm::BlockAlignment, 0u);
    EXPECT_TRUE(std::all_of(data, data + bytes, [](std::byte b) { return b == std::byte{ 0 }; }));
    const auto view = dsm::HostSharedMemory::Open(ticket);
    ASSERT_TRUE(view);
    ASSERT_NE(view->GetData(), data);
    if (bytes > 0)
    {
      data[bytes - 1] = std::byte{ 42 };
      EXPECT_EQ(view->GetData()[bytes - 1], std::byte{ 42 });
    }
  }
}

TEST(HostSharedMemory, ViewsOutliveTheOwner)
{
  std::optional<dsm::HostSharedMemory::View> view;
  dsm::HostSharedMemory::Ticket ticket;
  {
    dsm::HostSharedMemory memory(100, true);
    std::memset(memory.GetData(), 7, 100);
    ticket = memory.GetTicket();
    view = dsm::HostSharedMemory::Open(ticket);
    memory.CloseDoor();
    EXPECT_LT(memory.GetTicket().File, 0);
    EXPECT_FALSE(dsm::HostSharedMemory::Open(ticket));
    dsm::HostSharedMemory moved(std::move(memory));
    EXPECT_EQ(moved.GetData()[99], std::byte{ 7 });
  }
  ASSERT_TRUE(view);
  EXPECT_EQ(view->GetData()[99], std::byte{ 7 });
}

TEST(HostSharedMemory, WrongTicketsAreRefused)
{
  dsm::HostSharedMemory memory(100, true);
  const auto good = memory.GetTicket();
  EXPECT_TRUE(dsm::HostSharedMemory::Open(good));
  auto ticket = good;
  ++ticket.Token[1]; // another container's process of the same number
  EXPECT_FALSE(dsm::HostSharedMemory::Open(ticket));
  ticket = good;
  ticket.Bytes = 200;
  EXPECT_FALSE(dsm::HostSharedMemory::Open(ticket));
  ticket = good;
  ticket.Process = 1u << 30;
  EXPECT_FALSE(dsm::HostSharedMemory::Open(ticket));
  ticket = good;
  ticket.File = 0;
  EXPECT_FALSE(dsm::HostSharedMemory::Open(ticket));
  EXPECT_FALSE(dsm::HostSharedMemory::Open(dsm::HostSharedMemory::Ticket{}));
}

TEST(HostSharedMemory, WithoutSharingItIsOrdinaryMemory)
{
  dsm::HostSharedMemory memory(100, false);
  ASSERT_NE(memory.GetData(), nullptr);
  EXPECT_LT(memory.GetTicket().File, 0);
  const NoMoreFiles limit;
  dsm::HostSharedMemory refused(100, true);
  ASSERT_NE(refused.GetData(), nullptr);
  refused.GetData()[99] = std::byte{ 1 };
  EXPECT_LT(refused.GetTicket().File, 0);
}

// -- Stores ----------------------------------------------------------------------------------------

TEST(BlockStore, MoreCopiesThanTheMemoryHoldsAreRefusedWithTheNumberOfBytes)
{
  dsm_test::RunRanks(2,
    [](dsm::Messenger& messenger)
    {
      const auto directory = dsm_test::MakeDirectory(2, 10, 1000);
      constexpr std::uint64_t need = 10 * 1024 + 10 * 20;
      constexpr auto replicated = dsm::MemoryOrganization::Replicated;
      // Only rank 1 is short; both hear of it.
      dsm::BlockStore store(messenger,
        dsm_test::MakeStoreSettings(replicated, messenger.GetRank() == 1 ? need - 1 : 1 << 20));
      dsm_test::PatternSource source(
        directory, messenger.GetRank(), 2, dsm_test::Spread::EveryRankASlice, 100);
      dsm_test::PatternSink sink;
      const std::string text =
        dsm_test::GetErrorText([&] { store.Publish("Loading", directory, source, sink); });
      EXPECT_EQ(text.find("Loading: A copy of all data on every rank takes "), 0u) << text;
      EXPECT_NE(text.find(std::to_string(need) + " bytes) of rank 1's"), std::string::npos) << text;
      EXPECT_TRUE(sink.Begun.empty());
      store.SetSettings(dsm_test::MakeStoreSettings(replicated, need));
      const auto segment = dsm_test::PublishPattern(messenger, store, directory);
      dsm_test::ReadEverything(messenger, store, *segment);
      // What is there counts.
      dsm_test::PatternSource again(
        directory, messenger.GetRank(), 2, dsm_test::Spread::EveryRankASlice, 100);
      EXPECT_THROW(store.Publish("Loading", directory, again, sink), dsm::Error);
    });
}

TEST(ReplicatedStore, PairsAreHere)
{
  dsm_test::RunRanks(3,
    [](dsm::Messenger& messenger)
    {
      dsm::ReplicatedStore::Settings settings;
      settings.Workers = 4;
      dsm::ReplicatedStore store(messenger, settings);
      dsm_test::ReadRandomPairs(messenger, store, 512);
    });
}

TEST(ReplicatedStore, WithinAFrameNothingIsRearranged)
{
  dsm_test::RunRanks(1,
    [](dsm::Messenger& messenger)
    {
      dsm::ReplicatedStore store(messenger, {});
      const auto directory = dsm_test::MakeDirectory(1, 2, 100);
      const auto segment = dsm_test::PublishPattern(messenger, store, directory);
      dsm::ReplicatedStore::Settings none;
      none.Workers = 0;
      EXPECT_THROW(store.SetSettings(none), dsm::Error);
      store.BeginFrame();
      EXPECT_THROW(store.SetSettings({}), dsm::Error);
      EXPECT_THROW(store.Retire(segment), dsm::Error);
      EXPECT_THROW(store.BeginFrame(), dsm::Error);
      EXPECT_THROW(dsm_test::PublishPattern(messenger, store, directory), dsm::Error);
      store.EndFrame();
      store.Retire(segment);
      store.Retire(segment); // nothing left to do
      store.Retire(nullptr);
    });
}

TEST(BlockStore, RanksThatDisagreeAreTold)
{
  dsm_test::RunRanks(2,
    [](dsm::Messenger& messenger)
    {
      const bool last = messenger.GetRank() == 1;
      dsm::BlockStore store(
        messenger, dsm_test::MakeStoreSettings(dsm::MemoryOrganization::Automatic, 1 << 20));
      const auto publish = [&](std::size_t blocks)
      {
        const auto directory = dsm_test::MakeDirectory(2, blocks, 100);
        dsm_test::PatternSource source(
          directory, messenger.GetRank(), 2, dsm_test::Spread::EveryRankASlice, 100);
        dsm_test::PatternSink sink;
        return dsm_test::GetErrorText([&] { store.Publish("Loading", directory, source, sink); });
      };
      EXPECT_NE(publish(last ? 5 : 4).find("disagree"), std::string::npos);
      store.SetSettings(dsm_test::MakeStoreSettings(
        last ? dsm::MemoryOrganization::Replicated : dsm::MemoryOrganization::ObjectBased,
        1 << 20));
      EXPECT_NE(publish(4).find("disagree"), std::string::npos);
    });
}

/// The rank with the least memory decides for all.
TEST(BlockStore, AutomaticHeedsEveryRanksMemory)
{
  dsm_test::RunRanks(3,
    [](dsm::Messenger& messenger)
    {
      dsm::BlockStore store(messenger,
        dsm_test::MakeStoreSettings(
          dsm::MemoryOrganization::Automatic, messenger.GetRank() == 2 ? 9 * 1024 : 1 << 20));
      const auto directory = dsm_test::MakeDirectory(3, 12, 1000);
      const auto segment = dsm_test::PublishPattern(messenger, store, directory);
      EXPECT_EQ(store.GetOrganization(), dsm::MemoryOrganization::ObjectBased);
      dsm_test::ReadEverything(messenger, store, *segment);
      const auto counters = store.GetCounters();
      EXPECT_LE(counters.ResidentBytes + counters.TableBytes + counters.PeakCachedBytes,
        counters.MemoryBudget);
    });
}

/// An explicit size limits the cache below what the budget leaves.
TEST(BlockStore, CacheSizeIsAnUpperLimit)
{
  dsm_test::RunRanks(2,
    [](dsm::Messenger& messenger)
    {
      auto settings = dsm_test::MakeStoreSettings(dsm::MemoryOrganization::ObjectBased, 1 << 20);
      settings.CacheBytes = 3 * 1024;
      dsm::BlockStore store(messenger, settings);
      const auto segment =
        dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(2, 40, 1000));
      EXPECT_EQ(store.GetCounters().CacheCapacity, 3 * 1024u);
      settings.CacheBytes = SIZE_MAX;
      store.SetSettings(settings);
      EXPECT_FALSE(store.IsSettled());
      store.Settle();
      EXPECT_EQ(store.GetCounters().CacheCapacity,
        dsm_test::GetCacheRoom(1u << 20, 20 * 1024u + store.GetCounters().TableBytes));
      dsm_test::ReadEverything(messenger, store, *segment);
    });
}

TEST(BlockStore, WithoutABudgetHalfOfTheHostIsShared)
{
  dsm_test::RunRanks(2,
    [](dsm::Messenger& messenger)
    {
      dsm::BlockStore store(
        messenger, dsm_test::MakeStoreSettings(dsm::MemoryOrganization::Automatic, 0));
      EXPECT_EQ(store.GetMemoryBytes(), 0u);
      const auto segment =
        dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(2, 4, 1000));
      const std::uint64_t share = dsm::GetAvailableHostMemory() / 4;
      EXPECT_GT(store.GetMemoryBytes(), share / 2);
      EXPECT_LT(store.GetMemoryBytes(), share * 2);
      EXPECT_EQ(store.GetOrganization(), dsm::MemoryOrganization::Replicated);
    });
}

// -- MemoryPlan ------------------------------------------------------------------------------------

using Budget = dsm::MemoryPlan::Budget;

TEST(MemoryPlan, RankCountThatWouldDo)
{
  const auto directory = dsm_test::MakeDirectory(2, 100, 1024);
  const dsm::BlockDirectory small({ 64, 64, 64 }, dsm::RoundRobinAssigner(2));
  const auto find = [&](std::uint64_t bytes)
  {
    const dsm::MemoryPlan plan({ &directory, &small }, dsm::HostGroups::Separate(2),
      std::vector<Budget>(2, Budget{ bytes, bytes }), 4096);
    return plan.FindRankCount(dsm::MemoryOrganization::ObjectBased);
  };
  // A rank of 10 has ten blocks, the first three a small one, and all the tables, a cache of one and
  // two in messages.
  constexpr std::uint64_t besides = 103 * (16 + 4) + 3 * 1024;
  EXPECT_EQ(find(besides + 10 * 1024 + 64), 10);
  EXPECT_EQ(find(besides + 10 * 1024 + 63), 12);
  EXPECT_EQ(find(200 * 1024), 1);
  EXPECT_EQ(find(besides + 1024 + 64), 100);
  EXPECT_EQ(find(besides + 1024 + 63), 0);
  EXPECT_EQ(find(100), 0);
}

/// Once over the blocks for all ranks: what each rank would count of its own.
TEST(MemoryPlan, PairsNeedRoomForOneBlockMore)
{
  auto directory = dsm_test::MakeDirectory(2, 10, 1024);
  const auto getNeed = [&]
  {
    const dsm::MemoryPlan plan({ &directory }, dsm::HostGroups::Separate(2),
      std::vector<Budget>(2, Budget{ 1 << 20, 1 << 20 }), 4096);
    return plan.GetNeed(dsm::MemoryOrganization::ObjectBased, 0);
  };
  const std::uint64_t before = getNeed();
  directory.SetPaired();
  EXPECT_EQ(getNeed(), before + 1024);
}

TEST(MemoryPlan, CopiesAreThoseOfTheHolders)
{
  const dsm::HostGroups groups({ 0, 1, 0, 3, 1, 0, 1, 1, 3 }); // of 3, 4 and 2 ranks
  const auto directory = dsm_test::MakeDirectory(9, 211, 1000);
  const dsm::BlockDirectory small({ 64, 128, 64, 640 }, dsm::RoundRobinAssigner(9));
  const dsm::MemoryPlan plan(
    { &directory, &small }, groups, std::vector<Budget>(9, Budget{ 1 << 20, 1 << 20 }), 4096);
  for (int rank = 0; rank < 9; ++rank)
  {
    const std::uint64_t mine = dsm::BlockTable::CountReplicaBytes(directory, groups, rank) +
      dsm::BlockTable::CountReplicaBytes(small, groups, rank);
    EXPECT_GT(mine, 0u);
    EXPECT_EQ(plan.GetNeed(dsm::MemoryOrganization::Replicated, rank) -
        plan.GetNeed(dsm::MemoryOrganization::ObjectBased, rank),
      mine - 3 * 1024)
      << rank;
  }
}

TEST(MemoryPlan, PagesAreWhole)
{
  const auto directory = dsm_test::MakeDirectory(2, 10, 1000);
  constexpr std::uint64_t need = 8 * 4096 + 10 * 32;
  const dsm::MemoryPlan plan({ &directory }, dsm::HostGroups::Separate(2),
    std::vector<Budget>(2, Budget{ need, need }), 4096);
  EXPECT_EQ(plan.GetNeed(dsm::MemoryOrganization::PageBased, 0), need);
  EXPECT_EQ(plan.GetRoom(dsm::MemoryOrganization::PageBased, 0).CacheBytes, 4096u);
  EXPECT_EQ(plan.GetRoom(dsm::MemoryOrganization::PageBased, 0).ReplyBytes, 4096u);
  EXPECT_EQ(plan.GetNeed(dsm::MemoryOrganization::ObjectBased, 0), 8 * 1024u + 10 * 20);
  EXPECT_EQ(plan.GetNeed(dsm::MemoryOrganization::Replicated, 0), 10 * 1024u + 10 * 20);
  EXPECT_EQ(plan.Decide(dsm::MemoryOrganization::Automatic), dsm::MemoryOrganization::Replicated);
}

/// Many tiny blocks: what finds them takes more than they do.
TEST(MemoryPlan, TablesAndTheirIndexCount)
{
  constexpr std::size_t count = 1 << 14;
  const dsm::BlockDirectory directory(
    std::vector<std::uint32_t>(count, 64), dsm::RoundRobinAssigner(64), 9 * count);
  const auto fits = [&](dsm::MemoryOrganization organization, std::uint64_t bytes)
  {
    const dsm::MemoryPlan plan({ &directory, &directory }, dsm::HostGroups::Separate(64),
      std::vector<Budget>(64, Budget{ bytes, bytes }), 64);
    try
    {
      return plan.Decide(organization) == organization;
    }
    catch (const dsm::Error&)
    {
      return false;
    }
  };
  constexpr std::uint64_t own = 2 * count / 64 * 64 + 3 * 64;
  constexpr std::uint64_t table = 16 + 4 + 9;
  EXPECT_TRUE(fits(dsm::MemoryOrganization::ObjectBased, own + 2 * count * table));
  EXPECT_FALSE(fits(dsm::MemoryOrganization::ObjectBased, own + 2 * count * table - 1));
  constexpr std::uint64_t pageTable = 16 + 8 + 4 + 4 + 9;
  EXPECT_TRUE(fits(dsm::MemoryOrganization::PageBased, own + 2 * count * pageTable));
  EXPECT_FALSE(fits(dsm::MemoryOrganization::PageBased, own + 2 * count * pageTable - 1));
  constexpr std::uint64_t all = 2 * count * (64 + table);
  EXPECT_TRUE(fits(dsm::MemoryOrganization::Replicated, all));
  EXPECT_FALSE(fits(dsm::MemoryOrganization::Replicated, all - 1));
}

/// Replies have a part of what the cache would have, but no more than a network needs.
TEST(MemoryPlan, RepliesHaveRoom)
{
  const auto directory = dsm_test::MakeDirectory(2, 10, 1024);
  const auto find = [&](std::uint64_t room)
  {
    const std::uint64_t bytes = 5 * 1024 + 10 * 20 + room;
    const dsm::MemoryPlan plan({ &directory }, dsm::HostGroups::Separate(2),
      std::vector<Budget>(2, Budget{ bytes, bytes }), 4096);
    const auto found = plan.GetRoom(dsm::MemoryOrganization::ObjectBased, 0);
    EXPECT_EQ(found.CacheBytes + found.ReplyBytes + 1024, room);
    return found.ReplyBytes;
  };
  EXPECT_EQ(find(3 * 1024), 1024u);
  EXPECT_EQ(find(64 * 1024), 4 * 1024u);
  EXPECT_EQ(find(std::uint64_t(1) << 30), 8u << 20);
  const dsm::MemoryPlan together({ &directory }, dsm::HostGroups({ 0, 0 }),
    std::vector<Budget>(2, Budget{ 1 << 20, 1 << 20 }), 4096);
  EXPECT_EQ(together.GetRoom(dsm::MemoryOrganization::ObjectBased, 0).ReplyBytes, 0u);
}

/// Where the user said nothing, the resident set may take more than the part thought fit.
TEST(MemoryPlan, OwnBlocksMayExceedWhatIsThoughtFit)
{
  const auto directory = dsm_test::MakeDirectory(2, 10, 1024);
  const dsm::MemoryPlan plan({ &directory }, dsm::HostGroups::Separate(2),
    std::vector<Budget>(2, Budget{ 3 * 1024, 9 * 1024 }), 4096);
  EXPECT_EQ(plan.Decide(dsm::MemoryOrganization::Automatic), dsm::MemoryOrganization::ObjectBased);
  EXPECT_EQ(plan.GetRoom(dsm::MemoryOrganization::ObjectBased, 1).CacheBytes, 1024u);
  EXPECT_THROW(plan.Decide(dsm::MemoryOrganization::Replicated), dsm::Error);
  EXPECT_THROW(plan.Decide(dsm::MemoryOrganization::PageBased), dsm::Error);
}

} // namespace

#undef RUN_SCENARIO
