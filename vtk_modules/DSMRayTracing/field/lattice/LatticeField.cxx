// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/field/lattice/LatticeField.h"

#include "DSMRayTracing/object/ObjectDigest.h"

#include <glm/common.hpp>
#include <glm/vec4.hpp>
#include <glm/vector_relational.hpp>

namespace rt
{

LatticePlace LatticeField::GetPlace(const glm::dvec3& point) const
{
  const bricks::BrickLattice& lattice = this->Voxels->Lattice;
  const IndexSpace space = this->GetIndexSpace();
  const bricks::Index3 cells = lattice.GetCells();
  LatticePlace place;
  place.IndexPoint = glm::clamp(
    space.GetWorldToIndex() * (point - space.GetOrigin()), glm::dvec3(0.0), glm::dvec3(cells));
  if (space.GetPlanes())
  {
    place.IndexPoint = space.GetPlanes()->ToIndex(place.IndexPoint);
  }
  const bricks::Index3 cell =
    glm::min(bricks::Index3(glm::floor(place.IndexPoint)), cells - bricks::Index3(1));
  place.Cell = glm::ivec3(cell);
  place.Brick = lattice.GetId(cell / bricks::Index3(lattice.GetEdge()));
  return place;
}

ObjectTracer::Brick LatticeField::FindBrick(const glm::dvec3& place) const
{
  constexpr double slack = 1e-3; // a ray begins and ends at the border
  glm::dvec3 point(this->WorldToIndex * glm::dvec4(place, 1.0));
  const glm::dvec3 end(this->Voxels->Lattice.GetCells());
  const bool isInside = glm::all(glm::greaterThanEqual(point, glm::dvec3(-slack))) &&
    glm::all(glm::lessThanEqual(point, end + slack));
  if (const bricks::GridPlanes* const planes = this->GetIndexSpace().GetPlanes())
  {
    point = planes->ToIndex(point);
  }
  return { isInside ? this->Voxels->Segment.get() : nullptr,
    this->Voxels->Lattice.FindBrick(point) };
}

void LatticeField::AddTo(ObjectDigest& digest) const
{
  digest.Add(this->IndexToWorld);
  AddTo(digest, *this->Voxels);
}

void LatticeField::AddTo(ObjectDigest& digest, const Values& values)
{
  digest.Add(values.Segment->GetNumber());
  digest.Add(values.Segment->GetVersion());
  if (values.Planes)
  {
    digest.Add(values.Planes->GetHash());
  }
}

} // namespace rt
