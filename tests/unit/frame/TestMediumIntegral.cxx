// SPDX-License-Identifier: BSD-3-Clause
// Pixels of media against sums of so many samples that these have no error that could be seen.
#include "tests/support/FunctionVolume.h"

#include "DSMCore/transport/LoopbackTransport.h"
#include "DSMRayTracing/frame/TileGrid.h"
#include "DSMRayTracing/frame/TileSampler.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace
{

/// Value; red, green, blue and extinction there. Straight lines in between.
using Nodes = std::vector<std::pair<double, glm::dvec4>>;

glm::dvec4 Evaluate(const Nodes& nodes, double value)
{
  const double held = std::clamp(value, nodes.front().first, nodes.back().first);
  std::size_t node = 1;
  while (node + 1 < nodes.size() && nodes[node].first < held)
  {
    ++node;
  }
  const auto& [low, before] = nodes[node - 1];
  const auto& [high, after] = nodes[node];
  return before + (held - low) / (high - low) * (after - before);
}

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

class TestMediumIntegral : public testing::Test
{
protected:
  static constexpr int Points = 33;

  static double GetWaves(const glm::dvec3& p)
  {
    return std::sin(7.0 * p.x) + std::sin(6.0 * p.y + p.x) + std::sin(8.0 * p.z) - 0.4;
  }
  /// Values of neighboring points have little to do with one another.
  static double GetNoise(const glm::dvec3& p)
  {
    return 3.0 * std::sin(1e4 * (p.x + 1.7 * p.y + 2.9 * p.z));
  }

  enum class Blending
  {
    Composite,
    Maximum,
    Minimum,
    Mean,
    Sum
  };

  /// Of a mean, values above 0 count.
  void Add(const std::function<double(const glm::dvec3&)>& values, const Nodes& nodes,
    Blending blending = Blending::Composite, const rt::MediumLook& ownLook = {})
  {
    rt::LatticeField field =
      FunctionVolume::Publish(Points, values, this->Messenger, this->Store).Field;
    if (this->Planes)
    {
      const auto stretched = std::make_shared<bricks::VoxelField>(*field.Voxels);
      stretched->Planes = this->Planes;
      field.Voxels = stretched;
    }
    const double first = nodes.front().first;
    const double last = nodes.back().first;
    std::vector<double> places;
    for (const auto& node : nodes)
    {
      places.push_back(node.first);
    }
    const auto look = [&](double value) { return Evaluate(nodes, value); };
    const auto sum = [&](double value)
    {
      const double weight = blending == Blending::Mean && value < 0.0 ? 0.0 : 1.0;
      return rt::LatticeSum::ToLook({ look(value).x, weight }, 2.0);
    };
    const auto colors = std::make_shared<rt::ColorMap>();
    colors->First = first;
    colors->Last = last;
    colors->Sample(
      rt::TransferFunction::Bins,
      [&](double value)
      {
        const glm::dvec4 here = look(value);
        return glm::vec4(glm::dvec3(here), GetOpacity(here));
      },
      places);
    colors->Below = colors->Map(first);
    colors->Above = colors->Map(last);
    switch (blending)
    {
      case Blending::Composite:
        this->World.Media.push_back(rt::LatticeMedium{ field,
          rt::TransferFunction::Create(first, last, look, places, 0.0, 2.0 / (Points - 1)), ownLook,
          {} });
        break;
      case Blending::Maximum:
      case Blending::Minimum:
        this->World.Media.push_back(
          rt::LatticeExtremum{ field, colors, blending == Blending::Minimum, {} });
        break;
      default:
        places.push_back(0.0);
        this->World.Media.push_back(
          rt::LatticeSum{ field, rt::TransferFunction::Create(first, last, sum, places, 0.0, 0.0),
            blending == Blending::Mean, {} });
    }
    this->Blended = blending;
    std::vector<double> own;
    for (int z = 0; z < Points; ++z)
    {
      for (int y = 0; y < Points; ++y)
      {
        for (int x = 0; x < Points; ++x)
        {
          own.push_back(values(-1.0 + 2.0 / (Points - 1) * glm::dvec3(x, y, z)));
        }
      }
    }
    this->Parts.push_back({ std::move(own), nodes, ownLook });
  }

  void Clear()
  {
    this->World.Media.clear();
    this->Parts.clear();
  }

  /// The largest difference of any channel of any pixel, in 255ths.
  double Compare(const glm::dmat4& worldToClip)
  {
    return this->Compare(worldToClip,
      [this](const rt::Ray& ray, std::vector<glm::dvec3>& half) {
        return this->Blended == Blending::Composite ? this->Integrate(ray, half) : this->Blend(ray);
      });
  }
  /// `expect(ray, half)`: what is right; adds places where about half of the light is gone.
  double Compare(const glm::dmat4& worldToClip,
    const std::function<glm::dvec4(const rt::Ray&, std::vector<glm::dvec3>&)>& expect)
  {
    rt::FrameRequest request;
    request.Width = 24;
    request.Height = 20;
    request.TileSize = 32;
    request.WorldToClip = worldToClip;
    const rt::PixelRays rays(request);
    return this->Store.Visit(
      [&](auto& store)
      {
        auto& worker = store.GetWorker(0);
        const rt::SceneTracers tracers = rt::CreateSceneTracers(store, worker, this->World);
        const rt::TileSampler sampler(tracers, this->World, rays, request);
        rt::Tile tile = rt::TileGrid(request.Width, request.Height, request.TileSize).CreateTile(0);
        store.BeginFrame();
        store.Enter(worker);
        sampler.Trace(tile);
        store.Leave(worker);
        store.EndFrame();
        double largest = 0.0;
        double mean = 0.0;
        for (int y = 0; y < request.Height; ++y)
        {
          for (int x = 0; x < request.Width; ++x)
          {
            const rt::Ray ray = rays.GetRay(x, y);
            std::vector<glm::dvec3> half;
            const glm::dvec4 expected = expect(ray, half);
            if (!half.empty() && expected.w > 0.52)
            {
              constexpr double slack = 1e-3; // half a cell
              const float depth = tile.Depth[static_cast<std::size_t>(y * request.Width + x)];
              EXPECT_GT(depth, rays.GetDepth(half.front()) - slack) << x << ", " << y;
              EXPECT_LT(depth, rays.GetDepth(half.back()) + slack) << x << ", " << y;
            }
            const glm::dvec4 found(tile.Sum[static_cast<std::size_t>(y * request.Width + x)]);
            for (int channel = 0; channel < 4; ++channel)
            {
              largest = std::max(largest, 255.0 * std::abs(found[channel] - expected[channel]));
            }
            mean += found.w;
          }
        }
        EXPECT_GT(mean, 20.0) << "nothing is seen";
        return largest;
      });
  }

  static glm::dmat4 GetPerspective()
  {
    return glm::perspective(0.6, 1.2, 1.0, 20.0) *
      glm::lookAt(glm::dvec3(2.9, 2.1, 3.3), glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0));
  }
  static glm::dmat4 GetAlongZ()
  {
    return glm::ortho(-1.3, 1.3, -1.1, 1.1, 1.0, 20.0) *
      glm::lookAt(glm::dvec3(0.0, 0.0, 5.0), glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0));
  }

  rt::Scene World;
  /// Where planes between cells are; null: at equal distances.
  std::shared_ptr<const bricks::GridPlanes> Planes;

