// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MediaMarcher_h
#define rt_MediaMarcher_h

#include "DSMRayTracing/object/MediumTracer.h"
#include "DSMRayTracing/ray/MediumShading.h"
#include "DSMRayTracing/scene/SceneBeam.h"
#include "DSMRayTracing/scene/SceneTracers.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <optional>

namespace rt
{

/// Takes rays through all media of a scene at once: of media that overlap, what they emit and absorb at a place
/// adds up, in whatever order they are, but for media of a group (MediumTracer::GetGroup). One for each worker.
class MediaMarcher
{
public:
  /// Keeps a reference.
  explicit MediaMarcher(const SceneTracers& tracers);

  bool IsEmpty() const { return this->Media.empty(); }

  /// The look of the only medium, if it can be shaded while rays march through it; else null.
  const MediumLook* GetMarchedLook() const
  {
    return this->Media.size() == 1 ? this->Media.front()->GetMarchedLook() : nullptr;
  }
  /// Shades that medium so.
  void SetShading(const MediumShading& shading)
  {
    this->Shading = shading;
    this->IsLit = false;
    this->KeepsPieces = false;
  }

  /// Finds the light that the `wanted` rays of a batch receive from media in [ray.Min, ray.Max].
  /// `beam`: contains all of the rays; null: the rays have any direction. `shine(light)` is called
  /// in between if media are lit: it gives the pieces that have a look their color in the light
  /// that arrives; or, if MediumLight::LocatesPlaces, finds MediumLight::Arriving.
  template <class Shine>
  void March(
    const Ray* rays, RayMask wanted, SceneBeam* beam, MediumLight& light, const Shine& shine) const
  {
    if (this->Shading && this->Shading->HasShadows)
    {
      this->LocatePlaces(rays, wanted, beam, light);
      shine(light);
      light.LocatesPlaces = false;
    }
    this->Gather(rays, wanted, beam, light);
    if (this->IsLit)
    {
      shine(light);
    }
    this->Merge(wanted, light);
  }

  /// The brick that has a place's values (world space), of the first medium that is there; of no segment, where
  /// none is.
  ObjectTracer::Brick FindBrick(const glm::dvec3& place) const;

  /// Multiplies the transmittances of those of the rays that are `wanted` by that of all media.
  void Attenuate(const Ray* rays, RayMask wanted, glm::dvec3* transmittances) const;

private:
  /// Takes rays through one medium, up to its description, if it `isDescribed`.
  static void March(const MediumTracer& medium, bool isDescribed, const Ray* rays, RayMask wanted,
    ObjectBeam* beam, MediumLight& light);
  /// Finds MediumLight::Place of the rays.
  void LocatePlaces(const Ray* rays, RayMask wanted, SceneBeam* beam, MediumLight& light) const;
  /// Takes rays through all, each by itself.
  void Gather(const Ray* rays, RayMask wanted, SceneBeam* beam, MediumLight& light) const;
  /// Sums up pieces that were kept.
  void Merge(RayMask wanted, MediumLight& light) const;

  const MediumTracers& Media;
  std::size_t FirstBeam; ///< index in SceneBeam
  double Errors;         ///< LightTransport::MediumErrors
  bool IsLit;            ///< true if light affects any medium
  bool KeepsPieces;
  std::optional<MediumShading> Shading;
};

} // namespace rt

#endif
