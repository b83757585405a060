// SPDX-License-Identifier: BSD-3-Clause
// Rays through leaves of several levels.
#include "tests/unit/raytracing/MemoryStore.h"
#include "tests/unit/raytracing/PublishedLevels.h"

#include "DSMRayTracing/field/levels/LevelSections.h"
#include "DSMRayTracing/field/levels/LevelSurfaces.h"
#include "DSMRayTracing/scene/SceneObject.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace
{

using bricks::Index3;

constexpr int RayCount = rt::RayPacket::Size;

double GetNoise(const glm::dvec3& place)
{
  const double wave = std::sin(dot(place, glm::dvec3(127.1, 311.7, 74.7))) * 43758.5453;
  return wave - std::floor(wave) - 0.5;
}

/// Noise within one value that is above it everywhere at the border: from a place that is below, each ray meets the
/// surface.
LevelModel CreateClosed(unsigned seed, double offset)
{
  LevelModel model = CreateRandomLevels(seed, false);
  model.OfPoints = seed % 4 == 1;
  model.Type = seed % 5 == 0 ? bricks::ScalarType::Float64 : bricks::ScalarType::Float32;
  const glm::dvec3 end(model.Roots);
  model.Function = [end, offset](int, const glm::dvec3& place)
  {
    const glm::dvec3 inside = glm::min(place, end - place);
    const bool isOuter = std::min({ inside.x, inside.y, inside.z }) <= 1.0;
    return offset + (isOuter ? 1.0 : GetNoise(place));
  };
  return model;
}

/// Rays in random directions, along axes and diagonals, of which most start at corners, edges and faces of leaves.
class Rays
{
public:
  Rays(const LevelModel& model, unsigned seed)
    : Model(model)
    , Random(seed)
  {
  }

  glm::dvec3 GetStart()
  {
    glm::dvec3 start;
    for (int axis = 0; axis < 3; ++axis)
    {
      const std::int64_t size = this->Model.Size[axis];
      const double cells = this->Get() < 0.6
        ? std::floor(this->Get() * static_cast<double>(size + 1))
        : this->Get() * static_cast<double>(size);
      start[axis] = cells / static_cast<double>(this->Model.Scales.back()[axis]);
    }
    return start;
  }

  glm::dvec3 GetDirection()
  {
    glm::dvec3 direction(0.0);
    while (direction == glm::dvec3(0.0))
    {
      const bool isRandom = this->Get() < 0.4;
      for (int axis = 0; axis < 3; ++axis)
      {
        direction[axis] = isRandom ? this->Get() - 0.5 : std::floor(this->Get() * 3.0) - 1.0;
      }
    }
    return direction;
  }

  double Get() { return std::uniform_real_distribution<double>(0.0, 1.0)(this->Random); }

private:
  const LevelModel& Model;
  std::mt19937 Random;
};

/// A model with its tracers, one for each vector width.
class TracedLevels
{
public:
  TracedLevels(const LevelModel& model, std::vector<double> isovalues)
    : Published(model)
    , Isovalues(isovalues)
  {
    const bricks::LevelVoxels& levels = *this->Published.Levels;
    auto voxels = std::make_shared<bricks::LevelVoxels>(levels);
    const auto segment = std::make_shared<MemoryStore::Segment>(levels.Lattice.CreateDirectory(1));
    levels.Segment->ForEachResident([&](dsm::BlockId id, const std::byte* block, std::size_t bytes)
      { std::copy_n(block, bytes, segment->GetBlock(id)); });
    voxels->Segment = segment;
    this->Sets.Field.Voxels = voxels;
    this->Sets.Isovalues = std::move(isovalues);
  }

  /// Calls `use(tracer)` for each vector width, that of single rays first.
  template <class Use>
  void ForEachTracer(const Use& use)
  {
    MemoryStore store;
    MemoryStore::Worker worker;
    for (const rt::PacketKernel& kernel : rt::PacketKernel::GetAll())
    {
      SCOPED_TRACE(kernel.Name);
      use(rt::LevelSurfaces<MemoryStore>(store, worker, kernel));
    }
  }

  /// The value at a place in cells of level 0; NaN where there is none.
  double Evaluate(const glm::dvec3& place) const
  {
    const glm::dvec3 finest = place * glm::dvec3(this->Published.Model.Scales.back());
    double value;
    return this->Published.GetValue(Index3(glm::floor(finest)), finest, value)
      ? value
      : std::numeric_limits<double>::quiet_NaN();
  }

  PublishedLevels Published;
  std::vector<double> Isovalues;
  rt::LevelIsosurface Sets;
};

bool AreSame(const rt::LatticeHit& a, const rt::LatticeHit& b)
{
  return a.T == b.T && a.Isovalue == b.Isovalue && a.FromInside == b.FromInside &&
    a.Normal == b.Normal && a.At.Brick == b.At.Brick && a.At.Cell == b.At.Cell &&
    a.At.IndexPoint == b.At.IndexPoint;
}

/// All widths and packets give what single rays give; shadow rays agree with them.
void CompareWays(
  TracedLevels& traced, const rt::Ray* rays, rt::RayMask& found, rt::LatticeHit* hits)
{
  const std::vector<glm::dvec3> sheets(traced.Isovalues.size(), glm::dvec3(0.5));
  bool isFirst = true;
  glm::dvec3 light[RayCount];
  traced.ForEachTracer(
    [&](const auto& tracer)
    {
      rt::LatticeHit now[RayCount];
      const auto open = [&](int ray, double) { return &now[ray]; };
      rt::RayMask these = tracer.Intersect(traced.Sets, nullptr, rays, ~rt::RayMask{ 0 }, open);
      if (isFirst)
      {
        found = these;
        std::copy_n(now, RayCount, hits);
      }
      glm::dvec3 passing[RayCount];
      std::fill_n(passing, RayCount, glm::dvec3(1.0));
      tracer.Attenuate(traced.Sets, sheets, rays, ~rt::RayMask{ 0 }, passing);
      ASSERT_EQ(these, found);
      ASSERT_EQ(tracer.FindOccluded(traced.Sets, rays, ~rt::RayMask{ 0 }), found);
      for (int ray = 0; ray < RayCount; ++ray)
      {
        const rt::RayMask bit = rt::RayMask{ 1 } << ray;
        light[ray] = isFirst ? passing[ray] : light[ray];
        ASSERT_EQ(passing[ray], light[ray]) << "ray " << ray;
        ASSERT_EQ(passing[ray].x < 1.0, (found & bit) != 0) << "ray " << ray;
        ASSERT_TRUE((found & bit) == 0 || AreSame(now[ray], hits[ray])) << "ray " << ray;
      }
      for (int ray = 0; isFirst && ray < RayCount; ++ray)
      {
        const rt::RayMask bit = rt::RayMask{ 1 } << ray;
        these = tracer.Intersect(traced.Sets, nullptr, rays, bit, open);
        ASSERT_EQ(these, found & bit) << "ray " << ray;
        ASSERT_TRUE(these == 0 || AreSame(now[ray], hits[ray])) << "ray " << ray;
      }
      isFirst = false;
    });
}

} // namespace

