// SPDX-License-Identifier: BSD-3-Clause
#include "SearchBench.h"
#include "TestVolume.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <limits>
#include <random>

namespace
{

/// Away from the larger values, as Contour's.
template <class T>
glm::dvec3 GetNormal(const TestVolume<T>& volume, const rt::Ray& ray, double isovalue, int edge = 4)
{
  SearchBench bench;
  const auto object = CreateObject(bench.Store, volume, { isovalue }, edge);
  rt::LatticeHit hit;
  EXPECT_TRUE(bench.Search.Intersect(object, ray, hit));
  return hit.Normal;
}

/// The gradient that Contour has at a sample: central differences, one-sided at the border.
template <class T>
glm::dvec3 GetDifference(const TestVolume<T>& volume, const bricks::Index3& at)
{
  glm::dvec3 gradient;
  for (int axis = 0; axis < 3; ++axis)
  {
    bricks::Index3 low = at;
    bricks::Index3 high = at;
    low[axis] = std::max<std::int64_t>(at[axis] - 1, 0);
    high[axis] = std::min(at[axis] + 1, volume.Points[axis] - 1);
    const auto span = static_cast<double>(high[axis] - low[axis]);
    gradient[axis] = (static_cast<double>(volume.At(high.x, high.y, high.z)) -
                       static_cast<double>(volume.At(low.x, low.y, low.z))) /
      span;
  }
  return gradient;
}

} // namespace

TEST(TestIsosurfaceSearchNormals, EqualTheAnalyticGradientOfAParaboloid)
{
  // Central differences of a quadratic are exact; trilinear in between, as the gradient is linear.
  const TestVolume<double> volume({ 40, 40, 40 },
    [](int x, int y, int z) {
      return 300.0 - (x - 19.5) * (x - 19.5) - (y - 18.2) * (y - 18.2) - 0.5 * (z - 20) * (z - 20);
    });
  SearchBench bench;
  const auto object = CreateObject(bench.Store, volume, { 150.0 }, 8);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 2000; ++i)
  {
    const glm::dvec3 direction =
      glm::normalize(glm::dvec3(uniform(random), uniform(random), uniform(random)));
    rt::LatticeHit hit;
    const glm::dvec3 center(19.5, 18.2, 20.0);
    ASSERT_TRUE(bench.Search.Intersect(object, CreateRay(center, center + 50.0 * direction), hit));
    const glm::dvec3 expected = glm::normalize(glm::dvec3(2, 2, 1) * (hit.At.IndexPoint - center));
    ASSERT_LT(glm::length(hit.Normal - expected), 1e-9);
  }
}

TEST(TestIsosurfaceSearchNormals, EqualContoursOnGridEdges)
{
  std::mt19937 random(2);
  const TestVolume<std::int16_t> volume({ 9, 10, 11 },
    [&](int, int, int)
    { return static_cast<std::int16_t>(static_cast<int>(random() % 200) - 100); });
  SearchBench bench;
  const auto object = CreateObject(bench.Store, volume, { 10.0 }, 4);
  int edges = 0;
  for (int z = 0; z < 11; ++z)
  {
    for (int y = 0; y < 10; ++y)
    {
      for (int x = 0; x < 8; ++x)
      {
        const double a = volume.At(x, y, z) - 10.0;
        const double b = volume.At(x + 1, y, z) - 10.0;
        if ((a >= 0) == (b >= 0))
        {
          continue;
        }
        ++edges;
        rt::LatticeHit hit;
        ASSERT_TRUE(bench.Search.Intersect(object, CreateRay({ x, y, z }, { x + 1, y, z }), hit));
        const double place = a / (a - b);
        ASSERT_NEAR(hit.T, place, 1e-12);
        const glm::dvec3 expected = glm::mix(
          GetDifference(volume, { x, y, z }), GetDifference(volume, { x + 1, y, z }), place);
        ASSERT_LT(glm::length(hit.Normal + glm::normalize(expected)), 1e-9);
      }
    }
  }
  EXPECT_GT(edges, 200);
}

