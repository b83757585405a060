// SPDX-License-Identifier: BSD-3-Clause
#include "TestMesh.h"

#include "DSMRayTracing/mesh/TriangleIntersector.h"

#include <gtest/gtest.h>

#include <limits>

namespace
{

using namespace TestMesh;

/// From within a closed mesh around `center` every ray must meet the surface; here those through
/// its points and edges, as exactly as doubles allow, wherever bricks end.
void ExpectClosed(const Mesh& mesh, const glm::dvec3& center, std::uint32_t brickBytes)
{
  TraceAlone(
    mesh,
    [&](const Tracer& tracer, const std::shared_ptr<bricks::TriangleMesh>& published)
    {
      EXPECT_GT(published->Segment->GetDirectory().GetCount(), 10u);
      const rt::MeshInstance instance(published, glm::dmat4(1.0));
      std::uint64_t missed = 0;
      std::uint64_t wrongSide = 0;
      for (std::uint64_t triangle = 0; triangle < mesh.GetTriangleCount(); ++triangle)
      {
        for (int corner = 0; corner < 3; ++corner)
        {
          // What the bricks hold.
          const glm::dvec3 a(glm::vec3(GetPoint(mesh, triangle, corner) - published->Origin));
          const glm::dvec3 b(
            glm::vec3(GetPoint(mesh, triangle, (corner + 1) % 3) - published->Origin));
          for (const double weight : { 0.0, 0.25, 0.5, 0.7 })
          {
            for (const glm::dvec3& offset :
              { glm::dvec3(0.0), glm::dvec3(0.25, -0.125, 0.3), glm::dvec3(-0.31, 0.2, -0.17) })
            {
              rt::Ray ray;
              ray.Origin = center + offset;
              ray.Direction = a + weight * (b - a) + (published->Origin - ray.Origin);
              ray.Max = std::numeric_limits<double>::infinity();
              rt::MeshHit hit;
              missed += tracer.Intersect(instance, ray, hit) ? 0 : 1;
              wrongSide += hit.Front ? 1 : 0;
            }
          }
        }
      }
      EXPECT_EQ(missed, 0u);
      EXPECT_EQ(wrongSide, 0u);
    },
    brickBytes);
}

} // namespace

TEST(Watertight, RaysThroughAllPointsAndEdges)
{
  ExpectClosed(CreateBlob(4), glm::dvec3(0.0), 1024);
}

TEST(Watertight, SingleTrianglesInBricks)
{
  ExpectClosed(CreateBlob(2), glm::dvec3(0.0), 1);
}

TEST(Watertight, FarFromTheOrigin)
{
  const double far = 1 << 20;
  Mesh mesh = CreateBlob(3);
  for (double& coordinate : mesh.Positions)
  {
    coordinate += far;
  }
  ExpectClosed(mesh, glm::dvec3(far), 1024);
}

TEST(Watertight, GridWhoseEdgesLieInThePixelsPlanes)
{
  // All rays go exactly along edges or through points of a flat grid, where edge functions vanish.
  const int n = 16;
  Mesh mesh = CreateTerrain(n);
  for (std::size_t z = 2; z < mesh.Positions.size(); z += 3)
  {
    mesh.Positions[z] = 0.0;
  }
  TraceAlone(
    mesh,
    [&](const Tracer& tracer, const std::shared_ptr<bricks::TriangleMesh>& published)
    {
      const rt::MeshInstance instance(published, glm::dmat4(1.0));
      for (int j = 0; j <= 4 * n; ++j)
      {
        for (int i = 0; i <= 4 * n; ++i)
        {
          rt::Ray ray;
          ray.Origin = { i / (4.0 * n), j / (4.0 * n), 2.0 };
          ray.Direction = { 0.0, 0.0, -1.0 };
          ray.Max = 10.0;
          rt::MeshHit hit;
          ASSERT_TRUE(tracer.Intersect(instance, ray, hit)) << i << ", " << j;
          EXPECT_EQ(hit.T, 2.0);
          EXPECT_TRUE(hit.Front);
        }
      }
    },
    512);
}

