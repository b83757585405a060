// SPDX-License-Identifier: BSD-3-Clause
#include "TestMesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <mutex>
#include <string>

namespace
{

using namespace TestMesh;

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();
constexpr double Infinity = std::numeric_limits<double>::infinity();

/// The error that every rank gets when rank r publishes pieces[r]; the store works on afterwards.
std::string GetError(const std::vector<const bricks::TriangleSource*>& pieces,
  const bricks::TriangleMeshSettings& settings = {})
{
  std::vector<std::string> errors(pieces.size());
  RunOnCluster(static_cast<int>(pieces.size()),
    [&](dsm::Messenger& messenger)
    {
      dsm::ObjectStore store(messenger, { std::size_t(1) << 20, 1 });
      try
      {
        bricks::PublishMesh("mesh", *pieces[messenger.GetRank()], settings, store, messenger);
      }
      catch (const dsm::Error& error)
      {
        errors[messenger.GetRank()] = error.what();
      }
      const Mesh good = TakePart(CreateBlob(2), messenger.GetRank(), messenger.GetSize(), 1);
      EXPECT_EQ(bricks::PublishMesh("mesh", good, {}, store, messenger)->Triangles, 320u);
      TraceOnWorker(store, messenger, [](dsm::ObjectStore::Worker&) {});
    });
  for (const std::string& error : errors)
  {
    EXPECT_EQ(error, errors.front());
  }
  return errors.front();
}

/// Claims to have very many triangles.
class BoundlessSource final : public bricks::TriangleSource
{
public:
  bricks::MeshAttributes GetAttributes() const override { return {}; }
  std::uint64_t GetTriangleCount() const override { return std::uint64_t(1) << 31; }
  std::uint64_t GetPointCount() const override { return 3; }
  void GetTriangle(std::uint64_t, std::uint64_t*) const override { throw dsm::Error("was read"); }
  void GetPosition(std::uint64_t, double*) const override {}
  void GetNormal(std::uint64_t, double*) const override {}
  double GetValue(std::uint64_t) const override { return 0.0; }
  void GetColor(std::uint64_t, std::uint8_t*) const override {}
  void GetTextureCoordinate(std::uint64_t, double*) const override {}
  unsigned GetEdgeFlags(std::uint64_t) const override { return bricks::AllEdges; }
  double GetRadius(std::uint64_t, int) const override { return 0.0; }
};

} // namespace

TEST(MeshInput, EmptyOnAllRanks)
{
  for (const int ranks : { 1, 3 })
  {
    RunOnCluster(ranks,
      [](dsm::Messenger& messenger)
      {
        dsm::ObjectStore store(messenger, { std::size_t(1) << 20, 1 });
        const auto published = bricks::PublishMesh("mesh", Mesh(), {}, store, messenger);
        EXPECT_EQ(published->Triangles, 0u);
        EXPECT_TRUE(published->Bricks.IsEmpty());
        TraceOnWorker(store, messenger,
          [&](dsm::ObjectStore::Worker& worker)
          {
            const Tracer tracer(store, worker);
            rt::Ray ray;
            ray.Max = 10.0;
            rt::MeshHit hit;
            EXPECT_FALSE(tracer.Intersect(rt::MeshInstance(published, glm::dmat4(1.0)), ray, hit));
          });
      });
  }
}

TEST(MeshInput, WhatCannotBeHitIsLeftOut)
{
  Mesh mesh = CreateBlob(2);
  const std::uint64_t good = mesh.GetTriangleCount();
  const std::uint64_t points = mesh.GetPointCount();
  // Unused points far away, and points that are not finite.
  mesh.Positions.insert(mesh.Positions.end(),
    { 1e30, 0.0, 0.0, NaN, 0.0, 0.0, 0.0, Infinity, 0.0, 2.0, 0.0, 0.0, 3.0, 0.0, 0.0, 4.0, 0.0,
      0.0 });
  mesh.Triangles.insert(mesh.Triangles.end(),
    { 0, 1, points + 1,                      // a point that is not a number
      0, points + 2, 1,                      // an infinite one
      5, 5, 6, 5, 5, 5,                      // points that coincide
      points + 3, points + 4, points + 5 }); // on one line
  TraceAlone(mesh,
    [&](const Tracer& tracer, const std::shared_ptr<bricks::TriangleMesh>& published)
    {
      EXPECT_EQ(published->Triangles, good);
      EXPECT_EQ(published->Dropped, 5u);
      const rt::MeshInstance instance(published, glm::dmat4(1.0));
      const Mesh clean = CreateBlob(2);
      for (const rt::Ray& ray : CreateRays(500, 41))
      {
        const Oracle expected = FindByTryingAll(clean, ray);
        rt::MeshHit hit;
        ASSERT_EQ(tracer.Intersect(instance, ray, hit), expected.Found);
        if (expected.Found)
        {
          ASSERT_NEAR(hit.T, expected.T, 1e-5);
        }
      }
    });
}