private:
  struct Part
  {
    std::vector<double> Values;
    Nodes Function;
    rt::MediumLook Look;
  };

  static double GetOpacity(const glm::dvec4& look) { return look.w / (1.0 + look.w); }

  /// Calls `visit(place)` for so many places in the shortest way through a cell.
  template <class Visit>
  static void ForEachStep(const rt::Ray& ray, const Visit& visit)
  {
    const glm::dvec3 direction = glm::normalize(ray.Direction);
    const double length = glm::length(ray.Direction) * ray.Max;
    for (double way = 0.5 * Step; way < length; way += Step)
    {
      const glm::dvec3 place = (ray.Origin + way * direction + 1.0) * (0.5 * (Points - 1));
      if (!glm::any(glm::lessThan(place, glm::dvec3(0.0))) &&
        !glm::any(glm::greaterThan(place, glm::dvec3(Points - 1))))
      {
        visit(place);
      }
    }
  }
  static constexpr double Step = 2.0 / (Points - 1) / 512.0;

  /// `half`: places where about half of the light is gone.
  glm::dvec4 Integrate(const rt::Ray& ray, std::vector<glm::dvec3>& half) const
  {
    glm::dvec3 color(0.0);
    double transmittance = 1.0;
    ForEachStep(ray,
      [&](const glm::dvec3& place)
      {
        glm::dvec4 sum(0.0);
        for (const Part& part : this->Parts)
        {
          const glm::dvec4 here = Evaluate(part.Function, Interpolate(part.Values, place));
          sum += here.w == 0.0 ? glm::dvec4(0.0)
                               : this->Light(part, place, glm::normalize(ray.Direction),
                                   glm::dvec4(here.w * glm::dvec3(here), here.w));
        }
        const double passed = std::exp(-Step * sum.w);
        if (sum.w > 0.0)
        {
          color += transmittance * (1.0 - passed) * glm::dvec3(sum) / sum.w;
        }
        if (transmittance > 0.48 && transmittance * passed < 0.52)
        {
          half.push_back(place * (2.0 / (Points - 1)) - 1.0);
        }
        transmittance *= passed;
      });
    return { color, 1.0 - transmittance };
  }

  glm::dvec4 Blend(const rt::Ray& ray) const
  {
    const Part& part = this->Parts.front();
    double least = HUGE_VAL;
    double largest = -HUGE_VAL;
    double sum = 0.0;
    double count = 0.0;
    const bool isSummed = this->Blended == Blending::Mean || this->Blended == Blending::Sum;
    ForEachStep(ray,
      [&](const glm::dvec3& place)
      {
        const double value = Interpolate(part.Values, place);
        least = std::min(least, value);
        largest = std::max(largest, value);
        if (!isSummed)
        {
          return;
        }
        const double weight = this->Blended == Blending::Mean && value < 0.0 ? 0.0 : 1.0;
        sum += weight * Evaluate(part.Function, value).x;
        count += weight;
      });
    if (isSummed ? count == 0.0 : least > largest)
    {
      return glm::dvec4(0.0);
    }
    if (isSummed)
    {
      const double gray =
        std::clamp(this->Blended == Blending::Mean ? sum / count : 0.5 * Step * sum, 0.0, 1.0);
      return { glm::dvec3(gray), 1.0 };
    }
    const glm::dvec4 look =
      Evaluate(part.Function, this->Blended == Blending::Minimum ? least : largest);
    const double opacity = GetOpacity(look);
    return { opacity * glm::dvec3(look), opacity };
  }

  /// What becomes of a color with its extinction.
  glm::dvec4 Light(const Part& part, const glm::dvec3& place, const glm::dvec3& direction,
    const glm::dvec4& amount) const
  {
    const rt::MediumLook& look = part.Look;
    glm::dvec3 gradient(0.0);
    for (int axis = 0; axis < 3 && (look.Shade || look.Gradients); ++axis)
    {
      glm::dvec3 before = place;
      glm::dvec3 after = place;
      before[axis] = std::max(0.0, place[axis] - 1.0);
      after[axis] = std::min(Points - 1.0, place[axis] + 1.0);
      gradient[axis] = (Interpolate(part.Values, after) - Interpolate(part.Values, before)) /
        (after[axis] - before[axis]);
    }
    const double density = look.Gradients ? look.Gradients->GetFactor(glm::length(gradient)) : 1.0;
    if (!look.Shade)
    {
      return density * amount;
    }
    glm::dvec3 lit(0.0);
    for (const rt::Light& light : this->World.Lights)
    {
      lit += double(look.Surface.Ambient) *
        (light.IsLoneHeadlight ? glm::dvec3(amount) : amount.w * glm::dvec3(light.AmbientColor));
      const glm::dvec3 normal = glm::normalize(gradient);
      const glm::dvec3 mirrored = glm::reflect(light.Direction, normal);
      lit += glm::dvec3(light.Color) *
        (look.Surface.Diffuse * std::abs(glm::dot(normal, light.Direction)) * glm::dvec3(amount) +
          look.Surface.Specular * amount.w *
            std::pow(std::max(0.0, glm::dot(mirrored, -direction)), look.Surface.SpecularPower));
    }
    return density * glm::dvec4(lit, amount.w);
  }

  double Interpolate(const std::vector<double>& values, const glm::dvec3& at) const
  {
    const glm::dvec3 place = this->Planes ? this->Planes->ToIndex(at) : at;
    const glm::ivec3 cell = glm::min(glm::ivec3(place), glm::ivec3(Points - 2));
    const glm::dvec3 within = place - glm::dvec3(cell);
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner)
    {
      const glm::ivec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
      const glm::ivec3 point = cell + side;
      double weight = 1.0;
      for (int axis = 0; axis < 3; ++axis)
      {
        weight *= side[axis] != 0 ? within[axis] : 1.0 - within[axis];
      }
      sum +=
        weight * values[static_cast<std::size_t>(point.x + Points * (point.y + Points * point.z))];
    }
    return sum;
  }

  dsm::Messenger Messenger{ std::move(dsm::LoopbackTransport::CreateGroup(1).front()) };
  dsm::BlockStore Store{ Messenger, dsm::BlockStore::Settings{} };
  std::vector<Part> Parts;
  Blending Blended = Blending::Composite;
};

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
