// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/InterruptedView.h"
#include "tests/support/LoopbackCluster.h"
#include "tests/support/MeshScene.h"
#include "tests/support/PictureHash.h"
#include "tests/support/SphereScene.h"

#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/frame/FrameRenderer.h"
#include "DSMRayTracing/frame/KeptHits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

namespace
{

struct Setting
{
  dsm::MemoryOrganization Organization = dsm::MemoryOrganization::Replicated;
  bool HostSharing = false;
  int Ranks = 1;
  int Workers = 1;
  std::size_t CacheBytes = std::size_t(16) << 20;
  float Opacity = 1.0f;
  int Width = 97;
  int Height = 61;
};

/// The picture as every rank has it, after three frames.
rt::Picture Trace(const Setting& setting, dsm::StoreCounters* sum = nullptr)
{
  rt::Picture first;
  std::mutex guard;
  RunOnCluster(setting.Ranks,
    [&](dsm::Messenger& messenger)
    {
      dsm::BlockStore::Settings settings =
        SphereScene::CreateSettings(setting.CacheBytes, setting.Workers, setting.Organization);
      settings.HostSharing = setting.HostSharing;
      dsm::BlockStore store(messenger, settings);
      const rt::Scene scene =
        SphereScene::CreateScene(SphereScene::Publish(messenger, store), setting.Opacity);
      rt::FrameRenderer renderer(messenger);
      rt::Picture picture;
      for (int frame = 0; frame < 3; ++frame)
      {
        const rt::Frame traced =
          renderer.Render(store, scene, SphereScene::CreateRequest(setting.Width, setting.Height));
        picture = rt::GatherFrame(messenger, traced);
        const std::lock_guard<std::mutex> lock(guard);
        if (sum && frame == 0)
        {
          sum->Workers += traced.Counters.Workers;
          sum->Evictions += traced.Counters.Evictions;
          sum->PeakCachedBytes = std::max(sum->PeakCachedBytes, traced.Counters.PeakCachedBytes);
        }
      }
      const std::lock_guard<std::mutex> lock(guard);
      if (first.Width == 0)
      {
        first = picture;
      }
      EXPECT_EQ(GetPictureHash(first), GetPictureHash(picture)) << "rank " << messenger.GetRank();
    });
  return first;
}

int CountCovered(const rt::Picture& picture)
{
  return static_cast<int>(std::count_if(
    picture.Depth.begin(), picture.Depth.end(), [](float depth) { return depth < 1.0f; }));
}

} // namespace

/// How bricks are kept, and whether ranks of a host read one another's in place.
struct Keeping
{
  dsm::MemoryOrganization Organization;
  bool HostSharing;
};

class FrameInOrganization : public testing::TestWithParam<Keeping>
{
protected:
  static Setting Create()
  {
    Setting setting;
    setting.Organization = GetParam().Organization;
    setting.HostSharing = GetParam().HostSharing;
    return setting;
  }
};

INSTANTIATE_TEST_SUITE_P(Organizations, FrameInOrganization,
  testing::Values(Keeping{ dsm::MemoryOrganization::Automatic, true },
    Keeping{ dsm::MemoryOrganization::Replicated, false },
    Keeping{ dsm::MemoryOrganization::Replicated, true },
    Keeping{ dsm::MemoryOrganization::ObjectBased, false },
    Keeping{ dsm::MemoryOrganization::ObjectBased, true },
    Keeping{ dsm::MemoryOrganization::PageBased, false }),
  [](const auto& info)
  {
    std::string name = dsm::GetText(info.param.Organization);
    name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
    return name + (info.param.HostSharing ? "_shared" : "");
  });

