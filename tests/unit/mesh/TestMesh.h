// SPDX-License-Identifier: BSD-3-Clause
#ifndef tests_TestMesh_h
#define tests_TestMesh_h

#include "tests/support/LoopbackCluster.h"
#include "tests/support/TriangleArrays.h"

#include "DSMBricks/build/PublishMesh.h"
#include "DSMCore/table/ObjectStore.h"
#include "DSMRayTracing/frame/FrameAgreement.h"
#include "DSMRayTracing/mesh/MeshSearch.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <random>
#include <thread>
#include <vector>

/// Generated meshes, ways to distribute them, and an oracle for hits.
namespace TestMesh
{

using Mesh = TriangleArrays<double>;
using Tracer = rt::MeshSearch<dsm::ObjectStore>;

/// Where Tracer::Intersect writes the hits of a packet.
inline auto KeepIn(rt::MeshHit* hits)
{
  return [hits](int index, double) { return hits + index; };
}

/// A closed surface around the origin with radii between 0.7 and 1.3; 20 * 4^level triangles.
inline Mesh CreateBlob(int level)
{
  const double golden = 0.5 * (1.0 + std::sqrt(5.0));
  std::vector<glm::dvec3> points{ { -1, golden, 0 }, { 1, golden, 0 }, { -1, -golden, 0 },
    { 1, -golden, 0 }, { 0, -1, golden }, { 0, 1, golden }, { 0, -1, -golden }, { 0, 1, -golden },
    { golden, 0, -1 }, { golden, 0, 1 }, { -golden, 0, -1 }, { -golden, 0, 1 } };
  std::vector<std::uint64_t> triangles{ 0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5,
    11, 4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3, 9, 4, 3, 4, 2, 3, 2, 6, 3, 6, 8, 3, 8, 9, 4, 9, 5, 2, 4,
    11, 6, 2, 10, 8, 6, 7, 9, 8, 1 };
  for (int step = 0; step < level; ++step)
  {
    std::map<std::pair<std::uint64_t, std::uint64_t>, std::uint64_t> middles;
    const auto getMiddle = [&](std::uint64_t a, std::uint64_t b)
    {
      const auto [entry, isNew] = middles.try_emplace(std::minmax(a, b), points.size());
      if (isNew)
      {
        points.push_back(points[a] + points[b]);
      }
      return entry->second;
    };
    std::vector<std::uint64_t> finer;
    for (std::size_t t = 0; t < triangles.size(); t += 3)
    {
      const std::uint64_t p[3] = { triangles[t], triangles[t + 1], triangles[t + 2] };
      const std::uint64_t m[3] = { getMiddle(p[0], p[1]), getMiddle(p[1], p[2]),
        getMiddle(p[2], p[0]) };
      finer.insert(
        finer.end(), { p[0], m[0], m[2], m[0], p[1], m[1], m[2], m[1], p[2], m[0], m[1], m[2] });
    }
    triangles = finer;
  }
  Mesh mesh;
  mesh.Triangles = triangles;
  for (const glm::dvec3& point : points)
  {
    const glm::dvec3 d = glm::normalize(point);
    const glm::dvec3 p =
      d * (1.0 + 0.3 * std::sin(5.0 * d.x) * std::sin(4.0 * d.y + 1.0) * std::cos(3.0 * d.z));
    mesh.Positions.insert(mesh.Positions.end(), { p.x, p.y, p.z });
  }
  return mesh;
}

/// Triangles of all sizes and directions within the unit cube.
inline Mesh CreateSoup(int triangles, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Mesh mesh;
  for (int triangle = 0; triangle < triangles; ++triangle)
  {
    const glm::dvec3 center(uniform(random), uniform(random), uniform(random));
    const double size = std::pow(10.0, -1.5 + uniform(random));
    for (int corner = 0; corner < 3; ++corner)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        mesh.Positions.push_back(center[axis] + size * uniform(random));
      }
      mesh.Triangles.push_back(mesh.Triangles.size());
    }
  }
  return mesh;
}

