// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LatticeSampler_txx
#define rt_LatticeSampler_txx

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/field/grid/HitGradient.h"
#include "DSMRayTracing/field/grid/IsovalueLevel.h"
#include "DSMRayTracing/field/grid/TrilinearCell.h"
#include "DSMRayTracing/look/PackedColor.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <tuple>

namespace rt
{

/// Equal infinite values have no others between them, though their difference is NaN.
inline double EvaluateWithInfinite(const double corners[8], const Lanes& local)
{
  const double value = EvaluateTrilinear(corners, local);
  return std::isnan(value) ? std::accumulate(corners, corners + 8, 0.0) : value;
}

inline double EvaluateNearest(const double corners[8], const Lanes& local)
{
  const auto isSecond = [&](int axis) { return local[axis] >= 0.5 ? 1 : 0; };
  return corners[isSecond(0) | isSecond(1) << 1 | isSecond(2) << 2];
}

/// Reads cells of a field, and keeps the pin of the brick that it has read last.
template <class Store>
template <class T>
class LatticeSampler<Store>::Reader
{
public:
  Reader(const LatticeSampler& sampler, const bricks::VoxelField& field)
    : Sampler(sampler)
    , Field(field)
  {
  }

  /// Samples at the corners of such a cell that the point is in, and where in the cell it is; false where there is
  /// none.
  bool FindCorners(
    const glm::dvec3& indexPoint, T corners[8], Lanes& local, Corners which = Corners::Finite)
  {
    return this->AnyCellHas(indexPoint,
      [&](const bricks::Index3& cell)
      {
        const glm::dvec3 inside = indexPoint - glm::dvec3(cell);
        local = Lanes(inside.x, inside.y, inside.z, 0.0);
        return this->GetCorners(cell, corners, which);
      });
  }

  /// The value, in a field of cells, of the place's cell, or of another one that the point is in, too; false where none
  /// is there.
  bool FindCell(const LatticePlace& place, T& value)
  {
    return this->GetCell(place.GetCell(), value) ||
      this->AnyCellHas(
        place.IndexPoint, [&](const bricks::Index3& cell) { return this->GetCell(cell, value); });
  }

  bool GetCorners(const bricks::Index3& cell, T corners[8], Corners which = Corners::Finite)
  {
    const bricks::VoxelBrick<T> voxels = this->Enter(cell);
    const glm::ivec3 local(cell - this->Brick * bricks::Index3(this->Field.Lattice.GetEdge()));
    if (which == Corners::Finite ? !voxels.HoldsData(local.x, local.y, local.z)
                                 : !voxels.IsCovered(local.x, local.y, local.z))
    {
      return false;
    }
    for (int corner = 0; corner < 8; ++corner)
    {
      corners[corner] = voxels.GetSample(
        local.x + (corner & 1), local.y + (corner >> 1 & 1), local.z + (corner >> 2));
    }
    return true;
  }

private:
  /// Calls `has(cell)` for the cells that a point is in, until it says yes; returns whether it did.
  template <class Has>
  bool AnyCellHas(const glm::dvec3& indexPoint, const Has& has)
  {
    const bricks::Index3 cells = this->Field.Lattice.GetCells();
    bricks::Index3 cell;
    for (int axis = 0; axis < 3; ++axis)
    {
      if (!(indexPoint[axis] >= 0.0 && indexPoint[axis] <= static_cast<double>(cells[axis])))
      {
        return false;
      }
      cell[axis] = std::min(static_cast<std::int64_t>(indexPoint[axis]), cells[axis] - 1);
    }
    // A point on a face belongs to the cells on both sides; either may hold data.
    for (int side = 0; side < 8; ++side)
    {
      const bricks::Index3 back(side & 1, side >> 1 & 1, side >> 2);
      bool touches = true;
      for (int axis = 0; axis < 3; ++axis)
      {
        touches = touches &&
          (back[axis] == 0 ||
            (cell[axis] > 0 && indexPoint[axis] == static_cast<double>(cell[axis])));
      }
      if (touches && has(cell - back))
      {
        return true;
      }
    }
    return false;
  }

