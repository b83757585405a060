// SPDX-License-Identifier: BSD-3-Clause
#ifndef MediumIntegral_h
#define MediumIntegral_h

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
#include <memory>
#include <utility>
#include <vector>

/// Value; red, green, blue and extinction there. Straight lines in between.
using Nodes = std::vector<std::pair<double, glm::dvec4>>;

inline glm::dvec4 Evaluate(const Nodes& nodes, double value)
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

/// Pixels of media against sums of so many samples that these have no error that could be seen.
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

  using Values = std::function<double(const glm::dvec3&)>;
  /// The values at all points.
  static std::vector<double> Sample(const Values& values)
  {
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
    return own;
  }

  /// Adds a medium. A mean takes values above 0 only.
  void Add(const Values& values, const Nodes& nodes, Blending blending = Blending::Composite,
    const rt::MediumLook& ownLook = {})
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
    this->Parts.push_back({ Sample(values), nodes, ownLook, {}, {}, {} });
  }

  /// Emission and extinction are a function of the values and of a second number: of `seconds` or, if that is null, of
  /// the gradients' lengths. `getExtinction`: of an opacity.
  void Add2D(const Values& values, const Values& seconds,
    const rt::TransferFunction2D::Image& image, const std::function<double(double)>& getExtinction,
    const rt::MediumLook& ownLook = {})
  {
    const auto function =
      std::make_shared<const rt::TransferFunction2D>(image, getExtinction, 2.0 / (Points - 1));
    rt::LatticeMedium medium{
      FunctionVolume::Publish(Points, values, this->Messenger, this->Store).Field,
      function->GetEnvelope(), ownLook, {}
    };
    medium.Function2D = function;
    if (seconds)
    {
      medium.SecondValues =
        FunctionVolume::Publish(Points, seconds, this->Messenger, this->Store).Field.Voxels;
    }
    this->World.Media.push_back(medium);
    this->Parts.push_back({ Sample(values), {}, ownLook,
      seconds ? Sample(seconds) : std::vector<double>{}, image, getExtinction });
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
  double StepsInCell = 512.0;
  /// Where planes between cells are; null: at equal distances.
  std::shared_ptr<const bricks::GridPlanes> Planes;

private:
  struct Part
  {
    std::vector<double> Values;
    Nodes Function;
    rt::MediumLook Look;
    ///@{
    /// Add2D
    std::vector<double> Seconds;
    rt::TransferFunction2D::Image Image;
    std::function<double(double)> GetExtinction;
    ///@}
  };

  static double GetOpacity(const glm::dvec4& look) { return look.w / (1.0 + look.w); }

  /// Calls `visit(place)` for so many places in the shortest way through a cell.
  template <class Visit>
  void ForEachStep(const rt::Ray& ray, const Visit& visit) const
  {
    const glm::dvec3 direction = glm::normalize(ray.Direction);
    const double length = glm::length(ray.Direction) * ray.Max;
    const double step = this->GetStep();
    for (double way = 0.5 * step; way < length; way += step)
    {
      const glm::dvec3 place = (ray.Origin + way * direction + 1.0) * (0.5 * (Points - 1));
      if (!glm::any(glm::lessThan(place, glm::dvec3(0.0))) &&
        !glm::any(glm::greaterThan(place, glm::dvec3(Points - 1))))
      {
        visit(place);
      }
    }
  }
  double GetStep() const { return 2.0 / (Points - 1) / this->StepsInCell; }

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
          const glm::dvec4 here = part.GetExtinction
            ? this->Evaluate2D(part, place)
            : Evaluate(part.Function, Interpolate(part.Values, place));
          sum += here.w == 0.0 ? glm::dvec4(0.0)
                               : this->Light(part, place, glm::normalize(ray.Direction),
                                   glm::dvec4(here.w * glm::dvec3(here), here.w));
        }
        const double passed = std::exp(-this->GetStep() * sum.w);
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
      const double gray = std::clamp(
        this->Blended == Blending::Mean ? sum / count : 0.5 * this->GetStep() * sum, 0.0, 1.0);
      return { glm::dvec3(gray), 1.0 };
    }
    const glm::dvec4 look =
      Evaluate(part.Function, this->Blended == Blending::Minimum ? least : largest);
    const double opacity = GetOpacity(look);
    return { opacity * glm::dvec3(look), opacity };
  }

  /// The look that an OpenGL texture would have, and the extinction of its opacity.
  glm::dvec4 Evaluate2D(const Part& part, const glm::dvec3& place) const
  {
    const double numbers[2] = { this->Interpolate(part.Values, place),
      part.Seconds.empty() ? glm::length(this->GetSmoothGradient(part.Values, place))
                           : this->Interpolate(part.Seconds, place) };
    const rt::TransferFunction2D::Image& image = part.Image;
    const glm::dvec2 ranges[2] = { image.Values, image.Seconds };
    const int counts[2] = { image.Columns, image.Rows };
    int first[2];
    double within[2];
    for (int axis = 0; axis < 2; ++axis)
    {
      const double texture = (numbers[axis] - ranges[axis].x) / (ranges[axis].y - ranges[axis].x);
      const double texel = std::clamp(texture * counts[axis] - 0.5, 0.0, counts[axis] - 1.0);
      first[axis] = std::min(static_cast<int>(texel), counts[axis] - 2);
      within[axis] = texel - first[axis];
    }
    glm::dvec4 look(0.0);
    for (int corner = 0; corner < 4; ++corner)
    {
      const int x = corner & 1;
      const int y = corner >> 1;
      look += (x != 0 ? within[0] : 1.0 - within[0]) * (y != 0 ? within[1] : 1.0 - within[1]) *
        image.Looks[static_cast<std::size_t>((first[1] + y) * counts[0] + first[0] + x)];
    }
    look.w = part.GetExtinction(look.w);
    return look;
  }

  /// Central differences at the corners of the cell, interpolated; in cells.
  glm::dvec3 GetSmoothGradient(const std::vector<double>& values, const glm::dvec3& place) const
  {
    const glm::ivec3 cell = glm::min(glm::ivec3(place), glm::ivec3(Points - 2));
    const glm::dvec3 within = place - glm::dvec3(cell);
    glm::dvec3 sum(0.0);
    for (int corner = 0; corner < 8; ++corner)
    {
      const glm::ivec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
      double weight = 1.0;
      glm::dvec3 gradient(0.0);
      for (int axis = 0; axis < 3; ++axis)
      {
        weight *= side[axis] != 0 ? within[axis] : 1.0 - within[axis];
        glm::ivec3 before = cell + side;
        glm::ivec3 after = before;
        before[axis] = std::max(0, before[axis] - 1);
        after[axis] = std::min(Points - 1, after[axis] + 1);
        const auto get = [&](const glm::ivec3& p)
        { return values[static_cast<std::size_t>(p.x + Points * (p.y + Points * p.z))]; };
        gradient[axis] = (get(after) - get(before)) / (after[axis] - before[axis]);
      }
      sum += weight * gradient;
    }
    return sum;
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

#endif
