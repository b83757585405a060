// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LightTracer_h
#define rt_LightTracer_h

#include "DSMRayTracing/mesh/MeshTracer.h"
#include "DSMRayTracing/scene/Occluders.h"
#include "DSMRayTracing/scene/Scene.h"
#include "DSMRayTracing/scene/SceneTracer.h"
#include "DSMRayTracing/volume/PacketTracer.h"
#include "DSMRayTracing/volume/VolumeTracer.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cstdint>

namespace rt
{

/// How much of each colour of light gets along rays: none where an opaque surface is anywhere on the
/// way; translucent surfaces dim and tint it, from the ray's origin on. One for each worker.
template <class Store>
class LightTracer
{
public:
  /// Keeps a reference to `surfaces`, of the same scene.
  LightTracer(Store& store, typename Store::Worker& worker, const Scene& scene,
    const SceneTracer<Store>& surfaces)
    : Volumes(store, worker)
    , Packets(store, worker)
    , Meshes(store, worker)
    , Surfaces(surfaces)
    , World(scene)
    , Opaque(scene)
  {
  }

  /// How many rays are traced together at most.
  static constexpr int MaxRays = RayPacket::Size;

  glm::dvec3 GetTransmittance(const Ray& ray) const
  {
    return this->IsOccluded(ray) ? glm::dvec3(0.0) : this->GetTint(ray);
  }

  /// GetTransmittance for up to MaxRays rays, with the same results.
  void GetTransmittances(const Ray* rays, int count, glm::dvec3* transmittances) const
  {
    static_assert(MaxRays == 64, "a bit for each ray");
    const std::uint64_t all = ~std::uint64_t{ 0 } >> (MaxRays - count);
    const std::uint64_t occluded = this->FindOccluded(rays, all);
    for (int index = 0; index < count; ++index)
    {
      transmittances[index] =
        (occluded >> index & 1) != 0 ? glm::dvec3(0.0) : this->GetTint(rays[index]);
    }
  }

private:
  /// Less than half a step of an 8-bit channel.
  static constexpr double Dark = 0.5 / 255.0;

  static double Largest(const glm::dvec3& color) { return std::max({ color.x, color.y, color.z }); }

  bool IsOccluded(const IsosurfaceObject& object, const Ray& ray) const
  {
    return object.Clipping.FindFirst(
      ray, [&](const Ray& part) { return this->Volumes.IsOccluded(object, part); });
  }
  bool IsOccluded(const MeshObject& object, const Ray& ray) const
  {
    return object.Clipping.FindFirst(
      ray, [&](const Ray& part) { return this->Meshes.IsOccluded(*object.Instance, part); });
  }

  /// Whether an opaque surface is on the way.
  bool IsOccluded(const Ray& ray) const
  {
    const auto occludes = [&](const auto& object)
    { return this->Opaque.Has(object) && this->IsOccluded(object, ray); };
    return std::any_of(this->World.Isosurfaces.begin(), this->World.Isosurfaces.end(), occludes) ||
      std::any_of(this->World.Meshes.begin(), this->World.Meshes.end(), occludes);
  }

  /// IsOccluded for those of up to 64 rays (bits) that are `wanted`.
  std::uint64_t FindOccluded(const Ray* rays, std::uint64_t wanted) const
  {
    std::uint64_t open = wanted;
    const auto find = [&](const auto& object)
    {
      if (open != 0 && this->Opaque.Has(object))
      {
        open &= ~(object.Clipping.KeepsAll() ? this->FindOccluded(object, rays, open)
                                             : this->FindOccludedByClipped(object, rays, open));
      }
    };
    std::for_each(this->World.Isosurfaces.begin(), this->World.Isosurfaces.end(), find);
    std::for_each(this->World.Meshes.begin(), this->World.Meshes.end(), find);
    return wanted & ~open;
  }

  std::uint64_t FindOccluded(
    const IsosurfaceObject& object, const Ray* rays, std::uint64_t wanted) const
  {
    return this->Packets.FindOccluded(object, rays, wanted);
  }
  std::uint64_t FindOccluded(const MeshObject& object, const Ray* rays, std::uint64_t wanted) const
  {
    std::uint64_t occluded = 0;
    for (int first = 0; first < MaxRays; first += MeshPacket::Size)
    {
      const MeshPacket::Mask some = GetPart(wanted, first, MeshPacket::Size);
      if (some != 0)
      {
        occluded |= std::uint64_t{ this->Meshes.FindOccluded(*object.Instance, rays + first, some) }
          << first;
      }
    }
    return occluded;
  }

  /// Each ray has parts of its own, so one after the other.
  template <class Object>
  std::uint64_t FindOccludedByClipped(
    const Object& object, const Ray* rays, std::uint64_t wanted) const
  {
    std::uint64_t occluded = 0;
    for (std::uint64_t left = wanted; left != 0; left &= left - 1)
    {
      const int index = __builtin_ctzll(left);
      occluded |= std::uint64_t{ this->IsOccluded(object, rays[index]) } << index;
    }
    return occluded;
  }

  /// What surfaces that are not opaque leave of the light.
  glm::dvec3 GetTint(Ray ray) const
  {
    glm::dvec3 transmittance(1.0);
    if (this->Opaque.AreAll())
    {
      return transmittance;
    }
    SurfacePoint point;
    while (Largest(transmittance) > Dark && this->Surfaces.Intersect(ray, point, &this->Opaque))
    {
      const double opacity = point.Color.w;
      const glm::dvec3 tint = glm::mix(glm::dvec3(1.0), glm::dvec3(point.Color), opacity);
      transmittance *= (1.0 - opacity) * tint;
      ray.Min = point.T + point.Clearance / glm::length(ray.Direction);
    }
    return Largest(transmittance) > Dark ? transmittance : glm::dvec3(0.0);
  }

  VolumeTracer<Store> Volumes;
  PacketTracer<Store> Packets;
  MeshTracer<Store> Meshes;
  const SceneTracer<Store>& Surfaces;
  const Scene& World;
  Occluders Opaque;
};

} // namespace rt

#endif
