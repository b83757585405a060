// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/field/grid/TrilinearIsosurface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace
{

struct Way
{
  double Corners[8];
  rt::Lanes Start{ 0.0 };
  rt::Lanes End{ 0.0 };

  double Evaluate(double s) const
  {
    return rt::EvaluateTrilinear(
      this->Corners, rt::Lanes(1.0 - s) * this->Start + rt::Lanes(s) * this->End);
  }
};

Way CreateWay(std::mt19937& random, bool coarse)
{
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  std::uniform_real_distribution<double> place(0.0, 1.0);
  std::uniform_int_distribution<int> step(-1, 1);
  Way way;
  for (double& corner : way.Corners)
  {
    corner = coarse ? step(random) : value(random);
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    way.Start.Set(axis, place(random));
    way.End.Set(axis, place(random));
  }
  const int entry = static_cast<int>(random() % 3);
  const int exit = static_cast<int>(random() % 3);
  way.Start.Set(entry, random() % 2);
  way.End.Set(exit, exit == entry ? 1.0 - way.Start[entry] : double(random() % 2));
  return way;
}

} // namespace

TEST(TestTrilinearIsosurface, FindsTheFirstOfAllCrossings)
{
  std::mt19937 random(1);
  int found = 0;
  int pairs = 0;
  for (int i = 0; i < 20000; ++i)
  {
    const Way way = CreateWay(random, false);
    constexpr int steps = 512;
    double expected = -1.0;
    const bool begin = way.Evaluate(0.0) >= 0.0;
    for (int step = 1; step <= steps && expected < 0.0; ++step)
    {
      if ((way.Evaluate(double(step) / steps) >= 0.0) != begin)
      {
        expected = double(step) / steps;
      }
    }
    double s = -1.0;
    const bool hit = rt::FindFirstCrossing(way.Corners, way.Start, way.End, s);
    if (expected >= 0.0)
    {
      ASSERT_TRUE(hit);
      // Two crossings within one step of the scan may come before.
      ASSERT_LE(s, expected + 1e-12);
      pairs += begin == (way.Evaluate(1.0) >= 0.0);
    }
    if (hit)
    {
      ASSERT_GE(s, 0.0);
      ASSERT_LE(s, 1.0);
      ASSERT_NEAR(way.Evaluate(s), 0.0, 1e-12);
      ++found;
    }
  }
  EXPECT_GT(found, 5000);
  EXPECT_GT(pairs, 200);
}

TEST(TestTrilinearIsosurface, DifferentEndsAlwaysCross)
{
  std::mt19937 random(2);
  for (int i = 0; i < 50000; ++i)
  {
    const Way way = CreateWay(random, i % 2 == 0);
    const bool begin = rt::EvaluateTrilinear(way.Corners, way.Start) >= 0.0;
    const bool end = rt::EvaluateTrilinear(way.Corners, way.End) >= 0.0;
    double s = -1.0;
    if (begin != end)
    {
      ASSERT_TRUE(rt::FindFirstCrossing(way.Corners, way.Start, way.End, s));
      ASSERT_GE(s, 0.0);
      ASSERT_LE(s, 1.0);
      // On the two sides of the place the values are on different sides, up to rounding.
      const double before = way.Evaluate(std::max(0.0, s - 2e-9));
      const double after = way.Evaluate(std::min(1.0, s + 2e-9));
      ASSERT_LE(begin ? -before : before, 1e-15);
      ASSERT_LE(begin ? after : -after, 1e-15);
    }
  }
}

TEST(TestTrilinearIsosurface, TouchingZeroAtTheStartIsNotTheCrossing)
{
  // Along x: 0 at the start, up, and down to -1: the values are on the inside up to the crossing.
  const double corners[8] = { 0.0, 4.0, 4.0, -1.0, 0.0, 4.0, 4.0, -1.0 };
  const rt::Lanes start(0.0, 0.0, 0.5, 0.0);
  const rt::Lanes end(1.0, 1.0, 0.5, 0.0);
  double s = -1.0;
  ASSERT_TRUE(rt::FindFirstCrossing(corners, start, end, s));
  EXPECT_NEAR(s, 8.0 / 9.0, 1e-12);
}

TEST(TestTrilinearIsosurface, TheUnitOfTheValuesDoesNotMatter)
{
  std::mt19937 random(5);
  int pairs = 0;
  for (int i = 0; i < 20000; ++i)
  {
    const Way way = CreateWay(random, i % 2 == 0);
    double expected = -1.0;
    const bool hit = rt::FindFirstCrossing(way.Corners, way.Start, way.End, expected);
    pairs += hit && (way.Evaluate(0.0) >= 0.0) == (way.Evaluate(1.0) >= 0.0);
    for (const double unit : { 0x1p-900, 0x1p-600, 0x1p600, 0x1p1010 })
    {
      Way other = way;
      for (double& corner : other.Corners)
      {
        corner *= unit;
      }
      double s = -1.0;
      ASSERT_EQ(rt::FindFirstCrossing(other.Corners, other.Start, other.End, s), hit) << unit;
      ASSERT_EQ(rt::HasCrossing(other.Corners, other.Start, other.End), hit) << unit;
      ASSERT_EQ(s, expected) << unit;
    }
  }
  EXPECT_GT(pairs, 200);
}

TEST(TestTrilinearCell, FaceValuesAreTheSameFromBothCells)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> value(-1e3, 1e3);
  std::uniform_real_distribution<double> place(0.0, 1.0);
  for (int i = 0; i < 1000; ++i)
  {
    const int axis = i % 3;
    double left[8];
    double right[8];
    for (int corner = 0; corner < 8; ++corner)
    {
      left[corner] = value(random);
      right[corner] = value(random);
    }
    for (int corner = 0; corner < 8; ++corner)
    {
      if ((corner >> axis & 1) != 0)
      {
        right[corner ^ (1 << axis)] = left[corner];
      }
    }
    rt::Lanes point(place(random), place(random), place(random), 0.0);
    point.Set(axis, 1.0);
    const double fromLeft = rt::EvaluateTrilinear(left, point);
    point.Set(axis, 0.0);
    ASSERT_EQ(fromLeft, rt::EvaluateTrilinear(right, point));
  }
}

TEST(TestTrilinearCell, CubicIsTheFunctionAlongTheLine)
{
  std::mt19937 random(4);
  for (int i = 0; i < 1000; ++i)
  {
    const Way way = CreateWay(random, false);
    const rt::Cubic cubic = rt::GetCubic(way.Corners, way.Start, way.End - way.Start);
    ASSERT_EQ(cubic.Evaluate(0.0), rt::EvaluateTrilinear(way.Corners, way.Start));
    for (const double s : { 0.1, 0.5, 0.9, 1.0 })
    {
      ASSERT_NEAR(cubic.Evaluate(s), way.Evaluate(s), 1e-13);
      ASSERT_NEAR(cubic.EvaluateDerivative(s),
        (way.Evaluate(s + 1e-6) - way.Evaluate(s - 1e-6)) / 2e-6, 1e-6);
    }
  }
}
