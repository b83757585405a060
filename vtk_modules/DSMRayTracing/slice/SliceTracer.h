// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SliceTracer_h
#define rt_SliceTracer_h

#include "DSMRayTracing/object/ObjectTracer.h"
#include "DSMRayTracing/slice/SliceOf.h"
#include "DSMRayTracing/surface/ValueColors.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <memory>
#include <vector>

namespace rt
{

/// Planes through a field as an object that rays meet. Bricks are read only where they decide whether a plane is
/// there, or color it.
template <class FieldType, class Store>
class SliceTracer final : public ObjectTracer
{
public:
  using Place = typename FieldType::Place;
  using Sections = typename FieldType::Sections;
  using Hit = typename Sections::Hit;

  /// Keeps references.
  SliceTracer(Store& store, typename Store::Worker& worker, const SliceOf<FieldType>& object)
    : Object(object)
    , Blocks(store)
    , Planes(object.Field, object.Planes)
    , Values(store, worker)
    , ReadsField(object.DependsOnValues() || FieldType::HasHoles(object.Field.GetValues()))
    , Clearance(PlaneClearance * object.Field.GetFinestLength())
  {
  }

  bool IsOpaque() const override { return this->Object.IsOpaque(); }

  std::unique_ptr<ObjectBeam> FindBeam(const Ray corners[4]) const override
  {
    return std::make_unique<SectionBeam>(this->Planes.FindBeam(corners));
  }

  bool Prefetch(const ObjectBeam& beam, std::size_t count) const override
  {
    const std::vector<dsm::BlockId>& bricks = static_cast<const SectionBeam&>(beam).Bricks;
    const auto prefetch = [&](const typename FieldType::Values& values)
    {
      const dsm::BlockSegment* const segment = FieldType::GetSegment(values);
      std::vector<dsm::BlockId> there;
      std::copy_if(bricks.begin(),
        bricks.begin() + static_cast<std::ptrdiff_t>(std::min(count, bricks.size())),
        std::back_inserter(there),
        [&](dsm::BlockId id) { return segment && id < segment->GetDirectory().GetCount(); });
      return !there.empty() && this->Blocks.Prefetch(*segment, there.data(), there.size(), {});
    };
    const auto& field = this->Object.Field.GetValues();
    const bool anyAbsent = this->ReadsField && prefetch(field);
    const auto* const colors = this->Object.ColorValues.get();
    const bool isOther = colors && !(this->ReadsField && colors == &field);
    return (isOther && prefetch(*colors)) || anyAbsent;
  }

  void FindNext(Ray* rays, RayMask wanted, ObjectBeam* beam, ObjectHit* nearest) const override
  {
    auto* const known = static_cast<SectionBeam*>(beam);
    this->Object.Clipping.SearchParts(rays, wanted,
      [&](const Ray* parts, RayMask some)
      {
        Hit hits[MaxRays];
        const RayMask found = this->Find(parts, some, hits);
        ForEachRay(found,
          [&](int index)
          {
            if (known)
            {
              known->Reach(this->Object.Field.FindBrick(hits[index].At).Id);
            }
            nearest[index].Take(*this, hits[index], rays[index]);
          });
        return found;
      });
  }

  RayMask FindOccluded(const Ray* rays, RayMask wanted) const override
  {
    return this->Object.Clipping.SearchParts(rays, wanted,
      [&](const Ray* parts, RayMask some)
      {
        Hit hits[MaxRays];
        return this->Find(parts, some, hits);
      });
  }

  void Describe(const ObjectHit* hits, const Ray* rays, const PictureView* const*, RayMask wanted,
    SurfacePoint* const* points) const override
  {
    const IsosurfaceLook& look = this->Object.Look;
    Place places[MaxRays];
    const BlockLooks::Look* ofBlocks[MaxRays] = {};
    ForEachRay(wanted,
      [&](int index)
      {
        places[index] = hits[index].Get<Hit>().At;
        ofBlocks[index] =
          look.Blocks ? look.Blocks->Find(this->Object.Field.GetBlockCell(places[index])) : nullptr;
      });
    const auto hasOwnColor = [&](int index) { return ofBlocks[index] && ofBlocks[index]->Color; };
    glm::vec4 colors[MaxRays];
    if (this->Object.ColorValues)
    {
      FindValueColors(this->Values, *this->Object.ColorValues, look, this->Object.NearestValues,
        places, FindRays(wanted, [&](int index) { return !hasOwnColor(index); }), colors);
    }
    ForEachRay(wanted,
      [&](int index)
      {
        const auto& hit = hits[index].Get<Hit>();
        const glm::dvec3& direction = rays[index].Direction;
        SurfacePoint& point = *points[index];
        point.T = hit.T;
        point.Position = rays[index].Origin + hit.T * direction;
        point.Normal = glm::normalize(this->Object.Planes[hit.Plane].Normal);
        point.Facing = glm::dot(point.Normal, direction) > 0.0 ? -point.Normal : point.Normal;
        point.ColorIsFromArray = hasOwnColor(index) || this->Object.ColorValues;
        point.Surface = &look.Surface;
        point.Color = hasOwnColor(index) ? *ofBlocks[index]->Color
          : this->Object.ColorValues     ? colors[index]
                                         : glm::vec4(look.Surface.DiffuseColor, 1.0f);
        const float opacity = look.Surface.Opacity;
        point.Color.w *= ofBlocks[index] ? ofBlocks[index]->Opacity.value_or(opacity) : opacity;
        point.Clearance = this->Clearance;
        point.LineCover = 0.0;
      });
  }

  Brick FindBrick(const ObjectHit& hit) const override
  {
    return this->Object.Field.FindBrick(hit.Get<Hit>().At);
  }

private:
  /// Relative to the shortest edge of a cell.
  static constexpr double PlaneClearance = 1e-4;

  /// Finds the first hits of those of the rays that are `wanted`; returns which have one.
  RayMask Find(const Ray* rays, RayMask wanted, Hit* hits) const
  {
    typename Sections::Line lines[MaxRays];
    RayMask left =
      FindRays(wanted, [&](int index) { return this->Planes.GetLine(rays[index], lines[index]); });
    RayMask found = 0;
    while (left != 0)
    {
      left = FindRays(left,
        [&](int index) { return this->Planes.FindNext(rays[index], lines[index], hits[index]); });
      const RayMask there = this->ReadsField ? this->FindShown(hits, left) : left;
      found |= there;
      left &= ~there;
    }
    return found;
  }

  /// Returns the subset of the hits where the field has a value, and one that is to be shown; sets their places.
  RayMask FindShown(Hit* hits, RayMask wanted) const
  {
    Place places[MaxRays];
    ForEachRay(wanted, [&](int index) { places[index] = hits[index].At; });
    const auto& field = this->Object.Field.GetValues();
    const RayMask there = this->Values.FindPlaces(field, places, wanted);
    ForEachRay(there, [&](int index) { hits[index].At = places[index]; });
    double values[MaxRays];
    const RayMask covered = this->Values.FindValues(field, places, there, values);
    return !this->Object.DependsOnValues()
      ? covered
      : FindRays(covered,
          [&](int index)
          { return values[index] >= this->Object.Least && values[index] <= this->Object.Most; });
  }

  const SliceOf<FieldType>& Object;
  Store& Blocks;
  Sections Planes;
  typename FieldType::template Sampler<Store> Values;
  bool ReadsField;
  double Clearance;
};

} // namespace rt

#endif
