// SPDX-License-Identifier: BSD-3-Clause
#include "TestMesh.h"

#include "tests/support/MeshFile.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>

namespace
{

using namespace TestMesh;

/// Every ray: hit or miss, T, the side and the plane's normal as the oracle has them.
void CompareWithOracle(const bricks::TriangleSource& mesh, const std::vector<rt::Ray>& rays,
  double tolerance, std::uint32_t brickBytes)
{
  TraceAlone(
    mesh,
    [&](const Tracer& tracer, const std::shared_ptr<bricks::TriangleMesh>& published)
    {
      const rt::MeshInstance instance(published, glm::dmat4(1.0));
      int hits = 0;
      for (std::size_t index = 0; index < rays.size(); ++index)
      {
        const Oracle expected = FindByTryingAll(mesh, rays[index]);
        rt::MeshHit hit;
        ASSERT_EQ(tracer.Intersect(instance, rays[index], hit), expected.Found) << "ray " << index;
        if (!expected.Found)
        {
          continue;
        }
        ++hits;
        ASSERT_NEAR(hit.T, expected.T, tolerance * expected.T) << "ray " << index;
        const glm::dvec3 normal = glm::normalize(expected.Normal);
        ASSERT_NEAR(glm::dot(normal, hit.GeometricNormal), 1.0, 1e-3) << "ray " << index;
        ASSERT_EQ(hit.Front, glm::dot(expected.Normal, rays[index].Direction) < 0.0);
      }
      EXPECT_GT(hits, static_cast<int>(rays.size()) / 10);
    },
    brickBytes);
}

/// What the bricks hold: positions in single precision.
template <class Real>
TriangleArrays<Real> RoundToFloat(TriangleArrays<Real> mesh)
{
  for (Real& coordinate : mesh.Positions)
  {
    coordinate = static_cast<float>(coordinate);
  }
  return mesh;
}

} // namespace

TEST(MeshHits, BlobAsTheOracleFindsThem)
{
  CompareWithOracle(RoundToFloat(CreateBlob(3)), CreateRays(3000, 1), 1e-12, 1024);
}

TEST(MeshHits, SoupOfTrianglesOfAllSizes)
{
  CompareWithOracle(RoundToFloat(CreateSoup(1500, 3)), CreateRays(3000, 2), 1e-11, 2048);
}

TEST(MeshHits, OneTriangleABrick)
{
  CompareWithOracle(RoundToFloat(CreateBlob(1)), CreateRays(1000, 5), 1e-12, 1);
}

TEST(MeshHits, LargestBricks)
{
  CompareWithOracle(RoundToFloat(CreateBlob(5)), CreateRays(60, 6), 1e-12, std::uint32_t(1) << 20);
}

TEST(MeshHits, RaysFromWithinAndOfBoundedLength)
{
  const Mesh mesh = RoundToFloat(CreateSoup(800, 9));
  std::vector<rt::Ray> rays = CreateRays(2000, 7);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> uniform(0.0, 8.0);
  for (rt::Ray& ray : rays)
  {
    ray.Min = uniform(random);
    ray.Max = ray.Min + 0.5 * uniform(random);
  }
  CompareWithOracle(mesh, rays, 1e-11, 1024);
}

TEST(MeshHits, RaysAlongTheAxes)
{
  const Mesh mesh = RoundToFloat(CreateBlob(3));
  std::vector<rt::Ray> rays = CreateRays(600, 10);
  for (std::size_t index = 0; index < rays.size(); ++index)
  {
    rt::Ray& ray = rays[index];
    const int axis = static_cast<int>(index % 3);
    ray.Direction = glm::dvec3(0.0);
    ray.Direction[axis] = index % 2 == 0 ? 1.0 : -1.0;
    ray.Origin *= 0.25;
    ray.Origin[axis] = -4.0 * ray.Direction[axis];
  }
  CompareWithOracle(mesh, rays, 1e-12, 1024);
}

