// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/field/tetrahedra/CellField.h"

#include "DSMRayTracing/object/ObjectDigest.h"

#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cstddef>

namespace rt
{

namespace
{

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

double CellField::GetFinestLength(const glm::dmat3& worldToSpace) const
{
  return this->GetShortestEdge(worldToSpace, glm::dvec3(1.0)) * this->Voxels->Cells->ShortestEdge;
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
