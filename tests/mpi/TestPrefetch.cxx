// SPDX-License-Identifier: BSD-3-Clause
// A camera that moves, over real MPI ranks with a small cache: prefetching changes no picture, and
// workers wait less often.
#include "tests/support/PictureHash.h"
#include "tests/support/SphereScene.h"

#include "DSMCore/transport/MpiTransport.h"
#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/frame/FrameRenderer.h"

#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace
{

constexpr int Frames = 24;
constexpr int Pixels = 256;

glm::dmat4 GetCamera(int frame)
{
  const double angle = glm::radians(20.0 + 4.0 * frame);
  const glm::dvec3 centre(0.5 * (SphereScene::Points - 1));
  const glm::dvec3 eye =
    centre + 110.0 * glm::dvec3(std::cos(angle), 0.3 + 0.01 * frame, std::sin(angle));
  return glm::perspective(glm::radians(22.0), 1.0, 1.0, 400.0) *
    glm::lookAt(eye, centre, glm::dvec3(0.0, 1.0, 0.0));
}

struct Session
{
  std::vector<std::uint64_t> Pictures;
  // Over all ranks:
  std::uint64_t Misses = 0;
  std::uint64_t Prefetches = 0;
  std::uint64_t PrefetchesUsed = 0;
};

Session Play(dsm::Messenger& messenger, dsm::BlockStore::Settings settings, bool prefetch)
{
  settings.Prefetch = prefetch;
  dsm::BlockStore store(messenger, settings);
  const rt::Scene scene = SphereScene::CreateScene(SphereScene::Publish(messenger, store), 1.0f);
  rt::FrameRenderer renderer(messenger);
  rt::FrameRequest request = SphereScene::CreateRequest(Pixels, Pixels);
  rt::Frame frame;
  Session session;
  for (int number = 0; number < Frames; ++number)
  {
    request.WorldToClip = GetCamera(number);
    frame = renderer.Render(store, scene, request, &frame);
    session.Pictures.push_back(GetPictureHash(rt::GatherFrame(messenger, frame)));
    for (const dsm::StoreCounters& counters : messenger.AllGatherValue(frame.Counters))
    {
      session.Misses += counters.Workers.Misses;
      session.Prefetches += counters.Prefetches;
      session.PrefetchesUsed += counters.PrefetchesUsed;
      EXPECT_LE(counters.PeakCachedBytes, counters.CacheCapacity);
    }
  }
  return session;
}

class PrefetchOverMpi : public testing::TestWithParam<dsm::MemoryOrganization>
{
protected:
  dsm::Messenger Messenger{ dsm::MpiTransport::Create(nullptr) };
};

INSTANTIATE_TEST_SUITE_P(Organizations, PrefetchOverMpi,
  testing::Values(dsm::MemoryOrganization::ObjectBased, dsm::MemoryOrganization::PageBased));

} // namespace

TEST_P(PrefetchOverMpi, MovingCameraWaitsLessAndSeesTheSame)
{
  const Session alone = Play(this->Messenger,
    SphereScene::CreateSettings(std::size_t(16) << 20, 1, dsm::MemoryOrganization::Replicated),
    false);
  EXPECT_EQ(alone.Misses, 0u);
  const bricks::BrickLattice lattice(bricks::Index3(SphereScene::Points),
    bricks::ScalarType::Float32, false, SphereScene::BrickEdge);
  const std::size_t page = 4096; // a brick takes whole ones, where it is paged
  const std::size_t oneBrick = (lattice.CreateDirectory(1).GetLargest() + page - 1) / page * page;
  const auto settings = SphereScene::CreateSettings(16 * oneBrick, 1, this->GetParam());
  Session without;
  Session with;
  // Which rank traces which tile is never the same twice, and misses of a session vary by a tenth.
  constexpr int Rounds = 6;
  for (int round = 0; round < Rounds; ++round)
  {
    for (const bool prefetch : { false, true })
    {
      const Session session = Play(this->Messenger, settings, prefetch);
      EXPECT_EQ(session.Pictures, alone.Pictures) << (prefetch ? "with" : "without");
      Session& sum = prefetch ? with : without;
      sum.Misses += session.Misses;
      sum.Prefetches += session.Prefetches;
      sum.PrefetchesUsed += session.PrefetchesUsed;
    }
  }
  EXPECT_EQ(without.Prefetches, 0u);
  EXPECT_LE(with.PrefetchesUsed, with.Prefetches);
  RecordProperty("misses_without", std::to_string(without.Misses));
  RecordProperty("misses_with", std::to_string(with.Misses));
  RecordProperty("prefetches", std::to_string(with.Prefetches));
  RecordProperty("prefetches_used", std::to_string(with.PrefetchesUsed));
  if (this->Messenger.GetSize() == 1)
  {
    EXPECT_EQ(with.Prefetches, 0u);
    return;
  }
  EXPECT_GT(with.PrefetchesUsed, 0u);
  // With more ranks than that on a few cores, tiles change hands as the machine's load will have it.
  if (this->Messenger.GetSize() <= 3)
  {
    EXPECT_LT(with.Misses, without.Misses);
  }
}
