// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/transport/LoopbackTransport.h"

#include <gtest/gtest.h>

#include <thread>

namespace
{

dsm::Message MakeMessage(int value)
{
  dsm::Message message;
  message.Kind = dsm::MessageKind::TileGrant;
  message.Session = 5;
  message.Payload = dsm::Encode(value);
  return message;
}

TEST(LoopbackTransport, MessageArrivesWithItsHeader)
{
  auto group = dsm::LoopbackTransport::CreateGroup(3);
  group[2]->Post(0, MakeMessage(8));
  int count = 0;
  EXPECT_TRUE(group[0]->Progress(
    [&](dsm::Message&& message)
    {
      EXPECT_EQ(message.Source, 2);
      EXPECT_EQ(message.Session, 5u);
      EXPECT_EQ(dsm::Decode<int>(message, dsm::MessageKind::TileGrant), 8);
      ++count;
    }));
  EXPECT_EQ(count, 1);
  EXPECT_FALSE(group[0]->Progress([&](dsm::Message&&) { ++count; }));
  EXPECT_EQ(count, 1);
}

TEST(LoopbackTransport, RanksAndSize)
{
  auto group = dsm::LoopbackTransport::CreateGroup(3);
  for (int rank = 0; rank < 3; ++rank)
  {
    EXPECT_EQ(group[rank]->GetRank(), rank);
    EXPECT_EQ(group[rank]->GetSize(), 3);
  }
}

TEST(LoopbackTransport, MessageToSelfWaitsForTheNextProgress)
{
  auto group = dsm::LoopbackTransport::CreateGroup(1);
  int count = 0;
  const auto again = [&](dsm::Message&&)
  {
    ++count;
    group[0]->Post(0, MakeMessage(count));
  };
  group[0]->Post(0, MakeMessage(0));
  group[0]->Progress(again);
  EXPECT_EQ(count, 1);
  group[0]->Progress(again);
  EXPECT_EQ(count, 2);
}

TEST(LoopbackTransport, UnsentBytesAreThoseNotTaken)
{
  auto group = dsm::LoopbackTransport::CreateGroup(2);
  group[0]->Post(1, MakeMessage(1));
  group[0]->Post(1, MakeMessage(2));
  EXPECT_EQ(group[0]->GetUnsentBytes(), 2 * sizeof(int));
  EXPECT_EQ(group[1]->GetUnsentBytes(), 0u);
  group[1]->Progress([](dsm::Message&&) {});
  EXPECT_EQ(group[0]->GetUnsentBytes(), 0u);
  EXPECT_FALSE(group[0]->HasUnsent(dsm::MessageKind::TileGrant));
}

TEST(LoopbackTransport, NoSuchRank)
{
  auto group = dsm::LoopbackTransport::CreateGroup(2);
  EXPECT_THROW(group[0]->Post(2, MakeMessage(1)), dsm::Error);
  EXPECT_THROW(group[0]->Post(-1, MakeMessage(1)), dsm::Error);
  EXPECT_THROW(dsm::LoopbackTransport::CreateGroup(0), dsm::Error);
}

TEST(LoopbackTransport, ThrowingReceiverLosesOnlyThatMessage)
{
  auto group = dsm::LoopbackTransport::CreateGroup(2);
  group[0]->Post(1, MakeMessage(1));
  group[0]->Post(1, MakeMessage(2));
  EXPECT_THROW(group[1]->Progress([](dsm::Message&&) { throw dsm::Error("no"); }), dsm::Error);
  int value = 0;
  group[1]->Progress([&](dsm::Message&& message)
    { value = dsm::Decode<int>(message, dsm::MessageKind::TileGrant); });
  EXPECT_EQ(value, 2);
}

TEST(LoopbackTransport, PeerMayGoFirst)
{
  auto group = dsm::LoopbackTransport::CreateGroup(2);
  group[0]->Post(1, MakeMessage(1));
  group[0].reset();
  int count = 0;
  group[1]->Progress([&](dsm::Message&&) { ++count; });
  EXPECT_EQ(count, 1);
  group[1]->Post(0, MakeMessage(1));
}

TEST(LoopbackTransport, ThreadsKeepTheOrderOfEachPair)
{
  auto group = dsm::LoopbackTransport::CreateGroup(3);
  const int count = 5000;
  std::vector<std::thread> senders;
  for (int rank = 1; rank < 3; ++rank)
  {
    senders.emplace_back(
      [&group, rank]
      {
        for (int i = 0; i < count; ++i)
        {
          group[rank]->Post(0, MakeMessage(i));
        }
      });
  }
  int next[3] = { 0, 0, 0 };
  while (next[1] + next[2] < 2 * count)
  {
    group[0]->Progress(
      [&](dsm::Message&& message) {
        EXPECT_EQ(dsm::Decode<int>(message, dsm::MessageKind::TileGrant), next[message.Source]++);
      });
  }
  for (std::thread& sender : senders)
  {
    sender.join();
  }
}

} // namespace
