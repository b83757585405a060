// SPDX-License-Identifier: BSD-3-Clause
// All that is shown of a field, for each kind of field, against closed formulas. Lattices and levels hold samples
// of the function; a function without bricks has nothing but a walk and a sampler.
#include "tests/support/LoopbackCluster.h"
#include "tests/support/PictureHash.h"
#include "tests/support/SphereScene.h"
#include "tests/unit/frame/FieldKinds.h"

#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/frame/FrameRenderer.h"
#include "DSMRayTracing/frame/PixelRays.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace
{

using FieldKinds::GetMedium;
using FieldKinds::GetObject;

/// A ball's surface is where this has such a value.
const Quadratic Ball{ 0.0, { 0.1, 0.0, -0.1 }, { 1.0, 1.4, 0.9 } };
constexpr double BallValue = 0.25;
constexpr double SliceHeight = -0.8;
/// Lattices and levels hold exactly this.
const Quadratic Slope{ 0.5, { 0.2, -0.15, 0.1 } };
/// Largest within the box, and smallest at its sides.
const Quadratic Hill{ 0.9, { 0.05, -0.02, 0.04 }, { -0.2, -0.15, -0.25 } };

/// What a pixel is to show, premultiplied; nothing where that is not known.
using Expected = std::optional<glm::dvec4>;

glm::dvec3 GetPoint(const rt::Ray& ray, double t)
{
  return ray.Origin + t * ray.Direction;
}

/// T of the places, in order, where a function has a value.
std::vector<double> FindRoots(const Quadratic& function, double value, const rt::Ray& ray)
{
  const double a = glm::dot(function.Square, ray.Direction * ray.Direction);
  const double b = glm::dot(function.GetGradient(ray.Origin), ray.Direction);
  const double c = function.Evaluate(ray.Origin) - value;
  const double discriminant = b * b - 4.0 * a * c;
  double first;
  double last;
  std::vector<double> roots;
  for (const double sign : { -1.0, 1.0 })
  {
    const double root = (-b + sign * std::sqrt(discriminant)) / (2.0 * a);
    if (discriminant > 0.0 && Quadratic::FindWay(ray, first, last) && root >= first && root <= last)
    {
      roots.push_back(root);
    }
  }
  return roots;
}

/// T where a ray meets a plane of this height within the box.
std::optional<double> FindPlane(double height, const rt::Ray& ray)
{
  const double t = (height - ray.Origin.z) / ray.Direction.z;
  double first;
  double last;
  return Quadratic::FindWay(ray, first, last) && t >= first && t <= last ? std::optional(t)
                                                                         : std::nullopt;
}

/// The integral of a function between two places of a ray, over the length of the way.
double Integrate(const Quadratic& function, const rt::Ray& ray, double first, double last)
{
  // Simpson's rule, which is exact.
  const double sum = function.Evaluate(GetPoint(ray, first)) +
    4.0 * function.Evaluate(GetPoint(ray, 0.5 * (first + last))) +
    function.Evaluate(GetPoint(ray, last));
  return sum / 6.0 * (last - first) * glm::length(ray.Direction);
}

/// From (0, 0.5, 1) at 0 to (1, 0.5, 0) at 1.
glm::dvec3 GetColor(double value)
{
  return { value, 0.5, 1.0 - value };
}
rt::ColorMap CreateColors()
{
  rt::ColorMap colors;
  colors.Sample(4096, [](double value) { return glm::vec4(glm::vec3(GetColor(value)), 1.0f); }, {});
  colors.Below = colors.Map(0.0);
  colors.Above = colors.Map(1.0);
  return colors;
}

rt::Light GetLight()
{
  rt::Light light;
  light.Direction = glm::normalize(glm::dvec3(0.4, 0.3, -1.0));
  return light;
}

template <class Kind>
class FieldTest : public testing::Test
{
protected:
  using FieldType = typename Kind::FieldType;
  using Values = std::shared_ptr<const typename FieldType::Values>;
  /// Makes values of a function.
  using Publish = std::function<Values(const Quadratic&)>;
  using Build = std::function<void(const Publish&, rt::Scene&)>;

  /// Compares a scene's picture on several ranks, in all organizations of memory, with `expect(ray)` for each pixel
  /// but those in which it changes much. The largest difference, in 255ths: `sampled` where the field holds
  /// samples, else `exact`.
  void Check(const Build& build, const std::function<Expected(const rt::Ray&)>& expect,
    double sampled, double exact = 1.0)
  {
    const rt::Picture picture = Trace(build, 1, dsm::MemoryOrganization::Replicated);
    for (const auto organization :
      { dsm::MemoryOrganization::ObjectBased, dsm::MemoryOrganization::PageBased })
    {
      EXPECT_EQ(GetPictureHash(Trace(build, 3, organization)), GetPictureHash(picture));
    }
    const rt::PixelRays rays(CreateRequest());
    double largest = 0.0;
    int compared = 0;
    for (int y = 0; y < picture.Height; ++y)
    {
      for (int x = 0; x < picture.Width; ++x)
      {
        const auto get = [&](double across, double up) {
          return expect(rays.GetRay(x, y, { across, up }));
        };
        const Expected expected = get(0.5, 0.5);
        const bool isEven = expected && expected->w > 0.0 && AreNear(expected, get(0.0, 0.0)) &&
          AreNear(expected, get(1.0, 0.0)) && AreNear(expected, get(0.0, 1.0)) &&
          AreNear(expected, get(1.0, 1.0));
        for (int channel = 0; isEven && channel < 4; ++channel)
        {
          const std::size_t place = 4 * static_cast<std::size_t>(y * picture.Width + x);
          const double found = picture.Color[place + static_cast<std::size_t>(channel)];
          largest = std::max(largest, std::abs(found - 255.0 * (*expected)[channel]));
        }
        compared += isEven;
      }
    }
    EXPECT_LE(largest, Kind::IsExact ? exact : sampled);
    EXPECT_GT(compared, 100);
  }

  static FieldType Create(const Values& values) { return Kind::Create(values); }

  /// A floor in the field of a function.
  static rt::SliceOf<FieldType> CreateFloor(const Values& values)
  {
    rt::SliceOf<FieldType> slice;
    slice.Field = Create(values);
    slice.Planes = { { { 0.0, 0.0, 1.0 }, { 0.0, 0.0, SliceHeight } } };
    return slice;
  }
  static rt::IsosurfaceOf<FieldType> CreateBall(const Values& values)
  {
    rt::IsosurfaceOf<FieldType> ball;
    ball.Field = Create(values);
    ball.Isovalues = { BallValue };
    return ball;
  }
  /// A medium of that color and extinction as functions of the value, which is from 0 to 1.
  static rt::MediumOf<FieldType> CreateMedium(
    const Values& values, const std::function<glm::dvec4(double)>& look)
  {
    rt::MediumOf<FieldType> medium;
    medium.Field = Create(values);
    medium.Function = rt::TransferFunction::Create(0.0, 1.0, look, {}, 0.0, 0.0);
    return medium;
  }

private:
  static bool AreNear(const Expected& one, const Expected& other)
  {
    if (!one || !other)
    {
      return false;
    }
    const glm::dvec4 difference = glm::abs(*one - *other);
    return std::max({ difference.x, difference.y, difference.z, difference.w }) < 0.1;
  }

  static rt::FrameRequest CreateRequest()
  {
    rt::FrameRequest request;
    request.Width = 48;
    request.Height = 40;
    request.WorldToClip = glm::perspective(0.6, 1.2, 1.0, 20.0) *
      glm::lookAt(glm::dvec3(2.1, 1.7, 3.5), glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0));
    return request;
  }

  static rt::Picture Trace(const Build& build, int ranks, dsm::MemoryOrganization organization)
  {
    rt::Picture picture;
    RunOnCluster(ranks,
      [&](dsm::Messenger& messenger)
      {
        dsm::BlockStore store(
          messenger, SphereScene::CreateSettings(std::size_t(1) << 22, 1, organization));
        rt::Scene scene;
        build([&](const Quadratic& function) { return Kind::Publish(function, messenger, store); },
          scene);
        rt::FrameRenderer renderer(messenger);
        rt::FrameRequest request = CreateRequest();
        request.KeepsHits = true;
        if (scene.Media.empty())
        {
          // The picture is made of the hits of another one.
          rt::Scene unlit = scene;
          unlit.Lights.clear();
          unlit.Transport = {};
          renderer.Render(store, unlit, request);
        }
        rt::Picture whole = rt::GatherFrame(messenger, renderer.Render(store, scene, request));
        if (messenger.GetRank() == 0)
        {
          picture = std::move(whole);
        }
      });
    return picture;
  }
};

