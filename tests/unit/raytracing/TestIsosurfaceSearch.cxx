// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/base/Error.h"
#include "DSMRayTracing/field/lattice/IsosurfaceSearch.h"
#include "Oracle.h"
#include "RandomRays.h"
#include "TestVolume.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <limits>
#include <random>

namespace
{

/// Values of a type that strain it: of 64-bit integers such that doubles would lose the differences.
template <class T>
struct Values
{
  static double GetAmplitude() { return sizeof(T) == 1 ? 50.0 : 1000.0; }
  static T Create(double unit)
  {
    if constexpr (std::is_floating_point_v<T>)
    {
      return static_cast<T>(unit);
    }
    else
    {
      return static_cast<T>(GetCenter() + static_cast<T>(std::lround(unit * GetAmplitude())));
    }
  }
  static T GetCenter()
  {
    if constexpr (std::is_floating_point_v<T>)
    {
      return 0;
    }
    else if constexpr (sizeof(T) == 8)
    {
      return static_cast<T>(T(1) << 53);
    }
    else
    {
      return std::is_signed_v<T> ? T(0) : T(std::numeric_limits<T>::max() / 2);
    }
  }
  /// Whole for integers, so that many samples equal it.
  static double GetIsovalue(double unit) { return static_cast<double>(Create(unit)); }
};

template <class T>
TestVolume<T> CreateNoise(const bricks::Index3& points, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return TestVolume<T>(points, [&](int, int, int) { return Values<T>::Create(uniform(random)); });
}

template <class T>
TestVolume<T> CreateSmooth(const bricks::Index3& points, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.2, 0.9);
  const double a = uniform(random);
  const double b = uniform(random);
  const double c = uniform(random);
  return TestVolume<T>(points,
    [&](int x, int y, int z)
    {
      return Values<T>::Create(
        (std::sin(a * x + 1) + std::sin(b * y) + std::sin(c * z + a * x)) / 3);
    });
}

/// Three values only: plateaus of samples that equal the isovalue.
template <class T>
TestVolume<T> CreatePlateaus(const bricks::Index3& points, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> step(-1, 1);
  return TestVolume<T>(
    points, [&](int, int, int) { return Values<T>::Create(0.1 * step(random)); });
}

struct Comparison
{
  int Rays = 0;
  int Hits = 0;
  /// The oracle itself gives another answer after the smallest change of the isovalue.
  int Unstable = 0;
};

template <class T>
void CompareWithOracle(const TestVolume<T>& volume, double isovalue, int edge, unsigned seed,
  RandomRays::Kind kind, int rays, Comparison& comparison, const Planes& planes = nullptr)
{
  MemoryStore store;
  MemoryStore::Worker worker;
  const rt::LatticeIsosurface object = CreateObject(store, volume, { isovalue }, edge, planes);
  const rt::IsosurfaceSearch<MemoryStore> tracer(store, worker);
  const Oracle<T> oracle(volume, isovalue, 0, planes);
  RandomRays generator(volume.GetCells(), seed, planes.get());
  for (int i = 0; i < rays; ++i)
  {
    const rt::Ray ray = generator.Create(kind);
    const double cells = glm::length(ray.Direction);
    const std::optional<double> expected = oracle.FindFirst(ray);
    rt::LatticeHit hit;
    const bool found = tracer.Intersect(object, ray, hit);
    ++comparison.Rays;
    comparison.Hits += found;
    if (found)
    {
      ASSERT_GE(hit.T, ray.Min);
      ASSERT_LE(hit.T, ray.Max);
      ASSERT_NEAR(glm::length(hit.Normal), 1.0, 1e-12);
      const glm::dvec3 point = ray.Origin + hit.T * ray.Direction;
      const glm::dvec3 at = planes ? planes->ToPlace(hit.At.IndexPoint) : hit.At.IndexPoint;
      ASSERT_LT(glm::length(point - at), 1e-9);
      const glm::dvec3 inCell = hit.At.IndexPoint - glm::dvec3(hit.At.Cell);
      ASSERT_TRUE(glm::all(glm::greaterThanEqual(inCell, glm::dvec3(-1e-9))));
      ASSERT_TRUE(glm::all(glm::lessThanEqual(inCell, glm::dvec3(1.0 + 1e-9))));
    }
    if (found == expected.has_value() && (!found || std::abs(hit.T - *expected) * cells < 1e-4))
    {
      continue;
    }
    const long double small = 1e-9L * static_cast<long double>(Values<T>::GetAmplitude());
    const auto above = Oracle<T>(volume, isovalue, small, planes).FindFirst(ray);
    const auto below = Oracle<T>(volume, isovalue, -small, planes).FindFirst(ray);
    const bool stable = above.has_value() == below.has_value() &&
      (!above || std::abs(*above - *below) * cells < 1e-4);
    ASSERT_FALSE(stable) << "ray " << i << " of kind " << static_cast<int>(kind) << " found "
                         << (found ? hit.T : -1.0) << " instead of " << expected.value_or(-1.0);
    ++comparison.Unstable;
  }
}

