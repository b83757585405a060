// SPDX-License-Identifier: BSD-3-Clause
// Tubes and spheres against balls, whose hits are known, and against searches for the ball that a ray meets first.
#include "TestTubes.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <limits>
#include <optional>

namespace
{

using namespace TestTubes;
using Number = long double;

struct Interval
{
  Number Enter = 0.0;
  Number Leave = 0.0;
};

/// A ball at a part of the way from the first of two points to the second.
struct Ball
{
  Number Center[3];
  Number Radius;

  Ball(const Mesh& mesh, std::uint64_t first, std::uint64_t second, Number part)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const Number from = mesh.Positions[3 * first + axis];
      this->Center[axis] = from + part * (mesh.Positions[3 * second + axis] - from);
    }
    const Number from = mesh.Radii[first];
    this->Radius = from + part * (mesh.Radii[second] - from);
  }

  /// How far the line is outside, as a square less that of the radius, and where it is nearest.
  Number GetOutside(const rt::Ray& ray, Number& nearest, Number& square) const
  {
    Number offset[3];
    Number along = 0.0;
    square = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      offset[axis] = this->Center[axis] - ray.Origin[axis];
      along += offset[axis] * ray.Direction[axis];
      square += static_cast<Number>(ray.Direction[axis]) * ray.Direction[axis];
    }
    nearest = along / square;
    Number distance = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const Number beside = offset[axis] - nearest * ray.Direction[axis];
      distance += beside * beside;
    }
    return std::sqrt(distance) - this->Radius;
  }

  std::optional<Interval> Intersect(const rt::Ray& ray) const
  {
    Number nearest = 0.0;
    Number square = 0.0;
    const Number outside = this->GetOutside(ray, nearest, square);
    if (outside > 0.0)
    {
      return {};
    }
    const Number half = std::sqrt(-outside * (outside + 2.0 * this->Radius) / square);
    return Interval{ nearest - half, nearest + half };
  }
};

/// The place in [low, high] where a convex function is the least.
template <class Function>
Number FindLeast(Number low, Number high, const Function& function)
{
  for (int step = 0; step < 120; ++step)
  {
    const Number left = low + (high - low) / 3.0;
    const Number right = high - (high - low) / 3.0;
    (function(left) < function(right) ? high : low) =
      function(left) < function(right) ? right : left;
  }
  return 0.5 * (low + high);
}

/// Where the line is in any ball between two points. How far it is outside of a ball is a convex function of the
/// ball, and so is where it enters one.
std::optional<Interval> IntersectByTrying(
  const Mesh& mesh, std::uint64_t first, std::uint64_t second, const rt::Ray& ray)
{
  const auto getOutside = [&](Number part)
  {
    Number nearest = 0.0;
    Number square = 0.0;
    return Ball(mesh, first, second, part).GetOutside(ray, nearest, square);
  };
  Number inside = FindLeast(0.0, 1.0, getOutside);
  for (const Number end : { 0.0, 1.0 })
  {
    inside = getOutside(end) < getOutside(inside) ? end : inside;
  }
  if (getOutside(inside) > 0.0)
  {
    return {};
  }
  Number ends[2] = { 0.0, 1.0 };
  for (Number& end : ends)
  {
    Number good = inside;
    for (int step = 0; step < 120 && getOutside(end) > 0.0; ++step)
    {
      const Number middle = 0.5 * (good + end);
      (getOutside(middle) > 0.0 ? end : good) = middle;
    }
    end = getOutside(end) > 0.0 ? good : end;
  }
  const auto intersect = [&](Number part)
  {
    const auto found = Ball(mesh, first, second, part).Intersect(ray);
    return found ? *found : Interval{ 1e30L, -1e30L };
  };
  Interval all = intersect(inside);
  for (const Number part : { ends[0], ends[1],
         FindLeast(ends[0], ends[1], [&](Number place) { return intersect(place).Enter; }),
         FindLeast(ends[0], ends[1], [&](Number place) { return -intersect(place).Leave; }) })
  {
    all.Enter = std::min(all.Enter, intersect(part).Enter);
    all.Leave = std::max(all.Leave, intersect(part).Leave);
  }
  return all;
}