TEST(MeshInput, OnlyWhatCannotBeHit)
{
  Mesh mesh;
  mesh.Positions = { 0.0, 0.0, 0.0, NaN, 1.0, 1.0, 5.0, 5.0, 5.0 };
  mesh.Triangles = { 0, 1, 2, 0, 0, 2 };
  TraceAlone(mesh,
    [&](const Tracer&, const std::shared_ptr<bricks::TriangleMesh>& published)
    {
      EXPECT_EQ(published->Triangles, 0u);
      EXPECT_EQ(published->Dropped, 2u);
    });
}

TEST(MeshInput, NearlyFlatTrianglesAreHarmless)
{
  // Slivers of the width of a rounding error among others.
  Mesh mesh = CreateBlob(2);
  const std::uint64_t triangles = mesh.GetTriangleCount();
  for (std::uint64_t triangle = 0; triangle < triangles; ++triangle)
  {
    const glm::dvec3 a = GetPoint(mesh, triangle, 0);
    const glm::dvec3 b = GetPoint(mesh, triangle, 1);
    const glm::dvec3 middle = 0.5 * (a + b);
    mesh.Triangles.insert(mesh.Triangles.end(),
      { mesh.Triangles[3 * triangle], mesh.GetPointCount(), mesh.Triangles[3 * triangle + 1] });
    mesh.Positions.insert(mesh.Positions.end(), { middle.x, middle.y, middle.z });
  }
  const Mesh clean = CreateBlob(2);
  TraceAlone(mesh,
    [&](const Tracer& tracer, const std::shared_ptr<bricks::TriangleMesh>& published)
    {
      const rt::MeshInstance instance(published, glm::dmat4(1.0));
      for (const rt::Ray& ray : CreateRays(2000, 42))
      {
        const Oracle expected = FindByTryingAll(clean, ray);
        rt::MeshHit hit;
        ASSERT_EQ(tracer.Intersect(instance, ray, hit), expected.Found);
        if (expected.Found)
        {
          ASSERT_NEAR(hit.T, expected.T, 1e-4);
          ASSERT_NEAR(glm::length(hit.Normal), 1.0, 1e-6);
        }
      }
    });
}

TEST(MeshInput, MoreTrianglesInOnePlaceThanABrickHolds)
{
  // One centroid: no cut of space parts them.
  Mesh mesh;
  mesh.Positions = { 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0 };
  for (int copy = 0; copy < 20000; ++copy)
  {
    mesh.Triangles.insert(mesh.Triangles.end(), { 0, 1, 2 });
    mesh.Values.push_back(copy % 5000);
  }
  mesh.ValuesOf = bricks::Attachment::Triangles;
  TraceAlone(
    mesh,
    [&](const Tracer& tracer, const std::shared_ptr<bricks::TriangleMesh>& published)
    {
      EXPECT_EQ(published->Triangles, 20000u);
      EXPECT_GT(published->Segment->GetDirectory().GetCount(), 2u);
      rt::Ray ray;
      ray.Origin = { 0.25, 0.25, 1.0 };
      ray.Direction = { 0.0, 0.0, -1.0 };
      ray.Max = 5.0;
      rt::MeshHit hit;
      ASSERT_TRUE(tracer.Intersect(rt::MeshInstance(published, glm::dmat4(1.0)), ray, hit));
      EXPECT_EQ(hit.T, 1.0);
    },
    std::uint32_t(32) << 10);
}

TEST(MeshInput, OneTriangle)
{
  Mesh mesh;
  mesh.Positions = { 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0 };
  mesh.Triangles = { 1, 2, 0 };
  TraceAlone(mesh,
    [&](const Tracer& tracer, const std::shared_ptr<bricks::TriangleMesh>& published)
    {
      EXPECT_EQ(published->Segment->GetDirectory().GetCount(), 1u);
      rt::Ray ray;
      ray.Origin = { 0.25, 0.25, 1.0 };
      ray.Direction = { 0.0, 0.0, -1.0 };
      ray.Max = 5.0;
      rt::MeshHit hit;
      ASSERT_TRUE(tracer.Intersect(rt::MeshInstance(published, glm::dmat4(1.0)), ray, hit));
      EXPECT_EQ(hit.Normal, glm::dvec3(0.0, 0.0, 1.0));
      EXPECT_TRUE(hit.Front);
    });
}

