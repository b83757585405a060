// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_RayBeam_h
#define rt_RayBeam_h

#include "DSMRayTracing/kernel/GridRay.h"

namespace rt
{

/// The space, in a volume's index space, that the rays between four others pass through: those of a
/// tile lie between the rays of its corners, whatever the camera.
class RayBeam
{
public:
  /// `corners`: in order around the beam. Returns false when it is of no use: corners that move to
  /// different sides or not at all on an axis, or that are not apart.
  bool Set(const GridRay corners[4]);

  /// Whether all rays of the beam move towards larger coordinates.
  const bool* GetForward() const { return this->Forward; }

  /// Whether any ray may meet a box. May say so of a box that none meets, but only near the beam.
  bool MayMeet(const Lanes& lower, const Lanes& upper) const
  {
    for (const Side& side : this->Sides)
    {
      // The corner of the box that is farthest inside.
      const Lanes corner = Select(side.Positive, upper, lower);
      if ((corner * side.Normal).GetSum() < side.Least)
      {
        return false;
      }
    }
    return true;
  }

private:
  /// A plane between two corners; the normal points into the beam. Idle lanes are 0.
  struct Side
  {
    Lanes Normal;
    IntegerLanes Positive; ///< where the normal is
    double Least;          ///< of normal * point within the beam
  };

  Side Sides[4];
  bool Forward[3];
};

} // namespace rt

#endif
