// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/transport/Message.h"

#include <gtest/gtest.h>

namespace
{

struct Pair
{
  int First;
  double Second;
};

dsm::Message MakeMessage(dsm::MessageKind kind, std::vector<std::byte> payload)
{
  dsm::Message message;
  message.Kind = kind;
  message.Source = 3;
  message.Payload = std::move(payload);
  return message;
}

TEST(Message, EncodedValueComesBack)
{
  const auto message = MakeMessage(dsm::MessageKind::TileGrant, dsm::Encode(Pair{ 4, 0.5 }));
  const Pair pair = dsm::Decode<Pair>(message, dsm::MessageKind::TileGrant);
  EXPECT_EQ(pair.First, 4);
  EXPECT_EQ(pair.Second, 0.5);
}

TEST(Message, WrongKindIsRejected)
{
  const auto message = MakeMessage(dsm::MessageKind::TileGrant, dsm::Encode(1));
  EXPECT_THROW(dsm::Decode<int>(message, dsm::MessageKind::TileRequest), dsm::Error);
}

TEST(Message, WrongSizeIsRejected)
{
  const auto message = MakeMessage(dsm::MessageKind::TileGrant, dsm::Encode(Pair{ 1, 2.0 }));
  EXPECT_THROW(dsm::Decode<int>(message, dsm::MessageKind::TileGrant), dsm::Error);
  EXPECT_EQ(dsm::Decode<int>(message, dsm::MessageKind::TileGrant, false), 1);
  const auto empty = MakeMessage(dsm::MessageKind::TileGrant, {});
  EXPECT_THROW(dsm::Decode<int>(empty, dsm::MessageKind::TileGrant, false), dsm::Error);
}

TEST(Message, TailComesOffWithoutTouchingTheRest)
{
  std::vector<std::byte> bytes(5, std::byte{ 7 });
  dsm::AttachTail(bytes, Pair{ 9, 1.5 });
  auto message = MakeMessage(dsm::MessageKind::Fragment, std::move(bytes));
  const Pair tail = dsm::DetachTail<Pair>(message, dsm::MessageKind::Fragment);
  EXPECT_EQ(tail.First, 9);
  EXPECT_EQ(tail.Second, 1.5);
  EXPECT_EQ(message.Payload, std::vector<std::byte>(5, std::byte{ 7 }));
}

TEST(Message, MissingTailIsRejected)
{
  auto message = MakeMessage(dsm::MessageKind::Fragment, std::vector<std::byte>(3));
  EXPECT_THROW(dsm::DetachTail<Pair>(message, dsm::MessageKind::Fragment), dsm::Error);
}

} // namespace
