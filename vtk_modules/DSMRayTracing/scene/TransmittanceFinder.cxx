// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/scene/TransmittanceFinder.h"

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

} // namespace

TransmittanceFinder::TransmittanceFinder(const SceneTracers& tracers)
  : Opaque(GetObjects(tracers.Objects, true))
  , Others(GetObjects(tracers.Objects, false))
  , Media(tracers)
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
  RayMask dark = 0;
  for (const ObjectTracer* object : this->Others)
  {
    open &= ~dark;
    dark |= open != 0 ? object->Attenuate(rays, open, transmittances) : 0;
  }
  ForEachRay(dark, [&](int index) { transmittances[index] = glm::dvec3(0.0); });
  open &= ~dark;
  if (open != 0 && !this->Media.IsEmpty())
  {
    this->Media.Attenuate(rays, open, transmittances);
  }
}

} // namespace rt
