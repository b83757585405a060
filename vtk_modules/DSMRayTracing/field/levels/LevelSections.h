// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LevelSections_h
#define rt_LevelSections_h

#include "DSMRayTracing/field/levels/LevelDescent.h"
#include "DSMRayTracing/field/walk/WalkSections.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>

namespace rt
{

/// The sections of planes through levels, which foresee bricks. Any number of threads may ask.
class LevelSections : public WalkSections<LevelField>
{
public:
  using WalkSections<LevelField>::WalkSections;

  /// Rays at the border of the beam may meet other bricks, too.
  SectionBeam FindBeam(const Ray corners[4]) const
  {
    SectionBeam beam;
    beam.Usable = true;
    const auto all = [](const bricks::ValueRange&) { return true; };
    for (const BeamBricks::Brick& brick : FindBeamBricks(this->Field, all, corners).Bricks)
    {
      if (this->MeetAnyPlane(brick))
      {
        beam.Bricks.push_back(brick.Id);
      }
    }
    return beam;
  }

private:
  bool MeetAnyPlane(const BeamBricks::Brick& brick) const
  {
    const bricks::LevelLattice& lattice = this->Field.Voxels->Lattice;
    const glm::dvec3 scale(lattice.GetScales().Get(lattice.GetBrick(brick.Id).Level));
    const glm::dvec3 lower = glm::dvec3(brick.Lower[0], brick.Lower[1], brick.Lower[2]) / scale;
    const glm::dvec3 upper = glm::dvec3(brick.Upper[0], brick.Upper[1], brick.Upper[2]) / scale;
    const glm::dvec3 half = 0.5 * (upper - lower);
    const glm::dvec3 middle(this->Field.IndexToWorld * glm::dvec4(lower + half, 1.0));
    return std::any_of(this->Planes.begin(), this->Planes.end(),
      [&](const SectionPlane& plane)
      {
        const glm::dvec3 slopes = glm::abs(plane.Normal * glm::dmat3(this->Field.IndexToWorld));
        return std::abs(glm::dot(plane.Normal, plane.Point - middle)) <= glm::dot(slopes, half);
      });
  }
};

} // namespace rt

#endif
