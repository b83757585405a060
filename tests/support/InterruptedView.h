// SPDX-License-Identifier: BSD-3-Clause
#ifndef InterruptedView_h
#define InterruptedView_h

#include "tests/support/PictureHash.h"
#include "tests/support/SphereScene.h"

#include "DSMCore/store/BlockStore.h"
#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/frame/FrameAccumulation.h"
#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/frame/FrameRenderer.h"
#include "DSMRayTracing/look/TransferFunction.h"
#include "DSMRayTracing/scene/Scene.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <utility>
#include <vector>

/// A view whose frames are aborted at random moments, as by a user who presses the mouse: isosurfaces and a volume, in
/// light of shadows and occlusion. Each rank has its own; all calls are collective.
class InterruptedView
{
public:
  static constexpr int Samples = 3;

  InterruptedView(dsm::Messenger& messenger, const dsm::BlockStore::Settings& settings)
    : Ranks(messenger)
    , Store(messenger, settings)
    , Renderer(messenger)
  {
    const auto field = SphereScene::Publish(messenger, this->Store);
    for (const float opacity : { 1.0f, 0.5f })
    {
      this->AddLook(SphereScene::CreateScene(field, opacity));
    }
    rt::Scene volume = SphereScene::CreateScene(field, 1.0f);
    volume.Objects.clear();
    rt::LatticeMedium medium;
    medium.Field.Voxels = field;
    medium.Function = rt::TransferFunction::Create(
      0.0, 1.0, [](double value) { return glm::dvec4(value, 0.5, 1.0 - value, 0.2 * value); },
      { 0.0, 1.0 }, 0.0, 1.0);
    medium.Look.Shade = true;
    volume.Media.push_back(medium);
    this->AddLook(volume);
  }

  /// How many frames a test aborts: DSM_TEST_ABORTS of the environment, or `usual`.
  static int CountAborts(int usual)
  {
    const char* const given = std::getenv("DSM_TEST_ABORTS");
    return given ? std::atoi(given) : usual;
  }

  /// Aborts `wanted` frames. Between them, the view shows another look, or gets the samples that are missing. Then its
  /// picture must equal that of a frame without aborts. Returns how many pictures were compared.
  int Abort(int wanted, unsigned seed)
  {
    std::mt19937 random(seed); // the same on all ranks
    int compared = 0;
    std::size_t shown = 0;
    for (int aborted = 0; aborted < wanted;)
    {
      shown = random() % 3 == 0 ? random() % this->Looks.size() : shown;
      const Look& look = this->Looks[shown];
      const bool isToEnd = random() % 4 == 0;
      const int samples = static_cast<int>(random() % 3);
      this->Scheduling =
        random() % 2 == 0 ? rt::TileScheduling::CentralQueue : rt::TileScheduling::WorkStealing;
      const double seconds = std::uniform_real_distribution<>(0.0, 1.2 * look.Seconds)(random);
      this->Deadline = Clock::now() +
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
      this->Renderer.SetWatch([&](double) { return !isToEnd && Clock::now() >= this->Deadline; });
      // All at once, one by one until they are there, or one.
      const auto result = this->Trace(this->View, look, { isToEnd ? 0 : samples, samples == 1 });
      aborted += result == rt::FrameAccumulation::Result::Aborted ? 1 : 0;
      EXPECT_EQ(this->View.GetPart() == 1.0, this->View.IsComplete());
      if (isToEnd || this->View.IsComplete())
      {
        ++compared;
        EXPECT_EQ(this->GetHash(this->View), look.Hash)
          << "look " << shown << ", after " << aborted << " aborts";
      }
    }
    this->Renderer.SetWatch({});
    return compared;
  }

private:
  using Clock = std::chrono::steady_clock;

  struct Look
  {
    rt::Scene Scene;
    std::uint64_t Hash; ///< of its picture
    double Seconds;     ///< that the picture takes
  };

  void AddLook(rt::Scene scene)
  {
    scene.Transport.Shadows = true;
    scene.Transport.AmbientOcclusionSamples = 2;
    scene.Transport.AmbientOcclusionDistance = SphereScene::Points;
    Look look{ std::move(scene), 0, 0.0 };
    rt::FrameAccumulation whole;
    const auto start = Clock::now();
    this->Trace(whole, look, {});
    look.Seconds = std::chrono::duration<double>(Clock::now() - start).count();
    look.Hash = this->GetHash(whole);
    this->Looks.push_back(look);
  }

  rt::FrameAccumulation::Result Trace(
    rt::FrameAccumulation& view, const Look& look, const rt::FrameAccumulation::Pace& pace)
  {
    rt::FrameRequest request = SphereScene::CreateRequest(97, 61);
    request.Scheduling = this->Scheduling;
    request.KeepsHits = true;
    const auto offers = this->Ranks.GatherValueTogether(
      "Testing", [&] { return view.CreateOffer(this->Store, look.Scene, request, Samples, pace); });
    return view.Trace({ this->Ranks, this->Renderer, this->Store }, offers, look.Scene, request,
      Samples, pace, [](const rt::Frame&) { return std::vector<std::byte>(); });
  }

  std::uint64_t GetHash(const rt::FrameAccumulation& view)
  {
    return GetPictureHash(rt::GatherFrame(this->Ranks, view.GetFrame()));
  }

  dsm::Messenger& Ranks;
  dsm::BlockStore Store;
  rt::FrameRenderer Renderer;
  rt::TileScheduling Scheduling = rt::TileScheduling::WorkStealing;
  std::vector<Look> Looks;
  rt::FrameAccumulation View;
  Clock::time_point Deadline;
};

#endif
