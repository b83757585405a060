// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MediumLighting_h
#define rt_MediumLighting_h

#include "DSMRayTracing/frame/LightPath.h"
#include "DSMRayTracing/ray/MediumLight.h"
#include "DSMRayTracing/ray/MediumShading.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayMask.h"
#include "DSMRayTracing/scene/Scene.h"
#include "DSMRayTracing/scene/TransmittanceFinder.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace rt
{

/// Lights pieces of media. The light that arrives is computed at a few positions of each ray, where
/// most is visible; the positions differ between samples of a pixel. One for each worker.
class MediumLighting
{
public:
  /// Keeps references.
  MediumLighting(const SceneTracers& tracers, const Scene& scene);

  /// Returns the light that shades a medium of that look while rays march through it; nothing, if pieces are needed.
  std::optional<MediumShading> FindShading(const MediumLook& look) const;

  /// Finds MediumLight::Arriving at the places of the rays that are `wanted`; each has a path.
  void FindArriving(
    const Ray* rays, RayMask wanted, LightPath* const* paths, MediumLight& light) const;

  /// Gives the pieces that have a look the color that they have in that light, of those of the rays that are `wanted`;
  /// each has a path.
  void Shine(const Ray* rays, RayMask wanted, LightPath* const* paths, MediumLight& light) const;

private:
  /// Places of a ray, at most.
  static constexpr int MostPlaces = 8;

  /// A place of a ray, and what arrives there, were all of it to arrive 1.
  struct Place
  {
    const MediumPiece* Piece = nullptr;
    double Ambient = 1.0;
    std::vector<glm::dvec3> Lamps; ///< empty: all of it
  };
  struct Places
  {
    double Share = 0.0; ///< share of all pieces of the ray that have a look
    std::vector<Place> All;
  };

  static Places Choose(const std::vector<MediumPiece>& pieces, SampleSequence& random);
  /// Finds what arrives at the places with that number.
  void Look(int number, const Ray* rays, RayMask wanted, LightPath* const* paths,
    std::vector<Places>& places) const;
  /// Sends a ray from each of them: `aim(ray, path, normal)` says where to and how far, `take(place,
  /// transmittance)` gets the transmittance along it.
  template <class Aim, class Take>
  void Send(int number, const Ray* rays, RayMask wanted, LightPath* const* paths,
    std::vector<Places>& places, const Aim& aim, const Take& take) const;
  void LookAround(int number, const Ray* rays, RayMask wanted, LightPath* const* paths,
    std::vector<Places>& places) const;
  void LookToLamps(int number, const Ray* rays, RayMask wanted, LightPath* const* paths,
    std::vector<Places>& places) const;

  /// A ray to a lamp.
  Ray AimAtLamp(std::size_t lamp, const glm::dvec3& position, LightPath& path) const;

  /// The amounts of a piece, as they are seen from there.
  Lanes GetLit(const MediumPiece& piece, const glm::dvec3& position, LightPath& path,
    const Place* arriving) const;

  TransmittanceFinder Transmittances;
  const Scene& World;
};

} // namespace rt

#endif
