// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/PixelSampler.h"

#include "DSMRayTracing/light/Shading.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace rt
{

namespace
{

std::vector<const ObjectTracer*> GetAll(const ObjectTracers& objects)
{
  std::vector<const ObjectTracer*> all;
  for (const auto& object : objects)
  {
    all.push_back(object.get());
  }
  return all;
}

std::vector<const ObjectTracer*> GetByNumber(const ObjectTracers& objects)
{
  std::vector<const ObjectTracer*> all(objects.size());
  for (const auto& object : objects)
  {
    all[static_cast<std::size_t>(object->GetNumber())] = object.get();
  }
  return all;
}

/// The place in its box of the pixel whose ray has that number in the batch.
glm::ivec2 GetPlace(int ray)
{
  constexpr int edge = PixelSampler::BlockEdge;
  constexpr int columns = PixelSampler::BoxEdge / edge;
  const int block = ray / (edge * edge);
  const int pixel = ray % (edge * edge);
  return { edge * (block % columns) + pixel % edge, edge * (block / columns) + pixel / edge };
}

/// Returns the number that a debug view of bricks shows.
std::uint64_t GetNumber(DebugView view, const ObjectTracer::Brick& brick)
{
  if (view == DebugView::Level)
  {
    return brick.Segment ? static_cast<std::uint64_t>(brick.Segment->GetDirectory().GetLevel()) : 0;
  }
  return brick.Segment && view == DebugView::Owner
    ? static_cast<std::uint64_t>(brick.Segment->GetDirectory().GetOwner(brick.Id))
    : brick.Id;
}

/// Adds the surface at which a path of the picture is to the channels on request. `weight`: of the surface.
void DescribeSurface(const LightPath& path, float weight)
{
  PixelSample& pixel = *path.Layers;
  const SurfacePoint& point = path.Point;
  if (pixel.Object < 0)
  {
    pixel.Normal = glm::vec3(point.Facing);
    pixel.Object = path.Object;
  }
  const glm::vec3 color =
    glm::mix(glm::vec3(point.Color), point.LineColor, static_cast<float>(point.LineCover));
  pixel.Albedo += weight * glm::vec4(glm::clamp(color, 0.0f, 1.0f), 1.0f);
}

} // namespace

/// Light from mirrors while it is gathered. Not on the stack: mirrors may reflect mirrors many
/// times over.
struct PixelSampler::Mirrored
{
  // Does not write to what is not used.
  Mirrored() {}

  Ray Rays[MaxRays];
  PictureView Views[MaxRays];
  PixelSampler::Paths Paths;
};

PixelSampler::PixelSampler(
  const SceneTracers& tracers, const Scene& scene, const PixelRays& rays, ChannelSet channels)
  : Finders(tracers.GetBeamFinders())
  , Objects(GetByNumber(tracers.Objects))
  , Surfaces(GetAll(tracers.Objects))
  , Media(tracers)
  , Integrals(tracers)
  , Lighting(tracers, scene)
  , LitMedia(tracers, scene)
  , World(scene)
  , Rays(rays)
  , FindsOpenLight(channels.Has(ChannelSet::Light))
  , HasMoreChannels(channels.HasMore())
  , HasIntegral(channels.Has(ChannelSet::Integral))
{
  const MediumLook* const look = this->Media.GetMarchedLook();
  const auto shading = look ? this->LitMedia.FindShading(*look) : std::nullopt;
  if (shading)
  {
    this->Media.SetShading(*shading);
  }
}

SceneBeam PixelSampler::FindBeam(int x, int y, int width, int height) const
{
  const auto getCorner = [&](int right, int top)
  { return this->Rays.GetRay(x + right * width, y + top * height, glm::dvec2(0.0)); };
  const Ray corners[4] = { getCorner(0, 0), getCorner(1, 0), getCorner(1, 1), getCorner(0, 1) };
  SceneBeam beam;
  for (const BeamFinder* finder : this->Finders)
  {
    beam.Objects.push_back(finder->FindBeam(corners));
  }
  return beam;
}

void PixelSampler::Sample(SceneBeam* beam, int x, int y, int width, int height, int sample,
  const FirstHits& hits, Samples& samples) const
{
  const glm::ivec2 corner(x, y);
  // Rays that meet nothing show nothing but media.
  const bool areAllWanted = !hits.Known || !this->Media.IsEmpty();
  const glm::dvec2 position = SampleSequence::GetPositionInPixel(sample);
  Ray rays[MaxRays];
  RayMask wanted = 0;
  for (int index = 0; index < MaxRays; ++index)
  {
    const glm::ivec2 place = GetPlace(index);
    if (place.x < width && place.y < height &&
      (areAllWanted || hits.Known->Has(hits.GetPlace(corner + place))))
    {
      rays[index] = this->Rays.GetRay(x + place.x, y + place.y, position);
      wanted |= GetBit(index);
    }
  }
  const bool isIntegrated = this->HasIntegral && sample == 0;
  double integrals[MaxRays];
  if (isIntegrated)
  {
    this->Integrals.Find(rays, wanted, beam, integrals);
  }
  Paths paths;
  this->Follow(
    beam, rays, wanted, this->World.Transport.MaxBounces,
    [&](ObjectHit* first) { return this->FindFirst(rays, wanted, beam, hits, corner, first); },
    [&](int index) -> LightPath&
    {
      LightPath& path = paths.Add();
      path.Index = index;
      path.Layers = &samples.Add();
      path.Layers->Pixel = corner + GetPlace(index);
      path.Random = SampleSequence(path.Layers->Pixel.x, path.Layers->Pixel.y, sample);
      path.ToViewer = -glm::normalize(rays[index].Direction);
      path.View = &this->Rays.GetView();
      return path;
    },
    [&](int index)
    {
      const glm::ivec2 place = GetPlace(index);
      return this->Rays.GetEnd(x + place.x, y + place.y, position);
    });
  for (int number = 0; number < paths.GetCount(); ++number)
  {
    const LightPath& path = paths[number];
    path.Layers->Color = path.Color;
    path.Layers->Open = path.Open;
    path.Layers->LightRays = path.LightRays;
    if (isIntegrated)
    {
      path.Layers->Integral = static_cast<float>(integrals[path.Index]);
    }
  }
}

RayMask PixelSampler::FindFirst(Ray* rays, RayMask wanted, SceneBeam* beam, const FirstHits& known,
  const glm::ivec2& corner, ObjectHit* hits) const
{
  const auto getPlace = [&](int index) { return known.GetPlace(corner + rt::GetPlace(index)); };
  if (known.Known)
  {
    const RayMask found =
      FindRays(wanted, [&](int index) { return known.Known->Has(getPlace(index)); });
    ForEachRay(found,
      [&](int index)
      { known.Known->Get(getPlace(index), this->Objects.data(), rays[index], hits[index]); });
    return found;
  }
  const RayMask found = this->Surfaces.Find(rays, wanted, beam, hits);
  if (known.Kept)
  {
    ForEachRay(
      found, [&](int index) { known.Kept->Add(getPlace(index), rays[index], hits[index]); });
  }
  return found;
}

template <class Find, class GetPath>
RayMask PixelSampler::DescribeSurfaces(
  const Ray* rays, const Find& find, const GetPath& getPath) const
{
  ObjectHit hits[MaxRays];
  SurfacePoint* points[MaxRays];
  const PictureView* views[MaxRays];
  const RayMask found = find(hits);
  ForEachRay(found,
    [&](int index)
    {
      LightPath& path = getPath(index);
      points[index] = &path.Point;
      views[index] = path.View;
      if (this->HasMoreChannels)
      {
        path.Object = hits[index].GetObject()->GetNumber();
      }
      if (IsOfBricks(this->World.View))
      {
        path.Number = GetNumber(this->World.View, hits[index].GetObject()->FindBrick(hits[index]));
      }
    });
  SurfaceFinder::Describe(hits, rays, views, found, points);
  return found;
}

template <class First, class Start, class GetEnd>
void PixelSampler::Follow(SceneBeam* beam, Ray* rays, RayMask wanted, int bounces,
  const First& findFirst, const Start& start, const GetEnd& getEnd) const
{
  LightPath* paths[MaxRays] = {};
  const auto getPath = [&](int index) -> LightPath&
  {
    if (!paths[index])
    {
      paths[index] = &start(index);
    }
    return *paths[index];
  };
  bool isFirst = true;
  while (wanted != 0)
  {
    RayMask seen = this->DescribeSurfaces(
      rays,
      [&](ObjectHit* hits)
      {
        return std::exchange(isFirst, false) ? findFirst(hits)
                                             : this->Surfaces.Find(rays, wanted, beam, hits);
      },
      getPath);
    if (!this->Media.IsEmpty())
    {
      ForEachRay(wanted, [&](int index) { getPath(index); });
      this->AddMedia(beam, rays, wanted, paths);
      seen = FindRays(seen, [&](int index) { return paths[index]->GoesOn(); });
    }
    LightPath* list[MaxRays];
    int count = 0;
    ForEachRay(seen, [&](int index) { list[count++] = paths[index]; });
    this->AddSurfaces(list, count, bounces);
    wanted = FindRays(seen, [&](int index) { return paths[index]->GoesOn(); });
    ForEachRay(wanted, [&](int index) { paths[index]->Pass(rays[index], getEnd(index)); });
  }
}

void PixelSampler::AddMedia(
  SceneBeam* beam, const Ray* rays, RayMask wanted, LightPath* const* paths) const
{
  const auto light = std::make_unique<MediumLight>();
  if (!this->Rays.HasMediumCuts())
  {
    this->AddPart(beam, rays, wanted, paths, 0, *light);
    return;
  }
  Ray parts[MaxRays];
  ForEachRay(wanted, [&](int index) { parts[index] = rays[index]; });
  RayMask begunAtCut = 0;
  while (wanted != 0)
  {
    RayMask endedByCut = 0;
    ForEachRay(wanted,
      [&](int index)
      {
        const PixelSample* const pixel = paths[index]->Layers;
        const double cut = pixel ? this->Rays.FindMediumCut(parts[index], pixel->Pixel)
                                 : std::numeric_limits<double>::infinity();
        parts[index].Max = std::min(rays[index].Max, cut);
        endedByCut |= GetBit(index, cut < rays[index].Max);
      });
    this->AddPart(beam, parts, wanted, paths, begunAtCut | endedByCut, *light);
    wanted = FindRays(endedByCut, [&](int index) { return paths[index]->GoesOn(); });
    begunAtCut = wanted;
    ForEachRay(wanted, [&](int index) { parts[index].Min = parts[index].Max; });
  }
}

void PixelSampler::AddPart(SceneBeam* beam, const Ray* rays, RayMask wanted,
  LightPath* const* paths, RayMask cut, MediumLight& light) const
{
  this->Media.March(rays, wanted, beam, light,
    [&](MediumLight& gathered)
    {
      if (gathered.LocatesPlaces)
      {
        this->LitMedia.FindArriving(rays, wanted, paths, gathered);
      }
      else
      {
        this->LitMedia.Shine(rays, wanted, paths, gathered);
      }
    });
  ForEachRay(wanted,
    [&](int index)
    {
      if (std::isinf(light.First[index]))
      {
        return;
      }
      LightPath& path = *paths[index];
      const float weight = 1.0f - path.Color.w;
      const auto opacity = static_cast<float>(1.0 - light.Transmittance[index]);
      // At a cut, something else is drawn.
      const bool isCut = (cut & GetBit(index)) != 0;
      const double t = isCut ? light.GetHalfWay(index) : light.GetPlace(index);
      const glm::dvec3 place = rays[index].Origin + t * rays[index].Direction;
      const glm::vec3 color = this->World.View == DebugView::Off
        ? glm::vec3(light.GetColor(index))
        : opacity * this->ShowForDebugging(place);
      const glm::vec4 layer = weight * glm::vec4(color, opacity);
      path.Color += layer;
      path.Open += glm::vec3(layer);
      if (path.Layers)
      {
        path.Layers->AddLayer(layer, this->Rays.GetDepth(place), true);
      }
    });
}

void PixelSampler::AddSurfaces(LightPath* const* paths, int count, int bounces) const
{
  LightPath* seen[MaxRays] = {};
  int seenCount = 0;
  for (int number = 0; number < count; ++number)
  {
    if (paths[number]->GetWeight() > 0.0f)
    {
      seen[seenCount++] = paths[number];
    }
  }
  glm::vec3 colors[MaxRays];
  glm::vec3 open[MaxRays] = {};
  this->Shade(seen, seenCount, bounces, colors, open);
  for (int number = 0; number < seenCount; ++number)
  {
    LightPath& path = *seen[number];
    const float weight = path.GetWeight();
    const glm::vec4 layer(weight * colors[number], weight);
    path.Color += layer;
    path.Open += weight * open[number];
    if (path.Layers)
    {
      if (this->HasMoreChannels)
      {
        DescribeSurface(path, weight);
      }
      path.Layers->AddLayer(layer, this->Rays.GetDepth(path.Point.Position));
    }
  }
}

void PixelSampler::Shade(
  LightPath* const* paths, int count, int bounces, glm::vec3* colors, glm::vec3* open) const
{
  if (this->World.View != DebugView::Off)
  {
    for (int number = 0; number < count; ++number)
    {
      colors[number] = this->ShowForDebugging(*paths[number]);
    }
    return;
  }
  const std::vector<ShadingPoint> points = this->Lighting.FindPoints(paths, count);
  const std::vector<LightSample> arriving =
    this->Lighting.FindArriving(paths, count, points.data());
  const std::vector<Light>& lights = this->World.Lights;
  const auto shade = [&](int number)
  {
    return rt::Shade(lights, *paths[number]->Point.Surface, points[number],
      [&](std::size_t lamp)
      {
        return arriving.empty()
          ? lights[lamp].Sample(points[number].Position, paths[number]->Random)
          : arriving[MaxRays * lamp + number];
      });
  };
  for (int number = 0; number < count; ++number)
  {
    colors[number] = shade(number);
  }
  for (int number = 0; this->FindsOpenLight && number < count; ++number)
  {
    const ShadingPoint point = this->Lighting.GetPoint(*paths[number]);
    // Hard shadows have no noise.
    open[number] = rt::Shade(lights, *paths[number]->Point.Surface, point,
      [&](std::size_t lamp)
      {
        SampleSequence random = paths[number]->Random;
        return arriving.empty() || this->World.Transport.LightRadius > 0.0
          ? lights[lamp].Sample(point.Position, random)
          : arriving[MaxRays * lamp + number];
      });
  }
  if (bounces > 0)
  {
    this->AddReflections(paths, count, points.data(), bounces, colors, open);
  }
}

void PixelSampler::AddReflections(LightPath* const* paths, int count, const ShadingPoint* points,
  int bounces, glm::vec3* colors, glm::vec3* open) const
{
  // A line is painted on the mirror.
  const auto getReflectivity = [&](int number)
  {
    return static_cast<float>(1.0 - points[number].LineCover) *
      paths[number]->Point.Surface->Reflectivity;
  };
  RayMask mirrors = 0;
  for (int number = 0; number < count; ++number)
  {
    mirrors |= GetBit(number, getReflectivity(number) > 0.0f);
  }
  if (mirrors == 0)
  {
    return;
  }
  const auto mirrored = std::make_unique<Mirrored>();
  ForEachRay(mirrors,
    [&](int number)
    {
      const LightPath& path = *paths[number];
      const glm::dvec3& normal = points[number].Normal;
      Ray& ray = mirrored->Rays[number];
      ray.Origin = path.Point.Position;
      ray.Direction = glm::reflect(-path.ToViewer, normal);
      ray.Min = path.Point.Clearance;
      ray.Max = std::numeric_limits<double>::infinity();
      mirrored->Views[number] = path.View->GetMirrored(path.Point.Position, normal);
    });
  this->Follow(
    nullptr, mirrored->Rays, mirrors, bounces - 1,
    [&](ObjectHit* hits) { return this->Surfaces.Find(mirrored->Rays, mirrors, nullptr, hits); },
    [&](int number) -> LightPath&
    {
      LightPath& behind = mirrored->Paths.Add();
      behind.Index = number;
      behind.Random = paths[number]->Random;
      behind.ToViewer = -glm::normalize(mirrored->Rays[number].Direction);
      behind.View = &mirrored->Views[number];
      return behind;
    },
    [](int) { return std::numeric_limits<double>::infinity(); });
  glm::vec4 seen[MaxRays];
  glm::vec3 openlySeen[MaxRays];
  ForEachRay(mirrors,
    [&](int number)
    {
      seen[number] = glm::vec4(0.0f);
      openlySeen[number] = glm::vec3(0.0f);
    });
  for (int index = 0; index < mirrored->Paths.GetCount(); ++index)
  {
    const LightPath& behind = mirrored->Paths[index];
    seen[behind.Index] = behind.Color;
    openlySeen[behind.Index] = behind.Open;
    paths[behind.Index]->Random = behind.Random;
    paths[behind.Index]->LightRays += behind.LightRays;
  }
  ForEachRay(mirrors,
    [&](int number)
    {
      const float reflectivity = getReflectivity(number);
      const glm::vec3 behind = (1.0f - seen[number].w) * this->World.Transport.Background;
      const auto add = [&](const glm::vec3& reflection, glm::vec3& color)
      { color = (1.0f - reflectivity) * color + reflectivity * (reflection + behind); };
      add(glm::vec3(seen[number]), colors[number]);
      add(openlySeen[number], open[number]);
    });
}

glm::vec3 PixelSampler::ShowForDebugging(const glm::dvec3& place) const
{
  const DebugView view = this->World.View;
  if (view == DebugView::Depth)
  {
    return glm::vec3(1.0f - this->Rays.GetDepth(place));
  }
  // Tinted when the tile is done; a medium has no normals.
  return IsOfBricks(view) ? GetNumberColor(GetNumber(view, this->Media.FindBrick(place)))
                          : glm::vec3(1.0f);
}

glm::vec3 PixelSampler::ShowForDebugging(const LightPath& path) const
{
  // Surfaces that face the viewer are brighter, so that the shape is visible.
  const SurfacePoint& point = path.Point;
  const float facing =
    static_cast<float>(0.4 + 0.6 * std::abs(glm::dot(point.Normal, path.ToViewer)));
  switch (this->World.View)
  {
    case DebugView::Normal:
      return glm::vec3(0.5 + 0.5 * point.Normal);
    case DebugView::Depth:
      return glm::vec3(1.0f - this->Rays.GetDepth(point.Position));
    case DebugView::Owner:
    case DebugView::Brick:
    case DebugView::Level:
      return facing * GetNumberColor(path.Number);
    default:
      return glm::vec3(facing); // tinted when the tile is done
  }
}

} // namespace rt
