// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/light/Shading.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <vector>

namespace
{

rt::Material CreateMaterial()
{
  rt::Material material;
  material.Ambient = 0.1f;
  material.Diffuse = 0.5f;
  material.Specular = 0.25f;
  material.SpecularPower = 8.0f;
  material.AmbientColor = { 1.0f, 0.5f, 0.0f };
  material.DiffuseColor = { 0.2f, 0.4f, 0.6f };
  material.SpecularColor = { 1.0f, 1.0f, 0.5f };
  return material;
}

rt::Light CreateLight()
{
  rt::Light light;
  light.Direction = glm::normalize(glm::dvec3(1.0, 0.0, -2.0));
  light.Color = { 0.9f, 0.8f, 0.7f };
  return light;
}

void ExpectNear(const glm::vec3& a, const glm::dvec3& b)
{
  for (int channel = 0; channel < 3; ++channel)
  {
    EXPECT_NEAR(a[channel], b[channel], 1e-6) << channel;
  }
}

const glm::dvec3 Point(1.0, 2.0, 3.0);
const glm::dvec3 Up(0.0, 0.0, 1.0);
const glm::dvec3 ToViewer = glm::normalize(glm::dvec3(0.6, 0.0, 1.0));

glm::vec3 ShadePoint(const std::vector<rt::Light>& lights, const rt::Material& material,
  const glm::dvec3& normal, const glm::vec3& color, bool fromArray)
{
  rt::ShadingPoint point;
  point.Position = Point;
  point.Normal = normal;
  point.ToViewer = ToViewer;
  point.Color = color;
  point.ColorIsFromArray = fromArray;
  rt::SampleSequence random;
  return rt::Shade(lights, material, point,
    [&](std::size_t light) { return lights[light].Sample(Point, random); });
}

glm::vec3 ShadeWith(const rt::Light& light, const glm::dvec3& normal = Up)
{
  const rt::Material material = CreateMaterial();
  return ShadePoint({ light }, material, normal, material.DiffuseColor, false);
}

/// The formula of vtkOpenGLPolyDataMapper's fragment shader, for one light.
glm::dvec3 GetExpected(const glm::dvec3& direction, double attenuation)
{
  const rt::Material m = CreateMaterial();
  const glm::dvec3 light(CreateLight().Color);
  const double df = std::max(0.0, attenuation * glm::dot(Up, -direction));
  const glm::dvec3 reflected = direction - 2.0 * glm::dot(Up, direction) * Up;
  const double sf = (df > 0.0 ? 1.0 : 0.0) * attenuation *
    std::pow(std::max(0.0, glm::dot(reflected, ToViewer)), double(m.SpecularPower));
  return double(m.Ambient) * glm::dvec3(m.AmbientColor) +
    df * light * double(m.Diffuse) * glm::dvec3(m.DiffuseColor) +
    sf * light * double(m.Specular) * glm::dvec3(m.SpecularColor);
}

} // namespace

TEST(TestShading, DirectionalLight)
{
  ExpectNear(ShadeWith(CreateLight()), GetExpected(CreateLight().Direction, 1.0));
}

TEST(TestShading, ANormalThatTurnsAwayAtASilhouetteIsNotTurnedBack)
{
  rt::Light light = CreateLight();
  light.Direction = -ToViewer;
  const glm::dvec3 away = glm::normalize(glm::dvec3(1.0, 0.0, -0.7));
  EXPECT_LT(glm::dot(away, ToViewer), 0.0);
  ExpectNear(ShadeWith(light, away), { 0.1, 0.05, 0.0 });
}

TEST(TestShading, HighlightOfALoneHeadlightIsAPowerOfItsAngle)
{
  rt::Light light = CreateLight();
  light.IsLoneHeadlight = true;
  const rt::Material m = CreateMaterial();
  const double cosine = glm::dot(Up, -light.Direction);
  const glm::dvec3 expected = double(m.Ambient) * glm::dvec3(m.AmbientColor) +
    glm::dvec3(light.Color) *
      (cosine * double(m.Diffuse) * glm::dvec3(m.DiffuseColor) +
        std::pow(cosine, double(m.SpecularPower)) * double(m.Specular) *
          glm::dvec3(m.SpecularColor));
  ExpectNear(ShadeWith(light), expected);
}

