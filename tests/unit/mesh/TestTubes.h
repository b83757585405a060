// SPDX-License-Identifier: BSD-3-Clause
#ifndef tests_TestTubes_h
#define tests_TestTubes_h

#include "TestMesh.h"

/// Generated tubes and spheres.
namespace TestTubes
{

using namespace TestMesh;

inline void AddPoint(Mesh& mesh, const glm::dvec3& position, double radius)
{
  // As bricks have them.
  for (int axis = 0; axis < 3; ++axis)
  {
    mesh.Positions.push_back(static_cast<float>(position[axis]));
  }
  mesh.Radii.push_back(static_cast<float>(radius));
}

/// Random walks and spheres within about the unit ball, with values and colors.
inline Mesh CreateTubes(int lines, int spheres, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto getVector = [&]
  { return glm::dvec3(uniform(random), uniform(random), uniform(random)); };
  Mesh mesh;
  for (int line = 0; line < lines; ++line)
  {
    const std::uint64_t first = mesh.GetPointCount();
    const std::uint64_t count = 2 + line % 9;
    glm::dvec3 place = 0.6 * getVector();
    for (std::uint64_t point = 0; point < count; ++point)
    {
      AddPoint(mesh, place, 0.02 + 0.015 * uniform(random));
      place += 0.15 * getVector();
    }
    mesh.AddLine(first, count);
  }
  for (int sphere = 0; sphere < spheres; ++sphere)
  {
    const std::uint64_t point = mesh.GetPointCount();
    AddPoint(mesh, 0.6 * getVector(), 0.06 + 0.05 * uniform(random));
    mesh.Triangles.insert(mesh.Triangles.end(), { point, point, point });
  }
  for (std::uint64_t point = 0; point < mesh.GetPointCount(); ++point)
  {
    mesh.Values.push_back(mesh.Positions[3 * point] - mesh.Positions[3 * point + 1]);
  }
  mesh.ColorsOf = bricks::Attachment::Triangles;
  for (std::uint64_t triangle = 0; triangle < mesh.GetTriangleCount(); ++triangle)
  {
    mesh.Colors.insert(mesh.Colors.end(), { static_cast<std::uint8_t>(triangle), 7, 8, 255 });
  }
  return mesh;
}

} // namespace TestTubes

#endif
