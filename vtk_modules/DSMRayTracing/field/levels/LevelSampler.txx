// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LevelSampler_txx
#define rt_LevelSampler_txx

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/base/Lanes.h"
#include "DSMRayTracing/field/grid/TrilinearCell.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

namespace rt
{

/// Reads cells and points of a field, and keeps the pin of the brick that it has read last.
template <class Store>
template <class T>
class LevelSampler<Store>::Reader
{
public:
  Reader(const LevelSampler& sampler, const bricks::LevelVoxels& field)
    : Sampler(sampler)
    , Field(field)
  {
  }

  /// Returns whether a cell of a brick is a leaf.
  bool IsLeaf(dsm::BlockId id, const bricks::Index3& cell)
  {
    const bricks::LevelBrick& brick = this->Field.Lattice.GetBrick(id);
    const glm::ivec3 at(cell - brick.Cells.Min);
    return !brick.HasMask || this->Enter(id).IsCovered(at.x, at.y, at.z);
  }

  /// Finds the corners of a leaf of a brick; returns false if the cell is not a leaf, or has a corner that is not
  /// finite.
  bool GetCorners(dsm::BlockId id, const bricks::Index3& cell, double corners[8])
  {
    const bricks::LevelBrick& brick = this->Field.Lattice.GetBrick(id);
    if (!brick.Has(cell))
    {
      return false;
    }
    const bricks::VoxelBrick<T> voxels = this->Enter(id);
    const glm::ivec3 at(cell - brick.Cells.Min);
    if (!voxels.HoldsData(at.x, at.y, at.z))
    {
      return false;
    }
    for (int corner = 0; corner < 8; ++corner)
    {
      corners[corner] = static_cast<double>(
        voxels.GetSample(at.x + (corner & 1), at.y + (corner >> 1 & 1), at.z + (corner >> 2)));
    }
    return true;
  }

  /// The value at a point of a level, which may be within a cell of a coarser one. The level's own leaves are asked
  /// first, then those of coarser and of finer ones, nearer levels first. False where there are no data.
  bool FindPoint(int level, const bricks::Index3& point, double& value)
  {
    if (this->FindPointInBrick(level, point, value))
    {
      return true;
    }
    const int levels = this->Field.Lattice.GetScales().GetCount();
    for (int apart = 0; apart < levels; ++apart)
    {
      if (this->FindPointOf(level - apart, level, point, value) ||
        (apart > 0 && this->FindPointOf(level + apart, level, point, value)))
      {
        return true;
      }
    }
    return false;
  }

private:
  /// The same in the brick that was read last, if it is of that level.
  bool FindPointInBrick(int level, const bricks::Index3& point, double& value)
  {
    if (!this->Pin)
    {
      return false;
    }
    const bricks::LevelBrick& brick = this->Field.Lattice.GetBrick(this->Brick);
    const glm::ivec3 at(point - brick.Cells.Min);
    const glm::ivec3 cells(brick.Cells.Max - brick.Cells.Min);
    if (brick.Level != level || glm::any(glm::lessThan(at, glm::ivec3(0))) ||
      glm::any(glm::greaterThan(at, cells)))
    {
      return false;
    }
    const bricks::VoxelBrick<T> voxels(this->Pin->GetData());
    bool isCorner = !brick.HasMask;
    for (int octant = 0; octant < 8 && !isCorner; ++octant)
    {
      const glm::ivec3 cell = at - glm::ivec3(octant & 1, octant >> 1 & 1, octant >> 2);
      isCorner = glm::all(glm::greaterThanEqual(cell, glm::ivec3(0))) &&
        glm::all(glm::lessThan(cell, cells)) && voxels.IsCovered(cell.x, cell.y, cell.z);
    }
    value = isCorner ? static_cast<double>(voxels.GetSample(at.x, at.y, at.z)) : value;
    return isCorner;
  }

