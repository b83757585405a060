// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_test_MessengerScenarios_h
#define dsm_test_MessengerScenarios_h

#include "DSMCore/transport/Messenger.h"
#include "tests/unit/dsmcore/RankGroup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <new>
#include <string>
#include <thread>
#include <vector>

/// What a messenger must do on any transport and number of ranks; each is run by every rank.
namespace dsm_test
{

inline std::vector<std::byte> MakeBytes(std::size_t count, int seed)
{
  std::vector<std::byte> bytes(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    bytes[i] =
      static_cast<std::byte>((i * 31 + static_cast<std::size_t>(seed) * 17 + i / 251) & 255);
  }
  return bytes;
}

inline void AllGatherKeepsRankOrderAndSizes(dsm::Messenger& messenger)
{
  // Rank 0 gives nothing, the others ever more; the last more than any eager limit of MPI.
  const std::size_t unit = 100000;
  const auto parts = messenger.AllGather(
    MakeBytes(static_cast<std::size_t>(messenger.GetRank()) * unit, messenger.GetRank()));
  EXPECT_EQ(static_cast<int>(parts.size()), messenger.GetSize());
  for (std::size_t rank = 0; rank < parts.size(); ++rank)
  {
    EXPECT_EQ(parts[rank], MakeBytes(rank * unit, static_cast<int>(rank)));
  }
}

inline void AllGatherValueKeepsRankOrder(dsm::Messenger& messenger)
{
  const auto values = messenger.AllGatherValue(messenger.GetRank() * 10);
  EXPECT_EQ(static_cast<int>(values.size()), messenger.GetSize());
  for (std::size_t rank = 0; rank < values.size(); ++rank)
  {
    EXPECT_EQ(values[rank], static_cast<int>(rank) * 10);
  }
}

inline void BroadcastReachesAll(dsm::Messenger& messenger)
{
  for (const std::size_t count : { std::size_t(0), std::size_t(1), std::size_t(3) << 20 })
  {
    const auto mine = messenger.GetRank() == 0 ? MakeBytes(count, 5) : MakeBytes(9, 6);
    EXPECT_EQ(messenger.Broadcast(mine), MakeBytes(count, 5));
  }
}

/// Values of several bytes, in one piece and in many, in which no rank has all that is smallest.
inline void ReduceCombinesTheValuesOfAllRanks(dsm::Messenger& messenger)
{
  using Value = std::array<float, 3>;
  const auto make = [&](std::size_t index, int rank)
  {
    Value value;
    for (std::size_t place = 0; place < value.size(); ++place)
    {
      value[place] = static_cast<float>(
        (index + place + 7 * static_cast<std::size_t>(rank)) % (messenger.GetSize() * 5));
    }
    return value;
  };
  const auto takeLess = [](Value& value, const Value& other)
  {
    for (std::size_t place = 0; place < value.size(); ++place)
    {
      value[place] = std::min(value[place], other[place]);
    }
  };
  for (const std::size_t count : { 0, 1, 300000 })
  {
    std::vector<Value> values(count);
    std::vector<Value> expected(count);
    for (std::size_t index = 0; index < count; ++index)
    {
      values[index] = make(index, messenger.GetRank());
      expected[index] = make(index, 0);
      for (int rank = 1; rank < messenger.GetSize(); ++rank)
      {
        takeLess(expected[index], make(index, rank));
      }
    }
    messenger.Reduce(values, takeLess);
    EXPECT_TRUE(values == expected) << count;
  }
}

/// Ranks run ahead of one another by whole steps; nothing may cross over.
inline void CollectivesInARowDoNotMix(dsm::Messenger& messenger)
{
  for (int round = 0; round < 200; ++round)
  {
    if (round % messenger.GetSize() == messenger.GetRank() && round % 16 == 0)
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const auto values = messenger.AllGatherValue(round * 100 + messenger.GetRank());
    for (std::size_t rank = 0; rank < values.size(); ++rank)
    {
      EXPECT_EQ(values[rank], round * 100 + static_cast<int>(rank));
    }
    const auto bytes = messenger.Broadcast(MakeBytes(8, messenger.GetRank() == 0 ? round : -1));
    EXPECT_EQ(bytes, MakeBytes(8, round));
    messenger.Barrier();
  }
}

inline void NobodyLeavesABarrierBeforeTheLastEnters(dsm::Messenger& messenger)
{
  using Clock = std::chrono::steady_clock;
  const bool last = messenger.GetRank() == messenger.GetSize() - 1;
  messenger.Barrier();
  const auto start = Clock::now();
  if (last)
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
  }
  const auto entered = Clock::now();
  messenger.Barrier();
  const auto left = Clock::now();
  // One clock for all, as they run on one host here.
  const auto enters = messenger.AllGatherValue(entered.time_since_epoch().count());
  EXPECT_GE(left.time_since_epoch().count(), enters.back());
  EXPECT_GE(left, start);
}

