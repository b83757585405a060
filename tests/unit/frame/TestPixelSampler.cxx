// SPDX-License-Identifier: BSD-3-Clause
// Shadows, occlusion, transparency and mirrors against what analysis says of spheres and planes.
#include "tests/support/FunctionVolume.h"
#include "tests/support/MeshScene.h"
#include "tests/support/PictureHash.h"

#include "DSMCore/transport/LoopbackTransport.h"
#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/frame/FrameRenderer.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <variant>

namespace
{

constexpr int PictureSize = 96;
/// The camera looks down the z axis, in parallel, at [-1, 1]^2.
const glm::dmat4 Parallel = glm::ortho(-1.0, 1.0, -1.0, 1.0, 0.0, 10.0) *
  glm::lookAt(glm::dvec3(0.0, 0.0, 5.0), glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0));

constexpr double BallRadius = 0.25;
const glm::dvec3 BallCenter(0.1, -0.05, 0.3);
constexpr double FloorHeight = -0.6;

double GetBall(const glm::dvec3& p)
{
  return glm::distance(p, BallCenter) - BallRadius;
}

double GetBallAboveFloor(const glm::dvec3& p)
{
  return std::min(GetBall(p), p.z - FloorHeight);
}

class LightTransportTest : public testing::Test
{
protected:
  rt::LatticeIsosurface Publish(const FunctionVolume::Function& function, int points = 65)
  {
    return FunctionVolume::Publish(points, function, this->Messenger, this->Store);
  }

  rt::Picture Trace(const rt::Scene& scene, int samples = 1, rt::ChannelSet channels = {})
  {
    rt::FrameRequest request;
    request.Channels = channels;
    request.Width = PictureSize;
    request.Height = PictureSize;
    request.WorldToClip = Parallel;
    request.Samples = samples;
    rt::FrameRenderer renderer(this->Messenger);
    return rt::GatherFrame(this->Messenger, renderer.Render(this->Store, scene, request));
  }

  static glm::dvec2 GetPlace(int x, int y)
  {
    return { (x + 0.5) * 2.0 / PictureSize - 1.0, (y + 0.5) * 2.0 / PictureSize - 1.0 };
  }

  static int GetRed(const rt::Picture& picture, int x, int y)
  {
    return picture.Color[4 * (static_cast<std::size_t>(y) * PictureSize + x)];
  }

  dsm::Messenger Messenger{ std::move(dsm::LoopbackTransport::CreateGroup(1).front()) };
  dsm::BlockStore Store{ Messenger, dsm::BlockStore::Settings{} };
};

rt::Light GetSlantedLight()
{
  rt::Light light;
  light.Direction = glm::normalize(glm::dvec3(0.4, 0.3, -1.0));
  return light;
}

} // namespace

TEST_F(LightTransportTest, WithoutShadowsTheFloorIsLitAllOver)
{
  rt::Scene scene;
  scene.Objects = { this->Publish(GetBallAboveFloor) };
  scene.Lights = { GetSlantedLight() };
  const rt::Picture picture = this->Trace(scene);
  const int expected = static_cast<int>(std::lround(255.0 * -scene.Lights.front().Direction.z));
  EXPECT_NEAR(GetRed(picture, 5, 5), expected, 1);
  EXPECT_NEAR(GetRed(picture, PictureSize - 5, 40), expected, 1);
}

TEST_F(LightTransportTest, SoftShadowHasAPenumbraAroundTheHardOne)
{
  rt::Scene scene;
  scene.Objects = { this->Publish(GetBallAboveFloor) };
  rt::Light above;
  scene.Lights = { above }; // straight down, so the camera sees only the rim of the shadow
  scene.Transport.Shadows = true;
  scene.Transport.LightRadius = 0.3;
  const rt::Picture picture = this->Trace(scene, 64);
  // A light of tangent 0.3 and a ball 0.9 above the floor: half of the light at the hard rim, all
  // of it beyond the rim by 0.3 * 0.9.
  const double fullyLit = BallRadius + 0.3 * 0.9 * 1.2;
  for (int x = 0; x < PictureSize; ++x)
  {
    const int y = PictureSize / 2;
    const double distance = glm::distance(GetPlace(x, y), glm::dvec2(BallCenter));
    if (distance > fullyLit)
    {
      EXPECT_EQ(GetRed(picture, x, y), 255) << distance;
    }
    else if (distance > BallRadius + 0.03 && distance < BallRadius + 0.1)
    {
      EXPECT_GT(GetRed(picture, x, y), 60) << distance;
      EXPECT_LT(GetRed(picture, x, y), 245) << distance;
    }
  }
}

