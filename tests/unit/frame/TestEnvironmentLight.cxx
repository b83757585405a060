// SPDX-License-Identifier: BSD-3-Clause
// Light from all around against what integrals over the half space say.
#include "tests/support/FunctionVolume.h"
#include "tests/support/MeshScene.h"
#include "tests/support/PictureHash.h"

#include "DSMCore/transport/LoopbackTransport.h"
#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/frame/FrameRenderer.h"

#include <gtest/gtest.h>

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <mutex>
#include <variant>

namespace
{

constexpr int Size = 24;
const glm::vec3 Lower(0.1f, 0.6f, 0.0f);
const glm::vec3 Upper(0.9f, 0.2f, 0.5f);

rt::Environment CreateEnvironment(const glm::dvec3& up)
{
  rt::Environment environment;
  environment.Up = up;
  environment.Lower = Lower;
  environment.Upper = Upper;
  return environment;
}

/// Light of which the upper color has `part`.
glm::dvec3 Mix(double part)
{
  return glm::mix(glm::dvec3(Lower), glm::dvec3(Upper), part);
}

/// White surfaces, looked at along -z, in parallel, at [-1, 1]^2.
class EnvironmentLight : public testing::Test
{
protected:
  rt::Picture Trace(int samples = 1)
  {
    rt::FrameRequest request;
    request.Width = Size;
    request.Height = Size;
    request.Samples = samples;
    request.WorldToClip = glm::ortho(-1.0, 1.0, -1.0, 1.0, 0.0, 10.0) *
      glm::lookAt(glm::dvec3(0.0, 0.0, 5.0), glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0));
    rt::FrameRenderer renderer(this->Messenger);
    return rt::GatherFrame(this->Messenger, renderer.Render(this->Store, this->World, request));
  }

  /// A floor that is 100 wide at z = 0, and a wall on it along the y axis that looks to positive x.
  void AddFloorAndWall()
  {
    TestMesh::Mesh mesh;
    mesh.Positions = { -50, -50, 0, 50, -50, 0, 50, 50, 0, -50, 50, 0, 0, -50, 50, 0, 50, 50, 0,
      -50, 0, 0, 50, 0 };
    mesh.Triangles = { 0, 1, 2, 0, 2, 3, 6, 7, 5, 6, 5, 4 };
    rt::MeshObject object;
    object.Instance = std::make_shared<rt::MeshInstance>(
      MeshScene::Publish(mesh, this->Messenger, this->Store), glm::dmat4(1.0));
    this->World.Objects.push_back(object);
  }

  static glm::dvec2 GetPlace(int x, int y)
  {
    return { (x + 0.5) * 2.0 / Size - 1.0, (y + 0.5) * 2.0 / Size - 1.0 };
  }

  static void ExpectColor(
    const rt::Picture& picture, int x, int y, const glm::dvec3& color, double tolerance)
  {
    for (int channel = 0; channel < 3; ++channel)
    {
      EXPECT_NEAR(picture.Color[4 * (static_cast<std::size_t>(y) * Size + x) + channel],
        255.0 * color[channel], tolerance)
        << x << ", " << y << ", " << channel;
    }
  }

  dsm::Messenger Messenger{ std::move(dsm::LoopbackTransport::CreateGroup(1).front()) };
  dsm::BlockStore Store{ Messenger, dsm::BlockStore::Settings{} };
  rt::Scene World;
};

} // namespace

