// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/look/PackedColor.h"
#include "RandomRays.h"
#include "SearchBench.h"
#include "TestVolume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

template <class T>
class TestLatticeSampler : public testing::Test
{
};

using ScalarTypes = testing::Types<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t,
  std::int32_t, std::uint32_t, std::int64_t, std::uint64_t, float, double>;
TYPED_TEST_SUITE(TestLatticeSampler, ScalarTypes);

TYPED_TEST(TestLatticeSampler, IsTrilinearAcrossBricks)
{
  const TestVolume<TypeParam> volume(
    { 7, 8, 9 }, [](int x, int y, int z) { return static_cast<TypeParam>(x + 2 * y + x * y + z); });
  SearchBench bench;
  const auto field = CreateField(bench.Store, volume, 4);
  RandomRays generator(volume.GetCells(), 1);
  for (int i = 0; i < 500; ++i)
  {
    const glm::dvec3 p = i % 4 == 0 ? glm::round(generator.GetPoint()) : generator.GetPoint();
    ASSERT_NEAR(bench.Sample(*field, p), p.x + 2 * p.y + p.x * p.y + p.z, 1e-12);
  }
}

TEST(TestLatticeSamplerCases, NotANumberWithoutData)
{
  TestVolume<float> volume({ 5, 5, 5 }, [](int x, int, int) { return static_cast<float>(x); });
  volume.At(4, 4, 4) = std::numeric_limits<float>::quiet_NaN();
  volume.Blank(1, 1, 1);
  SearchBench bench;
  const auto field = CreateField(bench.Store, volume, 2);
  const auto sample = [&](double x, double y, double z) {
    return bench.Sample(*field, { x, y, z });
  };
  EXPECT_TRUE(std::isnan(sample(1.5, 1.5, 1.5)));
  EXPECT_TRUE(std::isnan(sample(3.5, 3.5, 3.5)));
  EXPECT_TRUE(std::isnan(sample(-0.1, 2.0, 2.0)));
  EXPECT_TRUE(std::isnan(sample(2.0, 4.1, 2.0)));
  EXPECT_TRUE(std::isnan(sample(2.0, std::nan(""), 2.0)));
  EXPECT_EQ(sample(2.5, 1.5, 1.5), 2.5);
}

TEST(TestLatticeSamplerCases, FacesOfCellsWithoutDataBelongToTheirNeighbours)
{
  TestVolume<float> volume({ 5, 5, 5 }, [](int x, int, int) { return static_cast<float>(x); });
  volume.Blank(1, 1, 1);
  volume.At(3, 3, 3) = std::numeric_limits<float>::quiet_NaN();
  SearchBench bench;
  const auto field = CreateField(bench.Store, volume, 2);
  EXPECT_EQ(bench.Sample(*field, { 1.0, 1.5, 1.5 }), 1.0);
  EXPECT_EQ(bench.Sample(*field, { 1.25, 1.0, 1.5 }), 1.25);
  EXPECT_EQ(bench.Sample(*field, { 2.0, 1.5, 2.5 }), 2.0);
}

TEST(TestLatticeSamplerCases, CellsHaveTheirOwnValuesAndNoneIsOfAnother)
{
  TestVolume<float> volume(
    { 6, 5, 4 }, [](int x, int y, int z) { return static_cast<float>(x + 10 * y + 100 * z); });
  volume.Blank(1, 2, 1);
  SearchBench bench;
  const auto field = CreateField(bench.Store, volume, 2);
  field->Lattice = field->Lattice.OfCells();
  field->Segment = PublishPieces(bench.Store, field->Lattice, GetWhole(volume));
  const auto find = [&](const glm::ivec3& cell, const glm::dvec3& inside = glm::dvec3(0.5))
  {
    const rt::LatticePlace place{ glm::dvec3(cell) + inside, cell, {} };
    double value;
    const bool isThere = bench.Sampler.FindValues(*field, &place, 1, &value) != 0;
    EXPECT_EQ(isThere, !std::isnan(value));
    return value;
  };
  for (int z = 0; z < 3; ++z)
  {
    for (int y = 0; y < 4; ++y)
    {
      for (int x = 0; x < 5; ++x)
      {
        const double value = find({ x, y, z });
        const bool blank = x == 1 && y == 2 && z == 1;
        EXPECT_TRUE(blank ? std::isnan(value) : value == x + 10 * y + 100 * z);
      }
    }
  }
  // A face of the blank cell is another one's, too.
  EXPECT_EQ(find({ 1, 2, 1 }, { 0.5, 0.0, 0.5 }), 1 + 10 + 100);
}

TEST(TestLatticeSamplerCases, ColorsAreInterpolatedChannelByChannel)
{
  const std::uint8_t red[4] = { 255, 0, 51, 255 };
  const std::uint8_t green[4] = { 0, 255, 51, 0 };
  const TestVolume<std::uint32_t> volume(
    { 3, 2, 2 }, [&](int x, int, int) { return rt::PackedColor::Make(x == 0 ? red : green); });
  SearchBench bench;
  const auto field = CreateField(bench.Store, volume, 2);
  glm::vec4 color;
  const rt::LatticePlace between{ { 0.25, 0.5, 0.5 }, {}, {} };
  ASSERT_EQ(bench.Sampler.FindColors(*field, &between, 1, &color), 1u);
  EXPECT_NEAR(color.x, 0.75, 1e-6);
  EXPECT_NEAR(color.y, 0.25, 1e-6);
  EXPECT_NEAR(color.z, 0.2, 1e-6);
  EXPECT_NEAR(color.w, 0.75, 1e-6);
  field->Lattice = field->Lattice.OfCells();
  const rt::LatticePlace second{ glm::dvec3(0.0), { 1, 0, 0 }, {} };
  ASSERT_EQ(bench.Sampler.FindColors(*field, &second, 1, &color), 1u);
  EXPECT_EQ(color, glm::vec4(0.0f, 1.0f, 0.2f, 0.0f));
}

TEST(TestLatticeSamplerCases, TheNearestSampleIsNotInterpolated)
{
  TestVolume<std::int16_t> volume({ 6, 5, 4 },
    [](int x, int y, int z) { return static_cast<std::int16_t>(x + 10 * y + 100 * z); });
  volume.Blank(4, 3, 2);
  SearchBench bench;
  const auto field = CreateField(bench.Store, volume, 2);
  const auto find = [&](double x, double y, double z)
  {
    const rt::LatticePlace place{ { x, y, z }, {}, {} };
    double value;
    bench.Sampler.FindNearestValues(*field, &place, 1, &value);
    return value;
  };
  EXPECT_EQ(find(0.0, 0.0, 0.0), 0.0);
  EXPECT_EQ(find(1.49, 2.51, 0.7), 131.0);
  EXPECT_EQ(find(2.5, 1.5, 1.5), 223.0) << "in the middle, the later one";
  EXPECT_EQ(find(2.0, 3.6, 1.2), 142.0) << "on a face between bricks";
  EXPECT_EQ(find(5.0, 1.2, 3.0), 315.0) << "the last samples";
  EXPECT_TRUE(std::isnan(find(4.2, 3.2, 2.2)));
  EXPECT_TRUE(std::isnan(find(5.1, 1.0, 1.0)));
}