/// Where the line is inside any of the mesh's tubes and spheres, in order and joined.
std::vector<Interval> FindInside(const Mesh& mesh, const rt::Ray& ray)
{
  std::vector<Interval> parts;
  for (std::uint64_t triangle = 0; triangle < mesh.GetTriangleCount(); ++triangle)
  {
    const std::uint64_t* points = &mesh.Triangles[3 * triangle];
    if (points[0] != points[1] || points[1] == points[2])
    {
      if (const auto part = IntersectByTrying(mesh, points[0], points[1], ray))
      {
        parts.push_back(*part);
      }
    }
  }
  std::sort(parts.begin(), parts.end(),
    [](const Interval& a, const Interval& b) { return a.Enter < b.Enter; });
  std::vector<Interval> joined;
  for (const Interval& part : parts)
  {
    if (!joined.empty() && part.Enter <= joined.back().Leave)
    {
      joined.back().Leave = std::max(joined.back().Leave, part.Leave);
    }
    else
    {
      joined.push_back(part);
    }
  }
  return joined;
}

/// The first hit of rays from outside, with T and side, and the first one behind the start of others.
void CompareFirstHits(
  const Mesh& mesh, const std::vector<rt::Ray>& rays, double tolerance, std::uint32_t brickBytes)
{
  TraceAlone(
    mesh,
    [&](const Tracer& tracer, const std::shared_ptr<bricks::TriangleMesh>& published)
    {
      const rt::MeshInstance instance(published, glm::dmat4(1.0));
      int hits = 0;
      for (std::size_t index = 0; index < rays.size(); ++index)
      {
        SCOPED_TRACE(testing::Message() << "ray " << index);
        const rt::Ray& ray = rays[index];
        const std::vector<Interval> inside = FindInside(mesh, ray);
        const auto first = std::find_if(inside.begin(), inside.end(),
          [&](const Interval& part) { return part.Enter >= ray.Min; });
        const bool isHit = first != inside.end() && first->Enter <= ray.Max;
        rt::MeshHit hit;
        rt::MeshInstance fronts = instance;
        fronts.Culling.Back = true;
        ASSERT_EQ(tracer.Intersect(fronts, ray, hit), isHit);
        ASSERT_EQ(tracer.IsOccluded(fronts, ray), isHit);
        if (isHit)
        {
          ++hits;
          ASSERT_NEAR(hit.T, static_cast<double>(first->Enter), tolerance);
          ASSERT_TRUE(hit.Front);
          ASSERT_LE(glm::dot(hit.Normal, ray.Direction), 1e-6);
          ASSERT_NEAR(glm::length(hit.Normal), 1.0, 1e-12);
        }
      }
      EXPECT_GT(hits, static_cast<int>(rays.size()) / 20);
    },
    brickBytes);
}

/// All hits one after the other: the ray enters and leaves, and there is nothing inside.
void CompareAllHits(const Mesh& mesh, const std::vector<rt::Ray>& rays, double tolerance)
{
  TraceAlone(mesh,
    [&](const Tracer& tracer, const std::shared_ptr<bricks::TriangleMesh>& published)
    {
      const rt::MeshInstance instance(published, glm::dmat4(1.0));
      int spans = 0;
      for (std::size_t index = 0; index < rays.size(); ++index)
      {
        SCOPED_TRACE(testing::Message() << "ray " << index);
        rt::Ray ray = rays[index];
        for (const Interval& part : FindInside(mesh, ray))
        {
          if (part.Leave - part.Enter < 1e-9)
          {
            continue; // may be missed, and so may its neighbour be
          }
          for (const bool front : { true, false })
          {
            if ((front ? part.Enter : part.Leave) < ray.Min)
            {
              continue; // behind the ray's start
            }
            rt::MeshHit hit;
            ASSERT_TRUE(tracer.Intersect(instance, ray, hit));
            ASSERT_EQ(hit.Front, front);
            ASSERT_NEAR(hit.T, static_cast<double>(front ? part.Enter : part.Leave), tolerance);
            ray.Min = std::nextafter(hit.T, 1e30);
          }
          ++spans;
        }
        rt::MeshHit hit;
        ASSERT_FALSE(tracer.Intersect(instance, ray, hit));
      }
      EXPECT_GT(spans, static_cast<int>(rays.size()) / 20);
    });
}

/// A line that winds around the z axis, of points nearer to each other than it is thick.
Mesh CreateHelix(int points, double radius, double thickness)
{
  Mesh mesh;
  for (int point = 0; point < points; ++point)
  {
    const double part = static_cast<double>(point) / (points - 1);
    AddPoint(mesh,
      { radius * std::cos(8.0 * part), radius * std::sin(8.0 * part), 1.6 * part - 0.8 },
      thickness * (1.0 + 0.3 * std::sin(20.0 * part)));
  }
  mesh.AddLine(0, static_cast<std::uint64_t>(points));
  return mesh;
}