  /// The same among the leaves of level `other`.
  bool FindPointOf(int other, int level, const bricks::Index3& point, double& value)
  {
    const bricks::LevelScales& scales = this->Field.Lattice.GetScales();
    if (other < 0 || other >= scales.GetCount())
    {
      return false;
    }
    const bricks::Index3 from = scales.Get(level);
    const bricks::Index3 to = scales.Get(other);
    const bricks::Index3 there = point * to; // in parts of 1 / from
    const bricks::Index3 base = bricks::DivideDown(there, from);
    const bricks::Index3 rest = there - base * from;
    for (int octant = 0; octant < 8; ++octant)
    {
      const bricks::Index3 back(octant & 1, octant >> 1 & 1, octant >> 2);
      if (glm::any(glm::greaterThan(back * rest, bricks::Index3(0))))
      {
        continue; // not on that face
      }
      const bricks::Index3 cell = base - back;
      double corners[8];
      const dsm::BlockId id = this->Field.Lattice.Find(other, cell);
      if (id != bricks::LevelLattice::None && this->GetCorners(id, cell, corners))
      {
        const glm::dvec3 local = glm::dvec3(there - cell * from) / glm::dvec3(from);
        value = EvaluateTrilinear(corners, Lanes(local.x, local.y, local.z, 0.0));
        return true;
      }
    }
    return false;
  }

  bricks::VoxelBrick<T> Enter(dsm::BlockId id)
  {
    if (!this->Pin || id != this->Brick)
    {
      this->Pin.reset();
      this->Brick = id;
      this->Pin.reset(new typename Store::Pin(
        this->Sampler.Blocks.Acquire(this->Sampler.Self, *this->Field.Segment, id)));
    }
    return bricks::VoxelBrick<T>(this->Pin->GetData());
  }

