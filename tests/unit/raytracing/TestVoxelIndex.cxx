// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/base/ByteHash.h"
#include "DSMRayTracing/build/VoxelIndex.h"
#include "TestVolume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <vector>

namespace
{

rt::VoxelIndex MakeIndex()
{
  MemoryStore store;
  const TestVolume<float> volume(rt::Index3(9),
    [](int x, int y, int z) { return static_cast<float>(std::sin(0.9 * y + 0.4 * z + 0.1 * x)); });
  const auto field = CreateField(store, volume, 4);
  rt::VoxelIndex index;
  index.Bricks.resize(field->Lattice.GetBrickCount(), rt::ValueRange{ -1.0f, 1.0f });
  index.Digests.resize(index.Bricks.size());
  field->Segment->ForEachResident([&](dsm::BlockId id, const std::byte* block, std::size_t)
    { index.Survey.CountBrick(field->Lattice, id, block); });
  return index;
}

/// Adds a matching checksum, as a forged file would have.
std::vector<std::byte> Sign(std::vector<std::byte> bytes)
{
  const std::size_t end = bytes.size() - sizeof(std::uint64_t);
  rt::ByteHash hash;
  hash.Add(bytes.data(), end);
  const std::uint64_t value = hash.Get();
  std::memcpy(bytes.data() + end, &value, sizeof(value));
  return bytes;
}

} // namespace

TEST(TestVoxelIndex, IsReadAsItWasWritten)
{
  const rt::VoxelIndex index = MakeIndex();
  const std::vector<std::byte> bytes = index.Encode();
  const std::size_t bricks = index.Bricks.size();
  EXPECT_EQ(bytes.size(), rt::VoxelIndex::CountBytes(bricks));
  const auto read = rt::VoxelIndex::Decode(bytes, bricks);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->Encode(), bytes);
  rt::VoxelIndex empty; // no cell of a brick holds data
  empty.Bricks.resize(
    1, { std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity() });
  empty.Digests.resize(1);
  EXPECT_TRUE(rt::VoxelIndex::Decode(empty.Encode(), 1));
}

TEST(TestVoxelIndex, WhatIsDamagedIsNone)
{
  const rt::VoxelIndex index = MakeIndex();
  const std::vector<std::byte> bytes = index.Encode();
  const std::size_t bricks = index.Bricks.size();
  for (const std::size_t count : { bricks - 1, bricks + 1, std::size_t(0), ~std::size_t(0),
         std::size_t(1) << 61, ~std::size_t(0) / 24 })
  {
    EXPECT_FALSE(rt::VoxelIndex::Decode(bytes, count)) << count;
  }
  EXPECT_FALSE(rt::VoxelIndex::Decode({}, bricks));
  EXPECT_FALSE(rt::VoxelIndex::Decode({}, 0));
  EXPECT_FALSE(rt::VoxelIndex::Decode(std::vector<std::byte>(bytes.size()), bricks));
  for (std::size_t at = 0; at < bytes.size(); at += 7)
  {
    std::vector<std::byte> damaged = bytes;
    damaged[at] ^= std::byte{ 0x10 };
    EXPECT_FALSE(rt::VoxelIndex::Decode(damaged, bricks)) << at;
  }
}

TEST(TestVoxelIndex, NumbersThatNobodyFoundAreNone)
{
  const rt::VoxelIndex index = MakeIndex();
  const std::size_t bricks = index.Bricks.size();
  EXPECT_TRUE(rt::VoxelIndex::Decode(Sign(index.Encode()), bricks));
  EXPECT_FALSE(rt::VoxelIndex::Decode(
    Sign(std::vector<std::byte>(rt::VoxelIndex::CountBytes(bricks))), bricks));
  const std::vector<std::function<void(rt::VoxelIndex&)>> damages = {
    [](rt::VoxelIndex& one) { one.Bricks.back().First = std::numeric_limits<float>::quiet_NaN(); },
    [](rt::VoxelIndex& one) { one.Bricks.front().Last = std::numeric_limits<float>::quiet_NaN(); },
    [](rt::VoxelIndex& one) { one.Survey.Values.back() += 1; },
    [](rt::VoxelIndex& one) { one.Survey.First -= 1; },
    [](rt::VoxelIndex& one) { one.Survey.All = std::numeric_limits<std::int64_t>::max(); },
  };
  for (std::size_t damage = 0; damage < damages.size(); ++damage)
  {
    rt::VoxelIndex damaged = index;
    damages[damage](damaged);
    EXPECT_FALSE(rt::VoxelIndex::Decode(damaged.Encode(), bricks)) << damage;
  }
}
