// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_BeamDescent_h
#define rt_BeamDescent_h

#include "DSMBricks/layout/GridPlanes.h"
#include "DSMBricks/layout/MacrocellHierarchy.h"
#include "DSMRayTracing/field/lattice/BeamBricks.h"
#include "DSMRayTracing/field/lattice/LatticeField.h"
#include "DSMRayTracing/field/lattice/RayBeam.h"
#include "DSMRayTracing/ray/Ray.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace rt
{

/// Takes a beam down through the levels above the bricks, nearer macrocells first. `Predicate` decides from a
/// ValueRange whether the rays may find anything there; see IsovaluePredicate.
template <class Predicate>
class BeamDescent
{
public:
  /// All is kept by reference. `planes`: of a rectilinear grid; null: at whole numbers.
  BeamDescent(const bricks::MacrocellHierarchy& hierarchy, const Predicate& mayHold,
    const RayBeam& beam, const bricks::GridPlanes* planes = nullptr)
    : Levels(hierarchy.GetLevels())
    , Planes(planes)
    , MayHold(mayHold)
    , Beam(beam)
  {
    for (const bricks::MacrocellHierarchy::Level& level : this->Levels)
    {
      this->Cubes.push_back(this->GetCubes(level.Edge));
    }
  }

  BeamBricks Find()
  {
    BeamBricks found;
    found.Usable = true;
    std::copy_n(this->Beam.GetForward(), 3, found.Forward);
    const int top = static_cast<int>(this->Levels.size()) - 1;
    const int first[3] = { 0, 0, 0 };
    this->VisitBox(top, first, this->Levels[top].Size, found.Bricks);
    return found;
  }

private:
  using Bricks = std::vector<BeamBricks::Brick>;

  /// Macrocells [begin, end) of a level.
  void VisitBox(int number, const int begin[3], const int end[3], Bricks& bricks)
  {
    const bricks::MacrocellHierarchy::Level& level = this->Levels[number];
    const RayBeam::Cubes& cubes = this->Cubes[number];
    int first[3];
    int last[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      first[axis] = std::max(begin[axis], cubes.First[axis]);
      last[axis] = std::min(end[axis], cubes.Last[axis] + 1);
    }
    const bool* forward = this->Beam.GetForward();
    const int size[3] = { last[0] - first[0], last[1] - first[1], last[2] - first[2] };
    for (int k = 0; k < size[2]; ++k)
    {
      const int z = forward[2] ? first[2] + k : last[2] - 1 - k;
      for (int j = 0; j < size[1]; ++j)
      {
        const int y = forward[1] ? first[1] + j : last[1] - 1 - j;
        int low = first[0];
        int high = last[0] - 1;
        if (!this->ClipRow(level.Edge, cubes, y, z, low, high))
        {
          continue;
        }
        const std::int64_t row = level.Size[0] * (y + std::int64_t{ level.Size[1] } * z);
        for (int i = low; i <= high; ++i)
        {
          const int x = forward[0] ? i : low + high - i;
          if (this->MayHold(level.Ranges[static_cast<std::size_t>(row + x)]))
          {
            this->Visit(number, row + x, { x, y, z }, bricks);
          }
        }
      }
    }
  }

  RayBeam::Cubes GetCubes(double edge) const
  {
    RayBeam::Cubes cubes = this->Beam.GetCubes(edge);
    for (int axis = 0; this->Planes && axis < 3; ++axis)
    {
      const double lower = this->Beam.GetLower(axis);
      const double upper = this->Beam.GetUpper(axis);
      const bool isOutside =
        upper < 0.0 || lower > static_cast<double>(this->Planes->GetCells(axis));
      cubes.First[axis] = this->FindNode(edge, axis, lower);
      cubes.Last[axis] = isOutside ? -1 : this->FindNode(edge, axis, upper);
    }
    return cubes;
  }

  /// Nodes `low` to `high` of a row: shortens it to those that rays may meet. Returns false if there are none.
  bool ClipRow(double edge, const RayBeam::Cubes& cubes, int y, int z, int& low, int& high) const
  {
    if (!this->Planes)
    {
      return this->Beam.ClipRow(cubes, y * edge, z * edge, low, high);
    }
    const double lower[2] = { this->Planes->GetPlace(1, y * edge),
      this->Planes->GetPlace(2, z * edge) };
    const double upper[2] = { this->Planes->GetPlace(1, (y + 1) * edge),
      this->Planes->GetPlace(2, (z + 1) * edge) };
    double begin;
    double end;
    if (!this->Beam.FindRow(lower, upper, begin, end))
    {
      return false;
    }
    low = std::max(low, this->FindNode(edge, 0, begin));
    high = std::min(high, this->FindNode(edge, 0, end));
    return low <= high;
  }

  /// The node of `edge` cells that a place of a rectilinear grid is in.
  int FindNode(double edge, int axis, double place) const
  {
    return static_cast<int>(static_cast<double>(this->Planes->FindCell(axis, place)) / edge);
  }

  struct Place
  {
    int x;
    int y;
    int z;
  };

  void Visit(int number, std::int64_t index, const Place& place, Bricks& bricks)
  {
    if (number == 0)
    {
      const double edge = this->Levels[0].Edge;
      bricks.push_back(
        { static_cast<dsm::BlockId>(index), { place.x * edge, place.y * edge, place.z * edge },
          { (place.x + 1) * edge, (place.y + 1) * edge, (place.z + 1) * edge } });
      return;
    }
    constexpr int ratio = 1 << bricks::MacrocellHierarchy::Shift;
    const int first[3] = { ratio * place.x, ratio * place.y, ratio * place.z };
    const int* size = this->Levels[number - 1].Size;
    const int last[3] = { std::min(first[0] + ratio, size[0]), std::min(first[1] + ratio, size[1]),
      std::min(first[2] + ratio, size[2]) };
    this->VisitBox(number - 1, first, last, bricks);
  }

  const std::vector<bricks::MacrocellHierarchy::Level>& Levels;
  const bricks::GridPlanes* Planes; ///< of a rectilinear grid, or null
  const Predicate& MayHold;
  const RayBeam& Beam;
  std::vector<RayBeam::Cubes> Cubes; ///< one for each level
};

/// The bricks of a lattice that hold what rays between those of `corners`, in order around them, look for.
template <class Predicate>
BeamBricks FindBeamBricks(const LatticeField& field, const Predicate& mayHold, const Ray corners[4])
{
  const IndexSpace space = field.GetIndexSpace();
  RayBeam beam;
  if (!beam.Set(space, corners))
  {
    return BeamBricks();
  }
  return BeamDescent<Predicate>(field.Voxels->Hierarchy, mayHold, beam, space.GetPlanes()).Find();
}

} // namespace rt

#endif