TEST(MeshHits, FarAway)
{
  // A camera a million extents away from a mesh a million extents away from the origin.
  Mesh mesh = CreateBlob(2);
  for (std::size_t index = 0; index < mesh.Positions.size(); ++index)
  {
    mesh.Positions[index] = std::ldexp(std::round(std::ldexp(mesh.Positions[index], 20)), -20) +
      (index % 3 == 0 ? 2097152.0 : 0.0);
  }
  const glm::dvec3 center(2097152.0, 0.0, 0.0);
  std::vector<rt::Ray> rays = CreateRays(1000, 11, center);
  for (rt::Ray& ray : rays)
  {
    ray.Direction *= 5.0;
    ray.Origin -= 1e6 * ray.Direction;
    ray.Max = 2e6;
  }
  CompareWithOracle(mesh, rays, 1e-12, 1024);
}

TEST(MeshHits, TinyAndHugeMeshes)
{
  for (const double scale : { 1e-12, 1e12 })
  {
    Mesh mesh = CreateBlob(2);
    for (double& coordinate : mesh.Positions)
    {
      coordinate *= scale;
    }
    CompareWithOracle(RoundToFloat(mesh), CreateRays(500, 12, glm::dvec3(0.0), scale), 1e-12, 1024);
  }
}

TEST(MeshHits, MovedScaledAndMirrored)
{
  const Mesh mesh = RoundToFloat(CreateBlob(3));
  glm::dmat4 matrix = glm::translate(glm::dmat4(1.0), glm::dvec3(100.0, -20.0, 3.0));
  matrix = glm::rotate(matrix, 0.7, glm::normalize(glm::dvec3(1.0, 2.0, -1.0)));
  matrix = glm::scale(matrix, glm::dvec3(-2.0, 0.5, 3.0));
  TraceAlone(mesh,
    [&](const Tracer& tracer, const std::shared_ptr<bricks::TriangleMesh>& published)
    {
      const rt::MeshInstance instance(published, matrix);
      int hits = 0;
      for (const rt::Ray& local : CreateRays(2000, 13))
      {
        rt::Ray ray = local;
        ray.Origin = glm::dvec3(matrix * glm::dvec4(local.Origin, 1.0));
        ray.Direction = glm::dmat3(matrix) * local.Direction;
        const Oracle expected = FindByTryingAll(mesh, local);
        rt::MeshHit hit;
        ASSERT_EQ(tracer.Intersect(instance, ray, hit), expected.Found);
        if (expected.Found)
        {
          ++hits;
          ASSERT_NEAR(hit.T, expected.T, 1e-9);
          // Perpendicular to the moved triangle, and on the side on which it was before.
          for (int corner = 1; corner < 3; ++corner)
          {
            const glm::dvec3 edge = glm::dmat3(matrix) *
              (GetPoint(mesh, expected.Triangle, corner) - GetPoint(mesh, expected.Triangle, 0));
            ASSERT_NEAR(glm::dot(glm::normalize(edge), hit.GeometricNormal), 0.0, 1e-5);
          }
          ASSERT_EQ(hit.Front, glm::dot(expected.Normal, local.Direction) < 0.0);
          ASSERT_EQ(hit.Front, glm::dot(hit.GeometricNormal, ray.Direction) < 0.0);
        }
      }
      EXPECT_GT(hits, 1000);
    });
}

TEST(MeshHits, Culling)
{
  TraceAlone(RoundToFloat(CreateBlob(3)),
    [&](const Tracer& tracer, const std::shared_ptr<bricks::TriangleMesh>& published)
    {
      rt::MeshInstance instance(published, glm::dmat4(1.0));
      int both = 0;
      for (const rt::Ray& ray : CreateRays(1000, 14))
      {
        rt::MeshHit any;
        rt::MeshHit front;
        rt::MeshHit back;
        rt::MeshHit none;
        instance.Culling = {};
        const bool hasAny = tracer.Intersect(instance, ray, any);
        instance.Culling.Back = true;
        const bool hasFront = tracer.Intersect(instance, ray, front);
        instance.Culling.Front = true;
        EXPECT_FALSE(tracer.Intersect(instance, ray, none));
        instance.Culling.Back = false;
        const bool hasBack = tracer.Intersect(instance, ray, back);
        // Closed and turned outward: whatever is hit shows its front first, then its back.
        ASSERT_EQ(hasAny, hasFront);
        ASSERT_EQ(hasAny, hasBack);
        if (hasAny)
        {
          ++both;
          EXPECT_EQ(any.T, front.T);
          EXPECT_TRUE(front.Front);
          EXPECT_FALSE(back.Front);
          EXPECT_GT(back.T, front.T);
        }
      }
      EXPECT_GT(both, 500);
    });
}

