// SPDX-License-Identifier: BSD-3-Clause
// Ranges and bricks, found in one reading.
#include "DSMBricks/build/VoxelBrickReader.h"
#include "DSMBricks/build/VoxelIndex.h"
#include "DSMCore/transport/LoopbackTransport.h"
#include "DSMVolumeFiles/cache/FileSamples.h"
#include "DSMVolumeFiles/range/LookThrough.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <thread>
#include <vector>

namespace
{

const bricks::Index3 Samples(70, 53, 41);

float GetValue(const bricks::Index3& at)
{
  if (at == bricks::Index3(33, 20, 7))
  {
    return std::numeric_limits<float>::quiet_NaN();
  }
  if (at == bricks::Index3(60, 50, 40))
  {
    return std::numeric_limits<float>::infinity();
  }
  return std::sin(0.1f * static_cast<float>(at.x)) * std::cos(0.2f * static_cast<float>(at.y)) +
    0.01f * static_cast<float>(at.z);
}

class ComputedFile final : public vol::VolumeFile
{
public:
  explicit ComputedFile(const bricks::Index3& chunk)
    : VolumeFile("computed")
  {
    vol::FileArray array;
    array.Type = bricks::ScalarType::Float32;
    array.Grid = { Samples, chunk };
    this->Arrays.push_back(array);
    this->Geometry.Points = Samples;
  }
  void ReadChunk(std::size_t, int, const bricks::Index3& chunk, std::byte* out) const override
  {
    ++this->Read;
    auto* to = reinterpret_cast<float*>(out);
    bricks::ForEachIndex(this->GetArrays().front().Grid.GetBox(chunk),
      [&](const bricks::Index3& at) { *to++ = GetValue(at); });
  }

  mutable std::atomic<int> Read{ 0 };
};

/// A ball's values in two chunks, and 0.5 where nothing is stored, which it may say.
class SparseFile final : public vol::VolumeFile
{
public:
  SparseFile(bool says, double missing)
    : VolumeFile("sparse")
    , Says(says)
  {
    vol::FileArray array;
    array.Type = bricks::ScalarType::Float32;
    array.Grid = { Samples, bricks::Index3(16) };
    array.Valid.AddFill(missing);
    this->Arrays.push_back(array);
    this->Geometry.Points = Samples;
  }
  void ReadChunk(std::size_t, int, const bricks::Index3& chunk, std::byte* out) const override
  {
    ++this->Read;
    auto* to = reinterpret_cast<float*>(out);
    bricks::ForEachIndex(this->GetArrays().front().Grid.GetBox(chunk),
      [&](const bricks::Index3& at)
      {
        const bool isMissing = this->GetArrays().front().Valid.Fills.front() == 0.5;
        const float fill = isMissing ? std::numeric_limits<float>::quiet_NaN() : 0.5f;
        *to++ = IsThere(chunk) ? GetValue(at) : fill;
      });
  }
  bool IsFill(std::size_t, int, const bricks::Box& box) const override
  {
    bool isThere = false;
    const bricks::Index3 edge(16);
    bricks::ForEachIndex({ box.Min / edge, (box.Max + bricks::Index3(15)) / edge },
      [&](const bricks::Index3& chunk) { isThere = isThere || IsThere(chunk); });
    return this->Says && !isThere;
  }

  mutable std::atomic<int> Read{ 0 };

private:
  static bool IsThere(const bricks::Index3& chunk)
  {
    return chunk == bricks::Index3(0) || chunk == bricks::Index3(4, 3, 2);
  }

