// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/FunctionVolume.h"
#include "tests/support/LoopbackCluster.h"
#include "tests/support/PictureError.h"
#include "tests/support/PictureHash.h"
#include "tests/support/SphereScene.h"

#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/frame/FrameRenderer.h"
#include "DSMRayTracing/frame/LightFilter.h"
#include "DSMRayTracing/frame/LightKernel.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace
{

/// A ball above a floor with steps, in soft light: shadows, creases, edges, and colors of light that differ.
rt::Scene CreateScene(dsm::Messenger& messenger, dsm::BlockStore& store)
{
  rt::Scene scene;
  scene.Objects = { FunctionVolume::Publish(
    65,
    [](const glm::dvec3& p)
    {
      const double floor = p.z + 0.6 - (p.x > 0.3 ? 0.3 : 0.0) + 0.02 * std::sin(9.0 * p.y);
      return std::min(glm::distance(p, glm::dvec3(-0.2, 0.0, 0.1)) - 0.45, floor);
    },
    messenger, store) };
  rt::Light lamp;
  lamp.Direction = glm::normalize(glm::dvec3(0.4, 0.3, -1.0));
  rt::Light other;
  other.Direction = glm::normalize(glm::dvec3(-0.8, 0.1, -1.0));
  other.Color = { 0.3f, 0.2f, 0.4f };
  lamp.Color = { 0.7f, 0.7f, 0.5f };
  scene.Lights = { lamp, other };
  scene.Transport.Shadows = true;
  scene.Transport.LightRadius = 0.2;
  scene.Transport.AmbientOcclusionSamples = 1;
  scene.Transport.AmbientOcclusionDistance = 0.6;
  return scene;
}

rt::FrameRequest CreateRequest(int samples)
{
  rt::FrameRequest request;
  request.Width = 131;
  request.Height = 97;
  request.WorldToClip = glm::perspective(glm::radians(35.0), 131.0 / 97.0, 0.5, 20.0) *
    glm::lookAt(glm::dvec3(0.8, -2.2, 2.4), glm::dvec3(0.0), glm::dvec3(0.0, 0.0, 1.0));
  request.Samples = samples;
  request.Channels.Value |= rt::LightFilter::Channels;
  return request;
}

class LightFilterTest : public testing::Test
{
protected:
  rt::Picture Trace(int samples, bool isFiltered)
  {
    rt::FrameRenderer renderer(this->Messenger);
    const rt::FrameRequest request = CreateRequest(samples);
    const rt::Frame frame = renderer.Render(this->Store, this->World, request);
    return rt::GatherFrame(this->Messenger,
      isFiltered ? renderer.FilterLight(this->Store, request.WorldToClip, frame) : frame);
  }

  /// Pixels that a single sample shows as many do, but for the noise: not those at edges.
  std::vector<std::size_t> FindSmoothPixels()
  {
    const rt::LightTransport noisy = this->World.Transport;
    this->World.Transport = {};
    const rt::Picture one = this->Trace(1, false);
    const rt::Picture many = this->Trace(64, false);
    this->World.Transport = noisy;
    return FindAlike(one, many, 2);
  }

  dsm::Messenger Messenger{ std::move(dsm::LoopbackTransport::CreateGroup(1).front()) };
  dsm::BlockStore Store{ Messenger, dsm::BlockStore::Settings{} };
  rt::Scene World = CreateScene(Messenger, Store);
};

} // namespace

TEST_F(LightFilterTest, FewSamplesLookLikeMany)
{
  const std::vector<std::size_t> pixels = this->FindSmoothPixels();
  EXPECT_GT(pixels.size(), 6000u);
  const rt::Picture exact = this->Trace(256, false);
  const auto getError = [&](int samples, bool isFiltered)
  { return GetError(this->Trace(samples, isFiltered), exact, pixels); };
  for (const auto& [samples, part] : { std::pair(1, 0.25), std::pair(4, 0.4), std::pair(16, 0.7) })
  {
    EXPECT_LT(getError(samples, true), part * getError(samples, false)) << samples << " samples";
  }
  EXPECT_LE(getError(1, true), 1.1 * getError(16, false));
}

