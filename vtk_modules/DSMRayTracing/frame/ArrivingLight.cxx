// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/ArrivingLight.h"

#include "DSMRayTracing/light/Directions.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace rt
{

namespace
{

/// Part of the brightest light that remains in a faint shadow.
constexpr double LeftInFaintShadow = 0.4;
/// Cosines of the angle to a surface's normal at which a faint shadow begins, and at which it is
/// full.
constexpr double GrazingCosine = 0.15;
constexpr double FullCosine = 0.6;

float GetBrightness(const Light& light)
{
  return light.Color.x + light.Color.y + light.Color.z;
}

/// How much a light that arrives adds to the color of a surface at most.
double GetBrightest(const LightSample& light, const LightPath& path, const ShadingPoint& point)
{
  const Material& surface = *path.Point.Surface;
  const double cosine = -glm::dot(point.Normal, light.Direction);
  const double part = surface.Diffuse * cosine + surface.Specular;
  return part * std::max({ light.Radiance.x, light.Radiance.y, light.Radiance.z });
}

/// Visibility in a faint shadow. At grazing angles, the surface's coarse shape would cast shadows onto its smooth
/// shading.
glm::dvec3 GetFaint(
  const glm::dvec3& visibility, const LightSample& light, const glm::dvec3& normal)
{
  const double cosine = -glm::dot(light.Direction, normal);
  const double taken = (1.0 - LeftInFaintShadow) *
    std::clamp((cosine - GrazingCosine) / (FullCosine - GrazingCosine), 0.0, 1.0);
  return 1.0 - taken * (1.0 - visibility);
}

} // namespace

ArrivingLight::ArrivingLight(const SceneTracers& tracers, const Scene& scene)
  : Transmittances(tracers)
  , World(scene)
  , HasSurroundings(!scene.Transport.Surroundings.IsBlack())
{
}

std::vector<ShadingPoint> ArrivingLight::FindPoints(LightPath* const* paths, int count) const
{
  std::vector<ShadingPoint> points;
  points.reserve(static_cast<std::size_t>(count));
  for (int number = 0; number < count; ++number)
  {
    points.push_back(this->GetPoint(*paths[number]));
  }
  if (this->World.Transport.AmbientOcclusionSamples > 0)
  {
    this->LookAround(paths, count, points.data());
  }
  return points;
}

std::vector<LightSample> ArrivingLight::FindArriving(
  LightPath* const* paths, int count, const ShadingPoint* points) const
{
  const std::vector<Light>& lights = this->World.Lights;
  const bool shadows = this->World.Transport.Shadows;
  if (!shadows && !this->World.Transport.FaintShadows)
  {
    return {};
  }
  const auto brightest = static_cast<std::size_t>(
    std::max_element(lights.begin(), lights.end(),
      [](const Light& a, const Light& b) { return GetBrightness(a) < GetBrightness(b); }) -
    lights.begin());
  std::vector<LightSample> arriving(MaxRays * lights.size());
  for (std::size_t lamp = 0; lamp < lights.size(); ++lamp)
  {
    LightSample* const samples = arriving.data() + MaxRays * lamp;
    for (int number = 0; number < count; ++number)
    {
      samples[number] = lights[lamp].Sample(points[number].Position, paths[number]->Random);
    }
    if (!shadows && lamp != brightest)
    {
      continue;
    }
    glm::dvec3 visibility[MaxRays] = {};
    this->FindVisibility(lamp, paths, count, points, samples, visibility);
    for (int number = 0; number < count; ++number)
    {
      samples[number].Radiance *= shadows
        ? visibility[number]
        : GetFaint(visibility[number], samples[number], points[number].Normal);
    }
  }
  return arriving;
}

ShadingPoint ArrivingLight::GetPoint(const LightPath& path) const
{
  const SurfacePoint& point = path.Point;
  ShadingPoint shading;
  shading.Position = point.Position;
  shading.Normal = point.Facing;
  shading.ToViewer = path.ToViewer;
  shading.Color = glm::vec3(point.Color);
  shading.ColorIsFromArray = point.ColorIsFromArray;
  shading.LineColor = point.LineColor;
  shading.LineCover = point.LineCover;
  shading.IsLit = point.Surface->Lighting;
  shading.HasSurroundings = this->HasSurroundings;
  if (this->HasSurroundings)
  {
    shading.Surroundings = this->World.Transport.Surroundings.GetLightOnto(shading.Normal);
  }
  return shading;
}

void ArrivingLight::FindVisibility(std::size_t lamp, LightPath* const* paths, int count,
  const ShadingPoint* points, const LightSample* samples, glm::dvec3* visibility) const
{
  const bool isKept = lamp < LightPath::MaxKnownLamps;
  Ray rays[MaxRays];
  int numbers[MaxRays];
  int rayCount = 0;
  for (int number = 0; number < count; ++number)
  {
    LightPath& path = *paths[number];
    const LightSample& light = samples[number];
    if (!path.Point.Surface->Lighting || !Arrives(light, points[number]))
    {
      continue;
    }
    if (isKept && (path.KnownLamps >> lamp & 1u) != 0 &&
      path.Lamps[lamp].Lend(path.GetWeight() * GetBrightest(light, path, points[number])))
    {
      visibility[number] = path.Lamps[lamp].Get();
      continue;
    }
    rays[rayCount] = this->GetLightRay(light, path);
    numbers[rayCount++] = number;
  }
  glm::dvec3 transmittances[MaxRays];
  this->Transmittances.Find(rays, rayCount, transmittances);
  for (int ray = 0; ray < rayCount; ++ray)
  {
    LightPath& path = *paths[numbers[ray]];
    visibility[numbers[ray]] = transmittances[ray];
    if (isKept && path.Point.Color.w < 1.0f)
    {
      path.Lamps[lamp].Set(transmittances[ray]);
      path.KnownLamps |= 1u << lamp;
    }
  }
}

Ray ArrivingLight::GetLightRay(const LightSample& light, LightPath& path) const
{
  Ray ray;
  ray.Origin = path.Point.Position;
  ray.Direction = light.Aim(this->World.Transport.LightRadius, path.Random);
  ray.Min = path.Point.Clearance;
  ray.Max = light.Distance;
  ++path.LightRays;
  return ray;
}

/// Finds the parts of the hemispheres, weighted by the cosine, in which nothing is near, and the
/// light that comes from there.
void ArrivingLight::LookAround(LightPath* const* paths, int count, ShadingPoint* points) const
{
  const LightTransport& transport = this->World.Transport;
  const int samples = transport.AmbientOcclusionSamples;
  int numbers[MaxRays];
  int rayCount = 0;
  for (int number = 0; number < count; ++number)
  {
    LightPath& path = *paths[number];
    if (!points[number].IsLit)
    {
      continue;
    }
    if (path.KnowsAmbient && path.Ambient.Lend(path.GetWeight()))
    {
      points[number].AmbientVisibility = path.Ambient.Get();
      points[number].Surroundings *= path.Ambient.Get();
      continue;
    }
    numbers[rayCount++] = number;
  }
  double visible[MaxRays] = {};
  glm::dvec3 arriving[MaxRays];
  std::fill_n(arriving, rayCount, glm::dvec3(0.0));
  for (int sample = 0; sample < samples; ++sample)
  {
    Ray rays[MaxRays];
    for (int ray = 0; ray < rayCount; ++ray)
    {
      rays[ray] = this->GetOcclusionRay(points[numbers[ray]].Normal, *paths[numbers[ray]]);
    }
    glm::dvec3 transmittances[MaxRays];
    this->Transmittances.Find(rays, rayCount, transmittances);
    for (int ray = 0; ray < rayCount; ++ray)
    {
      const glm::dvec3& transmittance = transmittances[ray];
      visible[ray] += (transmittance.x + transmittance.y + transmittance.z) / 3.0;
      if (this->HasSurroundings)
      {
        arriving[ray] += transmittance * transport.Surroundings.GetLight(rays[ray].Direction);
      }
    }
  }
  for (int ray = 0; ray < rayCount; ++ray)
  {
    LightPath& path = *paths[numbers[ray]];
    ShadingPoint& point = points[numbers[ray]];
    point.AmbientVisibility = visible[ray] / samples;
    point.Surroundings = arriving[ray] / static_cast<double>(samples);
    path.Ambient.Set(point.AmbientVisibility);
    path.KnowsAmbient = true;
  }
}

Ray ArrivingLight::GetOcclusionRay(const glm::dvec3& normal, LightPath& path) const
{
  Ray ray;
  ray.Origin = path.Point.Position;
  ray.Direction = Directions(normal).GetByCosine(path.Random);
  ray.Min = path.Point.Clearance;
  ray.Max = this->World.Transport.AmbientOcclusionDistance;
  ++path.LightRays;
  return ray;
}

} // namespace rt
