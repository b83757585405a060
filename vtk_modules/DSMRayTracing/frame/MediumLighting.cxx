// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/MediumLighting.h"

#include "DSMRayTracing/light/Directions.h"
#include "DSMRayTracing/light/Shading.h"
#include "DSMRayTracing/look/MediumLook.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>

namespace rt
{

namespace
{

/// Henyey and Greenstein, "Diffuse radiation in the galaxy" (1941), beside light that is scattered evenly. `cosine`: of
/// the angle by which light turns.
double GetPhase(double anisotropy, double cosine)
{
  const double square = anisotropy * anisotropy;
  const double base = 1.0 + square - 2.0 * anisotropy * cosine;
  return (1.0 - square) / (base * std::sqrt(base));
}

glm::dvec3 GetPosition(const Ray& ray, const MediumPiece& piece)
{
  return ray.Origin + piece.GetMiddle() * ray.Direction;
}

} // namespace

MediumLighting::MediumLighting(const SceneTracers& tracers, const Scene& scene)
  : Transmittances(tracers)
  , World(scene)
{
}

std::optional<MediumShading> MediumLighting::FindShading(const MediumLook& look) const
{
  const LightTransport& transport = this->World.Transport;
  if (transport.AmbientOcclusionSamples > 0 || !transport.Surroundings.IsBlack())
  {
    return std::nullopt;
  }
  MediumShading shading;
  const Material& surface = look.Surface;
  const auto scattered = static_cast<float>(look.Scattering);
  const float surfacePart = 1.0f - scattered;
  shading.HasScattering = scattered > 0.0f;
  shading.Anisotropy = static_cast<float>(look.Anisotropy);
  shading.SpecularPower = surface.SpecularPower;
  shading.HasHighlights = surface.Specular > 0.0f;
  shading.TwoSided = transport.TwoSided;
  shading.HasShadows = transport.Shadows;
  for (const Light& lamp : this->World.Lights)
  {
    if (!std::holds_alternative<DirectionalLight>(lamp.Kind))
    {
      return std::nullopt;
    }
    shading.Lamps.push_back({ glm::vec3(lamp.Direction), surfacePart * surface.Diffuse * lamp.Color,
      surfacePart * surface.Specular * lamp.Color, scattered * lamp.Color });
    (lamp.IsLoneHeadlight ? shading.Ambient : shading.AmbientOpacity) +=
      surfacePart * surface.Ambient * (lamp.IsLoneHeadlight ? glm::vec3(1.0f) : lamp.AmbientColor);
  }
  return shading;
}

void MediumLighting::FindArriving(
  const Ray* rays, RayMask wanted, LightPath* const* paths, MediumLight& light) const
{
  const std::size_t lamps = this->World.Lights.size();
  light.Arriving.assign(MediumLight::GetArriving(lamps, 0, 0, 0), 1.0f);
  struct Asked
  {
    int Ray;
    int Place;
    double T;
  };
  std::vector<Asked> asked;
  for (int place = 0; place < MediumLight::Places; ++place)
  {
    ForEachRay(wanted,
      [&](int ray)
      {
        double t = light.Place[place][ray];
        // What hardly shows anything looks once.
        t =
          place == 0 && std::isinf(t) && !std::isinf(light.First[ray]) ? light.GetHalfWay(ray) : t;
        if (!std::isinf(t))
        {
          asked.push_back({ ray, place, t });
        }
      });
  }
  for (std::size_t lamp = 0; lamp < lamps; ++lamp)
  {
    for (std::size_t first = 0; first < asked.size(); first += MaxRays)
    {
      const auto count = static_cast<int>(std::min<std::size_t>(MaxRays, asked.size() - first));
      Ray sent[MaxRays];
      for (int index = 0; index < count; ++index)
      {
        const Asked& own = asked[first + static_cast<std::size_t>(index)];
        LightPath& path = *paths[own.Ray];
        sent[index] =
          this->AimAtLamp(lamp, rays[own.Ray].Origin + own.T * rays[own.Ray].Direction, path);
        ++path.LightRays;
      }
      glm::dvec3 transmittances[MaxRays];
      this->Transmittances.Find(sent, count, transmittances);
      for (int index = 0; index < count; ++index)
      {
        const Asked& own = asked[first + static_cast<std::size_t>(index)];
        for (int channel = 0; channel < 3; ++channel)
        {
          // Places that the ray does not come to have the light of the last one.
          for (int place = own.Place; place < MediumLight::Places; ++place)
          {
            light.Arriving[MediumLight::GetArriving(lamp, channel, place, own.Ray)] =
              static_cast<float>(transmittances[index][channel]);
          }
        }
      }
    }
  }
}

Ray MediumLighting::AimAtLamp(std::size_t lamp, const glm::dvec3& position, LightPath& path) const
{
  const LightSample light = this->World.Lights[lamp].Sample(position, path.Random);
  Ray ray;
  ray.Origin = position;
  ray.Direction = light.Aim(this->World.Transport.LightRadius, path.Random);
  ray.Min = 0.0;
  ray.Max = light.Distance;
  return ray;
}

void MediumLighting::Shine(
  const Ray* rays, RayMask wanted, LightPath* const* paths, MediumLight& light) const
{
  std::vector<Places> places(MaxRays);
  const bool looks =
    this->World.Transport.Shadows || this->World.Transport.AmbientOcclusionSamples > 0;
  if (looks)
  {
    ForEachRay(wanted,
      [&](int ray)
      { places[static_cast<std::size_t>(ray)] = Choose(light.Pieces[ray], paths[ray]->Random); });
    for (int number = 0; number < MostPlaces; ++number)
    {
      const RayMask some = FindRays(wanted,
        [&](int ray)
        { return number < static_cast<int>(places[static_cast<std::size_t>(ray)].All.size()); });
      if (some != 0)
      {
        this->Look(number, rays, some, paths, places);
      }
    }
  }
  ForEachRay(wanted,
    [&](int ray)
    {
      const Places& own = places[static_cast<std::size_t>(ray)];
      double before = 0.0;
      for (MediumPiece& piece : light.Pieces[ray])
      {
        if (!piece.Look)
        {
          continue;
        }
        const Place* arriving = nullptr;
        if (!own.All.empty())
        {
          const double middle = (before + 0.5 * piece.Share) / own.Share;
          const std::size_t count = own.All.size();
          arriving = &own.All[std::min(
            static_cast<std::size_t>(middle * static_cast<double>(count)), count - 1)];
        }
        before += piece.Share;
        piece.Amount = this->GetLit(piece, GetPosition(rays[ray], piece), *paths[ray], arriving);
      }
    });
}

/// Each stands for an equal part of what is seen, and lies in it by chance.
MediumLighting::Places MediumLighting::Choose(
  const std::vector<MediumPiece>& pieces, SampleSequence& random)
{
  Places places;
  for (const MediumPiece& piece : pieces)
  {
    places.Share += piece.Look ? piece.Share : 0.0;
  }
  if (!(places.Share > 0.0))
  {
    return places;
  }
  const int count =
    std::clamp(static_cast<int>(std::ceil(places.Share * MostPlaces)), 1, MostPlaces);
  places.All.resize(static_cast<std::size_t>(count));
  const double within = random.Next();
  std::size_t next = 0;
  double before = 0.0;
  for (const MediumPiece& piece : pieces)
  {
    if (!piece.Look)
    {
      continue;
    }
    before += piece.Share;
    for (; next < places.All.size() &&
         (static_cast<double>(next) + within) * places.Share / count <= before;
         ++next)
    {
      places.All[next].Piece = &piece;
    }
    // Whatever rounding does to the last ones.
    for (std::size_t left = next; left < places.All.size(); ++left)
    {
      places.All[left].Piece = &piece;
    }
  }
  return places;
}

void MediumLighting::Look(int number, const Ray* rays, RayMask wanted, LightPath* const* paths,
  std::vector<Places>& places) const
{
  if (this->World.Transport.AmbientOcclusionSamples > 0)
  {
    this->LookAround(number, rays, wanted, paths, places);
  }
  if (this->World.Transport.Shadows)
  {
    this->LookToLamps(number, rays, wanted, paths, places);
  }
}

template <class Aim, class Take>
void MediumLighting::Send(int number, const Ray* rays, RayMask wanted, LightPath* const* paths,
  std::vector<Places>& places, const Aim& aim, const Take& take) const
{
  Ray sent[MaxRays];
  Place* asking[MaxRays];
  int count = 0;
  ForEachRay(wanted,
    [&](int index)
    {
      LightPath& path = *paths[index];
      Place& place = places[static_cast<std::size_t>(index)].All[static_cast<std::size_t>(number)];
      Ray& ray = sent[count];
      ray.Origin = GetPosition(rays[index], *place.Piece);
      ray.Min = 0.0;
      aim(ray, path, place.Piece->Normal);
      ++path.LightRays;
      asking[count++] = &place;
    });
  glm::dvec3 transmittances[MaxRays];
  this->Transmittances.Find(sent, count, transmittances);
  for (int index = 0; index < count; ++index)
  {
    take(*asking[index], transmittances[index]);
  }
}

void MediumLighting::LookAround(int number, const Ray* rays, RayMask wanted,
  LightPath* const* paths, std::vector<Places>& places) const
{
  const LightTransport& transport = this->World.Transport;
  // All places of a ray together look as often as a surface does.
  const int samples = (transport.AmbientOcclusionSamples + MostPlaces - 1) / MostPlaces;
  for (int sample = 0; sample < samples; ++sample)
  {
    this->Send(
      number, rays, wanted, paths, places,
      [&](Ray& ray, LightPath& path, const glm::dvec3& normal)
      {
        ray.Direction = normal == glm::dvec3(0.0)
          ? Directions::GetAny(path.Random)
          : Directions(glm::dot(normal, path.ToViewer) < 0.0 ? -normal : normal)
              .GetByCosine(path.Random);
        ray.Max = transport.AmbientOcclusionDistance;
      },
      [&](Place& place, const glm::dvec3& transmittance)
      {
        place.Ambient = (sample == 0 ? 0.0 : place.Ambient) +
          (transmittance.x + transmittance.y + transmittance.z) / (3.0 * samples);
      });
  }
}

void MediumLighting::LookToLamps(int number, const Ray* rays, RayMask wanted,
  LightPath* const* paths, std::vector<Places>& places) const
{
  for (std::size_t lamp = 0; lamp < this->World.Lights.size(); ++lamp)
  {
    this->Send(
      number, rays, wanted, paths, places,
      [&](Ray& ray, LightPath& path, const glm::dvec3&)
      { ray = this->AimAtLamp(lamp, ray.Origin, path); },
      [](Place& place, const glm::dvec3& transmittance) { place.Lamps.push_back(transmittance); });
  }
}

/// As VTK's ray cast mappers shade (vtkVolumeShaderComposer).
Lanes MediumLighting::GetLit(const MediumPiece& piece, const glm::dvec3& position, LightPath& path,
  const Place* arriving) const
{
  const MediumLook& look = *piece.Look;
  const glm::dvec3& toViewer = path.ToViewer;
  const Material& surface = look.Surface;
  const glm::dvec3 color(piece.Amount[0], piece.Amount[1], piece.Amount[2]);
  const double ambient = arriving ? arriving->Ambient : 1.0;
  const double surfacePart = 1.0 - look.Scattering;
  glm::dvec3 lit = look.Shade ? glm::dvec3(0.0) : surfacePart * color;
  const Environment& surroundings = this->World.Transport.Surroundings;
  if (!surroundings.IsBlack())
  {
    const bool isBehind = glm::dot(piece.Normal, toViewer) < 0.0;
    const glm::dvec3 onto = surroundings.GetLightOnto(isBehind ? -piece.Normal : piece.Normal);
    const glm::dvec3 fromAll = surroundings.GetLight(glm::dvec3(0.0));
    lit += ambient * color *
      ((look.Shade ? surfacePart * surface.Diffuse : 0.0) * onto + look.Scattering * fromAll);
  }
  for (std::size_t number = 0; number < this->World.Lights.size(); ++number)
  {
    const Light& lamp = this->World.Lights[number];
    const LightSample sample = lamp.Sample(position, path.Random);
    if (look.Shade)
    {
      lit += surfacePart * ambient * surface.Ambient *
        (lamp.IsLoneHeadlight ? color : piece.Amount[3] * glm::dvec3(lamp.AmbientColor));
    }
    glm::dvec3 light = sample.Radiance;
    if (arriving && !arriving->Lamps.empty())
    {
      light *= arriving->Lamps[number];
    }
    lit += look.Scattering * ambient *
      GetPhase(look.Anisotropy, glm::dot(sample.Direction, toViewer)) * light * color;
    const double along = -glm::dot(piece.Normal, sample.Direction);
    const double cosine = this->World.Transport.TwoSided ? std::abs(along) : along;
    if (look.Shade && cosine > 0.0)
    {
      lit += surfacePart * ambient * surface.Diffuse * cosine * light * color;
      const double highlight = glm::dot(glm::reflect(sample.Direction, piece.Normal), toViewer);
      if (surface.Specular > 0.0f && highlight > 0.0)
      {
        lit += surfacePart * surface.Specular * std::pow(highlight, surface.SpecularPower) *
          piece.Amount[3] * light;
      }
    }
  }
  return Lanes(lit.x, lit.y, lit.z, piece.Amount[3]);
}

} // namespace rt
