// SPDX-License-Identifier: BSD-3-Clause
#ifndef tests_Oracle_h
#define tests_Oracle_h

#include "DSMRayTracing/ray/Ray.h"
#include "TestVolume.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

/// The first hit by the slowest and plainest way: every cell of the volume, in long double, its
/// cubic halved between its extrema. Index (or grid) space is world space.
template <class T>
class Oracle
{
public:
  using Real = long double;

  /// Of the isosurface of `isovalue + shift`; kept apart, as the sum may need too many bits.
  Oracle(const TestVolume<T>& volume, Real isovalue, Real shift = 0, Planes planes = nullptr)
    : Volume(volume)
    , Isovalue(isovalue)
    , Shift(shift)
    , Grid(std::move(planes))
  {
  }

  /// T of the first hit.
  std::optional<double> FindFirst(const rt::Ray& ray) const
  {
    std::optional<double> first;
    const bricks::Index3 cells = this->Volume.GetCells();
    for (int z = 0; z < cells.z; ++z)
    {
      for (int y = 0; y < cells.y; ++y)
      {
        for (int x = 0; x < cells.x; ++x)
        {
          const std::optional<double> hit = this->IntersectCell(ray, { x, y, z });
          if (hit && (!first || *hit < *first))
          {
            first = hit;
          }
        }
      }
    }
    return first;
  }

  bool HoldsData(const bricks::Index3& cell) const
  {
    if (!this->Volume.IsCovered(cell.x, cell.y, cell.z))
    {
      return false;
    }
    for (int corner = 0; corner < 8; ++corner)
    {
      if (!std::isfinite(this->GetCorner(cell, corner)))
      {
        return false;
      }
    }
    return true;
  }

  /// The trilinear value less the isovalue.
  Real Evaluate(const bricks::Index3& cell, const rt::Ray& ray, Real t) const
  {
    Real local[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const Real lower = this->GetPlane(axis, cell[axis]);
      local[axis] = (Real(ray.Origin[axis]) + t * Real(ray.Direction[axis]) - lower) /
        (this->GetPlane(axis, cell[axis] + 1) - lower);
      // A ray that runs in a face, or ends on one, has that face's values.
      for (const Real end : { Real(0), Real(1) })
      {
        local[axis] = std::abs(local[axis] - end) < Real(1e-13) ? end : local[axis];
      }
    }
    Real value = 0;
    for (int corner = 0; corner < 8; ++corner)
    {
      Real weight = 1;
      for (int axis = 0; axis < 3; ++axis)
      {
        weight *= (corner >> axis & 1) != 0 ? local[axis] : Real(1) - local[axis];
      }
      value += weight * this->GetCorner(cell, corner);
    }
    return value;
  }

private:
  Real GetPlane(int axis, std::int64_t plane) const
  {
    return this->Grid ? this->Grid->GetPlace(axis, static_cast<double>(plane)) : Real(plane);
  }

  Real GetCorner(const bricks::Index3& cell, int corner) const
  {
    return Real(this->Volume.At(
             cell.x + (corner & 1), cell.y + (corner >> 1 & 1), cell.z + (corner >> 2))) -
      this->Isovalue - this->Shift;
  }

  bool Clip(const rt::Ray& ray, const bricks::Index3& cell, Real& enter, Real& leave) const
  {
    enter = ray.Min;
    leave = ray.Max;
    for (int axis = 0; axis < 3; ++axis)
    {
      const Real origin = ray.Origin[axis];
      const Real direction = ray.Direction[axis];
      const Real lower = this->GetPlane(axis, cell[axis]);
      const Real upper = this->GetPlane(axis, cell[axis] + 1);
      if (direction == 0)
      {
        if (origin < lower || origin > upper)
        {
          return false;
        }
        continue;
      }
      const Real a = (lower - origin) / direction;
      const Real b = (upper - origin) / direction;
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return leave - enter > 1e-15L * std::max<Real>(1, std::abs(leave));
  }

  std::optional<double> IntersectCell(const rt::Ray& ray, const bricks::Index3& cell) const
  {
    Real enter;
    Real leave;
    if (!this->Clip(ray, cell, enter, leave) || !this->HoldsData(cell))
    {
      return {};
    }
    const auto at = [&](Real s) { return this->Evaluate(cell, ray, enter + s * (leave - enter)); };
    // The cubic through four of its values, in the basis 1, s, s^2, s^3.
    const Real f0 = at(0);
    const Real f1 = at(Real(1) / 3);
    const Real f2 = at(Real(2) / 3);
    const Real f3 = at(1);
    const Real c1 = (-11 * f0 + 18 * f1 - 9 * f2 + 2 * f3) / 2;
    const Real c2 = 9 * (2 * f0 - 5 * f1 + 4 * f2 - f3) / 2;
    const Real c3 = 9 * (-f0 + 3 * f1 - 3 * f2 + f3) / 2;
    std::vector<Real> places{ 0 };
    const Real discriminant = c2 * c2 - 3 * c3 * c1;
    if (discriminant > 0)
    {
      const Real q = -(c2 + std::copysign(std::sqrt(discriminant), c2));
      for (const Real place : { q / (3 * c3), c1 / q })
      {
        if (place > 0 && place < 1)
        {
          places.push_back(place);
        }
      }
    }
    std::sort(places.begin(), places.end());
    places.push_back(1);
    for (std::size_t i = 0; i + 1 < places.size(); ++i)
    {
      Real low = places[i];
      Real high = places[i + 1];
      const bool inside = at(low) >= 0;
      if (inside == (at(high) >= 0))
      {
        continue;
      }
      for (int iteration = 0; iteration < 80; ++iteration)
      {
        const Real middle = (low + high) / 2;
        ((at(middle) >= 0) == inside ? low : high) = middle;
      }
      return static_cast<double>(enter + high * (leave - enter));
    }
    return {};
  }

  const TestVolume<T>& Volume;
  Real Isovalue;
  Real Shift;
  Planes Grid;
};

#endif