using Kinds = testing::Types<FieldKinds::Functions, FieldKinds::Lattices, FieldKinds::Levels,
  FieldKinds::Cells<false>, FieldKinds::Cells<true>>;
TYPED_TEST_SUITE(FieldTest, Kinds);

/// Returns whether the ball is between a place of the floor and the light.
bool IsInShadow(const glm::dvec3& place)
{
  rt::Ray toLight;
  toLight.Origin = place;
  toLight.Direction = -GetLight().Direction;
  toLight.Max = 100.0;
  return !FindRoots(Ball, BallValue, toLight).empty();
}

} // namespace

TYPED_TEST(FieldTest, SurfacesHaveColorsLightAndShadow)
{
  this->Check(
    [](const auto& publish, rt::Scene& scene)
    {
      const auto values = publish(Ball);
      auto ball = TestFixture::CreateBall(values);
      ball.ColorValues = publish(Slope);
      ball.Look.Colors = CreateColors();
      scene.Objects = { GetObject(ball), GetObject(TestFixture::CreateFloor(values)) };
      scene.Lights = { GetLight() };
      scene.Transport.Shadows = true;
    },
    [](const rt::Ray& ray) -> Expected
    {
      const glm::dvec3 toLight = -GetLight().Direction;
      const std::optional<double> floor = FindPlane(SliceHeight, ray);
      const std::vector<double> roots = FindRoots(Ball, BallValue, ray);
      if (!roots.empty() && !(floor && *floor < roots[0]))
      {
        const glm::dvec3 place = GetPoint(ray, roots[0]);
        const double cosine = glm::dot(glm::normalize(Ball.GetGradient(place)), toLight);
        return glm::dvec4(std::max(cosine, 0.0) * GetColor(Slope.Evaluate(place)), 1.0);
      }
      return floor
        ? glm::dvec4(glm::dvec3(IsInShadow(GetPoint(ray, *floor)) ? 0.0 : toLight.z), 1.0)
        : glm::dvec4(0.0);
    },
    5.0);
}

