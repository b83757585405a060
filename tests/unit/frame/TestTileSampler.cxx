// SPDX-License-Identifier: BSD-3-Clause
// A tile's pixels, traced in packets, against the same pixels traced alone.
#include "tests/support/FunctionVolume.h"
#include "tests/support/MeshScene.h"

#include "DSMCore/transport/LoopbackTransport.h"
#include "DSMRayTracing/frame/TileGrid.h"
#include "DSMRayTracing/frame/TileSampler.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <utility>
#include <variant>
#include <vector>

namespace
{

double GetWaves(const glm::dvec3& p)
{
  return std::sin(7.0 * p.x) + std::sin(6.0 * p.y + p.x) + std::sin(8.0 * p.z) - 0.4;
}

struct PixelDifference
{
  int Covered = 0;
  int Pixels = 0; ///< that differ
};

class TestTileSampler : public testing::Test
{
protected:
  PixelDifference Compare(const glm::dmat4& worldToClip, int width, int height, int tileSize,
    const rt::ClipRegion& clipping = rt::ClipRegion())
  {
    rt::Scene scene;
    scene.Objects = { FunctionVolume::Publish(65, GetWaves, this->Messenger, this->Store),
      FunctionVolume::Publish(
        50, [](const glm::dvec3& p) { return glm::length(p) - 0.8; }, this->Messenger,
        this->Store) };
    std::get<rt::LatticeIsosurface>(scene.Objects[0]).Clipping = clipping;
    std::get<rt::LatticeIsosurface>(scene.Objects[1]).Look.Surface.Opacity = 0.4f;
    return this->Compare(scene, worldToClip, width, height, tileSize);
  }

  PixelDifference Compare(
    rt::Scene scene, const glm::dmat4& worldToClip, int width, int height, int tileSize)
  {
    scene.Lights.emplace_back();
    rt::FrameRequest request;
    request.Width = width;
    request.Height = height;
    request.TileSize = tileSize;
    request.Samples = 2;
    request.Channels.Value = rt::ChannelSet::All;
    request.WorldToClip = worldToClip;
    return this->Store.Visit([&](auto& store) { return CompareTiles(store, scene, request); });
  }

  rt::MeshObject Publish(const TestMesh::Mesh& mesh, float opacity)
  {
    rt::MeshObject object;
    object.Instance = std::make_shared<rt::MeshInstance>(
      MeshScene::Publish(mesh, this->Messenger, this->Store), glm::dmat4(1.0));
    object.Look.Surface.Opacity = opacity;
    return object;
  }

  /// The tiles of a picture that gets its samples in steps.
  std::vector<rt::Tile> Trace(
    const rt::Scene& scene, rt::FrameRequest request, const std::vector<int>& steps)
  {
    return this->Store.Visit(
      [&](auto& store)
      {
        auto& worker = store.GetWorker(0);
        const rt::PixelRays rays(request);
        const rt::SceneTracers tracers = rt::CreateSceneTracers(store, worker, scene);
        const rt::TileGrid grid(request.Width, request.Height, request.TileSize);
        std::vector<rt::Tile> tiles;
        store.BeginFrame();
        store.Enter(worker);
        for (int number = 0; number < grid.GetCount(); ++number)
        {
          rt::Tile tile = grid.CreateTile(number);
          request.FirstSample = 0;
          for (const int samples : steps)
          {
            request.Samples = samples;
            const rt::TileSampler sampler(tracers, scene, rays, request);
            sampler.Trace(tile);
            sampler.Finish(tile, glm::vec3(1.0f));
            request.FirstSample += samples;
          }
          tiles.push_back(std::move(tile));
        }
        store.Leave(worker);
        store.EndFrame();
        return tiles;
      });
  }

