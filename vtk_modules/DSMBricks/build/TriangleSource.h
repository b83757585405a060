// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_TriangleSource_h
#define bricks_TriangleSource_h

#include "DSMBricks/layout/MeshAttributes.h"

#include <cstdint>

namespace bricks
{

/// One rank's triangles, as this rank has them: any part of the mesh, in any order, none at all.
/// Implemented over vtkPolyData, and by generators. All numbers are of this piece, from 0. While a
/// mesh is built, several threads call at the same time.
///
/// Tubes and spheres are triangles with radii (MeshAttributes::Radii). A tube is the hull of two balls,
/// a round cone, for each two points of a line in turn. Every triangle is one point b of the line, with
/// the points before and behind it, a and c. To it belong the half next to b of the round cone from a to
/// b, and that of the one from b to c; so a primitive alone tells where one lies inside the other, and a
/// tube has no walls inside.
///
///   (a, b, c)               a point in the middle of a line
///   (a, a, c), (a, b, b)    its first point, and its last one: the half of one round cone
///   (a, b, a)               a line of two points: all of its round cone
///   (a, a, a)               a sphere
class TriangleSource
{
public:
  virtual ~TriangleSource() = default;

  /// Ignored for a piece without triangles.
  virtual MeshAttributes GetAttributes() const = 0;

  virtual std::uint64_t GetTriangleCount() const = 0;
  virtual std::uint64_t GetPointCount() const = 0;

  /// The points of a triangle, counter-clockwise seen from its front.
  virtual void GetTriangle(std::uint64_t triangle, std::uint64_t points[3]) const = 0;
  /// In the mesh's own space. Triangles with a point that is not finite are left out.
  virtual void GetPosition(std::uint64_t point, double position[3]) const = 0;

  // -- Each only when the piece has the attribute --------------------------------------------------

  /// Normal of a point or triangle, of any length. Where it is zero or not finite, the surface is
  /// shaded flat.
  virtual void GetNormal(std::uint64_t element, double normal[3]) const = 0;
  /// `element` is a point or a triangle, as the attachment says.
  virtual double GetValue(std::uint64_t element) const = 0;
  virtual void GetColor(std::uint64_t element, std::uint8_t rgba[4]) const = 0;
  virtual void GetTextureCoordinate(std::uint64_t point, double coordinate[2]) const = 0;
  /// In the order of the triangle's points; see AllEdges.
  virtual unsigned GetEdgeFlags(std::uint64_t triangle) const = 0;
  /// Radius at a corner, in the mesh's own space and not negative. Those with a radius that is not finite
  /// are left out, and those with three that are 0.
  virtual double GetRadius(std::uint64_t triangle, int corner) const = 0;
};

} // namespace bricks

#endif
