// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LevelDescent_h
#define rt_LevelDescent_h

#include "DSMBricks/levels/LevelVoxels.h"
#include "DSMRayTracing/field/lattice/BeamBricks.h"
#include "DSMRayTracing/field/lattice/RayBeam.h"
#include "DSMRayTracing/field/levels/LevelField.h"
#include "DSMRayTracing/ray/Ray.h"

#include <algorithm>
#include <cmath>
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
  using Node = bricks::RangedBrickBvh::Node;
  BeamBricks found;
  found.Usable = true;
  std::copy_n(beam.GetForward(), 3, found.Forward);
  if (field.Hierarchy.IsEmpty())
  {
    return found;
  }
  std::vector<std::pair<double, BeamBricks::Brick>> bricks;
  std::vector<std::uint32_t> open{ 0 };
  while (!open.empty())
  {
    const Node& node = field.Hierarchy.GetNodes()[open.back()];
    open.pop_back();
    for (int child = 0; child < node.Children; ++child)
    {
      double lower[3];
      double upper[3];
      for (int axis = 0; axis < 3; ++axis)
      {
        const double step = std::ldexp(1.0, static_cast<int>(node.Exponent[axis]) - 127);
        const auto get = [&](int side)
        {
          const std::uint8_t bound = node.Bounds[(3 * side + axis) * Node::Width + child];
          return static_cast<double>(node.Origin[axis]) + step * bound;
        };
        lower[axis] = get(0);
        upper[axis] = get(1);
      }
      if (!mayHold(node.Ranges[child]) || !beam.MayMeetBox(lower, upper))
      {
        continue;
      }
      const std::uint32_t reference = node.References[child];
      if ((reference & Node::LeafBit) == 0)
      {
        open.push_back(reference);
        continue;
      }
      BeamBricks::Brick brick;
      brick.Id = bricks::RangedBrickBvh::GetBrick(reference);
      const bricks::Box& cells = field.Lattice.GetBrick(brick.Id).Cells;
      for (int axis = 0; axis < 3; ++axis)
      {
        brick.Lower[axis] = static_cast<double>(cells.Min[axis]);
        brick.Upper[axis] = static_cast<double>(cells.Max[axis]);
      }
      bricks.emplace_back(beam.GetEntry(lower, upper), brick);
    }
  }
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
