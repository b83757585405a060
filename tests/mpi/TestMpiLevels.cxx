// SPDX-License-Identifier: BSD-3-Clause
// Leaves of several levels: bricks and pictures do not depend on which rank has which leaves.
#include "tests/support/LevelModel.h"
#include "tests/support/LoopbackCluster.h"
#include "tests/support/PictureHash.h"

#include "DSMBricks/base/ByteHash.h"
#include "DSMBricks/levels/PublishLevels.h"
#include "DSMCore/base/Error.h"
#include "DSMCore/store/BlockStore.h"
#include "DSMCore/transport/MpiTransport.h"
#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/frame/FrameRenderer.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <map>
#include <string>

namespace
{

using bricks::Index3;
/// From the number of a group of leaves, and that of ranks, to the rank that has it.
using Deal = std::function<int(std::int64_t, int)>;

LevelModel CreateModel(unsigned seed)
{
  LevelModel model = CreateRandomLevels(seed, seed % 2 == 1);
  model.OfPoints = seed % 4 >= 2;
  model.Function = [](int, const glm::dvec3& place)
  { return std::sin(2.0 * place.x) + std::cos(3.0 * place.y) * std::sin(1.0 + place.z); };
  return model;
}

struct Outcome
{
  std::map<dsm::BlockId, std::uint64_t> Bricks; ///< hashes of those of this rank
  std::uint64_t Picture = 0;
};

Outcome Trace(const LevelModel& model, const Deal& deal, dsm::Messenger& messenger,
  dsm::MemoryOrganization organization)
{
  dsm::BlockStore::Settings settings;
  settings.Organization = organization;
  settings.CacheBytes = std::size_t(4) << 20;
  settings.HostSharing = false;
  dsm::BlockStore store(messenger, settings);
  const LevelModelSource source(model,
    [&](int level, const Index3& cell)
    {
      const Index3 part = cell / Index3(3);
      return deal(part.x + 5 * part.y + 7 * part.z + level, messenger.GetSize()) ==
        messenger.GetRank();
    });
  const bricks::LevelLattice lattice = bricks::DivideLevels(
    "levels", bricks::LevelScales(model.Scales), model.Type, source, messenger);
  const auto levels = bricks::PublishLevels(
    "levels", lattice, source, store, messenger, dsm::BlockStore::Place::Memory, 1);
  Outcome outcome;
  levels->Segment->ForEachResident(
    [&](dsm::BlockId id, const std::byte* block, std::size_t bytes)
    {
      bricks::ByteHash hash;
      hash.Add(block, bytes);
      outcome.Bricks[id] = hash.Get();
    });
  rt::Scene scene;
  scene.Lights.emplace_back();
  scene.Transport.Shadows = true;
  rt::LevelIsosurface object;
  object.Field.Voxels = levels;
  object.Isovalues = { -0.4, 0.5 };
  object.Look.Surface.Opacity = 0.6f;
  scene.Objects.push_back(object);
  rt::FrameRequest request;
  request.Width = 67;
  request.Height = 53;

  request.WorldToClip = glm::perspective(glm::radians(30.0), 67.0 / 53.0, 1.0, 100.0) *
    glm::lookAt(glm::dvec3(9.0, 8.0, 14.0), 0.5 * glm::dvec3(model.Roots), glm::dvec3(0, 1, 0));
  rt::FrameRenderer renderer(messenger);
  outcome.Picture =
    GetPictureHash(rt::GatherFrame(messenger, renderer.Render(store, scene, request)));
  return outcome;
}

/// Fails on one rank, when it reads a cube for the first or the second time.
class FailingSource final : public bricks::LevelSource
{
public:
  FailingSource(const bricks::LevelSource& source, std::size_t calls)
    : Source(source)
    , Left(calls)
  {
  }
  const std::vector<bricks::LevelCube>& GetCubes() const override
  {
    return this->Source.GetCubes();
  }
  bool IsOfPoints() const override { return this->Source.IsOfPoints(); }
  void ReadCube(std::size_t number, double* values, std::uint8_t* isLeaf) const override
  {
    if (this->Left-- == 0)
    {
      throw dsm::Error("The values are gone.");
    }
    this->Source.ReadCube(number, values, isLeaf);
  }

private:
  const bricks::LevelSource& Source;
  mutable std::size_t Left;
};

} // namespace

TEST(LevelsOverMpi, BricksAndPicturesEqualThoseOfOneRank)
{
  dsm::Messenger messenger(dsm::MpiTransport::Create(nullptr));
  const std::map<std::string, Deal> deals{
    { "scattered", [](std::int64_t part, int ranks) { return static_cast<int>(part % ranks); } },
    { "reversed",
      [](std::int64_t part, int ranks) { return ranks - 1 - static_cast<int>(part % ranks); } },
    { "all on the last rank", [](std::int64_t, int ranks) { return ranks - 1; } },
    { "none on the first rank",
      [](std::int64_t part, int ranks)
      { return ranks == 1 ? 0 : 1 + static_cast<int>(part % (ranks - 1)); } }
  };
  for (unsigned seed = 0; seed < 4; ++seed)
  {
    const LevelModel model = CreateModel(seed);
    Outcome expected;
    RunOnCluster(1,
      [&](dsm::Messenger& alone)
      {
        expected = Trace(
          model, [](std::int64_t, int) { return 0; }, alone, dsm::MemoryOrganization::Replicated);
      });
    for (const auto& [name, deal] : deals)
    {
      for (const auto organization : { dsm::MemoryOrganization::Replicated,
             dsm::MemoryOrganization::ObjectBased, dsm::MemoryOrganization::PageBased })
      {
        SCOPED_TRACE(name + ", model " + std::to_string(seed));
        const Outcome outcome = Trace(model, deal, messenger, organization);
        EXPECT_EQ(outcome.Picture, expected.Picture);
        EXPECT_FALSE(outcome.Bricks.empty());
        for (const auto& [id, hash] : outcome.Bricks)
        {
          EXPECT_EQ(hash, expected.Bricks.at(id)) << "brick " << id;
        }
      }
    }
  }
}

TEST(LevelsOverMpi, AFailureOfOneRankFailsAll)
{
  dsm::Messenger messenger(dsm::MpiTransport::Create(nullptr));
  dsm::BlockStore store(messenger, {});
  const LevelModel model = CreateModel(1);
  const LevelModelSource source(model,
    [&](int, const Index3& cell) { return cell.x % messenger.GetSize() == messenger.GetRank(); });
  const bricks::LevelLattice lattice = bricks::DivideLevels(
    "levels", bricks::LevelScales(model.Scales), model.Type, source, messenger);
  for (const std::size_t calls : { std::size_t(0), source.GetCubes().size() })
  {
    const bool fails = messenger.GetRank() == messenger.GetSize() - 1;
    const FailingSource failing(source, fails ? calls : std::numeric_limits<std::size_t>::max());
    try
    {
      bricks::PublishLevels(
        "levels", lattice, failing, store, messenger, dsm::BlockStore::Place::Memory, 1);
      ADD_FAILURE() << "nothing failed";
    }
    catch (const dsm::Error& error)
    {
      EXPECT_NE(std::string(error.what()).find("The values are gone."), std::string::npos)
        << error.what();
    }
  }
  // The store can be used on.
  EXPECT_TRUE(bricks::PublishLevels(
    "levels", lattice, source, store, messenger, dsm::BlockStore::Place::Memory, 1));
}
