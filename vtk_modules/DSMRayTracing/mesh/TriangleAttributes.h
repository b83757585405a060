// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TriangleAttributes_h
#define rt_TriangleAttributes_h

#include "DSMBricks/layout/OctahedralNormal.h"
#include "DSMBricks/layout/TriangleBrick.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

namespace rt
{

/// Attributes at the corners of one triangle, copied out of its brick so that the brick can be
/// released.
struct TriangleAttributes
{
  std::uint32_t Normals[3]; ///< or the bits of radii
  float Values[3];
  std::uint8_t Colors[3][4];
  float TextureCoordinates[3][2];
  unsigned EdgeFlags;

  void Copy(const bricks::TriangleBrick& brick, std::uint32_t triangle)
  {
    const bricks::TriangleBrickHeader& header = brick.GetHeader();
    const std::uint16_t* corners = brick.GetTriangle(triangle);
    this->EdgeFlags = brick.GetEdgeFlags(triangle);
    for (int corner = 0; corner < 3; ++corner)
    {
      const std::uint32_t vertex = corners[corner];
      this->Normals[corner] = brick.GetVertices()[vertex].Normal;
      if (header.Values != bricks::Attachment::None)
      {
        this->Values[corner] =
          brick.GetValues()[header.Values == bricks::Attachment::Points ? vertex : triangle];
      }
      if (header.Colors != bricks::Attachment::None)
      {
        const std::uint32_t element =
          header.Colors == bricks::Attachment::Points ? vertex : triangle;
        std::memcpy(this->Colors[corner], brick.GetColors() + 4 * element, 4);
      }
      if (header.TextureOffset != 0)
      {
        std::memcpy(this->TextureCoordinates[corner], brick.GetTextureCoordinates() + 2 * vertex,
          2 * sizeof(float));
      }
    }
  }

  /// In the mesh's space, not of unit length; false when a corner has none.
  bool GetNormal(const double weights[3], glm::dvec3& normal) const
  {
    glm::vec3 sum(0.0f);
    for (int corner = 0; corner < 3; ++corner)
    {
      if (this->Normals[corner] == bricks::OctahedralNormal::None)
      {
        return false;
      }
      glm::vec3 direction;
      bricks::OctahedralNormal::Unpack(this->Normals[corner], &direction.x);
      sum += static_cast<float>(weights[corner]) / glm::length(direction) * direction;
    }
    normal = sum;
    return true;
  }

  /// For tubes.
  float GetLargestRadius() const
  {
    float radii[3];
    std::memcpy(radii, this->Normals, sizeof(radii));
    return std::max({ radii[0], radii[1], radii[2] });
  }

  double GetValue(const double weights[3]) const
  {
    // Exact where the corners are alike, as they are for a value of the triangle.
    if (this->Values[0] == this->Values[1] && this->Values[1] == this->Values[2])
    {
      return this->Values[0];
    }
    return weights[0] * this->Values[0] + weights[1] * this->Values[1] +
      weights[2] * this->Values[2];
  }

  glm::vec4 GetColor(const double weights[3]) const
  {
    glm::vec4 color(0.0f);
    for (int corner = 0; corner < 3; ++corner)
    {
      const std::uint8_t* rgba = this->Colors[corner];
      color +=
        static_cast<float>(weights[corner] / 255.0) * glm::vec4(rgba[0], rgba[1], rgba[2], rgba[3]);
    }
    return color;
  }

  glm::dvec2 GetTextureCoordinate(const double weights[3]) const
  {
    glm::dvec2 place(0.0);
    for (int corner = 0; corner < 3; ++corner)
    {
      const float* coordinate = this->TextureCoordinates[corner];
      place += weights[corner] * glm::dvec2(coordinate[0], coordinate[1]);
    }
    return place;
  }
};

} // namespace rt

#endif