inline void AgreeNamesTheLowestFailingRank(dsm::Messenger& messenger)
{
  const int last = messenger.GetSize() - 1;
  EXPECT_TRUE(messenger.Agree("").IsOk());
  const dsm::Status one = messenger.Agree(messenger.GetRank() == last ? "the disk is full" : "");
  EXPECT_EQ(one.FailedRank, last);
  EXPECT_EQ(one.Cause, "the disk is full");
  const dsm::Status all = messenger.Agree("cause " + std::to_string(messenger.GetRank()));
  EXPECT_EQ(all.FailedRank, 0);
  EXPECT_EQ(all.Cause, "cause 0");
}

inline void RunTogetherThrowsTheSameOnEveryRank(dsm::Messenger& messenger)
{
  const int last = messenger.GetSize() - 1;
  const std::string name = last > 0 ? "Rank " + std::to_string(last) + ": " : "";
  EXPECT_EQ(GetErrorText(
              [&]
              {
                messenger.RunTogether("Reading failed",
                  [&]
                  {
                    if (messenger.GetRank() == last)
                    {
                      throw dsm::Error("no such array");
                    }
                  });
              }),
    "Reading failed: " + name + "no such array");
  const std::string memory = GetErrorText(
    [&]
    {
      messenger.RunTogether("Loading failed",
        [&]
        {
          if (messenger.GetRank() == last)
          {
            throw std::bad_alloc();
          }
        });
    });
  EXPECT_EQ(memory.find("Loading failed: " + name + "out of memory"), 0u) << memory;
  EXPECT_NE(memory.find("more ranks"), std::string::npos) << memory;
  EXPECT_EQ(GetErrorText(
              [&]
              {
                messenger.RunTogether("Odd",
                  [&]
                  {
                    if (messenger.GetRank() == last)
                    {
                      throw 7;
                    }
                  });
              }),
    "Odd: " + name + "an exception of unknown type");
  messenger.RunTogether("Nothing wrong", [] {});
}

/// A message for a step that the receiver has not reached waits there, and is then handed over.
inline void EarlyMessagesWaitForTheirSession(dsm::Messenger& messenger)
{
  const int size = messenger.GetSize();
  messenger.Barrier();
  messenger.BeginSession();
  if (messenger.GetRank() == 0)
  {
    // One step ahead of all others, which only take part in the first step's barrier below.
    for (int rank = 1; rank < size; ++rank)
    {
      messenger.Post(rank, dsm::MessageKind::TileGrant, dsm::Encode(41));
    }
    const std::uint32_t next = messenger.BeginSession();
    for (int rank = 1; rank < size; ++rank)
    {
      messenger.Post(rank, dsm::MessageKind::TileGrant, dsm::Encode(42));
    }
    EXPECT_EQ(messenger.GetSession(), next);
  }
  else
  {
    std::vector<int> seen;
    messenger.SetHandler(dsm::MessageKind::TileGrant,
      [&](dsm::Message&& message)
      {
        EXPECT_EQ(message.Session, messenger.GetSession());
        seen.push_back(dsm::Decode<int>(message, dsm::MessageKind::TileGrant));
      });
    messenger.ProgressUntil([&] { return !seen.empty(); });
    // The second may have come, too; give it the time.
    for (int i = 0; i < 100; ++i)
    {
      messenger.Progress();
    }
    EXPECT_EQ(seen, std::vector<int>({ 41 }));
    messenger.BeginSession();
    messenger.ProgressUntil([&] { return seen.size() == 2; });
    EXPECT_EQ(seen, std::vector<int>({ 41, 42 }));
    messenger.SetHandler(dsm::MessageKind::TileGrant, {});
  }
  messenger.Barrier();
}

inline void MessagesOfTheSessionWaitForTheirHandler(dsm::Messenger& messenger)
{
  messenger.Barrier();
  messenger.BeginSession();
  const int next = (messenger.GetRank() + 1) % messenger.GetSize();
  messenger.Post(next, dsm::MessageKind::TileRequest, dsm::Encode(7));
  for (int i = 0; i < 50; ++i)
  {
    messenger.Progress(); // has no handler yet
  }
  int count = 0;
  messenger.SetHandler(dsm::MessageKind::TileRequest, [&](dsm::Message&&) { ++count; });
  messenger.ProgressUntil([&] { return count > 0; });
  messenger.SetHandler(dsm::MessageKind::TileRequest, {});
  EXPECT_EQ(count, 1);
  messenger.Barrier();
}

