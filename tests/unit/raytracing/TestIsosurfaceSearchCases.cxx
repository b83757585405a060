// SPDX-License-Identifier: BSD-3-Clause
#include "Oracle.h"
#include "RandomRays.h"
#include "SearchBench.h"
#include "TestVolume.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <limits>
#include <random>

namespace
{

constexpr float NotANumber = std::numeric_limits<float>::quiet_NaN();

TestVolume<float> CreateNoise(const bricks::Index3& points, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  return TestVolume<float>(points, [&](int, int, int) { return uniform(random); });
}

/// Noise, below zero at the border: every surface is closed.
template <class T>
TestVolume<T> CreateClosedNoise(int points, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> value(-3, 4);
  return TestVolume<T>({ points, points, points },
    [&](int x, int y, int z)
    {
      const bool border = std::min({ x, y, z }) == 0 || std::max({ x, y, z }) == points - 1;
      return static_cast<T>(border ? -1 : value(random));
    });
}

/// Between points of different sides there must be a hit.
template <class T>
void ExpectNoHoles(double isovalue, int edge, unsigned seed)
{
  const auto volume = CreateClosedNoise<T>(9, seed);
  SearchBench bench;
  const auto object = CreateObject(bench.Store, volume, { isovalue }, edge);
  RandomRays generator(volume.GetCells(), seed);
  int rays = 0;
  for (int i = 0; i < 30000; ++i)
  {
    glm::dvec3 target = generator.GetPoint();
    if (i % 3 == 0)
    {
      target = glm::round(target);
    }
    if (!(bench.Sample(*object.Field.Voxels, target) >= isovalue))
    {
      continue;
    }
    ++rays;
    glm::dvec3 outside = target;
    if (i % 2 == 0)
    {
      outside[i % 3] = i % 4 == 0 ? -3.0 : 20.0;
    }
    else
    {
      outside += 40.0 * glm::round(glm::dvec3(generator.Get(-2, 2), generator.Get(-2, 2), 3.0));
    }
    rt::LatticeHit hit;
    ASSERT_TRUE(bench.Search.Intersect(object, CreateRay(outside, target), hit)) << i;
    ASSERT_TRUE(bench.Search.Intersect(object, CreateRay(target, outside), hit)) << i;
  }
  EXPECT_GT(rays, 2000);
}

} // namespace

TEST(TestIsosurfaceSearchCases, ClosedSurfacesHaveNoHoles)
{
  ExpectNoHoles<float>(0.5, 4, 1);
  ExpectNoHoles<double>(0.1, 3, 2);
}

TEST(TestIsosurfaceSearchCases, ClosedSurfacesThroughEqualSamplesHaveNoHoles)
{
  ExpectNoHoles<float>(0.0, 4, 3);
  ExpectNoHoles<std::int8_t>(0.0, 5, 4);
  ExpectNoHoles<std::int16_t>(1.0, 1, 5);
  ExpectNoHoles<std::int64_t>(2.0, 8, 6);
}

TEST(TestIsosurfaceSearchCases, SidesAlternateAlongARay)
{
  // Every hit of a ray, one after the other: into the inside, out of it, and so on.
  const auto volume = CreateClosedNoise<float>(9, 7);
  SearchBench bench;
  const auto object = CreateObject(bench.Store, volume, { 0.25 }, 4);
  RandomRays generator(volume.GetCells(), 8);
  for (int i = 0; i < 2000; ++i)
  {
    rt::Ray ray = generator.Create(RandomRays::Kind::Through);
    rt::LatticeHit hit;
    int hits = 0;
    double last = -1.0;
    while (bench.Search.Intersect(object, ray, hit))
    {
      ASSERT_GT(hit.T, last);
      last = hit.T;
      ray.Min = hit.T + 1e-7;
      ++hits;
    }
    ASSERT_EQ(hits % 2, 0) << i;
  }
}