TEST(LevelSurfaces, NoRayLeavesAClosedSurface)
{
  int tried = 0;
  for (unsigned seed = 0; seed < 32; ++seed)
  {
    SCOPED_TRACE(seed);
    const double offset = seed % 3 == 0 ? 0.0 : (seed % 3 == 1 ? 1000.0 : -1e6);
    const LevelModel model = CreateClosed(seed, offset);
    TracedLevels traced(model, { offset + 0.07 * (seed % 4) });
    Rays random(model, seed);
    for (int round = 0; round < 12; ++round)
    {
      rt::Ray rays[RayCount];
      for (rt::Ray& ray : rays)
      {
        for (int attempt = 0; attempt < 400; ++attempt)
        {
          ray.Origin = random.GetStart();
          if (traced.Evaluate(ray.Origin) < traced.Isovalues[0] - 0.01 - 4e-7 * std::abs(offset))
          {
            break;
          }
        }
        if (!(traced.Evaluate(ray.Origin) < traced.Isovalues[0] - 0.01 - 4e-7 * std::abs(offset)))
        {
          continue; // no place within
        }
        ray.Direction = random.GetDirection();
        ray.Max = 1000.0;
      }
      rt::RayMask found = 0;
      rt::LatticeHit hits[RayCount];
      CompareWays(traced, rays, found, hits);
      for (int ray = 0; ray < RayCount; ++ray)
      {
        const bool isWanted = rays[ray].Max > 0.0;
        tried += isWanted;
        const bool isFound = (found >> ray & 1) != 0;
        const glm::dvec3& at = rays[ray].Origin;
        const glm::dvec3& way = rays[ray].Direction;
        EXPECT_EQ(isFound, isWanted) << "from " << at.x << " " << at.y << " " << at.z << " to "
                                     << way.x << " " << way.y << " " << way.z;
        if (!isFound)
        {
          continue;
        }
        const double value = traced.Evaluate(at + hits[ray].T * way);
        EXPECT_NEAR(value, traced.Isovalues[0], 1e-6 + 2e-7 * std::abs(offset)) << "ray " << ray;
      }
      if (testing::Test::HasFailure())
      {
        return;
      }
    }
  }
  EXPECT_GT(tried, 5000);
}