TYPED_TEST(FieldTest, TranslucentSurfacesDimLight)
{
  const glm::dvec3 color(1.0, 0.5, 0.0);
  this->Check(
    [&](const auto& publish, rt::Scene& scene)
    {
      const auto values = publish(Ball);
      auto ball = TestFixture::CreateBall(values);
      ball.Look.Surface.Opacity = 0.5f;
      ball.Look.Surface.DiffuseColor = color;
      scene.Objects = { GetObject(ball), GetObject(TestFixture::CreateFloor(values)) };
      scene.Lights = { GetLight() };
      scene.Transport.Shadows = true;
    },
    [&](const rt::Ray& ray) -> Expected
    {
      // Half of the light passes each side straight, and half of what is scattered in the surface's color.
      const glm::dvec3 passed = 0.5 * (1.0 + 0.5 * color);
      const glm::dvec3 toLight = -GetLight().Direction;
      const std::vector<double> roots = FindRoots(Ball, BallValue, ray);
      const std::optional<double> floor = FindPlane(SliceHeight, ray);
      glm::dvec4 seen(0.0);
      if (floor)
      {
        const bool isDimmed = IsInShadow(GetPoint(ray, *floor));
        seen = glm::dvec4(toLight.z * (isDimmed ? passed * passed : glm::dvec3(1.0)), 1.0);
      }
      for (std::size_t side = roots.size(); side-- > 0;)
      {
        // The inner side is lit through the ball.
        const double facing = side == 0 ? 1.0 : -1.0;
        const glm::dvec3 normal = glm::normalize(Ball.GetGradient(GetPoint(ray, roots[side])));
        const double cosine = std::max(0.0, facing * glm::dot(normal, toLight));
        const glm::dvec3 lit = cosine * color * (side == 0 ? glm::dvec3(1.0) : passed);
        seen = 0.5 * (seen + glm::dvec4(lit, 1.0));
      }
      return seen;
    },
    // Surfaces behind others borrow their light (KnownLight).
    8.0, 3.0);
}

TYPED_TEST(FieldTest, MediaEmitAndAbsorb)
{
  // Above this height.
  constexpr double clipped = -0.5;
  const glm::dvec3 color(0.9, 0.6, 0.3);
  this->Check(
    [&](const auto& publish, rt::Scene& scene)
    {
      auto medium = TestFixture::CreateMedium(
        publish(Hill), [&](double value) { return glm::dvec4(color, 1.5 * value); });
      medium.Clipping.HalfSpaces = { { { 0.0, 0.0, 1.0 }, { 0.0, 0.0, clipped } } };
      scene.Media = { GetMedium(medium) };
    },
    [&](const rt::Ray& ray) -> Expected
    {
      double first;
      double last;
      if (!Quadratic::FindWay(ray, first, last))
      {
        return glm::dvec4(0.0);
      }
      last = std::min(last, (clipped - ray.Origin.z) / ray.Direction.z);
      const double depth = first < last ? 1.5 * Integrate(Hill, ray, first, last) : 0.0;
      return (1.0 - std::exp(-depth)) * glm::dvec4(color, 1.0);
    },
    2.0);
}

