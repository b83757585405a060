// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/light/Light.h"

#include "DSMRayTracing/light/Directions.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <limits>

namespace rt
{

glm::dvec3 LightSample::Aim(double lightRadius, SampleSequence& random) const
{
  const glm::dvec3 center = -this->Direction;
  return lightRadius > 0.0 ? Directions(center).GetInCone(lightRadius, random) : center;
}

LightSample DirectionalLight::Sample(
  const glm::dvec3& direction, const glm::dvec3&, SampleSequence&) const
{
  return { direction, std::numeric_limits<double>::infinity(), glm::dvec3(1.0) };
}

LightSample PositionalLight::Sample(
  const glm::dvec3& direction, const glm::dvec3& point, SampleSequence&) const
{
  const glm::dvec3 way = point - this->Position;
  const double distance = glm::length(way);
  const double attenuation = 1.0 /
    (this->Attenuation.x + this->Attenuation.y * distance +
      this->Attenuation.z * distance * distance);
  // A point at the light has no direction to it. The light's own direction stands in.
  return { distance > 0.0 ? way / distance : direction, distance, glm::dvec3(attenuation) };
}

LightSample ConeLight::Sample(
  const glm::dvec3& direction, const glm::dvec3& point, SampleSequence& random) const
{
  LightSample sample = this->Lamp.Sample(direction, point, random);
  const double cosine = glm::dot(sample.Direction, direction);
  sample.Radiance =
    cosine >= this->Cosine ? std::pow(cosine, this->Exponent) * sample.Radiance : glm::dvec3(0.0);
  return sample;
}

LightSample Light::Sample(const glm::dvec3& point, SampleSequence& random) const
{
  LightSample sample = std::visit(
    [&](const auto& kind) { return kind.Sample(this->Direction, point, random); }, this->Kind);
  sample.Radiance *= glm::dvec3(this->Color);
  return sample;
}

} // namespace rt
