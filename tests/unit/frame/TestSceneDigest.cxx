// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/SceneDigest.h"

#include "tests/support/LoopbackCluster.h"
#include "tests/support/MeshScene.h"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <variant>
#include <vector>

namespace
{

rt::LatticeIsosurface& GetIsosurface(rt::Scene& scene)
{
  return std::get<rt::LatticeIsosurface>(scene.Objects.front());
}

} // namespace

TEST(TestSceneDigest, ChangesWithAllThatThePictureShows)
{
  RunOnCluster(1,
    [](dsm::Messenger& messenger)
    {
      dsm::BlockStore store(messenger, SphereScene::CreateSettings(std::size_t(1) << 20, 1));
      const rt::Scene scene =
        SphereScene::CreateScene(SphereScene::Publish(messenger, store), 1.0f);
      const rt::FrameRequest request = SphereScene::CreateRequest(40, 30);
      std::set<std::uint64_t> digests{ rt::GetSceneDigest(scene, request) };
      EXPECT_EQ(rt::GetSceneDigest(scene, request), *digests.begin());

      const std::vector<std::function<void(rt::Scene&, rt::FrameRequest&)>> changes = {
        [](rt::Scene&, rt::FrameRequest& r) { r.Width = 41; },
        [](rt::Scene&, rt::FrameRequest& r) { r.Layers = 4; },
        [](rt::Scene&, rt::FrameRequest& r)
        { r.Limits = std::make_shared<const std::vector<float>>(1200, 0.5f); },
        [](rt::Scene&, rt::FrameRequest& r)
        { r.MediumCuts = std::make_shared<const std::vector<float>>(1200, 0.5f); },
        [](rt::Scene&, rt::FrameRequest& r) { r.Channels.Value |= rt::ChannelSet::Normal; },
        [](rt::Scene&, rt::FrameRequest& r) { r.WorldToClip[3][0] += 1e-12; },
        [](rt::Scene& s, rt::FrameRequest&) { GetIsosurface(s).Isovalues[0] += 1e-12; },
        [](rt::Scene& s, rt::FrameRequest&) { GetIsosurface(s).Isovalues.push_back(1e3); },
        [](rt::Scene& s, rt::FrameRequest&)
        { GetIsosurface(s).Look.Surface.DiffuseColor.y = 0.1f; },
        [](rt::Scene& s, rt::FrameRequest&) { GetIsosurface(s).Look.Surface.Reflectivity = 0.5f; },
        [](rt::Scene& s, rt::FrameRequest&) { GetIsosurface(s).Field.IndexToWorld[3][1] += 1.0; },
        [](rt::Scene& s, rt::FrameRequest&) { s.Objects.push_back(s.Objects[0]); },
        [](rt::Scene& s, rt::FrameRequest&)
        { GetIsosurface(s).Clipping.HalfSpaces.emplace_back(); },
        [](rt::Scene& s, rt::FrameRequest&) { GetIsosurface(s).Clipping.Boxes.emplace(); },
        [](rt::Scene& s, rt::FrameRequest&) { s.Lights.emplace_back(); },
        [](rt::Scene& s, rt::FrameRequest&) { s.Lights.emplace_back().Color.y = 2; },
        [](rt::Scene& s, rt::FrameRequest&)
        { s.Lights.emplace_back().Kind = rt::PositionalLight{}; },
        [](rt::Scene& s, rt::FrameRequest&) {
          s.Lights.emplace_back().Kind = rt::PositionalLight{ { 2.0, 0.0, 0.0 }, {} };
        },
        [](rt::Scene& s, rt::FrameRequest&) {
          s.Lights.emplace_back().Kind = rt::ConeLight{ {}, 0.5f, 1.0f };
        },
        [](rt::Scene& s, rt::FrameRequest&) { s.Lights.emplace_back().Direction.z = 2; },
        [](rt::Scene& s, rt::FrameRequest&) { s.Transport.Shadows = true; },
        [](rt::Scene& s, rt::FrameRequest&) { s.Transport.Background.z = 0.3f; },
        [](rt::Scene& s, rt::FrameRequest&) { s.Transport.Surroundings.Lower.z = 0.3f; },
        [](rt::Scene& s, rt::FrameRequest&) { s.Transport.Surroundings.Upper.z = 0.3f; },
        [](rt::Scene& s, rt::FrameRequest&) { s.Transport.Surroundings.Up.x = 0.3; },
        [&](rt::Scene& s, rt::FrameRequest&)
        { GetIsosurface(s).Field.Voxels = SphereScene::Publish(messenger, store); },
      };
      for (const auto& change : changes)
      {
        rt::Scene other = scene;
        rt::FrameRequest otherRequest = request;
        change(other, otherRequest);
        digests.insert(rt::GetSceneDigest(other, otherRequest));
      }
      EXPECT_EQ(digests.size(), changes.size() + 1);

      rt::FrameRequest more = request;
      more.FirstSample = 3;
      more.Samples = 2;
      EXPECT_EQ(rt::GetSceneDigest(scene, more), rt::GetSceneDigest(scene, request));
    });
}

TEST(TestSceneDigest, ChangesWithWhatIsLaidOnAMesh)
{
  RunOnCluster(1,
    [](dsm::Messenger& messenger)
    {
      dsm::BlockStore store(messenger, SphereScene::CreateSettings(std::size_t(1) << 20, 1));
      const rt::Scene scene = MeshScene::Create(messenger, store);
      const rt::FrameRequest request = SphereScene::CreateRequest(40, 30);
      rt::Texture texture;
      texture.Width = texture.Height = 3;
      texture.Texels.assign(4 * 9, 128);
      const std::vector<std::function<void(rt::Texture&)>> changes = {
        [](rt::Texture&) {},
        [](rt::Texture& t) { t.Texels.front() = 129; },
        [](rt::Texture& t) { t.Texels.back() = 129; },
        [](rt::Texture& t) { t.Repeat = false; },
        [](rt::Texture& t) { t.Interpolate = true; },
        [](rt::Texture& t) { t.Transform[3][0] = 0.5; },
      };
      std::set<std::uint64_t> digests{ rt::GetSceneDigest(scene, request) };
      for (const auto& change : changes)
      {
        rt::Texture other = texture;
        change(other);
        rt::Scene textured = scene;
        std::get<rt::MeshObject>(textured.Objects[1]).Look.Picture =
          std::make_shared<rt::Texture>(other);
        digests.insert(rt::GetSceneDigest(textured, request));
      }
      EXPECT_EQ(digests.size(), changes.size() + 1);

      const std::vector<std::function<void(std::optional<rt::EdgeLines>&)>> lines = {
        [](std::optional<rt::EdgeLines>& e) { e.reset(); },
        [](std::optional<rt::EdgeLines>& e) { e->Color.y = 0.7f; },
        [](std::optional<rt::EdgeLines>& e) { e->Width = 5.0f; },
        [](std::optional<rt::EdgeLines>& e) { e->Opacity = 0.5f; },
      };
      const std::size_t before = digests.size();
      for (const auto& change : lines)
      {
        rt::Scene other = scene;
        change(std::get<rt::MeshObject>(other.Objects[1]).Look.Edges);
        digests.insert(rt::GetSceneDigest(other, request));
      }
      EXPECT_EQ(digests.size(), before + lines.size());
    });
}
