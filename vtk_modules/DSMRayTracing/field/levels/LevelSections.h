// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LevelSections_h
#define rt_LevelSections_h

#include "DSMRayTracing/field/PlaneSections.h"
#include "DSMRayTracing/field/lattice/LatticePlace.h"
#include "DSMRayTracing/field/lattice/LatticeSections.h"
#include "DSMRayTracing/ray/Ray.h"

#include <glm/vec3.hpp>

#include <vector>

namespace rt
{

struct LevelField;

/// The sections of planes through levels: where rays meet them within the bounds of all cells. Reads no bricks, so
/// a place is only a point, in the index space of level 0, until LevelSampler::FindPlaces finds its cell. Any
/// number of threads may ask.
class LevelSections
{
public:
  struct Line
  {
  };
  using Hit = SectionHit<LatticePlace>;
  using Beam = LatticeSections::Beam;

  /// Keeps both by reference.
  LevelSections(const LevelField& field, const std::vector<SectionPlane>& planes)
    : Field(field)
    , Planes(planes)
  {
  }

  /// The planes need no more than the ray itself.
  bool GetLine(const Ray&, Line&) const { return true; }

  /// See LatticeSections.
  bool FindNext(const Ray& ray, const Line&, Hit& hit) const;

  /// Which bricks the planes pass through is not foreseen.
  Beam FindBeam(const Ray[4]) const
  {
    Beam beam;
    beam.IsKnown = false;
    return beam;
  }

private:
  const LevelField& Field;
  const std::vector<SectionPlane>& Planes;
};

} // namespace rt

#endif