/// A block request is valid at any time, so one of an earlier session reaches a handler.
inline void MessagesOfAnEarlierSessionReachAHandler(dsm::Messenger& messenger)
{
  messenger.Barrier();
  const std::uint32_t session = messenger.BeginSession();
  const int next = (messenger.GetRank() + 1) % messenger.GetSize();
  messenger.Post(next, dsm::MessageKind::BlockRequest, dsm::Encode(3));
  int count = 0;
  messenger.SetHandler(dsm::MessageKind::BlockRequest,
    [&](dsm::Message&& message)
    {
      EXPECT_EQ(message.Session, session);
      ++count;
    });
  messenger.BeginSession();
  messenger.ProgressUntil([&] { return count > 0; });
  messenger.SetHandler(dsm::MessageKind::BlockRequest, {});
  messenger.Barrier();
}

/// Without a handler, what belongs to the past is dropped and never surfaces.
inline void MessagesOfAnEarlierSessionWithoutHandlerAreDropped(dsm::Messenger& messenger)
{
  messenger.Barrier();
  messenger.BeginSession();
  const int next = (messenger.GetRank() + 1) % messenger.GetSize();
  messenger.Post(next, dsm::MessageKind::FrameDone, dsm::Encode(3));
  messenger.Barrier(); // begins a session; messages of a pair keep their order
  messenger.Barrier();
  for (int i = 0; i < 50; ++i)
  {
    messenger.Progress();
  }
  int count = 0;
  messenger.SetHandler(dsm::MessageKind::FrameDone, [&](dsm::Message&&) { ++count; });
  for (int i = 0; i < 50; ++i)
  {
    messenger.Progress();
  }
  messenger.Barrier();
  messenger.SetHandler(dsm::MessageKind::FrameDone, {});
  EXPECT_EQ(count, 0);
}

inline void MessagesOfAPairKeepTheirOrder(dsm::Messenger& messenger)
{
  messenger.Barrier();
  messenger.BeginSession();
  const int size = messenger.GetSize();
  const int count = 300;
  std::vector<int> next(static_cast<std::size_t>(size), 0);
  int total = 0;
  messenger.SetHandler(dsm::MessageKind::Fragment,
    [&](dsm::Message&& message)
    {
      const int number = dsm::DetachTail<int>(message, dsm::MessageKind::Fragment);
      EXPECT_EQ(number, next[static_cast<std::size_t>(message.Source)]++);
      // Small and large ones alternate, so that MPI's eager and rendezvous paths compete.
      EXPECT_EQ(message.Payload, MakeBytes(number % 3 == 0 ? 50000 : 10, number));
      ++total;
    });
  for (int number = 0; number < count; ++number)
  {
    for (int rank = 0; rank < size; ++rank)
    {
      auto bytes = MakeBytes(number % 3 == 0 ? 50000 : 10, number);
      dsm::AttachTail(bytes, number);
      messenger.Post(rank, dsm::MessageKind::Fragment, std::move(bytes));
    }
  }
  // What a rank has sent may have been taken while it still has to tell others that it took theirs.
  messenger.ProgressUntil(
    [&]
    {
      return total == count * size && messenger.GetUnsentBytes() == 0 &&
        !messenger.HasUnsent(dsm::MessageKind::Fragment);
    });
  messenger.SetHandler(dsm::MessageKind::Fragment, {});
  EXPECT_EQ(total, count * size);
  messenger.Barrier();
}

/// A handler that throws while a collective waits must not leave the others waiting.
inline void HandlerThatThrowsDoesNotBreakACollective(dsm::Messenger& messenger)
{
  messenger.Barrier();
  messenger.BeginSession();
  messenger.SetHandler(dsm::MessageKind::BlockRequest,
    [](dsm::Message&& message) { dsm::Decode<double>(message, dsm::MessageKind::BlockRequest); });
  const int next = (messenger.GetRank() + 1) % messenger.GetSize();
  messenger.Post(next, dsm::MessageKind::BlockRequest, dsm::Encode('x'));
  int thrown = 0;
  const auto attempt = [&](const auto& step)
  {
    try
    {
      step();
    }
    catch (const dsm::Error& error)
    {
      EXPECT_NE(std::string(error.what()).find("rejected"), std::string::npos) << error.what();
      ++thrown;
    }
  };
  for (int i = 0; i < 3; ++i)
  {
    attempt([&] { messenger.Barrier(); });
  }
  while (thrown == 0) // the message may be slower than the barriers
  {
    attempt([&] { messenger.Progress(); });
  }
  messenger.SetHandler(dsm::MessageKind::BlockRequest, {});
  EXPECT_EQ(thrown, 1);
  messenger.Barrier();
}

} // namespace dsm_test

#endif
