// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/field/lattice/MacrocellKernel.h"
#include "DSMRayTracing/field/lattice/PacketKernel.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace
{

template <class T>
class MacrocellComparisonTest : public testing::Test
{
public:
  /// Few different values, those of the type's ends among them, so that many are equal to the level.
  static T GetSample(std::mt19937& random)
  {
    const T some[] = { std::numeric_limits<T>::lowest(), T(1), T(2), T(3),
      std::numeric_limits<T>::max(), GetLast() };
    return some[random() % 6];
  }

private:
  static T GetLast()
  {
    return std::numeric_limits<T>::has_quiet_NaN ? std::numeric_limits<T>::quiet_NaN() : T(100);
  }
};

using SampleTypes = testing::Types<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t,
  std::int32_t, std::uint32_t, std::int64_t, std::uint64_t, float, double>;
TYPED_TEST_SUITE(MacrocellComparisonTest, SampleTypes);

TYPED_TEST(MacrocellComparisonTest, CellsWithCornersOnBothSidesAreFound)
{
  using T = TypeParam;
  constexpr int row = 13;
  constexpr int slice = 7 * row;
  std::mt19937 random(7);
  int found = 0;
  for (int round = 0; round < 40; ++round)
  {
    // Ends with the last macrocell: nothing beyond it may be read.
    std::vector<T> samples(5 * slice);
    for (T& sample : samples)
    {
      sample = round % 2 == 0 || random() % 20 == 0 ? this->GetSample(random) : T(2);
    }
    const T level = round % 4 < 2 ? T(2) : T(3);
    for (const int x : { 0, 3, row - 5 })
    {
      const T* const begin = samples.data() + 2 * row;
      std::uint64_t expected = 0;
      for (int cell = 0; cell < 64; ++cell)
      {
        bool any = false;
        bool all = true;
        for (int corner = 0; corner < 8; ++corner)
        {
          const bool inside =
            begin[x + cell % 4 + corner % 2 + (cell / 4 % 4 + corner / 2 % 2) * row +
              (cell / 16 + corner / 4) * slice] >= level;
          any = any || inside;
          all = all && inside;
        }
        expected |= std::uint64_t{ any && !all } << cell;
      }
      found += expected != 0;
      for (const rt::PacketKernel& kernel : rt::PacketKernel::GetAll())
      {
        EXPECT_EQ(kernel.Macrocells.Get<T>().FindCells(begin, x, row, slice, level), expected)
          << kernel.Name << ", from " << x << ", round " << round;
      }
    }
  }
  EXPECT_GT(found, 60);
}

TYPED_TEST(MacrocellComparisonTest, MacrocellsWithSamplesOnBothSidesAreFound)
{
  using T = TypeParam;
  constexpr int row = 5;
  constexpr int slice = 4 * row;
  std::mt19937 random(3);
  int found = 0;
  for (int round = 0; round < 40; ++round)
  {
    std::vector<bricks::MacrocellRange<T>> ranges(3 * slice + 3 * row + 4);
    for (bricks::MacrocellRange<T>& range : ranges)
    {
      range = { this->GetSample(random), this->GetSample(random) };
    }
    const T level = T(2);
    std::uint64_t expected = 0;
    for (int number = 0; number < 64; ++number)
    {
      const auto& range = ranges[number % 4 + number / 4 % 4 * row + number / 16 * slice];
      expected |= std::uint64_t{ range.Min < level && range.Max >= level } << number;
    }
    found += expected != 0;
    for (const rt::PacketKernel& kernel : rt::PacketKernel::GetAll())
    {
      EXPECT_EQ(
        kernel.Macrocells.Get<T>().FindMacrocells(ranges.data(), row, slice, level), expected)
        << kernel.Name << ", round " << round;
    }
  }
  EXPECT_EQ(found, 40);
}

} // namespace
