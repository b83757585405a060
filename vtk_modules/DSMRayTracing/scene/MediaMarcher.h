// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MediaMarcher_h
#define rt_MediaMarcher_h

#include "DSMRayTracing/object/MediumTracer.h"
#include "DSMRayTracing/scene/SceneBeam.h"
#include "DSMRayTracing/scene/SceneTracers.h"

#include <glm/vec3.hpp>

#include <cstddef>

namespace rt
{

/// Takes rays through all media of a scene at once: of media that overlap, what they emit and absorb at a place adds up,
/// in whatever order they are, but for media of a group (MediumTracer::GetGroup). One for each worker.
class MediaMarcher
{
public:
  /// Keeps a reference.
  explicit MediaMarcher(const SceneTracers& tracers);

  bool IsEmpty() const { return this->Media.empty(); }

  /// What those of a batch of rays that are `wanted` get from media in [ray.Min, ray.Max]. `beam`: with all of the rays
  /// within; null: they go where they like. `shine(light)` is called between, if media are lit: it gives the pieces that
  /// have a look the color that they have in the light that arrives.
  template <class Shine>
  void March(
    const Ray* rays, RayMask wanted, SceneBeam* beam, MediumLight& light, const Shine& shine) const
  {
    this->Gather(rays, wanted, beam, light);
    if (this->IsLit)
    {
      shine(light);
    }
    this->Merge(wanted, light);
  }

  /// The brick that has a place's values (world space), of the first medium that is there; of no segment, where none is.
  ObjectTracer::Brick FindBrick(const glm::dvec3& place) const;

  /// Multiplies the transmittances of those of the rays that are `wanted` by that of all media.
  void Attenuate(const Ray* rays, RayMask wanted, glm::dvec3* transmittances) const;

private:
  /// Takes rays through one medium, up to its description, if it `isDescribed`.
  static void March(const MediumTracer& medium, bool isDescribed, const Ray* rays, RayMask wanted,
    ObjectBeam* beam, MediumLight& light);
  /// Takes rays through all, each by itself.
  void Gather(const Ray* rays, RayMask wanted, SceneBeam* beam, MediumLight& light) const;
  /// Sums up pieces that were kept.
  void Merge(RayMask wanted, MediumLight& light) const;

  const MediumTracers& Media;
  std::size_t FirstBeam; ///< of SceneBeam
  bool IsLit;            ///< what any medium looks like depends on light
  bool KeepsPieces;
};

} // namespace rt

#endif
