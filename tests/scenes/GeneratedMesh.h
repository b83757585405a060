// SPDX-License-Identifier: BSD-3-Clause
#ifndef tests_scenes_GeneratedMesh_h
#define tests_scenes_GeneratedMesh_h

#include "tests/scenes/GeneratedVolume.h"
#include "tests/support/TriangleArrays.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace Generated
{

using Mesh = TriangleArrays<double>;

/// Adds a point with all that points may have.
inline void AddPoint(
  Mesh& mesh, const glm::dvec3& position, const glm::dvec3& normal, double u, double v)
{
  mesh.Positions.insert(mesh.Positions.end(), { position.x, position.y, position.z });
  mesh.Normals.insert(mesh.Normals.end(),
    { static_cast<float>(normal.x), static_cast<float>(normal.y), static_cast<float>(normal.z) });
  mesh.TextureCoordinates.insert(
    mesh.TextureCoordinates.end(), { static_cast<float>(u), static_cast<float>(v) });
  mesh.Values.push_back(2.0 * position.x + position.y * position.z);
  const auto number = static_cast<std::int64_t>(mesh.Values.size());
  mesh.Colors.insert(mesh.Colors.end(),
    { static_cast<std::uint8_t>(255.0 * u), static_cast<std::uint8_t>(255.0 * v),
      static_cast<std::uint8_t>(Hash(number) % 256),
      static_cast<std::uint8_t>(128 + number % 128) });
}

/// Adds squares of two triangles each between the last n + 1 times n + 1 points.
inline void AddSquares(Mesh& mesh, int n)
{
  const std::uint64_t first = mesh.GetPointCount() - static_cast<std::uint64_t>(n + 1) * (n + 1);
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      const std::uint64_t p = first + static_cast<std::uint64_t>(i + j * (n + 1));
      mesh.Triangles.insert(mesh.Triangles.end(), { p, p + 1, p + n + 2, p, p + n + 2, p + n + 1 });
      mesh.EdgeFlags.insert(mesh.EdgeFlags.end(), { 0b011, 0b110 });
    }
  }
}

/// A closed surface of 12 n^2 triangles with radii about 1, more or less by `bumps`.
inline Mesh CreateBall(int n, double bumps)
{
  Mesh mesh;
  for (int side = 0; side < 6; ++side)
  {
    const int axis = side / 2;
    const double sign = side % 2 == 0 ? 1.0 : -1.0;
    for (int j = 0; j <= n; ++j)
    {
      for (int i = 0; i <= n; ++i)
      {
        glm::dvec3 place;
        place[axis] = sign;
        // In either direction, so that all fronts are outside.
        place[(axis + 1) % 3] = sign * static_cast<double>(2 * i - n) / n;
        place[(axis + 2) % 3] = static_cast<double>(2 * j - n) / n;
        const glm::dvec3 d =
          place / std::sqrt(place.x * place.x + place.y * place.y + place.z * place.z);
        const double radius =
          1.0 + bumps * (Noise(2.0 * d.x + 9.0, 2.0 * d.y + 9.0, 2.0 * d.z + 9.0, 5) - 0.5);
        AddPoint(mesh, radius * d, d, static_cast<double>(i) / n, static_cast<double>(j) / n);
      }
    }
    AddSquares(mesh, n);
  }
  return mesh;
}

/// A height field over [-1, 1]^2 that looks up z.
inline Mesh CreateTerrain(int n, double height)
{
  Mesh mesh;
  for (int j = 0; j <= n; ++j)
  {
    for (int i = 0; i <= n; ++i)
    {
      const double u = static_cast<double>(i) / n;
      const double v = static_cast<double>(j) / n;
      const auto get = [&](double x, double y) { return height * Noise(5.0 * x, 5.0 * y, 0.5, 2); };
      const glm::dvec3 normal(
        get(u - 0.01, v) - get(u + 0.01, v), get(u, v - 0.01) - get(u, v + 0.01), 0.04);
      AddPoint(mesh, { 2.0 * u - 1.0, 2.0 * v - 1.0, get(u, v) }, normal, 3.0 * u, 2.0 * v);
    }
  }
  AddSquares(mesh, n);
  return mesh;
}

/// Triangles that belong to nothing, of all sizes and directions.
inline Mesh CreateSoup(int triangles)
{
  Mesh mesh;
  for (int triangle = 0; triangle < triangles; ++triangle)
  {
    const double size =
      0.02 + 0.4 * Random(triangle, 1) * Random(triangle, 2) * Random(triangle, 3);
    for (int corner = 0; corner < 3; ++corner)
    {
      glm::dvec3 position;
      for (int axis = 0; axis < 3; ++axis)
      {
        position[axis] = 2.0 * Random(triangle, axis, 4) - 1.0 +
          size * (2.0 * Random(triangle, axis, 10 + corner) - 1.0);
      }
      mesh.Triangles.push_back(mesh.GetPointCount());
      AddPoint(mesh, position, position, Random(triangle, corner, 5), Random(triangle, corner, 6));
    }
    mesh.EdgeFlags.push_back(static_cast<std::uint8_t>(Hash(triangle) % 8));
  }
  return mesh;
}