TEST(TestIsosurfaceSearchNormals, ContinuousAcrossCellsAndBricks)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<float> noise(-0.2f, 0.2f);
  const TestVolume<float> volume({ 18, 18, 18 },
    [&](int x, int y, int z)
    { return static_cast<float>(z) + 0.1f * x - 0.2f * y + noise(random); });
  SearchBench bench;
  const auto object = CreateObject(bench.Store, volume, { 8.3 }, 4);
  for (int plane = 1; plane < 17; ++plane)
  {
    for (double along = 0.05; along < 17.0; along += 0.31)
    {
      for (const bool first : { false, true })
      {
        rt::LatticeHit hits[2];
        for (int side = 0; side < 2; ++side)
        {
          const double place = plane + (side == 0 ? -1e-9 : 1e-9);
          const glm::dvec3 from(first ? place : along, first ? along : place, 0.0);
          ASSERT_TRUE(bench.Search.Intersect(
            object, CreateRay(from, from + glm::dvec3(0.0, 0.0, 17.0)), hits[side]));
        }
        ASSERT_NEAR(hits[0].T, hits[1].T, 1e-8);
        ASSERT_LT(glm::length(hits[0].Normal - hits[1].Normal), 1e-6);
      }
    }
  }
}

TEST(TestIsosurfaceSearchNormals, OneSidedNextToMissingSamples)
{
  // The slope on x is 1 up to the hit's cell, and would be torn by what lies beyond it.
  const auto slope = [](int x, int, int) { return static_cast<float>(x < 4 ? x : 100 * x); };
  TestVolume<float> torn({ 7, 4, 4 }, slope);
  const rt::Ray ray = CreateRay({ 0, 1.5, 1.5 }, { 6, 1.5, 1.5 });
  EXPECT_LT(glm::length(GetNormal(torn, ray, 2.6) - glm::dvec3(-1, 0, 0)), 1e-12);
  const auto tilted = [&](int x, int y, int z) { return slope(x, y, z) + (x < 4 ? y : 0); };
  TestVolume<float> missing({ 7, 4, 4 }, tilted);
  for (int z = 0; z < 4; ++z)
  {
    for (int y = 0; y < 4; ++y)
    {
      missing.At(4, y, z) = std::numeric_limits<float>::quiet_NaN();
    }
  }
  const glm::dvec3 expected = glm::normalize(glm::dvec3(-1, -1, 0));
  EXPECT_LT(glm::length(GetNormal(missing, ray, 4.1) - expected), 1e-12);
  TestVolume<float> blanked({ 7, 4, 4 }, tilted);
  for (int z = 0; z < 3; ++z)
  {
    for (int y = 0; y < 3; ++y)
    {
      blanked.Blank(3, y, z);
    }
  }
  for (const int edge : { 1, 3, 4, 16 })
  {
    EXPECT_LT(glm::length(GetNormal(blanked, ray, 4.1, edge) - expected), 1e-12);
  }
}

TEST(TestIsosurfaceSearchNormals, LargeIntegersKeepTheirSlope)
{
  // Of which a double would keep no more than multiples of 256.
  constexpr std::int64_t base = std::int64_t(1) << 60;
  const TestVolume<std::int64_t> volume(
    { 6, 6, 6 }, [](int x, int y, int) { return base + 300 * x + 400 * y; });
  const glm::dvec3 normal = GetNormal(
    volume, CreateRay({ 0, 2.5, 2.5 }, { 5, 2.5, 2.5 }), static_cast<double>(base) + 1792.0);
  EXPECT_LT(glm::length(normal - glm::dvec3(-0.6, -0.8, 0.0)), 1e-12);
}

TEST(TestIsosurfaceSearchNormals, WithoutASlopeTheyLookBackAlongTheRay)
{
  // Of a chequerboard all central differences vanish.
  const TestVolume<float> volume(
    { 8, 8, 8 }, [](int x, int y, int z) { return (x + y + z) % 2 == 0 ? 1.0f : -1.0f; });
  const glm::dvec3 from(3.1, 3.2, 3.3);
  const glm::dvec3 to(3.9, 3.25, 3.35);
  const glm::dvec3 normal = GetNormal(volume, CreateRay(from, to), 0.1, 16);
  EXPECT_LT(glm::length(normal - glm::normalize(from - to)), 1e-12);
}