TEST_F(LightTransportTest, OcclusionOfACornerIsThatOfBruteForce)
{
  // A floor, and a wall on it that ends where the volume ends.
  rt::Scene scene;
  scene.Objects = { this->Publish(
    [](const glm::dvec3& p) { return std::min(p.z - FloorHeight, p.x + 0.5); }) };
  scene.Lights = { rt::Light() };
  scene.Transport.AmbientOcclusionSamples = 4;
  scene.Transport.AmbientOcclusionDistance = 100.0;
  const rt::Picture picture = this->Trace(scene, 64);
  const auto getVisible = [](const glm::dvec2& place)
  {
    constexpr int Steps = 128;
    int visible = 0;
    for (int step = 0; step < Steps * Steps; ++step)
    {
      const double square = (step % Steps + 0.5) / Steps;
      const double angle = glm::two_pi<double>() * (step / Steps + 0.5) / Steps;
      const glm::dvec3 way(std::sqrt(square) * std::cos(angle), std::sqrt(square) * std::sin(angle),
        std::sqrt(1.0 - square));
      const double t = (-0.5 - place.x) / way.x;
      visible +=
        !(t > 0.0 && std::fabs(place.y + t * way.y) < 1.0 && FloorHeight + t * way.z < 1.0);
    }
    return static_cast<double>(visible) / (Steps * Steps);
  };
  for (const int x : { PictureSize / 4 + 3, PictureSize / 2, 3 * PictureSize / 4, PictureSize - 8 })
  {
    double traced = 0.0;
    double expected = 0.0;
    for (int y = 0; y < PictureSize; ++y)
    {
      traced += GetRed(picture, x, y) / 255.0;
      expected += getVisible(GetPlace(x, y));
    }
    EXPECT_NEAR(traced / PictureSize, expected / PictureSize, 0.01) << x;
  }
}

TEST_F(LightTransportTest, OcclusionEndsAtItsDistance)
{
  rt::Scene scene;
  scene.Objects = { this->Publish(
    [](const glm::dvec3& p) { return std::min(p.z - FloorHeight, p.x + 0.5); }) };
  scene.Lights = { rt::Light() };
  scene.Transport.AmbientOcclusionSamples = 8;
  scene.Transport.AmbientOcclusionDistance = 0.2;
  const rt::Picture picture = this->Trace(scene, 8);
  EXPECT_EQ(GetRed(picture, 3 * PictureSize / 4, PictureSize / 2), 255);
  EXPECT_LT(GetRed(picture, PictureSize / 4 + 2, PictureSize / 2), 230);
}

TEST_F(LightTransportTest, NestOfTranslucentSpheres)
{
  const auto distance = [](const glm::dvec3& p) { return glm::length(p); };
  rt::Scene scene;
  scene.Objects = { this->Publish(distance) };
  auto& nest = std::get<rt::LatticeIsosurface>(scene.Objects.front());
  nest.Isovalues = { 0.2, 0.5, 0.8 };
  nest.Look.Opacities = { 1.0f, 0.5f, 0.25f };
  nest.Look.Surface.Lighting = false;
  const rt::Picture picture = this->Trace(scene);
  const auto getAlpha = [&](double radius)
  {
    const int x = static_cast<int>((radius + 1.0) * PictureSize / 2.0);
    return picture.Color[4 * (static_cast<std::size_t>(PictureSize / 2) * PictureSize + x) + 3] /
      255.0;
  };
  EXPECT_NEAR(getAlpha(0.9), 0.0, 0.005);
  EXPECT_NEAR(getAlpha(0.65), 1.0 - 0.75 * 0.75, 0.005);
  EXPECT_NEAR(getAlpha(0.35), 1.0 - 0.75 * 0.5 * 0.5 * 0.75, 0.005);
  EXPECT_NEAR(getAlpha(0.0), 1.0, 0.005);
}