/// A ball as a scanner might have seen it: rough, and with holes.
inline Mesh CreateScan(int n)
{
  const Mesh whole = CreateBall(n, 0.5);
  Mesh mesh = whole;
  mesh.Triangles.clear();
  mesh.EdgeFlags.clear();
  for (std::uint64_t triangle = 0; triangle < whole.GetTriangleCount(); ++triangle)
  {
    if (Hash(static_cast<std::int64_t>(triangle), 3) % 11 != 0)
    {
      for (int corner = 0; corner < 3; ++corner)
      {
        mesh.Triangles.push_back(whole.Triangles[3 * triangle + corner]);
      }
      mesh.EdgeFlags.push_back(whole.EdgeFlags[triangle]);
    }
  }
  for (std::size_t at = 0; at < mesh.Positions.size(); ++at)
  {
    mesh.Positions[at] += 0.02 * Random(static_cast<std::int64_t>(at), 8);
  }
  return mesh;
}

/// Long thin triangles around a point.
inline Mesh CreateFan(int triangles)
{
  Mesh mesh;
  AddPoint(mesh, glm::dvec3(0.0), { 0.0, 0.0, 1.0 }, 0.5, 0.5);
  for (int point = 0; point <= triangles; ++point)
  {
    const double t = static_cast<double>(2 * point - triangles) / triangles;
    const double x = (1.0 - t * t) / (1.0 + t * t);
    const double y = 2.0 * t / (1.0 + t * t);
    AddPoint(mesh, { x, y, 0.3 * Random(point, 9) }, { x, y, 1.0 }, 0.5 + 0.5 * x, 0.5 + 0.5 * y);
    if (point > 0)
    {
      const auto last = static_cast<std::uint64_t>(point);
      mesh.Triangles.insert(mesh.Triangles.end(), { 0, last, last + 1 });
      mesh.EdgeFlags.push_back(0b010);
    }
  }
  return mesh;
}

/// Lines of 2 to 9 points as tubes, and a sphere for each; see bricks::TriangleSource.
inline Mesh CreateTubes(int lines)
{
  Mesh mesh;
  for (int line = 0; line < lines; ++line)
  {
    glm::dvec3 place;
    for (int axis = 0; axis < 3; ++axis)
    {
      place[axis] = 1.6 * Random(line, axis, 11) - 0.8;
    }
    const int points = 2 + line % 8;
    const std::uint64_t first = mesh.GetPointCount();
    const std::uint64_t sphere = first + static_cast<std::uint64_t>(points);
    for (int point = 0; point <= points; ++point)
    {
      AddPoint(mesh, place, place, static_cast<double>(point) / points, Random(line, 12));
      mesh.Radii.push_back(0.03 + 0.03 * Random(line, point, 13));
      for (int axis = 0; axis < 3; ++axis)
      {
        place[axis] += 0.4 * Random(line, point, 14 + axis) - 0.2;
      }
    }
    mesh.AddLine(first, static_cast<std::uint64_t>(points));
    mesh.Triangles.insert(mesh.Triangles.end(), { sphere, sphere, sphere });
    mesh.Radii.back() = 0.15 * Random(line, 17);
  }
  mesh.Normals.clear();
  return mesh;
}

/// A mesh without any attribute.
inline Mesh Strip(Mesh mesh)
{
  mesh.Normals.clear();
  mesh.Values.clear();
  mesh.Colors.clear();
  mesh.TextureCoordinates.clear();
  mesh.EdgeFlags.clear();
  return mesh;
}

/// Normals, values and colors of triangles in place of points: those of their first corners.
inline Mesh MoveToTriangles(const Mesh& mesh)
{
  Mesh moved = mesh;
  moved.NormalsOf = moved.ValuesOf = moved.ColorsOf = bricks::Attachment::Triangles;
  moved.Normals.clear();
  moved.Values.clear();
  moved.Colors.clear();
  for (std::uint64_t triangle = 0; triangle < mesh.GetTriangleCount(); ++triangle)
  {
    const std::uint64_t point = mesh.Triangles[3 * triangle];
    const auto copy = [point](const auto& from, int count, auto& to)
    {
      const auto first = from.begin() + static_cast<std::ptrdiff_t>(count * point);
      to.insert(to.end(), first, first + count);
    };
    copy(mesh.Normals, 3, moved.Normals);
    copy(mesh.Values, 1, moved.Values);
    copy(mesh.Colors, 4, moved.Colors);
  }
  return moved;
}

} // namespace Generated

#endif