  /// The value of a cell of a field of cells.
  bool GetCell(const bricks::Index3& cell, T& value)
  {
    const bricks::VoxelBrick<T> voxels = this->Enter(cell);
    const glm::ivec3 local(cell - this->Brick * bricks::Index3(this->Field.Lattice.GetEdge()));
    value = voxels.GetSample(local.x, local.y, local.z);
    return voxels.IsCovered(local.x, local.y, local.z);
  }

  /// The brick of a cell.
  bricks::VoxelBrick<T> Enter(const bricks::Index3& cell)
  {
    const bricks::Index3 brick = cell / bricks::Index3(this->Field.Lattice.GetEdge());
    if (!this->Pin || brick != this->Brick)
    {
      this->Pin.reset();
      this->Brick = brick;
      this->Pin.reset(new typename Store::Pin(this->Sampler.Blocks.Acquire(
        this->Sampler.Self, *this->Field.Segment, this->Field.Lattice.GetId(brick))));
    }
    return bricks::VoxelBrick<T>(this->Pin->GetData());
  }

  const LatticeSampler& Sampler;
  const bricks::VoxelField& Field;
  bricks::Index3 Brick{ 0 };
  std::unique_ptr<typename Store::Pin> Pin; ///< pins cannot be moved
};

template <class Store>
template <class T, class Visit>
void LatticeSampler<Store>::VisitPlaces(const bricks::VoxelField& field, const LatticePlace* places,
  RayMask wanted, const Visit& visit) const
{
  Reader<T> reader(*this, field);
  while (wanted != 0)
  {
    std::optional<dsm::BlockId> brick;
    const RayMask here = FindRays(wanted,
      [&](int index)
      {
        brick = brick.value_or(places[index].Brick);
        return places[index].Brick == *brick;
      });
    ForEachRay(here, [&](int index) { visit(reader, index); });
    wanted &= ~here;
  }
}

template <class Store>
template <class Evaluate>
RayMask LatticeSampler<Store>::FindValues(const bricks::VoxelField& field,
  const LatticePlace* places, RayMask wanted, double* values, const Evaluate& evaluate) const
{
  const bool ofCells = field.Lattice.IsOfCells();
  RayMask found = 0;
  bricks::Dispatch(field.Lattice.GetScalarType(),
    [&](auto sample)
    {
      using T = decltype(sample);
      this->VisitPlaces<T>(field, places, wanted,
        [&](Reader<T>& reader, int index)
        {
          values[index] = std::numeric_limits<double>::quiet_NaN();
          if (ofCells)
          {
            T value;
            if (reader.FindCell(places[index], value))
            {
              found |= GetBit(index);
              values[index] = static_cast<double>(value);
            }
            return;
          }
          const glm::dvec3& point = places[index].IndexPoint;
          T corners[8];
          Lanes local;
          if (reader.FindCorners(point, corners, local) ||
            reader.FindCorners(point, corners, local, Corners::Any))
          {
            found |= GetBit(index);
            double numbers[8];
            std::transform(
              corners, corners + 8, numbers, [](T value) { return static_cast<double>(value); });
            values[index] = evaluate(numbers, local);
          }
        });
    });
  return found;
}

template <class Store>
RayMask LatticeSampler<Store>::FindValues(
  const bricks::VoxelField& field, const LatticePlace* places, RayMask wanted, double* values) const
{
  return this->FindValues(field, places, wanted, values, EvaluateWithInfinite);
}

template <class Store>
RayMask LatticeSampler<Store>::FindNearestValues(
  const bricks::VoxelField& field, const LatticePlace* places, RayMask wanted, double* values) const
{
  return this->FindValues(field, places, wanted, values, EvaluateNearest);
}

template <class Store>
void LatticeSampler<Store>::FindGradients(const bricks::VoxelField& field,
  const LatticePlace* places, RayMask wanted, glm::dvec3* gradients) const
{
  bricks::Dispatch(field.Lattice.GetScalarType(),
    [&](auto sample)
    {
      using T = decltype(sample);
      this->VisitPlaces<T>(field, places, wanted,
        [&](Reader<T>& reader, int index)
        {
          T corners[8] = {};
          reader.GetCorners(places[index].GetCell(), corners);
          double numbers[8];
          std::transform(
            corners, corners + 8, numbers, [](T value) { return static_cast<double>(value); });
          const glm::dvec3 inside = places[index].IndexPoint - glm::dvec3(places[index].Cell);
          DifferentiateTrilinear(
            numbers, Lanes(inside.x, inside.y, inside.z, 0.0), &gradients[index].x);
          for (int axis = 0; field.Planes && axis < 3; ++axis)
          {
            gradients[index][axis] *= field.Planes->GetInverseWidths(
              axis)[static_cast<std::size_t>(places[index].Cell[axis])];
          }
        });
    });
}

template <class Store>
void LatticeSampler<Store>::FindSmoothGradients(const LatticeField& field,
  const std::vector<glm::dvec3>& points, std::vector<glm::dvec3>& gradients) const
{
  std::vector<Asked> all(points.size());
  for (std::size_t number = 0; number < points.size(); ++number)
  {
    all[number].Number = number;
    FindCell(field, points[number], all[number]);
  }
  std::sort(all.begin(), all.end(),
    [](const Asked& one, const Asked& other)
    { return std::tie(one.Brick, one.Number) < std::tie(other.Brick, other.Number); });
  bricks::Dispatch(field.Voxels->Lattice.GetScalarType(),
    [&](auto sample)
    {
      using T = decltype(sample);
      for (auto begin = all.begin(); begin != all.end();)
      {
        const auto end = std::find_if(
          begin, all.end(), [&](const Asked& asked) { return asked.Brick != begin->Brick; });
        const auto beyond = this->FindGradientsWithin<T>(field, begin, end, gradients);
        for (const Asked* asked : beyond)
        {
          HitGradient::Find<T>(this->Blocks, this->Self, *field.Voxels, asked->Brick, asked->Cell,
            0.0, &gradients[asked->Number].x);
        }
        begin = end;
      }
    });
}

template <class Store>
void LatticeSampler<Store>::FindCell(
  const LatticeField& field, const glm::dvec3& point, Asked& asked)
{
  const LatticePlace place = field.GetPlace(point);
  asked.Brick = place.Brick;
  const int edge = field.Voxels->Lattice.GetEdge();
  for (int axis = 0; axis < 3; ++axis)
  {
    asked.Cell.Cell[axis] = place.Cell[axis] % edge;
  }
  const glm::dvec3 inside = place.IndexPoint - glm::dvec3(place.Cell);
  asked.Cell.Local = Lanes(inside.x, inside.y, inside.z, 0.0);
}

template <class Store>
template <class T, class Iterator>
std::vector<const typename LatticeSampler<Store>::Asked*>
LatticeSampler<Store>::FindGradientsWithin(
  const LatticeField& field, Iterator begin, Iterator end, std::vector<glm::dvec3>& gradients) const
{
  std::vector<const Asked*> beyond;
  const IsovalueLevel<T> level(0.0);
  const typename Store::Pin pin =
    this->Blocks.Acquire(this->Self, *field.Voxels->Segment, begin->Brick);
  const bricks::VoxelBrick<T> voxels(pin.GetData());
  for (auto asked = begin; asked != end; ++asked)
  {
    if (!HitGradient::FindWithin(
          *field.Voxels, asked->Brick, voxels, asked->Cell, level, &gradients[asked->Number].x))
    {
      beyond.push_back(&*asked);
    }
  }
  return beyond;
}

template <class Store>
RayMask LatticeSampler<Store>::FindColors(const bricks::VoxelField& field,
  const LatticePlace* places, RayMask wanted, glm::vec4* colors) const
{
  const bool ofCells = field.Lattice.IsOfCells();
  RayMask found = 0;
  this->VisitPlaces<std::uint32_t>(field, places, wanted,
    [&](Reader<std::uint32_t>& reader, int index)
    {
      std::uint32_t corners[8] = {};
      Lanes local;
      if (ofCells)
      {
        found |= GetBit(index, reader.FindCell(places[index], corners[0]));
        colors[index] = PackedColor::Get(corners[0]);
      }
      else if (reader.FindCorners(places[index].IndexPoint, corners, local))
      {
        found |= GetBit(index);
        for (int channel = 0; channel < 4; ++channel)
        {
          double values[8];
          std::transform(corners, corners + 8, values,
            [=](std::uint32_t packed)
            { return static_cast<double>(PackedColor::Get(packed)[channel]); });
          colors[index][channel] = static_cast<float>(EvaluateTrilinear(values, local));
        }
      }
    });
  return found;
}

} // namespace rt

#endif
