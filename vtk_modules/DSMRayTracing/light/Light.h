// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Light_h
#define rt_Light_h

#include "DSMRayTracing/light/SampleSequence.h"

#include <glm/vec3.hpp>

#include <variant>

namespace rt
{

/// Light that arrives at a point from one place of a light if nothing is in between. World space.
struct LightSample
{
  glm::dvec3 Direction{ 0.0 }; ///< unit, from the light to the point
  double Distance = 0.0;       ///< to the light; infinite for a directional one
  glm::dvec3 Radiance{ 0.0 };

  /// Returns a unit direction from the point to the light or, where lights have a radius
  /// (LightTransport::LightRadius), to a random place on it.
  glm::dvec3 Aim(double lightRadius, SampleSequence& random) const;
};

// Kinds of lights. Each is a plain value, which messages between ranks copy, and has two methods. Sample returns what
// arrives at a point from a white light that shines along a unit direction. A light of some extent chooses one of its
// places by random numbers. AddTo adds the fields to a digest of the scene.

struct DirectionalLight
{
  LightSample Sample(
    const glm::dvec3& direction, const glm::dvec3& point, SampleSequence& random) const;
  template <class Digest>
  void AddTo(Digest&) const
  {
  }
};

struct PositionalLight
{
  glm::dvec3 Position{ 0.0 };
  /// Constant, linear and quadratic attenuation, as in vtkLight.
  glm::vec3 Attenuation{ 1.0f, 0.0f, 0.0f };

  LightSample Sample(
    const glm::dvec3& direction, const glm::dvec3& point, SampleSequence& random) const;
  template <class Digest>
  void AddTo(Digest& digest) const
  {
    digest.AddAll(this->Position, this->Attenuation);
  }
};

struct ConeLight
{
  PositionalLight Lamp;
  /// Cosine of the cone's half angle, and exponent of the fall-off within it, as in vtkLight.
  float Cosine = 0.0f;
  float Exponent = 1.0f;

  LightSample Sample(
    const glm::dvec3& direction, const glm::dvec3& point, SampleSequence& random) const;
  template <class Digest>
  void AddTo(Digest& digest) const
  {
    this->Lamp.AddTo(digest);
    digest.AddAll(this->Cosine, this->Exponent);
  }
};

/// All kinds. The first is the default.
using LightKind = std::variant<DirectionalLight, PositionalLight, ConeLight>;

/// World space. Colors include the intensity.
struct Light
{
  LightKind Kind;
  /// The scene's only light, and it shines along the view: as VTK, the highlight is then a power of
  /// the light's angle, not of the mirrored light's.
  bool IsLoneHeadlight = false;
  /// Unit, from the light into the scene.
  glm::dvec3 Direction{ 0.0, 0.0, -1.0 };
  glm::vec3 Color{ 1.0f };
  /// The light that it adds in shaded media, from all sides. Ignored if it is a lone headlight, as in VTK.
  glm::vec3 AmbientColor{ 0.0f };

  LightSample Sample(const glm::dvec3& point, SampleSequence& random) const;
};

} // namespace rt

#endif
