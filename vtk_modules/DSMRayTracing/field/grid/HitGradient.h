// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_HitGradient_h
#define rt_HitGradient_h

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMBricks/layout/VoxelField.h"
#include "DSMCore/base/Block.h"
#include "DSMRayTracing/field/grid/CellNeighbourhood.h"
#include "DSMRayTracing/field/grid/CellSteps.h"
#include "DSMRayTracing/field/grid/GradientStencil.h"
#include "DSMRayTracing/field/grid/IsovalueLevel.h"
#include "DSMRayTracing/ray/CellHit.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace rt
{

/// The gradient, in index or grid space, of a field at a hit: see CellNeighbourhood::GetGradient, whose
/// operations these are, so that the bits do not depend on where a brick ends.
class HitGradient
{
public:
  /// Returns false unless all samples that it needs are in the brick of the hit, are finite, and
  /// none is masked. `id`: the brick's, in the field.
  template <class T>
  static bool FindWithin(const bricks::VoxelField& field, dsm::BlockId id,
    const bricks::VoxelBrick<T>& brick, const CellHit& hit, const IsovalueLevel<T>& level,
    double gradient[3])
  {
    GradientStencil stencil;
    return FillWithin(brick, hit, level, stencil) &&
      Evaluate(
        stencil, field, [&] { return field.Lattice.GetBrick(id); }, hit, gradient);
  }

  /// The samples that it needs; false unless they are all in the brick, and none is masked.
  template <class T>
  static bool FillWithin(const bricks::VoxelBrick<T>& brick, const CellHit& hit,
    const IsovalueLevel<T>& level, GradientStencil& stencil)
  {
    if (!CellNeighbourhood::IsWithin(brick, hit.Cell))
    {
      return false;
    }
    const std::ptrdiff_t row = brick.GetRow();
    const std::ptrdiff_t slice = brick.GetSlice();
    const T* const first =
      brick.GetSamples() + brick.GetOffset(hit.Cell[0], hit.Cell[1], hit.Cell[2]);
    stencil.SetCorners(first, row, slice, level);
    stencil.SetFace(0, 0, first - 1, row, slice, level);
    stencil.SetFace(0, 1, first + 2, row, slice, level);
    stencil.SetFace(1, 0, first - row, row, slice, level);
    stencil.SetFace(1, 1, first + 2 * row, row, slice, level);
    stencil.SetFace(2, 0, first - slice, row, slice, level);
    stencil.SetFace(2, 1, first + 2 * slice, row, slice, level);
    return true;
  }

  /// At any hit; acquires the bricks that it needs, so no pin may be held.
  template <class T, class Store>
  static void Find(Store& store, typename Store::Worker& worker, const bricks::VoxelField& field,
    dsm::BlockId id, const CellHit& cell, double isovalue, double gradient[3])
  {
    const IsovalueLevel<T> level(isovalue);
    const bricks::Index3 home = field.Lattice.GetBrick(id);
    if (!FindAcrossFaces(store, worker, field, home, cell, level, gradient))
    {
      FindCarefully(store, worker, field, home, cell, level, gradient);
    }
  }

private:
  /// The gradient of samples around a cell. `getBrick`: position of the brick that has it.
  template <class Samples, class GetBrick>
  [[gnu::always_inline]] static auto Evaluate(const Samples& samples,
    const bricks::VoxelField& field, const GetBrick& getBrick, const CellHit& cell,
    double gradient[3])
  {
    if (!field.Planes)
    {
      return samples.GetGradient(cell.Local, UnitSteps(), gradient);
    }
    const bricks::Index3 place = getBrick() * bricks::Index3(field.Lattice.GetEdge()) +
      bricks::Index3(cell.Cell[0], cell.Cell[1], cell.Cell[2]);
    return samples.GetGradient(cell.Local, CellSteps(*field.Planes, place), gradient);
  }

  /// Returns false if any sample is missing.
  template <class T, class Store>
  static bool FindAcrossFaces(Store& store, typename Store::Worker& worker,
    const bricks::VoxelField& field, const bricks::Index3& home, const CellHit& cell,
    const IsovalueLevel<T>& level, double gradient[3])
  {
    const bricks::BrickLattice& lattice = field.Lattice;
    const int edge = lattice.GetEdge();
    if (lattice.HasCellMask())
    {
      return false;
    }
    GradientStencil stencil;
    {
      const typename Store::Pin pin = store.Acquire(worker, *field.Segment, lattice.GetId(home));
      const bricks::VoxelBrick<T> brick(pin.GetData());
      const int strides[3] = { 1, brick.GetRow(), brick.GetSlice() };
      const T* const first =
        brick.GetSamples() + brick.GetOffset(cell.Cell[0], cell.Cell[1], cell.Cell[2]);
      stencil.SetCorners(first, strides[1], strides[2], level);
      for (int axis = 0; axis < 3; ++axis)
      {
        if (cell.Cell[axis] >= 1)
        {
          stencil.SetFace(axis, 0, first - strides[axis], strides[1], strides[2], level);
        }
        if (cell.Cell[axis] + 2 <= brick.GetCells(axis))
        {
          stencil.SetFace(axis, 1, first + 2 * strides[axis], strides[1], strides[2], level);
        }
      }
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      const std::int64_t place = home[axis] * edge + cell.Cell[axis];
      if (place < 1 || place + 2 > lattice.GetCells()[axis])
      {
        return false;
      }
      for (int side = 0; side < 2; ++side)
      {
        const bool beyond = side == 0 ? cell.Cell[axis] == 0 : cell.Cell[axis] + 1 == edge;
        if (!beyond)
        {
          continue;
        }
        bricks::Index3 next = home;
        next[axis] += side == 0 ? -1 : 1;
        int sample[3] = { cell.Cell[0], cell.Cell[1], cell.Cell[2] };
        // Neighbors share the samples between them.
        sample[axis] = side == 0 ? edge - 1 : 1;
        const typename Store::Pin pin = store.Acquire(worker, *field.Segment, lattice.GetId(next));
        const bricks::VoxelBrick<T> brick(pin.GetData());
        stencil.SetFace(axis, side,
          brick.GetSamples() + brick.GetOffset(sample[0], sample[1], sample[2]), brick.GetRow(),
          brick.GetSlice(), level);
      }
    }
    return Evaluate(
      stencil, field, [&] { return home; }, cell, gradient);
  }

  /// Whatever is missing.
  template <class T, class Store>
  static void FindCarefully(Store& store, typename Store::Worker& worker,
    const bricks::VoxelField& field, const bricks::Index3& home, const CellHit& cell,
    const IsovalueLevel<T>& level, double gradient[3])
  {
    const bricks::BrickLattice& lattice = field.Lattice;
    const bricks::Index3 edge(lattice.GetEdge());
    const bricks::Index3 place =
      home * edge + bricks::Index3(cell.Cell[0], cell.Cell[1], cell.Cell[2]);
    const bricks::Index3 first = glm::max(place - bricks::Index3(1), bricks::Index3(0)) / edge;
    const bricks::Index3 last =
      glm::min(place + bricks::Index3(1), lattice.GetCells() - bricks::Index3(1)) / edge;
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
          const bricks::Index3 brick(x, y, z);
          const bricks::Index3 local = place - brick * edge;
          const int localCell[3] = { static_cast<int>(local.x), static_cast<int>(local.y),
            static_cast<int>(local.z) };
          const typename Store::Pin pin =
            store.Acquire(worker, *field.Segment, lattice.GetId(brick));
          samples.CopyPart(bricks::VoxelBrick<T>(pin.GetData()), localCell, level);
        }
      }
    }
    Evaluate(
      samples, field, [&] { return home; }, cell, gradient);
  }
};

} // namespace rt

#endif
