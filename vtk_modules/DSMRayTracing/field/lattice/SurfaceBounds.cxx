// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/field/lattice/SurfaceBounds.h"

#include "DSMRayTracing/field/lattice/IsovaluePredicate.h"

#include <limits>

namespace rt
{

namespace
{

/// The bricks that a box of world space meets.
bricks::Box FindBricks(
  const bricks::VoxelField& field, const glm::dmat4& toIndex, const double bounds[6])
{
  glm::dvec3 low(std::numeric_limits<double>::max());
  glm::dvec3 high(std::numeric_limits<double>::lowest());
  for (int corner = 0; corner < 8; ++corner)
  {
    const glm::dvec3 place(toIndex *
      glm::dvec4(
        bounds[corner & 1], bounds[2 + (corner >> 1 & 1)], bounds[4 + (corner >> 2 & 1)], 1.0));
    low = glm::min(low, place);
    high = glm::max(high, place);
  }
  if (field.Planes)
  {
    low = field.Planes->ToIndex(low);
    high = field.Planes->ToIndex(high);
  }
  // A cell more on each side, for what rounding does.
  const double edge = field.Lattice.GetEdge();
  return bricks::Intersect({ bricks::Index3(glm::floor((low - 1.0) / edge)),
                             bricks::Index3(glm::floor((high + 1.0) / edge)) + bricks::Index3(1) },
    { bricks::Index3(0), field.Lattice.GetBricks() });
}

bool MayHoldAny(
  const bricks::VoxelField& field, const bricks::Box& bricks, const IsovaluePredicate& mayHold)
{
  const std::vector<bricks::ValueRange>& ranges = field.Hierarchy.GetLevels().front().Ranges;
  bricks::Index3 brick;
  for (brick.z = bricks.Min.z; brick.z < bricks.Max.z; ++brick.z)
  {
    for (brick.y = bricks.Min.y; brick.y < bricks.Max.y; ++brick.y)
    {
      for (brick.x = bricks.Min.x; brick.x < bricks.Max.x; ++brick.x)
      {
        if (mayHold(ranges[field.Lattice.GetId(brick)]))
        {
          return true;
        }
      }
    }
  }
  return false;
}

} // namespace

bool MayHaveSurface(const bricks::VoxelField& field, const glm::dmat4& worldToIndex,
  const double bounds[6], const std::vector<double>& isovalues)
{
  return MayHoldAny(field, FindBricks(field, worldToIndex, bounds), IsovaluePredicate(isovalues));
}

} // namespace rt
