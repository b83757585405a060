// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/object/ObjectTracer.h"

#include "DSMRayTracing/surface/SheetTransmittance.h"

#include <glm/geometric.hpp>

namespace rt
{

RayMask ObjectTracer::Attenuate(const Ray* rays, RayMask wanted, glm::dvec3* transmittances) const
{
  Ray rest[MaxRays];
  ForEachRay(wanted, [&](int index) { rest[index] = rays[index]; });
  ObjectHit hits[MaxRays];
  RayMask dark = 0;
  while (wanted != 0)
  {
    ForEachRay(wanted, [&](int index) { hits[index].Clear(); });
    this->FindNext(rest, wanted, nullptr, hits);
    wanted = FindRays(wanted,
      [&](int index)
      {
        if (!hits[index].GetObject())
        {
          return false;
        }
        Ray& ray = rest[index];
        SurfacePoint point;
        this->Describe(hits[index], ray, point);
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
