// SPDX-License-Identifier: BSD-3-Clause
// Over real MPI ranks, the picture of meshes and isosurfaces is that of one rank alone.
#include "tests/support/MeshScene.h"
#include "tests/support/PictureHash.h"

#include "DSMCore/transport/MpiTransport.h"
#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/frame/FrameRenderer.h"

#include <gtest/gtest.h>

namespace
{

std::uint64_t Trace(dsm::Messenger& messenger, const dsm::BlockStore::Settings& settings)
{
  dsm::BlockStore store(messenger, settings);
  const rt::Scene scene = MeshScene::Create(messenger, store);
  rt::FrameRenderer renderer(messenger);
  return GetPictureHash(
    rt::GatherFrame(messenger, renderer.Render(store, scene, SphereScene::CreateRequest(97, 61))));
}

class MeshFrameOverMpi : public testing::TestWithParam<dsm::MemoryOrganization>
{
protected:
  dsm::Messenger Messenger{ dsm::MpiTransport::Create(nullptr) };
};

INSTANTIATE_TEST_SUITE_P(Organizations, MeshFrameOverMpi,
  testing::Values(dsm::MemoryOrganization::Automatic, dsm::MemoryOrganization::Replicated,
    dsm::MemoryOrganization::ObjectBased, dsm::MemoryOrganization::PageBased));

} // namespace

TEST_P(MeshFrameOverMpi, EqualsOneRankAlone)
{
  constexpr std::size_t plenty = std::size_t(16) << 20;
  std::uint64_t expected = 0;
  RunOnCluster(1,
    [&](dsm::Messenger& alone)
    { expected = Trace(alone, SphereScene::CreateSettings(plenty, 1)); });
  for (const int workers : { 1, 2 })
  {
    EXPECT_EQ(
      Trace(this->Messenger, SphereScene::CreateSettings(plenty, workers, GetParam())), expected)
      << workers << " workers";
  }
}