  dsm::Messenger Messenger{ std::move(dsm::LoopbackTransport::CreateGroup(1).front()) };
  dsm::BlockStore Store{ Messenger, dsm::BlockStore::Settings{} };

private:
  /// A pixel by itself: a batch of one, without a beam.
  static rt::PixelSample SampleAlone(const rt::PixelSampler& sampler, int x, int y, int sample)
  {
    rt::PixelSampler::Samples samples;
    sampler.Sample(nullptr, x, y, 1, 1, sample, {}, samples);
    return samples.GetCount() > 0 ? samples[0] : rt::PixelSample();
  }

  template <class Store>
  static PixelDifference CompareTiles(
    Store& store, const rt::Scene& scene, const rt::FrameRequest& request)
  {
    auto& worker = store.GetWorker(0);
    const rt::PixelRays rays(request);
    const rt::SceneTracers tracers = rt::CreateSceneTracers(store, worker, scene);
    const rt::TileSampler together(tracers, scene, rays, request);
    const rt::PixelSampler alone(tracers, scene, rays, request.Channels);
    const rt::TileGrid grid(request.Width, request.Height, request.TileSize);
    PixelDifference difference;
    store.BeginFrame();
    store.Enter(worker);
    for (int number = 0; number < grid.GetCount(); ++number)
    {
      rt::Tile tile = grid.CreateTile(number);
      together.Trace(tile);
      for (int pixel = 0; pixel < tile.Width * tile.Height; ++pixel)
      {
        const int x = tile.X + pixel % tile.Width;
        const int y = tile.Y + pixel / tile.Width;
        const rt::PixelSample first = SampleAlone(alone, x, y, 0);
        const rt::PixelSample second = SampleAlone(alone, x, y, 1);
        difference.Covered += first.Depth < 1.0f;
        difference.Pixels += tile.Sum[pixel] != first.Color + second.Color ||
          tile.Depth[pixel] != std::min(first.Depth, second.Depth) ||
          tile.AlbedoSum[pixel] != first.Albedo + second.Albedo ||
          tile.NormalSum[pixel] != first.Normal + second.Normal ||
          tile.Object[pixel] != first.Object;
      }
    }
    store.Leave(worker);
    store.EndFrame();
    return difference;
  }
};

glm::dmat4 LookAt(const glm::dvec3& eye)
{
  return glm::perspective(glm::radians(40.0), 1.0, 0.1, 10.0) *
    glm::lookAt(eye, glm::dvec3(0.0), glm::dvec3(0.1, 1.0, 0.0));
}

} // namespace

TEST_F(TestTileSampler, SlantedViewEqualsSinglePixels)
{
  const PixelDifference difference = this->Compare(LookAt({ 2.5, 1.8, 2.1 }), 64, 64, 16);
  EXPECT_GT(difference.Covered, 1000);
  EXPECT_EQ(difference.Pixels, 0);
}

/// Rays to both sides of two axes; tiles that are no multiple of a packet.
TEST_F(TestTileSampler, ViewAlongAnAxisEqualsSinglePixels)
{
  const PixelDifference difference = this->Compare(LookAt({ 0.01, 0.02, 3.6 }), 61, 47, 19);
  EXPECT_GT(difference.Covered, 500);
  EXPECT_EQ(difference.Pixels, 0);
}

TEST_F(TestTileSampler, ViewFromInsideEqualsSinglePixels)
{
  const PixelDifference difference = this->Compare(LookAt({ 0.11, 0.2, 0.31 }), 33, 35, 16);
  EXPECT_GT(difference.Covered, 300);
  EXPECT_EQ(difference.Pixels, 0);
}

/// All rays are parallel to an axis.
TEST_F(TestTileSampler, ParallelViewAlongAnAxisEqualsSinglePixels)
{
  const glm::dmat4 parallel = glm::ortho(-1.0, 1.0, -1.0, 1.0, 0.0, 10.0) *
    glm::lookAt(glm::dvec3(0.0, 0.0, 5.0), glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0));
  const PixelDifference difference = this->Compare(parallel, 40, 40, 16);
  EXPECT_GT(difference.Covered, 500);
  EXPECT_EQ(difference.Pixels, 0);
}

