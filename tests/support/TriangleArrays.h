// SPDX-License-Identifier: BSD-3-Clause
#ifndef TriangleArrays_h
#define TriangleArrays_h

#include "DSMBricks/build/TriangleSource.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

/// Triangles in plain arrays. An attribute is there when its array is not empty; `Real` is the type
/// of the positions, float or double.
template <class Real>
class TriangleArrays final : public bricks::TriangleSource
{
public:
  std::vector<Real> Positions;          ///< three a point
  std::vector<std::uint64_t> Triangles; ///< three points a triangle
  std::vector<float> Normals;           ///< three an element
  std::vector<double> Values;
  std::vector<std::uint8_t> Colors;      ///< four an element
  std::vector<float> TextureCoordinates; ///< two a point
  std::vector<std::uint8_t> EdgeFlags;   ///< one a triangle
  std::vector<double> Radii;             ///< one a point; makes the triangles tubes and spheres
  /// What Normals, Values and Colors belong to, when there are any.
  bricks::Attachment NormalsOf = bricks::Attachment::Points;
  bricks::Attachment ValuesOf = bricks::Attachment::Points;
  bricks::Attachment ColorsOf = bricks::Attachment::Points;

  bricks::MeshAttributes GetAttributes() const override
  {
    bricks::MeshAttributes attributes;
    attributes.Normals = this->Normals.empty() ? bricks::Attachment::None : this->NormalsOf;
    attributes.Values = this->Values.empty() ? bricks::Attachment::None : this->ValuesOf;
    attributes.Colors = this->Colors.empty() ? bricks::Attachment::None : this->ColorsOf;
    attributes.TextureCoordinates = !this->TextureCoordinates.empty();
    attributes.EdgeFlags = !this->EdgeFlags.empty();
    attributes.Radii = !this->Radii.empty();
    return attributes;
  }

  /// Adds the tube along `count` points from `first` on; see bricks::TriangleSource.
  void AddLine(std::uint64_t first, std::uint64_t count)
  {
    const std::uint64_t last = first + count - 1;
    if (count == 2)
    {
      this->Triangles.insert(this->Triangles.end(), { first, last, first });
      return;
    }
    for (std::uint64_t point = first; point <= last; ++point)
    {
      this->Triangles.insert(this->Triangles.end(),
        { std::max(point, first + 1) - 1, point, std::min(point + 1, last) });
    }
  }

  std::uint64_t GetTriangleCount() const override { return this->Triangles.size() / 3; }
  std::uint64_t GetPointCount() const override { return this->Positions.size() / 3; }
  void GetTriangle(std::uint64_t triangle, std::uint64_t points[3]) const override
  {
    std::copy_n(this->Triangles.data() + 3 * triangle, 3, points);
  }
  void GetPosition(std::uint64_t point, double position[3]) const override
  {
    std::copy_n(this->Positions.data() + 3 * point, 3, position);
  }
  void GetNormal(std::uint64_t element, double normal[3]) const override
  {
    std::copy_n(this->Normals.data() + 3 * element, 3, normal);
  }
  double GetValue(std::uint64_t element) const override { return this->Values[element]; }
  void GetColor(std::uint64_t element, std::uint8_t rgba[4]) const override
  {
    std::copy_n(this->Colors.data() + 4 * element, 4, rgba);
  }
  void GetTextureCoordinate(std::uint64_t point, double coordinate[2]) const override
  {
    std::copy_n(this->TextureCoordinates.data() + 2 * point, 2, coordinate);
  }
  unsigned GetEdgeFlags(std::uint64_t triangle) const override { return this->EdgeFlags[triangle]; }
  double GetRadius(std::uint64_t triangle, int corner) const override
  {
    return this->Radii[this->Triangles[3 * triangle + static_cast<std::uint64_t>(corner)]];
  }
};

#endif