/// A height field of 2 n^2 triangles over [0, 1]^2, with values, colors, normals and texture.
inline Mesh CreateTerrain(int n)
{
  Mesh mesh;
  for (int j = 0; j <= n; ++j)
  {
    for (int i = 0; i <= n; ++i)
    {
      const double x = static_cast<double>(i) / n;
      const double y = static_cast<double>(j) / n;
      mesh.Positions.insert(mesh.Positions.end(), { x, y, 0.1 * std::sin(7.0 * x) * y });
      mesh.Normals.insert(mesh.Normals.end(),
        { static_cast<float>(-0.7 * std::cos(7.0 * x) * y),
          static_cast<float>(-0.1 * std::sin(7.0 * x)), 1.0f });
      mesh.Values.push_back(3.0 * x - 2.0 * y);
      mesh.Colors.insert(mesh.Colors.end(),
        { static_cast<std::uint8_t>(255 * x), static_cast<std::uint8_t>(255 * y), 10, 200 });
      mesh.TextureCoordinates.insert(mesh.TextureCoordinates.end(),
        { static_cast<float>(2.0 * x), static_cast<float>(1.0 - y) });
    }
  }
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      const auto p = static_cast<std::uint64_t>(i + j * (n + 1));
      mesh.Triangles.insert(mesh.Triangles.end(), { p, p + 1, p + n + 2, p, p + n + 2, p + n + 1 });
    }
  }
  return mesh;
}

/// The triangles whose number in a shuffled order falls to `part`; all attributes go with them. A
/// part's points are in another order too.
template <class Real>
TriangleArrays<Real> TakePart(
  const TriangleArrays<Real>& mesh, std::uint64_t part, std::uint64_t parts, unsigned seed)
{
  std::vector<std::uint64_t> order(mesh.GetTriangleCount());
  std::iota(order.begin(), order.end(), 0u);
  if (seed != 0)
  {
    std::shuffle(order.begin(), order.end(), std::mt19937(seed));
  }
  TriangleArrays<Real> piece;
  piece.NormalsOf = mesh.NormalsOf;
  piece.ValuesOf = mesh.ValuesOf;
  piece.ColorsOf = mesh.ColorsOf;
  const auto copy = [](const auto& from, std::uint64_t element, int count, auto& to)
  {
    if (!from.empty())
    {
      to.insert(to.end(), from.begin() + count * element, from.begin() + count * (element + 1));
    }
  };
  std::map<std::uint64_t, std::uint64_t> newPoints;
  for (std::uint64_t index = order.size() * part / parts; index < order.size() * (part + 1) / parts;
       ++index)
  {
    const std::uint64_t triangle = order[index];
    for (int corner = 0; corner < 3; ++corner)
    {
      const std::uint64_t point = mesh.Triangles[3 * triangle + corner];
      const auto [entry, isNew] = newPoints.try_emplace(point, newPoints.size());
      piece.Triangles.push_back(entry->second);
      if (isNew)
      {
        copy(mesh.Positions, point, 3, piece.Positions);
        copy(mesh.TextureCoordinates, point, 2, piece.TextureCoordinates);
        if (mesh.NormalsOf == bricks::Attachment::Points)
        {
          copy(mesh.Normals, point, 3, piece.Normals);
        }
        if (mesh.ValuesOf == bricks::Attachment::Points)
        {
          copy(mesh.Values, point, 1, piece.Values);
        }
        if (mesh.ColorsOf == bricks::Attachment::Points)
        {
          copy(mesh.Colors, point, 4, piece.Colors);
        }
        copy(mesh.Radii, point, 1, piece.Radii);
      }
    }
    if (mesh.NormalsOf == bricks::Attachment::Triangles)
    {
      copy(mesh.Normals, triangle, 3, piece.Normals);
    }
    if (mesh.ValuesOf == bricks::Attachment::Triangles)
    {
      copy(mesh.Values, triangle, 1, piece.Values);
    }
    if (mesh.ColorsOf == bricks::Attachment::Triangles)
    {
      copy(mesh.Colors, triangle, 4, piece.Colors);
    }
    copy(mesh.EdgeFlags, triangle, 1, piece.EdgeFlags);
  }
  return piece;
}

/// Runs `work` on a thread as the store's worker 0, while this one serves; rethrows.
inline void TraceOnWorker(dsm::ObjectStore& store, dsm::Messenger& messenger,
  const std::function<void(dsm::ObjectStore::Worker&)>& work)
{
  store.BeginFrame();
  rt::FrameAgreement agreement(messenger, [] {});
  messenger.BeginSession();
  std::exception_ptr failure;
  std::atomic<bool> done{ false };
  std::thread thread(
    [&]
    {
      dsm::ObjectStore::Worker& worker = store.GetWorker(0);
      store.Enter(worker);
      try
      {
        work(worker);
      }
      catch (...)
      {
        failure = std::current_exception();
      }
      store.Leave(worker);
      done = true;
      messenger.WakeUp();
    });
  messenger.ProgressUntil([&] { return agreement.IsOver(); },
    [&]
    {
      if (done && !agreement.IsDone())
      {
        agreement.ReportDone();
      }
      return store.Service();
    });
  thread.join();
  store.EndFrame();
  if (failure)
  {
    std::rethrow_exception(failure);
  }
}

