// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_IsosurfaceSearch_txx
#define rt_IsosurfaceSearch_txx

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/field/grid/GridTraversal.h"
#include "DSMRayTracing/field/grid/IndexSpace.h"
#include "DSMRayTracing/field/grid/IsovalueLevel.h"
#include "DSMRayTracing/look/SheetTransmittance.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <type_traits>

namespace rt
{

template <class Store>
bool IsosurfaceSearch<Store>::Intersect(const Sets& sets, const Ray& ray, Hit& hit) const
{
  const IndexSpace space = sets.Field.GetIndexSpace();
  const bricks::BrickLattice& lattice = sets.Field.Voxels->Lattice;
  return space.VisitLine(ray,
    [&](const auto& line)
    {
      double enter = ray.Min;
      double leave = ray.Max;
      if (!line.Clip(lattice.GetCells(), enter, leave))
      {
        return false;
      }
      return bricks::Dispatch(lattice.GetScalarType(),
        [&](auto sample)
        {
          double gradient[3];
          if (!this->IntersectBricks<decltype(sample)>(sets, line, enter, leave, hit, gradient))
          {
            return false;
          }
          hit.Normal = space.GetNormal(gradient, ray.Direction);
          return true;
        });
    });
}

template <class Store>
template <class T, class Line>
bool IsosurfaceSearch<Store>::IntersectBricks(const Sets& sets, const Line& line, double enter,
  double leave, Hit& hit, double gradient[3]) const
{
  const bricks::VoxelField& field = *sets.Field.Voxels;
  const IsovaluePredicate mayHold(sets.Isovalues);
  Walk<Line> walk(field.Hierarchy, line, mayHold, enter, leave);
  while (walk.Next())
  {
    CellHit cell;
    bool hasGradient = false;
    if (!this->IntersectBrick<T>(sets, line, walk, cell, hit.Isovalue, gradient, hasGradient))
    {
      continue;
    }
    if (!hasGradient)
    {
      HitGradient::Find<T>(this->Blocks, this->Self, field, walk.GetId(), cell,
        sets.Isovalues[hit.Isovalue], gradient);
    }
    hit.T = cell.T;
    hit.At.Brick = walk.GetId();
    hit.FromInside = cell.FromInside;
    for (int axis = 0; axis < 3; ++axis)
    {
      hit.At.IndexPoint[axis] = walk.GetOrigin()[axis] + cell.Cell[axis] + cell.Local[axis];
      hit.At.Cell[axis] = static_cast<int>(walk.GetOrigin()[axis]) + cell.Cell[axis];
    }
    return true;
  }
  return false;
}

template <class Store>
template <class T, class Line>
bool IsosurfaceSearch<Store>::IntersectBrick(const Sets& sets, const Line& line,
  const Walk<Line>& walk, CellHit& cell, int& isovalue, double gradient[3], bool& hasGradient) const
{
  const typename Store::Pin pin =
    this->Blocks.Acquire(this->Self, *sets.Field.Voxels->Segment, walk.GetId());
  const bricks::VoxelBrick<T> voxels(pin.GetData());
  const bricks::ValueRange range{ voxels.GetHeader().First, voxels.GetHeader().Last };
  const GridTraversal<T, Line> traversal(line, voxels, walk.GetOrigin());
  bool found = false;
  double limit = std::numeric_limits<double>::infinity();
  for (std::size_t index = 0; index < sets.Isovalues.size(); ++index)
  {
    CellHit candidate;
    if (range.MayHold(sets.Isovalues[index]) &&
      traversal.FindFirst(IsovalueLevel<T>(sets.Isovalues[index]), walk.GetEnter(), walk.GetLeave(),
        limit, candidate) &&
      candidate.T < limit)
    {
      found = true;
      limit = candidate.T;
      cell = candidate;
      isovalue = static_cast<int>(index);
    }
  }
  if (!found)
  {
    return false;
  }
  hasGradient = HitGradient::FindWithin(*sets.Field.Voxels, walk.GetId(), voxels, cell,
    IsovalueLevel<T>(sets.Isovalues[isovalue]), gradient);
  return true;
}

template <class Store>
bool IsosurfaceSearch<Store>::IsOccluded(const Sets& sets, const Ray& ray) const
{
  return this->SearchBricks(sets, ray,
    [&](auto sample, const auto& traversal, const bricks::ValueRange& range, const auto& walk)
    {
      return std::any_of(sets.Isovalues.begin(), sets.Isovalues.end(),
        [&](double isovalue)
        {
          return range.MayHold(isovalue) &&
            traversal.HasHit(
              IsovalueLevel<decltype(sample)>(isovalue), walk.GetEnter(), walk.GetLeave());
        });
    });
}

template <class Store>
bool IsosurfaceSearch<Store>::Attenuate(const Sets& sets, const std::vector<glm::dvec3>& sheets,
  const Ray& ray, glm::dvec3& transmittance) const
{
  return this->SearchBricks(sets, ray,
    [&](auto sample, const auto& traversal, const bricks::ValueRange& range, const auto& walk)
    {
      for (std::size_t index = 0; index < sheets.size(); ++index)
      {
        const double isovalue = sets.Isovalues[index];
        if (range.MayHold(isovalue) &&
          PassSheet(sheets[index],
            traversal.CountHits(
              IsovalueLevel<decltype(sample)>(isovalue), walk.GetEnter(), walk.GetLeave()),
            transmittance))
        {
          return true;
        }
      }
      return false;
    });
}

template <class Store>
template <class IsDone>
bool IsosurfaceSearch<Store>::SearchBricks(
  const Sets& sets, const Ray& ray, const IsDone& isDone) const
{
  const IndexSpace space = sets.Field.GetIndexSpace();
  const bricks::VoxelField& field = *sets.Field.Voxels;
  return space.VisitLine(ray,
    [&](const auto& line)
    {
      using Line = std::decay_t<decltype(line)>;
      double enter = ray.Min;
      double leave = ray.Max;
      if (!line.Clip(field.Lattice.GetCells(), enter, leave))
      {
        return false;
      }
      return bricks::Dispatch(field.Lattice.GetScalarType(),
        [&](auto sample)
        {
          using T = decltype(sample);
          const dsm::BlockSegment& segment = *field.Segment;
          const IsovaluePredicate mayHold(sets.Isovalues);
          Walk<Line> walk(field.Hierarchy, line, mayHold, enter, leave);
          while (walk.Next())
          {
            const typename Store::Pin pin = this->Blocks.Acquire(this->Self, segment, walk.GetId());
            const bricks::VoxelBrick<T> voxels(pin.GetData());
            const bricks::ValueRange range{ voxels.GetHeader().First, voxels.GetHeader().Last };
            const GridTraversal<T, Line> traversal(line, voxels, walk.GetOrigin());
            if (isDone(sample, traversal, range, walk))
            {
              return true;
            }
          }
          return false;
        });
    });
}

} // namespace rt

#endif
