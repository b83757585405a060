// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/field/grid/IsovalueLevel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace
{

template <class T>
void ExpectConsistent(double isovalue)
{
  const rt::IsovalueLevel<T> level(isovalue);
  using Limits = std::numeric_limits<T>;
  std::vector<T> samples{ Limits::lowest(), Limits::max(), T(0), T(1), T(-1), T(100) };
  if (level.IsReachable())
  {
    const T first = level.GetFirst();
    samples.push_back(first);
    if constexpr (std::is_integral_v<T>)
    {
      samples.push_back(static_cast<T>(first - (first > Limits::lowest())));
      samples.push_back(static_cast<T>(first + (first < Limits::max())));
    }
    else
    {
      samples.push_back(std::nextafter(first, Limits::lowest()));
      samples.push_back(std::nextafter(first, Limits::max()));
    }
  }
  for (const T sample : samples)
  {
    const bool inside = static_cast<long double>(sample) >= static_cast<long double>(isovalue);
    EXPECT_EQ(level.IsReachable() && level.IsInside(sample), inside) << +sample << " " << isovalue;
    if (level.IsReachable() && isovalue >= static_cast<double>(Limits::lowest()))
    {
      EXPECT_EQ(level.Subtract(sample) >= 0.0, inside) << +sample << " " << isovalue;
    }
  }
}

} // namespace

template <class T>
class TestIsovalueLevel : public testing::Test
{
};

using ScalarTypes = testing::Types<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t,
  std::int32_t, std::uint32_t, std::int64_t, std::uint64_t, float, double>;
TYPED_TEST_SUITE(TestIsovalueLevel, ScalarTypes);

TYPED_TEST(TestIsovalueLevel, InsideMeansNotBelow)
{
  for (const double isovalue :
    { 0.0, -0.0, 1.0, 0.5, -0.5, 100.0, 1e-300, -1e-300, 0.1, 127.0, 127.5, 128.0, 255.0, 255.5,
      -128.0, -128.5, 1e9, 4294967295.0, 4294967295.5, 1e18, 9223372036854775808.0,
      18446744073709551616.0, -9223372036854775808.0, -1e19, 1e38, 3.5e38, -3.5e38, 1e300, -1e300 })
  {
    ExpectConsistent<TypeParam>(isovalue);
  }
}

TEST(TestIsovalueLevel64, DifferencesKeepAllBits)
{
  constexpr std::int64_t base = std::int64_t(1) << 60;
  const rt::IsovalueLevel<std::int64_t> level(static_cast<double>(base));
  EXPECT_EQ(level.Subtract(base + 1), 1.0);
  EXPECT_EQ(level.Subtract(base - 3), -3.0);
  EXPECT_EQ(rt::IsovalueLevel<std::int64_t>(-0.25).Subtract(5), 5.25);
  const rt::IsovalueLevel<std::uint64_t> high(18446744073709549568.0);
  EXPECT_EQ(high.Subtract(18446744073709549569u), 1.0);
  EXPECT_EQ(high.Subtract(18446744073709549567u), -1.0);
}

TEST(TestIsovalueLevel64, SeparatesOnlyWhereBothSidesAre)
{
  const rt::IsovalueLevel<int> level(3.0);
  EXPECT_TRUE(level.Separates(2, 3));
  EXPECT_FALSE(level.Separates(3, 9));
  EXPECT_FALSE(level.Separates(1, 2));
  EXPECT_FALSE(
    level.Separates(std::numeric_limits<int>::max(), std::numeric_limits<int>::lowest()));
  EXPECT_FALSE(rt::IsovalueLevel<unsigned char>(256.0).Separates(0, 255));
}