TEST_P(FrameInOrganization, PictureDoesNotDependOnRanksOrWorkers)
{
  const rt::Picture expected = Trace({});
  EXPECT_GT(CountCovered(expected), 97 * 61 / 10);
  EXPECT_LT(CountCovered(expected), 97 * 61 * 9 / 10);
  for (const int ranks : { 1, 2, 3, 4 })
  {
    for (const int workers : { 1, 2, 3 })
    {
      Setting setting = this->Create();
      setting.Ranks = ranks;
      setting.Workers = workers;
      const rt::Picture picture = Trace(setting);
      EXPECT_EQ(picture.Color, expected.Color) << ranks << " ranks, " << workers << " workers";
      EXPECT_EQ(picture.Depth, expected.Depth) << ranks << " ranks, " << workers << " workers";
    }
  }
}

TEST_P(FrameInOrganization, CacheHoldsOneBrick)
{
  const bricks::BrickLattice lattice(bricks::Index3(SphereScene::Points),
    bricks::ScalarType::Float32, false, SphereScene::BrickEdge);
  const std::size_t page = 4096; // a brick takes whole ones, where it is paged
  const std::size_t oneBrick = (lattice.CreateDirectory(1).GetLargest() + page - 1) / page * page;
  const std::uint64_t expected = GetPictureHash(Trace({}));
  const bool fetches = GetParam().Organization == dsm::MemoryOrganization::PageBased ||
    (GetParam().Organization == dsm::MemoryOrganization::ObjectBased && !GetParam().HostSharing);
  for (const int ranks : { 2, 3 })
  {
    Setting setting = this->Create();
    setting.Ranks = ranks;
    setting.Workers = 3;
    setting.CacheBytes = oneBrick;
    dsm::StoreCounters sum;
    EXPECT_EQ(GetPictureHash(Trace(setting, &sum)), expected) << ranks << " ranks";
    EXPECT_EQ(sum.Evictions > 0, fetches);
    EXPECT_EQ(sum.Workers.Misses > 0, fetches);
    EXPECT_LE(sum.PeakCachedBytes, setting.CacheBytes);
    EXPECT_GT(sum.Workers.Accesses, 0u);
    if (GetParam().Organization != dsm::MemoryOrganization::PageBased)
    {
      EXPECT_EQ(sum.Workers.Accesses, sum.Workers.Hits + sum.Workers.Misses);
    }
  }
}

TEST_P(FrameInOrganization, CameraThatCannotBeInvertedIsRefusedAndTheNextFrameWorks)
{
  RunOnCluster(2,
    [](dsm::Messenger& messenger)
    {
      dsm::BlockStore::Settings settings =
        SphereScene::CreateSettings(std::size_t(16) << 20, 1, GetParam().Organization);
      settings.HostSharing = GetParam().HostSharing;
      dsm::BlockStore store(messenger, settings);
      const rt::Scene scene =
        SphereScene::CreateScene(SphereScene::Publish(messenger, store), 1.0f);
      rt::FrameRenderer renderer(messenger);
      rt::FrameRequest flat = SphereScene::CreateRequest(32, 32);
      flat.WorldToClip = glm::dmat4(0.0);
      EXPECT_THROW(renderer.Render(store, scene, flat), dsm::Error);
      const rt::Frame frame = renderer.Render(store, scene, SphereScene::CreateRequest(32, 32));
      EXPECT_GT(CountCovered(rt::GatherFrame(messenger, frame)), 0);
    });
}

TEST(FrameRenderer, TranslucentSurfaces)
{
  Setting setting;
  setting.Opacity = 0.4f;
  const rt::Picture alone = Trace(setting);
  // Front and back of two nested surfaces: 1 - 0.6^4 where a ray meets all four.
  const int most = *std::max_element(alone.Color.begin(), alone.Color.end());
  EXPECT_GE(most, 200);
  std::uint8_t largestAlpha = 0;
  for (std::size_t at = 3; at < alone.Color.size(); at += 4)
  {
    largestAlpha = std::max(largestAlpha, alone.Color[at]);
  }
  EXPECT_GE(largestAlpha, std::lround(255.0 * (1.0 - std::pow(0.6, 4))));
  setting.Ranks = 3;
  setting.Workers = 2;
  setting.Organization = dsm::MemoryOrganization::ObjectBased;
  EXPECT_EQ(GetPictureHash(Trace(setting)), GetPictureHash(alone));
}

