// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_test_PairScenarios_h
#define dsm_test_PairScenarios_h

#include "tests/unit/dsmcore/StoreScenarios.h"

#include <cstdint>
#include <random>

/// What stores must do with blocks that are read in pairs; each is run by every rank.
namespace dsm_test
{

/// Every worker reads random pairs of blocks of two segments, and both are there as long as it holds them.
template <class Store>
void ReadRandomPairs(dsm::Messenger& messenger, Store& store, std::uint32_t bytes)
{
  constexpr int count = 60;
  const auto directory = MakePairedDirectory(
    messenger.GetSize(), 4 * static_cast<std::size_t>(messenger.GetSize()), bytes);
  const auto topology = PublishPattern(messenger, store, directory);
  const auto values = PublishPattern(messenger, store, directory);
  RunFrame(messenger, store,
    [&](typename Store::Worker& worker, int index)
    {
      std::minstd_rand random(static_cast<unsigned>(index + 10 * messenger.GetRank() + 1));
      for (int number = 0; number < count; ++number)
      {
        const dsm::BlockId one = random() % directory.GetCount();
        const dsm::BlockId other = random() % directory.GetCount();
        const auto pair = store.AcquirePair(worker, *topology, one, *values, other);
        EXPECT_EQ(CountWrongBytes(one, pair.first.GetData(), pair.first.GetBytes()), 0u);
        EXPECT_EQ(CountWrongBytes(other, pair.second.GetData(), pair.second.GetBytes()), 0u);
        EXPECT_EQ(CountWrongBytes(one, pair.first.GetData(), pair.first.GetBytes()), 0u);
      }
    });
  const auto counters = store.GetCounters();
  EXPECT_EQ(counters.Workers.Accesses,
    2u * count * static_cast<std::uint64_t>(store.GetSettings().Workers));
  store.Retire(topology);
  store.Retire(values);
}

/// A cache of two blocks and eight workers, of which one at a time waits for a pair, must get on.
inline void CacheHoldsTwoBricks(dsm::Messenger& messenger)
{
  const std::uint32_t bytes = 512;
  dsm::ObjectStore store(messenger, MakeSettings(2 * bytes, 8));
  ReadRandomPairs(messenger, store, bytes);
  EXPECT_LE(store.GetCounters().PeakCachedBytes, 2 * bytes);
}

/// With more room several of them wait at a time.
inline void PairsShareACacheOfSixBricks(dsm::Messenger& messenger)
{
  const std::uint32_t bytes = 512;
  dsm::ObjectStore store(messenger, MakeSettings(6 * bytes, 8));
  ReadRandomPairs(messenger, store, bytes);
}

inline void BlocksThatAreNotPairedAreNoPair(dsm::Messenger& messenger)
{
  const auto directory =
    MakeDirectory(messenger.GetSize(), 2 * static_cast<std::size_t>(messenger.GetSize()), 64);
  dsm::ObjectStore store(messenger, MakeSettings(std::size_t(1) << 20));
  const auto segment = PublishPattern(messenger, store, directory);
  RunFrame(messenger, store,
    [&](dsm::ObjectStore::Worker& worker, int)
    {
      const auto other = static_cast<dsm::BlockId>((messenger.GetRank() + 1) % messenger.GetSize());
      if (directory.GetOwner(other) != messenger.GetRank())
      {
        EXPECT_THROW(store.AcquirePair(worker, *segment, 0, *segment, other), dsm::Error);
      }
    });
}

inline void CacheSmallerThanTwoBricksIsRefusedToPairs(dsm::Messenger& messenger)
{
  const std::uint32_t bytes = 512;
  const auto directory = MakePairedDirectory(
    messenger.GetSize(), 2 * static_cast<std::size_t>(messenger.GetSize()), bytes);
  dsm::ObjectStore store(messenger, MakeSettings(2 * bytes - 1));
  const auto segment = PublishPattern(messenger, store, directory);
  EXPECT_EQ(store.MayBeginFrame(), messenger.GetSize() == 1);
}

} // namespace dsm_test

#endif