TEST(MeshHits, RaysThatCannotHit)
{
  TraceAlone(CreateBlob(2),
    [&](const Tracer& tracer, const std::shared_ptr<bricks::TriangleMesh>& published)
    {
      const rt::MeshInstance instance(published, glm::dmat4(1.0));
      const double nan = std::numeric_limits<double>::quiet_NaN();
      rt::MeshHit hit;
      for (const glm::dvec3& direction :
        { glm::dvec3(0.0), glm::dvec3(nan, 0.0, 1.0), glm::dvec3(1e300 * 1e300, 0.0, 0.0) })
      {
        rt::Ray ray;
        ray.Origin = { 0.0, 0.0, -3.0 };
        ray.Direction = direction;
        ray.Max = 10.0;
        EXPECT_FALSE(tracer.Intersect(instance, ray, hit));
      }
      rt::Ray ray;
      ray.Origin = { nan, 0.0, -3.0 };
      ray.Max = 10.0;
      EXPECT_FALSE(tracer.Intersect(instance, ray, hit));
      ray.Origin = { 0.1, 0.1, -3.0 };
      EXPECT_TRUE(tracer.Intersect(instance, ray, hit));
      ray.Max = 1.0;
      EXPECT_FALSE(tracer.Intersect(instance, ray, hit));
    });
}

/// The scanned meshes, where they are at hand.
class ScannedMesh : public testing::TestWithParam<const char*>
{
};

TEST_P(ScannedMesh, HitsAndBytes)
{
  const char* folder = std::getenv("DSM_TEST_DATA");
  const std::filesystem::path path =
    std::filesystem::path(folder ? folder : DSM_DEFAULT_TEST_DATA) / GetParam();
  if (!std::filesystem::exists(path))
  {
    GTEST_SKIP() << path << " is not there; DSM_TEST_DATA names the folder of the data";
  }
  MeshFile::Mesh mesh = MeshFile::Read(path.string());
  MeshFile::AddNormals(mesh);
  mesh.Values.assign(mesh.GetPointCount(), 1.0);
  TraceAlone(
    mesh,
    [&](const Tracer& tracer, const std::shared_ptr<bricks::TriangleMesh>& published)
    {
      EXPECT_EQ(published->Triangles + published->Dropped, mesh.GetTriangleCount());
      const double bytes = static_cast<double>(published->Segment->GetDirectory().GetTotalBytes()) +
        static_cast<double>(published->Bricks.GetBytes());
      EXPECT_LT(bytes / static_cast<double>(published->Triangles), 90.0);
      RecordProperty(
        "bytes_per_triangle", std::to_string(bytes / static_cast<double>(published->Triangles)));
      const glm::dvec3 center = published->Origin + 0.5 * (published->Lower + published->Upper);
      const double radius = 0.5 * glm::length(published->Upper - published->Lower);
      const rt::MeshInstance instance(published, glm::dmat4(1.0));
      int hits = 0;
      for (const rt::Ray& ray : CreateRays(150, 15, center, 0.5 * radius))
      {
        const Oracle expected = FindByTryingAll(mesh, ray);
        rt::MeshHit hit;
        ASSERT_EQ(tracer.Intersect(instance, ray, hit), expected.Found);
        if (expected.Found)
        {
          ++hits;
          ASSERT_NEAR(hit.T, expected.T, 1e-10 * expected.T);
        }
      }
      EXPECT_GT(hits, 15);
    },
    std::uint32_t(32) << 10);
}

INSTANTIATE_TEST_SUITE_P(Data, ScannedMesh,
  testing::Values("stanford_bunny.ply", "stanford_dragon_res2.ply", "stanford_armadillo.ply",
    "turbineblade.ply", "utah_teapot.obj"),
  [](const auto& info)
  {
    std::string name = info.param;
    std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return name;
  });
