// SPDX-License-Identifier: BSD-3-Clause
#include "RandomRays.h"
#include "SearchBench.h"
#include "TestVolume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

template <class T>
class TestIsosurfaceSearchSample : public testing::Test
{
};

using ScalarTypes = testing::Types<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t,
  std::int32_t, std::uint32_t, std::int64_t, std::uint64_t, float, double>;
TYPED_TEST_SUITE(TestIsosurfaceSearchSample, ScalarTypes);

TYPED_TEST(TestIsosurfaceSearchSample, IsTrilinearAcrossBricks)
{
  const TestVolume<TypeParam> volume(
    { 7, 8, 9 }, [](int x, int y, int z) { return static_cast<TypeParam>(x + 2 * y + x * y + z); });
  SearchBench bench;
  const auto field = CreateField(bench.Store, volume, 4);
  RandomRays generator(volume.GetCells(), 1);
  for (int i = 0; i < 500; ++i)
  {
    const glm::dvec3 p = i % 4 == 0 ? glm::round(generator.GetPoint()) : generator.GetPoint();
    ASSERT_NEAR(bench.Search.Sample(*field, p), p.x + 2 * p.y + p.x * p.y + p.z, 1e-12);
  }
}

TEST(TestIsosurfaceSearchSampleCases, NotANumberWithoutData)
{
  TestVolume<float> volume({ 5, 5, 5 }, [](int x, int, int) { return static_cast<float>(x); });
  volume.At(4, 4, 4) = std::numeric_limits<float>::quiet_NaN();
  volume.Blank(1, 1, 1);
  SearchBench bench;
  const auto field = CreateField(bench.Store, volume, 2);
  const auto sample = [&](double x, double y, double z) {
    return bench.Search.Sample(*field, { x, y, z });
  };
  EXPECT_TRUE(std::isnan(sample(1.5, 1.5, 1.5)));
  EXPECT_TRUE(std::isnan(sample(3.5, 3.5, 3.5)));
  EXPECT_TRUE(std::isnan(sample(-0.1, 2.0, 2.0)));
  EXPECT_TRUE(std::isnan(sample(2.0, 4.1, 2.0)));
  EXPECT_TRUE(std::isnan(sample(2.0, std::nan(""), 2.0)));
  EXPECT_EQ(sample(2.5, 1.5, 1.5), 2.5);
}

TEST(TestIsosurfaceSearchSampleCases, FacesOfCellsWithoutDataBelongToTheirNeighbours)
{
  TestVolume<float> volume({ 5, 5, 5 }, [](int x, int, int) { return static_cast<float>(x); });
  volume.Blank(1, 1, 1);
  volume.At(3, 3, 3) = std::numeric_limits<float>::quiet_NaN();
  SearchBench bench;
  const auto field = CreateField(bench.Store, volume, 2);
  EXPECT_EQ(bench.Search.Sample(*field, { 1.0, 1.5, 1.5 }), 1.0);
  EXPECT_EQ(bench.Search.Sample(*field, { 1.25, 1.0, 1.5 }), 1.25);
  EXPECT_EQ(bench.Search.Sample(*field, { 2.0, 1.5, 2.5 }), 2.0);
}
