// SPDX-License-Identifier: BSD-3-Clause
// What the rooms above know of an object: batches against the same rays one by one.
#include "DSMRayTracing/field/lattice/LatticeSampler.h"
#include "DSMRayTracing/field/lattice/LatticeSurfaces.h"
#include "DSMRayTracing/scene/SurfaceFinder.h"
#include "DSMRayTracing/surface/IsosurfaceTracer.h"
#include "TestVolume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <vector>

namespace
{

using Tracer = rt::IsosurfaceTracer<rt::LatticeField, MemoryStore>;

const bricks::Index3 TracedPoints(37, 41, 34);

TestVolume<float> CreateWaves()
{
  return TestVolume<float>(TracedPoints,
    [](int x, int y, int z)
    { return static_cast<float>(std::sin(0.4 * x) + std::sin(0.5 * y) + std::sin(0.3 * z)); });
}

rt::Ray CreateRay(double u, double v)
{
  rt::Ray ray;
  ray.Origin = { -90.0, -70.0, -80.0 };
  ray.Direction = glm::dvec3(30.0 * u, 40.0 - 10.0 * u, 30.0 * v) - ray.Origin;
  ray.Max = 2.0;
  return ray;
}

struct Batch
{
  Batch()
  {
    for (int index = 0; index < rt::MaxRays; ++index)
    {
      this->Rays[index] = CreateRay((index % 8 + 0.5) / 8.0, (index / 8 + 0.5) / 8.0);
      this->Hits[index].Clear();
    }
  }

  rt::Ray Corners[4] = { CreateRay(0.0, 0.0), CreateRay(1.0, 0.0), CreateRay(1.0, 1.0),
    CreateRay(0.0, 1.0) };
  rt::Ray Rays[rt::MaxRays];
  rt::ObjectHit Hits[rt::MaxRays];
};

/// What all rays with hits meet, asked for together.
std::vector<rt::SurfacePoint> Describe(const Tracer& tracer, const Batch& batch)
{
  std::vector<rt::SurfacePoint> points(rt::MaxRays);
  rt::SurfacePoint* places[rt::MaxRays];
  std::transform(
    points.begin(), points.end(), places, [](rt::SurfacePoint& point) { return &point; });
  const rt::RayMask hit = rt::FindRays(
    ~rt::RayMask{ 0 }, [&](int index) { return batch.Hits[index].GetObject() != nullptr; });
  tracer.Describe(batch.Hits, batch.Rays, nullptr, hit, places);
  return points;
}

class TestIsosurfaceTracer : public testing::Test
{
protected:
  TestIsosurfaceTracer() { this->Object.Look.Surface.Opacity = 0.5f; }

  MemoryStore Store;
  MemoryStore::Worker Worker;
  rt::LatticeIsosurface Object = CreateObject(this->Store, CreateWaves(), { 0.3, 1.1 }, 4);
};

} // namespace

TEST_F(TestIsosurfaceTracer, BatchesFindWhatRaysFindAlone)
{
  for (const bool clipped : { false, true })
  {
    if (clipped)
    {
      rt::ClipRegion::Grid boxes;
      boxes.Lower = { 10.0, 12.0, 9.0 };
      boxes.Upper = { 25.0, 30.0, 22.0 };
      boxes.Kept = 0x5aa555a; // every other box
      this->Object.Clipping.Boxes = boxes;
    }
    const Tracer tracer(this->Store, this->Worker, this->Object);
    Batch together;
    Batch apart;
    Batch alone;
    const auto beam = tracer.FindBeam(together.Corners);
    ASSERT_TRUE(beam && beam->Usable && beam->MayMeet());
    constexpr rt::RayMask wanted = 0xfff0f0ff0137ffffu;
    const rt::RayMask occluded = tracer.FindOccluded(alone.Rays, wanted);
    tracer.FindNext(together.Rays, wanted, beam.get(), together.Hits);
    tracer.FindNext(apart.Rays, wanted, nullptr, apart.Hits);
    EXPECT_GT(beam->Reached, 0u);
    const std::vector<rt::SurfacePoint> described[2] = { Describe(tracer, together),
      Describe(tracer, apart) };
    int hits = 0;
    for (int index = 0; index < rt::MaxRays; ++index)
    {
      SCOPED_TRACE(index);
      const rt::RayMask bit = rt::GetBit(index);
      const bool isOccluded = tracer.FindOccluded(alone.Rays, bit) != 0;
      tracer.FindNext(alone.Rays, wanted & bit, nullptr, alone.Hits);
      const bool found = alone.Hits[index].GetObject() == &tracer;
      EXPECT_EQ((occluded & bit) != 0, found);
      EXPECT_EQ(isOccluded && (wanted & bit) != 0, found);
      for (Batch* other : { &together, &apart })
      {
        ASSERT_EQ(other->Hits[index].GetObject(), alone.Hits[index].GetObject());
        EXPECT_EQ(other->Rays[index].Max, alone.Rays[index].Max);
        if (found)
        {
          rt::SurfacePoint expected;
          rt::SurfacePoint* const place = &expected;
          tracer.Describe(&alone.Hits[index], &alone.Rays[index], nullptr, 1, &place);
          const rt::SurfacePoint& point = described[other == &apart].at(index);
          EXPECT_EQ(point.T, alone.Rays[index].Max);
          EXPECT_EQ(point.Position, expected.Position);
          EXPECT_EQ(point.Normal, expected.Normal);
          EXPECT_EQ(
            tracer.FindBrick(other->Hits[index]).Id, tracer.FindBrick(alone.Hits[index]).Id);
        }
      }
      hits += found;
    }
    EXPECT_GT(hits, 20);
  }
}

