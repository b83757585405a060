// SPDX-License-Identifier: BSD-3-Clause
#include "TestTubes.h"
#include "tests/support/LimitedCluster.h"

#include <gtest/gtest.h>

#include <cstring>
#include <initializer_list>
#include <mutex>
#include <string>

namespace
{

using namespace TestMesh;

constexpr std::size_t CacheBytes = std::size_t(1) << 20;

struct Setting
{
  int Ranks = 1;
  unsigned Seed = 0; ///< 0: in the mesh's own order
  int Threads = 1;
  bool OneRankHasAll = false;
  std::size_t Cache = CacheBytes;
  /// Of collectives; messages cannot carry much more.
  std::size_t PieceBytes = dsm::Messenger::DefaultPieceBytes;
};

/// Everything that a ray can see of a published mesh.
struct Outcome
{
  std::map<dsm::BlockId, std::vector<std::byte>> Blocks;
  std::vector<std::byte> Hierarchy;
  std::vector<double> Hits;
  dsm::StoreCounters Counters; ///< of the last rank
};

Outcome Publish(const Mesh& mesh, const Setting& setting)
{
  Outcome outcome;
  std::mutex guard;
  const std::vector<rt::Ray> rays = CreateRays(400, 31);
  RunOnLimitedCluster(setting.Ranks, setting.PieceBytes,
    [&](dsm::Messenger& messenger)
    {
      const auto rank = static_cast<std::uint64_t>(messenger.GetRank());
      const auto ranks = static_cast<std::uint64_t>(messenger.GetSize());
      const Mesh piece = setting.OneRankHasAll
        ? (rank + 1 == ranks ? TakePart(mesh, 0, 1, setting.Seed) : Mesh())
        : TakePart(mesh, rank, ranks, setting.Seed);
      dsm::ObjectStore store(messenger, { setting.Cache, 1 });
      bricks::TriangleMeshSettings settings;
      settings.BrickBytes = 1500;
      settings.Threads = setting.Threads;
      const auto published = bricks::PublishMesh("mesh", piece, settings, store, messenger);
      const rt::MeshInstance instance(published, glm::dmat4(1.0));
      std::vector<double> hits;
      TraceOnWorker(store, messenger,
        [&](dsm::ObjectStore::Worker& worker)
        {
          const Tracer tracer(store, worker);
          for (const rt::Ray& ray : rays)
          {
            rt::MeshHit hit;
            const bool found = tracer.Intersect(instance, ray, hit);
            hits.insert(hits.end(),
              { found ? hit.T : -1.0, hit.Normal.x, hit.Normal.y, hit.Normal.z, hit.Value,
                hit.Color.x, hit.TextureCoordinate.x, hit.Weights.x, static_cast<double>(hit.Brick),
                static_cast<double>(hit.Triangle) });
          }
        });
      const std::lock_guard<std::mutex> lock(guard);
      published->Segment->ForEachResident(
        [&](dsm::BlockId id, const std::byte* block, std::size_t bytes)
        { outcome.Blocks[id].assign(block, block + bytes); });
      const auto* nodes = reinterpret_cast<const std::byte*>(published->Bricks.GetNodes());
      outcome.Hierarchy.assign(nodes, nodes + published->Bricks.GetBytes());
      outcome.Hits = hits;
      outcome.Counters = store.GetCounters();
      EXPECT_EQ(outcome.Blocks.size() > 0, true);
    });
  return outcome;
}

void ExpectSame(const Outcome& a, const Outcome& b, const std::string& what)
{
  EXPECT_EQ(a.Blocks.size(), b.Blocks.size()) << what;
  EXPECT_TRUE(a.Blocks == b.Blocks) << what;
  EXPECT_TRUE(a.Hierarchy == b.Hierarchy) << what;
  ASSERT_EQ(a.Hits.size(), b.Hits.size());
  EXPECT_EQ(std::memcmp(a.Hits.data(), b.Hits.data(), a.Hits.size() * sizeof(double)), 0) << what;
}

/// The same bits on 1 to 4 ranks, in orders of these seeds.
void ExpectSameForAnyRanks(
  const Mesh& mesh, const Outcome& expected, std::initializer_list<unsigned> seeds)
{
  for (const int ranks : { 1, 2, 3, 4 })
  {
    for (const unsigned seed : seeds)
    {
      Setting setting;
      setting.Ranks = ranks;
      setting.Seed = seed;
      setting.Threads = ranks % 3 + 1;
      ExpectSame(expected, Publish(mesh, setting),
        std::to_string(ranks) + " ranks, order " + std::to_string(seed));
    }
  }
}

/// A blob with all attributes and with duplicates of some triangles that differ in their values and
/// edge flags.
Mesh CreateRichMesh()
{
  Mesh mesh = CreateBlob(3);
  const std::uint64_t points = mesh.GetPointCount();
  for (std::uint64_t point = 0; point < points; ++point)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      mesh.Normals.push_back(static_cast<float>(mesh.Positions[3 * point + axis]));
    }
    mesh.TextureCoordinates.insert(
      mesh.TextureCoordinates.end(), { 0.01f * point, 1.0f - 0.01f * point });
  }
  for (int copy = 0; copy < 300; ++copy)
  {
    mesh.Triangles.insert(mesh.Triangles.end(), mesh.Triangles.begin(), mesh.Triangles.begin() + 3);
  }
  mesh.ValuesOf = bricks::Attachment::Triangles;
  mesh.ColorsOf = bricks::Attachment::Triangles;
  for (std::uint64_t triangle = 0; triangle < mesh.GetTriangleCount(); ++triangle)
  {
    mesh.Values.push_back(static_cast<double>(triangle / 2));
    mesh.EdgeFlags.push_back(static_cast<std::uint8_t>(triangle % 8));
    mesh.Colors.insert(mesh.Colors.end(), { static_cast<std::uint8_t>(triangle / 2), 7, 8, 255 });
  }
  return mesh;
}

} // namespace

