// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_WalkIntegrals_h
#define rt_WalkIntegrals_h

#include "DSMBricks/base/ValueRange.h"
#include "DSMRayTracing/field/walk/WalkSearch.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayIntegrals.h"
#include "DSMRayTracing/ray/RayMask.h"

namespace rt
{

/// Integrates the values of a field along rays by its Walk; see VoxelIntegrals.
template <class FieldType, class Store>
class WalkIntegrals : public WalkSearch<FieldType, Store>
{
public:
  using WalkSearch<FieldType, Store>::WalkSearch;

  void Add(const FieldType& field, ObjectBeam*, const Ray* rays, RayMask wanted,
    RayIntegrals& integrals) const
  {
    this->FindEach(
      field, rays, wanted, [](RayMask) { return [](const bricks::ValueRange&) { return true; }; },
      [&](int ray, const Segment& segment)
      {
        integrals.Add(ray, segment.Enter, segment.Exit, segment.Values.GetMean());
        return false;
      });
  }

private:
  using typename WalkSearch<FieldType, Store>::Segment;
};

} // namespace rt

#endif