TEST(TestIsosurfaceSearchCases, HitsDoNotDependOnTheBricks)
{
  const auto volume = CreateNoise({ 20, 17, 15 }, 9);
  SearchBench bench;
  const auto reference = CreateObject(bench.Store, volume, { 0.8, 0.9 }, 64);
  std::vector<rt::LatticeIsosurface> others;
  for (const int edge : { 1, 2, 3, 4, 5, 7, 8, 16 })
  {
    others.push_back(CreateObject(bench.Store, volume, { 0.8, 0.9 }, edge));
  }
  RandomRays generator(volume.GetCells(), 10);
  int hits = 0;
  for (int i = 0; i < 4000; ++i)
  {
    const rt::Ray ray = generator.Create(
      static_cast<RandomRays::Kind>(i % static_cast<int>(RandomRays::Kind::Count)));
    rt::LatticeHit expected;
    const bool found = bench.Search.Intersect(reference, ray, expected);
    hits += found;
    for (const rt::LatticeIsosurface& object : others)
    {
      rt::LatticeHit hit;
      ASSERT_EQ(bench.Search.Intersect(object, ray, hit), found);
      if (found)
      {
        ASSERT_EQ(hit.T, expected.T);
        ASSERT_EQ(hit.Normal, expected.Normal);
        ASSERT_EQ(hit.At.IndexPoint, expected.At.IndexPoint);
        ASSERT_EQ(hit.Isovalue, expected.Isovalue);
        const bricks::Box cells = object.Field.Voxels->Lattice.GetCellsOfBrick(hit.At.Brick);
        ASSERT_TRUE(glm::all(glm::greaterThanEqual(hit.At.IndexPoint, glm::dvec3(cells.Min))));
        ASSERT_TRUE(glm::all(glm::lessThanEqual(hit.At.IndexPoint, glm::dvec3(cells.Max))));
      }
    }
  }
  EXPECT_GT(hits, 1000);
}

TEST(TestIsosurfaceSearchCases, SeveralIsovaluesGiveTheNearestHit)
{
  const auto volume = CreateNoise({ 9, 8, 10 }, 11);
  const std::vector<double> isovalues{ -0.9, -0.4, 0.0, 0.3, 0.95, 7.0 };
  SearchBench bench;
  const auto all = CreateObject(bench.Store, volume, isovalues, 4);
  RandomRays generator(volume.GetCells(), 12);
  for (int i = 0; i < 3000; ++i)
  {
    const rt::Ray ray = generator.Create(
      static_cast<RandomRays::Kind>(i % static_cast<int>(RandomRays::Kind::Count)));
    rt::LatticeHit expected;
    bool found = false;
    for (std::size_t index = 0; index < isovalues.size(); ++index)
    {
      rt::LatticeIsosurface one = all;
      one.Isovalues = { isovalues[index] };
      rt::LatticeHit hit;
      if (bench.Search.Intersect(one, ray, hit) && (!found || hit.T < expected.T))
      {
        found = true;
        expected = hit;
        expected.Isovalue = static_cast<int>(index);
      }
    }
    rt::LatticeHit hit;
    ASSERT_EQ(bench.Search.Intersect(all, ray, hit), found);
    if (found)
    {
      ASSERT_EQ(hit.T, expected.T);
      ASSERT_EQ(hit.Isovalue, expected.Isovalue);
    }
  }
}

