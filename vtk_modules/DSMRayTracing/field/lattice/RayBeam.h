// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_RayBeam_h
#define rt_RayBeam_h

#include "DSMRayTracing/field/grid/GridRay.h"
#include "DSMRayTracing/field/grid/IndexSpace.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayPacket.h"

#include <algorithm>
#include <cmath>

namespace rt
{

/// The space, in a volume's index or grid space, that rays pass through which have something in common.
class RayBeam
{
public:
  /// The rays between four others: those of a tile lie between the rays of its corners, whatever the
  /// camera. `corners`: in order around the beam. Returns false when it is of no use: corners that move to
  /// different sides or not at all on an axis, or that are not apart.
  bool Set(const GridRay corners[4]);
  /// The same of rays in world space; also false when one of them cannot be traced.
  bool Set(const IndexSpace& space, const Ray corners[4]);

  /// The rays of a packet, from where they enter the volume to where they leave it. There is at least
  /// one.
  void Set(const RayPacket& packet);

  /// Returns for each axis whether all rays of the beam move towards larger coordinates.
  const bool* GetForward() const { return this->Forward; }

  /// Cubes of `edge`, on one lattice.
  struct Cubes
  {
    double Least[4];    ///< for each side: normal * lower corner of a cube that may be met
    double InverseX[4]; ///< for each side's normal, in cubes
    int First[3];       ///< cubes before have no part of the beam
    int Last[3];
  };
  Cubes GetCubes(double edge) const;

  /// Which of the cubes whose lower corners are at (x Edge, y, z), for whole numbers x from `first`
  /// to `last`, rays may meet: shortens the row to them; false when there is none. May keep cubes
  /// that no ray meets, but only near the beam.
  bool ClipRow(const Cubes& cubes, double y, double z, int& first, int& last) const
  {
    double low = first;
    double high = last;
    for (int side = 0; side < 4; ++side)
    {
      const Side& plane = this->Sides[side];
      const double missing = cubes.Least[side] - (plane.Normal[1] * y + plane.Normal[2] * z);
      const double x = missing * cubes.InverseX[side];
      low = plane.Normal[0] > 0.0 ? std::max(low, x) : low;
      high = plane.Normal[0] < 0.0 ? std::min(high, x) : high;
    }
    if (!(low <= high))
    {
      return false;
    }
    first = static_cast<int>(std::ceil(low));
    last = static_cast<int>(std::floor(high));
    return first <= last;
  }

  /// Returns whether rays may meet a box; also true for some near the beam.
  bool MayMeetBox(const double lower[3], const double upper[3]) const
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      if (lower[axis] > this->Upper[axis] || upper[axis] < this->Lower[axis])
      {
        return false;
      }
    }
    for (const Side& side : this->Sides)
    {
      double most = 0.0;
      for (int axis = 0; axis < 3; ++axis)
      {
        most += side.Normal[axis] * (side.Normal[axis] > 0.0 ? upper[axis] : lower[axis]);
      }
      if (most < side.Least)
      {
        return false;
      }
    }
    return true;
  }

  /// Returns a number by which boxes can be sorted: rays mostly enter the box with the smaller one first.
  double GetEntry(const double lower[3], const double upper[3]) const
  {
    double entry = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      entry += this->Way[axis] * (this->Forward[axis] ? lower[axis] : upper[axis]);
    }
    return entry;
  }

  /// The part of a row of boxes, all of which are from `lower` to `upper` on y and z, that rays may meet: its ends
  /// on x. Returns false when there is none. May keep too much, but only near the beam.
  bool FindRow(const double lower[2], const double upper[2], double& low, double& high) const
  {
    low = this->Lower[0];
    high = this->Upper[0];
    for (const Side& side : this->Sides)
    {
      const double inside = std::max(side.Normal[1] * lower[0], side.Normal[1] * upper[0]) +
        std::max(side.Normal[2] * lower[1], side.Normal[2] * upper[1]);
      const double x = (side.Least - inside) * side.InverseX;
      low = side.Normal[0] > 0.0 ? std::max(low, x) : low;
      high = side.Normal[0] < 0.0 ? std::min(high, x) : high;
    }
    return low <= high;
  }
  /// The beam's ends on an axis.
  double GetLower(int axis) const { return this->Lower[axis]; }
  double GetUpper(int axis) const { return this->Upper[axis]; }

private:
  void SetSide(int number, const double normal[3], double least);

  /// A plane between two corners; the normal points into the beam.
  struct Side
  {
    double Normal[3];
    double InverseX; ///< inverse of the normal's x; finite
    double Least;    ///< minimum of normal * point within the beam
  };

  Side Sides[4];
  double Lower[3];
  double Upper[3];
  bool Forward[3];
  double Way[3]; ///< of all rays together
};

} // namespace rt

#endif