/// Meshes that cut through one another, one of them translucent; then with an isosurface, and one of
/// them clipped.
TEST_F(TestTileSampler, MeshesEqualSinglePixels)
{
  rt::Scene scene;
  scene.Objects = { this->Publish(TestMesh::CreateSoup(500, 5), 0.6f),
    this->Publish(TestMesh::CreateBlob(4), 1.0f) };
  const glm::dmat4 parallel = glm::ortho(-1.5, 1.5, -1.5, 1.5, 0.0, 10.0) *
    glm::lookAt(glm::dvec3(0.0, 0.0, 5.0), glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0));
  for (const bool withVolume : { false, true })
  {
    if (withVolume)
    {
      scene.Objects.emplace_back(
        FunctionVolume::Publish(65, GetWaves, this->Messenger, this->Store));
      std::get<rt::MeshObject>(scene.Objects[1]).Clipping.HalfSpaces = { { { 0.3, -1.0, 0.2 },
        { 0.0, 0.2, 0.0 } } };
    }
    for (const glm::dmat4& view : { LookAt({ 2.5, 1.8, 2.1 }), LookAt({ 0.01, 0.02, 3.6 }),
           LookAt({ 0.11, 0.2, 0.31 }), parallel })
    {
      const PixelDifference difference = this->Compare(scene, view, 61, 47, 19);
      EXPECT_GT(difference.Covered, 1000);
      EXPECT_EQ(difference.Pixels, 0);
    }
  }
}

/// Hard and soft shadows, occlusion and mirrors, of opaque surfaces, of translucent ones that tint
/// the light, of clipped ones.
TEST_F(TestTileSampler, LightRaysEqualSinglePixels)
{
  rt::Scene scene;
  scene.Objects = { FunctionVolume::Publish(65, GetWaves, this->Messenger, this->Store),
    this->Publish(TestMesh::CreateBlob(4), 1.0f) };
  auto& isosurface = std::get<rt::LatticeIsosurface>(scene.Objects[0]);
  auto& mesh = std::get<rt::MeshObject>(scene.Objects[1]);
  scene.Lights.emplace_back();
  scene.Lights.back().Direction = glm::normalize(glm::dvec3(-0.4, -1.0, -0.3));
  scene.Lights.emplace_back();
  scene.Lights.back().Kind = rt::PositionalLight{ { 1.5, 1.0, 0.2 }, { 1.0f, 0.0f, 0.0f } };
  scene.Transport.Shadows = true;
  isosurface.Look.Surface.Reflectivity = 0.3f;
  for (int variant = 0; variant < 5; ++variant)
  {
    SCOPED_TRACE(variant);
    scene.Transport.AmbientOcclusionSamples = variant == 0 ? 0 : 2;
    scene.Transport.AmbientOcclusionDistance = 0.7;
    scene.Transport.LightRadius = variant == 2 ? 0.1 : 0.0;
    isosurface.Look.Surface.Opacity = variant == 3 ? 0.5f : 1.0f;
    mesh.Look.Surface.Opacity = variant == 1 ? 0.6f : 1.0f;
    mesh.Look.Surface.DiffuseColor = { 0.9f, 0.4f, 0.2f };
    if (variant == 4)
    {
      isosurface.Clipping.HalfSpaces = { { { 0.3, -1.0, 0.2 }, { 0.0, 0.2, 0.0 } } };
      mesh.Clipping.HalfSpaces = { { { -1.0, 0.2, 0.2 }, { 0.3, 0.0, 0.0 } } };
    }
    for (const glm::dmat4& view : { LookAt({ 2.5, 1.8, 2.1 }), LookAt({ 0.01, 0.02, 3.6 }) })
    {
      const PixelDifference difference = this->Compare(scene, view, 45, 39, 16);
      EXPECT_GT(difference.Covered, 500);
      EXPECT_EQ(difference.Pixels, 0);
    }
  }
}

