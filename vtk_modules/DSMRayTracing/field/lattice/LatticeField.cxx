// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/field/lattice/LatticeField.h"

#include "DSMRayTracing/object/ObjectDigest.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>

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

double LatticeField::GetGrowth(const glm::dvec3& gradient) const
{
  const glm::dmat3 edges(this->IndexToWorld);
  const glm::dvec3 lengths(glm::length(edges[0]), glm::length(edges[1]), glm::length(edges[2]));
  const double mean = (lengths.x + lengths.y + lengths.z) / 3.0;
  return glm::length(gradient / lengths) * mean;
}

double LatticeField::GetFinestLength(const glm::dmat3& worldToSpace) const
{
  const glm::dmat3 edges = worldToSpace * glm::dmat3(this->IndexToWorld);
  return std::min({ glm::length(edges[0]), glm::length(edges[1]), glm::length(edges[2]) });
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
