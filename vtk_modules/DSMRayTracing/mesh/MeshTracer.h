// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MeshTracer_h
#define rt_MeshTracer_h

#include "DSMRayTracing/mesh/EdgeCover.h"
#include "DSMRayTracing/mesh/MeshObject.h"
#include "DSMRayTracing/mesh/MeshSearch.h"
#include "DSMRayTracing/object/ObjectTracer.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <memory>

namespace rt
{

/// A mesh as an object that rays meet. Rays need have nothing in common to be searched as packets, so it
/// has no use for beams; its bricks are not prefetched.
template <class Store>
class MeshTracer final : public ObjectTracer
{
public:
  /// Keeps references.
  MeshTracer(Store& store, typename Store::Worker& worker, const MeshObject& object)
    : Object(object)
    , Search(store, worker)
  {
  }

  bool IsOpaque() const override { return this->Object.IsOpaque(); }

  std::unique_ptr<ObjectBeam> FindBeam(const Ray*) const override { return nullptr; }

  void FindNext(Ray* rays, RayMask wanted, ObjectBeam*, ObjectHit* nearest) const override
  {
    const auto take = [&](int index, double t)
    { return nearest[index].Open<MeshHit>(*this, t, rays[index]); };
    this->Object.Clipping.SearchParts(rays, wanted,
      [&](const Ray* parts, RayMask some)
      { return this->Search.Intersect(*this->Object.Instance, parts, some, take); });
  }

  RayMask FindOccluded(const Ray* rays, RayMask wanted) const override
  {
    return this->Object.Clipping.SearchParts(rays, wanted,
      [&](const Ray* parts, RayMask some)
      { return this->Search.FindOccluded(*this->Object.Instance, parts, some); });
  }

  void Describe(const ObjectHit* hits, const Ray* rays, const PictureView* const* views,
    RayMask wanted, SurfacePoint* const* points) const override
  {
    ForEachRay(wanted,
      [&](int index)
      {
        const auto& hit = hits[index].Get<MeshHit>();
        this->Describe(hit, rays[index], *points[index]);
        if (this->Object.Look.Edges && views)
        {
          this->DrawEdges(hit, *views[index], *points[index]);
        }
      });
  }

  Brick FindBrick(const ObjectHit& hit) const override
  {
    return { this->Object.Instance->GetMesh().Segment.get(), hit.Get<MeshHit>().Brick };
  }

private:
  /// Bound of the error of a hit, relative to the distances of the hit and of the ray's origin from
  /// the world's origin. The test in double precision is off by a few 1e-16; this suffices for rays
  /// at low angles.
  static constexpr double HitError = 1e-13;

  void Describe(const MeshHit& hit, const Ray& ray, SurfacePoint& point) const
  {
    const MeshLook& look = this->Object.Look;
    point.T = hit.T;
    point.Position = ray.Origin + hit.T * ray.Direction;
    point.Normal = look.Flat ? hit.GeometricNormal : hit.Normal;
    // The triangle tells the side; the points' normals may point to either.
    const bool agrees = glm::dot(point.Normal, hit.GeometricNormal) >= 0.0;
    point.Facing = agrees == hit.Front ? point.Normal : -point.Normal;
    point.Surface = !hit.Front && look.BackSurface ? &*look.BackSurface : &look.Surface;
    point.ColorIsFromArray = look.ColoredBy != MeshLook::Coloring::Material;
    point.Color = this->GetColor(hit, *point.Surface);
    if (look.Picture)
    {
      point.Color *= look.Picture->Sample(hit.TextureCoordinate);
      point.ColorIsFromArray = true;
    }
    point.Color.w *= point.Surface->Opacity;
    const glm::dvec3 distance = glm::abs(point.Position) + glm::abs(ray.Origin);
    point.Clearance = this->Object.Instance->GetResolution(hit.Corners, hit.Radius) +
      HitError * (distance.x + distance.y + distance.z);
    point.LineCover = 0.0;
  }

  void DrawEdges(const MeshHit& hit, const PictureView& view, SurfacePoint& point) const
  {
    const EdgeLines& edges = *this->Object.Look.Edges;
    glm::dvec3 corners[3];
    for (int corner = 0; corner < 3; ++corner)
    {
      corners[corner] = this->Object.Instance->Place(hit.Corners[corner]);
    }
    point.LineColor = edges.Color;
    point.LineCover = edges.Opacity *
      GetEdgeCover(
        point.Position, corners, hit.EdgeFlags, edges.Width / view.PixelSize, view.WorldToPixels);
  }

  glm::vec4 GetColor(const MeshHit& hit, const Material& surface) const
  {
    switch (this->Object.Look.ColoredBy)
    {
      case MeshLook::Coloring::Values:
        return this->Object.Look.Colors->Map(hit.Value);
      case MeshLook::Coloring::CornerValues:
        return static_cast<float>(hit.Weights[0]) *
          this->Object.Look.Colors->Map(hit.CornerValues[0]) +
          static_cast<float>(hit.Weights[1]) * this->Object.Look.Colors->Map(hit.CornerValues[1]) +
          static_cast<float>(hit.Weights[2]) * this->Object.Look.Colors->Map(hit.CornerValues[2]);
      case MeshLook::Coloring::Colors:
        return hit.Color;
      case MeshLook::Coloring::Material:
        break;
    }
    return glm::vec4(surface.DiffuseColor, 1.0f);
  }

  const MeshObject& Object;
  MeshSearch<Store> Search;
};

} // namespace rt

#endif