TEST_F(TestIsosurfaceTracer, OfEquallyNearHitsThatOfTheFirstObjectCounts)
{
  const Tracer first(this->Store, this->Worker, this->Object);
  const Tracer second(this->Store, this->Worker, this->Object);
  rt::Ray ray;
  ray.Max = 3.0;
  rt::ObjectHit nearest;
  nearest.Clear();
  rt::LatticeHit hit;
  hit.T = 3.0;
  nearest.Take(first, hit, ray);
  EXPECT_EQ(nearest.GetObject(), &first) << "a hit at the end of the ray";
  nearest.Take(second, hit, ray);
  EXPECT_EQ(nearest.GetObject(), &first);
  hit.T = 2.0;
  hit.Isovalue = 5;
  nearest.Take(second, hit, ray);
  EXPECT_EQ(nearest.GetObject(), &second);
  EXPECT_EQ(nearest.Get<rt::LatticeHit>().Isovalue, 5);
  EXPECT_EQ(ray.Max, 2.0);
}

TEST_F(TestIsosurfaceTracer, WhatIsInvisibleIsNotMet)
{
  const Tracer seen(this->Store, this->Worker, this->Object);
  rt::LatticeIsosurface invisible = this->Object;
  invisible.Look.Surface.Opacity = 0.0f;
  const Tracer none(this->Store, this->Worker, invisible);
  const rt::SurfaceFinder finder({ &none, &seen });
  Batch batch;
  rt::SceneBeam beam;
  beam.Objects.push_back(none.FindBeam(batch.Corners));
  beam.Objects.push_back(seen.FindBeam(batch.Corners));
  ASSERT_TRUE(beam.IsUsable() && beam.MayMeet());
  const rt::RayMask found = finder.Find(batch.Rays, ~rt::RayMask{ 0 }, &beam, batch.Hits);
  EXPECT_GT(rt::GetCount(found), 20);
  rt::ForEachRay(
    found, [&](int index) { EXPECT_EQ(batch.Hits[index].GetObject(), &seen) << index; });
}

TEST_F(TestIsosurfaceTracer, AsksForTheFirstBricksOfABeam)
{
  const Tracer tracer(this->Store, this->Worker, this->Object);
  const auto beam = tracer.FindBeam(Batch().Corners);
  std::vector<dsm::BlockId> all;
  for (const auto& brick : dynamic_cast<const rt::BeamBricks&>(*beam).Bricks)
  {
    all.push_back(brick.Id);
  }
  ASSERT_GT(all.size(), 3u);
  tracer.Prefetch(*beam, 3);
  EXPECT_EQ(this->Store.Prefetched, std::vector<dsm::BlockId>(all.begin(), all.begin() + 3));
  tracer.Prefetch(*beam, all.size() + 5);
  EXPECT_EQ(this->Store.Prefetched, all);
  this->Store.Prefetched.clear();
  this->Object.Look.Surface.Opacity = 0.0f;
  tracer.Prefetch(*beam, 3);
  EXPECT_TRUE(this->Store.Prefetched.empty());
}

TEST_F(TestIsosurfaceTracer, NeighborsLieInTheRow)
{
  constexpr int edge = 4;
  const std::set<int> onSurface{ 1, 2, 3, 6, 7, 8, 9 }; // of ten bricks in a row
  const TestVolume<float> row({ 10 * edge + 1, edge + 1, edge + 1 },
    [&](int x, int y, int)
    { return x % edge != 0 && onSurface.count(x / edge) > 0 ? static_cast<float>(y) : 0.0f; });
  this->Object = CreateObject(this->Store, row, { 1.5 }, edge);
  const Tracer tracer(this->Store, this->Worker, this->Object);
  const auto findNeighbors = [&](dsm::BlockId id)
  {
    rt::BeamBricks beam;
    beam.Bricks.push_back({ id, {}, {} });
    tracer.Prefetch(beam, 1);
    EXPECT_EQ(this->Store.Prefetched, std::vector<dsm::BlockId>{ id });
    return std::set<dsm::BlockId>(this->Store.Neighbors.begin(), this->Store.Neighbors.end());
  };
  using Ids = std::set<dsm::BlockId>;
  EXPECT_EQ(findNeighbors(2), Ids({ 1, 3 })) << "not what lies behind a brick without surface";
  EXPECT_EQ(findNeighbors(6), Ids({ 7 })) << "not what lies in the next part of the row";
  EXPECT_EQ(findNeighbors(9), Ids({ 8 }));
}
