// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TileTracer_h
#define rt_TileTracer_h

#include "DSMRayTracing/frame/Frame.h"
#include "DSMRayTracing/frame/PixelRays.h"
#include "DSMRayTracing/frame/Scene.h"
#include "DSMRayTracing/kernel/Shading.h"
#include "DSMRayTracing/kernel/VolumeTracer.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rt
{

/// Traces the pixels of a tile, one worker's view of one frame. A pixel depends on the scene and the
/// camera only.
template <class Store>
class TileTracer
{
public:
  TileTracer(
    Store& store, typename Store::Worker& worker, const Scene& scene, const PixelRays& rays)
    : Tracer(store, worker)
    , World(scene)
    , Rays(rays)
  {
  }

  /// Fills in the pixels of a tile whose place and size are set. May wait for bricks.
  void Trace(Tile& tile) const
  {
    const std::size_t pixels = static_cast<std::size_t>(tile.Width) * tile.Height;
    tile.Color.resize(4 * pixels);
    tile.Depth.resize(pixels);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel)
    {
      const int x = tile.X + static_cast<int>(pixel % tile.Width);
      const int y = tile.Y + static_cast<int>(pixel / tile.Width);
      const Shaded shaded = this->TracePixel(x, y);
      for (int channel = 0; channel < 4; ++channel)
      {
        tile.Color[4 * pixel + channel] = static_cast<std::uint8_t>(
          std::lround(255.0f * std::clamp(shaded.Color[channel], 0.0f, 1.0f)));
      }
      tile.Depth[pixel] = shaded.Depth;
    }
  }

private:
  struct Shaded
  {
    glm::vec4 Color{ 0.0f }; ///< premultiplied
    float Depth = 1.0f;
  };

  struct NearestHit
  {
    SurfaceHit Hit;
    const IsosurfaceObject* Object = nullptr;
  };

  /// What lies behind contributes less than half a step of an 8-bit channel.
  static constexpr float OpaqueEnough = 1.0f - 0.5f / 255.0f;

  /// A ray goes on behind a translucent surface after this part of a cell: more than the error of
  /// the root, less than the distance of two surfaces that can be told apart.
  static constexpr double StepBehindSurface = 1e-4;

  NearestHit FindNearest(Ray ray) const
  {
    NearestHit nearest;
    for (const IsosurfaceObject& object : this->World.Isosurfaces)
    {
      SurfaceHit hit;
      if (object.Surface.Opacity > 0.0f && this->Tracer.Intersect(object, ray, hit) &&
        (!nearest.Object || hit.T < nearest.Hit.T))
      {
        nearest = { hit, &object };
        ray.Max = hit.T;
      }
    }
    return nearest;
  }

  /// Straight (not premultiplied) colour of the surface itself, before light; alpha is opacity.
  glm::vec4 GetSurfaceColor(const NearestHit& nearest) const
  {
    const IsosurfaceObject& object = *nearest.Object;
    glm::vec4 color(object.Surface.DiffuseColor, 1.0f);
    if (object.ColorField)
    {
      color = object.Colors.Map(this->Tracer.Sample(*object.ColorField, nearest.Hit.IndexPoint));
    }
    color.w *= object.Surface.Opacity;
    return color;
  }

  Shaded TracePixel(int x, int y) const
  {
    Ray ray = this->Rays.GetRay(x, y);
    const glm::dvec3 toViewer = -glm::normalize(ray.Direction);
    Shaded pixel;
    while (pixel.Color.w < OpaqueEnough)
    {
      const NearestHit nearest = this->FindNearest(ray);
      if (!nearest.Object)
      {
        break;
      }
      const IsosurfaceObject& object = *nearest.Object;
      const glm::dvec3 point = ray.Origin + nearest.Hit.T * ray.Direction;
      const glm::vec4 surface = this->GetSurfaceColor(nearest);
      const glm::vec3 lit = Shade(this->World.Lights, object.Surface, point, nearest.Hit.Normal,
        toViewer, glm::vec3(surface), object.ColorField != nullptr);
      const float weight = (1.0f - pixel.Color.w) * surface.w;
      pixel.Color += glm::vec4(weight * lit, weight);
      if (pixel.Depth == 1.0f && weight > 0.0f)
      {
        pixel.Depth = this->Rays.GetDepth(point);
      }
      const double cellsPerT = glm::length(glm::dmat3(object.WorldToIndex) * ray.Direction);
      ray.Min = nearest.Hit.T + StepBehindSurface / cellsPerT;
    }
    return pixel;
  }

  VolumeTracer<Store> Tracer;
  const Scene& World;
  const PixelRays& Rays;
};

} // namespace rt

#endif
