// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/layout/IsovalueSurvey.h"
#include "TestVolume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace
{

/// Values of very different size here and there, so that intervals have to become wider.
template <class T>
TestVolume<T> MakeVolume(double offset, double size)
{
  return TestVolume<T>(bricks::Index3(33, 21, 17),
    [=](int x, int y, int z)
    {
      return static_cast<T>(
        offset + size * std::pow(10.0, -0.5 * (x / 4)) * std::sin(0.9 * y + 0.4 * z + 0.1 * x));
    });
}

/// Counted in an order, and in so many parts, which are added.
template <class T>
bricks::IsovalueSurvey Count(const bricks::VoxelField& field, std::uint32_t seed, std::size_t parts)
{
  std::vector<dsm::BlockId> order(field.Lattice.GetBrickCount());
  std::iota(order.begin(), order.end(), dsm::BlockId(0));
  std::shuffle(order.begin(), order.end(), std::mt19937(seed));
  std::vector<const std::byte*> blocks(order.size());
  field.Segment->ForEachResident(
    [&](dsm::BlockId id, const std::byte* block, std::size_t) { blocks[id] = block; });
  std::vector<bricks::IsovalueSurvey> surveys(parts);
  for (std::size_t at = 0; at < order.size(); ++at)
  {
    surveys[at % parts].CountBrick(field.Lattice, order[at], blocks[order[at]]);
  }
  bricks::IsovalueSurvey sum;
  for (const bricks::IsovalueSurvey& survey : surveys)
  {
    sum.Add(survey);
  }
  return sum;
}

template <class T>
void ExpectNoOrder(double offset, double size)
{
  MemoryStore store;
  const TestVolume<T> volume = MakeVolume<T>(offset, size);
  const auto field = CreateField(store, volume, 4);
  const bricks::IsovalueSurvey expected = Count<T>(*field, 0, 1);
  EXPECT_EQ(expected.All, static_cast<std::int64_t>(field->Lattice.GetBrickCount()));
  EXPECT_TRUE(expected.IsValid(expected.All));
  EXPECT_FALSE(expected.IsValid(expected.All - 1));
  EXPECT_GE(expected.CountIntervals(), bricks::IsovalueSurvey::Intervals / 2u);
  EXPECT_LE(expected.CountIntervals(), bricks::IsovalueSurvey::Intervals * 1u);
  EXPECT_EQ(std::accumulate(expected.Values.begin(), expected.Values.end(), std::int64_t(0)),
    4 * expected.All);
  const auto [least, greatest] = std::minmax_element(volume.Samples.begin(), volume.Samples.end());
  EXPECT_LE(expected.GetBorder(-1), static_cast<double>(*least));
  EXPECT_GT(expected.GetBorder(0), static_cast<double>(*least));
  EXPECT_GT(expected.GetBorder(static_cast<double>(expected.CountIntervals()) - 1),
    static_cast<double>(*greatest));
  for (std::uint32_t seed = 1; seed < 6; ++seed)
  {
    const bricks::IsovalueSurvey found = Count<T>(*field, seed, seed);
    EXPECT_EQ(std::memcmp(&found, &expected, sizeof(found)), 0) << offset << " " << size;
  }
}

} // namespace

TEST(TestIsovalueSurvey, DoesNotDependOnTheOrder)
{
  ExpectNoOrder<float>(0.0, 1.0);
  ExpectNoOrder<float>(-1e30, 3e35);
  ExpectNoOrder<float>(12345.0, 0.7);
  ExpectNoOrder<double>(1e15, 2e5);
  ExpectNoOrder<double>(-0.5, 1.6e308);
  ExpectNoOrder<double>(0.0, 1e-280);
  ExpectNoOrder<std::int16_t>(-300.0, 2000.0);
  ExpectNoOrder<std::uint8_t>(100.0, 99.0);
}

TEST(TestIsovalueSurvey, ValuesThatAreAllTheSameAreInOneInterval)
{
  MemoryStore store;
  for (const float value : { 0.0f, -3.5f, 1e38f, 1e-40f })
  {
    const TestVolume<float> volume(bricks::Index3(9), [=](int, int, int) { return value; });
    const bricks::IsovalueSurvey survey = Count<float>(*CreateField(store, volume, 4), 0, 2);
    EXPECT_EQ(survey.CountIntervals(), 1u);
    EXPECT_EQ(survey.Values[0], 4 * survey.All);
    EXPECT_TRUE(survey.IsValid(survey.All));
  }
  EXPECT_EQ(bricks::IsovalueSurvey().CountIntervals(), 0u);
}

