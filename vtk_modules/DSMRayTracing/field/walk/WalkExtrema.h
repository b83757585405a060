// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_WalkExtrema_h
#define rt_WalkExtrema_h

#include "DSMRayTracing/field/ValuePredicates.h"
#include "DSMRayTracing/field/walk/WalkSearch.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayExtrema.h"
#include "DSMRayTracing/ray/RayMask.h"

namespace rt
{

/// Finds the largest or smallest value of a field that each ray meets by its Walk; see VoxelExtrema.
template <class FieldType, class Store>
class WalkExtrema : public WalkSearch<FieldType, Store>
{
public:
  using WalkSearch<FieldType, Store>::WalkSearch;

  RayMask Find(const FieldType& field, double, ObjectBeam*, const Ray* rays, RayMask wanted,
    RayExtrema& extrema) const
  {
    return FindRays(wanted,
      [&](int ray)
      {
        const auto mayImprove = [&](const bricks::ValueRange& range)
        { return ExtremumPredicate(extrema.Sign, extrema.Value[ray])(range); };
        return this->Way.Find(field, rays[ray], mayImprove,
          [&](const Segment& segment) { return Improve(segment, ray, extrema); });
      });
  }

private:
  using typename WalkSearch<FieldType, Store>::Segment;

  /// Returns whether the ray has met its goal.
  static bool Improve(const Segment& segment, int ray, RayExtrema& extrema)
  {
    const auto take = [&](double part, double value)
    {
      if (extrema.Sign * value > extrema.Value[ray])
      {
        extrema.Value[ray] = extrema.Sign * value;
        extrema.T[ray] = segment.GetT(part);
        extrema.Found |= GetBit(ray);
      }
    };
    take(0.0, segment.Values.Coefficients[0]);
    double parts[2];
    const int count = FindExtrema(segment.Values, parts);
    for (int number = 0; number < count; ++number)
    {
      take(parts[number], segment.Values.Evaluate(parts[number]));
    }
    take(1.0, segment.Last);
    return extrema.Value[ray] >= extrema.Goal;
  }
};

} // namespace rt

#endif
