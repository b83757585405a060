// SPDX-License-Identifier: BSD-3-Clause
// The parts of rays in a clip region against asking every point.
#include "DSMRayTracing/ray/ClipRegion.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace
{

bool IsKept(const rt::ClipRegion& region, const glm::dvec3& p)
{
  for (const rt::ClipRegion::HalfSpace& half : region.HalfSpaces)
  {
    if (glm::dot(half.Normal, p - half.Point) < 0.0)
    {
      return false;
    }
  }
  if (!region.Boxes)
  {
    return true;
  }
  const glm::dvec3 place = region.Boxes->WorldToGrid * glm::dvec4(p, 1.0);
  int box = 0;
  for (int axis = 2; axis >= 0; --axis)
  {
    box = 3 * box + (place[axis] > region.Boxes->Lower[axis]) +
      (place[axis] > region.Boxes->Upper[axis]);
  }
  return (region.Boxes->Kept >> box & 1u) != 0;
}

rt::Ray CreateBoundedRay(const glm::dvec3& origin, const glm::dvec3& direction, double last)
{
  rt::Ray ray;
  ray.Origin = origin;
  ray.Direction = direction;
  ray.Max = last;
  return ray;
}

} // namespace

TEST(ClipRegion, PartsAreWhereThePointsAreKept)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  const auto point = [&] { return glm::dvec3(place(random), place(random), place(random)); };
  constexpr int steps = 500;
  int largest = 0;
  int kept = 0;
  for (int trial = 0; trial < 2000; ++trial)
  {
    rt::ClipRegion region;
    for (int number = trial % 3; number > 0; --number)
    {
      region.HalfSpaces.push_back({ point(), 0.5 * point() });
    }
    if (trial % 4 != 0)
    {
      rt::ClipRegion::Grid boxes;
      boxes.WorldToGrid = glm::rotate(glm::dmat4(1.0), place(random), point());
      boxes.Lower = -0.4 * glm::abs(point());
      boxes.Upper = 0.4 * glm::abs(point());
      boxes.Kept = random() & 0x7ffffffu;
      region.Boxes = boxes;
    }
    const rt::Ray ray = CreateBoundedRay(2.0 * point(), 2.0 * point(), 2.0);
    rt::ClipRegion::Interval parts[rt::ClipRegion::MaxParts];
    const int count = region.FindParts(ray, parts);
    largest = std::max(largest, count);
    for (int step = 0; step < steps; ++step)
    {
      const double t = 2.0 * (step + 0.5) / steps;
      bool inside = false;
      for (int number = 0; number < count; ++number)
      {
        inside = inside || (t >= parts[number].First && t <= parts[number].Last);
        EXPECT_LE(parts[number].First, parts[number].Last);
        EXPECT_TRUE(number == 0 || parts[number].First > parts[number - 1].First);
      }
      kept += inside;
      ASSERT_EQ(inside, IsKept(region, ray.Origin + t * ray.Direction)) << trial << ", " << t;
    }
  }
  EXPECT_GE(largest, 3);
  EXPECT_GT(kept, 2000 * steps / 10);
}

TEST(ClipRegion, ARayAlongTheBorderIsKept)
{
  rt::ClipRegion region;
  region.HalfSpaces = { { { 0.0, 2.0, 0.0 }, { 5.0, 1.0, 7.0 } } };
  rt::ClipRegion::Interval parts[rt::ClipRegion::MaxParts];
  EXPECT_EQ(region.FindParts(CreateBoundedRay({ 0, 1, 0 }, { 1, 0, 0 }, 1.0), parts), 1);
  EXPECT_EQ(parts[0].First, 0.0);
  EXPECT_EQ(parts[0].Last, 1.0);
  EXPECT_EQ(region.FindParts(CreateBoundedRay({ 0, 0.5, 0 }, { 1, 0, 0 }, 1.0), parts), 0);
}

TEST(ClipRegion, RaysWithoutAnEnd)
{
  rt::ClipRegion region;
  region.Boxes.emplace();
  region.Boxes->Upper = glm::dvec3(1.0);
  region.Boxes->Kept = 1u << 13;
  const double infinity = std::numeric_limits<double>::infinity();
  const rt::Ray ray = CreateBoundedRay({ -1.0, 0.5, 0.5 }, { 1.0, 0.0, 0.0 }, infinity);
  rt::ClipRegion::Interval parts[rt::ClipRegion::MaxParts];
  ASSERT_EQ(region.FindParts(ray, parts), 1);
  EXPECT_NEAR(parts[0].First, 1.0, 1e-11);
  EXPECT_NEAR(parts[0].Last, 2.0, 1e-11);
  region.Boxes->Kept = ~region.Boxes->Kept;
  ASSERT_EQ(region.FindParts(ray, parts), 2);
  EXPECT_EQ(parts[0].First, 0.0);
  EXPECT_NEAR(parts[1].First, 2.0, 1e-11);
  EXPECT_EQ(parts[1].Last, infinity);
}