Mesh CreateBall(const glm::dvec3& center, double radius)
{
  Mesh mesh;
  AddPoint(mesh, center, radius);
  mesh.Triangles = { 0, 0, 0 };
  return mesh;
}

Mesh CreateRod(
  const glm::dvec3& first, double firstRadius, const glm::dvec3& second, double secondRadius)
{
  Mesh mesh;
  AddPoint(mesh, first, firstRadius);
  AddPoint(mesh, second, secondRadius);
  mesh.AddLine(0, 2);
  return mesh;
}

rt::Ray CreateRay(const glm::dvec3& origin, const glm::dvec3& direction)
{
  rt::Ray ray;
  ray.Origin = origin;
  ray.Direction = direction;
  ray.Max = 1e30;
  return ray;
}

} // namespace

TEST(Tubes, AsTheirBalls)
{
  CompareFirstHits(CreateTubes(40, 25, 1), CreateRays(200, 2), 1e-10, 1024);
}

TEST(Tubes, OneABrick)
{
  CompareFirstHits(CreateTubes(12, 9, 3), CreateRays(300, 4), 1e-10, 1);
}

TEST(Tubes, RaysFromWithinAndOfBoundedLength)
{
  std::vector<rt::Ray> rays = CreateRays(400, 5);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(0.0, 8.0);
  for (rt::Ray& ray : rays)
  {
    ray.Min = uniform(random);
    ray.Max = ray.Min + uniform(random);
  }
  const Mesh mesh = CreateRod({ -0.8, 0.1, 0.0 }, 0.3, { 0.7, -0.2, 0.1 }, 0.5);
  CompareFirstHits(mesh, rays, 1e-10, 1024);
}

TEST(Tubes, RaysAlongTheAxes)
{
  std::vector<rt::Ray> rays = CreateRays(150, 7);
  for (std::size_t index = 0; index < rays.size(); ++index)
  {
    const int axis = static_cast<int>(index % 3);
    rays[index].Direction = glm::dvec3(0.0);
    rays[index].Direction[axis] = index % 2 == 0 ? 1.0 : -1.0;
    rays[index].Origin *= 0.25;
    rays[index].Origin[axis] = -4.0 * rays[index].Direction[axis];
  }
  CompareFirstHits(CreateTubes(30, 20, 8), rays, 1e-10, 1024);
}

TEST(Tubes, RodsOfAllShapes)
{
  std::mt19937 random(9);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto getVector = [&]
  { return glm::dvec3(uniform(random), uniform(random), uniform(random)); };
  for (int rod = 0; rod < 60; ++rod)
  {
    SCOPED_TRACE(rod);
    // Also with a tip, of no length, and with one ball inside the other.
    const glm::dvec3 first = 0.5 * getVector();
    const double length = rod % 6 == 0 ? 0.0 : std::pow(10.0, uniform(random) - 1.0);
    const double radius = 0.3 + 0.2 * uniform(random);
    const double other = rod % 4 == 0 ? 0.0 : radius * (1.0 + uniform(random));
    const Mesh mesh = CreateRod(first, radius, first + length * getVector(), other);
    CompareAllHits(mesh, CreateRays(100, static_cast<unsigned>(rod), first, 0.4), 1e-8);
  }
}

TEST(Tubes, OfManyPointsAreOneSurface)
{
  // Nothing is inside, though each part reaches into several others.
  CompareAllHits(CreateHelix(120, 0.6, 0.1), CreateRays(150, 10), 1e-8);
  CompareAllHits(CreateHelix(25, 0.6, 0.1), CreateRays(200, 11), 1e-8);
}

TEST(Tubes, BendsHaveNeitherHolesNorWalls)
{
  for (int bend = 0; bend < 30; ++bend)
  {
    SCOPED_TRACE(bend);
    Mesh mesh;
    const double angle = 0.06 * bend; // up to a right angle
    AddPoint(mesh, { -1.0, 0.0, 0.0 }, 0.2);
    AddPoint(mesh, { 0.0, 0.0, 0.0 }, bend % 2 == 0 ? 0.2 : 0.3);
    AddPoint(mesh, { std::cos(angle), std::sin(angle), 0.0 }, bend % 3 == 0 ? 0.2 : 0.1);
    mesh.AddLine(0, 3);
    CompareAllHits(mesh, CreateRays(100, static_cast<unsigned>(bend), glm::dvec3(0.0), 0.3), 1e-8);
  }
}

