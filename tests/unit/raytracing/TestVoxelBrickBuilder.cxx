// SPDX-License-Identifier: BSD-3-Clause
#include "CellScenarios.h"
#include "DSMBricks/build/ValidSource.h"
#include "DSMBricks/build/VoxelBrickBuilder.h"
#include "DSMBricks/build/VoxelBrickReader.h"
#include "DSMBricks/layout/MacrocellBuilder.h"
#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMCore/base/Error.h"
#include "RandomCuts.h"
#include "TestVolume.h"
#include "tests/support/LoopbackCluster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

namespace
{

template <class T>
TestVolume<T> CreateRandomVolume(const bricks::Index3& points, std::mt19937& random)
{
  return TestVolume<T>(
    points, [&](int, int, int) { return static_cast<T>(static_cast<int>(random() % 200) - 100); });
}

template <class T>
void ExpectSameBricksForAllCuts(bool masked, bool ofCells = false)
{
  std::mt19937 random(5);
  TestVolume<T> volume = CreateRandomVolume<T>({ 14, 10, 12 }, random);
  for (int i = 0; masked && i < 300; ++i)
  {
    volume.Blank(random() % 13, random() % 9, random() % 11);
  }
  const bricks::BrickLattice ofPoints(volume.Points, GetScalarType<T>(), masked, 5);
  const bricks::BrickLattice lattice = ofCells ? ofPoints.OfCells() : ofPoints;
  MemoryStore store;
  const auto expected = PublishPieces(store, lattice, GetWhole(volume));
  for (const int cuts : { 1, 3, 10, 60 })
  {
    Pieces pieces;
    for (const bricks::Box& box :
      CutAtRandom({ bricks::Index3(0), volume.GetCells() }, cuts, random))
    {
      pieces.push_back(std::make_shared<VolumePiece<T>>(volume, box));
    }
    const auto actual = PublishPieces(store, lattice, pieces);
    for (dsm::BlockId id = 0; id < lattice.GetBrickCount(); ++id)
    {
      ASSERT_EQ(
        std::memcmp(actual->GetBlock(id), expected->GetBlock(id), lattice.GetBlockBytes(id)), 0)
        << "brick " << id << " after " << cuts << " cuts";
    }
  }
}

} // namespace

template <class T>
class TestVoxelBrickBuilder : public testing::Test
{
};

using ScalarTypes = testing::Types<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t,
  std::int32_t, std::uint32_t, std::int64_t, std::uint64_t, float, double>;
TYPED_TEST_SUITE(TestVoxelBrickBuilder, ScalarTypes);

TYPED_TEST(TestVoxelBrickBuilder, AnySplitGivesTheSameBytes)
{
  ExpectSameBricksForAllCuts<TypeParam>(false);
  ExpectSameBricksForAllCuts<TypeParam>(true);
  ExpectSameBricksForAllCuts<TypeParam>(true, true);
}

TYPED_TEST(TestVoxelBrickBuilder, SamplesAreKeptAsTheyAre)
{
  std::mt19937 random(6);
  const auto volume = CreateRandomVolume<TypeParam>({ 11, 7, 9 }, random);
  const bricks::BrickLattice lattice(volume.Points, GetScalarType<TypeParam>(), false, 4);
  MemoryStore store;
  const auto segment = PublishPieces(store, lattice, GetWhole(volume));
  for (dsm::BlockId id = 0; id < lattice.GetBrickCount(); ++id)
  {
    const bricks::Box cells = lattice.GetCellsOfBrick(id);
    const bricks::VoxelBrick<TypeParam> brick(segment->GetBlock(id));
    ASSERT_EQ(reinterpret_cast<std::uintptr_t>(brick.GetSamples()) % 64, 0u);
    for (auto z = cells.Min.z; z <= cells.Max.z; ++z)
    {
      for (auto y = cells.Min.y; y <= cells.Max.y; ++y)
      {
        for (auto x = cells.Min.x; x <= cells.Max.x; ++x)
        {
          ASSERT_EQ(
            brick.GetSample(x - cells.Min.x, y - cells.Min.y, z - cells.Min.z), volume.At(x, y, z));
        }
      }
    }
  }
}

