// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SceneTracer_h
#define rt_SceneTracer_h

#include "DSMRayTracing/mesh/MeshTracer.h"
#include "DSMRayTracing/scene/Occluders.h"
#include "DSMRayTracing/scene/Scene.h"
#include "DSMRayTracing/volume/PacketTracer.h"
#include "DSMRayTracing/volume/VolumeTracer.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <vector>

namespace rt
{

/// Where a ray meets the scene first, and what is there.
struct SurfacePoint
{
  double T = 0.0;
  glm::dvec3 Position{ 0.0 };
  glm::dvec3 Normal{ 0.0 }; ///< unit, world
  /// Normal or its opposite: that of the side from which the ray comes.
  glm::dvec3 Facing{ 0.0 };
  /// Of the surface itself, before light; straight (not premultiplied), alpha is opacity.
  glm::vec4 Color{ 1.0f };
  bool ColorIsFromArray = false;
  const Material* Surface = nullptr;
  /// World length that is more than the error of the hit, and less than the distance of two
  /// surfaces that can be told apart: where rays that leave the surface begin.
  double Clearance = 0.0;
  /// What a debug view of owners or bricks numbers.
  std::uint64_t Number = 0;
  /// Of the triangle's sides; null: none are drawn.
  const EdgeLines* Edges = nullptr;
  glm::dvec3 Corners[3]; ///< of the triangle, world, when edges are drawn
  unsigned EdgeFlags = 0;
};

/// Finds what a ray meets among all objects of a scene. One for each worker.
template <class Store>
class SceneTracer
{
public:
  SceneTracer(Store& store, typename Store::Worker& worker, const Scene& scene)
    : Volumes(store, worker)
    , Packets(store, worker)
    , Meshes(store, worker)
    , World(scene)
  {
    for (const IsosurfaceObject& object : scene.Isosurfaces)
    {
      const glm::dmat3 edges(object.IndexToWorld);
      this->Clearances.push_back(ClearancePart *
        std::min({ glm::length(edges[0]), glm::length(edges[1]), glm::length(edges[2]) }));
    }
  }

  /// The first surface in [ray.Min, ray.Max]; of equally near ones that of the first object,
  /// isosurfaces before meshes. What is in `without` is passed by.
  bool Intersect(Ray ray, SurfacePoint& point, const Occluders* without = nullptr) const
  {
    SurfaceHit isosurfaceHit;
    const IsosurfaceObject* isosurface = this->FindIsosurface(ray, without, isosurfaceHit);
    MeshHit meshHit;
    const MeshObject* mesh = this->FindMesh(ray, without, isosurface != nullptr, meshHit);
    return this->Complete(ray, isosurface, isosurfaceHit, mesh, meshHit, point);
  }

  /// For each isosurface object, what rays between those of `corners` have in common.
  std::vector<BeamBricks> FindBricks(const Ray corners[4]) const
  {
    std::vector<BeamBricks> bricks;
    for (const IsosurfaceObject& object : this->World.Isosurfaces)
    {
      bricks.push_back(this->Packets.FindBricks(object, corners));
    }
    return bricks;
  }

  /// PacketTracer::Prefetch for the isosurface object of that number, unless it cannot be seen.
  bool Prefetch(std::size_t object, const std::vector<dsm::BlockId>& bricks) const
  {
    const IsosurfaceObject& surface = this->World.Isosurfaces[object];
    return surface.Surface.Opacity > 0.0f && this->Packets.Prefetch(surface, bricks);
  }

  /// Whether rays within the beam that `bricks` was found for may meet anything.
  bool MayMeet(const std::vector<BeamBricks>& bricks) const
  {
    return !this->World.Meshes.empty() ||
      std::any_of(bricks.begin(), bricks.end(),
        [](const BeamBricks& object) { return !object.Usable || !object.Bricks.empty(); });
  }

  /// Whether rays can be traced together with the help of `bricks`.
  static bool AreUsable(const std::vector<BeamBricks>& bricks)
  {
    return std::all_of(
      bricks.begin(), bricks.end(), [](const BeamBricks& object) { return object.Usable; });
  }

