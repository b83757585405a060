// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/field/levels/LevelField.h"

#include "DSMRayTracing/object/ObjectDigest.h"

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

namespace rt
{

bricks::Index3 LevelField::GetBlockCell(const LatticePlace& place) const
{
  const bricks::LevelLattice& lattice = this->Voxels->Lattice;
  const int level = lattice.GetBrick(place.Brick).Level;
  return bricks::DivideDown(place.GetCell(), lattice.GetScales().Get(level));
}

bool LevelField::FindPlace(const glm::dvec3& point, LatticePlace& place) const
{
  const auto& bounds = this->Voxels->Lattice.GetBounds();
  const glm::dvec3 at = this->ToIndex(point);
  place = { glm::clamp(at, bounds[0], bounds[1]), glm::ivec3(0), bricks::LevelLattice::None };
  const glm::dvec3 slack = 1e-9 * (bounds[1] - bounds[0]);
  return glm::all(glm::lessThanEqual(glm::abs(at - place.IndexPoint), slack));
}

ObjectTracer::Brick LevelField::FindBrick(const glm::dvec3& place) const
{
  const bricks::LevelLattice& lattice = this->Voxels->Lattice;
  const glm::dvec3 point = this->ToIndex(place);
  for (int level = lattice.GetScales().GetCount() - 1; level >= 0; --level)
  {
    const glm::dvec3 there = point * glm::dvec3(lattice.GetScales().Get(level));
    const dsm::BlockId id = lattice.Find(level, bricks::Index3(glm::floor(there)));
    if (id != bricks::LevelLattice::None)
    {
      return { this->Voxels->Segment.get(), id };
    }
  }
  return { nullptr, 0 };
}

void LevelField::AddTo(ObjectDigest& digest) const
{
  digest.Add(this->IndexToWorld);
  AddTo(digest, *this->Voxels);
}

void LevelField::AddTo(ObjectDigest& digest, const Values& values)
{
  digest.Add(values.Segment->GetNumber());
  digest.Add(values.Segment->GetVersion());
}

} // namespace rt