TEST(TestIsosurfaceSearchCases, TheUnitOfTheValuesDoesNotMatter)
{
  std::mt19937 random(23);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const TestVolume<double> volume({ 9, 8, 10 }, [&](int, int, int) { return uniform(random); });
  SearchBench bench;
  const auto reference = CreateObject(bench.Store, volume, { 0.8 }, 4);
  for (const double unit : { 0x1p-600, 0x1p600 })
  {
    TestVolume<double> scaled = volume;
    for (double& sample : scaled.Samples)
    {
      sample *= unit;
    }
    const auto object = CreateObject(bench.Store, scaled, { 0.8 * unit }, 4);
    RandomRays generator(volume.GetCells(), 24);
    int hits = 0;
    for (int i = 0; i < 4000; ++i)
    {
      const rt::Ray ray = generator.Create(
        static_cast<RandomRays::Kind>(i % static_cast<int>(RandomRays::Kind::Count)));
      rt::LatticeHit expected;
      rt::LatticeHit hit;
      const bool found = bench.Search.Intersect(reference, ray, expected);
      ASSERT_EQ(bench.Search.Intersect(object, ray, hit), found);
      if (found)
      {
        ++hits;
        ASSERT_EQ(hit.T, expected.T);
        ASSERT_EQ(hit.At.IndexPoint, expected.At.IndexPoint);
        ASSERT_LT(glm::length(hit.Normal - expected.Normal), 1e-14);
      }
    }
    EXPECT_GT(hits, 500);
  }
}

TEST(TestIsosurfaceSearchCases, NoIsovalueNoHit)
{
  SearchBench bench;
  const auto volume = CreateNoise({ 5, 5, 5 }, 13);
  rt::LatticeHit hit;
  const rt::Ray ray = CreateRay({ -1, 2, 2 }, { 6, 2, 2 });
  EXPECT_FALSE(bench.Search.Intersect(CreateObject(bench.Store, volume, {}), ray, hit));
  EXPECT_FALSE(bench.Search.Intersect(CreateObject(bench.Store, volume, { 5.0 }), ray, hit));
  EXPECT_EQ(bench.Worker.Accesses, 0);
}

TEST(TestIsosurfaceSearchCases, CellsWithNaNHoldNoSurface)
{
  auto volume = CreateNoise({ 9, 8, 7 }, 14);
  std::mt19937 random(15);
  for (int i = 0; i < 25; ++i)
  {
    volume.At(random() % 9, random() % 8, random() % 7) =
      i % 5 == 0 ? std::numeric_limits<float>::infinity() : NotANumber;
  }
  SearchBench bench;
  const auto object = CreateObject(bench.Store, volume, { 0.1 }, 4);
  const Oracle<float> oracle(volume, 0.1);
  RandomRays generator(volume.GetCells(), 16);
  int hits = 0;
  for (int i = 0; i < 2000; ++i)
  {
    const rt::Ray ray =
      generator.Create(i % 2 == 0 ? RandomRays::Kind::Through : RandomRays::Kind::FromInside);
    const auto expected = oracle.FindFirst(ray);
    rt::LatticeHit hit;
    ASSERT_EQ(bench.Search.Intersect(object, ray, hit), expected.has_value());
    if (expected)
    {
      ++hits;
      ASSERT_NEAR(hit.T, *expected, 1e-6);
      ASSERT_NEAR(glm::length(hit.Normal), 1.0, 1e-12);
    }
  }
  EXPECT_GT(hits, 500);
}

TEST(TestIsosurfaceSearchCases, BlankedCellsHoldNoSurface)
{
  auto volume = CreateNoise({ 9, 8, 7 }, 17);
  std::mt19937 random(18);
  for (int i = 0; i < 150; ++i)
  {
    volume.Blank(random() % 8, random() % 7, random() % 6);
  }
  SearchBench bench;
  const auto object = CreateObject(bench.Store, volume, { 0.1 }, 4);
  const Oracle<float> oracle(volume, 0.1);
  RandomRays generator(volume.GetCells(), 19);
  int hits = 0;
  for (int i = 0; i < 2000; ++i)
  {
    const rt::Ray ray =
      generator.Create(i % 2 == 0 ? RandomRays::Kind::Through : RandomRays::Kind::FromInside);
    const auto expected = oracle.FindFirst(ray);
    rt::LatticeHit hit;
    ASSERT_EQ(bench.Search.Intersect(object, ray, hit), expected.has_value());
    if (expected)
    {
      ++hits;
      ASSERT_NEAR(hit.T, *expected, 1e-6);
      ASSERT_NEAR(glm::length(hit.Normal), 1.0, 1e-12);
    }
  }
  EXPECT_GT(hits, 500);
}