  const LevelSampler& Sampler;
  const bricks::LevelVoxels& Field;
  dsm::BlockId Brick = bricks::LevelLattice::None;
  std::unique_ptr<typename Store::Pin> Pin; ///< pins cannot be moved
};

template <class Store>
bool LevelSampler<Store>::FindLeaf(
  const bricks::LevelVoxels& field, const glm::dvec3& point, LatticePlace& place) const
{
  const bricks::LevelLattice& lattice = field.Lattice;
  return bricks::DispatchSamples(lattice,
    [&](auto sample)
    {
      Reader<decltype(sample)> reader(*this, field);
      for (int level = lattice.GetScales().GetCount() - 1; level >= 0; --level)
      {
        const glm::dvec3 there = point * glm::dvec3(lattice.GetScales().Get(level));
        const bricks::Index3 base(glm::floor(there));
        // A point on a face is in the cells on both sides.
        for (int octant = 0; octant < 8; ++octant)
        {
          const bricks::Index3 back(octant & 1, octant >> 1 & 1, octant >> 2);
          const glm::dvec3 beyond = glm::dvec3(back) * (there - glm::dvec3(base));
          if (beyond != glm::dvec3(0.0))
          {
            continue;
          }
          const bricks::Index3 cell = base - back;
          const dsm::BlockId id = lattice.Find(level, cell);
          if (id != bricks::LevelLattice::None && reader.IsLeaf(id, cell))
          {
            place = { there, glm::ivec3(cell), id };
            return true;
          }
        }
      }
      return false;
    });
}

template <class Store>
template <class Evaluate>
RayMask LevelSampler<Store>::VisitCells(const bricks::LevelVoxels& field,
  const LatticePlace* places, RayMask wanted, const Evaluate& evaluate) const
{
  RayMask found = 0;
  bricks::DispatchSamples(field.Lattice,
    [&](auto sample)
    {
      Reader<decltype(sample)> reader(*this, field);
      RayMask left = wanted;
      while (left != 0)
      {
        std::optional<dsm::BlockId> brick;
        const RayMask here = FindRays(left,
          [&](int index)
          {
            brick = brick.value_or(places[index].Brick);
            return places[index].Brick == *brick;
          });
        left &= ~here;
        if (*brick >= field.Lattice.GetBrickCount())
        {
          continue;
        }
        ForEachRay(here,
          [&](int index)
          {
            double corners[8];
            if (reader.GetCorners(*brick, places[index].GetCell(), corners))
            {
              found |= GetBit(index);
              const glm::dvec3 local =
                glm::clamp(places[index].IndexPoint - glm::dvec3(places[index].Cell), 0.0, 1.0);
              evaluate(index, corners, Lanes(local.x, local.y, local.z, 0.0));
            }
          });
      }
    });
  return found;
}

template <class Store>
RayMask LevelSampler<Store>::FindValues(const bricks::LevelVoxels& field,
  const LatticePlace* places, RayMask wanted, double* values) const
{
  ForEachRay(wanted, [&](int index) { values[index] = std::numeric_limits<double>::quiet_NaN(); });
  return this->VisitCells(field, places, wanted,
    [&](int index, const double corners[8], const Lanes& local)
    { values[index] = EvaluateTrilinear(corners, local); });
}

template <class Store>
RayMask LevelSampler<Store>::FindNearestValues(const bricks::LevelVoxels& field,
  const LatticePlace* places, RayMask wanted, double* values) const
{
  ForEachRay(wanted, [&](int index) { values[index] = std::numeric_limits<double>::quiet_NaN(); });
  return this->VisitCells(field, places, wanted,
    [&](int index, const double corners[8], const Lanes& local)
    {
      const auto isSecond = [&](int axis) { return local[axis] >= 0.5 ? 1 : 0; };
      values[index] = corners[isSecond(0) | isSecond(1) << 1 | isSecond(2) << 2];
    });
}

template <class Store>
void LevelSampler<Store>::FindGradients(const bricks::LevelVoxels& field,
  const LatticePlace* places, RayMask wanted, glm::dvec3* gradients) const
{
  this->VisitCells(field, places, wanted,
    [&](int index, const double corners[8], const Lanes& local)
    {
      DifferentiateTrilinear(corners, local, &gradients[index].x);
      const int level = field.Lattice.GetBrick(places[index].Brick).Level;
      gradients[index] *= glm::dvec3(field.Lattice.GetScales().Get(level));
    });
}

template <class Store>
void LevelSampler<Store>::FindSmoothGradient(
  const bricks::LevelVoxels& field, const LatticePlace& place, glm::dvec3& gradient) const
{
  gradient = glm::dvec3(0.0);
  bricks::DispatchSamples(field.Lattice,
    [&](auto sample)
    {
      Reader<decltype(sample)> reader(*this, field);
      const int level = field.Lattice.GetBrick(place.Brick).Level;
      const bricks::Index3 cell = place.GetCell();
      double corners[8];
      if (!reader.GetCorners(place.Brick, cell, corners))
      {
        return;
      }
      const glm::dvec3 at = glm::clamp(place.IndexPoint - glm::dvec3(cell), 0.0, 1.0);
      const Lanes local(at.x, at.y, at.z, 0.0);
      for (int axis = 0; axis < 3; ++axis)
      {
        double differences[8];
        for (int corner = 0; corner < 8; ++corner)
        {
          // The other end of the cell's edge is on one side, a point beyond the cell on the other.
          const bool isUpper = (corner >> axis & 1) != 0;
          const double within = corners[corner ^ 1 << axis];
          const double step = isUpper ? 1.0 : -1.0;
          bricks::Index3 beyond = cell + bricks::Index3(corner & 1, corner >> 1 & 1, corner >> 2);
          beyond[axis] += isUpper ? 1 : -1;
          double value;
          const bool isThere = reader.FindPoint(level, beyond, value) && std::isfinite(value);
          differences[corner] =
            isThere ? step * 0.5 * (value - within) : step * (corners[corner] - within);
        }
        gradient[axis] = EvaluateTrilinear(differences, local);
      }
      gradient *= glm::dvec3(field.Lattice.GetScales().Get(level));
    });
}

} // namespace rt

#endif