TEST(MeshInput, CoordinatesThatAreFloatsAreKeptExactly)
{
  Mesh mesh = CreateBlob(2);
  for (double& coordinate : mesh.Positions)
  {
    coordinate = static_cast<float>(123456.0 + coordinate);
  }
  TraceAlone(mesh,
    [&](const Tracer&, const std::shared_ptr<bricks::TriangleMesh>& published)
    {
      EXPECT_NE(published->Origin, glm::dvec3(0.0));
      std::vector<double> expected = mesh.Positions;
      std::vector<double> found;
      published->Segment->ForEachResident(
        [&](dsm::BlockId, const std::byte* block, std::size_t)
        {
          const bricks::TriangleBrick brick(block);
          for (int vertex = 0; vertex < brick.GetHeader().Vertices; ++vertex)
          {
            for (int axis = 0; axis < 3; ++axis)
            {
              found.push_back(brick.GetVertices()[vertex].Position[axis] + published->Origin[axis]);
            }
          }
        });
      for (std::vector<double>* numbers : { &expected, &found })
      {
        std::sort(numbers->begin(), numbers->end());
        numbers->erase(std::unique(numbers->begin(), numbers->end()), numbers->end());
      }
      EXPECT_EQ(found, expected);
    });
}

TEST(MeshInput, TooManyTrianglesAreRefusedBeforeTheyAreRead)
{
  const BoundlessSource boundless;
  const Mesh none;
  bricks::TriangleMeshSettings settings;
  settings.MemoryBytes = std::uint64_t(1) << 30;
  const std::string error = GetError({ &none, &boundless }, settings);
  EXPECT_NE(error.find("2147483648 triangles"), std::string::npos) << error;
  // 32 bytes to sort it, 36 to send it, and about 20 in its brick.
  EXPECT_NE(error.find("at least 178 ranks"), std::string::npos) << error;
}

TEST(MeshInput, PiecesMustHaveTheSameAttributes)
{
  const Mesh plain = CreateBlob(1);
  Mesh withValues = plain;
  withValues.Values.assign(plain.GetPointCount(), 1.0);
  const Mesh none;
  const std::string error = GetError({ &none, &plain, &withValues });
  EXPECT_NE(error.find("ranks 1 and 2"), std::string::npos) << error;
}

TEST(MeshInput, PointThatDoesNotExist)
{
  const Mesh good = CreateBlob(1);
  Mesh bad = good;
  bad.Triangles[4] = 1000;
  const std::string error = GetError({ &good, &bad });
  EXPECT_NE(error.find("Rank 1"), std::string::npos) << error;
  EXPECT_NE(error.find("point 1000"), std::string::npos) << error;
}

TEST(MeshInput, CoordinatesOutOfRange)
{
  Mesh mesh = CreateBlob(1);
  mesh.Positions[0] = 1e31;
  const std::string error = GetError({ &mesh });
  EXPECT_NE(error.find("1e30"), std::string::npos) << error;
}

/// A galaxy in centimeters: beyond what products of floats can hold.
TEST(MeshInput, LargeCoordinatesGiveTheSameHits)
{
  const auto trace = [](double scale)
  {
    Mesh mesh = CreateBlob(2);
    std::transform(mesh.Positions.begin(), mesh.Positions.end(), mesh.Positions.begin(),
      [&](double position) { return (position + 3.0) * scale; });
    std::vector<double> hits;
    TraceAlone(mesh,
      [&](const Tracer& tracer, const std::shared_ptr<bricks::TriangleMesh>& published)
      {
        const rt::MeshInstance instance(published, glm::dmat4(1.0));
        for (int number = 0; number < 100; ++number)
        {
          rt::Ray ray;
          ray.Origin =
            scale * glm::dvec3(2.05 + 0.2 * (number % 10), 2.07 + 0.2 * (number / 10), 9.0);
          ray.Direction = { 0.0, 0.0, -1.0 };
          ray.Max = 20.0 * scale;
          rt::MeshHit hit;
          hits.push_back(tracer.Intersect(instance, ray, hit) ? hit.T / scale : -1.0);
        }
      });
    return hits;
  };
  const std::vector<double> expected = trace(1.0);
  EXPECT_GT(*std::max_element(expected.begin(), expected.end()), 0.0);
  for (const double scale : { 0x1p60, 0x1p66, 0x1p80, 0x1p97 })
  {
    const std::vector<double> found = trace(scale);
    for (std::size_t number = 0; number < expected.size(); ++number)
    {
      EXPECT_NEAR(found[number], expected[number], 1e-9) << scale << " ray " << number;
    }
  }
}
