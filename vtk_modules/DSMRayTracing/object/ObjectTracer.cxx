// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/object/ObjectTracer.h"

#include "DSMRayTracing/look/SheetTransmittance.h"

#include <glm/geometric.hpp>

namespace rt
{

RayMask ObjectTracer::Attenuate(const Ray* rays, RayMask wanted, glm::dvec3* transmittances) const
{
  Ray rest[MaxRays];
  SurfacePoint found[MaxRays];
  SurfacePoint* points[MaxRays];
  ForEachRay(wanted,
    [&](int index)
    {
      rest[index] = rays[index];
      points[index] = &found[index];
    });
  ObjectHit hits[MaxRays];
  RayMask dark = 0;
  while (wanted != 0)
  {
    ForEachRay(wanted, [&](int index) { hits[index].Clear(); });
    this->FindNext(rest, wanted, nullptr, hits);
    wanted = FindRays(wanted, [&](int index) { return hits[index].GetObject() != nullptr; });
    this->Describe(hits, rest, nullptr, wanted, points);
    wanted = FindRays(wanted,
      [&](int index)
      {
        const SurfacePoint& point = found[index];
        Ray& ray = rest[index];
        transmittances[index] *= GetSheetTransmittance(point.Color);
        ray.Min = point.T + point.Clearance / glm::length(ray.Direction);
        ray.Max = rays[index].Max;
        const bool isDark = IsDark(transmittances[index]);
        dark |= GetBit(index, isDark);
        return !isDark;
      });
  }
  return dark;
}

} // namespace rt
