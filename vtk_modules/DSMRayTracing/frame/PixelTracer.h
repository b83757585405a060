// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_PixelTracer_h
#define rt_PixelTracer_h

#include "DSMRayTracing/frame/EdgeCover.h"
#include "DSMRayTracing/frame/PixelRays.h"
#include "DSMRayTracing/frame/SampleSequence.h"
#include "DSMRayTracing/frame/SceneTracer.h"
#include "DSMRayTracing/kernel/Shading.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
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
    , World(scene)
    , Rays(rays)
  {
  }

  /// One pixel by itself: what TraceBox finds for it, and has to equal.
  PixelSample Trace(int x, int y, int sample) const
  {
    SampleSequence random(x, y, sample);
    PixelSample result;
    const Ray ray = this->Rays.GetRay(x, y, random.GetPositionInPixel());
    result.Color = this->Follow(
      ray, this->World.Transport.MaxBounces, this->Rays.GetWorldToPixels(), random, &result);
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
    constexpr int most = PacketTracer<Store>::MaxPackets;
    Ray rays[RayPacket::Size * most];
    glm::ivec2 places[RayPacket::Size * most];
    RayPacket::Mask wanted[most] = {};
    int packets = 0;
    for (int top = 0; top < height; top += BlockEdge)
    {
      for (int left = 0; left < width; left += BlockEdge, ++packets)
      {
        for (int lane = 0; lane < RayPacket::Size; ++lane)
        {
          const glm::ivec2 place(left + lane % BlockEdge, top + lane / BlockEdge);
          if (place.x < width && place.y < height)
          {
            const int index = RayPacket::Size * packets + lane;
            places[index] = place + glm::ivec2(x, y);
            const SampleSequence random(x + place.x, y + place.y, sample);
            rays[index] = this->Rays.GetRay(x + place.x, y + place.y, random.GetPositionInPixel());
            wanted[packets] |= RayPacket::Mask{ 1 } << lane;
          }
        }
      }
    }
    this->Surfaces.Intersect(bricks, packets, rays, wanted,
      [&](int index, const SurfacePoint& point)
      {
        const glm::ivec2& place = places[index];
        SampleSequence random(place.x, place.y, sample);
        PixelSample result;
        Ray ray = rays[index];
        ray.Max = PixelRays::Last;
        result.Color = this->FollowFrom(point, ray, this->World.Transport.MaxBounces,
          this->Rays.GetWorldToPixels(), random, &result);
        take(place.x, place.y, result);
      });
  }

  /// Whether anything may be seen in the pixels that `bricks` was found for.
  bool MayMeet(const std::vector<BeamBricks>& bricks) const
  {
    return this->Surfaces.MayMeet(bricks);
  }

  /// Of the blocks of pixels whose rays make a packet, and of what is traced at once.
  static constexpr int BlockEdge = 4;
  static constexpr int BoxEdge = 8;
  static_assert(BlockEdge * BlockEdge == RayPacket::Size &&
      BoxEdge * BoxEdge == RayPacket::Size * PacketTracer<Store>::MaxPackets,
    "a block is a packet, and a box as many as are traced together");