/// One rank means another picture than the others.
struct Difference
{
  const char* Name;
  void (*Apply)(rt::FrameRequest& request, rt::Scene& scene);
};

class FrameThatDiffers : public testing::TestWithParam<Difference>
{
};

INSTANTIATE_TEST_SUITE_P(Differences, FrameThatDiffers,
  testing::Values(Difference{ "Width", [](auto& request, auto&) { request.Width = 33; } },
    Difference{ "Camera", [](auto& request, auto&) { request.WorldToClip[3][0] += 1e-9; } },
    Difference{ "TileSize", [](auto& request, auto&) { request.TileSize = 8; } },
    Difference{ "Samples", [](auto& request, auto&) { request.Samples = 2; } },
    Difference{ "Layers", [](auto& request, auto&) { request.Layers = 3; } },
    Difference{
      "Channels", [](auto& request, auto&) { request.Channels.Value |= rt::ChannelSet::Object; } },
    Difference{ "Objects", [](auto&, auto& scene) { scene.Objects.clear(); } },
    Difference{ "Isovalue",
      [](auto&, auto& scene)
      { std::get<rt::LatticeIsosurface>(scene.Objects[0]).Isovalues[1] = 0.6; } },
    Difference{ "Look",
      [](auto&, auto& scene)
      { std::get<rt::LatticeIsosurface>(scene.Objects[0]).Look.Surface.DiffuseColor.y = 0.3f; } },
    Difference{ "Light", [](auto&, auto& scene) { scene.Lights[0].Color.x = 0.5f; } }),
  [](const auto& info) { return info.param.Name; });

TEST_P(FrameThatDiffers, IsRefusedByAllAndTheNextFrameWorks)
{
  std::mutex guard;
  std::vector<std::string> errors;
  RunOnCluster(3,
    [&](dsm::Messenger& messenger)
    {
      dsm::BlockStore store(messenger, SphereScene::CreateSettings(std::size_t(16) << 20, 1));
      const rt::Scene scene =
        SphereScene::CreateScene(SphereScene::Publish(messenger, store), 1.0f);
      rt::FrameRenderer renderer(messenger);
      rt::FrameRequest request = SphereScene::CreateRequest(32, 32);
      rt::Scene mine = scene;
      if (messenger.GetRank() == 2)
      {
        GetParam().Apply(request, mine);
      }
      try
      {
        renderer.Render(store, mine, request);
      }
      catch (const dsm::Error& error)
      {
        const std::lock_guard<std::mutex> lock(guard);
        errors.push_back(error.what());
      }
      const rt::Frame frame = renderer.Render(store, scene, SphereScene::CreateRequest(32, 32));
      EXPECT_GT(CountCovered(rt::GatherFrame(messenger, frame)), 0);
    });
  ASSERT_EQ(errors.size(), 3u);
  EXPECT_NE(errors[0].find("rank 2"), std::string::npos) << errors[0];
  EXPECT_EQ(errors[0], errors[1]);
  EXPECT_EQ(errors[0], errors[2]);
}

