// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/scene/SurfaceFinder.h"

#include <cstddef>
#include <utility>

namespace rt
{

SurfaceFinder::SurfaceFinder(std::vector<const ObjectTracer*> objects)
  : Objects(std::move(objects))
{
}

RayMask SurfaceFinder::Find(Ray* rays, RayMask wanted, SceneBeam* beam, ObjectHit* hits) const
{
  ForEachRay(wanted, [&](int index) { hits[index].Clear(); });
  for (std::size_t number = 0; number < this->Objects.size(); ++number)
  {
    ObjectBeam* const ofObject = beam ? beam->Objects[number].get() : nullptr;
    this->Objects[number]->FindNext(rays, wanted, ofObject, hits);
  }
  return FindRays(wanted, [&](int index) { return hits[index].GetObject() != nullptr; });
}

void SurfaceFinder::Describe(const ObjectHit* hits, const Ray* rays,
  const PictureView* const* views, RayMask wanted, SurfacePoint* const* points)
{
  while (wanted != 0)
  {
    const ObjectTracer* const object = hits[GetLowest(wanted)].GetObject();
    const RayMask own =
      FindRays(wanted, [&](int index) { return hits[index].GetObject() == object; });
    object->Describe(hits, rays, views, own, points);
    wanted &= ~own;
  }
}

} // namespace rt