TEST(LevelSurfaces, HitsAreWhereTheFunctionCrosses)
{
  int crossed = 0;
  for (unsigned seed = 0; seed < 16; ++seed)
  {
    SCOPED_TRACE(seed);
    LevelModel model = CreateRandomLevels(seed, true);
    model.OfPoints = seed % 4 >= 2;
    model.Type = seed % 5 == 0 ? bricks::ScalarType::Float64 : bricks::ScalarType::Float32;
    model.Function = [](int, const glm::dvec3& place)
    {
      const double value = GetNoise(place);
      return value > 0.49 ? std::numeric_limits<double>::quiet_NaN() : value;
    };
    TracedLevels traced(model, { -0.1, 0.123 });
    Rays random(model, seed);
    for (int round = 0; round < 4; ++round)
    {
      rt::Ray rays[RayCount];
      for (rt::Ray& ray : rays)
      {
        ray.Direction = random.GetDirection();
        ray.Origin = random.GetStart() - ray.Direction * std::floor(random.Get() * 3.0) * 4.0;
        ray.Min = random.Get() < 0.2 ? 1.0 : 0.0;
        ray.Max = 16.0;
      }
      rt::RayMask found = 0;
      rt::LatticeHit hits[RayCount];
      CompareWays(traced, rays, found, hits);
      for (int ray = 0; ray < RayCount; ++ray)
      {
        const bool isFound = (found >> ray & 1) != 0;
        const auto evaluate = [&](double t)
        { return traced.Evaluate(rays[ray].Origin + t * rays[ray].Direction); };
        constexpr int steps = 4000;
        const double step = (rays[ray].Max - rays[ray].Min) / steps;
        double before = evaluate(rays[ray].Min);
        double first = std::numeric_limits<double>::infinity();
        for (int at = 1; at <= steps && std::isinf(first); ++at)
        {
          const double value = evaluate(rays[ray].Min + at * step);
          for (const double isovalue : traced.Isovalues)
          {
            // Away from it on both sides, so that rounding does not decide.
            if ((before - isovalue) * (value - isovalue) < 0.0 &&
              std::min(std::abs(before - isovalue), std::abs(value - isovalue)) > 1e-5)
            {
              // No hole in between.
              bool isWhole = true;
              for (int part = 1; part < 40; ++part)
              {
                isWhole =
                  isWhole && std::isfinite(evaluate(rays[ray].Min + (at - part / 40.0) * step));
              }
              first = isWhole ? rays[ray].Min + at * step : first;
            }
          }
          before = value;
        }
        if (std::isfinite(first))
        {
          ++crossed;
          ASSERT_TRUE(isFound) << "ray " << ray;
          ASSERT_LE(hits[ray].T, first) << "ray " << ray;
        }
        if (isFound)
        {
          const rt::LatticePlace& at = hits[ray].At;
          double corners[8];
          const bricks::LevelBrick& brick = traced.Published.Levels->Lattice.GetBrick(at.Brick);
          ASSERT_TRUE(traced.Published.GetCorners(brick.Level, at.GetCell(), corners));
          const glm::dvec3 parts(model.GetParts(brick.Level));
          const glm::dvec3 finest(at.GetCell() * model.GetParts(brick.Level));
          double value = 0.0;
          ASSERT_TRUE(traced.Published.GetValue(Index3(finest), at.IndexPoint * parts, value));
          ASSERT_NEAR(value, traced.Isovalues[static_cast<std::size_t>(hits[ray].Isovalue)], 1e-6);
          ASSERT_LE(rays[ray].Min, hits[ray].T);
          ASSERT_GE(rays[ray].Max, hits[ray].T);
        }
      }
    }
  }
  EXPECT_GT(crossed, 500);
}

TEST(LevelSections, TheBricksThatRaysOfABeamMeetAreForeseen)
{
  int met = 0;
  std::size_t foreseen = 0;
  std::size_t all = 0;
  for (unsigned seed = 0; seed < 8; ++seed)
  {
    SCOPED_TRACE(seed);
    const LevelModel model = CreateRandomLevels(seed, false);
    const PublishedLevels published(model);
    rt::LevelField field;
    field.Voxels = published.Levels;
    field.SetIndexToWorld(glm::dmat4(1.0));
    const glm::dvec3 middle = 0.5 * glm::dvec3(model.Roots);
    const std::vector<rt::SectionPlane> planes{ { { 1.0, 0.3, 0.2 }, middle },
      { { 0.1, -0.4, 1.0 }, 0.8 * middle } };
    const rt::LevelSections sections(field, planes);
    const auto create = [&](double x, double y)
    {
      rt::Ray ray;
      ray.Origin = { -9.0, -8.0, -7.0 };
      ray.Direction = middle + glm::dvec3(x, -x, y) - ray.Origin;
      ray.Max = 4.0;
      return ray;
    };
    const rt::Ray corners[4] = { create(0.0, 0.0), create(0.6, 0.0), create(0.6, 0.6),
      create(0.0, 0.6) };
    const rt::SectionBeam beam = sections.FindBeam(corners);
    foreseen += beam.Bricks.size();
    all += field.Voxels->Lattice.GetBrickCount();
    for (int number = 0; number < 100; ++number)
    {
      const rt::Ray ray = create(0.06 * (number % 10 + 0.5), 0.06 * (number / 10 + 0.5));
      rt::LevelSections::Hit hit;
      while (sections.FindNext(ray, {}, hit))
      {
        const auto brick = field.FindBrick(ray.Origin + hit.T * ray.Direction);
        met += std::count(beam.Bricks.begin(), beam.Bricks.end(), brick.Id) == 1;
        EXPECT_TRUE(
          !brick.Segment || std::count(beam.Bricks.begin(), beam.Bricks.end(), brick.Id) == 1);
      }
    }
  }
  EXPECT_GT(met, 400);
  EXPECT_LT(foreseen, all);
}