  /// Intersect for those of a packet's rays that are `wanted`, with the same result. All lie within
  /// the beam that `bricks` was found for. `getPoint(index)` is called once for each ray that meets
  /// something, and gives where that is stored; the ray ends there afterwards.
  template <class GetPoint>
  void Intersect(const std::vector<BeamBricks>& bricks, Ray* rays, RayPacket::Mask wanted,
    const GetPoint& getPoint) const
  {
    SurfaceHit hits[RayPacket::Size];
    const IsosurfaceObject* objects[RayPacket::Size] = {};
    this->FindIsosurfaces(bricks, rays, wanted, objects, hits);
    MeshHit meshHits[MeshPacket::Size];
    for (int first = 0; first < RayPacket::Size; first += MeshPacket::Size)
    {
      const MeshPacket::Mask some = GetPart(wanted, first, MeshPacket::Size);
      const MeshObject* meshes[MeshPacket::Size] = {};
      if (some != 0 && !this->World.Meshes.empty())
      {
        this->FindMeshes(rays + first, some, objects + first, meshes, meshHits);
      }
      for (MeshPacket::Mask left = some; left != 0; left &= left - 1)
      {
        const int lane = GetLowest(left);
        const int index = first + lane;
        if (objects[index] || meshes[lane])
        {
          this->Complete(rays[index], objects[index], hits[index], meshes[lane], meshHits[lane],
            getPoint(index));
        }
      }
    }
  }

private:
  /// Of the shortest edge of a cell. Roots are found to 1e-7 of the way through a cell.
  static constexpr double ClearancePart = 1e-4;

  /// Of the distances of a mesh's hit and of its ray's origin from the origin of the world: what the
  /// test in double precision can be off by, a few 1e-16 of them, and enough for rays at low angles.
  static constexpr double HitError = 1e-13;

  std::uint64_t GetNumber(const dsm::BlockSegment& segment, dsm::BlockId id) const
  {
    return this->World.View == DebugView::Owner
      ? static_cast<std::uint64_t>(segment.GetDirectory().GetOwner(id))
      : id;
  }

  /// The object that the ray meets first, or null; the ray ends there afterwards.
  const IsosurfaceObject* FindIsosurface(
    Ray& ray, const Occluders* without, SurfaceHit& nearest) const
  {
    const IsosurfaceObject* object = nullptr;
    for (const IsosurfaceObject& candidate : this->World.Isosurfaces)
    {
      if (without && without->Has(candidate))
      {
        continue;
      }
      SurfaceHit hit;
      const auto find = [&](const Ray& part)
      { return this->Volumes.Intersect(candidate, part, hit); };
      if (candidate.Surface.Opacity > 0.0f && candidate.Clipping.FindFirst(ray, find) &&
        (!object || hit.T < nearest.T))
      {
        nearest = hit;
        object = &candidate;
        ray.Max = hit.T;
      }
    }
    return object;
  }

  /// FindIsosurface for the rays of `wanted`; `objects` are null before.
  void FindIsosurfaces(const std::vector<BeamBricks>& bricks, Ray* rays, RayPacket::Mask wanted,
    const IsosurfaceObject** objects, SurfaceHit* nearest) const
  {
    SurfaceHit further[RayPacket::Size];
    bool isFirst = true;
    for (std::size_t number = 0; number < bricks.size(); ++number)
    {
      const IsosurfaceObject& candidate = this->World.Isosurfaces[number];
      if (!(candidate.Surface.Opacity > 0.0f))
      {
        continue;
      }
      SurfaceHit* const hits = isFirst ? nearest : further;
      isFirst = false;
      RayPacket::Mask left = this->IntersectParts(candidate, bricks[number], rays, wanted, hits);
      for (; left != 0; left &= left - 1)
      {
        const int index = GetLowest(left);
        if (!objects[index] || hits[index].T < nearest[index].T)
        {
          nearest[index] = hits[index];
          objects[index] = &candidate;
          rays[index].Max = hits[index].T;
        }
      }
    }
  }

  /// PacketTracer::Intersect in the part of the object that is shown.
  RayPacket::Mask IntersectParts(const IsosurfaceObject& object, const BeamBricks& bricks,
    const Ray* rays, RayPacket::Mask wanted, SurfaceHit* hits) const
  {
    if (object.Clipping.KeepsAll())
    {
      return this->Packets.Intersect(object, bricks, rays, wanted, hits);
    }
    RayPacket::Mask found = 0;
    bool goesOn = true;
    for (int number = 0; number < ClipRegion::MaxParts && goesOn; ++number)
    {
      goesOn = this->IntersectPart(object, number, bricks, rays, wanted, hits, found);
    }
    return found;
  }

