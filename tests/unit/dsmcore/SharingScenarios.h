// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_test_SharingScenarios_h
#define dsm_test_SharingScenarios_h

#include "DSMCore/store/BlockStore.h"
#include "DSMCore/table/ObjectStore.h"
#include "DSMCore/table/ReplicatedStore.h"
#include "tests/unit/dsmcore/StoreTestTools.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

/// What replication and sharing within a host must do on any transport whose ranks are on one host;
/// each is run by every rank.
namespace dsm_test
{

/// Odd sizes, among them nothing, one byte, and one larger than any eager limit of MPI.
inline dsm::BlockDirectory MakeOddDirectory(int ranks)
{
  return dsm::BlockDirectory(
    { 0, 1, 63, 64, 65, 4097, 300001, 12, 5000, 0, 777, 2500000 }, dsm::RoundRobinAssigner(ranks));
}

/// Every worker reads every block, and every byte.
template <class Store>
void ReadEverything(dsm::Messenger& messenger, Store& store, const dsm::BlockSegment& segment)
{
  RunFrame(messenger, store,
    [&](typename Store::Worker& worker, int)
    {
      for (dsm::BlockId id = 0; id < segment.GetDirectory().GetCount(); ++id)
      {
        EXPECT_EQ(Visit(store, worker, segment, id), 0u) << "block " << id;
      }
    });
}

inline void ReadEverything(
  dsm::Messenger& messenger, dsm::BlockStore& store, const dsm::BlockSegment& segment)
{
  store.Visit([&](auto& blocks) { ReadEverything(messenger, blocks, segment); });
}

inline std::uint64_t CountAligned(const dsm::BlockDirectory& directory)
{
  std::uint64_t bytes = 0;
  for (dsm::BlockId id = 0; id < directory.GetCount(); ++id)
  {
    bytes += dsm::AlignBlock(directory.GetBytes(id));
  }
  return bytes;
}

inline void Replicate(dsm::Messenger& messenger, bool hostSharing)
{
  const auto directory = MakeOddDirectory(messenger.GetSize());
  dsm::ReplicatedStore::Settings settings;
  settings.Workers = 2;
  settings.HostSharing = hostSharing;
  dsm::ReplicatedStore store(messenger, settings);
  const auto one = PublishPattern(messenger, store, directory, Spread::EveryRankASlice, 40000);
  const auto two = PublishPattern(messenger, store, directory, Spread::OnlyLastRank, 40000);
  const std::uint64_t all = 2 * CountAligned(directory);
  for (int frame = 0; frame < 2; ++frame)
  {
    ReadEverything(messenger, store, *one);
    ReadEverything(messenger, store, *two);
    const auto counters = store.GetCounters();
    EXPECT_EQ(counters.Workers.Accesses, 2 * directory.GetCount());
    EXPECT_EQ(counters.Workers.Hits, counters.Workers.Accesses);
    EXPECT_EQ(counters.Workers.Misses, 0u);
    EXPECT_EQ(counters.ResidentBytes, 2 * directory.GetResidentBytes(messenger.GetRank()));
    // On one host the blocks of all are there already.
    EXPECT_EQ(counters.ReplicaBytes, hostSharing ? 0 : all - counters.ResidentBytes);
    EXPECT_EQ(counters.SharedBytes, hostSharing ? all - counters.ResidentBytes : 0);
  }
  EXPECT_EQ(store.GetWorkerCounters().size(), 2u);
  store.Retire(one);
  ReadEverything(messenger, store, *two);
  store.Retire(two);
  EXPECT_EQ(store.GetCounters().ResidentBytes, 0u);
  EXPECT_EQ(store.GetCounters().ReplicaBytes, 0u);
}

inline void EveryRankHasEveryBlock(dsm::Messenger& messenger)
{
  Replicate(messenger, false);
}

inline void EveryHostHasEveryBlockOnce(dsm::Messenger& messenger)
{
  Replicate(messenger, true);
}

/// Of one host, so nothing is fetched: no cache is needed.
inline void SharedBlocksAreHits(dsm::Messenger& messenger)
{
  const auto directory = MakeOddDirectory(messenger.GetSize());
  dsm::ObjectStore::Settings settings;
  settings.CacheBytes = 0;
  settings.Workers = 2;
  settings.HostSharing = true;
  dsm::ObjectStore store(messenger, settings);
  const auto segment = PublishPattern(messenger, store, directory, Spread::EveryRankASlice, 40000);
  ReadEverything(messenger, store, *segment);
  auto counters = store.GetCounters();
  EXPECT_EQ(counters.Workers.Accesses, 2 * directory.GetCount());
  EXPECT_EQ(counters.Workers.Hits, counters.Workers.Accesses);
  EXPECT_EQ(counters.BytesReceived + counters.BytesSent, 0u);
  EXPECT_EQ(counters.PeakCachedBytes, 0u);
  EXPECT_EQ(counters.SharedBytes + counters.ResidentBytes, CountAligned(directory));

  // What is published from now on is fetched; what is shared stays so.
  settings.HostSharing = false;
  settings.CacheBytes = std::size_t(4) << 20;
  store.SetSettings(settings);
  const auto fetched = PublishPattern(messenger, store, directory, Spread::EveryRankASlice, 40000);
  ReadEverything(messenger, store, *segment);
  EXPECT_EQ(store.GetCounters().Workers.Misses, 0u);
  ReadEverything(messenger, store, *fetched);
  counters = store.GetCounters();
  EXPECT_EQ(counters.Workers.Misses > 0, messenger.GetSize() > 1);
  EXPECT_EQ(counters.BytesReceived > 0, messenger.GetSize() > 1);
  store.Retire(segment);
  EXPECT_EQ(store.GetCounters().SharedBytes, 0u);
}

/// The memory of a rank that retired a segment first stays readable for the others.
inline void SharedMemoryOutlivesItsOwner(dsm::Messenger& messenger)
{
  const auto directory = MakeDirectory(messenger.GetSize(), 16, 5000);
  dsm::ObjectStore::Settings settings;
  settings.HostSharing = true;
  auto store = std::make_unique<dsm::ObjectStore>(messenger, settings);
  auto table =
    std::static_pointer_cast<dsm::BlockTable>(PublishPattern(messenger, *store, directory));
  store.reset();
  if (messenger.GetRank() == 0)
  {
    table.reset();
  }
  messenger.Barrier(); // rank 0 has nothing any more
  for (dsm::BlockId id = 0; table && id < directory.GetCount(); ++id)
  {
    ASSERT_NE(table->Find(id), nullptr);
    EXPECT_EQ(CountWrongBytes(id, table->Find(id), directory.GetBytes(id)), 0u);
  }
  messenger.Barrier();
}

/// Two hosts of one machine: groups of ranks that share memory, and messages between them.
inline void CopiesOnceAGroup(dsm::Messenger& messenger)
{
  const int size = messenger.GetSize();
  const int rank = messenger.GetRank();
  // Ranks 0 and 1 together, 2 and 3, ...
  std::vector<int> leaders;
  for (int other = 0; other < size; ++other)
  {
    leaders.push_back(other / 2 * 2);
  }
  const dsm::HostGroups groups(leaders);
  const auto directory = dsm::BlockDirectory(
    { 100, 0, 65, 70000, 64, 1, 5000, 333, 20, 4096, 4097, 90, 12, 777, 31, 9, 8, 7 },
    dsm::RoundRobinAssigner(size));
  dsm::BlockTable table(messenger.BeginSession(), directory, rank, groups);
  for (dsm::BlockId id = 0; id < directory.GetCount(); ++id)
  {
    for (std::size_t place = 0; directory.GetOwner(id) == rank && place < directory.GetBytes(id);
         ++place)
    {
      table.GetOwned(id)[place] = GetPattern(id, place);
    }
  }
  messenger.Barrier();
  table.Meet(messenger);
  table.Seal();
  const auto look = [&](bool replicated)
  {
    EXPECT_EQ(table.IsReplicated(), replicated);
    EXPECT_EQ(table.IsWhole(), replicated || groups.GetGroupCount() == 1);
    for (dsm::BlockId id = 0; id < directory.GetCount(); ++id)
    {
      const bool here = replicated || groups.AreTogether(directory.GetOwner(id), rank);
      ASSERT_EQ(table.Find(id) != nullptr, here) << "block " << id;
      if (here)
      {
        EXPECT_EQ(CountWrongBytes(id, table.Find(id), directory.GetBytes(id)), 0u)
          << "block " << id;
      }
    }
  };
  look(false);
  const std::uint64_t shared = table.GetSharedBytes();
  for (int round = 0; round < 2; ++round)
  {
    table.Replicate(messenger, "Copying");
    look(true);
    const std::uint64_t all = CountAligned(directory);
    EXPECT_EQ(table.GetResidentBytes() + table.GetReplicaBytes() + table.GetSharedBytes(), all);
    // Each group has everything once.
    std::uint64_t inGroup = 0;
    const auto each = messenger.AllGatherValue(table.GetResidentBytes() + table.GetReplicaBytes());
    for (const int member : groups.GetMembers(rank))
    {
      inGroup += each[static_cast<std::size_t>(member)];
    }
    EXPECT_EQ(inGroup, all);
    EXPECT_EQ(table.GetReplicaBytes(), dsm::BlockTable::CountReplicaBytes(directory, groups, rank));
    table.DropReplicas();
    look(false);
    EXPECT_EQ(table.GetReplicaBytes(), 0u);
    EXPECT_EQ(table.GetSharedBytes(), shared);
  }
}

inline dsm::BlockStore::Settings MakeStoreSettings(
  dsm::MemoryOrganization organization, std::uint64_t memoryBytes, bool hostSharing = false)
{
  dsm::BlockStore::Settings settings;
  settings.Organization = organization;
  settings.MemoryBytes = memoryBytes;
  settings.HostSharing = hostSharing;
  return settings;
}

/// What is left for the cache of a rank that holds so much, when blocks of 1024 bytes are fetched.
inline std::uint64_t GetCacheRoom(std::uint64_t memoryBytes, std::uint64_t held)
{
  const std::uint64_t room = memoryBytes - held;
  return room - std::max<std::uint64_t>(1024, room / 16) - 1024; // replies, and one that has come
}

/// 16 blocks of 1024 bytes a rank; everything fits, then no more, then again.
inline void AutomaticFollowsTheData(dsm::Messenger& messenger)
{
  const int size = messenger.GetSize();
  const auto directory = MakeDirectory(size, 16 * static_cast<std::size_t>(size), 1024);
  const std::uint64_t all = CountAligned(directory);
  dsm::BlockStore store(
    messenger, MakeStoreSettings(dsm::MemoryOrganization::Automatic, all + all / 2));
  const auto one = PublishPattern(messenger, store, directory);
  EXPECT_EQ(store.GetOrganization(), dsm::MemoryOrganization::Replicated);
  EXPECT_NE(store.GetExplanation().find("replicated"), std::string::npos);
  EXPECT_FALSE(store.LacksMemory());
  EXPECT_TRUE(store.IsSettled());
  ReadEverything(messenger, store, *one);
  EXPECT_EQ(store.GetCounters().Workers.Misses, 0u);
  EXPECT_EQ(store.GetCounters().ResidentBytes + store.GetCounters().ReplicaBytes, all);
  EXPECT_EQ(store.GetCounters().MemoryBudget, all + all / 2);
  if (size == 1)
  {
    return; // twice the data would never fit
  }
  const auto two = PublishPattern(messenger, store, directory);
  EXPECT_EQ(store.GetOrganization(), dsm::MemoryOrganization::ObjectBased);
  EXPECT_NE(store.GetExplanation().find("object based: all data take 1 MiB on a rank, "
                                        "which exceeds the limit of 1 MiB"),
    std::string::npos)
    << store.GetExplanation();
  EXPECT_TRUE(store.LacksMemory());
  for (int frame = 0; frame < 2; ++frame)
  {
    ReadEverything(messenger, store, *one);
    ReadEverything(messenger, store, *two);
  }
  auto counters = store.GetCounters();
  EXPECT_EQ(counters.ReplicaBytes, 0u);
  EXPECT_EQ(counters.ResidentBytes, 2 * 16 * 1024u);
  // The budget is kept by all that takes memory together.
  EXPECT_EQ(counters.TableBytes, 2 * dsm::BlockTable::CountTableBytes(directory));
  EXPECT_EQ(counters.CacheCapacity,
    GetCacheRoom(all + all / 2, counters.ResidentBytes + counters.TableBytes));

  store.Retire(one);
  EXPECT_FALSE(store.IsSettled());
  store.Settle();
  EXPECT_EQ(store.GetOrganization(), dsm::MemoryOrganization::Replicated);
  ReadEverything(messenger, store, *two);
  EXPECT_EQ(store.GetCounters().Workers.Misses, 0u);
  EXPECT_EQ(store.GetCounters().CachedBytes, 0u);
}

inline void OrganizationsChangeUnderTheData(dsm::Messenger& messenger)
{
  const auto directory = MakeOddDirectory(messenger.GetSize());
  dsm::BlockStore store(messenger, MakeStoreSettings(dsm::MemoryOrganization::ObjectBased, 0));
  const auto segment = PublishPattern(messenger, store, directory);
  for (const auto organization :
    { dsm::MemoryOrganization::ObjectBased, dsm::MemoryOrganization::Replicated,
      dsm::MemoryOrganization::ObjectBased, dsm::MemoryOrganization::Automatic })
  {
    store.SetSettings(MakeStoreSettings(organization, 0));
    store.Settle();
    EXPECT_EQ(store.GetOrganization() == dsm::MemoryOrganization::Replicated,
      organization != dsm::MemoryOrganization::ObjectBased);
    ReadEverything(messenger, store, *segment);
  }
  EXPECT_THROW(
    store.SetSettings(MakeStoreSettings(dsm::MemoryOrganization::PageBased, 0)), dsm::Error);
  EXPECT_EQ(store.GetSettings().Organization, dsm::MemoryOrganization::Automatic);
  store.Retire(segment);
  store.SetSettings(MakeStoreSettings(dsm::MemoryOrganization::PageBased, 0));
  const auto paged = PublishPattern(messenger, store, directory);
  EXPECT_EQ(store.GetOrganization(), dsm::MemoryOrganization::PageBased);
  ReadEverything(messenger, store, *paged);
  EXPECT_THROW(
    store.SetSettings(MakeStoreSettings(dsm::MemoryOrganization::Automatic, 0)), dsm::Error);
  store.Retire(paged);
  store.SetSettings(MakeStoreSettings(dsm::MemoryOrganization::Automatic, 0, true));
  const auto shared = PublishPattern(messenger, store, directory);
  EXPECT_EQ(store.GetOrganization(), dsm::MemoryOrganization::Replicated);
  ReadEverything(messenger, store, *shared);
}

/// Too little memory is an error of all ranks that names what would do; the next publication works.
inline void TooLittleMemoryIsRefusedWithNumbers(dsm::Messenger& messenger)
{
  const int size = messenger.GetSize();
  // 12 blocks in all, of 1024 bytes each; a rank holds 12 / size and, of several, caches one, and has
  // two in messages.
  const auto directory = MakeDirectory(size, 12, 1024);
  const std::uint64_t tables = dsm::BlockTable::CountTableBytes(directory);
  const std::uint64_t need =
    (12 / static_cast<std::uint64_t>(size) + (size > 1 ? 3 : 0)) * 1024 + tables;
  const auto publish = [&](dsm::BlockStore& store)
  {
    PatternSource source(directory, messenger.GetRank(), size, Spread::EveryRankASlice, 100);
    PatternSink sink;
    return GetErrorText([&] { store.Publish("Loading 'p'", directory, source, sink); });
  };
  // Room for four blocks and three more: three ranks would do.
  const std::uint64_t memory = 7 * 1024 + tables;
  dsm::BlockStore store(messenger, MakeStoreSettings(dsm::MemoryOrganization::ObjectBased, memory));
  if (need > memory)
  {
    const std::string text = publish(store);
    EXPECT_EQ(text.find("Loading 'p': "), 0u) << text;
    EXPECT_NE(text.find(std::to_string(need) + " bytes"), std::string::npos) << text;
    EXPECT_NE(text.find("at least 3 ranks"), std::string::npos) << text;
    store.SetSettings(MakeStoreSettings(dsm::MemoryOrganization::ObjectBased, 1024 * 14));
  }
  const auto segment = PublishPattern(messenger, store, directory);
  ReadEverything(messenger, store, *segment);
  const auto counters = store.GetCounters();
  EXPECT_LE(
    counters.ResidentBytes + counters.TableBytes + counters.PeakCachedBytes, counters.MemoryBudget);

  dsm::BlockStore replicated(
    messenger, MakeStoreSettings(dsm::MemoryOrganization::Replicated, 11 * 1024));
  const std::string text = publish(replicated);
  EXPECT_NE(text.find(std::to_string(12 * 1024 + tables) + " bytes"), std::string::npos) << text;
  EXPECT_NE(text.find("object based"), std::string::npos) << text;
}

} // namespace dsm_test

#endif