TYPED_TEST(TestVoxelBrickBuilder, MacrocellsSpanTheirCorners)
{
  using T = TypeParam;
  std::mt19937 random(7);
  const auto volume = CreateRandomVolume<T>({ 8, 6, 7 }, random);
  const bricks::BrickLattice lattice(volume.Points, GetScalarType<T>(), false, 16);
  MemoryStore store;
  const auto segment = PublishPieces(store, lattice, GetWhole(volume));
  const bricks::VoxelBrick<T> brick(segment->GetBlock(0));
  ASSERT_EQ(brick.GetMacrocells(0), 2);
  ASSERT_EQ(brick.GetMacrocells(1), 2);
  ASSERT_EQ(brick.GetMacrocells(2), 2);
  for (int macrocell = 0; macrocell < 8; ++macrocell)
  {
    const int first[3] = { 4 * (macrocell & 1), 4 * (macrocell >> 1 & 1), 4 * (macrocell >> 2) };
    T low = std::numeric_limits<T>::max();
    T high = std::numeric_limits<T>::lowest();
    for (int z = first[2]; z <= std::min(first[2] + 4, 6); ++z)
    {
      for (int y = first[1]; y <= std::min(first[1] + 4, 5); ++y)
      {
        for (int x = first[0]; x <= std::min(first[0] + 4, 7); ++x)
        {
          low = std::min(low, volume.At(x, y, z));
          high = std::max(high, volume.At(x, y, z));
        }
      }
    }
    EXPECT_EQ(brick.GetMacrocellRanges()[macrocell].Min, low);
    EXPECT_EQ(brick.GetMacrocellRanges()[macrocell].Max, high);
  }
}

TYPED_TEST(TestVoxelBrickBuilder, CellsWithAMissingValueHoldNoData)
{
  using T = TypeParam;
  std::mt19937 random(8);
  auto volume = CreateRandomVolume<T>({ 14, 10, 12 }, random);
  volume.Blank(3, 4, 5);
  const bricks::ScalarType type = GetScalarType<T>();
  bricks::ValidValues valid;
  EXPECT_FALSE(valid.Exclude(type));
  valid.Lowest = 0.0;
  valid.Highest = 98.0;
  valid.AddFill(7.0);
  EXPECT_TRUE(valid.Exclude(type));
  const auto isValid = [](T value) { return value >= T(0) && value <= T(98) && value != T(7); };
  const bricks::BrickLattice lattice(volume.Points, type, true, 5);
  Pieces pieces;
  for (const auto& piece : GetWhole(volume))
  {
    pieces.push_back(bricks::ValidSource::Make(piece, lattice, valid));
  }
  MemoryStore store;
  const auto segment = PublishPieces(store, lattice, pieces);
  const bricks::VoxelBrickReader reader(lattice, pieces.front());
  for (dsm::BlockId id = 0; id < lattice.GetBrickCount(); ++id)
  {
    std::vector<std::byte> read(lattice.GetBlockBytes(id));
    reader.Read(id, read.data(), read.size());
    ASSERT_EQ(std::memcmp(read.data(), segment->GetBlock(id), read.size()), 0) << "brick " << id;
    const bricks::Box cells = lattice.GetCellsOfBrick(id);
    const bricks::VoxelBrick<T> brick(segment->GetBlock(id));
    EXPECT_TRUE(brick.GetHeader().First > brick.GetHeader().Last ||
      (brick.GetHeader().First >= 0.0f && brick.GetHeader().Last <= 98.0f));
    bricks::ForEachIndex(cells,
      [&](const bricks::Index3& cell)
      {
        bool holdsData = volume.IsCovered(cell.x, cell.y, cell.z);
        bricks::ForEachIndex({ cell, cell + bricks::Index3(2) },
          [&](const bricks::Index3& at)
          { holdsData = holdsData && isValid(volume.At(at.x, at.y, at.z)); });
        const bricks::Index3 in = cell - cells.Min;
        EXPECT_EQ(brick.HoldsData(in.x, in.y, in.z), holdsData);
      });
  }
}

TEST(TestValidValues, FloatingPointGiantsStandForWhatIsBeyondThem)
{
  bricks::ValidValues valid;
  valid.Fills.front() = 9.969209968386869e36; // as netCDF has it, for float and double
  const bricks::MissingTest<float> isMissing(valid);
  EXPECT_TRUE(isMissing(9.96921e36f));
  EXPECT_TRUE(isMissing(1e38f));
  EXPECT_FALSE(isMissing(9.9e36f));
  EXPECT_FALSE(isMissing(-9.96921e36f));
  valid.Fills.front() = -1e20;
  EXPECT_TRUE(bricks::MissingTest<float>(valid)(-1e20f));
  EXPECT_TRUE(bricks::MissingTest<double>(valid)(-1e21));
  EXPECT_FALSE(bricks::MissingTest<double>(valid)(1e20));
  valid.Fills.front() = -9999.9;
  EXPECT_TRUE(bricks::MissingTest<float>(valid)(-9999.9f));
  EXPECT_FALSE(bricks::MissingTest<float>(valid)(-10000.0f));
  valid.Fills.front() = -9999.0;
  EXPECT_FALSE(valid.Exclude(bricks::ScalarType::UInt8));
  EXPECT_TRUE(bricks::MissingTest<std::int16_t>(valid)(-9999));
  EXPECT_FALSE(bricks::MissingTest<std::int16_t>(valid)(-10000));
  std::vector<double> values{ 1.0, -9999.0 };
  bricks::ReplaceMissing(
    valid, bricks::ScalarType::Float64, reinterpret_cast<std::byte*>(values.data()), values.size());
  EXPECT_EQ(values[0], 1.0);
  EXPECT_TRUE(std::isnan(values[1]));
}

