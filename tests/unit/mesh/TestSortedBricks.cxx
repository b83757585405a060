// SPDX-License-Identifier: BSD-3-Clause
#include "TestMesh.h"

#include "DSMBricks/accel/BrickHierarchy.h"
#include "DSMBricks/sorted/RecordReader.h"
#include "DSMBricks/sorted/SortedBrickBuilder.h"
#include "DSMCore/base/Error.h"
#include "DSMCore/table/ObjectStore.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <mutex>
#include <random>
#include <string>
#include <tuple>
#include <vector>

namespace
{

/// A kind of primitive besides triangles: a place and a value. The record holds both.
struct Drop
{
  float Place[3];
  float Value;
  bool operator<(const Drop& other) const
  {
    return std::tie(this->Place[0], this->Place[1], this->Place[2]) <
      std::tie(other.Place[0], other.Place[1], other.Place[2]);
  }
};
static_assert(sizeof(Drop) == 16, "four words");

std::vector<Drop> CreateDrops()
{
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-1.0f, 1.0f);
  std::vector<Drop> drops(3000);
  for (Drop& drop : drops)
  {
    drop = { { place(random), place(random), place(random) }, 0.0f };
    drop.Value = drop.Place[0] + 2.0f;
  }
  return drops;
}

/// A brick is its drops, sorted.
class DropBricks final : public bricks::RecordBrickBuilder
{
public:
  std::vector<bricks::RecordBrick> Build(const std::uint32_t* records, std::size_t count) override
  {
    std::vector<Drop> drops(count);
    std::memcpy(static_cast<void*>(drops.data()), records, count * sizeof(Drop));
    std::sort(drops.begin(), drops.end());
    bricks::RecordBrick brick;
    for (const Drop& drop : drops)
    {
      const float place[4] = { drop.Place[0], drop.Place[1], drop.Place[2], 0.0f };
      brick.Bounds.Add(bricks::Float4::Load(place));
      brick.Range.Add({ drop.Value, drop.Value });
    }
    brick.Bytes.resize(count * sizeof(Drop));
    std::memcpy(brick.Bytes.data(), drops.data(), brick.Bytes.size());
    return { brick };
  }
};

class DropReader final : public bricks::RecordReader
{
public:
  explicit DropReader(std::vector<Drop> drops)
    : Drops(std::move(drops))
  {
  }

  bricks::RecordKind GetKind() const override
  {
    return { "cloud", "drops", sizeof(Drop), sizeof(Drop), 1000 };
  }
  std::uint64_t GetCount() const override { return this->Drops.size(); }
  bricks::PositionBounds FindBounds(int threads) const override
  {
    return bricks::FindPositionBounds(threads, this->GetCount(),
      [this](std::uint64_t drop, bricks::PositionBounds& bounds)
      {
        const float* const p = this->Drops[drop].Place;
        bounds.Add(glm::dvec3(p[0], p[1], p[2]));
      });
  }
  void SetSpace(const bricks::BrickSpace& space, int) override
  {
    EXPECT_EQ(space.Origin, glm::dvec3(0.0));
    EXPECT_EQ(space.Scale, 1.0);
  }
  void FindCodes(std::uint64_t begin, std::uint64_t end, const bricks::MortonCode& order,
    std::uint64_t* codes) const override
  {
    for (std::uint64_t drop = begin; drop < end; ++drop)
    {
      float corners[9];
      for (int word = 0; word < 9; ++word)
      {
        corners[word] = this->Drops[drop].Place[word % 3];
      }
      codes[drop - begin] = order.GetOfTriangle(corners);
    }
  }
  void ReadRecords(
    const std::uint64_t* drops, std::size_t count, std::uint32_t* records) const override
  {
    for (std::size_t number = 0; number < count; ++number)
    {
      std::memcpy(records + number * sizeof(Drop) / sizeof(*records), &this->Drops[drops[number]],
        sizeof(Drop));
    }
  }
  std::unique_ptr<bricks::RecordBrickBuilder> CreateBuilder(
    const bricks::MortonCode&, std::uint32_t) const override
  {
    return std::make_unique<DropBricks>();
  }

private:
  std::vector<Drop> Drops;
};

struct SortedOutcome
{
  std::map<dsm::BlockId, std::vector<std::byte>> Blocks;
  std::vector<std::byte> Nodes;
};

