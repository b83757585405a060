// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/layout/FirstIsovalue.h"
#include "DSMCore/transport/LoopbackTransport.h"
#include "TestVolume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>

namespace
{

constexpr int Points = 64;

/// One rank's share of the blocks of a segment.
class ShareOfSegment final : public dsm::BlockSegment
{
public:
  ShareOfSegment(std::shared_ptr<dsm::BlockSegment> all, dsm::BlockDirectory directory, int rank)
    : BlockSegment(0, std::move(directory))
    , All(std::move(all))
    , Rank(rank)
  {
  }
  void ForEachResident(const Visit& visit) const override
  {
    this->All->ForEachResident(
      [&](dsm::BlockId id, const std::byte* block, std::size_t bytes)
      {
        if (this->GetDirectory().GetOwner(id) == this->Rank)
        {
          visit(id, block, bytes);
        }
      });
  }
  std::uint64_t GetResidentBytes() const override { return 0; }
  std::byte* GetOwned(dsm::BlockId) const override { return nullptr; }
  void Seal() override {}

private:
  std::shared_ptr<dsm::BlockSegment> All;
  int Rank;
};

using Fields = std::vector<std::shared_ptr<bricks::VoxelField>>;

/// What each of several ranks finds.
std::vector<std::optional<double>> FindOnRanks(const Fields& fields, int ranks)
{
  auto transports = dsm::LoopbackTransport::CreateGroup(ranks);
  std::vector<std::optional<double>> found(ranks);
  std::vector<std::thread> threads;
  for (int rank = 0; rank < ranks; ++rank)
  {
    threads.emplace_back(
      [&, rank]
      {
        dsm::Messenger messenger(std::move(transports[rank]));
        Fields mine;
        std::vector<bricks::SurveyedBricks> surveyed;
        for (const auto& field : fields)
        {
          const auto share = mine.emplace_back(std::make_shared<bricks::VoxelField>(*field));
          share->Segment = std::make_shared<ShareOfSegment>(
            field->Segment, field->Lattice.CreateDirectory(ranks), rank);
          surveyed.push_back({ share->Survey ? &*share->Survey : nullptr, share.get() });
        }
        found[rank] = bricks::FindFirstLook(surveyed, messenger).Isovalue;
        messenger.Barrier();
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  return found;
}

template <class T>
std::optional<double> Find(const TestVolume<T>& volume)
{
  MemoryStore store;
  return FindOnRanks({ CreateField(store, volume) }, 1).front();
}

/// From -1 to 1.
double GetCoordinate(int index)
{
  return 2.0 * index / (Points - 1) - 1.0;
}

float GetSquaredDistance(int x, int y, int z)
{
  return static_cast<float>(
    std::pow(GetCoordinate(x), 2) + std::pow(GetCoordinate(y), 2) + std::pow(GetCoordinate(z), 2));
}

/// As a scan: an object of about 120 in noise of 0 to 9, and a few grains of 255.
std::uint8_t GetScanned(int x, int y, int z)
{
  const auto noise = (x * 131 + y * 37 + z * 61) % 10;
  if (x % 16 == 8 && y % 16 == 8 && z % 16 == 8)
  {
    return 255;
  }
  return static_cast<std::uint8_t>(GetSquaredDistance(x, y, z) < 0.2f ? 115 + noise : noise);
}

} // namespace

TEST(TestFirstIsovalue, TheBorderDoesNotCutTheSphereOpen)
{
  const auto found = Find(TestVolume<float>(bricks::Index3(Points), GetSquaredDistance));
  ASSERT_TRUE(found);
  EXPECT_GT(*found, 0.5);
  EXPECT_LT(*found, 0.95);
}

TEST(TestFirstIsovalue, LiesBetweenNoiseAndObject)
{
  const auto found = Find(TestVolume<std::uint8_t>(bricks::Index3(Points), GetScanned));
  ASSERT_TRUE(found);
  EXPECT_GT(*found, 12.0);
  EXPECT_LT(*found, 110.0);
}

TEST(TestFirstIsovalue, IsTheSameOnEveryNumberOfRanks)
{
  MemoryStore store;
  const TestVolume<float> sphere(bricks::Index3(Points), GetSquaredDistance);
  const TestVolume<std::uint8_t> scan(bricks::Index3(Points, 23, 41), GetScanned);
  const Fields fields{ CreateField(store, sphere), CreateField(store, scan) };
  const std::optional<double> expected = FindOnRanks(fields, 1).front();
  ASSERT_TRUE(expected);
  for (const int ranks : { 2, 3, 4 })
  {
    for (const std::optional<double>& found : FindOnRanks(fields, ranks))
    {
      EXPECT_EQ(found, expected) << ranks << " ranks";
    }
  }
}

TEST(TestFirstIsovalue, BlankCellsDoNotCount)
{
  TestVolume<float> volume(bricks::Index3(Points), GetSquaredDistance);
  // Only a slab in the middle holds data, and values elsewhere would move everything.
  for (int z = 0; z < Points - 1; ++z)
  {
    for (int y = 0; y < Points - 1; ++y)
    {
      for (int x = 0; x < Points - 1; ++x)
      {
        if (z < 24 || z >= 40)
        {
          volume.Blank(x, y, z);
        }
      }
    }
  }
  for (int y = 0; y < Points; ++y)
  {
    for (int x = 0; x < Points; ++x)
    {
      volume.At(x, y, 0) = 1e6f;
    }
  }
  const auto found = Find(volume);
  ASSERT_TRUE(found);
  EXPECT_LT(*found, 2.0);
}

TEST(TestFirstIsovalue, ThereIsNoneWhereNoSurfaceIs)
{
  EXPECT_FALSE(Find(TestVolume<float>(bricks::Index3(Points), [](int, int, int) { return 3.0f; })));
  EXPECT_FALSE(Find(TestVolume<float>(bricks::Index3(Points), [](int, int, int) { return NAN; })));
  EXPECT_FALSE(FindOnRanks({}, 2).back());
}

/// A ball whose other half, beyond x = 40, is a fill value that nothing declares.
template <class T>
TestVolume<T> MakeFilled(double fill, double scale)
{
  return TestVolume<T>(bricks::Index3(Points),
    [=](int x, int y, int z)
    { return static_cast<T>(x > 40 ? fill : scale * GetSquaredDistance(x, y, z)); });
}

template <class T>
void ExpectFillDoesNotCount(double fill, double scale)
{
  MemoryStore store;
  const Fields fields{ CreateField(store, MakeFilled<T>(fill, scale)) };
  const auto found = FindOnRanks(fields, 1).front();
  ASSERT_TRUE(found) << fill;
  EXPECT_GT(*found, 0.3 * scale) << fill;
  EXPECT_LT(*found, 2.0 * scale) << fill;
  EXPECT_EQ(FindOnRanks(fields, 3).back(), found) << fill;
}

TEST(TestFirstIsovalue, FillsDoNotCount)
{
  for (const double fill : { 1e37, 9.96921e36, -3.4028235e38, 1e20, -9999.0, -32768.0 })
  {
    ExpectFillDoesNotCount<float>(fill, 1.0);
    ExpectFillDoesNotCount<double>(fill, 100.0);
  }
  ExpectFillDoesNotCount<double>(std::numeric_limits<double>::lowest(), 1.0);
  ExpectFillDoesNotCount<double>(std::numeric_limits<double>::max(), 1.0);
  ExpectFillDoesNotCount<std::int16_t>(-32768, 1000.0);
  ExpectFillDoesNotCount<std::int16_t>(-3024, 1000.0);
  ExpectFillDoesNotCount<std::int16_t>(-2000, 500.0);
}

TEST(TestFirstIsovalue, ValuesThatDoNotStandAloneCount)
{
  // A ball of one value in noise; and one that falls off without a gap.
  const auto inNoise = Find(TestVolume<float>(bricks::Index3(Points),
    [](int x, int y, int z)
    { return GetSquaredDistance(x, y, z) < 0.2f ? 4095.0f : static_cast<float>((x + y) % 7); }));
  ASSERT_TRUE(inNoise);
  EXPECT_GT(*inNoise, 100.0);
  const auto steep = Find(TestVolume<double>(bricks::Index3(Points),
    [](int x, int y, int z) { return std::pow(10.0, 20.0 - 30.0 * GetSquaredDistance(x, y, z)); }));
  ASSERT_TRUE(steep);
  EXPECT_GT(*steep, 1e16);
}