  bool Says;
};

bool GoOn(double)
{
  return true;
}

/// Cut along z, with a layer of samples in common, as VTK cuts an image.
std::vector<bricks::Box> Cut(int pieces)
{
  std::vector<bricks::Box> boxes;
  for (int piece = 0; piece < pieces; ++piece)
  {
    const std::int64_t cells = Samples.z - 1;
    const std::int64_t end = cells * (piece + 1) / pieces;
    boxes.push_back({ { 0, 0, cells * piece / pieces }, { Samples.x, Samples.y, end + 1 } });
  }
  return boxes;
}

struct Found
{
  bricks::VoxelIndex Index;
  std::vector<int> Read; ///< bricks, of each rank
};

/// Counts.
class CountingReader final : public dsm::BlockReader
{
public:
  CountingReader(
    const bricks::BrickLattice& lattice, const std::shared_ptr<const vol::VolumeFile>& file)
    : Bricks(lattice,
        std::make_shared<vol::FileSamples>(
          vol::ArrayStep{ file, 0, 0 }, vol::ChunkCache::GetShared()))
  {
  }
  void Read(dsm::BlockId id, std::byte* block, std::size_t bytes) const override
  {
    ++this->Count;
    this->Bricks.Read(id, block, bytes);
  }
  mutable std::atomic<int> Count{ 0 };

private:
  bricks::VoxelBrickReader Bricks;
};

/// The index that ranks find which have looked through these pieces.
Found FindIndex(const std::vector<bricks::Box>& pieces, bool look)
{
  const auto file = std::make_shared<const ComputedFile>(bricks::Index3(24, 20, 16));
  const bricks::BrickLattice lattice(Samples, bricks::ScalarType::Float32, false);
  auto transports = dsm::LoopbackTransport::CreateGroup(static_cast<int>(pieces.size()));
  Found found;
  found.Read.resize(pieces.size());
  std::vector<std::thread> threads;
  for (std::size_t rank = 0; rank < pieces.size(); ++rank)
  {
    threads.emplace_back(
      [&, rank]
      {
        dsm::Messenger messenger(std::move(transports[rank]));
        std::optional<vol::Look> seen;
        if (look)
        {
          seen = vol::LookThrough({ file, 0, 0 }, pieces[rank], 2, GoOn);
        }
        bricks::VoxelIndex::Pass pass;
        pass.Order.resize(lattice.GetBrickCount());
        std::iota(pass.Order.begin(), pass.Order.end(), dsm::BlockId(0));
        pass.Seen = seen ? &seen->Bricks : nullptr;
        const CountingReader reader(lattice, file);
        bricks::VoxelIndex index = bricks::VoxelIndex::Find(messenger, lattice, reader, pass, {});
        found.Read[rank] = reader.Count;
        if (rank == 0)
        {
          found.Index = std::move(index);
        }
        messenger.Barrier();
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  return found;
}

} // namespace

TEST(LookThrough, TheIndexIsThatOfBricksReadForIt)
{
  const std::vector<std::byte> expected = FindIndex(Cut(1), false).Index.Encode();
  for (const int ranks : { 1, 2, 3 })
  {
    const Found found = FindIndex(Cut(ranks), true);
    EXPECT_EQ(found.Index.Encode(), expected) << ranks << " ranks";
    for (const int read : found.Read)
    {
      EXPECT_EQ(read, 0) << ranks << " ranks";
    }
  }
}

/// As where pieces have ghost cells: what two ranks have seen counts once, and the rest is read.
TEST(LookThrough, BricksThatSeveralRanksHaveSeenCountOnce)
{
  const std::vector<std::byte> expected = FindIndex(Cut(1), false).Index.Encode();
  const Found found = FindIndex(
    { { bricks::Index3(0), { Samples.x, Samples.y, 18 } }, { { 0, 0, 16 }, Samples } }, true);
  EXPECT_EQ(found.Index.Encode(), expected);
  EXPECT_GT(std::accumulate(found.Read.begin(), found.Read.end(), 0), 0);
}

TEST(LookThrough, RangesAreOfTheBoxAlone)
{
  const auto file = std::make_shared<const ComputedFile>(bricks::Index3(16));
  const std::vector<bricks::Box> boxes = { { bricks::Index3(0), Samples },
    { bricks::Index3(5, 17, 3), bricks::Index3(34, 33, 20) },
    { bricks::Index3(48, 32, 32), Samples }, { bricks::Index3(0, 0, 40), Samples } };
  for (const bricks::Box& box : boxes)
  {
    const auto look = vol::LookThrough({ file, 0, 0 }, box, 3, GoOn);
    const auto expected = vol::FindRanges({ file, 0, 0 }, box, 1, GoOn);
    ASSERT_TRUE(look && expected);
    EXPECT_EQ(look->Ranges.All[0].Least, expected->All[0].Least);
    EXPECT_EQ(look->Ranges.All[0].Greatest, expected->All[0].Greatest);
    EXPECT_EQ(look->Ranges.Finite[0].Greatest, expected->Finite[0].Greatest);
  }
  EXPECT_FALSE(vol::LookThrough({ file, 0, 0 }, boxes[0], 2, [](double) { return false; }));
}

TEST(LookThrough, EachChunkIsReadAboutOnce)
{
  const auto file = std::make_shared<const ComputedFile>(bricks::Index3(16));
  ASSERT_TRUE(vol::LookThrough({ file, 0, 0 }, { bricks::Index3(0), Samples }, 2, GoOn));
  EXPECT_EQ(file->Read, file->GetArrays().front().Grid.GetCount());
}

/// Where the cache holds few chunks, most would be read for several bricks.
TEST(LookThrough, IsNotForChunksThatTheCacheDoesNotHold)
{
  vol::ChunkCache& cache = vol::ChunkCache::GetShared();
  const std::size_t limit = cache.GetLimit();
  const ComputedFile file(bricks::Index3(32));
  EXPECT_TRUE(vol::CanLookAtBricks(file.GetArrays().front()));
  cache.SetLimit(1 << 20);
  EXPECT_FALSE(vol::CanLookAtBricks(file.GetArrays().front()));
  cache.SetLimit(limit);
  vol::FileArray flat = file.GetArrays().front();
  flat.Grid.Samples.z = 1;
  EXPECT_FALSE(vol::CanLookAtBricks(flat));
}

TEST(LookThrough, AllBricksAreInOrderOnce)
{
  const bricks::BrickLattice lattice(Samples, bricks::ScalarType::UInt8, false, 8);
  vol::FileArray array;
  for (const bricks::Index3& chunk :
    { bricks::Index3(5, 64, 1), bricks::Index3(24, 20, 16), bricks::Index3(128) })
  {
    array.Grid = { Samples + bricks::Index3(9), chunk };
    std::vector<dsm::BlockId> order = vol::OrderBricks(
      lattice, { bricks::Index3(0), lattice.GetBricks() }, array, bricks::Index3(9, 7, 3));
    std::sort(order.begin(), order.end());
    std::vector<dsm::BlockId> expected(lattice.GetBrickCount());
    std::iota(expected.begin(), expected.end(), dsm::BlockId(0));
    EXPECT_EQ(order, expected);
  }
}

/// Bricks of what is not stored count without being read, and the results are the same.
TEST(LookThrough, WhatIsNotStoredIsNotRead)
{
  for (const double missing : { std::numeric_limits<double>::quiet_NaN(), 0.5 })
  {
    SCOPED_TRACE(missing);
    const auto whole = bricks::Box{ bricks::Index3(0), Samples };
    const auto all = std::make_shared<const SparseFile>(false, missing);
    const auto few = std::make_shared<const SparseFile>(true, missing);
    const auto expected = vol::LookThrough({ all, 0, 0 }, whole, 2, GoOn);
    const auto found = vol::LookThrough({ few, 0, 0 }, whole, 2, GoOn);
    ASSERT_TRUE(expected && found);
    EXPECT_LT(few->Read, all->Read);
    const auto expectSame = [](const vol::ValueRanges& one, const vol::ValueRanges& other)
    {
      EXPECT_EQ(one.All[0].Least, other.All[0].Least);
      EXPECT_EQ(one.All[0].Greatest, other.All[0].Greatest);
      EXPECT_EQ(one.Finite[0].Greatest, other.Finite[0].Greatest);
    };
    expectSame(found->Ranges, expected->Ranges);
    ASSERT_EQ(found->Bricks.Seen.size(), expected->Bricks.Seen.size());
    for (std::size_t brick = 0; brick < found->Bricks.Seen.size(); ++brick)
    {
      const bricks::SeenBrick& one = found->Bricks.Seen[brick];
      const bricks::SeenBrick& other = expected->Bricks.Seen[brick];
      EXPECT_EQ(one.Range.First, other.Range.First);
      EXPECT_EQ(one.Range.Last, other.Range.Last);
      EXPECT_FALSE(one.Digest != other.Digest);
    }
    const bricks::IsovalueSurvey& survey = found->Bricks.Survey;
    EXPECT_EQ(survey.All, expected->Bricks.Survey.All);
    EXPECT_EQ(survey.AtBorder, expected->Bricks.Survey.AtBorder);
    EXPECT_EQ(survey.Values, expected->Bricks.Survey.Values);
    EXPECT_EQ(survey.Crossed, expected->Bricks.Survey.Crossed);
    EXPECT_EQ(survey.CutOpen, expected->Bricks.Survey.CutOpen);
    const int before = few->Read;
    const auto ranges = vol::FindRanges({ few, 0, 0 }, whole, 2, GoOn);
    ASSERT_TRUE(ranges);
    EXPECT_LE(few->Read, before + 4) << "two chunks, and the fill value for each thread";
    expectSame(*ranges, expected->Ranges);
  }
}
