// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/field/levels/LevelField.h"

#include "DSMRayTracing/object/ObjectDigest.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>

namespace rt
{

double LevelField::GetFinestLength() const
{
  const bricks::LevelScales& scales = this->Voxels->Lattice.GetScales();
  const glm::dvec3 finest(scales.Get(scales.GetCount() - 1));
  const glm::dmat3 edges(this->IndexToWorld);
  return std::min({ glm::length(edges[0]) / finest.x, glm::length(edges[1]) / finest.y,
    glm::length(edges[2]) / finest.z });
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