TEST(TestValidValues, SeveralValuesAreMissing)
{
  bricks::ValidValues valid;
  for (const double fill : { 3.0, 4.0, 1e20, -9999.0 })
  {
    EXPECT_TRUE(valid.AddFill(fill));
    EXPECT_TRUE(valid.AddFill(fill)); // again
  }
  EXPECT_FALSE(valid.AddFill(5.0));
  EXPECT_TRUE(valid.AddFill(std::nan("")));
  const bricks::MissingTest<std::int16_t> isMissing(valid);
  EXPECT_TRUE(isMissing(3) && isMissing(4) && isMissing(-9999));
  EXPECT_FALSE(isMissing(5));
  EXPECT_TRUE(bricks::MissingTest<float>(valid)(2e20f));
  EXPECT_FALSE(bricks::MissingTest<float>(valid)(-2e20f));
}

TEST(TestVoxelBrick, CellsWithoutDataAreLeftOutOfTheRange)
{
  TestVolume<float> volume({ 9, 5, 5 }, [](int x, int, int) { return static_cast<float>(x); });
  volume.At(1, 1, 1) = std::numeric_limits<float>::quiet_NaN();
  volume.At(8, 4, 4) = std::numeric_limits<float>::infinity();
  const bricks::BrickLattice lattice(volume.Points, bricks::ScalarType::Float32, false, 16);
  MemoryStore store;
  const auto segment = PublishPieces(store, lattice, GetWhole(volume));
  const bricks::VoxelBrick<float> brick(segment->GetBlock(0));
  EXPECT_EQ(brick.GetMacrocellRanges()[0].Min, 0.0f);
  EXPECT_EQ(brick.GetMacrocellRanges()[0].Max, 4.0f);
  EXPECT_EQ(brick.GetMacrocellRanges()[1].Max, 8.0f);
  EXPECT_FALSE(brick.HoldsData(0, 0, 0));
  EXPECT_FALSE(brick.HoldsData(7, 3, 3));
  EXPECT_TRUE(brick.HoldsData(2, 1, 1));
}

TEST(TestVoxelBrick, BrickWithoutDataIsEmpty)
{
  TestVolume<float> volume(
    { 3, 3, 3 }, [](int, int, int) { return std::numeric_limits<float>::quiet_NaN(); });
  const bricks::BrickLattice lattice(volume.Points, bricks::ScalarType::Float32, false, 16);
  MemoryStore store;
  const auto segment = PublishPieces(store, lattice, GetWhole(volume));
  const bricks::VoxelBrick<float> brick(segment->GetBlock(0));
  EXPECT_GT(brick.GetHeader().First, brick.GetHeader().Last);
  EXPECT_GT(brick.GetMacrocellRanges()[0].Min, brick.GetMacrocellRanges()[0].Max);
}

TEST(TestVoxelBrick, CellsThatNoPieceCoversHoldNoData)
{
  const TestVolume<short> volume({ 7, 5, 5 }, [](int x, int, int) { return x; });
  const bricks::BrickLattice lattice(volume.Points, bricks::ScalarType::Int16, true, 8);
  MemoryStore store;
  const auto segment = PublishPieces(store, lattice,
    { std::make_shared<VolumePiece<short>>(volume, bricks::Box{ { 2, 0, 0 }, { 3, 4, 4 } }) });
  const bricks::VoxelBrick<short> brick(segment->GetBlock(0));
  for (int x = 0; x < 6; ++x)
  {
    EXPECT_EQ(brick.HoldsData(x, 1, 2), x == 2);
  }
  EXPECT_EQ(brick.GetHeader().First, 2.0f);
  EXPECT_EQ(brick.GetHeader().Last, 3.0f);
}

