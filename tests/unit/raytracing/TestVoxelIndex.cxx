// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/base/ByteHash.h"
#include "DSMBricks/build/VoxelIndex.h"
#include "TestVolume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <vector>

namespace
{

bricks::VoxelIndex MakeIndex()
{
  MemoryStore store;
  const TestVolume<float> volume(bricks::Index3(9),
    [](int x, int y, int z) { return static_cast<float>(std::sin(0.9 * y + 0.4 * z + 0.1 * x)); });
  const auto field = CreateField(store, volume, 4);
  bricks::VoxelIndex index;
  index.Bricks.resize(field->Lattice.GetBrickCount(), bricks::ValueRange{ -1.0f, 1.0f });
  index.Digests.resize(index.Bricks.size());
  field->Segment->ForEachResident([&](dsm::BlockId id, const std::byte* block, std::size_t)
    { index.Survey.CountBrick(field->Lattice, id, block); });
  return index;
}

/// Adds a matching checksum, as a forged file would have.
std::vector<std::byte> Sign(std::vector<std::byte> bytes)
{
  const std::size_t end = bytes.size() - sizeof(std::uint64_t);
  bricks::ByteHash hash;
  hash.Add(bytes.data(), end);
  const std::uint64_t value = hash.Get();
  std::memcpy(bytes.data() + end, &value, sizeof(value));
  return bytes;
}

} // namespace

TEST(TestVoxelIndex, IsReadAsItWasWritten)
{
  const bricks::VoxelIndex index = MakeIndex();
  const std::vector<std::byte> bytes = index.Encode();
  const std::size_t bricks = index.Bricks.size();
  EXPECT_EQ(bytes.size(), bricks::VoxelIndex::CountBytes(bricks));
  const auto read = bricks::VoxelIndex::Decode(bytes, bricks);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->Encode(), bytes);
  bricks::VoxelIndex empty; // no cell of a brick holds data
  empty.Bricks.resize(
    1, { std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity() });
  empty.Digests.resize(1);
  EXPECT_TRUE(bricks::VoxelIndex::Decode(empty.Encode(), 1));
}

TEST(TestVoxelIndex, WhatIsDamagedIsNone)
{
  const bricks::VoxelIndex index = MakeIndex();
  const std::vector<std::byte> bytes = index.Encode();
  const std::size_t bricks = index.Bricks.size();
  for (const std::size_t count : { bricks - 1, bricks + 1, std::size_t(0), ~std::size_t(0),
         std::size_t(1) << 61, ~std::size_t(0) / 24 })
  {
    EXPECT_FALSE(bricks::VoxelIndex::Decode(bytes, count)) << count;
  }
  EXPECT_FALSE(bricks::VoxelIndex::Decode({}, bricks));
  EXPECT_FALSE(bricks::VoxelIndex::Decode({}, 0));
  EXPECT_FALSE(bricks::VoxelIndex::Decode(std::vector<std::byte>(bytes.size()), bricks));
  for (std::size_t at = 0; at < bytes.size(); at += 7)
  {
    std::vector<std::byte> damaged = bytes;
    damaged[at] ^= std::byte{ 0x10 };
    EXPECT_FALSE(bricks::VoxelIndex::Decode(damaged, bricks)) << at;
  }
}

TEST(TestVoxelIndex, NumbersThatNobodyFoundAreNone)
{
  const bricks::VoxelIndex index = MakeIndex();
  const std::size_t bricks = index.Bricks.size();
  EXPECT_TRUE(bricks::VoxelIndex::Decode(Sign(index.Encode()), bricks));
  EXPECT_FALSE(bricks::VoxelIndex::Decode(
    Sign(std::vector<std::byte>(bricks::VoxelIndex::CountBytes(bricks))), bricks));
  const std::vector<std::function<void(bricks::VoxelIndex&)>> damages = {
    [](bricks::VoxelIndex& one)
    { one.Bricks.back().First = std::numeric_limits<float>::quiet_NaN(); },
    [](bricks::VoxelIndex& one)
    { one.Bricks.front().Last = std::numeric_limits<float>::quiet_NaN(); },
    [](bricks::VoxelIndex& one) { one.Survey.Values.back() += 1; },
    [](bricks::VoxelIndex& one) { one.Survey.First -= 1; },
    [](bricks::VoxelIndex& one) { one.Survey.All = std::numeric_limits<std::int64_t>::max(); },
  };
  for (std::size_t damage = 0; damage < damages.size(); ++damage)
  {
    bricks::VoxelIndex damaged = index;
    damages[damage](damaged);
    EXPECT_FALSE(bricks::VoxelIndex::Decode(damaged.Encode(), bricks)) << damage;
  }
}