template <class T>
void CompareAllKinds(const TestVolume<T>& volume, double isovalue, int edge, int raysPerKind,
  const Planes& planes = nullptr)
{
  Comparison comparison;
  for (int kind = 0; kind < static_cast<int>(RandomRays::Kind::Count); ++kind)
  {
    CompareWithOracle(volume, isovalue, edge, 17 + kind, static_cast<RandomRays::Kind>(kind),
      raysPerKind, comparison, planes);
    if (testing::Test::HasFatalFailure())
    {
      return;
    }
  }
  EXPECT_GT(comparison.Hits, comparison.Rays / 5);
  EXPECT_LE(comparison.Unstable, comparison.Rays / 100);
}

} // namespace

template <class T>
class TestIsosurfaceSearch : public testing::Test
{
};

using ScalarTypes = testing::Types<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t,
  std::int32_t, std::uint32_t, std::int64_t, std::uint64_t, float, double>;
TYPED_TEST_SUITE(TestIsosurfaceSearch, ScalarTypes);

TYPED_TEST(TestIsosurfaceSearch, NoisyVolumeEqualsBruteForce)
{
  using T = TypeParam;
  CompareAllKinds(CreateNoise<T>({ 8, 7, 9 }, 1), Values<T>::GetIsovalue(0.12), 4, 150);
  CompareAllKinds(CreateNoise<T>({ 8, 7, 9 }, 2), Values<T>::GetIsovalue(-0.3), 0, 50);
}

TYPED_TEST(TestIsosurfaceSearch, SmoothVolumeEqualsBruteForce)
{
  using T = TypeParam;
  CompareAllKinds(CreateSmooth<T>({ 12, 11, 10 }, 3), Values<T>::GetIsovalue(0.05), 8, 80);
}

TYPED_TEST(TestIsosurfaceSearch, PlateausEqualBruteForce)
{
  using T = TypeParam;
  CompareAllKinds(CreatePlateaus<T>({ 7, 8, 9 }, 4), Values<T>::GetIsovalue(0.0), 4, 100);
  CompareAllKinds(CreatePlateaus<T>({ 7, 8, 9 }, 5), Values<T>::GetIsovalue(0.1), 3, 100);
}

TEST(TestIsosurfaceSearchOfGrids, RectilinearVolumesEqualBruteForce)
{
  for (const double ratio : { 2.0, 1e6 })
  {
    const TestVolume<float> noise = CreateNoise<float>({ 8, 7, 9 }, 1);
    const double isovalue = Values<float>::GetIsovalue(0.12);
    CompareAllKinds(noise, isovalue, 4, 150, CreatePlanes(noise.GetCells(), ratio, 1));
    const TestVolume<double> smooth = CreateSmooth<double>({ 12, 11, 10 }, 3);
    CompareAllKinds(
      smooth, Values<double>::GetIsovalue(0.05), 8, 80, CreatePlanes(smooth.GetCells(), ratio, 2));
  }
}