/// Publishes `mesh` on one rank, in small bricks, and runs `work` on a worker.
inline void TraceOnStore(const bricks::TriangleSource& mesh,
  const std::function<void(dsm::ObjectStore&, dsm::ObjectStore::Worker&,
    const std::shared_ptr<bricks::TriangleMesh>&)>& work,
  std::uint32_t brickBytes = 1024)
{
  RunOnCluster(1,
    [&](dsm::Messenger& messenger)
    {
      dsm::ObjectStore store(messenger, { std::size_t(1) << 20, 1 });
      bricks::TriangleMeshSettings settings;
      settings.BrickBytes = brickBytes;
      settings.Threads = 2;
      const auto published = bricks::PublishMesh("mesh", mesh, settings, store, messenger);
      TraceOnWorker(store, messenger,
        [&](dsm::ObjectStore::Worker& worker) { work(store, worker, published); });
    });
}

/// The same with a tracer.
inline void TraceAlone(const bricks::TriangleSource& mesh,
  const std::function<void(const Tracer&, const std::shared_ptr<bricks::TriangleMesh>&)>& work,
  std::uint32_t brickBytes = 1024)
{
  TraceOnStore(
    mesh,
    [&](dsm::ObjectStore& store, dsm::ObjectStore::Worker& worker,
      const std::shared_ptr<bricks::TriangleMesh>& published)
    { work(Tracer(store, worker), published); },
    brickBytes);
}

/// The nearest hit by trying all triangles, in double precision (Moller, Trumbore 1997).
struct Oracle
{
  bool Found = false;
  double T = 0.0;
  std::uint64_t Triangle = 0;
  glm::dvec3 Normal{ 0.0 }; ///< not unit
  double Weights[3] = {};
};

inline glm::dvec3 GetPoint(const bricks::TriangleSource& mesh, std::uint64_t triangle, int corner)
{
  std::uint64_t points[3];
  mesh.GetTriangle(triangle, points);
  glm::dvec3 point;
  mesh.GetPosition(points[corner], &point.x);
  return point;
}

inline Oracle FindByTryingAll(const bricks::TriangleSource& mesh, const rt::Ray& ray)
{
  Oracle nearest;
  for (std::uint64_t triangle = 0; triangle < mesh.GetTriangleCount(); ++triangle)
  {
    const glm::dvec3 a = GetPoint(mesh, triangle, 0);
    const glm::dvec3 ab = GetPoint(mesh, triangle, 1) - a;
    const glm::dvec3 ac = GetPoint(mesh, triangle, 2) - a;
    const glm::dvec3 p = glm::cross(ray.Direction, ac);
    const double inverse = 1.0 / glm::dot(ab, p);
    const glm::dvec3 s = ray.Origin - a;
    const glm::dvec3 q = glm::cross(s, ab);
    const double v = glm::dot(s, p) * inverse;
    const double w = glm::dot(ray.Direction, q) * inverse;
    const double t = glm::dot(ac, q) * inverse;
    if (v >= 0.0 && w >= 0.0 && v + w <= 1.0 && t >= ray.Min && t <= ray.Max &&
      (!nearest.Found || t < nearest.T))
    {
      nearest = { true, t, triangle, glm::cross(ab, ac), { 1.0 - v - w, v, w } };
    }
  }
  return nearest;
}

/// Rays from all around, most of which meet a mesh within the sphere.
inline std::vector<rt::Ray> CreateRays(
  int count, unsigned seed, const glm::dvec3& center = glm::dvec3(0.0), double radius = 1.0)
{
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto getDirection = [&]
  { return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random))); };
  std::vector<rt::Ray> rays(count);
  for (rt::Ray& ray : rays)
  {
    ray.Origin = center + 3.0 * radius * getDirection();
    ray.Direction = 0.2 * (center + 0.9 * radius * getDirection() - ray.Origin);
    ray.Max = 100.0;
  }
  return rays;
}

} // namespace TestMesh

#endif
