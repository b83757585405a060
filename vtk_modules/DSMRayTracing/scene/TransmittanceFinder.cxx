// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/scene/TransmittanceFinder.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>

namespace rt
{

namespace
{

std::vector<const ObjectTracer*> GetObjects(const ObjectTracers& objects, bool opaque)
{
  std::vector<const ObjectTracer*> some;
  for (const auto& object : objects)
  {
    if (object->IsOpaque() == opaque)
    {
      some.push_back(object.get());
    }
  }
  return some;
}

double GetLargest(const glm::dvec3& color)
{
  return std::max({ color.x, color.y, color.z });
}

} // namespace

TransmittanceFinder::TransmittanceFinder(const ObjectTracers& objects)
  : Opaque(GetObjects(objects, true))
  , Others(GetObjects(objects, false))
{
}

void TransmittanceFinder::Find(const Ray* rays, int count, glm::dvec3* transmittances) const
{
  RayMask open = count > 0 ? ~RayMask{ 0 } >> (MaxRays - count) : 0;
  for (const ObjectTracer* object : this->Opaque)
  {
    open &= open != 0 ? ~object->FindOccluded(rays, open) : 0;
  }
  for (int index = 0; index < count; ++index)
  {
    transmittances[index] = glm::dvec3((open & GetBit(index)) != 0 ? 1.0 : 0.0);
  }
  if (this->Others.HasObjects())
  {
    this->FindTints(rays, open, transmittances);
  }
}

void TransmittanceFinder::FindTints(
  const Ray* rays, RayMask wanted, glm::dvec3* transmittances) const
{
  Ray rest[MaxRays];
  ForEachRay(wanted, [&](int index) { rest[index] = rays[index]; });
  ObjectHit hits[MaxRays];
  while ((wanted = this->Others.Find(rest, wanted, nullptr, hits)) != 0)
  {
    wanted = FindRays(wanted,
      [&](int index)
      {
        Ray& ray = rest[index];
        SurfacePoint point;
        hits[index].GetObject()->Describe(hits[index], ray, point);
        const double opacity = point.Color.w;
        const glm::dvec3 tint = glm::mix(glm::dvec3(1.0), glm::dvec3(point.Color), opacity);
        glm::dvec3& transmittance = transmittances[index];
        transmittance *= (1.0 - opacity) * tint;
        ray.Min = point.T + point.Clearance / glm::length(ray.Direction);
        ray.Max = rays[index].Max;
        const bool goesOn = GetLargest(transmittance) > Dark;
        transmittance = goesOn ? transmittance : glm::dvec3(0.0);
        return goesOn;
      });
  }
}

} // namespace rt