/// A surface of values that are linear in space is a plane, also at the grid's border.
TEST(TestIsosurfaceSearchOfGrids, NormalsAreThoseOfTheValuesInSpace)
{
  const bricks::Index3 points(14, 11, 12);
  const Planes planes = CreatePlanes(points - bricks::Index3(1), 1e3, 5);
  const glm::dvec3 slope(3.0, -2.0, 1.0);
  const TestVolume<double> volume(points,
    [&](int x, int y, int z) { return glm::dot(slope, planes->ToPlace(glm::dvec3(x, y, z))); });
  MemoryStore store;
  MemoryStore::Worker worker;
  const double isovalue = glm::dot(slope, 0.5 * glm::dvec3(volume.GetCells()));
  const rt::LatticeIsosurface object = CreateObject(store, volume, { isovalue }, 4, planes);
  const rt::IsosurfaceSearch<MemoryStore> tracer(store, worker);
  RandomRays generator(volume.GetCells(), 3, planes.get());
  int hits = 0;
  for (int i = 0; i < 500; ++i)
  {
    const rt::Ray ray = generator.Create(RandomRays::Kind::Through);
    rt::LatticeHit hit;
    if (tracer.Intersect(object, ray, hit))
    {
      ++hits;
      EXPECT_LT(glm::length(hit.Normal + glm::normalize(slope)), 1e-9);
      const rt::LatticePlace place = object.Field.GetPlace(ray.Origin + hit.T * ray.Direction);
      EXPECT_LT(
        glm::length(planes->ToPlace(place.IndexPoint) - planes->ToPlace(hit.At.IndexPoint)), 1e-9);
    }
  }
  EXPECT_GT(hits, 100);
}

/// Equal steps in a table give the picture of the uniform lattice, up to rounding.
TEST(TestIsosurfaceSearchOfGrids, EqualStepsAreAUniformLattice)
{
  const TestVolume<float> volume = CreateSmooth<float>({ 12, 11, 10 }, 3);
  const double isovalue = Values<float>::GetIsovalue(0.05);
  MemoryStore store;
  MemoryStore::Worker worker;
  const rt::LatticeIsosurface uniform = CreateObject(store, volume, { isovalue }, 4);
  const rt::LatticeIsosurface stretched =
    CreateObject(store, volume, { isovalue }, 4, CreatePlanes(volume.GetCells(), 1.0, 1));
  const rt::IsosurfaceSearch<MemoryStore> tracer(store, worker);
  RandomRays generator(volume.GetCells(), 3);
  for (int i = 0; i < 500; ++i)
  {
    const rt::Ray ray = generator.Create(RandomRays::Kind::Through);
    rt::LatticeHit hit;
    rt::LatticeHit expected;
    ASSERT_EQ(tracer.Intersect(stretched, ray, hit), tracer.Intersect(uniform, ray, expected));
    ASSERT_NEAR(hit.T, expected.T, 1e-9);
    ASSERT_LT(glm::length(hit.Normal - expected.Normal), 1e-9);
  }
}

TEST(TestGridPlanes, FindsCellsAndRefusesDisorder)
{
  const Planes planes = CreatePlanes({ 40, 50, 60 }, 1e6, 8);
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto cells = planes->GetCells(axis);
    EXPECT_EQ(planes->GetPlace(axis, 0.0), 0.0);
    EXPECT_EQ(planes->GetPlace(axis, double(cells)), double(cells));
    for (std::int64_t cell = 0; cell < cells; ++cell)
    {
      EXPECT_EQ(planes->FindCell(axis, planes->GetPlace(axis, double(cell))), cell);
      const double middle = planes->ToPlace(axis, double(cell) + 0.5);
      EXPECT_EQ(planes->FindCell(axis, middle), cell);
      EXPECT_NEAR(planes->ToIndex(axis, middle), double(cell) + 0.5, 1e-6);
    }
    EXPECT_EQ(planes->FindCell(axis, -1.0), 0);
    EXPECT_EQ(planes->FindCell(axis, double(cells) + 1.0), cells - 1);
  }
  const std::vector<double> good{ 0.0, 1.0 };
  for (const std::vector<double>& bad : std::vector<std::vector<double>>{
         { 0.0 }, { 0.0, 1.0, 1.0 }, { 0.0, 2.0, 1.0 }, { 0.0, INFINITY }, { 0.0, NAN, 1.0 } })
  {
    EXPECT_THROW(bricks::GridPlanes({ good, bad, good }), dsm::Error);
  }
}
