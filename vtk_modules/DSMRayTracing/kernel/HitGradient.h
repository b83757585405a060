// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_HitGradient_h
#define rt_HitGradient_h

#include "DSMCore/Block.h"
#include "DSMRayTracing/brick/VoxelBrick.h"
#include "DSMRayTracing/frame/Scene.h"
#include "DSMRayTracing/kernel/CellHit.h"
#include "DSMRayTracing/kernel/CellNeighbourhood.h"
#include "DSMRayTracing/kernel/IsovalueLevel.h"

#include <algorithm>
#include <cmath>

namespace rt
{

/// The gradient, in index space, of a field at a hit: see CellNeighbourhood::GetGradient, whose
/// operations these are, so that the bits do not depend on where a brick ends.
class HitGradient
{
public:
  /// Where all samples that it needs are in the brick of the hit, are numbers, and none is masked;
  /// else returns false.
  template <class T>
  static bool FindWithin(const VoxelBrick<T>& brick, const CellHit& hit,
    const IsovalueLevel<T>& level, double gradient[3])
  {
    if (!CellNeighbourhood::IsWithin(brick, hit.Cell))
    {
      return false;
    }
    const std::ptrdiff_t row = brick.GetRow();
    const std::ptrdiff_t slice = brick.GetSlice();
    const T* const first =
      brick.GetSamples() + brick.GetOffset(hit.Cell[0], hit.Cell[1], hit.Cell[2]);
    // The two corners of a row at once; y and z count rows.
    const auto load = [&](int x, int y, int z)
    { return level.SubtractPair(first + x + y * row + z * slice); };
    Pair corners[2][2];
    Pair differences[3][2][2];
    for (int z = 0; z < 2; ++z)
    {
      for (int y = 0; y < 2; ++y)
      {
        corners[z][y] = load(0, y, z);
        differences[0][z][y] = 0.5 * (load(1, y, z) - load(-1, y, z));
      }
    }
    for (int other = 0; other < 2; ++other)
    {
      differences[1][other][0] = 0.5 * (corners[other][1] - load(0, -1, other));
      differences[1][other][1] = 0.5 * (load(0, 2, other) - corners[other][0]);
      differences[2][0][other] = 0.5 * (corners[1][other] - load(0, other, -1));
      differences[2][1][other] = 0.5 * (load(0, other, 2) - corners[0][other]);
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      gradient[axis] = CellNeighbourhood::Interpolate(differences[axis], hit.Local);
    }
    return std::isfinite(gradient[0] + gradient[1] + gradient[2]);
  }

  /// At any hit; acquires the bricks that it needs, so no pin may be held.
  template <class T, class Store>
  static void Find(Store& store, typename Store::Worker& worker, const VoxelField& field,
    dsm::BlockId id, const CellHit& cell, double isovalue, double gradient[3])
  {
    const BrickLattice& lattice = field.Lattice;
    const IsovalueLevel<T> level(isovalue);
    const Index3 edge(lattice.GetEdge());
    const Index3 home = lattice.GetBrick(id);
    const Index3 place = home * edge + Index3(cell.Cell[0], cell.Cell[1], cell.Cell[2]);
    const Index3 first = glm::max(place - Index3(1), Index3(0)) / edge;
    const Index3 last = glm::min(place + Index3(1), lattice.GetCells() - Index3(1)) / edge;
    CellNeighbourhood samples;
    if (lattice.HasCellMask())
    {
      samples.Clear();
    }
    else
    {
      samples.CoverWithin(place, lattice.GetCells());
    }
    for (std::int64_t z = first.z; z <= last.z; ++z)
    {
      for (std::int64_t y = first.y; y <= last.y; ++y)
      {
        for (std::int64_t x = first.x; x <= last.x; ++x)
        {
          // Differences along the axes only need the bricks across faces; the others tell no more
          // than whether their cells are blanked.
          const int axesApart = (x != home.x) + (y != home.y) + (z != home.z);
          if (axesApart > 1 && !lattice.HasCellMask())
          {
            continue;
          }
          const Index3 brick(x, y, z);
          const Index3 local = place - brick * edge;
          const int localCell[3] = { static_cast<int>(local.x), static_cast<int>(local.y),
            static_cast<int>(local.z) };
          const typename Store::Pin pin =
            store.Acquire(worker, *field.Segment, lattice.GetId(brick));
          samples.CopyPart(VoxelBrick<T>(pin.GetData()), localCell, level);
        }
      }
    }
    samples.GetGradient(cell.Local, gradient);
  }

private:
  using Pair = CellNeighbourhood::Pair;
};

} // namespace rt

#endif