TYPED_TEST(FieldTest, MediaAreShadedAcrossTheGradient)
{
  const glm::dvec3 color(0.9, 0.6, 0.3);
  for (const bool thinned : { false, true })
  {
    this->Check(
      [&](const auto& publish, rt::Scene& scene)
      {
        auto medium = TestFixture::CreateMedium(
          publish(Slope), [&](double value) { return glm::dvec4(color, 2.0 * value); });
        medium.Look.Shade = true;
        medium.Look.Surface.Diffuse = 0.75f;
        if (thinned)
        {
          // All kinds have details of the same size.
          const double growth = QuadraticField::Detail * glm::length(Slope.Linear);
          medium.Look.Gradients = std::make_shared<const rt::GradientOpacity>(
            rt::GradientOpacity{ 2.0 * growth, { 0.1, 0.1, 0.1, 0.5, 0.1, 0.1, 0.1 } });
        }
        scene.Media = { GetMedium(medium) };
        scene.Lights = { GetLight() };
      },
      [&](const rt::Ray& ray) -> Expected
      {
        double first;
        double last;
        if (!Quadratic::FindWay(ray, first, last))
        {
          return glm::dvec4(0.0);
        }
        const double depth = (thinned ? 1.0 : 2.0) * Integrate(Slope, ray, first, last);
        const double cosine =
          std::abs(glm::dot(glm::normalize(Slope.Linear), GetLight().Direction));
        return (1.0 - std::exp(-depth)) * glm::dvec4(0.75 * cosine * color, 1.0);
      },
      1.0);
  }
}

TYPED_TEST(FieldTest, MediaHaveColorsOfOtherValues)
{
  constexpr double extinction = 0.8;
  this->Check(
    [](const auto& publish, rt::Scene& scene)
    {
      auto medium = TestFixture::CreateMedium(
        publish(Ball), [](double) { return glm::dvec4(1.0, 1.0, 1.0, extinction); });
      medium.ColorValues = publish(Slope);
      medium.Colors = std::make_shared<const rt::ColorMap>(CreateColors());
      scene.Media = { GetMedium(medium) };
    },
    [](const rt::Ray& ray) -> Expected
    {
      double first;
      double last;
      if (!Quadratic::FindWay(ray, first, last))
      {
        return glm::dvec4(0.0);
      }
      const double depth = extinction * (last - first) * glm::length(ray.Direction);
      const double passed = std::exp(-depth);
      const glm::dvec3 begin = GetColor(Slope.Evaluate(GetPoint(ray, first)));
      const glm::dvec3 end = GetColor(Slope.Evaluate(GetPoint(ray, last)));
      return glm::dvec4(
        begin * (1.0 - passed) + (end - begin) * ((1.0 - passed) / depth - passed), 1.0 - passed);
    },
    1.0);
}

TYPED_TEST(FieldTest, MaximumAndMinimum)
{
  for (const bool isMinimum : { false, true })
  {
    this->Check(
      [&](const auto& publish, rt::Scene& scene)
      {
        rt::ExtremumOf<typename TypeParam::FieldType> medium;
        medium.Field = TypeParam::Create(publish(Hill));
        medium.Colors = std::make_shared<const rt::ColorMap>(CreateColors());
        medium.IsMinimum = isMinimum;
        scene.Media = { GetMedium(medium) };
      },
      [&](const rt::Ray& ray) -> Expected
      {
        double first;
        double last;
        if (!Quadratic::FindWay(ray, first, last))
        {
          return glm::dvec4(0.0);
        }
        // Where the function grows no more.
        const double top = std::clamp(-glm::dot(Hill.GetGradient(ray.Origin), ray.Direction) /
            (2.0 * glm::dot(Hill.Square, ray.Direction * ray.Direction)),
          first, last);
        const double least =
          std::min(Hill.Evaluate(GetPoint(ray, first)), Hill.Evaluate(GetPoint(ray, last)));
        const double value = isMinimum ? least : Hill.Evaluate(GetPoint(ray, top));
        return glm::dvec4(GetColor(value), 1.0);
      },
      2.0);
  }
}