TEST_F(LightFilterTest, LeavesAPictureWithoutNoiseAlone)
{
  EXPECT_TRUE(rt::LightFilter::IsNoisy(this->World));
  this->World.Transport.AmbientOcclusionSamples = 0;
  EXPECT_TRUE(rt::LightFilter::IsNoisy(this->World));
  this->World.Transport.LightRadius = 0.0;
  EXPECT_FALSE(rt::LightFilter::IsNoisy(this->World)) << "hard shadows";
  for (const int samples : { 1, 4 })
  {
    const rt::Picture plain = this->Trace(samples, false);
    const rt::Picture filtered = this->Trace(samples, true);
    EXPECT_EQ(filtered.Color, plain.Color);
    EXPECT_EQ(filtered.Depth, plain.Depth);
  }
}

TEST_F(LightFilterTest, PictureDoesNotDependOnRanks)
{
  for (const int samples : { 1, 4 })
  {
    const std::uint64_t expected = GetPictureHash(this->Trace(samples, true));
    for (const int ranks : { 2, 3 })
    {
      RunOnCluster(ranks,
        [&](dsm::Messenger& messenger)
        {
          dsm::BlockStore store(messenger, SphereScene::CreateSettings(std::size_t(1) << 20, 2));
          const rt::Scene scene = CreateScene(messenger, store);
          rt::FrameRenderer renderer(messenger);
          const rt::FrameRequest request = CreateRequest(samples);
          const rt::Frame frame = renderer.Render(store, scene, request);
          const rt::Frame filtered = renderer.FilterLight(store, request.WorldToClip, frame);
          EXPECT_EQ(GetPictureHash(rt::GatherFrame(messenger, filtered)), expected)
            << ranks << " ranks, " << samples << " samples";
        });
    }
  }
}

TEST(LightKernel, AllFindTheSameBits)
{
  constexpr int width = 61;
  constexpr int height = 23;
  rt::LightPlanes made;
  made.Reset(width, 0, height);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  for (int plane = 0; plane < rt::LightPlanes::Count; ++plane)
  {
    for (int row = 0; row < height; ++row)
    {
      std::generate_n(made.GetRow(plane, row), width, [&] { return unit(random); });
    }
  }
  for (int row = 0; row < height; ++row)
  {
    std::generate_n(made.GetRow(rt::LightPlanes::Weight, row), width,
      [&] { return unit(random) < 0.8f ? 1.0f : 0.0f; });
    for (int x = 0; x < width; ++x)
    {
      const glm::vec3 normal =
        glm::normalize(glm::vec3(0.3f * unit(random), 0.3f * unit(random), 1.0f));
      for (int axis = 0; axis < 3; ++axis)
      {
        made.GetRow(rt::LightPlanes::NormalX + axis, row)[x] = normal[axis];
      }
    }
  }
  std::vector<float> expected;
  for (const rt::LightKernel& kernel : rt::LightKernel::GetAll())
  {
    rt::LightPlanes planes = made;
    for (int row = 0; row < height; ++row)
    {
      kernel.FindContrast(planes, row, row % 2 == 0);
    }
    for (int row = 0; row < height; ++row)
    {
      kernel.Smooth(planes, row, 2, 1.5f, rt::LightPlanes::Red);
    }
    std::vector<float> found;
    for (const int plane : { rt::LightPlanes::Contrast, rt::LightPlanes::OtherGreen })
    {
      for (int row = 0; row < height; ++row)
      {
        const float* const values = planes.GetRow(plane, row);
        const float* const weights = planes.GetRow(rt::LightPlanes::Weight, row);
        for (int x = 0; x < width; ++x)
        {
          found.push_back(weights[x] > 0.0f ? values[x] : 0.0f);
        }
      }
    }
    EXPECT_NE(found, std::vector<float>(found.size(), 0.0f));
    expected = expected.empty() ? found : expected;
    EXPECT_EQ(found, expected) << kernel.Name;
  }
}
