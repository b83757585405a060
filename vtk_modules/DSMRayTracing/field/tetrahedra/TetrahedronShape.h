// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TetrahedronShape_h
#define rt_TetrahedronShape_h

#include "DSMBricks/accel/WideBvhNode.h"
#include "DSMBricks/cells/CellBrick.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

namespace rt
{

/// The corners of a tetrahedron in the space of the bricks.
class TetrahedronShape
{
public:
  TetrahedronShape(const bricks::CellBrick& brick, const std::uint16_t* corners)
  {
    for (int corner = 0; corner < 4; ++corner)
    {
      float point[3];
      brick.GetPoint(corners[corner], point);
      this->Corners[corner] = { point[0], point[1], point[2] };
    }
  }

  /// The weights of the corners at a point; those of the nearest corner alone, and false, if the tetrahedron is flat.
  bool GetWeights(const glm::dvec3& point, double weights[4]) const
  {
    const glm::dvec3 edges[3] = { this->GetEdge(1), this->GetEdge(2), this->GetEdge(3) };
    const double volume = glm::dot(edges[0], glm::cross(edges[1], edges[2]));
    if (volume == 0.0)
    {
      std::fill_n(weights, 4, 0.0);
      weights[this->FindNearest(point)] = 1.0;
      return false;
    }
    const glm::dvec3 way = point - this->Corners[0];
    weights[1] = glm::dot(way, glm::cross(edges[1], edges[2])) / volume;
    weights[2] = glm::dot(way, glm::cross(edges[2], edges[0])) / volume;
    weights[3] = glm::dot(way, glm::cross(edges[0], edges[1])) / volume;
    weights[0] = 1.0 - weights[1] - weights[2] - weights[3];
    return true;
  }

  int FindNearest(const glm::dvec3& point) const
  {
    int nearest = 0;
    for (int corner = 1; corner < 4; ++corner)
    {
      nearest =
        glm::distance(point, this->Corners[corner]) < glm::distance(point, this->Corners[nearest])
        ? corner
        : nearest;
    }
    return nearest;
  }

  /// How fast values grow in it, on each axis; 0 if it is flat.
  glm::dvec3 GetGradient(const float* values, const std::uint16_t* corners) const
  {
    const glm::dvec3 edges[3] = { this->GetEdge(1), this->GetEdge(2), this->GetEdge(3) };
    const double volume = glm::dot(edges[0], glm::cross(edges[1], edges[2]));
    if (volume == 0.0)
    {
      return glm::dvec3(0.0);
    }
    const double first = values[corners[0]];
    return ((values[corners[1]] - first) * glm::cross(edges[1], edges[2]) +
             (values[corners[2]] - first) * glm::cross(edges[2], edges[0]) +
             (values[corners[3]] - first) * glm::cross(edges[0], edges[1])) /
      volume;
  }

private:
  glm::dvec3 GetEdge(int corner) const { return this->Corners[corner] - this->Corners[0]; }

  glm::dvec3 Corners[4];
};

/// Calls `visit(leaf)` for the leaves of a hierarchy whose boxes have a point, or nearly so.
template <class Node, class Visit>
inline void ForEachContaining(const Node* nodes, const glm::dvec3& point, const Visit& visit)
{
  constexpr double slack = 1e-6; // of a box's grid
  using Reference = typename Node::ReferenceType;
  std::vector<Reference> waiting{ 0 };
  while (!waiting.empty())
  {
    const Node& node = nodes[waiting.back()];
    waiting.pop_back();
    glm::dvec3 place;
    for (int axis = 0; axis < 3; ++axis)
    {
      const std::uint32_t bits = std::uint32_t(node.Exponent[axis]) << 23;
      float unit;
      std::memcpy(&unit, &bits, sizeof(unit));
      place[axis] = (point[axis] - node.Origin[axis]) / unit;
    }
    for (int child = 0; child < node.Children; ++child)
    {
      bool isInside = true;
      for (int axis = 0; axis < 3; ++axis)
      {
        isInside = isInside && place[axis] >= node.Bounds[8 * axis + child] - slack &&
          place[axis] <= node.Bounds[8 * (3 + axis) + child] + slack;
      }
      if (isInside)
      {
        const Reference reference = node.References[child];
        if (reference & Node::LeafBit)
        {
          visit(reference);
        }
        else
        {
          waiting.push_back(reference);
        }
      }
    }
  }
}

} // namespace rt

#endif
