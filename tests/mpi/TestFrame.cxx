// SPDX-License-Identifier: BSD-3-Clause
// Over real MPI ranks, the picture is that of one rank alone, bit for bit.
#include "tests/support/InterruptedView.h"
#include "tests/support/LoopbackCluster.h"
#include "tests/support/PictureHash.h"
#include "tests/support/SphereScene.h"

#include "DSMCore/transport/MpiTransport.h"
#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/frame/FrameRenderer.h"

#include <gtest/gtest.h>

#include <tuple>
#include <utility>

namespace
{

constexpr std::size_t PlentyOfCache = std::size_t(16) << 20;

rt::Picture TraceTurning(dsm::Messenger& messenger, const dsm::BlockStore::Settings& settings)
{
  dsm::BlockStore store(messenger, settings);
  const rt::Scene scene = SphereScene::CreateScene(SphereScene::Publish(messenger, store), 1.0f);
  rt::FrameRenderer renderer(messenger);
  rt::Picture picture;
  for (const int width : { 64, 33, 97 })
  {
    rt::FrameRequest request = SphereScene::CreateRequest(width, 61);
    request.Channels.Value = width == 64 ? rt::ChannelSet::Always : rt::ChannelSet::All;
    picture = rt::GatherFrame(messenger, renderer.Render(store, scene, request));
  }
  return picture;
}

std::uint64_t GetReference()
{
  std::uint64_t hash = 0;
  RunOnCluster(1,
    [&](dsm::Messenger& alone)
    { hash = GetPictureHash(TraceTurning(alone, SphereScene::CreateSettings(PlentyOfCache, 1))); });
  return hash;
}

/// The organization, and whether ranks of a host read one another's bricks in place.
class FrameOverMpi : public testing::TestWithParam<std::tuple<dsm::MemoryOrganization, bool>>
{
protected:
  static dsm::BlockStore::Settings Create(std::size_t cacheBytes, int workers)
  {
    dsm::BlockStore::Settings settings =
      SphereScene::CreateSettings(cacheBytes, workers, std::get<0>(GetParam()));
    settings.HostSharing = std::get<1>(GetParam());
    return settings;
  }

  dsm::Messenger Messenger{ dsm::MpiTransport::Create(nullptr) };
};

INSTANTIATE_TEST_SUITE_P(Organizations, FrameOverMpi,
  testing::Combine(
    testing::Values(dsm::MemoryOrganization::Automatic, dsm::MemoryOrganization::Replicated,
      dsm::MemoryOrganization::ObjectBased, dsm::MemoryOrganization::PageBased),
    testing::Bool()));

} // namespace

TEST_P(FrameOverMpi, EqualsOneRankAlone)
{
  const std::uint64_t expected = GetReference();
  for (const int workers : { 1, 2 })
  {
    EXPECT_EQ(
      GetPictureHash(TraceTurning(this->Messenger, this->Create(PlentyOfCache, workers))), expected)
      << workers << " workers";
  }
}

TEST_P(FrameOverMpi, CacheHoldsOneBrick)
{
  const bricks::BrickLattice lattice(bricks::Index3(SphereScene::Points),
    bricks::ScalarType::Float32, false, SphereScene::BrickEdge);
  const std::size_t page = 4096; // a brick takes whole ones, where it is paged
  const std::size_t oneBrick = (lattice.CreateDirectory(1).GetLargest() + page - 1) / page * page;
  EXPECT_EQ(
    GetPictureHash(TraceTurning(this->Messenger, this->Create(oneBrick, 2))), GetReference());
}

TEST_P(FrameOverMpi, AbortedFramesEndOnAllRanksAndTheirPicturesAreRight)
{
  InterruptedView view(this->Messenger, this->Create(PlentyOfCache, 2));
  EXPECT_GT(view.Abort(InterruptedView::CountAborts(12), 11), 0);
}