TEST_F(EnvironmentLight, OfAWhiteSphereIsThatOfItsNormals)
{
  constexpr double radius = 0.7;
  this->World.Objects = { FunctionVolume::Publish(
    65, [](const glm::dvec3& p) { return glm::length(p) - radius; }, this->Messenger,
    this->Store) };
  const glm::dvec3 up = glm::normalize(glm::dvec3(0.3, 1.0, 0.2));
  this->World.Transport.Surroundings = CreateEnvironment(up);
  const rt::Picture picture = this->Trace();
  int compared = 0;
  for (int y = 0; y < Size; ++y)
  {
    for (int x = 0; x < Size; ++x)
    {
      const glm::dvec2 place = GetPlace(x, y) / radius;
      const double square = glm::dot(place, place);
      if (square < 0.95)
      {
        const glm::dvec3 normal(place, std::sqrt(1.0 - square));
        ExpectColor(picture, x, y, Mix(0.5 + glm::dot(normal, up) / 3.0), 1.5);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 150);
}

TEST_F(EnvironmentLight, IsAddedToThatOfLampsAndUntouchedWhereSurfacesAreNotLit)
{
  this->AddFloorAndWall();
  rt::Material& surface = std::get<rt::MeshObject>(this->World.Objects.front()).Look.Surface;
  surface.Diffuse = 0.4f;
  this->World.Transport.Surroundings = CreateEnvironment({ 0.0, 0.0, 1.0 });
  const glm::dvec3 alone = 0.4 * Mix(0.5 + 1.0 / 3.0);
  ExpectColor(this->Trace(), 20, 10, alone, 0.6);
  this->World.Lights.resize(1); // straight down
  this->World.Lights[0].Color = { 0.5f, 0.25f, 0.0f };
  ExpectColor(this->Trace(), 20, 10, alone + 0.4 * glm::dvec3(0.5, 0.25, 0.0), 0.6);
  surface.Lighting = false;
  ExpectColor(this->Trace(), 20, 10, glm::dvec3(0.4), 0.6);
  surface.Lighting = true;
  this->World.Transport.Surroundings = {};
  ExpectColor(this->Trace(), 20, 10, 0.4 * glm::dvec3(0.5, 0.25, 0.0), 0.6);
}

TEST_F(EnvironmentLight, AWallKeepsHalfOfItAway)
{
  this->AddFloorAndWall();
  this->World.Transport.AmbientOcclusionSamples = 16;
  this->World.Transport.AmbientOcclusionDistance = 1000.0;
  constexpr int samples = 64;
  const int atWall = Size / 2; // a thousandth of its height away
  // Half of the directions are left, of the same heights.
  this->World.Transport.Surroundings = CreateEnvironment({ 0.0, 0.0, 1.0 });
  ExpectColor(this->Trace(samples), atWall, 10, 0.5 * Mix(0.5 + 1.0 / 3.0), 2.0);
  // The half that is left looks away from the wall: its mean of x, by the cosine, is 4 / (3 pi).
  this->World.Transport.Surroundings = CreateEnvironment({ 1.0, 0.0, 0.0 });
  ExpectColor(
    this->Trace(samples), atWall, 10, 0.5 * Mix(0.5 + 0.5 * 4.0 / (3.0 * glm::pi<double>())), 2.0);
}

TEST_F(EnvironmentLight, RaysFindWhatTheIntegralSaysWhereNothingIsNear)
{
  this->AddFloorAndWall();
  const glm::dvec3 up = glm::normalize(glm::dvec3(0.4, -0.7, 0.5));
  this->World.Transport.Surroundings = CreateEnvironment(up);
  this->World.Transport.AmbientOcclusionSamples = 16;
  this->World.Transport.AmbientOcclusionDistance = 0.01;
  ExpectColor(this->Trace(64), 22, 10, Mix(0.5 + up.z / 3.0), 1.0);
}

TEST(EnvironmentLightOnRanks, TheSamePictureOnAnyNumberOfRanks)
{
  std::uint64_t expected = 0;
  for (const int ranks : { 1, 2, 3, 4 })
  {
    for (const auto organization :
      { dsm::MemoryOrganization::ObjectBased, dsm::MemoryOrganization::PageBased })
    {
      std::mutex guard;
      RunOnCluster(ranks,
        [&](dsm::Messenger& messenger)
        {
          dsm::BlockStore store(
            messenger, SphereScene::CreateSettings(std::size_t(16) << 20, 2, organization));
          rt::Scene scene = MeshScene::Create(messenger, store);
          scene.Transport.AmbientOcclusionSamples = 1;
          scene.Transport.AmbientOcclusionDistance = 10.0;
          scene.Transport.Surroundings = CreateEnvironment({ 0.0, 1.0, 0.0 });
          rt::FrameRenderer renderer(messenger);
          const std::uint64_t hash = GetPictureHash(rt::GatherFrame(
            messenger, renderer.Render(store, scene, SphereScene::CreateRequest(48, 36))));
          const std::lock_guard<std::mutex> lock(guard);
          expected = expected == 0 ? hash : expected;
          EXPECT_EQ(hash, expected) << ranks << " ranks, rank " << messenger.GetRank();
        });
    }
  }
}