TYPED_TEST(FieldTest, MeanAndSum)
{
  constexpr double unit = 4.0;
  using Sums = rt::SumOf<typename TypeParam::FieldType>;
  for (const bool isMean : { false, true })
  {
    this->Check(
      [&](const auto& publish, rt::Scene& scene)
      {
        Sums medium;
        medium.Field = TypeParam::Create(publish(Hill));
        medium.Function = rt::TransferFunction::Create(
          0.0, 1.0,
          [](double value) {
            return Sums::ToLook({ value, 1.0 }, unit);
          },
          {}, 0.0, 0.0);
        medium.IsMean = isMean;
        scene.Media = { GetMedium(medium) };
      },
      [&](const rt::Ray& ray) -> Expected
      {
        double first;
        double last;
        if (!Quadratic::FindWay(ray, first, last))
        {
          return glm::dvec4(0.0);
        }
        const double length = (last - first) * glm::length(ray.Direction);
        const double sum = Integrate(Hill, ray, first, last);
        return glm::dvec4(glm::dvec3(sum / (isMean ? length : unit)), 1.0);
      },
      2.0);
  }
}

TYPED_TEST(FieldTest, Integral)
{
  constexpr double longest = 3.0;
  this->Check(
    [&](const auto& publish, rt::Scene& scene)
    {
      rt::IntegralOf<typename TypeParam::FieldType> medium;
      medium.Field = TypeParam::Create(publish(Hill));
      medium.Colors = std::make_shared<const rt::ColorMap>(CreateColors());
      medium.Longest = longest;
      scene.Media = { GetMedium(medium) };
    },
    [&](const rt::Ray& ray) -> Expected
    {
      double first;
      double last;
      return Quadratic::FindWay(ray, first, last)
        ? glm::dvec4(GetColor(Integrate(Hill, ray, first, last) / longest), 1.0)
        : glm::dvec4(0.0);
    },
    2.0);
}

TYPED_TEST(FieldTest, SlicesShowValues)
{
  const glm::dvec3 normal(0.5, 0.3, 1.0);
  this->Check(
    [&](const auto& publish, rt::Scene& scene)
    {
      rt::SliceOf<typename TypeParam::FieldType> slice;
      const auto values = publish(Hill);
      slice.Field = TypeParam::Create(values);
      slice.Planes = { { normal, glm::dvec3(0.1) } };
      slice.ColorValues = values;
      slice.Look.Colors = CreateColors();
      slice.Look.Surface.Lighting = false;
      scene.Objects = { GetObject(slice) };
    },
    [&](const rt::Ray& ray) -> Expected
    {
      const double t =
        glm::dot(normal, glm::dvec3(0.1) - ray.Origin) / glm::dot(normal, ray.Direction);
      double first;
      double last;
      const bool isThere = Quadratic::FindWay(ray, first, last) && t >= first && t <= last;
      return isThere ? glm::dvec4(GetColor(Hill.Evaluate(GetPoint(ray, t))), 1.0) : glm::dvec4(0.0);
    },
    2.0);
}

TYPED_TEST(FieldTest, CapsCloseClippedSurfaces)
{
  constexpr double height = 0.1;
  const glm::dvec3 color(0.3, 0.5, 0.7);
  this->Check(
    [&](const auto& publish, rt::Scene& scene)
    {
      const auto values = publish(Ball);
      auto ball = TestFixture::CreateBall(values);
      ball.Look.Surface.Lighting = false;
      ball.Look.Surface.DiffuseColor = color;
      ball.Clipping.HalfSpaces = { { { 0.0, 0.0, -1.0 }, { 0.0, 0.0, height } } };
      auto cap = TestFixture::CreateFloor(values);
      cap.Planes = { { { 0.0, 0.0, 1.0 }, { 0.0, 0.0, height } } };
      cap.ColorValues = values;
      cap.Look.Colors = CreateColors();
      cap.Look.Surface.Lighting = false;
      cap.Most = BallValue;
      scene.Objects = { GetObject(ball), GetObject(cap) };
    },
    [&](const rt::Ray& ray) -> Expected
    {
      const std::optional<double> cut = FindPlane(height, ray);
      const double value = cut ? Ball.Evaluate(GetPoint(ray, *cut)) : 1.0;
      if (value <= BallValue)
      {
        return glm::dvec4(GetColor(value), 1.0);
      }
      const std::vector<double> roots = FindRoots(Ball, BallValue, ray);
      const bool isMet = std::any_of(
        roots.begin(), roots.end(), [&](double root) { return GetPoint(ray, root).z <= height; });
      return isMet ? glm::dvec4(color, 1.0) : glm::dvec4(0.0);
    },
    4.0);
}
