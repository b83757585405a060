// SPDX-License-Identifier: BSD-3-Clause
// Over real MPI ranks, the picture is that of one rank alone, bit for bit.
#include "tests/support/LoopbackCluster.h"
#include "tests/support/SphereScene.h"

#include "DSMCore/MpiTransport.h"
#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/frame/FrameRenderer.h"

#include <gtest/gtest.h>

#include <utility>

namespace
{

constexpr std::size_t PlentyOfCache = std::size_t(16) << 20;

rt::Picture TraceTurning(dsm::Messenger& messenger, std::size_t cacheBytes, int workers)
{
  dsm::ObjectStore store(messenger, { cacheBytes, workers });
  const rt::Scene scene = SphereScene::CreateScene(SphereScene::Publish(messenger, store), 1.0f);
  rt::FrameRenderer renderer(messenger);
  rt::Picture picture;
  for (const int width : { 64, 33, 97 })
  {
    picture = rt::GatherFrame(
      messenger, renderer.Render(store, scene, SphereScene::CreateRequest(width, 61)));
  }
  return picture;
}

std::uint64_t GetReference()
{
  std::uint64_t hash = 0;
  RunOnCluster(
    1, [&](dsm::Messenger& alone) { hash = rt::GetHash(TraceTurning(alone, PlentyOfCache, 1)); });
  return hash;
}

class FrameOverMpi : public testing::Test
{
protected:
  dsm::Messenger Messenger{ dsm::MpiTransport::Create(nullptr) };
};

} // namespace

TEST_F(FrameOverMpi, EqualsOneRankAlone)
{
  const std::uint64_t expected = GetReference();
  for (const int workers : { 1, 2 })
  {
    EXPECT_EQ(rt::GetHash(TraceTurning(this->Messenger, PlentyOfCache, workers)), expected)
      << workers << " workers";
  }
}

TEST_F(FrameOverMpi, CacheHoldsOneBrick)
{
  const rt::BrickLattice lattice(
    rt::Index3(SphereScene::Points), rt::ScalarType::Float32, false, SphereScene::BrickEdge);
  const std::size_t oneBrick =
    (lattice.CreateDirectory(1).GetLargest() / dsm::BlockAlignment + 1) * dsm::BlockAlignment;
  EXPECT_EQ(rt::GetHash(TraceTurning(this->Messenger, oneBrick, 2)), GetReference());
}