TEST(Watertight, EdgesAndPointsGiveTheSameHitHoweverTheMeshIsCut)
{
  // Each is met in two triangles or more, at the same T or nearly.
  Mesh mesh = CreateBlob(3);
  for (double& coordinate : mesh.Positions)
  {
    coordinate = static_cast<float>(coordinate);
  }
  std::vector<std::vector<double>> hits;
  for (const std::uint32_t brickBytes : { 1u, 500u, 2000u, 1u << 20 })
  {
    hits.emplace_back();
    TraceAlone(
      mesh,
      [&](const Tracer& tracer, const std::shared_ptr<bricks::TriangleMesh>& published)
      {
        const rt::MeshInstance instance(published, glm::dmat4(1.0));
        for (std::uint64_t triangle = 0; triangle < mesh.GetTriangleCount(); ++triangle)
        {
          const glm::dvec3 a = GetPoint(mesh, triangle, 0);
          const glm::dvec3 b = GetPoint(mesh, triangle, 1);
          for (const glm::dvec3& point : { a, 0.5 * (a + b), a + 0.25 * (b - a) })
          {
            for (const double side : { 1.0, -1.0 })
            {
              rt::Ray ray;
              ray.Origin = point + glm::dvec3(0.0, 0.0, 4.0 * side);
              ray.Direction = { 0.0, 0.0, -side };
              ray.Max = 10.0;
              rt::MeshHit hit;
              const bool found = tracer.Intersect(instance, ray, hit);
              hits.back().insert(hits.back().end(),
                { found ? hit.T : -1.0, hit.GeometricNormal.x, hit.GeometricNormal.y, hit.Weights.x,
                  hit.Weights.y });
            }
          }
        }
      },
      brickBytes);
    EXPECT_EQ(hits.back(), hits.front()) << brickBytes;
  }
}

TEST(TriangleIntersector, TiesGoToTheSmallerCorners)
{
  rt::TriangleHit a;
  rt::TriangleHit b;
  b.Corners[1][2] = 1.0f;
  EXPECT_TRUE(rt::ComesFirst(a, b));
  EXPECT_FALSE(rt::ComesFirst(b, a));
  EXPECT_FALSE(rt::ComesFirst(a, a));
  a.Corners[1][1] = 0.5f;
  EXPECT_FALSE(rt::ComesFirst(a, b));
}

TEST(TriangleIntersector, WeightsAndSides)
{
  const float a[3] = { 0.0f, 0.0f, 0.0f };
  const float b[3] = { 1.0f, 0.0f, 0.0f };
  const float c[3] = { 0.0f, 1.0f, 0.0f };
  const double lower[3] = { 0.0, 0.0, 0.0 };
  const double upper[3] = { 1.0, 1.0, 0.0 };
  rt::ShearedRay ray;
  for (const double side : { 1.0, -1.0 })
  {
    const double origin[3] = { 0.25, 0.5, 3.0 * side };
    const double direction[3] = { 0.0, 0.0, -1.5 * side };
    ASSERT_TRUE(ray.Set(origin, direction, 0.0, 10.0, lower, upper));
    rt::TriangleHit hit;
    ASSERT_TRUE(rt::IntersectTriangle(ray.Triangles, a, b, c, hit));
    EXPECT_EQ(hit.T, 2.0);
    EXPECT_EQ(hit.Front, side > 0.0);
    EXPECT_DOUBLE_EQ(hit.Weights[0], 0.25);
    EXPECT_DOUBLE_EQ(hit.Weights[1], 0.25);
    EXPECT_DOUBLE_EQ(hit.Weights[2], 0.5);
    // Within the plane, and a triangle without area.
    EXPECT_FALSE(rt::IntersectTriangle(ray.Triangles, a, b, b, hit));
    ray.Triangles.Max = 1.9;
    EXPECT_FALSE(rt::IntersectTriangle(ray.Triangles, a, b, c, hit));
  }
  const double origin[3] = { -1.0, 0.2, 0.0 };
  const double direction[3] = { 1.0, 0.0, 0.0 };
  ASSERT_TRUE(ray.Set(origin, direction, 0.0, 10.0, lower, upper));
  rt::TriangleHit hit;
  EXPECT_FALSE(rt::IntersectTriangle(ray.Triangles, a, b, c, hit));
}
