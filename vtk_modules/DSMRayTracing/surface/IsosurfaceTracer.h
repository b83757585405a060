// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_IsosurfaceTracer_h
#define rt_IsosurfaceTracer_h

#include "DSMRayTracing/field/Field.h"
#include "DSMRayTracing/field/IsosurfaceHit.h"
#include "DSMRayTracing/object/ObjectTracer.h"
#include "DSMRayTracing/surface/IsosurfaceOf.h"
#include "DSMRayTracing/surface/ValueColors.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <memory>
#include <vector>

namespace rt
{

/// Isosurfaces of a field as an object that rays meet.
template <class FieldType, class Store>
class IsosurfaceTracer final : public ObjectTracer
{
public:
  using Place = typename FieldType::Place;
  using Hit = IsosurfaceHit<Place>;

  /// Keeps references.
  IsosurfaceTracer(
    Store& store, typename Store::Worker& worker, const IsosurfaceOf<FieldType>& object)
    : Object(object)
    , Surfaces(store, worker)
    , Values(store, worker)
    , Sheets(object.GetSheetTransmittances())
    , Clearance(ClearancePart<FieldType> * object.Field.GetFinestLength())
  {
  }

  bool IsOpaque() const override { return this->Object.IsOpaque(); }

  std::unique_ptr<ObjectBeam> FindBeam(const Ray corners[4]) const override
  {
    return this->Surfaces.FindBeam(this->Object, corners);
  }

  bool Prefetch(const ObjectBeam& beam, std::size_t count) const override
  {
    return this->Object.Look.IsSeen() && this->Surfaces.Prefetch(this->Object, beam, count);
  }

  void FindNext(Ray* rays, RayMask wanted, ObjectBeam* beam, ObjectHit* nearest) const override
  {
    if (!this->Object.Look.IsSeen())
    {
      return;
    }
    const auto open = [&](int index, double place)
    { return nearest[index].Open<Hit>(*this, place, rays[index]); };
    this->Object.Clipping.SearchParts(rays, wanted,
      [&](const Ray* parts, RayMask some)
      { return this->Surfaces.Intersect(this->Object, beam, parts, some, open); });
  }

  RayMask FindOccluded(const Ray* rays, RayMask wanted) const override
  {
    return this->Object.Clipping.SearchParts(rays, wanted,
      [&](const Ray* parts, RayMask some)
      { return this->Surfaces.FindOccluded(this->Object, parts, some); });
  }

  RayMask Attenuate(const Ray* rays, RayMask wanted, glm::dvec3* transmittances) const override
  {
    if (!this->Object.Look.IsSeen() || this->Sheets.empty())
    {
      return this->ObjectTracer::Attenuate(rays, wanted, transmittances);
    }
    return this->Object.Clipping.SearchParts(rays, wanted,
      [&](const Ray* parts, RayMask some) {
        return this->Surfaces.Attenuate(this->Object, this->Sheets, parts, some, transmittances);
      });
  }

  void Describe(const ObjectHit* hits, const Ray* rays, const PictureView* const*, RayMask wanted,
    SurfacePoint* const* points) const override
  {
    const IsosurfaceLook& look = this->Object.Look;
    // If the whole surface looks alike, no code needs the places.
    const bool asksForPlaces = look.Flat || look.Blocks || this->Object.ColorValues;
    Place places[MaxRays];
    if (asksForPlaces)
    {
      ForEachRay(wanted, [&](int index) { places[index] = hits[index].Get<Hit>().At; });
    }
    glm::dvec3 gradients[MaxRays];
    if (look.Flat)
    {
      this->Values.FindGradients(this->Object.Field.GetValues(), places, wanted, gradients);
    }
    const BlockLooks::Look* ofBlocks[MaxRays];
    RayMask uncolored = wanted;
    if (look.Blocks)
    {
      uncolored = FindRays(wanted,
        [&](int index)
        {
          ofBlocks[index] = look.Blocks->Find(this->Object.Field.GetBlockCell(places[index]));
          return !ofBlocks[index] || !ofBlocks[index]->Color;
        });
    }
    glm::vec4 colors[MaxRays];
    if (this->Object.ColorValues)
    {
      FindValueColors(
        this->Values, *this->Object.ColorValues, look, false, places, uncolored, colors);
    }
    ForEachRay(wanted,
      [&](int index)
      {
        const auto& hit = hits[index].Get<Hit>();
        SurfacePoint& point = *points[index];
        point.T = hit.T;
        point.Position = rays[index].Origin + hit.T * rays[index].Direction;
        point.Normal = look.Flat
          ? this->Object.Field.GetNormal(gradients[index], rays[index].Direction)
          : hit.Normal;
        point.Facing = hit.FromInside ? -point.Normal : point.Normal;
        const BlockLooks::Look* const block = look.Blocks ? ofBlocks[index] : nullptr;
        const bool isOfBlock = block && block->Color;
        point.ColorIsFromArray = isOfBlock || this->Object.ColorValues;
        const Material* const surface = look.GetSurface(hit.FromInside);
        point.Surface = surface ? surface : &look.Surface;
        point.Color = isOfBlock      ? *block->Color
          : this->Object.ColorValues ? colors[index]
                                     : glm::vec4(point.Surface->DiffuseColor, 1.0f);
        const float opacity = surface ? surface->Opacity : 0.0f;
        point.Color.w *= block && surface ? block->Opacity.value_or(opacity) : opacity;
        point.Color.w *= look.Opacities.empty() ? 1.0f : look.Opacities[hit.Isovalue];
        point.Clearance = this->Clearance;
        point.LineCover = 0.0;
      });
  }

  Brick FindBrick(const ObjectHit& hit) const override
  {
    return this->Object.Field.FindBrick(hit.Get<Hit>().At);
  }

private:
  const IsosurfaceOf<FieldType>& Object;
  typename FieldType::template Surfaces<Store> Surfaces;
  typename FieldType::template Sampler<Store> Values;
  std::vector<glm::dvec3> Sheets; ///< IsosurfaceOf::GetSheetTransmittances
  double Clearance;
};

} // namespace rt

#endif