/// A file can have any bytes in their place.
TEST(TestIsovalueSurvey, WhatNobodyCountedIsNotValid)
{
  using Survey = bricks::IsovalueSurvey;
  EXPECT_TRUE(Survey().IsValid(0));
  MemoryStore store;
  const Survey valid = Count<float>(*CreateField(store, MakeVolume<float>(0.0, 1.0), 4), 0, 1);
  const std::int64_t most = valid.All;
  ASSERT_TRUE(valid.IsValid(most));
  const auto last = static_cast<std::size_t>(valid.CountIntervals());
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr std::int64_t large = std::numeric_limits<std::int64_t>::max();
  constexpr std::int64_t small = std::numeric_limits<std::int64_t>::min();
  const std::vector<std::function<void(Survey&)>> damages = {
    [](Survey& survey) { std::memset(static_cast<void*>(&survey), 0xff, sizeof(survey)); },
    [](Survey& survey) { std::memset(static_cast<void*>(&survey), 0x41, sizeof(survey)); },
    [](Survey& survey) { survey.All = 0; },
    [](Survey& survey) { survey.All = -1; },
    [](Survey& survey) { survey.All = large; },
    [](Survey& survey) { survey.AtBorder = survey.All + 1; },
    [](Survey& survey) { survey.AtBorder = -1; },
    [](Survey& survey) { ++survey.First; },
    [](Survey& survey) { survey.First = small; },
    [](Survey& survey) { --survey.Exponent; },
    [](Survey& survey) { survey.Exponent = large; },
    [](Survey& survey) { survey.Exponent = small; },
    [](Survey& survey) { survey.Least = nan; },
    [](Survey& survey) { survey.Greatest = nan; },
    [](Survey& survey) { survey.Least = -infinity; },
    [](Survey& survey) { survey.Greatest = infinity; },
    [](Survey& survey) { std::swap(survey.Least, survey.Greatest); },
    [](Survey& survey) { survey.Greatest *= 4.0; },
    [](Survey& survey) { ++survey.Values[0]; },
    [](Survey& survey)
    {
      --survey.Values[0];
      ++survey.Values[1];
      survey.Values[1] -= 2 * survey.Values[1];
    },
    [](Survey& survey) { survey.Values[0] = large; },
    [](Survey& survey) { survey.Values[0] = small; },
    [](Survey& survey) { survey.Crossed[0] = -1; },
    [](Survey& survey) { survey.Crossed[1] = large; },
    [](Survey& survey) { survey.Crossed[1] = small; },
    [](Survey& survey) { survey.CutOpen[0] += 1; },
    [=](Survey& survey) { survey.CutOpen[last - 1] = large; },
  };
  for (std::size_t damage = 0; damage < damages.size(); ++damage)
  {
    Survey survey = valid;
    damages[damage](survey);
    EXPECT_FALSE(survey.IsValid(most)) << damage;
  }
  Survey empty;
  empty.Least = empty.Greatest = 0.0;
  EXPECT_FALSE(empty.IsValid(most));
}

/// A count in an interval outside of the range.
TEST(TestIsovalueSurvey, NothingIsWrittenOutsideWhateverIsAdded)
{
  bricks::IsovalueSurvey one;
  one.All = 1;
  one.Least = 0.0;
  one.Greatest = 256.0;
  one.Values = {};
  one.Values[0] = 4;
  one.Values[511] = 0x4141414141;
  EXPECT_FALSE(one.IsValid(1));
  bricks::IsovalueSurvey other;
  other.All = 1;
  other.Least = -255.0;
  other.Greatest = 256.0;
  other.First = -255;
  other.Values[0] = 4;
  bricks::IsovalueSurvey all;
  all.Add(one);
  all.Add(other);
  EXPECT_EQ(std::accumulate(all.Values.begin(), all.Values.end(), std::int64_t(0)), 8);
}