TEST(TestIsosurfaceSearchCases, VolumeOfOneCell)
{
  const TestVolume<std::uint8_t> volume({ 2, 2, 2 }, [](int x, int, int) { return 10 * x; });
  SearchBench bench;
  const auto object = CreateObject(bench.Store, volume, { 4.0 });
  rt::LatticeHit hit;
  ASSERT_TRUE(bench.Search.Intersect(object, CreateRay({ -1, 0.3, 0.6 }, { 2, 0.3, 0.6 }), hit));
  EXPECT_NEAR(hit.At.IndexPoint.x, 0.4, 1e-14);
  EXPECT_EQ(hit.Normal, glm::dvec3(-1.0, 0.0, 0.0));
  EXPECT_EQ(hit.At.Brick, 0u);
  // Along the volume's own faces and edges.
  for (const glm::dvec2 place : { glm::dvec2(0, 0), { 1, 0 }, { 0, 1 }, { 1, 1 }, { 0.5, 1 } })
  {
    ASSERT_TRUE(bench.Search.Intersect(
      object, CreateRay({ 3, place.x, place.y }, { -3, place.x, place.y }), hit));
    EXPECT_NEAR(hit.At.IndexPoint.x, 0.4, 1e-14);
  }
  EXPECT_FALSE(
    bench.Search.Intersect(object, CreateRay({ -1, 1.001, 0.5 }, { 2, 1.001, 0.5 }), hit));
}

TEST(TestIsosurfaceSearchCases, MinAndMaxAreRespected)
{
  const TestVolume<float> volume({ 9, 3, 3 }, [](int x, int, int) { return 1.0f * (x % 2); });
  SearchBench bench;
  const auto object = CreateObject(bench.Store, volume, { 0.5 }, 4);
  rt::Ray ray;
  ray.Origin = { -2.0, 1.2, 0.7 };
  ray.Direction = { 2.0, 0.0, 0.0 };
  ray.Max = 100.0;
  rt::LatticeHit hit;
  for (int crossing = 0; crossing < 8; ++crossing)
  {
    ASSERT_TRUE(bench.Search.Intersect(object, ray, hit));
    EXPECT_NEAR(hit.T, (crossing + 2.5) / 2.0, 1e-12);
    ray.Max = hit.T - 1e-9;
    EXPECT_FALSE(bench.Search.Intersect(object, ray, hit));
    ray.Max = 100.0;
    ray.Min = hit.T + 1e-9;
  }
  EXPECT_FALSE(bench.Search.Intersect(object, ray, hit));
  ray.Min = 1.0;
  ray.Max = 1.0;
  EXPECT_FALSE(bench.Search.Intersect(object, ray, hit));
}

TEST(TestIsosurfaceSearchCases, RaysThatAreNoneMiss)
{
  SearchBench bench;
  const auto object = CreateObject(bench.Store, CreateNoise({ 5, 5, 5 }, 20), { 0.0 });
  rt::LatticeHit hit;
  EXPECT_FALSE(bench.Search.Intersect(object, CreateRay({ 2, 2, 2 }, { 2, 2, 2 }), hit));
  EXPECT_FALSE(bench.Search.Intersect(object, CreateRay({ NotANumber, 2, 2 }, { 2, 2, 2 }), hit));
  EXPECT_FALSE(bench.Search.Intersect(object, CreateRay({ -1, 2, 2 }, { INFINITY, 2, 2 }), hit));
}

