// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/field/tetrahedra/CellField.h"

#include "DSMRayTracing/object/ObjectDigest.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace rt
{

namespace
{

/// Lengths of the axes of the space of bricks where a matrix leads to.
glm::dvec3 GetLengths(const glm::dmat3& axes)
{
  return { glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]) };
}

bool Contains(const bricks::BoundingBox& box, const glm::dvec3& point)
{
  float lower[4];
  float upper[4];
  box.Lower.Store(lower);
  box.Upper.Store(upper);
  return point.x >= lower[0] && point.y >= lower[1] && point.z >= lower[2] && point.x <= upper[0] &&
    point.y <= upper[1] && point.z <= upper[2];
}

} // namespace

ObjectTracer::Brick CellField::FindBrick(const glm::dvec3& place) const
{
  const glm::dvec3 point = this->ToIndex(place);
  const auto& boxes = this->Voxels->Cells->Boxes;
  const auto found = std::find_if(boxes.begin(), boxes.end(),
    [&](const bricks::BoundingBox& box) { return Contains(box, point); });
  if (found == boxes.end())
  {
    return { nullptr, 0 };
  }
  return { this->Voxels->Segment.get(), static_cast<dsm::BlockId>(found - boxes.begin()) };
}

bool CellField::FindPlace(const glm::dvec3& point, CellPlace& place) const
{
  const bricks::BrickSpace& space = *this->Voxels->Cells;
  place.Point = this->ToIndex(point);
  place.Brick = CellPlace::NoBrick;
  const glm::dvec3 slack = 1e-9 * (space.Upper - space.Lower);
  return glm::all(glm::greaterThanEqual(place.Point, space.Lower - slack)) &&
    glm::all(glm::lessThanEqual(place.Point, space.Upper + slack));
}

glm::dvec3 CellField::GetNormal(const glm::dvec3& gradient, const glm::dvec3& rayDirection) const
{
  const glm::dvec3 growth = glm::transpose(glm::dmat3(this->WorldToIndex)) * gradient;
  const double length = glm::length(growth);
  return length > 0.0 && std::isfinite(length) ? growth / -length : -glm::normalize(rayDirection);
}

double CellField::GetFinestLength(const glm::dmat3& worldToSpace) const
{
  const glm::dvec3 lengths = GetLengths(worldToSpace * glm::dmat3(this->IndexToWorld));
  return std::min({ lengths.x, lengths.y, lengths.z }) * this->Voxels->Cells->ShortestEdge;
}

double CellField::GetGrowth(const glm::dvec3& gradient) const
{
  return glm::length(gradient) * this->Voxels->Cells->MeanEdge;
}

void CellField::AddTo(ObjectDigest& digest) const
{
  digest.Add(this->IndexToWorld);
  AddTo(digest, *this->Voxels);
}

void CellField::AddTo(ObjectDigest& digest, const Values& values)
{
  digest.Add(values.Cells->Segment->GetNumber());
  digest.Add(values.Cells->Segment->GetVersion());
  digest.Add(values.Segment->GetNumber());
  digest.Add(values.Segment->GetVersion());
}

} // namespace rt