SortedOutcome Publish(const std::vector<Drop>& drops, int ranks)
{
  SortedOutcome outcome;
  std::mutex guard;
  RunOnCluster(ranks,
    [&](dsm::Messenger& messenger)
    {
      std::vector<Drop> mine;
      for (std::size_t drop = 0; drop < drops.size(); ++drop)
      {
        if (drop % static_cast<std::size_t>(ranks) == static_cast<std::size_t>(messenger.GetRank()))
        {
          mine.push_back(drops[drop]);
        }
      }
      dsm::ObjectStore store(messenger, { std::size_t(1) << 20, 1 });
      DropReader reader(mine);
      bricks::SortedBrickSettings settings;
      settings.BrickBytes = 1600;
      bricks::SortedBrickBuilder builder("drops", reader, settings, messenger);
      EXPECT_EQ(builder.GetCount(), drops.size());
      bricks::RangedBrickBvh hierarchy;
      const auto segment = builder.Publish(store, hierarchy, {});
      const std::lock_guard<std::mutex> lock(guard);
      segment->ForEachResident(
        [&](dsm::BlockId id, const std::byte* block, std::size_t bytes)
        {
          outcome.Blocks[id].assign(block, block + bytes);
          // The hierarchy knows the range of each brick, to the bit.
          bricks::ValueRange range = bricks::ValueRange::GetEmpty();
          for (std::size_t place = 0; place < bytes; place += sizeof(Drop))
          {
            Drop drop;
            std::memcpy(&drop, block + place, sizeof(drop));
            range.Add({ drop.Value, drop.Value });
          }
          EXPECT_EQ(hierarchy.GetRange(id).First, range.First);
          EXPECT_EQ(hierarchy.GetRange(id).Last, range.Last);
        });
      EXPECT_EQ(hierarchy.GetRanges().size(), segment->GetDirectory().GetCount());
      const auto* const nodes = reinterpret_cast<const std::byte*>(hierarchy.GetNodes());
      outcome.Nodes.assign(nodes, nodes + hierarchy.GetBytes());
    });
  return outcome;
}

TEST(SortedBricks, HoldAnyKindOfPrimitivesOnAnyNumberOfRanks)
{
  std::vector<Drop> drops = CreateDrops();
  const SortedOutcome alone = Publish(drops, 1);
  const SortedOutcome shared = Publish(drops, 3);
  EXPECT_GT(alone.Blocks.size(), 20u);
  EXPECT_EQ(alone.Blocks, shared.Blocks);
  EXPECT_EQ(alone.Nodes, shared.Nodes);
  std::vector<Drop> found;
  for (const auto& [id, bytes] : alone.Blocks)
  {
    found.resize(found.size() + bytes.size() / sizeof(Drop));
    std::memcpy(static_cast<void*>(&*(found.end() - bytes.size() / sizeof(Drop))), bytes.data(),
      bytes.size());
  }
  std::sort(found.begin(), found.end());
  std::sort(drops.begin(), drops.end());
  ASSERT_EQ(found.size(), drops.size());
  EXPECT_EQ(std::memcmp(found.data(), drops.data(), drops.size() * sizeof(Drop)), 0);
}

TEST(SortedBricks, SayWhatDoesNotFit)
{
  RunOnCluster(2,
    [](dsm::Messenger& messenger)
    {
      DropReader reader(CreateDrops());
      bricks::SortedBrickSettings settings;
      settings.MemoryBytes = 1000;
      try
      {
        bricks::SortedBrickBuilder("drops", reader, settings, messenger);
        ADD_FAILURE() << "nothing was thrown";
      }
      catch (const dsm::Error& error)
      {
        EXPECT_NE(std::string(error.what()).find("The cloud has 6000 drops."), std::string::npos)
          << error.what();
      }
    });
}

/// As a user's abort does: while primitives are sorted, and while bricks are built.
TEST(SortedBricks, EndOnAllRanksWhereProgressThrowsOnOne)
{
  for (const double end : { 0.0, 0.4 })
  {
    RunOnCluster(3,
      [end](dsm::Messenger& messenger)
      {
        DropReader reader(CreateDrops());
        bricks::SortedBrickSettings settings;
        settings.BrickBytes = 1600;
        const auto giveUp = [&](double part)
        {
          if (messenger.GetRank() == 1 && part >= end)
          {
            throw dsm::Error("that is enough");
          }
        };
        try
        {
          bricks::SortedBrickBuilder builder("drops", reader, settings, messenger, giveUp);
          EXPECT_GT(end, 0.2);
          builder.Build(giveUp);
          ADD_FAILURE() << "nothing was thrown";
        }
        catch (const dsm::Error& error)
        {
          EXPECT_STREQ(error.what(), "drops: Rank 1: that is enough");
        }
      });
  }
}

} // namespace