TEST(FrameRenderer, CacheSmallerThanABrickIsRefusedByAllAndTheNextFrameWorks)
{
  std::mutex guard;
  std::vector<std::string> errors;
  RunOnCluster(2,
    [&](dsm::Messenger& messenger)
    {
      dsm::BlockStore store(messenger, SphereScene::CreateSettings(std::size_t(16) << 20, 1));
      const rt::Scene scene =
        SphereScene::CreateScene(SphereScene::Publish(messenger, store), 1.0f);
      rt::FrameRenderer renderer(messenger);
      store.SetSettings(SphereScene::CreateSettings(
        messenger.GetRank() == 1 ? std::size_t(64) : std::size_t(16) << 20, 1));
      try
      {
        renderer.Render(store, scene, SphereScene::CreateRequest(32, 32));
      }
      catch (const dsm::Error& error)
      {
        const std::lock_guard<std::mutex> lock(guard);
        errors.push_back(error.what());
      }
      store.SetSettings(SphereScene::CreateSettings(std::size_t(16) << 20, 1));
      const rt::Frame frame = renderer.Render(store, scene, SphereScene::CreateRequest(32, 32));
      EXPECT_GT(CountCovered(rt::GatherFrame(messenger, frame)), 0);
    });
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_NE(errors[0].find("DSMCacheSize"), std::string::npos) << errors[0];
  EXPECT_EQ(errors[0], errors[1]);
}

TEST(FrameRenderer, ReportsComeToAllRanksAndOneThatFailsIsEverybodysFailure)
{
  constexpr int ranks = 5; // the end of a frame goes by way of other ranks
  std::mutex guard;
  std::vector<std::string> errors;
  RunOnCluster(ranks,
    [&](dsm::Messenger& messenger)
    {
      dsm::BlockStore store(messenger, SphereScene::CreateSettings(std::size_t(16) << 20, 1));
      const rt::Scene scene =
        SphereScene::CreateScene(SphereScene::Publish(messenger, store), 1.0f);
      rt::FrameRenderer renderer(messenger);
      const rt::FrameRequest request = SphereScene::CreateRequest(32, 32);
      const auto report = [&](const rt::Frame& frame)
      {
        // Of different sizes, and none.
        std::vector<std::byte> bytes(static_cast<std::size_t>(3 * messenger.GetRank()),
          static_cast<std::byte>(messenger.GetRank()));
        EXPECT_GT(frame.Counters.Workers.Accesses + (frame.Tiles.empty() ? 1 : 0), 0u);
        return bytes;
      };
      const auto failing = [&](const rt::Frame& frame)
      { return messenger.GetRank() == 3 ? throw dsm::Error("no picture") : report(frame); };
      for (int round = 0; round < 2; ++round)
      {
        const rt::Frame frame = renderer.Render(store, scene, request, nullptr, { {}, report });
        EXPECT_EQ(frame.Reports.size(), std::size_t(ranks));
        for (std::size_t rank = 0; rank < frame.Reports.size(); ++rank)
        {
          EXPECT_EQ(
            frame.Reports[rank], std::vector<std::byte>(3 * rank, static_cast<std::byte>(rank)));
        }
        try
        {
          renderer.Render(store, scene, request, nullptr, { {}, failing });
        }
        catch (const dsm::Error& error)
        {
          const std::lock_guard<std::mutex> lock(guard);
          errors.push_back(error.what());
        }
      }
    });
  ASSERT_EQ(errors.size(), 2u * ranks);
  EXPECT_NE(errors[0].find("Rank 3: no picture"), std::string::npos) << errors[0];
  EXPECT_EQ(std::count(errors.begin(), errors.end(), errors[0]), 2 * ranks);
}

TEST(FrameRenderer, EmptySceneIsAnEmptyPicture)
{
  RunOnCluster(2,
    [](dsm::Messenger& messenger)
    {
      dsm::BlockStore store(messenger, SphereScene::CreateSettings(std::size_t(1) << 20, 2));
      rt::FrameRenderer renderer(messenger);
      const rt::Frame frame =
        renderer.Render(store, rt::Scene{}, SphereScene::CreateRequest(40, 30));
      EXPECT_EQ(CountCovered(rt::GatherFrame(messenger, frame)), 0);
    });
}

