// SPDX-License-Identifier: BSD-3-Clause
#ifndef tests_RandomRays_h
#define tests_RandomRays_h

#include "DSMBricks/base/Box.h"
#include "DSMBricks/layout/GridPlanes.h"
#include "DSMRayTracing/ray/Ray.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <random>

/// Rays at a volume of all the kinds that are known to make trouble.
class RandomRays
{
public:
  enum class Kind
  {
    Through,       ///< from outside, at a point of the volume
    AxisParallel,  ///< two zeros in the direction
    PlaneParallel, ///< one zero
    AlongPlane,    ///< runs in planes between cells
    ThroughCorner, ///< meets a lattice point exactly, on a diagonal
    FromInside,
    Short, ///< begins and ends inside
    Count
  };

  /// `planes`: where planes between cells are; null: at whole numbers.
  RandomRays(const bricks::Index3& cells, unsigned seed, const bricks::GridPlanes* planes = nullptr)
    : Cells(cells)
    , Planes(planes)
    , Random(seed)
  {
  }

  rt::Ray Create(Kind kind)
  {
    const glm::dvec3 target = this->GetPoint();
    rt::Ray ray;
    ray.Direction = glm::normalize(
      glm::dvec3(this->Get(-1, 1), this->Get(-1, 1), this->Get(-1, 1)) + glm::dvec3(1e-9));
    const int axis = static_cast<int>(this->Get(0, 2.999));
    switch (kind)
    {
      case Kind::AxisParallel:
      case Kind::AlongPlane:
        ray.Direction = glm::dvec3(0.0);
        ray.Direction[axis] = this->Get(-1, 1) < 0 ? -0.7 : 1.3;
        break;
      case Kind::PlaneParallel:
        ray.Direction[axis] = 0.0;
        break;
      case Kind::ThroughCorner:
        ray.Direction = glm::dvec3(this->GetSign(), this->GetSign(), this->GetSign() * 0.5);
        break;
      default:
        break;
    }
    ray.Origin = target - 64.0 * ray.Direction;
    ray.Max = 1000.0;
    if (kind == Kind::AlongPlane || kind == Kind::ThroughCorner)
    {
      const glm::dvec3 corner = this->Planes
        ? this->Planes->ToPlace(glm::round(this->Planes->ToIndex(target)))
        : glm::round(target);
      ray.Origin = corner - 64.0 * ray.Direction;
    }
    if (kind == Kind::FromInside || kind == Kind::Short)
    {
      ray.Origin = target;
    }
    if (kind == Kind::Short)
    {
      ray.Min = this->Get(0, 2);
      ray.Max = ray.Min + this->Get(0, 3);
    }
    return ray;
  }

  glm::dvec3 GetPoint()
  {
    const double x = this->Get(0, static_cast<double>(this->Cells.x));
    const double y = this->Get(0, static_cast<double>(this->Cells.y));
    const double z = this->Get(0, static_cast<double>(this->Cells.z));
    return this->Planes ? this->Planes->ToPlace(glm::dvec3(x, y, z)) : glm::dvec3(x, y, z);
  }
  double Get(double low, double high)
  {
    return std::uniform_real_distribution<double>(low, high)(this->Random);
  }
  double GetSign() { return this->Get(-1, 1) < 0 ? -1.0 : 1.0; }

private:
  bricks::Index3 Cells;
  const bricks::GridPlanes* Planes;
  std::mt19937 Random;
};

#endif