  /// The same in part `number` of each ray, for those that are not in `found`; returns whether there
  /// is any.
  bool IntersectPart(const IsosurfaceObject& object, int number, const BeamBricks& bricks,
    const Ray* rays, RayPacket::Mask wanted, SurfaceHit* hits, RayPacket::Mask& found) const
  {
    Ray parts[RayPacket::Size];
    RayPacket::Mask searching = 0;
    for (RayPacket::Mask left = wanted & ~found; left != 0; left &= left - 1)
    {
      const int index = GetLowest(left);
      ClipRegion::Interval intervals[ClipRegion::MaxParts];
      if (number < object.Clipping.FindParts(rays[index], intervals))
      {
        parts[index] = rays[index];
        parts[index].Min = intervals[number].First;
        parts[index].Max = intervals[number].Last;
        searching |= RayPacket::Mask{ 1 } << index;
      }
    }
    if (searching == 0)
    {
      return false;
    }
    SurfaceHit met[RayPacket::Size];
    const RayPacket::Mask now = this->Packets.Intersect(object, bricks, parts, searching, met);
    found |= now;
    for (RayPacket::Mask left = now; left != 0; left &= left - 1)
    {
      const int index = GetLowest(left);
      hits[index] = met[index];
    }
    return true;
  }

  /// Describes what the ray meets first: the mesh, or if there is none the isosurface. Either may be
  /// null.
  bool Complete(const Ray& ray, const IsosurfaceObject* isosurface, const SurfaceHit& isosurfaceHit,
    const MeshObject* mesh, const MeshHit& meshHit, SurfacePoint& point) const
  {
    if (mesh)
    {
      Describe(*mesh, meshHit, ray, point);
      if (this->World.View != DebugView::Off)
      {
        point.Number = this->GetNumber(*mesh->Instance->GetMesh().Segment, meshHit.Brick);
      }
    }
    else if (isosurface)
    {
      this->Describe(*isosurface, isosurfaceHit, ray, point);
      if (this->World.View != DebugView::Off)
      {
        const VoxelField& field = *isosurface->Field;
        point.Number =
          this->GetNumber(*field.Segment, field.Lattice.FindBrick(isosurfaceHit.IndexPoint));
      }
    }
    return mesh || isosurface;
  }

  /// As FindIsosurface. `ended`: something else is at the ray's end, and hides what is no nearer.
  const MeshObject* FindMesh(Ray& ray, const Occluders* without, bool ended, MeshHit& nearest) const
  {
    const MeshObject* object = nullptr;
    for (const MeshObject& candidate : this->World.Meshes)
    {
      if (without && without->Has(candidate))
      {
        continue;
      }
      MeshHit hit;
      const auto find = [&](const Ray& part)
      { return this->Meshes.Intersect(*candidate.Instance, part, hit); };
      if (candidate.Clipping.FindFirst(ray, find) && (!ended || hit.T < ray.Max))
      {
        nearest = hit;
        object = &candidate;
        ray.Max = hit.T;
        ended = true;
      }
    }
    return object;
  }

  /// FindMesh for those of a packet's rays that are `wanted`; `isosurfaces` are what they meet, or
  /// null, and `objects` are null before.
  void FindMeshes(Ray* rays, MeshPacket::Mask wanted, const IsosurfaceObject* const* isosurfaces,
    const MeshObject** objects, MeshHit* nearest) const
  {
    MeshHit further[MeshPacket::Size];
    for (const MeshObject& candidate : this->World.Meshes)
    {
      MeshHit* const hits = &candidate == this->World.Meshes.data() ? nearest : further;
      MeshPacket::Mask found = candidate.Clipping.KeepsAll()
        ? this->Meshes.Intersect(*candidate.Instance, rays, wanted, hits)
        : this->IntersectClipped(candidate, rays, wanted, hits);
      for (; found != 0; found &= found - 1)
      {
        const int index = GetLowest(found);
        if ((!isosurfaces[index] && !objects[index]) || hits[index].T < rays[index].Max)
        {
          nearest[index] = hits[index];
          objects[index] = &candidate;
          rays[index].Max = hits[index].T;
        }
      }
    }
  }

