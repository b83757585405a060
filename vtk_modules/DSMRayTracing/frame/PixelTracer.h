// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_PixelTracer_h
#define rt_PixelTracer_h

#include "DSMRayTracing/base/FixedList.h"
#include "DSMRayTracing/frame/PixelRays.h"
#include "DSMRayTracing/light/EdgeCover.h"
#include "DSMRayTracing/light/SampleSequence.h"
#include "DSMRayTracing/light/Shading.h"
#include "DSMRayTracing/scene/LightTracer.h"
#include "DSMRayTracing/scene/SceneTracer.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace rt
{

/// Colour, premultiplied, and window depth of what a sample of a pixel shows.
struct PixelSample
{
  static constexpr int MaxLayers = FrameRequest::MaxLayers;

  glm::vec4 Color{ 0.0f };
  float Depth = 1.0f; ///< of the nearest surface
  int LightRays = 0;  ///< shadow and occlusion rays that were traced for it

  /// The same surface by surface, front to back: what each contributes to the colour, and its depth.
  /// The last one stands for all behind it.
  int Layers = 0;
  glm::vec4 LayerColors[MaxLayers];
  float LayerDepths[MaxLayers];

  void AddLayer(const glm::vec4& color, float depth)
  {
    if (this->Layers == MaxLayers)
    {
      this->LayerColors[MaxLayers - 1] += color;
      return;
    }
    this->Depth = this->Layers == 0 ? depth : this->Depth;
    this->LayerColors[this->Layers] = color;
    this->LayerDepths[this->Layers++] = depth;
  }
};

/// Follows the light of one sample of a pixel: what lies behind translucent surfaces, shadows,
/// ambient occlusion, mirrors. A sample depends on the scene, the camera, the pixel and the sample's
/// number only.
template <class Store>
class PixelTracer
{
public:
  PixelTracer(
    Store& store, typename Store::Worker& worker, const Scene& scene, const PixelRays& rays)
    : Surfaces(store, worker, scene)
    , LightRays(store, worker, scene, this->Surfaces)
    , World(scene)
    , Rays(rays)
    , HasSurroundings(!scene.Transport.Surroundings.IsBlack())
  {
  }

  /// One pixel by itself: what TraceBox finds for it, and has to equal.
  PixelSample Trace(int x, int y, int sample) const
  {
    PixelSample result;
    Path path;
    path.Random = SampleSequence(x, y, sample);
    path.Layers = &result;
    const Ray ray = this->Rays.GetRay(x, y, SampleSequence::GetPositionInPixel(sample));
    this->Follow(ray, this->World.Transport.MaxBounces, this->Rays.GetWorldToPixels(), path);
    result.Color = path.Color;
    result.LightRays = path.LightRays;
    return result;
  }

  /// What the pixels of a box have in common: for TraceBox.
  std::vector<BeamBricks> FindBricks(int x, int y, int width, int height) const
  {
    const auto getCorner = [&](int right, int top)
    { return this->Rays.GetRay(x + right * width, y + top * height, glm::dvec2(0.0)); };
    const Ray corners[4] = { getCorner(0, 0), getCorner(1, 0), getCorner(1, 1), getCorner(0, 1) };
    return this->Surfaces.FindBricks(corners);
  }

  /// SceneTracer::Prefetch, ahead of TraceBox.
  bool Prefetch(std::size_t object, const std::vector<dsm::BlockId>& bricks) const
  {
    return this->Surfaces.Prefetch(object, bricks);
  }

  /// Whether TraceBox gains from `bricks`; else a smaller box may.
  static bool AreUsable(const std::vector<BeamBricks>& bricks)
  {
    return SceneTracer<Store>::AreUsable(bricks);
  }

  /// Trace for a box of pixels, at most BoxEdge wide and high, within the one that `bricks` was found
  /// for. Calls `take(x, y, sample)` for those that show something.
  template <class Take>
  void TraceBox(const std::vector<BeamBricks>& bricks, int x, int y, int width, int height,
    int sample, Take&& take) const
  {
    // The rays of a block follow one another, so that mesh packets are as small as can be.
    const auto getPlace = [](unsigned index)
    {
      constexpr unsigned columns = BoxEdge / BlockEdge;
      const unsigned block = index / MeshPacket::Size;
      const unsigned lane = index % MeshPacket::Size;
      return glm::ivec2(BlockEdge * (block % columns) + lane % BlockEdge,
        BlockEdge * (block / columns) + lane / BlockEdge);
    };
    const glm::dvec2 position = SampleSequence::GetPositionInPixel(sample);
    Ray rays[MaxPaths];
    RayPacket::Mask wanted = 0;
    for (int index = 0; index < RayPacket::Size; ++index)
    {
      const glm::ivec2 place = getPlace(index);
      if (place.x < width && place.y < height)
      {
        rays[index] = this->Rays.GetRay(x + place.x, y + place.y, position);
        wanted |= RayPacket::Mask{ 1 } << index;
      }
    }
    FixedList<Path, MaxPaths> paths;
    FixedList<PixelSample, MaxPaths> samples;
    this->Surfaces.Intersect(bricks, rays, wanted,
      [&](int index) -> SurfacePoint&
      {
        Path& path = paths.Add();
        path.Index = index;
        return path.Point;
      });
    for (int number = 0; number < paths.GetCount(); ++number)
    {
      Path& path = paths[number];
      path.Place = glm::ivec2(x, y) + getPlace(path.Index);
      path.Random = SampleSequence(path.Place.x, path.Place.y, sample);
      path.ToViewer = -glm::normalize(rays[path.Index].Direction);
      path.Layers = &samples.Add();
    }
    this->FollowAll(bricks, rays, paths);
    for (int number = 0; number < paths.GetCount(); ++number)
    {
      const Path& path = paths[number];
      path.Layers->Color = path.Color;
      path.Layers->LightRays = path.LightRays;
      take(path.Place.x, path.Place.y, *path.Layers);
    }
  }

  /// Whether anything may be seen in the pixels that `bricks` was found for.
  bool MayMeet(const std::vector<BeamBricks>& bricks) const
  {
    return this->Surfaces.MayMeet(bricks);
  }

  /// Of the blocks of pixels whose rays make a mesh packet, and of what is traced at once.
  static constexpr int BlockEdge = 4;
  static constexpr int BoxEdge = 8;
  static_assert(BlockEdge * BlockEdge == MeshPacket::Size && BoxEdge * BoxEdge == RayPacket::Size,
    "a box is a packet, and a block one of meshes");

private:
  /// What lies behind contributes less than half a step of an 8-bit channel.
  static constexpr float OpaqueEnough = 1.0f - 0.5f / 255.0f;

  static constexpr int MaxPaths = LightTracer<Store>::MaxRays;

  /// A sample of a pixel on its way through the scene, and the surface that it has come to.
  struct Path
  {
    int Index = 0; ///< of its ray in the box
    glm::ivec2 Place{ 0 };
    SurfacePoint Point;
    glm::dvec3 ToViewer{ 0.0 };
    SampleSequence Random;
    glm::vec4 Color{ 0.0f };
    int LightRays = 0;
    PixelSample* Layers = nullptr; ///< gets the surfaces one by one, if not null

    /// What the surface contributes to the colour.
    float GetWeight() const { return (1.0f - this->Color.w) * this->Point.Color.w; }
    bool GoesOn() const { return this->Color.w < OpaqueEnough; }
    /// Moves the start of the ray, which goes on behind the surface.
    void Pass(Ray& ray) const
    {
      ray.Min = this->Point.T + this->Point.Clearance / glm::length(ray.Direction);
    }
  };

  /// Front to back, from where the paths are.
  void FollowAll(
    const std::vector<BeamBricks>& bricks, Ray* rays, FixedList<Path, MaxPaths>& paths) const
  {
    Path* list[MaxPaths];
    Path* byRay[MaxPaths];
    int count = 0;
    for (; count < paths.GetCount(); ++count)
    {
      list[count] = &paths[count];
      byRay[paths[count].Index] = &paths[count];
    }
    while (count > 0)
    {
      this->AddSurfaces(
        list, count, this->World.Transport.MaxBounces, this->Rays.GetWorldToPixels());
      RayPacket::Mask wanted = 0;
      for (int number = 0; number < count; ++number)
      {
        const Path& path = *list[number];
        if (path.GoesOn())
        {
          path.Pass(rays[path.Index]);
          rays[path.Index].Max = PixelRays::Last;
          wanted |= RayPacket::Mask{ 1 } << path.Index;
        }
      }
      count = 0;
      if (wanted != 0)
      {
        this->Surfaces.Intersect(bricks, rays, wanted,
          [&](int index) -> SurfacePoint&
          {
            list[count++] = byRay[index];
            return byRay[index]->Point;
          });
      }
    }
  }

  /// Front to back, by itself. `view` tells where in the picture the ray sees a point of the world.
  void Follow(Ray ray, int bounces, const glm::dmat4x3& view, Path& path) const
  {
    path.ToViewer = -glm::normalize(ray.Direction);
    Path* const list[] = { &path };
    while (path.GoesOn() && this->Surfaces.Intersect(ray, path.Point))
    {
      this->AddSurfaces(list, 1, bounces, view);
      path.Pass(ray);
    }
  }

  /// Adds what the surfaces at which paths are contribute.
  void AddSurfaces(Path* const* paths, int count, int bounces, const glm::dmat4x3& view) const
  {
    Path* seen[MaxPaths] = {};
    int seenCount = 0;
    for (int number = 0; number < count; ++number)
    {
      if (paths[number]->GetWeight() > 0.0f)
      {
        seen[seenCount++] = paths[number];
      }
    }
    glm::vec3 colors[MaxPaths];
    this->ShadePoints(seen, seenCount, bounces, view, colors);
    for (int number = 0; number < seenCount; ++number)
    {
      Path& path = *seen[number];
      const float weight = path.GetWeight();
      const glm::vec4 layer(weight * colors[number], weight);
      path.Color += layer;
      if (path.Layers)
      {
        path.Layers->AddLayer(layer, this->Rays.GetDepth(path.Point.Position));
      }
    }
  }

  void ShadePoints(
    Path* const* paths, int count, int bounces, const glm::dmat4x3& view, glm::vec3* colors) const
  {
    if (this->World.View != DebugView::Off)
    {
      for (int number = 0; number < count; ++number)
      {
        colors[number] = this->ShowForDebugging(paths[number]->Point, paths[number]->ToViewer);
      }
      return;
    }
    if (!this->World.Transport.Shadows && this->World.Transport.AmbientOcclusionSamples <= 0)
    {
      for (int number = 0; number < count; ++number)
      {
        const ShadingPoint point = this->GetShadingPoint(*paths[number], view);
        colors[number] = this->ShadePoint(
          *paths[number], point, bounces, view, [](const Light&) { return glm::dvec3(1.0); });
      }
      return;
    }
    std::vector<ShadingPoint> points;
    points.reserve(static_cast<std::size_t>(count));
    for (int number = 0; number < count; ++number)
    {
      points.push_back(this->GetShadingPoint(*paths[number], view));
    }
    if (this->World.Transport.AmbientOcclusionSamples > 0)
    {
      this->LookAround(paths, count, points.data());
    }
    const std::vector<Light>& lights = this->World.Lights;
    std::vector<glm::dvec3> visibility;
    if (this->World.Transport.Shadows)
    {
      visibility.resize(MaxPaths * lights.size());
      for (std::size_t light = 0; light < lights.size(); ++light)
      {
        this->FindLightVisibility(
          lights[light], paths, count, points.data(), visibility.data() + MaxPaths * light);
      }
    }
    for (int number = 0; number < count; ++number)
    {
      colors[number] = this->ShadePoint(*paths[number], points[number], bounces, view,
        [&](const Light& light)
        {
          return visibility.empty() ? glm::dvec3(1.0)
                                    : visibility[MaxPaths * (&light - lights.data()) + number];
        });
    }
  }

  /// The point when nothing is near it.
  ShadingPoint GetShadingPoint(const Path& path, const glm::dmat4x3& view) const
  {
    const SurfacePoint& point = path.Point;
    ShadingPoint shading;
    shading.Position = point.Position;
    shading.Normal = point.Facing;
    shading.ToViewer = path.ToViewer;
    shading.Color = glm::vec3(point.Color);
    shading.ColorIsFromArray = point.ColorIsFromArray;
    if (point.Edges)
    {
      shading.LineColor = point.Edges->Color;
      shading.LineCover = point.Edges->Opacity *
        GetEdgeCover(point.Position, point.Corners, point.EdgeFlags, point.Edges->Width, view);
    }
    shading.HasSurroundings = this->HasSurroundings;
    if (this->HasSurroundings)
    {
      shading.Surroundings = this->World.Transport.Surroundings.GetLightOnto(shading.Normal);
    }
    return shading;
  }

  /// `visibility(light)`: how much of a light arrives.
  template <class Visibility>
  glm::vec3 ShadePoint(Path& path, const ShadingPoint& point, int bounces, const glm::dmat4x3& view,
    const Visibility& visibility) const
  {
    glm::vec3 color = Shade(this->World.Lights, *path.Point.Surface, point,
      [&](const Light& light, const Incidence&) { return visibility(light); });
    this->AddReflection(bounces, view, path, point, color);
    return color;
  }

  void AddReflection(int bounces, const glm::dmat4x3& view, Path& path, const ShadingPoint& shading,
    glm::vec3& color) const
  {
    // A line is painted on the mirror.
    const float reflectivity =
      static_cast<float>(1.0 - shading.LineCover) * path.Point.Surface->Reflectivity;
    if (reflectivity <= 0.0f || bounces <= 0)
    {
      return;
    }
    Ray mirrored;
    mirrored.Origin = path.Point.Position;
    mirrored.Direction = glm::reflect(-path.ToViewer, shading.Normal);
    mirrored.Min = path.Point.Clearance;
    mirrored.Max = std::numeric_limits<double>::infinity();
    Path behind;
    behind.Random = path.Random;
    this->Follow(
      mirrored, bounces - 1, GetMirroredView(view, path.Point.Position, shading.Normal), behind);
    path.Random = behind.Random;
    path.LightRays += behind.LightRays;
    const glm::vec4 seen = behind.Color;
    const glm::vec3 reflection =
      glm::vec3(seen) + (1.0f - seen.w) * this->World.Transport.Background;
    color = (1.0f - reflectivity) * color + reflectivity * reflection;
  }

  glm::vec3 ShowForDebugging(const SurfacePoint& point, const glm::dvec3& toViewer) const
  {
    // What faces the viewer is brighter, so that the shape can be seen.
    const float facing = static_cast<float>(0.4 + 0.6 * std::abs(glm::dot(point.Normal, toViewer)));
    switch (this->World.View)
    {
      case DebugView::Normal:
        return glm::vec3(0.5 + 0.5 * point.Normal);
      case DebugView::Depth:
        return glm::vec3(1.0f - this->Rays.GetDepth(point.Position));
      case DebugView::Owner:
      case DebugView::Brick:
        return facing * GetNumberColor(point.Number);
      default:
        return glm::vec3(facing); // tinted when the tile is done
    }
  }

  /// Traces one ray for each of some paths: together, but a single one by itself.
  void FindTransmittances(const Ray* rays, int count, glm::dvec3* transmittances) const
  {
    if (count > 1)
    {
      this->LightRays.GetTransmittances(rays, count, transmittances);
    }
    else if (count == 1)
    {
      transmittances[0] = this->LightRays.GetTransmittance(rays[0]);
    }
  }

  /// How much of a light arrives at the points that face it.
  void FindLightVisibility(const Light& light, Path* const* paths, int count,
    const ShadingPoint* points, glm::dvec3* visibility) const
  {
    Ray rays[MaxPaths];
    int numbers[MaxPaths];
    int rayCount = 0;
    for (int number = 0; number < count; ++number)
    {
      const Incidence incidence = GetIncidence(light, points[number].Position);
      if (paths[number]->Point.Surface->Lighting && Arrives(incidence, points[number]))
      {
        rays[rayCount] = this->GetLightRay(incidence, *paths[number]);
        numbers[rayCount++] = number;
      }
    }
    glm::dvec3 transmittances[MaxPaths];
    this->FindTransmittances(rays, rayCount, transmittances);
    for (int ray = 0; ray < rayCount; ++ray)
    {
      visibility[numbers[ray]] = transmittances[ray];
    }
  }

  /// From a surface to a light, or to a random place on it.
  Ray GetLightRay(const Incidence& incidence, Path& path) const
  {
    Ray ray;
    ray.Origin = path.Point.Position;
    ray.Direction = -incidence.Direction;
    if (this->World.Transport.LightRadius > 0.0)
    {
      const Frame3 frame(ray.Direction);
      const double radius = this->World.Transport.LightRadius * std::sqrt(path.Random.Next());
      const double angle = glm::two_pi<double>() * path.Random.Next();
      ray.Direction = glm::normalize(ray.Direction + radius * std::cos(angle) * frame.Tangent +
        radius * std::sin(angle) * frame.Bitangent);
    }
    ray.Min = path.Point.Clearance;
    ray.Max = incidence.Distance;
    ++path.LightRays;
    return ray;
  }

  /// Finds the parts of the hemispheres, weighted by the cosine, in which nothing is near, and the
  /// light that comes from there.
  void LookAround(Path* const* paths, int count, ShadingPoint* points) const
  {
    const LightTransport& transport = this->World.Transport;
    const int samples = transport.AmbientOcclusionSamples;
    double visible[MaxPaths] = {};
    glm::dvec3 arriving[MaxPaths];
    std::fill_n(arriving, count, glm::dvec3(0.0));
    for (int sample = 0; sample < samples; ++sample)
    {
      Ray rays[MaxPaths];
      for (int number = 0; number < count; ++number)
      {
        rays[number] = this->GetOcclusionRay(points[number].Normal, *paths[number]);
      }
      glm::dvec3 transmittances[MaxPaths];
      this->FindTransmittances(rays, count, transmittances);
      for (int number = 0; number < count; ++number)
      {
        const glm::dvec3& transmittance = transmittances[number];
        visible[number] += (transmittance.x + transmittance.y + transmittance.z) / 3.0;
        if (this->HasSurroundings)
        {
          arriving[number] +=
            transmittance * transport.Surroundings.GetLight(rays[number].Direction);
        }
      }
    }
    for (int number = 0; number < count; ++number)
    {
      points[number].AmbientVisibility = visible[number] / samples;
      points[number].Surroundings = arriving[number] / static_cast<double>(samples);
    }
  }

  Ray GetOcclusionRay(const glm::dvec3& normal, Path& path) const
  {
    const Frame3 frame(normal);
    // Uniform on the disc, then up to the sphere: the density is the cosine over pi.
    const double square = path.Random.Next();
    const double radius = std::sqrt(square);
    const double angle = glm::two_pi<double>() * path.Random.Next();
    Ray ray;
    ray.Origin = path.Point.Position;
    ray.Direction = radius * std::cos(angle) * frame.Tangent +
      radius * std::sin(angle) * frame.Bitangent + std::sqrt(1.0 - square) * normal;
    ray.Min = path.Point.Clearance;
    ray.Max = this->World.Transport.AmbientOcclusionDistance;
    ++path.LightRays;
    return ray;
  }

  /// Two directions at right angles to a unit one, and to each other (Duff et al., Building an
  /// Orthonormal Basis, Revisited, JCGT 2017).
  struct Frame3
  {
    explicit Frame3(const glm::dvec3& unit)
    {
      const double sign = std::copysign(1.0, unit.z);
      const double a = -1.0 / (sign + unit.z);
      const double b = unit.x * unit.y * a;
      this->Tangent = { 1.0 + sign * unit.x * unit.x * a, sign * b, -sign * unit.x };
      this->Bitangent = { b, sign + unit.y * unit.y * a, -unit.y };
    }
    glm::dvec3 Tangent;
    glm::dvec3 Bitangent;
  };

  SceneTracer<Store> Surfaces;
  LightTracer<Store> LightRays;
  const Scene& World;
  const PixelRays& Rays;
  bool HasSurroundings; ///< light comes from everywhere
};

} // namespace rt

#endif
