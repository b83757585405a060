// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/frame/MediumIntegral.h"

namespace
{

const Nodes Fog = { { -3.0, { 0.1, 0.3, 0.9, 0.0 } }, { 0.0, { 0.3, 0.8, 0.4, 1.5 } },
  { 3.0, { 0.9, 0.2, 0.1, 6.0 } } };
/// A 256th of the range wide.
const Nodes Peak = { { -3.0, { 0.9, 0.5, 0.1, 0.0 } }, { 0.0, { 0.9, 0.5, 0.1, 0.0 } },
  { 3.0 / 256, { 0.9, 0.5, 0.1, 120.0 } }, { 6.0 / 256, { 0.9, 0.5, 0.1, 0.0 } },
  { 3.0, { 0.9, 0.5, 0.1, 0.0 } } };
/// A 16384th of a range of which values that lie near 0 fill a small part.
Nodes GetNarrowPeak(double range)
{
  const double width = 2.0 * range / 16384;
  const glm::dvec4 color(0.9, 0.5, 0.1, 0.0);
  return { { -range, color }, { 0.1, color },
    { 0.1 + 0.5 * width, color + glm::dvec4(0.0, 0.0, 0.0, 3.0 / width) }, { 0.1 + width, color },
    { range, color } };
}
/// Two steps in one even bin, each of color and extinction.
const Nodes Steps = { { -3e4, { 0.1, 0.3, 0.9, 0.5 } }, { 0.1, { 0.1, 0.3, 0.9, 0.5 } },
  { 0.1 + 1e-9, { 0.9, 0.8, 0.1, 8.0 } }, { 0.7, { 0.9, 0.8, 0.1, 8.0 } },
  { 0.7 + 1e-9, { 0.2, 0.9, 0.3, 0.0 } }, { 3e4, { 0.2, 0.9, 0.3, 0.0 } } };
/// Colors change where little light gets through.
const Nodes Rainbow = { { -1.0, { 1.0, 0.0, 0.0, 0.0 } }, { -0.5, { 0.0, 1.0, 0.0, 30.0 } },
  { 0.5, { 0.0, 0.0, 1.0, 90.0 } }, { 1.5, { 1.0, 1.0, 0.0, 10.0 } } };

TEST_F(TestMediumIntegral, OfSmoothFunctions)
{
  this->Add(GetWaves, Fog);
  EXPECT_LT(this->Compare(GetPerspective()), 1.0);
  EXPECT_LT(this->Compare(GetAlongZ()), 1.0);
}

TEST_F(TestMediumIntegral, OfValuesThatHardlyBend)
{
  // Rays take macrocells as a whole.
  this->Add(
    [](const glm::dvec3& p) { return 2.0 * std::sin(0.7 * p.x + 0.5 * p.y - 0.6 * p.z); }, Fog);
  EXPECT_LT(this->Compare(GetPerspective()), 0.5);
  EXPECT_LT(this->Compare(GetAlongZ()), 0.5);
}

TEST_F(TestMediumIntegral, OfANarrowPeak)
{
  this->Add(GetWaves, Peak);
  EXPECT_LT(this->Compare(GetPerspective()), 1.0);
  EXPECT_LT(this->Compare(GetAlongZ()), 1.0);
}

TEST_F(TestMediumIntegral, OfWhatIsNarrowerThanABin)
{
  // Values fill 40 even bins, or a part of one.
  for (const double range : { 300.0, 3e4 })
  {
    this->Add(GetWaves, GetNarrowPeak(range));
    EXPECT_LT(this->Compare(GetPerspective()), 1.0) << range;
    this->Clear();
  }
  this->Add(GetWaves, Steps);
  EXPECT_LT(this->Compare(GetPerspective()), 2.0);
  for (const auto blending : { Blending::Maximum, Blending::Sum })
  {
    this->Clear();
    this->Add(GetWaves, Steps, blending);
    EXPECT_LT(this->Compare(GetAlongZ()), 2.0) << static_cast<int>(blending);
  }
}

TEST_F(TestMediumIntegral, OfColorsThatChangeWithinAWall)
{
  this->Add(GetWaves, Rainbow);
  EXPECT_LT(this->Compare(GetPerspective()), 1.0);
}

TEST_F(TestMediumIntegral, OfNoise)
{
  this->Add(GetNoise, Fog);
  EXPECT_LT(this->Compare(GetPerspective()), 1.0);
}

TEST_F(TestMediumIntegral, OfANarrowPeakInNoise)
{
  this->Add(GetNoise, Peak);
  EXPECT_LT(this->Compare(GetPerspective()), 1.0);
}

TEST_F(TestMediumIntegral, OfTwoMediaInOneAnother)
{
  this->Add(GetWaves, Fog);
  this->Add([](const glm::dvec3& p) { return 2.0 - 3.0 * glm::length(p); }, Rainbow);
  EXPECT_LT(this->Compare(GetPerspective()), 1.0);
}

TEST_F(TestMediumIntegral, OfOneValueOfARay)
{
  for (const auto blending :
    { Blending::Maximum, Blending::Minimum, Blending::Mean, Blending::Sum })
  {
    this->Clear();
    this->Add(GetWaves, Fog, blending);
    EXPECT_LT(this->Compare(GetAlongZ()), 1.0) << static_cast<int>(blending);
    this->Clear();
    this->Add(GetNoise, Fog, blending);
    // The sums miss half a step at each end, where noise changes by a 50th of its range.
    EXPECT_LT(this->Compare(GetPerspective()), 2.0) << static_cast<int>(blending);
  }
}

rt::MediumLook GetShaded()
{
  rt::MediumLook look;
  look.Shade = true;
  look.Surface.Ambient = 0.2f;
  look.Surface.Diffuse = 0.7f;
  look.Surface.Specular = 0.3f;
  look.Surface.SpecularPower = 12.0f;
  return look;
}

TEST_F(TestMediumIntegral, OfRectilinearGrids)
{
  bricks::GridPlanes::Coordinates coordinates;
  for (int plane = 0; plane < Points; ++plane)
  {
    coordinates[0].push_back(std::pow(1.12, plane));
    coordinates[1].push_back(plane + 0.45 * std::sin(5.0 * plane));
    coordinates[2].push_back(-std::pow(0.8, plane));
  }
  this->Planes = std::make_shared<bricks::GridPlanes>(coordinates);
  for (const Blending blending :
    { Blending::Composite, Blending::Maximum, Blending::Minimum, Blending::Sum })
  {
    for (const bool isNoise : { false, true })
    {
      if (isNoise && (blending == Blending::Maximum || blending == Blending::Minimum))
      {
        continue; // the sum's samples miss extrema in thin cells
      }
      this->Add(isNoise ? GetNoise : GetWaves, Fog, blending);
      EXPECT_LT(this->Compare(GetPerspective()), 1.0) << static_cast<int>(blending) << isNoise;
      EXPECT_LT(this->Compare(GetAlongZ()), 1.0) << static_cast<int>(blending) << isNoise;
      this->Clear();
    }
  }
}

TEST_F(TestMediumIntegral, OfShadedMedia)
{
  rt::Light light;
  light.Direction = glm::normalize(glm::dvec3(-1.0, -2.0, -1.5));
  light.Color = { 0.9f, 0.8f, 0.7f };
  light.AmbientColor = { 0.3f, 0.6f, 0.2f };
  this->World.Lights.push_back(light);
  // Highlights are taken where the middle of a cell's piece is.
  this->Add(GetWaves, Fog, Blending::Composite, GetShaded());
  EXPECT_LT(this->Compare(GetPerspective()), 3.0);
  this->World.Lights.front().IsLoneHeadlight = true;
  EXPECT_LT(this->Compare(GetPerspective()), 3.0);
  this->Add([](const glm::dvec3& p) { return 2.0 - 3.0 * glm::length(p); }, Rainbow);
  EXPECT_LT(this->Compare(GetPerspective()), 3.0);
}

TEST_F(TestMediumIntegral, OfExtinctionByGradients)
{
  rt::MediumLook look;
  rt::GradientOpacity opacity;
  opacity.Last = 0.6;
  for (int factor = 0; factor < 1024; ++factor)
  {
    opacity.Factors.push_back(factor < 200 ? 0.0 : (factor - 200) / 824.0);
  }
  look.Gradients = std::make_shared<const rt::GradientOpacity>(std::move(opacity));
  this->Add(GetWaves, Fog, Blending::Composite, look);
  EXPECT_LT(this->Compare(GetPerspective()), 2.0);
}

TEST_F(TestMediumIntegral, OfLightThatIsScattered)
{
  // A cube that is the same everywhere, and light that comes from -x: as deep as a place lies, as dark is it.
  constexpr double extinction = 0.8;
  rt::MediumLook look;
  look.Scattering = 1.0;
  this->Add([](const glm::dvec3&) { return 0.5; },
    { { 0.0, { 0.9, 0.6, 0.3, extinction } }, { 1.0, { 0.9, 0.6, 0.3, extinction } } },
    Blending::Composite, look);
  rt::Light light;
  light.Direction = { 1.0, 0.0, 0.0 };
  this->World.Lights.push_back(light);
  this->World.Transport.Shadows = true;
  const auto expect = [&](const rt::Ray& ray, std::vector<glm::dvec3>&)
  {
    if (std::abs(ray.Origin.x) >= 1.0 || std::abs(ray.Origin.y) >= 1.0)
    {
      return glm::dvec4(0.0);
    }
    const double covered = 1.0 - std::exp(-2.0 * extinction);
    const double arriving = std::exp(-extinction * (ray.Origin.x + 1.0));
    return glm::dvec4(covered * arriving * glm::dvec3(0.9, 0.6, 0.3), covered);
  };
  EXPECT_LT(this->Compare(GetAlongZ(), expect), 0.5);
}

TEST_F(TestMediumIntegral, OfLightFromAllSides)
{
  constexpr double extinction = 0.8;
  rt::MediumLook look;
  look.Shade = true;
  look.Surface.Ambient = 0.0f;
  look.Surface.Diffuse = 0.5f;
  look.Scattering = 0.25;
  this->Add([](const glm::dvec3&) { return 0.5; },
    { { 0.0, { 0.9, 0.6, 0.3, extinction } }, { 1.0, { 0.9, 0.6, 0.3, extinction } } },
    Blending::Composite, look);
  this->World.Transport.Surroundings.Lower = glm::vec3(0.2f);
  this->World.Transport.Surroundings.Upper = glm::vec3(0.6f);
  const auto expect = [&](const rt::Ray& ray, std::vector<glm::dvec3>&)
  {
    const bool isInside = std::abs(ray.Origin.x) < 1.0 && std::abs(ray.Origin.y) < 1.0;
    const double covered = isInside ? 1.0 - std::exp(-2.0 * extinction) : 0.0;
    constexpr double lit = 0.4 * (0.75 * 0.5 + 0.25);
    return glm::dvec4(covered * lit * glm::dvec3(0.9, 0.6, 0.3), covered);
  };
  EXPECT_LT(this->Compare(GetAlongZ(), expect), 0.5);
}

} // namespace