TEST(TestVoxelBrick, RangesAreRoundedOutward)
{
  constexpr std::int64_t large = (std::int64_t(1) << 62) + 1;
  const auto contains = [](long double value, float low, float high)
  { return static_cast<long double>(low) <= value && value <= static_cast<long double>(high); };
  for (const std::int64_t value : { large, -large, std::int64_t(16777217), std::int64_t(-3),
         std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::lowest() })
  {
    EXPECT_TRUE(contains(value, bricks::RoundDown(value), bricks::RoundUp(value))) << value;
  }
  EXPECT_TRUE(contains(std::numeric_limits<std::uint64_t>::max(),
    bricks::RoundDown(std::numeric_limits<std::uint64_t>::max()),
    bricks::RoundUp(std::numeric_limits<std::uint64_t>::max())));
  for (const double value : { 0.1, -0.1, 1e300, -1e300, 1e-300, -1e-300, 0.0 })
  {
    EXPECT_TRUE(contains(value, bricks::RoundDown(value), bricks::RoundUp(value))) << value;
  }
  EXPECT_EQ(bricks::RoundDown(0.25f), 0.25f);
  EXPECT_EQ(bricks::RoundUp(std::uint8_t(255)), 255.0f);
}

TEST(TestVoxelFragmentSource, OneFragmentForEachPieceAndBrick)
{
  const TestVolume<float> volume({ 9, 9, 9 });
  const bricks::BrickLattice lattice(volume.Points, bricks::ScalarType::Float32, false, 4);
  bricks::VoxelFragmentSource source(lattice,
    { std::make_shared<VolumePiece<float>>(volume, bricks::Box{ { 0, 0, 0 }, { 8, 8, 3 } }),
      std::make_shared<VolumePiece<float>>(volume, bricks::Box{ { 5, 5, 5 }, { 5, 8, 8 } }),
      std::make_shared<VolumePiece<float>>(volume, bricks::Box{ { 3, 3, 3 }, { 5, 4, 4 } }) });
  dsm::Fragment fragment;
  std::vector<dsm::BlockId> blocks;
  double progress = -1.0;
  while (source.Next(fragment))
  {
    blocks.push_back(fragment.Block);
    EXPECT_GT(source.GetProgress(), progress);
    progress = source.GetProgress();
  }
  EXPECT_EQ(blocks, (std::vector<dsm::BlockId>{ 0, 1, 2, 3, 0, 1 }));
  EXPECT_EQ(progress, 1.0);
}

TEST(TestVoxelFragmentSource, RankWithoutDataHasNoFragment)
{
  bricks::VoxelFragmentSource source(
    bricks::BrickLattice({ 9, 9, 9 }, bricks::ScalarType::Int8, false), {});
  dsm::Fragment fragment;
  EXPECT_FALSE(source.Next(fragment));
  EXPECT_EQ(source.GetProgress(), 1.0);
}

TEST(TestVoxelFragmentSource, RefusesAMaskThatTheLatticeLacks)
{
  TestVolume<float> volume({ 3, 3, 3 });
  volume.Blank(0, 0, 0);
  const bricks::BrickLattice lattice(volume.Points, bricks::ScalarType::Float32, false);
  EXPECT_THROW(bricks::VoxelFragmentSource(lattice, GetWhole(volume)), dsm::Error);
}

TEST(TestVoxelBrickSink, RefusesFragmentsThatDoNotFit)
{
  const TestVolume<float> volume({ 9, 9, 9 });
  const bricks::BrickLattice lattice(volume.Points, bricks::ScalarType::Float32, false, 8);
  const bricks::BrickLattice wider({ 17, 9, 9 }, bricks::ScalarType::Float32, false, 16);
  bricks::VoxelBrickSink sink(lattice);
  std::vector<std::byte> block(lattice.GetBlockBytes(0));
  EXPECT_THROW(sink.Begin(0, block.data(), block.size() - 1), dsm::Error);
  sink.Begin(0, block.data(), block.size());
  dsm::Fragment fragment;
  bricks::VoxelFragmentSource source(lattice, GetWhole(volume));
  ASSERT_TRUE(source.Next(fragment));
  const auto absorb = [&](std::size_t bytes)
  { sink.Absorb(0, block.data(), block.size(), fragment.Bytes.data(), bytes); };
  EXPECT_NO_THROW(absorb(fragment.Bytes.size()));
  EXPECT_THROW(absorb(fragment.Bytes.size() - 1), dsm::Error);
  EXPECT_THROW(absorb(7), dsm::Error);
  const TestVolume<float> wide({ 17, 9, 9 });
  bricks::VoxelFragmentSource foreign(wider, GetWhole(wide));
  ASSERT_TRUE(foreign.Next(fragment));
  EXPECT_THROW(absorb(fragment.Bytes.size()), dsm::Error);
}

TEST(CellAverages, DoNotDependOnPieces)
{
  for (const int ranks : { 1, 2, 4 })
  {
    RunOnCluster(ranks, &dsm_test::AveragesDoNotDependOnPieces);
  }
}

TEST(CellAverages, CopiesStandInForMissingPieces)
{
  for (const int ranks : { 1, 3 })
  {
    RunOnCluster(ranks, &dsm_test::CopiesStandInForMissingPieces);
  }
}
