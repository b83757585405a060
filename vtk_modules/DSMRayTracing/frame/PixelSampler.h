// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_PixelSampler_h
#define rt_PixelSampler_h

#include "DSMRayTracing/base/FixedList.h"
#include "DSMRayTracing/frame/ArrivingLight.h"
#include "DSMRayTracing/frame/LightPath.h"
#include "DSMRayTracing/frame/MediumLighting.h"
#include "DSMRayTracing/frame/PixelRays.h"
#include "DSMRayTracing/frame/PixelSample.h"
#include "DSMRayTracing/frame/TileHits.h"
#include "DSMRayTracing/scene/MediaMarcher.h"
#include "DSMRayTracing/scene/MediumIntegrals.h"
#include "DSMRayTracing/scene/SceneBeam.h"
#include "DSMRayTracing/scene/SceneTracers.h"
#include "DSMRayTracing/scene/SurfaceFinder.h"

#include <glm/vec3.hpp>

#include <vector>

namespace rt
{

/// Follows the light of samples of pixels: through media, what lies behind translucent surfaces, shadows, ambient
/// occlusion, mirrors. A sample depends on the scene, the camera, the pixel and the sample's number only.
class PixelSampler
{
public:
  /// Keeps references.
  PixelSampler(const SceneTracers& tracers, const Scene& scene, const PixelRays& rays,
    ChannelSet channels = {});

  /// Finds the beam of a box of pixels, for Sample. A beam that is not usable is still valid, but a
  /// smaller box may have a usable one.
  SceneBeam FindBeam(int x, int y, int width, int height) const;

  /// Samples of pixels; empty ones are left out.
  using Samples = FixedList<PixelSample, MaxRays>;

  /// First hits of pixels around a box: those that are known, or else those that are to be kept.
  struct FirstHits
  {
    const TileHits* Known = nullptr;
    TileHits* Kept = nullptr;
    glm::ivec2 Corner{ 0 }; ///< lower left pixel
    int Width = 0;

    std::size_t GetPlace(const glm::ivec2& pixel) const
    {
      return static_cast<std::size_t>(pixel.y - this->Corner.y) * this->Width +
        static_cast<std::size_t>(pixel.x - this->Corner.x);
    }
  };

  /// Adds samples of that number of the pixels of a box, at most BoxEdge wide and high. `beam`: of pixels
  /// around; null: each by itself, which is slower.
  void Sample(SceneBeam* beam, int x, int y, int width, int height, int sample,
    const FirstHits& hits, Samples& samples) const;

  /// Returns whether beams are of use where the first hits are known.
  bool LooksBehindHits() const { return !this->World.IsOpaque(); }

  static constexpr int BoxEdge = 8;
  /// The rays of a block of pixels follow one another, so that those that mesh packets take have as much in
  /// common as can be.
  static constexpr int BlockEdge = 4;

private:
  static_assert(BoxEdge * BoxEdge == MaxRays, "a box is a batch");

  using Paths = FixedList<LightPath, MaxRays>;
  struct Mirrored;

  /// Finds what rays meet, and tells it the path that `getPath(index)` gives for each that meets
  /// something; it is called once for each. `find(hits)`: finds the hits of rays, and returns which have one. Returns
  /// those rays.
  template <class Find, class GetPath>
  RayMask DescribeSurfaces(const Ray* rays, const Find& find, const GetPath& getPath) const;

  /// Finds the first hits of a box of pixels, or takes those that are known.
  RayMask FindFirst(Ray* rays, RayMask wanted, SceneBeam* beam, const FirstHits& known,
    const glm::ivec2& corner, ObjectHit* hits) const;

  /// Follows those of the rays that are `wanted` front to back until they end: through media, and from surface to
  /// surface. `findFirst(hits)`: finds the first hits of the rays. `start(index)` makes the path of a ray that has
  /// something to show; it is called once for each. `getEnd(index)`: T where a ray ends.
  template <class First, class Start, class GetEnd>
  void Follow(SceneBeam* beam, Ray* rays, RayMask wanted, int bounces, const First& findFirst,
    const Start& start, const GetEnd& getEnd) const;

  /// Adds what media contribute in front of the surfaces that rays have met.
  void AddMedia(SceneBeam* beam, const Ray* rays, RayMask wanted, LightPath* const* paths) const;
  /// Adds the light of parts of such rays. `cut`: parts that begin or end at one of
  /// FrameRequest::MediumCuts.
  void AddPart(SceneBeam* beam, const Ray* rays, RayMask wanted, LightPath* const* paths,
    RayMask cut, MediumLight& light) const;

  /// Adds the light from the surfaces that the paths have reached.
  void AddSurfaces(LightPath* const* paths, int count, int bounces) const;

  /// `open`: see PixelSample; written only where channels are asked for.
  void Shade(
    LightPath* const* paths, int count, int bounces, glm::vec3* colors, glm::vec3* open) const;
  void AddReflections(LightPath* const* paths, int count, const ShadingPoint* points, int bounces,
    glm::vec3* colors, glm::vec3* open) const;
  glm::vec3 ShowForDebugging(const LightPath& path) const;
  /// Color for media, from the position that stands for them.
  glm::vec3 ShowForDebugging(const glm::dvec3& place) const;

  std::vector<const BeamFinder*> Finders;
  std::vector<const ObjectTracer*> Objects; ///< by their numbers
  SurfaceFinder Surfaces;
  MediaMarcher Media;
  MediumIntegrals Integrals;
  ArrivingLight Lighting;
  MediumLighting LitMedia;
  const Scene& World;
  const PixelRays& Rays;
  bool FindsOpenLight; ///< true if ChannelSet::Light was asked for
  bool HasMoreChannels;
  bool HasIntegral; ///< true if ChannelSet::Integral was asked for
};

} // namespace rt

#endif