TEST_F(LightTransportTest, ChannelsOnRequestDescribeTheFirstSurface)
{
  // The mesh is asked for hits last, though it is the first object.
  rt::Scene scene;
  rt::MeshObject floor;
  TestMesh::Mesh square;
  square.Positions = { -1, -1, -0.9, 0.51, -1, -0.9, 0.51, 1, -0.9, -1, 1, -0.9 };
  square.Triangles = { 0, 1, 2, 0, 2, 3 };
  floor.Instance = std::make_shared<rt::MeshInstance>(
    MeshScene::Publish(square, this->Messenger, this->Store), glm::dmat4(1.0));
  floor.Look.Surface.DiffuseColor = { 0.0f, 0.0f, 1.0f };
  rt::LatticeIsosurface glass = this->Publish(GetBall);
  glass.Look.Surface.Opacity = 0.5f;
  glass.Look.Surface.DiffuseColor = { 1.0f, 0.0f, 0.0f };
  scene.Objects = { floor, glass };
  scene.Lights = { GetSlantedLight() };
  rt::ChannelSet channels;
  channels.Value = rt::ChannelSet::All;
  const rt::Picture picture = this->Trace(scene, 1, channels);
  const rt::Picture averaged = this->Trace(scene, 16, channels);
  EXPECT_EQ(averaged.Object, picture.Object);
  int objects[2] = {};
  int between = 0;
  for (int y = 0; y < PictureSize; ++y)
  {
    for (int x = 0; x < PictureSize; ++x)
    {
      const std::size_t pixel = static_cast<std::size_t>(y) * PictureSize + x;
      const glm::vec3 normal = glm::make_vec3(&picture.Normal[3 * pixel]);
      const std::int32_t object = picture.Object[pixel];
      EXPECT_EQ(object < 0, picture.Depth[pixel] == 1.0f);
      EXPECT_EQ(picture.Albedo[4 * pixel + 3], picture.Color[4 * pixel + 3]);
      between += averaged.Albedo[4 * pixel + 3] % 255 % 191 != 0;
      const glm::dvec2 fromBall = GetPlace(x, y) - glm::dvec2(BallCenter);
      const double radius = glm::length(fromBall) / BallRadius;
      if (std::abs(radius - 1.0) < 0.1)
      {
        continue; // a sampled ball has another rim
      }
      const bool isFloor = GetPlace(x, y).x < 0.51;
      ASSERT_EQ(object, radius < 1.0 ? 1 : isFloor ? 0 : -1) << x << ", " << y;
      if (object < 0)
      {
        EXPECT_EQ(normal, glm::vec3(0.0f));
        continue;
      }
      ++objects[object];
      // Sheets of one half: the front of the ball, its back, and what they leave of the floor.
      const glm::ivec4 ball = isFloor ? glm::ivec4(191, 0, 64, 255) : glm::ivec4(191, 0, 0, 191);
      EXPECT_EQ(glm::ivec4(glm::make_vec4(&picture.Albedo[4 * pixel])),
        object == 0 ? glm::ivec4(0, 0, 255, 255) : ball);
      const glm::dvec3 expected = object == 0
        ? glm::dvec3(0.0, 0.0, 1.0)
        : glm::dvec3(fromBall / BallRadius, std::sqrt(1.0 - radius * radius));
      for (const glm::vec3& each : { normal, glm::make_vec3(&averaged.Normal[3 * pixel]) })
      {
        EXPECT_NEAR(glm::length(each), 1.0f, 1e-6f);
        EXPECT_GT(glm::dot(glm::dvec3(each), expected), std::cos(glm::radians(3.0)));
      }
    }
  }
  EXPECT_GT(objects[0], PictureSize * PictureSize / 2);
  EXPECT_GT(objects[1], PictureSize * PictureSize / 30);
  EXPECT_GT(between, PictureSize / 2);
}

TEST_F(LightTransportTest, MirrorShowsTheBackground)
{
  rt::Scene scene;
  scene.Objects = { this->Publish([](const glm::dvec3& p) { return p.z; }) };
  std::get<rt::LatticeIsosurface>(scene.Objects.front()).Look.Surface.Reflectivity = 0.75f;
  std::get<rt::LatticeIsosurface>(scene.Objects.front()).Look.Surface.Lighting = false;
  std::get<rt::LatticeIsosurface>(scene.Objects.front()).Look.Surface.DiffuseColor =
    glm::vec3(0.0f);
  scene.Transport.Background = { 0.2f, 0.4f, 0.8f };
  const rt::Picture picture = this->Trace(scene);
  EXPECT_NEAR(GetRed(picture, 40, 50), 255.0 * 0.75 * 0.2, 1.0);
  scene.Transport.MaxBounces = 0;
  EXPECT_EQ(GetRed(this->Trace(scene), 40, 50), 0);
}

TEST_F(LightTransportTest, MirrorsNeverBrightenAWhiteScene)
{
  rt::Scene scene;
  scene.Objects = { this->Publish(GetBallAboveFloor) };
  std::get<rt::LatticeIsosurface>(scene.Objects.front()).Look.Surface.Reflectivity = 0.5f;
  std::get<rt::LatticeIsosurface>(scene.Objects.front()).Look.Surface.Lighting = false;
  scene.Transport.Background = glm::vec3(1.0f);
  scene.Transport.MaxBounces = 8;
  for (const std::uint8_t channel : this->Trace(scene).Color)
  {
    ASSERT_EQ(channel, 255);
  }
}
