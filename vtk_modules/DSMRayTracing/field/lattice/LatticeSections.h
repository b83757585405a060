// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LatticeSections_h
#define rt_LatticeSections_h

#include "DSMBricks/layout/VoxelField.h"
#include "DSMCore/base/Block.h"
#include "DSMRayTracing/field/PlaneSections.h"
#include "DSMRayTracing/field/grid/GridRay.h"
#include "DSMRayTracing/field/grid/IndexSpace.h"
#include "DSMRayTracing/field/lattice/LatticePlace.h"
#include "DSMRayTracing/ray/Ray.h"

#include <glm/vec3.hpp>

#include <vector>

namespace rt
{

struct LatticeField;

/// The sections of planes through a lattice: where rays meet them, and the bricks that they pass through. Reads no
/// bricks. Any number of threads may ask.
class LatticeSections
{
public:
  using Line = GridRay;
  using Hit = SectionHit<LatticePlace>;

  /// Keeps both by reference.
  LatticeSections(const LatticeField& field, const std::vector<SectionPlane>& planes);

  /// The ray in the lattice's index space; false where it cannot be traced.
  bool GetLine(const Ray& ray, Line& line) const { return this->Space.GetGridRay(ray, line); }

  /// Finds the first position in [ray.Min, ray.Max], behind the one in `hit`, where the ray meets a plane
  /// within the lattice's box. Among equally near positions, that of the first plane comes first. Returns
  /// whether there is one.
  bool FindNext(const Ray& ray, const Line& line, Hit& hit) const;

  /// Finds the beam of all rays between the four `corners`, which are in order around it.
  SectionBeam FindBeam(const Ray corners[4]) const;

private:
  /// A plane in index (or grid) space: the points x with dot(Normal, x) == Offset.
  struct IndexPlane
  {
    glm::dvec3 Normal; ///< its largest component is 1 or -1
    double Offset;
    int Steepest;     ///< the axis of this component
    bool IsAlongAxes; ///< the others are 0
    double
      Coordinate; ///< on that axis, then: an index; a whole number where the plane goes through samples
  };

  /// In index or grid space.
  struct Box
  {
    glm::dvec3 Lower;
    glm::dvec3 Upper;
  };

  double ToIndex(int axis, double place) const
  {
    const bricks::GridPlanes* const planes = this->Space.GetPlanes();
    return planes ? planes->ToIndex(axis, place) : place;
  }
  double ToPlace(int axis, double index) const
  {
    const bricks::GridPlanes* const planes = this->Space.GetPlanes();
    return planes ? planes->ToPlace(axis, index) : index;
  }

  bool FindPlace(const Line& line, double t, const IndexPlane& plane, LatticePlace& place) const;
  void AddBricks(const IndexPlane& plane, const Box& box, std::vector<dsm::BlockId>& bricks) const;

  const bricks::VoxelField& Voxels;
  const std::vector<SectionPlane>& Planes;
  IndexSpace Space;
  std::vector<IndexPlane> IndexPlanes;
};

} // namespace rt

#endif
