// SPDX-License-Identifier: BSD-3-Clause
#include "TestMesh.h"

#include "DSMBricks/layout/OctahedralNormal.h"

#include <gtest/gtest.h>

#include <glm/trigonometric.hpp>

#include <cmath>
#include <limits>

namespace
{

using namespace TestMesh;

/// Traces straight down on the terrain; calls check(x, y, hit).
void LookDown(const Mesh& mesh,
  const std::function<void(double x, double y, const Oracle& oracle, const rt::MeshHit& hit)>&
    check)
{
  TraceAlone(mesh,
    [&](const Tracer& tracer, const std::shared_ptr<bricks::TriangleMesh>& published)
    {
      const rt::MeshInstance instance(published, glm::dmat4(1.0));
      std::mt19937 random(51);
      std::uniform_real_distribution<double> uniform(0.01, 0.99);
      for (int count = 0; count < 500; ++count)
      {
        rt::Ray ray;
        ray.Origin = { uniform(random), uniform(random), 2.0 };
        ray.Direction = { 0.0, 0.0, -1.0 };
        ray.Max = 10.0;
        rt::MeshHit hit;
        ASSERT_TRUE(tracer.Intersect(instance, ray, hit));
        check(ray.Origin.x, ray.Origin.y, FindByTryingAll(mesh, ray), hit);
      }
    });
}

} // namespace

TEST(OctahedralNormal, WithinAHundredthOfADegree)
{
  std::mt19937 random(52);
  std::normal_distribution<double> normal;
  for (int count = 0; count < 20000; ++count)
  {
    const glm::dvec3 direction =
      glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    glm::vec3 unpacked;
    const glm::dvec3 longer = 7.0 * direction;
    bricks::OctahedralNormal::Unpack(bricks::OctahedralNormal::Pack(&longer.x), &unpacked.x);
    const double sine = glm::length(glm::cross(glm::normalize(glm::dvec3(unpacked)), direction));
    ASSERT_LT(glm::degrees(std::asin(sine)), 0.01);
    ASSERT_GT(glm::dot(glm::dvec3(unpacked), direction), 0.0);
  }
}

TEST(OctahedralNormal, AxesAndNoDirection)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const double sign : { 1.0, -1.0 })
    {
      glm::dvec3 direction(0.0);
      direction[axis] = sign;
      glm::vec3 unpacked;
      bricks::OctahedralNormal::Unpack(bricks::OctahedralNormal::Pack(&direction.x), &unpacked.x);
      EXPECT_NEAR(glm::distance(glm::dvec3(unpacked), direction), 0.0, 1e-6);
    }
  }
  const double zero[3] = { 0.0, 0.0, 0.0 };
  const double nan[3] = { 1.0, std::numeric_limits<double>::quiet_NaN(), 0.0 };
  EXPECT_EQ(bricks::OctahedralNormal::Pack(zero), bricks::OctahedralNormal::None);
  EXPECT_EQ(bricks::OctahedralNormal::Pack(nan), bricks::OctahedralNormal::None);
}

TEST(MeshAttributes, OfPointsAreInterpolated)
{
  LookDown(CreateTerrain(12),
    [](double x, double y, const Oracle&, const rt::MeshHit& hit)
    {
      EXPECT_NEAR(hit.Value, 3.0 * x - 2.0 * y, 1e-5);
      EXPECT_NEAR(hit.TextureCoordinate.x, 2.0 * x, 1e-5);
      EXPECT_NEAR(hit.TextureCoordinate.y, 1.0 - y, 1e-5);
      EXPECT_NEAR(hit.Color.x, x, 0.005);
      EXPECT_NEAR(hit.Color.y, y, 0.005);
      EXPECT_NEAR(hit.Color.z, 10.0 / 255.0, 1e-5);
      EXPECT_NEAR(hit.Color.w, 200.0 / 255.0, 1e-5);
      EXPECT_NEAR(hit.Weights.x + hit.Weights.y + hit.Weights.z, 1.0, 1e-12);
    });
}