  /// MeshTracer::Intersect in the part of the mesh that is shown, one ray after the other.
  MeshPacket::Mask IntersectClipped(
    const MeshObject& object, const Ray* rays, MeshPacket::Mask wanted, MeshHit* hits) const
  {
    MeshPacket::Mask found = 0;
    for (MeshPacket::Mask left = wanted; left != 0; left &= left - 1)
    {
      const int index = GetLowest(left);
      const auto find = [&](const Ray& part)
      { return this->Meshes.Intersect(*object.Instance, part, hits[index]); };
      found |= MeshPacket::Mask{ object.Clipping.FindFirst(rays[index], find) } << index;
    }
    return found;
  }

  static void Describe(
    const MeshObject& object, const MeshHit& hit, const Ray& ray, SurfacePoint& point)
  {
    point.T = hit.T;
    point.Position = ray.Origin + hit.T * ray.Direction;
    point.Normal = object.Flat ? hit.GeometricNormal : hit.Normal;
    // The triangle tells the side; the points' normals may point to either.
    const bool agrees = glm::dot(point.Normal, hit.GeometricNormal) >= 0.0;
    point.Facing = agrees == hit.Front ? point.Normal : -point.Normal;
    point.Surface = !hit.Front && object.BackSurface ? &*object.BackSurface : &object.Surface;
    point.ColorIsFromArray = object.ColoredBy != MeshObject::Coloring::Material;
    point.Color = GetColor(object, hit, *point.Surface);
    if (object.Picture)
    {
      point.Color *= object.Picture->Sample(hit.TextureCoordinate);
      point.ColorIsFromArray = true;
    }
    point.Color.w *= point.Surface->Opacity;
    const glm::dvec3 distance = glm::abs(point.Position) + glm::abs(ray.Origin);
    point.Clearance = object.Instance->GetResolution(hit.Corners) +
      HitError * (distance.x + distance.y + distance.z);
    point.Edges = object.Edges ? &*object.Edges : nullptr;
    if (point.Edges)
    {
      point.EdgeFlags = hit.EdgeFlags;
      for (int corner = 0; corner < 3; ++corner)
      {
        point.Corners[corner] = object.Instance->Place(hit.Corners[corner]);
      }
    }
  }

  static glm::vec4 GetColor(const MeshObject& object, const MeshHit& hit, const Material& surface)
  {
    switch (object.ColoredBy)
    {
      case MeshObject::Coloring::Values:
        return object.Colors->Map(hit.Value);
      case MeshObject::Coloring::CornerValues:
        return static_cast<float>(hit.Weights[0]) * object.Colors->Map(hit.CornerValues[0]) +
          static_cast<float>(hit.Weights[1]) * object.Colors->Map(hit.CornerValues[1]) +
          static_cast<float>(hit.Weights[2]) * object.Colors->Map(hit.CornerValues[2]);
      case MeshObject::Coloring::Colors:
        return hit.Color;
      case MeshObject::Coloring::Material:
        break;
    }
    return glm::vec4(surface.DiffuseColor, 1.0f);
  }

  void Describe(const IsosurfaceObject& object, const SurfaceHit& hit, const Ray& ray,
    SurfacePoint& point) const
  {
    point.T = hit.T;
    point.Position = ray.Origin + hit.T * ray.Direction;
    point.Normal = hit.Normal;
    point.Facing = hit.FromInside ? -hit.Normal : hit.Normal;
    point.Surface = &object.Surface;
    point.ColorIsFromArray = object.ColorField != nullptr;
    point.Color = point.ColorIsFromArray
      ? object.Colors.Map(this->Volumes.Sample(*object.ColorField, hit.IndexPoint))
      : glm::vec4(object.Surface.DiffuseColor, 1.0f);
    point.Color.w *= object.Surface.Opacity;
    if (!object.Opacities.empty())
    {
      point.Color.w *= object.Opacities[hit.Isovalue];
    }
    point.Clearance = this->Clearances[&object - this->World.Isosurfaces.data()];
    point.Edges = nullptr;
  }

  VolumeTracer<Store> Volumes;
  PacketTracer<Store> Packets;
  MeshTracer<Store> Meshes;
  const Scene& World;
  std::vector<double> Clearances; ///< of the isosurfaces' points
};

} // namespace rt

#endif