TEST(TestShading, LightFromBehindLeavesTheAmbient)
{
  rt::Light light = CreateLight();
  light.Direction = -light.Direction;
  ExpectNear(ShadeWith(light), { 0.1, 0.05, 0.0 });
}

TEST(TestShading, PositionalLightIsAttenuated)
{
  rt::Light light = CreateLight();
  light.Kind = rt::PositionalLight{ Point + glm::dvec3(-3.0, 0.0, 4.0), { 0.5f, 0.1f, 0.02f } };
  ExpectNear(ShadeWith(light),
    GetExpected(glm::normalize(glm::dvec3(3.0, 0.0, -4.0)), 1.0 / (0.5 + 0.1 * 5 + 0.02 * 25)));
}

TEST(TestShading, ConeFallsOffAndEnds)
{
  rt::Light light = CreateLight();
  rt::ConeLight cone;
  cone.Lamp.Position = Point + glm::dvec3(-3.0, 0.0, 4.0);
  cone.Exponent = 3.0f;
  cone.Cosine = std::cos(0.5f);
  light.Kind = cone;
  light.Direction = glm::normalize(glm::dvec3(0.5, 0.0, -1.0));
  const glm::dvec3 direction = glm::normalize(glm::dvec3(3.0, 0.0, -4.0));
  const double cosine = glm::dot(direction, light.Direction);
  ASSERT_GT(cosine, cone.Cosine);
  ExpectNear(ShadeWith(light), GetExpected(direction, std::pow(cosine, 3.0)));
  cone.Cosine = static_cast<float>(cosine) + 1e-3f;
  light.Kind = cone;
  ExpectNear(ShadeWith(light), GetExpected(direction, 0.0));
}

TEST(TestShading, LightsAddUpAndSaturate)
{
  rt::Material material = CreateMaterial();
  const rt::Light light = CreateLight();
  const auto shade = [&](std::size_t lights)
  {
    return ShadePoint(
      std::vector<rt::Light>(lights, light), material, Up, material.DiffuseColor, false);
  };
  const glm::dvec3 ambient = glm::dvec3(material.Ambient * material.AmbientColor);
  const glm::dvec3 one = GetExpected(light.Direction, 1.0) - ambient;
  ExpectNear(shade(2), ambient + 2.0 * one);
  EXPECT_EQ(shade(100), glm::vec3(1.0f));
}

TEST(TestShading, ArrayColourIsAmbientToo)
{
  rt::Material material = CreateMaterial();
  rt::Light behind = CreateLight();
  behind.Direction = -behind.Direction;
  const glm::vec3 color(0.5f, 0.6f, 0.7f);
  ExpectNear(ShadePoint({ behind }, material, Up, color, true), { 0.05, 0.06, 0.07 });
  ExpectNear(ShadePoint({ behind }, material, Up, color, false), { 0.1, 0.05, 0.0 });
}

TEST(TestShading, WithoutLightingTheColourIsPlain)
{
  rt::Material material = CreateMaterial();
  const glm::vec3 color(0.5f, 0.6f, 0.7f);
  const glm::dvec3 plain(0.1 + 0.25, 0.05 + 0.3, 0.35);
  ExpectNear(ShadePoint({}, material, Up, color, false), plain);
  material.Lighting = false;
  ExpectNear(ShadePoint({ CreateLight() }, material, Up, color, false), plain);
}

TEST(TestShading, HiddenLightLeavesTheAmbient)
{
  const rt::Material material = CreateMaterial();
  rt::ShadingPoint point;
  point.Position = Point;
  point.Normal = Up;
  point.ToViewer = ToViewer;
  point.Color = material.DiffuseColor;
  const auto shade = [&](const glm::dvec3& part)
  {
    return rt::Shade({ CreateLight() }, material, point,
      [&](std::size_t)
      {
        rt::SampleSequence random;
        rt::LightSample light = CreateLight().Sample(Point, random);
        light.Radiance *= part;
        return light;
      });
  };
  const glm::dvec3 ambient(0.1, 0.05, 0.0);
  const glm::dvec3 lit = GetExpected(CreateLight().Direction, 1.0) - ambient;
  ExpectNear(shade(glm::dvec3(0.0)), ambient);
  ExpectNear(shade({ 1.0, 0.5, 0.0 }), ambient + glm::dvec3(1.0, 0.5, 0.0) * lit);
}
