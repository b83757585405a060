// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/field/grid/GridWalk.h"
#include "RandomRays.h"

#include <gtest/gtest.h>

#include <vector>

namespace
{

struct Visit
{
  std::int64_t Node;
  double Enter;
  double Leave;
};

/// All nodes of a grid of `edge` cells over `cells` cells that a ray visits.
std::vector<Visit> Walk(
  const rt::GridRay& line, const bricks::Index3& cells, int edge, double enter, double leave)
{
  const bricks::Index3 counts = (cells + bricks::Index3(edge - 1)) / bricks::Index3(edge);
  const rt::NodeStrides strides(counts.x, counts.x * counts.y);
  const rt::NodeGrid grid{ rt::Lanes(0.0), double(edge), 1.0 / edge,
    rt::Lanes(counts.x, counts.y, counts.z, 1.0), strides };
  rt::GridWalk walk;
  std::vector<Visit> visits;
  std::int64_t node = walk.Start(line, enter, grid);
  for (double t = enter; t < leave;)
  {
    const double exit = std::min(walk.GetExit(), leave);
    visits.push_back({ node, t, exit });
    node += walk.Advance(line, exit);
    t = exit;
  }
  return visits;
}

} // namespace

TEST(TestGridWalk, EveryNodeContainsItsPartOfTheRay)
{
  const bricks::Index3 cells(13, 9, 17);
  RandomRays generator(cells, 3);
  int walks = 0;
  for (int i = 0; i < 7000; ++i)
  {
    const rt::Ray ray = generator.Create(
      static_cast<RandomRays::Kind>(i % static_cast<int>(RandomRays::Kind::Count)));
    rt::GridRay line;
    double enter = ray.Min;
    double leave = ray.Max;
    ASSERT_TRUE(line.Set(&ray.Origin.x, &ray.Direction.x));
    if (!line.Clip(cells, enter, leave))
    {
      continue;
    }
    ++walks;
    for (const int edge : { 1, 3, 4 })
    {
      const bricks::Index3 counts = (cells + bricks::Index3(edge - 1)) / bricks::Index3(edge);
      double last = enter;
      for (const Visit& visit : Walk(line, cells, edge, enter, leave))
      {
        ASSERT_EQ(visit.Enter, last);
        ASSERT_GT(visit.Leave, visit.Enter);
        last = visit.Leave;
        const bricks::Index3 node(visit.Node % counts.x, visit.Node / counts.x % counts.y,
          visit.Node / (counts.x * counts.y));
        for (int axis = 0; axis < 3; ++axis)
        {
          const double middle =
            ray.Origin[axis] + 0.5 * (visit.Enter + visit.Leave) * ray.Direction[axis];
          ASSERT_GE(middle, double(node[axis] * edge) - 1e-12);
          ASSERT_LE(middle, double((node[axis] + 1) * edge) + 1e-12);
        }
      }
      ASSERT_EQ(last, leave);
    }
  }
  EXPECT_GT(walks, 4000);
}

TEST(TestGridWalk, StartingAnywhereGivesTheSameCells)
{
  const bricks::Index3 cells(13, 9, 17);
  RandomRays generator(cells, 4);
  for (int i = 0; i < 3500; ++i)
  {
    const rt::Ray ray = generator.Create(
      static_cast<RandomRays::Kind>(i % static_cast<int>(RandomRays::Kind::Count)));
    rt::GridRay line;
    double enter = ray.Min;
    double leave = ray.Max;
    ASSERT_TRUE(line.Set(&ray.Origin.x, &ray.Direction.x));
    if (!line.Clip(cells, enter, leave))
    {
      continue;
    }
    const std::vector<Visit> visits = Walk(line, cells, 1, enter, leave);
    for (std::size_t first = 0; first < visits.size(); ++first)
    {
      const std::vector<Visit> rest = Walk(line, cells, 1, visits[first].Enter, leave);
      ASSERT_EQ(rest.size(), visits.size() - first);
      for (std::size_t k = 0; k < rest.size(); ++k)
      {
        ASSERT_EQ(rest[k].Node, visits[first + k].Node);
        ASSERT_EQ(rest[k].Enter, visits[first + k].Enter);
        ASSERT_EQ(rest[k].Leave, visits[first + k].Leave);
      }
    }
  }
}

TEST(TestGridWalk, DiagonalRayVisitsOnlyTheDiagonal)
{
  const double origin[3] = { -2.0, -2.0, -2.0 };
  const double direction[3] = { 1.0, 1.0, 1.0 };
  rt::GridRay line;
  ASSERT_TRUE(line.Set(origin, direction));
  double enter = 0.0;
  double leave = 100.0;
  const bricks::Index3 cells(5, 5, 5);
  ASSERT_TRUE(line.Clip(cells, enter, leave));
  const std::vector<Visit> visits = Walk(line, cells, 1, enter, leave);
  ASSERT_EQ(visits.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i)
  {
    EXPECT_EQ(visits[i].Node, std::int64_t(i * 31));
  }
}

TEST(TestGridRay, RefusesRaysThatGoNowhere)
{
  rt::GridRay line;
  const double origin[3] = { 0.0, 0.0, 0.0 };
  const double still[3] = { 0.0, -0.0, 0.0 };
  const double tiny[3] = { 1e-320, 0.0, 0.0 };
  const double bad[3] = { 1.0, std::nan(""), 0.0 };
  const double infinite[3] = { 1.0, INFINITY, -INFINITY };
  EXPECT_FALSE(line.Set(origin, still));
  EXPECT_FALSE(line.Set(origin, tiny));
  EXPECT_FALSE(line.Set(origin, bad));
  EXPECT_FALSE(line.Set(origin, infinite));
  EXPECT_FALSE(line.Set(bad, origin));
}

TEST(TestGridRay, MissesBesideTheVolume)
{
  rt::GridRay line;
  const double direction[3] = { 0.0, 0.0, 1.0 };
  const double beside[3] = { 5.001, 1.0, -3.0 };
  const double border[3] = { 5.0, 0.0, -3.0 };
  double enter = 0.0;
  double leave = 10.0;
  ASSERT_TRUE(line.Set(beside, direction));
  EXPECT_FALSE(line.Clip({ 5, 5, 5 }, enter, leave));
  enter = 0.0;
  leave = 10.0;
  ASSERT_TRUE(line.Set(border, direction));
  EXPECT_TRUE(line.Clip({ 5, 5, 5 }, enter, leave));
  EXPECT_EQ(enter, 3.0);
  EXPECT_EQ(leave, 8.0);
}