TEST(TestFrameRenderer, SamplesAddedLaterGiveTheSamePicture)
{
  rt::Picture atOnce;
  for (const auto& [ranks, scheduling] : { std::tuple(1, rt::TileScheduling::WorkStealing),
         std::tuple(2, rt::TileScheduling::CentralQueue),
         std::tuple(3, rt::TileScheduling::WorkStealing) })
  {
    RunOnCluster(ranks,
      [&, ranks = ranks, scheduling = scheduling](dsm::Messenger& messenger)
      {
        dsm::BlockStore store(messenger, SphereScene::CreateSettings(std::size_t(1) << 20, 2));
        rt::Scene scene = SphereScene::CreateScene(SphereScene::Publish(messenger, store), 0.5f);
        scene.Transport.Shadows = true;
        scene.Transport.LightRadius = 0.2;
        scene.Transport.AmbientOcclusionSamples = 1;
        scene.Transport.AmbientOcclusionDistance = 1.0;
        rt::FrameRenderer renderer(messenger);
        rt::FrameRequest request = SphereScene::CreateRequest(97, 61);
        request.Samples = 6;
        request.Scheduling = scheduling;
        const rt::Picture plain =
          rt::GatherFrame(messenger, renderer.Render(store, scene, request));
        EXPECT_TRUE(plain.Normal.empty() && plain.Albedo.empty() && plain.Object.empty());
        request.Channels.Value = rt::ChannelSet::All;
        const rt::Picture whole =
          rt::GatherFrame(messenger, renderer.Render(store, scene, request));
        EXPECT_EQ(whole.Color, plain.Color);
        EXPECT_EQ(whole.Depth, plain.Depth);
        EXPECT_EQ(whole.Normal.size(), 3 * whole.Depth.size());
        request.Samples = 1;
        rt::Frame frame = renderer.Render(store, scene, request);
        for (const int samples : { 2, 3 })
        {
          request.FirstSample += request.Samples;
          request.Samples = samples;
          renderer.Refine(store, scene, request, frame);
        }
        const rt::Picture refined = rt::GatherFrame(messenger, frame);
        EXPECT_EQ(GetPictureHash(refined), GetPictureHash(whole));
        if (messenger.GetRank() == 0)
        {
          if (ranks == 1)
          {
            atOnce = whole;
          }
          EXPECT_EQ(GetPictureHash(whole), GetPictureHash(atOnce)) << ranks << " ranks";
        }
      });
  }
}