/// Histograms and boxes of bricks are more than a message carries, for a mesh that is large enough.
TEST(MeshDistribution, SameBitsWhenMessagesCarryLittle)
{
  const Mesh mesh = CreateRichMesh();
  const Outcome expected = Publish(mesh, {});
  for (const int ranks : { 1, 2, 3, 4 })
  {
    Setting setting;
    setting.Ranks = ranks;
    setting.PieceBytes = 256;
    ExpectSame(expected, Publish(mesh, setting), std::to_string(ranks) + " ranks");
  }
}

TEST(MeshDistribution, SameBitsForAnyRanksOrderAndThreads)
{
  const Mesh mesh = CreateRichMesh();
  const Outcome expected = Publish(mesh, {});
  EXPECT_GT(expected.Blocks.size(), 20u);
  EXPECT_GT(std::count_if(expected.Hits.begin(), expected.Hits.end(),
              [](double number) { return number == -1.0; }),
    0);
  ExpectSameForAnyRanks(mesh, expected, { 0u, 1u, 2u });
}

TEST(MeshDistribution, SameBitsOfTubesAndSpheres)
{
  const Mesh mesh = TestTubes::CreateTubes(120, 80, 1);
  const Outcome expected = Publish(mesh, {});
  EXPECT_GT(expected.Blocks.size(), 10u);
  ExpectSameForAnyRanks(mesh, expected, { 0u, 1u });
}

TEST(MeshDistribution, OneRankHasAllAndTheOthersNone)
{
  const Mesh mesh = CreateRichMesh();
  Setting setting;
  setting.Ranks = 3;
  setting.OneRankHasAll = true;
  ExpectSame(Publish(mesh, {}), Publish(mesh, setting), "last rank of 3");
}

TEST(MeshDistribution, CacheHoldsOneBrick)
{
  const Mesh mesh = CreateRichMesh();
  const Outcome expected = Publish(mesh, {});
  std::size_t largest = 0;
  for (const auto& [id, bytes] : expected.Blocks)
  {
    largest = std::max(largest, bytes.size());
  }
  Setting setting;
  setting.Ranks = 2;
  setting.Cache = dsm::AlignBlock(largest);
  const Outcome outcome = Publish(mesh, setting);
  ExpectSame(expected, outcome, "2 ranks, small cache");
  EXPECT_GT(outcome.Counters.Evictions, 0u);
  EXPECT_LE(outcome.Counters.PeakCachedBytes, setting.Cache);
}

TEST(MeshDistribution, TheStoreHoldsNothingButTheBricks)
{
  RunOnCluster(2,
    [](dsm::Messenger& messenger)
    {
      dsm::ObjectStore store(messenger, { CacheBytes, 1 });
      const Mesh piece = TakePart(CreateBlob(3), messenger.GetRank(), 2, 5);
      const auto published = bricks::PublishMesh("mesh", piece, {}, store, messenger);
      TraceOnWorker(store, messenger, [](dsm::ObjectStore::Worker&) {});
      EXPECT_EQ(store.GetCounters().ResidentBytes, published->Segment->GetResidentBytes());
    });
}

TEST(MeshDistribution, ProgressRisesToOne)
{
  RunOnCluster(2,
    [](dsm::Messenger& messenger)
    {
      dsm::ObjectStore store(messenger, { CacheBytes, 1 });
      const Mesh piece = TakePart(CreateBlob(4), messenger.GetRank(), 2, 5);
      double last = -1.0;
      bricks::PublishMesh("mesh", piece, {}, store, messenger,
        [&last](double done)
        {
          EXPECT_GE(done, last);
          last = done;
        });
      EXPECT_DOUBLE_EQ(last, 1.0);
    });
}