TEST(MeshAttributes, NormalsAreInterpolatedAsUnitVectors)
{
  const Mesh mesh = CreateTerrain(12);
  LookDown(mesh,
    [&](double, double, const Oracle& oracle, const rt::MeshHit& hit)
    {
      std::uint64_t points[3];
      mesh.GetTriangle(oracle.Triangle, points);
      glm::dvec3 expected(0.0);
      for (int corner = 0; corner < 3; ++corner)
      {
        glm::dvec3 normal;
        mesh.GetNormal(points[corner], &normal.x);
        expected += oracle.Weights[corner] * glm::normalize(normal);
      }
      EXPECT_NEAR(glm::distance(hit.Normal, glm::normalize(expected)), 0.0, 1e-4);
      EXPECT_NEAR(glm::distance(hit.GeometricNormal, glm::normalize(oracle.Normal)), 0.0, 1e-4);
    });
}

TEST(MeshAttributes, OfTrianglesAreExact)
{
  Mesh mesh = CreateTerrain(12);
  mesh.ValuesOf = bricks::Attachment::Triangles;
  mesh.ColorsOf = bricks::Attachment::Triangles;
  mesh.Values.clear();
  mesh.Colors.clear();
  for (std::uint64_t triangle = 0; triangle < mesh.GetTriangleCount(); ++triangle)
  {
    mesh.Values.push_back(0.1 * static_cast<double>(triangle));
    mesh.Colors.insert(mesh.Colors.end(), { static_cast<std::uint8_t>(triangle), 0, 255, 128 });
  }
  LookDown(mesh,
    [&](double, double, const Oracle& oracle, const rt::MeshHit& hit)
    {
      EXPECT_EQ(hit.Value, static_cast<float>(mesh.Values[oracle.Triangle]));
      EXPECT_NEAR(hit.Color.x, mesh.Colors[4 * oracle.Triangle] / 255.0, 1e-6);
      EXPECT_NEAR(hit.Color.z, 1.0, 1e-6);
    });
}

TEST(MeshAttributes, NormalsOfTrianglesAreNotInterpolated)
{
  Mesh mesh = CreateTerrain(10);
  mesh.NormalsOf = bricks::Attachment::Triangles;
  mesh.Normals.clear();
  for (std::uint64_t triangle = 0; triangle < mesh.GetTriangleCount(); ++triangle)
  {
    const float x = 0.1f * static_cast<float>(triangle % 7);
    mesh.Normals.insert(mesh.Normals.end(), { x, 0.2f, 1.0f });
  }
  LookDown(mesh,
    [&](double, double, const Oracle& oracle, const rt::MeshHit& hit)
    {
      const float* own = &mesh.Normals[3 * oracle.Triangle];
      const glm::dvec3 expected = glm::normalize(glm::dvec3(own[0], own[1], own[2]));
      EXPECT_NEAR(glm::distance(hit.Normal, expected), 0.0, 2e-4);
    });
}

TEST(MeshAttributes, WithoutAnyThereAreDefaults)
{
  Mesh mesh = CreateTerrain(12);
  mesh.Normals.clear();
  mesh.Values.clear();
  mesh.Colors.clear();
  mesh.TextureCoordinates.clear();
  LookDown(mesh,
    [](double, double, const Oracle& oracle, const rt::MeshHit& hit)
    {
      EXPECT_EQ(hit.Normal, hit.GeometricNormal);
      EXPECT_NEAR(glm::distance(hit.Normal, glm::normalize(oracle.Normal)), 0.0, 1e-4);
      EXPECT_TRUE(std::isnan(hit.Value));
      EXPECT_EQ(hit.Color, glm::vec4(1.0f));
      EXPECT_EQ(hit.TextureCoordinate, glm::dvec2(0.0));
    });
}

TEST(MeshAttributes, ZeroNormalsAreShadedFlatAndNaNValuesStayNaN)
{
  Mesh mesh = CreateTerrain(4);
  std::fill(mesh.Normals.begin(), mesh.Normals.end(), 0.0f);
  std::fill(mesh.Values.begin(), mesh.Values.end(), std::numeric_limits<double>::quiet_NaN());
  LookDown(mesh,
    [](double, double, const Oracle&, const rt::MeshHit& hit)
    {
      EXPECT_EQ(hit.Normal, hit.GeometricNormal);
      EXPECT_TRUE(std::isnan(hit.Value));
    });
}