/// Changes of a look, and of what rays meet. The scene is MeshScene's.
TEST(FrameRendererOnLoopback, PicturesOfKnownHitsAreThose)
{
  const auto getBall = [](rt::Scene& scene) -> rt::LatticeIsosurface&
  { return std::get<rt::LatticeIsosurface>(scene.Objects[0]); };
  const auto getBlob = [](rt::Scene& scene) -> rt::MeshObject&
  { return std::get<rt::MeshObject>(scene.Objects[1]); };
  using Change = std::function<void(rt::Scene&, rt::FrameRequest&)>;
  const std::vector<Change> changes{
    [&](rt::Scene& scene, rt::FrameRequest&) { getBall(scene).Look.Surface.Opacity = 1.0f; },
    [&](rt::Scene& scene, rt::FrameRequest&) { getBall(scene).Look.Surface.DiffuseColor.x = 0.2f; },
    [&](rt::Scene& scene, rt::FrameRequest&) { getBall(scene).Look.CullsFront = true; },
    [&](rt::Scene& scene, rt::FrameRequest&) { getBall(scene).Look.Surface.Opacity = 0.0f; },
    [&](rt::Scene& scene, rt::FrameRequest&) { getBlob(scene).Look.BackSurface.reset(); },
    [&](rt::Scene& scene, rt::FrameRequest&) { getBlob(scene).Look.Surface.Opacity = 0.0f; },
    [&](rt::Scene& scene, rt::FrameRequest&) { getBlob(scene).Look.Flat = true; },
    [&](rt::Scene& scene, rt::FrameRequest&) { getBlob(scene).Look.Surface.Reflectivity = 0.5f; },
    [](rt::Scene& scene, rt::FrameRequest&) { scene.Lights.front().Direction.x *= -1.0; },
    [](rt::Scene& scene, rt::FrameRequest&) { scene.Transport.Shadows = false; },
    [](rt::Scene& scene, rt::FrameRequest&) { scene.View = rt::DebugView::Brick; },
    [](rt::Scene&, rt::FrameRequest& request) { request.Channels.Value = rt::ChannelSet::All; },
    [](rt::Scene&, rt::FrameRequest& request) { request.Layers = 3; },
    [](rt::Scene& scene, rt::FrameRequest&)
    {
      scene.Transport.AmbientOcclusionSamples = 1;
      scene.Transport.AmbientOcclusionDistance = 5.0;
    },
    // These have other hits.
    [](rt::Scene&, rt::FrameRequest& request) { request.WorldToClip[3][0] += 0.1; },
    [](rt::Scene&, rt::FrameRequest& request)
    { request.Limits = std::make_shared<const std::vector<float>>(97 * 61, 0.95f); },
    [&](rt::Scene& scene, rt::FrameRequest&) { getBall(scene).Isovalues = { 0.6 }; },
    [&](rt::Scene& scene, rt::FrameRequest&) {
      getBall(scene).Clipping.HalfSpaces.push_back({ { 1.0, 0.0, 0.0 }, glm::dvec3(14.0) });
    },
    [&](rt::Scene& scene, rt::FrameRequest&) {
      getBlob(scene).Clipping.HalfSpaces.push_back({ { 1.0, 0.0, 0.0 }, glm::dvec3(24.0) });
    },
    [](rt::Scene& scene, rt::FrameRequest&) { scene.Objects.erase(scene.Objects.begin() + 1); },
  };
  // The smaller memory has no room for all hits of a picture.
  for (const auto& [ranks, memory] :
    { std::pair(2, std::uint64_t(1) << 30), std::pair(1, std::uint64_t(1) << 24) })
  {
    RunOnCluster(ranks,
      [&, memory = memory](dsm::Messenger& messenger)
      {
        auto settings = SphereScene::CreateSettings(std::size_t(1) << 20, 2);
        settings.MemoryBytes = memory;
        dsm::BlockStore store(messenger, settings);
        const rt::Scene scene = MeshScene::Create(messenger, store);
        rt::FrameRenderer renderer(messenger);
        rt::FrameRequest request = SphereScene::CreateRequest(97, 61);
        request.Samples = rt::KeptHits::MostSamples + 1;
        const auto trace = [&](const rt::Scene& some, rt::FrameRequest own, bool keepsHits)
        {
          own.KeepsHits = keepsHits;
          return GetPictureHash(rt::GatherFrame(messenger, renderer.Render(store, some, own)));
        };
        for (std::size_t change = 0; change < changes.size(); ++change)
        {
          rt::Scene other = scene;
          rt::FrameRequest otherRequest = request;
          changes[change](other, otherRequest);
          rt::FrameRenderer fresh(messenger);
          otherRequest.KeepsHits = false;
          const std::uint64_t expected =
            GetPictureHash(rt::GatherFrame(messenger, fresh.Render(store, other, otherRequest)));
          trace(scene, request, true);
          EXPECT_EQ(trace(other, otherRequest, true), expected) << "change " << change;
          EXPECT_EQ(trace(other, otherRequest, false), expected) << "change " << change;
        }
      });
  }
}

TEST(FrameRendererOnLoopback, NewLooksNeedNoBricks)
{
  RunOnCluster(1,
    [](dsm::Messenger& messenger)
    {
      dsm::BlockStore store(messenger, SphereScene::CreateSettings(std::size_t(1) << 30, 2));
      rt::Scene scene = SphereScene::CreateScene(SphereScene::Publish(messenger, store), 1.0f);
      rt::FrameRenderer renderer(messenger);
      rt::FrameRequest request = SphereScene::CreateRequest(97, 61);
      request.KeepsHits = true;
      EXPECT_GT(renderer.Render(store, scene, request).Counters.Workers.Accesses, 0u);
      std::get<rt::LatticeIsosurface>(scene.Objects[0]).Look.Surface.DiffuseColor.x = 0.3f;
      scene.Lights.front().Direction.x *= -1.0;
      EXPECT_EQ(renderer.Render(store, scene, request).Counters.Workers.Accesses, 0u);
    });
}