/// Cut by planes, and by boxes of which rays meet several: each part of a ray is searched.
TEST_F(TestTileSampler, ClippedViewEqualsSinglePixels)
{
  const PixelDifference whole = this->Compare(LookAt({ 2.5, 1.8, 2.1 }), 64, 64, 16);
  rt::ClipRegion clipping;
  clipping.HalfSpaces = { { { 0.3, -1.0, 0.2 }, { 0.0, 0.4, 0.0 } },
    { { 0.0, 0.0, -2.0 }, { 0.0, 0.0, 0.7 } } };
  const PixelDifference cut = this->Compare(LookAt({ 2.5, 1.8, 2.1 }), 64, 64, 16, clipping);
  EXPECT_GT(cut.Covered, 1000);
  EXPECT_NE(cut.Covered, whole.Covered);
  EXPECT_EQ(cut.Pixels, 0);
  rt::ClipRegion::Grid boxes;
  boxes.Lower = { -0.3, -0.2, -0.5 };
  boxes.Upper = { 0.4, 0.35, 0.1 };
  boxes.Kept = 0x5aa555a; // every other box
  clipping.Boxes = boxes;
  const PixelDifference parts = this->Compare(LookAt({ 2.5, 1.8, 2.1 }), 64, 64, 16, clipping);
  EXPECT_GT(parts.Covered, 1000);
  EXPECT_EQ(parts.Pixels, 0);
}

/// Smooth pixels get fewer samples, and no pixel differs much; the bits do not depend on the steps.
TEST_F(TestTileSampler, PixelsThatAreKnownGetNoMoreSamples)
{
  rt::Scene scene;
  scene.Objects = { FunctionVolume::Publish(
    65, [](const glm::dvec3& p) { return glm::length(p) - 0.8; }, this->Messenger, this->Store) };
  scene.Lights.emplace_back();
  scene.Lights.back().Direction = glm::normalize(glm::dvec3(-0.4, -1.0, -0.3));
  rt::FrameRequest request;
  request.Width = 244;
  request.Height = 188;
  request.TileSize = 19;
  request.Channels.Value = rt::ChannelSet::All;
  request.WorldToClip = LookAt({ 2.5, 1.8, 2.1 });
  const std::vector<rt::Tile> all = this->Trace(scene, request, { 64 });
  request.Tolerance = 0.5f / 255.0f;
  const std::vector<rt::Tile> some = this->Trace(scene, request, { 64 });
  const std::vector<rt::Tile> inSteps = this->Trace(scene, request, { 1, 1, 2, 5, 11, 12, 32 });
  int covered = 0;
  int taken = 0;
  int full = 0;
  int largest = 0;
  int unlike = 0;
  for (std::size_t tile = 0; tile < all.size(); ++tile)
  {
    EXPECT_EQ(some[tile].Counts, inSteps[tile].Counts);
    EXPECT_EQ(some[tile].Sum, inSteps[tile].Sum);
    EXPECT_EQ(some[tile].Color, inSteps[tile].Color);
    EXPECT_EQ(some[tile].Albedo, inSteps[tile].Albedo);
    EXPECT_EQ(some[tile].Object, all[tile].Object);
    for (std::size_t pixel = 0; pixel < all[tile].Sum.size(); ++pixel)
    {
      if (all[tile].Sum[pixel] == glm::vec4(0.0f))
      {
        continue;
      }
      ++covered;
      const int samples = some[tile].CountSamples(pixel);
      EXPECT_GE(samples, rt::FrameRequest::SureSamples);
      taken += samples;
      full += samples == 64;
      for (std::size_t channel = 4 * pixel; channel < 4 * pixel + 4; ++channel)
      {
        const int difference = std::abs(all[tile].Color[channel] - some[tile].Color[channel]);
        largest = std::max(largest, difference);
        unlike += difference > 1;
      }
    }
  }
  EXPECT_GT(covered, 8000);
  // Pixels at the sphere's edge get all of them.
  EXPECT_GT(full, 500);
  EXPECT_LT(taken, 64 * covered * 3 / 4);
  // The first samples may miss less than a sixteenth of a pixel.
  EXPECT_LE(largest, 255 / rt::FrameRequest::SureSamples);
  EXPECT_LE(unlike, covered / 500);
}
