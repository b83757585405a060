// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_FieldSampler_txx
#define rt_FieldSampler_txx

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/surface/PackedColor.h"
#include "DSMRayTracing/volume/TrilinearCell.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace rt
{

/// Between infinite values there are no others, though their difference is no number.
inline double EvaluateWithInfinite(const double corners[8], const Lanes& local)
{
  const double value = EvaluateTrilinear(corners, local);
  return std::isnan(value) ? std::accumulate(corners, corners + 8, 0.0) : value;
}

template <class Store>
double FieldSampler<Store>::Sample(
  const bricks::VoxelField& field, const glm::dvec3& indexPoint) const
{
  return this->Evaluate(field, indexPoint, EvaluateWithInfinite);
}

template <class Store>
double FieldSampler<Store>::SampleNearest(
  const bricks::VoxelField& field, const glm::dvec3& indexPoint) const
{
  return this->Evaluate(field, indexPoint,
    [](const double corners[8], const Lanes& local)
    {
      const auto isSecond = [&](int axis) { return local[axis] >= 0.5 ? 1 : 0; };
      return corners[isSecond(0) | isSecond(1) << 1 | isSecond(2) << 2];
    });
}

template <class Store>
template <class Function>
double FieldSampler<Store>::Evaluate(
  const bricks::VoxelField& field, const glm::dvec3& indexPoint, const Function& function) const
{
  return bricks::Dispatch(field.Lattice.GetScalarType(),
    [&](auto sample)
    {
      decltype(sample) corners[8];
      Lanes local;
      if (!this->FindCorners(field, indexPoint, corners, local) &&
        !this->FindCorners(field, indexPoint, corners, local, Corners::Any))
      {
        return std::numeric_limits<double>::quiet_NaN();
      }
      double values[8];
      std::transform(
        corners, corners + 8, values, [](auto value) { return static_cast<double>(value); });
      return function(values, local);
    });
}

template <class Store>
glm::dvec3 FieldSampler<Store>::GetGradient(
  const bricks::VoxelField& field, const bricks::Index3& cell, const glm::dvec3& indexPoint) const
{
  return bricks::Dispatch(field.Lattice.GetScalarType(),
    [&](auto sample)
    {
      decltype(sample) corners[8] = {};
      this->GetCorners(field, cell, corners);
      double values[8];
      std::transform(
        corners, corners + 8, values, [](auto value) { return static_cast<double>(value); });
      const glm::dvec3 inside = indexPoint - glm::dvec3(cell);
      glm::dvec3 gradient;
      DifferentiateTrilinear(values, Lanes(inside.x, inside.y, inside.z, 0.0), &gradient.x);
      return gradient;
    });
}

template <class Store>
double FieldSampler<Store>::GetOfCell(
  const bricks::VoxelField& field, const bricks::Index3& cell) const
{
  return bricks::Dispatch(field.Lattice.GetScalarType(),
    [&](auto value)
    {
      return this->GetCell(field, cell, value) ? static_cast<double>(value)
                                               : std::numeric_limits<double>::quiet_NaN();
    });
}

template <class Store>
bool FieldSampler<Store>::SampleColor(
  const bricks::VoxelField& field, const glm::dvec3& indexPoint, glm::vec4& color) const
{
  std::uint32_t corners[8];
  Lanes local;
  if (!this->FindCorners(field, indexPoint, corners, local))
  {
    return false;
  }
  for (int channel = 0; channel < 4; ++channel)
  {
    double values[8];
    std::transform(corners, corners + 8, values,
      [=](std::uint32_t packed) { return static_cast<double>(PackedColor::Get(packed)[channel]); });
    color[channel] = static_cast<float>(EvaluateTrilinear(values, local));
  }
  return true;
}

template <class Store>
bool FieldSampler<Store>::GetColorOfCell(
  const bricks::VoxelField& field, const bricks::Index3& cell, glm::vec4& color) const
{
  std::uint32_t packed = 0;
  const bool found = this->GetCell(field, cell, packed);
  color = PackedColor::Get(packed);
  return found;
}

template <class Store>
template <class T>
bool FieldSampler<Store>::FindCorners(const bricks::VoxelField& field, const glm::dvec3& indexPoint,
  T corners[8], Lanes& local, Corners which) const
{
  const bricks::Index3 cells = field.Lattice.GetCells();
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
    if (touches && this->GetCorners(field, cell - back, corners, which))
    {
      const glm::dvec3 inside = indexPoint - glm::dvec3(cell - back);
      local = Lanes(inside.x, inside.y, inside.z, 0.0);
      return true;
    }
  }
  return false;
}

template <class Store>
template <class T>
bool FieldSampler<Store>::GetCorners(
  const bricks::VoxelField& field, const bricks::Index3& cell, T corners[8], Corners which) const
{
  const bricks::Index3 brick = cell / bricks::Index3(field.Lattice.GetEdge());
  const glm::ivec3 local(cell - brick * bricks::Index3(field.Lattice.GetEdge()));
  const typename Store::Pin pin =
    this->Blocks.Acquire(this->Self, *field.Segment, field.Lattice.GetId(brick));
  const bricks::VoxelBrick<T> voxels(pin.GetData());
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

template <class Store>
template <class T>
bool FieldSampler<Store>::GetCell(
  const bricks::VoxelField& field, const bricks::Index3& cell, T& value) const
{
  const bricks::Index3 brick = cell / bricks::Index3(field.Lattice.GetEdge());
  const glm::ivec3 local(cell - brick * bricks::Index3(field.Lattice.GetEdge()));
  const typename Store::Pin pin =
    this->Blocks.Acquire(this->Self, *field.Segment, field.Lattice.GetId(brick));
  const bricks::VoxelBrick<T> voxels(pin.GetData());
  value = voxels.GetSample(local.x, local.y, local.z);
  return voxels.IsCovered(local.x, local.y, local.z);
}

} // namespace rt

#endif