TEST(FrameRendererOnLoopback, PicturesOfAnInterruptedViewAreRight)
{
  RunOnCluster(3,
    [](dsm::Messenger& messenger)
    {
      InterruptedView view(messenger, SphereScene::CreateSettings(std::size_t(1) << 16, 2));
      EXPECT_GT(view.Abort(InterruptedView::CountAborts(12), 7), 0);
    });
}

/// Whether the ranks are waited for in vain is a matter of the moment, so there are many.
class AbortedFrame : public testing::TestWithParam<std::tuple<int, rt::TileScheduling>>
{
};

INSTANTIATE_TEST_SUITE_P(RanksAndSchedulers, AbortedFrame,
  testing::Combine(testing::Values(1, 2),
    testing::Values(rt::TileScheduling::CentralQueue, rt::TileScheduling::WorkStealing)));

TEST_P(AbortedFrame, EndsOnAllRanksAndTheNextOneIsRight)
{
  const auto [ranks, scheduling] = GetParam();
  constexpr int rounds = 10;
  constexpr int latest = 400;
  std::atomic<int> aborted{ 0 };
  RunOnCluster(ranks,
    [&, scheduling = scheduling](dsm::Messenger& messenger)
    {
      dsm::BlockStore store(messenger,
        SphereScene::CreateSettings(std::size_t(1) << 16, 2, dsm::MemoryOrganization::ObjectBased));
      const rt::Scene scene =
        SphereScene::CreateScene(SphereScene::Publish(messenger, store), 0.5f);
      rt::FrameRenderer renderer(messenger);
      rt::FrameRequest request = SphereScene::CreateRequest(97, 61);
      request.Scheduling = scheduling;
      request.Samples = 3;
      const std::uint64_t expected =
        GetPictureHash(rt::GatherFrame(messenger, renderer.Render(store, scene, request)));
      std::mt19937 random(7);
      int left = -1; // looks at the abort status, before it is set; negative: it is not
      renderer.SetWatch([&](double) { return left >= 0 && left-- == 0; });
      for (int round = 0; round < rounds; ++round)
      {
        request.FirstSample = 0;
        request.Samples = 1;
        // The first one at once, however busy the machine is.
        left = round == 0 ? 0 : static_cast<int>(random() % latest);
        rt::Frame frame = renderer.Render(store, scene, request);
        left = -1;
        if (frame.IsAborted)
        {
          ++aborted;
          const double before = frame.Seconds;
          const std::uint64_t accesses = frame.Counters.Workers.Accesses;
          left = static_cast<int>(random() % latest);
          renderer.Resume(store, scene, request, frame);
          left = -1;
          if (frame.IsAborted)
          {
            renderer.Resume(store, scene, request, frame);
          }
          EXPECT_GT(frame.Seconds, before);
          EXPECT_GE(frame.Counters.Workers.Accesses, accesses);
        }
        request.FirstSample = 1;
        request.Samples = 2;
        left = static_cast<int>(random() % latest);
        renderer.Refine(store, scene, request, frame);
        left = -1;
        if (frame.IsAborted)
        {
          ++aborted;
          const double before = frame.Seconds;
          renderer.Refine(store, scene, request, frame);
          EXPECT_GT(frame.Seconds, before) << "the time of the aborted part belongs to the frame's";
        }
        EXPECT_EQ(GetPictureHash(rt::GatherFrame(messenger, frame)), expected) << "round " << round;
      }
    });
  EXPECT_GE(aborted, ranks) << "no frame was aborted";
  EXPECT_EQ(aborted % ranks, 0) << "a frame is aborted on all ranks, or on none";
}