TEST(TestIsosurfaceSearchCases, PreciseAnywhereInALargeVolume)
{
  // One long row of cells along each axis; the samples are a linear function.
  for (int axis = 0; axis < 3; ++axis)
  {
    bricks::Index3 points(3);
    points[axis] = 2049;
    glm::dvec3 gradient(7.0);
    gradient[axis] = 31.0;
    const TestVolume<std::uint16_t> volume(points,
      [&](int x, int y, int z)
      { return static_cast<std::uint16_t>(glm::dot(gradient, glm::dvec3(x, y, z))); });
    SearchBench bench;
    for (const int cell : { 0, 1, 1000, 2046, 2047 })
    {
      glm::dvec3 target(0.31, 0.74, 1.22);
      target[axis] = cell + 0.4;
      const auto object = CreateObject(bench.Store, volume, { glm::dot(gradient, target) });
      for (const double distance : { 3.0, 1e4, 1e7 })
      {
        rt::Ray ray;
        ray.Direction =
          glm::normalize(glm::dvec3(0.3, -0.2, 0.1) + glm::dvec3(axis == 0, axis == 1, axis == 2));
        ray.Origin = target - distance * ray.Direction;
        ray.Max = 2.0 * distance;
        rt::LatticeHit hit;
        ASSERT_TRUE(bench.Search.Intersect(object, ray, hit));
        EXPECT_NEAR(hit.T, distance, 1e-6);
        EXPECT_LT(glm::length(hit.At.IndexPoint - target), 1e-6);
        EXPECT_LT(glm::length(hit.Normal + glm::normalize(gradient)), 1e-12);
      }
    }
  }
}

TEST(TestIsosurfaceSearchCases, AnyPlacementInTheWorld)
{
  const auto volume = CreateNoise({ 10, 9, 8 }, 21);
  SearchBench bench;
  const auto plain = CreateObject(bench.Store, volume, { 0.2 }, 4);
  auto placed = plain;
  glm::dmat4 matrix = glm::translate(glm::dmat4(1.0), { 1000.0, -2000.0, 500.0 });
  matrix = glm::rotate(matrix, 0.7, { 1.0, 2.0, -0.5 });
  matrix = glm::scale(matrix, { 0.01, 3.0, -0.5 });
  matrix[1] += 0.3 * matrix[0] + 0.2 * matrix[2];
  placed.Field.SetIndexToWorld(matrix);
  RandomRays generator(volume.GetCells(), 22);
  int hits = 0;
  for (int i = 0; i < 2000; ++i)
  {
    const rt::Ray ray = generator.Create(RandomRays::Kind::Through);
    rt::Ray world = ray;
    world.Origin = glm::dvec3(matrix * glm::dvec4(ray.Origin, 1.0));
    world.Direction = glm::dvec3(matrix * glm::dvec4(ray.Direction, 0.0));
    rt::LatticeHit expected;
    rt::LatticeHit hit;
    ASSERT_EQ(
      bench.Search.Intersect(placed, world, hit), bench.Search.Intersect(plain, ray, expected));
    if (expected.T == 0.0)
    {
      continue;
    }
    ++hits;
    ASSERT_NEAR(hit.T, expected.T, 1e-6);
    const glm::dvec3 normal =
      glm::normalize(glm::transpose(glm::inverse(glm::dmat3(matrix))) * expected.Normal);
    ASSERT_LT(glm::length(hit.Normal - normal), 1e-6);
  }
  EXPECT_GT(hits, 500);
}

TEST(TestIsosurfaceSearchCases, EachBrickIsAcquiredOnceAVisit)
{
  const TestVolume<float> volume(
    { 65, 17, 17 }, [](int x, int, int) { return x < 63 ? 0.0f : 1.0f; });
  SearchBench bench;
  const auto object = CreateObject(bench.Store, volume, { 0.5 }, 16);
  rt::LatticeHit hit;
  ASSERT_TRUE(bench.Search.Intersect(object, CreateRay({ -5, 8.5, 8.5 }, { 70, 8.5, 8.5 }), hit));
  EXPECT_NEAR(hit.At.IndexPoint.x, 62.5, 1e-12);
  // Empty bricks are leapt over; the hit's neighborhood lies in its brick.
  EXPECT_EQ(bench.Worker.Accesses, 1);
}
