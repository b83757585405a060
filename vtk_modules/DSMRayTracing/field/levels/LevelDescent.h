// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LevelDescent_h
#define rt_LevelDescent_h

#include "DSMBricks/levels/LevelVoxels.h"
#include "DSMRayTracing/field/lattice/BeamBricks.h"
#include "DSMRayTracing/field/lattice/ChildrenInBeam.h"
#include "DSMRayTracing/field/lattice/RayBeam.h"
#include "DSMRayTracing/field/levels/LevelField.h"
#include "DSMRayTracing/ray/ChildrenInRange.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/WideBvhTraversal.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace rt
{

/// Finds the bricks of levels whose values satisfy `mayHold` (IsovaluePredicate) and that rays of a beam, in the
/// index space of level 0, may meet. The planes of a brick are in cells of its own level. Nearer ones come first,
/// but bricks of different levels may overlap, so a ray that has found something has to look into all that begin
/// before that.
template <class Predicate>
BeamBricks FindLevelBricks(
  const bricks::LevelVoxels& field, const Predicate& mayHold, const RayBeam& beam)
{
  BeamBricks found;
  found.Usable = true;
  std::copy_n(beam.GetForward(), 3, found.Forward);
  if (field.Hierarchy.IsEmpty())
  {
    return found;
  }
  std::vector<std::pair<double, BeamBricks::Brick>> bricks;
  TraverseWideBvh(field.Hierarchy.GetNodes(), ChildrenInRange(ChildrenInBeam(beam), mayHold),
    [&](std::uint32_t leaf)
    {
      BeamBricks::Brick brick;
      brick.Id = bricks::RangedBrickBvh::GetBrick(leaf);
      const bricks::LevelBrick& own = field.Lattice.GetBrick(brick.Id);
      const glm::dvec3 scale(field.Lattice.GetScales().Get(own.Level));
      double lower[3];
      double upper[3];
      for (int axis = 0; axis < 3; ++axis)
      {
        brick.Lower[axis] = static_cast<double>(own.Cells.Min[axis]);
        brick.Upper[axis] = static_cast<double>(own.Cells.Max[axis]);
        lower[axis] = brick.Lower[axis] / scale[axis];
        upper[axis] = brick.Upper[axis] / scale[axis];
      }
      bricks.emplace_back(beam.GetEntry(lower, upper), brick);
    });
  std::sort(bricks.begin(), bricks.end(),
    [](const auto& a, const auto& b)
    { return a.first < b.first || (a.first == b.first && a.second.Id < b.second.Id); });
  found.Bricks.reserve(bricks.size());
  for (const auto& [entry, brick] : bricks)
  {
    found.Bricks.push_back(brick);
  }
  return found;
}

/// The same for the rays between those of `corners`, in order around them. Not usable where these go to different
/// sides.
template <class Predicate>
BeamBricks FindBeamBricks(const LevelField& field, const Predicate& mayHold, const Ray corners[4])
{
  RayBeam beam;
  return beam.Set(field.GetIndexSpace(), corners) ? FindLevelBricks(*field.Voxels, mayHold, beam)
                                                  : BeamBricks();
}

} // namespace rt

#endif
