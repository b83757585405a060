// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_BorderedBrick_h
#define rt_BorderedBrick_h

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMBricks/layout/VoxelField.h"
#include "DSMCore/base/Block.h"
#include "DSMRayTracing/field/lattice/TypedMediumBrick.h"
#include "DSMRayTracing/look/TransferFunction.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace rt
{

/// Copies a brick with the samples next to it, which central differences in its cells need: those across its faces, but
/// not across its edges. The volume's border is extrapolated, so that the difference there is that of the two samples
/// next to it.
template <class T>
class BorderedBrick
{
public:
  /// Returns places in the function, which are kept in `memory` for a while, since neighboring packets of rays go
  /// through the same bricks. Acquires bricks, so no pin may be held.
  template <class Store>
  static const float* Get(Store& store, typename Store::Worker& worker,
    const bricks::VoxelField& field, dsm::BlockId id, const TransferFunction& function,
    MediumBrickMemory& memory)
  {
    const auto points = static_cast<std::size_t>(field.Lattice.GetEdge() + 3);
    memory.Bordered.SetCount(GetCount(points * points * points * sizeof(float)));
    return memory.Bordered
      .Get(
        id, [&](std::vector<float>& samples) { Fill(store, worker, field, id, function, samples); })
      .data();
  }

private:
  /// Bricks of so many bytes that are kept: a power of two.
  static std::size_t GetCount(std::size_t bytes)
  {
    constexpr std::size_t most = std::size_t{ 16 } << 20;
    std::size_t count = 64;
    while (2 * count * bytes <= most)
    {
      count *= 2;
    }
    return count;
  }

  template <class Store>
  static void Fill(Store& store, typename Store::Worker& worker, const bricks::VoxelField& field,
    dsm::BlockId id, const TransferFunction& function, std::vector<float>& samples)
  {
    const bricks::Index3 home = field.Lattice.GetBrick(id);
    const bricks::Index3 cells = field.Lattice.GetCellsOfBrick(id).GetSize();
    BorderedBrick all(cells, function, samples);
    {
      const typename Store::Pin pin = store.Acquire(worker, *field.Segment, id);
      all.CopyInner(bricks::VoxelBrick<T>(pin.GetData()));
    }
    const bricks::Index3 edge(field.Lattice.GetEdge());
    for (int axis = 0; axis < 3; ++axis)
    {
      for (const int side : { 0, 1 })
      {
        bricks::Index3 next = home;
        next[axis] += side == 0 ? -1 : 1;
        const bool isInside =
          next[axis] >= 0 && next[axis] * edge[axis] < field.Lattice.GetCells()[axis];
        if (isInside)
        {
          const typename Store::Pin pin =
            store.Acquire(worker, *field.Segment, field.Lattice.GetId(next));
          all.CopyFace(axis, side, bricks::VoxelBrick<T>(pin.GetData()));
        }
        else
        {
          all.GoOn(axis, side);
        }
      }
    }
  }

  BorderedBrick(
    const bricks::Index3& cells, const TransferFunction& function, std::vector<float>& samples)
    : Origin(function.GetOrigin())
    , Scale(function.GetScale())
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Points[axis] = static_cast<int>(cells[axis]) + 1;
    }
    this->Strides[1] = this->Points[0] + 2;
    this->Strides[2] = this->Strides[1] * (this->Points[1] + 2);
    samples.resize(
      static_cast<std::size_t>(this->Strides[2]) * static_cast<std::size_t>(this->Points[2] + 2));
    this->First = samples.data() + 1 + this->Strides[1] + this->Strides[2];
  }

  float ToPlace(T sample) const
  {
    return static_cast<float>((static_cast<double>(sample) - this->Origin) * this->Scale);
  }

  void CopyInner(const bricks::VoxelBrick<T>& brick)
  {
    for (int z = 0; z < this->Points[2]; ++z)
    {
      for (int y = 0; y < this->Points[1]; ++y)
      {
        const T* const from = brick.GetSamples() + brick.GetOffset(0, y, z);
        float* const to = this->First + y * this->Strides[1] + z * this->Strides[2];
        for (int x = 0; x < this->Points[0]; ++x)
        {
          to[x] = this->ToPlace(from[x]);
        }
      }
    }
  }

  /// Calls `set(to, x, y, z)` for each point of a face's border, where the brick's own point next to it has these
  /// coordinates.
  template <class Set>
  void ForFace(int axis, int side, const Set& set)
  {
    int first[3] = { 0, 0, 0 };
    int last[3] = { this->Points[0], this->Points[1], this->Points[2] };
    first[axis] = side == 0 ? 0 : this->Points[axis] - 1;
    last[axis] = first[axis] + 1;
    const int beyond = (side == 0 ? -1 : 1) * this->Strides[axis];
    for (int z = first[2]; z < last[2]; ++z)
    {
      for (int y = first[1]; y < last[1]; ++y)
      {
        float* const row = this->First + y * this->Strides[1] + z * this->Strides[2] + beyond;
        for (int x = first[0]; x < last[0]; ++x)
        {
          set(row + x, x, y, z);
        }
      }
    }
  }

  /// Neighbors share the samples between them.
  void CopyFace(int axis, int side, const bricks::VoxelBrick<T>& neighbor)
  {
    this->ForFace(axis, side,
      [&](float* to, int x, int y, int z)
      {
        int point[3] = { x, y, z };
        point[axis] = side == 0 ? neighbor.GetCells(axis) - 1 : 1;
        *to = this->ToPlace(neighbor.GetSample(point[0], point[1], point[2]));
      });
  }

  void GoOn(int axis, int side)
  {
    const int inward = (side == 0 ? 1 : -1) * this->Strides[axis];
    this->ForFace(
      axis, side, [&](float* to, int, int, int) { *to = 2.0f * to[inward] - to[2 * inward]; });
  }

  double Origin;
  double Scale;
  int Points[3];
  int Strides[3] = { 1, 0, 0 };
  float* First; ///< the brick's first sample
};

} // namespace rt

#endif
