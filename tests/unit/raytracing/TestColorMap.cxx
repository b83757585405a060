// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/scene/Scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{

/// The red channel is the number of the entry.
rt::ColorMap CreateMap(double first, double last, int entries)
{
  rt::ColorMap map;
  map.First = first;
  map.Last = last;
  for (int entry = 0; entry < entries; ++entry)
  {
    map.Table.push_back({ static_cast<float>(entry), 0.0f, 0.0f, 1.0f });
  }
  map.Below = { -1.0f, 0.0f, 0.0f, 1.0f };
  map.Above = { -2.0f, 0.0f, 0.0f, 1.0f };
  map.NotANumber = { -3.0f, 0.0f, 0.0f, 1.0f };
  return map;
}

} // namespace

TEST(TestColorMap, EntriesRunFromFirstToLast)
{
  const rt::ColorMap map = CreateMap(10.0, 20.0, 11);
  EXPECT_EQ(map.Map(10.0).x, 0.0f);
  EXPECT_EQ(map.Map(10.49).x, 0.0f);
  EXPECT_EQ(map.Map(10.51).x, 1.0f);
  EXPECT_EQ(map.Map(15.0).x, 5.0f);
  EXPECT_EQ(map.Map(20.0).x, 10.0f);
}

TEST(TestColorMap, OutsideOfTheRangeAndNaN)
{
  const rt::ColorMap map = CreateMap(10.0, 20.0, 11);
  EXPECT_EQ(map.Map(9.999).x, -1.0f);
  EXPECT_EQ(map.Map(-std::numeric_limits<double>::infinity()).x, -1.0f);
  EXPECT_EQ(map.Map(20.001).x, -2.0f);
  EXPECT_EQ(map.Map(std::numeric_limits<double>::infinity()).x, -2.0f);
  EXPECT_EQ(map.Map(std::nan("")).x, -3.0f);
}

TEST(TestColorMap, Logarithmic)
{
  rt::ColorMap map = CreateMap(1.0, 10000.0, 5);
  map.Logarithmic = true;
  EXPECT_EQ(map.Map(1.0).x, 0.0f);
  EXPECT_EQ(map.Map(3.0).x, 0.0f);
  EXPECT_EQ(map.Map(4.0).x, 1.0f);
  EXPECT_EQ(map.Map(100.0).x, 2.0f);
  EXPECT_EQ(map.Map(10000.0).x, 4.0f);
  EXPECT_EQ(map.Map(0.5).x, -1.0f);
  EXPECT_EQ(map.Map(-5.0).x, -1.0f);
}

TEST(TestColorMap, DegenerateRangesAndTables)
{
  EXPECT_EQ(CreateMap(5.0, 5.0, 4).Map(5.0).x, 0.0f);
  EXPECT_EQ(CreateMap(0.0, 1.0, 1).Map(0.7).x, 0.0f);
  EXPECT_EQ(CreateMap(0.0, 1.0, 0).Map(0.7).x, -3.0f);
}

TEST(TestColorMap, CategoriesHaveTheirOwnColorsAndNothingElseHasAny)
{
  rt::ColorMap map = CreateMap(0.0, 10.0, 11);
  map.Categories.emplace({ rt::ColorMap::Category{ 1.0, glm::vec4(21.0f, 0.0f, 0.0f, 1.0f) },
    { 3.0, glm::vec4(23.0f, 0.0f, 0.0f, 1.0f) }, { 70.0, glm::vec4(25.0f, 0.0f, 0.0f, 1.0f) } });
  EXPECT_EQ(map.Map(1.0).x, 21.0f);
  EXPECT_EQ(map.Map(3.0).x, 23.0f);
  EXPECT_EQ(map.Map(70.0).x, 25.0f) << "the range does not count";
  for (const double value : { -1.0, 2.0, std::nextafter(3.0, 4.0), 11.0, 71.0, std::nan("") })
  {
    EXPECT_EQ(map.Map(value).x, -3.0f) << value;
  }
  EXPECT_TRUE(map.IsOpaque());
  map.Categories->back().Color.w = 0.5f;
  EXPECT_FALSE(map.IsOpaque());
  map.Categories->clear();
  EXPECT_EQ(map.Map(1.0).x, -3.0f);
}

TEST(TestColorMap, WhatIsNarrowerThanAnEntryHasNodes)
{
  // A peak of opacity of width 4 in 65,536, and a step of color.
  const auto color = [](double value)
  {
    const double opacity = std::max(0.0, 1.0 - std::abs(value - 30002.0) / 2.0);
    return glm::vec4(value < 30001.0 ? 1.0f : 0.0f, 0.0f, 0.0f, opacity);
  };
  rt::ColorMap map;
  map.Last = 65536.0;
  map.Sample(4096, color, { 30000.0, 30001.0, 30002.0, 30004.0 });
  for (const double value : { 30000.0, 30000.5, 30000.99, 30001.0, 30002.0, 30003.9, 30004.1 })
  {
    EXPECT_NEAR(map.Map(value).x, color(value).x, 1e-3) << value;
    EXPECT_NEAR(map.Map(value).w, color(value).w, 1e-3) << value;
  }
  EXPECT_LT(map.Nodes.size(), 20u) << "all other entries have one color";
  EXPECT_GT(map.FindUnseenEnd(false), 29960.0);
  EXPECT_LT(map.FindUnseenEnd(false), 30000.0);
  EXPECT_LT(map.FindUnseenEnd(true), 30040.0);
}

TEST(TestColorMap, LowDecadesOfALinearTableHaveNodes)
{
  const auto color = [](double value)
  { return glm::vec4(std::log10(std::max(value, 1e-6)) / 12.0 + 0.5, 0.0, 0.0, 1.0); };
  rt::ColorMap map;
  map.First = -5.0;
  map.Last = 1e6;
  map.Sample(4096, color, { 1e-6, 1e6 });
  for (double value = 1e-6; value < 1e6; value *= 3.0)
  {
    EXPECT_NEAR(map.Map(value).x, color(value).x, 4e-3) << value;
  }
  EXPECT_EQ(map.Map(-1.0).x, 0.0f);
}
