// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_WalkExtrema_h
#define rt_WalkExtrema_h

#include "DSMRayTracing/field/ValuePredicates.h"
#include "DSMRayTracing/field/walk/WalkSearch.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayExtrema.h"
#include "DSMRayTracing/ray/RayMask.h"

#include <algorithm>
#include <limits>

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
    int changes = 0;
    return this->FindEach(
      field, rays, wanted, [&](RayMask some) { return MayImprove(extrema, some, changes); },
      [&](int ray, const Segment& segment)
      {
        const double before = extrema.Value[ray];
        const bool isMet = Improve(segment, ray, extrema);
        changes += static_cast<int>(extrema.Value[ray] != before);
        return isMet;
      });
  }

private:
  using typename WalkSearch<FieldType, Store>::Segment;

  /// Returns whether any value of a range is better than what one of some rays has found so far.
  class MayImprove
  {
  public:
    /// `changes`: how often any of the rays has found something. Both are kept by reference.
    MayImprove(const RayExtrema& extrema, RayMask rays, const int& changes)
      : Extrema(extrema)
      , Rays(rays)
      , Changes(changes)
    {
    }
    bool operator()(const bricks::ValueRange& range) const
    {
      if (this->Known != this->Changes)
      {
        this->Known = this->Changes;
        this->Least = std::numeric_limits<double>::infinity();
        ForEachRay(this->Rays,
          [&](int ray) { this->Least = std::min(this->Least, this->Extrema.Value[ray]); });
      }
      return ExtremumPredicate(this->Extrema.Sign, this->Least)(range);
    }

  private:
    const RayExtrema& Extrema;
    RayMask Rays;
    const int& Changes;
    mutable int Known = -1;
    mutable double Least = 0.0; ///< at that number of changes
  };

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