TEST(Tubes, RaysAlongTheirOwnAxis)
{
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1.0, 2.0, -0.5));
  for (const double end : { 0.25, 0.125, 0.0 })
  {
    TraceAlone(CreateRod({ 0.0, 0.0, 0.0 }, 0.25, { 2.0, 4.0, -1.0 }, end),
      [&](const Tracer& tracer, const std::shared_ptr<bricks::TriangleMesh>& published)
      {
        rt::MeshInstance instance(published, glm::dmat4(1.0));
        rt::MeshHit hit;
        rt::Ray ray = CreateRay(-3.0 * axis, axis);
        ASSERT_TRUE(tracer.Intersect(instance, ray, hit));
        EXPECT_NEAR(hit.T, 2.75, 1e-12);
        EXPECT_NEAR(glm::dot(hit.Normal, axis), -1.0, 1e-12);
        EXPECT_TRUE(hit.Front);
        ray.Min = 3.5; // from inside
        ASSERT_TRUE(tracer.Intersect(instance, ray, hit));
        EXPECT_NEAR(hit.T, 3.0 + std::sqrt(21.0) + end, 1e-7);
        EXPECT_FALSE(hit.Front);
      });
  }
}

TEST(Tubes, TangentRays)
{
  const Mesh rod = CreateRod({ -1.0, 0.0, 0.0 }, 0.5, { 1.0, 0.0, 0.0 }, 0.5);
  const Mesh ball = CreateBall({ 0.0, 0.0, 0.0 }, 0.5);
  for (const Mesh& mesh : { rod, ball })
  {
    TraceAlone(mesh,
      [&](const Tracer& tracer, const std::shared_ptr<bricks::TriangleMesh>& published)
      {
        const rt::MeshInstance instance(published, glm::dmat4(1.0));
        rt::MeshHit hit;
        for (const glm::dvec3& direction :
          { glm::dvec3(0.0, 0.0, 1.0), glm::dvec3(0.0, 0.0, -0.3) })
        {
          for (const double height : { 0.5, -0.5, 0.5 - 1e-12 })
          {
            const rt::Ray ray =
              CreateRay(glm::dvec3(0.0, height, 0.0) - 8.0 * direction, direction);
            ASSERT_TRUE(tracer.Intersect(instance, ray, hit)) << height;
            EXPECT_NEAR(hit.T, 8.0, 1e-5);
            EXPECT_NEAR(std::abs(hit.Normal.y), 1.0, 1e-5);
          }
          const rt::Ray ray =
            CreateRay(glm::dvec3(0.0, 0.5 + 1e-12, 0.0) - 8.0 * direction, direction);
          EXPECT_FALSE(tracer.Intersect(instance, ray, hit));
        }
      });
  }
}

TEST(Tubes, ValuesAndNormalsFollowTheLine)
{
  Mesh mesh = CreateRod({ -1.0, 0.0, 0.0 }, 0.25, { 3.0, 0.0, 0.0 }, 0.25);
  mesh.Values = { 10.0, 50.0 };
  mesh.Colors = { 0, 0, 0, 255, 200, 100, 40, 255 };
  mesh.TextureCoordinates = { 0.0f, 1.0f, 4.0f, 1.0f };
  TraceAlone(mesh,
    [&](const Tracer& tracer, const std::shared_ptr<bricks::TriangleMesh>& published)
    {
      const rt::MeshInstance instance(published, glm::dmat4(1.0));
      for (const double x : { -1.2, -1.0, -0.5, 0.75, 2.0, 3.0, 3.1 })
      {
        rt::MeshHit hit;
        ASSERT_TRUE(
          tracer.Intersect(instance, CreateRay({ x, 0.125, -5.0 }, { 0.0, 0.0, 1.0 }), hit));
        const double part = std::clamp((x + 1.0) / 4.0, 0.0, 1.0);
        EXPECT_NEAR(hit.Value, 10.0 + 40.0 * part, 1e-6);
        EXPECT_NEAR(hit.Color.x, 200.0 / 255.0 * part, 1e-6);
        EXPECT_NEAR(hit.TextureCoordinate.x, 4.0 * part, 1e-6);
        EXPECT_NEAR(hit.Normal.y, 0.5, 1e-9);
        EXPECT_EQ(hit.Normal, hit.GeometricNormal);
        EXPECT_EQ(hit.EdgeFlags, 0u);
      }
    });
}