private:
  /// What lies behind contributes less than half a step of an 8-bit channel.
  static constexpr float OpaqueEnough = 1.0f - 0.5f / 255.0f;

  /// Front to back. `view` tells where in the picture the ray sees a point of the world. `layers`,
  /// where given, gets the surfaces one by one.
  glm::vec4 Follow(const Ray& ray, int bounces, const glm::dmat4x3& view, SampleSequence& random,
    PixelSample* layers) const
  {
    SurfacePoint point;
    return this->Surfaces.Intersect(ray, point)
      ? this->FollowFrom(point, ray, bounces, view, random, layers)
      : glm::vec4(0.0f);
  }

  /// Follow, what the ray meets first being known.
  glm::vec4 FollowFrom(SurfacePoint point, Ray ray, int bounces, const glm::dmat4x3& view,
    SampleSequence& random, PixelSample* layers) const
  {
    const glm::dvec3 toViewer = -glm::normalize(ray.Direction);
    glm::vec4 color(0.0f);
    do
    {
      const float weight = (1.0f - color.w) * point.Color.w;
      if (weight > 0.0f)
      {
        const glm::vec4 layer(
          weight * this->ShadePoint(point, toViewer, bounces, view, random), weight);
        color += layer;
        if (layers)
        {
          layers->AddLayer(layer, this->Rays.GetDepth(point.Position));
        }
      }
      ray.Min = point.T + point.Clearance / glm::length(ray.Direction);
    } while (color.w < OpaqueEnough && this->Surfaces.Intersect(ray, point));
    return color;
  }

  glm::vec3 ShadePoint(const SurfacePoint& point, const glm::dvec3& toViewer, int bounces,
    const glm::dmat4x3& view, SampleSequence& random) const
  {
    if (this->World.View != DebugView::Off)
    {
      return this->ShowForDebugging(point, toViewer);
    }
    ShadingPoint shading;
    shading.Position = point.Position;
    shading.Normal = point.Facing;
    shading.ToViewer = toViewer;
    shading.Color = glm::vec3(point.Color);
    shading.ColorIsFromArray = point.ColorIsFromArray;
    this->LookAround(point, random, shading);
    if (point.Edges)
    {
      shading.LineColor = point.Edges->Color;
      shading.LineCover = point.Edges->Opacity *
        GetEdgeCover(point.Position, point.Corners, point.EdgeFlags, point.Edges->Width, view);
    }
    const glm::vec3 own = Shade(this->World.Lights, *point.Surface, shading,
      [&](const Light& light, const Incidence& incidence)
      { return this->GetLightVisibility(point, light, incidence, random); });
    // A line is painted on the mirror.
    const float reflectivity =
      static_cast<float>(1.0 - shading.LineCover) * point.Surface->Reflectivity;
    if (reflectivity <= 0.0f || bounces <= 0)
    {
      return own;
    }
    Ray mirrored;
    mirrored.Origin = point.Position;
    mirrored.Direction = glm::reflect(-toViewer, shading.Normal);
    mirrored.Min = point.Clearance;
    mirrored.Max = std::numeric_limits<double>::infinity();
    const glm::vec4 seen = this->Follow(mirrored, bounces - 1,
      GetMirroredView(view, point.Position, shading.Normal), random, nullptr);
    const glm::vec3 reflection =
      glm::vec3(seen) + (1.0f - seen.w) * this->World.Transport.Background;
    return (1.0f - reflectivity) * own + reflectivity * reflection;
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

  glm::dvec3 GetLightVisibility(const SurfacePoint& point, const Light&, const Incidence& incidence,
    SampleSequence& random) const
  {
    const LightTransport& transport = this->World.Transport;
    if (!transport.Shadows)
    {
      return glm::dvec3(1.0);
    }
    Ray ray;
    ray.Origin = point.Position;
    ray.Direction = -incidence.Direction;
    if (transport.LightRadius > 0.0)
    {
      const Frame3 frame(ray.Direction);
      const double radius = transport.LightRadius * std::sqrt(random.Next());
      const double angle = glm::two_pi<double>() * random.Next();
      ray.Direction = glm::normalize(ray.Direction + radius * std::cos(angle) * frame.Tangent +
        radius * std::sin(angle) * frame.Bitangent);
    }
    ray.Min = point.Clearance;
    ray.Max = incidence.Distance;
    return this->Surfaces.GetTransmittance(ray);
  }

  /// Finds the part of the hemisphere, weighted by the cosine, in which nothing is near, and the light
  /// that comes from there.
  void LookAround(const SurfacePoint& point, SampleSequence& random, ShadingPoint& shading) const
  {
    const LightTransport& transport = this->World.Transport;
    const glm::dvec3& normal = shading.Normal;
    shading.HasSurroundings = !transport.Surroundings.IsBlack();
    if (transport.AmbientOcclusionSamples <= 0)
    {
      if (shading.HasSurroundings)
      {
        shading.Surroundings = transport.Surroundings.GetLightOnto(normal);
      }
      return;
    }
    const Frame3 frame(normal);
    double visible = 0.0;
    glm::dvec3 arriving(0.0);
    for (int sample = 0; sample < transport.AmbientOcclusionSamples; ++sample)
    {
      // Uniform on the disc, then up to the sphere: the density is the cosine over pi.
      const double square = random.Next();
      const double radius = std::sqrt(square);
      const double angle = glm::two_pi<double>() * random.Next();
      Ray ray;
      ray.Origin = point.Position;
      ray.Direction = radius * std::cos(angle) * frame.Tangent +
        radius * std::sin(angle) * frame.Bitangent + std::sqrt(1.0 - square) * normal;
      ray.Min = point.Clearance;
      ray.Max = transport.AmbientOcclusionDistance;
      const glm::dvec3 transmittance = this->Surfaces.GetTransmittance(ray);
      visible += (transmittance.x + transmittance.y + transmittance.z) / 3.0;
      if (shading.HasSurroundings)
      {
        arriving += transmittance * transport.Surroundings.GetLight(ray.Direction);
      }
    }
    shading.AmbientVisibility = visible / transport.AmbientOcclusionSamples;
    shading.Surroundings = arriving / static_cast<double>(transport.AmbientOcclusionSamples);
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
  const Scene& World;
  const PixelRays& Rays;
};

} // namespace rt

#endif