TEST(Tubes, SpheresHaveOneValue)
{
  Mesh mesh = CreateBall({ 0.0, 0.0, 0.0 }, 1.0);
  mesh.Values = { 0.1 };
  TraceAlone(mesh,
    [&](const Tracer& tracer, const std::shared_ptr<bricks::TriangleMesh>& published)
    {
      const rt::MeshInstance instance(published, glm::dmat4(1.0));
      for (const rt::Ray& ray : CreateRays(200, 12))
      {
        rt::MeshHit hit;
        ASSERT_TRUE(tracer.Intersect(instance, ray, hit));
        EXPECT_EQ(hit.Value, 0.1f);
        EXPECT_LT(glm::length(hit.Normal - (ray.Origin + hit.T * ray.Direction)), 1e-12);
      }
    });
}

TEST(Tubes, SpheresOfAStretchedMeshAreEllipsoids)
{
  TraceAlone(CreateBall({ 0.0, 0.0, 0.0 }, 1.0),
    [&](const Tracer& tracer, const std::shared_ptr<bricks::TriangleMesh>& published)
    {
      // Mirrored, too: the surface is not turned inside out.
      const glm::dvec3 size(0.5, -1.0, 2.0);
      const rt::MeshInstance instance(published, glm::scale(glm::dmat4(1.0), size));
      for (rt::Ray ray : CreateRays(200, 13))
      {
        ray.Origin *= size;
        ray.Direction *= size;
        rt::MeshHit hit;
        ASSERT_TRUE(tracer.Intersect(instance, ray, hit));
        const glm::dvec3 place = (ray.Origin + hit.T * ray.Direction) / size;
        EXPECT_NEAR(glm::length(place), 1.0, 1e-12);
        EXPECT_LT(glm::length(hit.Normal - glm::normalize(place / size)), 1e-12);
        EXPECT_TRUE(hit.Front);
      }
    });
}

TEST(Tubes, FarAwayAndThin)
{
  // A million lengths from the origin and from the camera, and a thousand times as long as thick.
  const glm::dvec3 center(2097152.0, 0.0, 0.0);
  const Mesh rod = CreateRod({ 2097151.0, 0.0, 0.0 }, 0x1p-10, { 2097153.0, 0.0, 0.0 }, 0x1p-10);
  TraceAlone(rod,
    [&](const Tracer& tracer, const std::shared_ptr<bricks::TriangleMesh>& published)
    {
      const rt::MeshInstance instance(published, glm::dmat4(1.0));
      for (const double height : { 0.0, 0.9 * 0x1p-10, 1.1 * 0x1p-10 })
      {
        rt::MeshHit hit;
        const rt::Ray ray =
          CreateRay(center + glm::dvec3(0.5, height, -1048576.0), { 0.0, 0.0, 1.0 });
        ASSERT_EQ(tracer.Intersect(instance, ray, hit), height < 0x1p-10);
        if (height < 0x1p-10)
        {
          EXPECT_NEAR(hit.T, 1048576.0 - std::sqrt(0x1p-20 - height * height), 1e-9);
          EXPECT_NEAR(hit.Normal.y, height * 1024.0, 1e-5);
        }
      }
    });
}

TEST(Tubes, WithoutRadiusOrPlaceAreLeftOut)
{
  Mesh mesh = CreateTubes(5, 3, 14);
  const std::uint64_t whole = mesh.GetTriangleCount();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const auto addBall = [&](double x, double radius)
  {
    const std::uint64_t point = mesh.GetPointCount();
    AddPoint(mesh, { x, 0.0, 0.0 }, radius);
    mesh.Values.push_back(0.0);
    mesh.Triangles.insert(mesh.Triangles.end(), { point, point, point });
    mesh.Colors.insert(mesh.Colors.end(), 4, 0);
  };
  addBall(0.0, 0.0);
  addBall(nan, 1.0);
  addBall(0.0, infinity);
  addBall(0.0, nan);
  TraceAlone(mesh,
    [&](const Tracer&, const std::shared_ptr<bricks::TriangleMesh>& published)
    {
      EXPECT_EQ(published->Triangles, whole);
      EXPECT_EQ(published->Dropped, 4u);
      EXPECT_TRUE(published->Attributes.Radii);
      EXPECT_LT(published->Upper.x, 2.0);
    });
}
