// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/layout/DealBricks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

namespace
{

/// The bricks that each rank has, of those that `wanted` says.
template <class Wanted>
std::vector<int> Count(const bricks::BrickLattice& lattice, const dsm::BlockAssigner& assigner,
  int ranks, const Wanted& wanted)
{
  std::vector<int> counts(static_cast<std::size_t>(ranks), 0);
  for (dsm::BlockId id = 0; id < lattice.GetBrickCount(); ++id)
  {
    if (wanted(lattice.GetBrick(id)))
    {
      ++counts.at(static_cast<std::size_t>(assigner.GetOwner(id)));
    }
  }
  return counts;
}

TEST(DealBricks, AChunkBelongsToOneRank)
{
  const bricks::BrickLattice lattice(bricks::Index3(257), bricks::ScalarType::Float32, false, 16);
  const dsm::BlockAssigner assigner =
    bricks::DealBricks(lattice, bricks::Index3(64), bricks::Index3(0), 3);
  std::map<bricks::Index3, int, bool (*)(const bricks::Index3&, const bricks::Index3&)> owners(
    [](const bricks::Index3& a, const bricks::Index3& b)
    { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
  for (dsm::BlockId id = 0; id < lattice.GetBrickCount(); ++id)
  {
    const bricks::Index3 chunk = lattice.GetCellsOfBrick(id).Min / bricks::Index3(64);
    EXPECT_EQ(owners.emplace(chunk, assigner.GetOwner(id)).first->second, assigner.GetOwner(id));
  }
  EXPECT_EQ(owners.size(), 64u);
}

TEST(DealBricks, APartThatBeginsWithinAChunkIsCutWhereTheChunksAre)
{
  const bricks::BrickLattice lattice(bricks::Index3(193), bricks::ScalarType::Float32, false, 16);
  const dsm::BlockAssigner assigner =
    bricks::DealBricks(lattice, bricks::Index3(64), bricks::Index3(48, 0, 0), 2);
  std::set<int> owners;
  for (int x = 1; x < 5; ++x)
  {
    owners.insert(assigner.GetOwner(lattice.GetId({ x, 0, 0 })));
  }
  EXPECT_EQ(owners.size(), 1u) << "these four are in the second chunk";
}

TEST(DealBricks, SurfacesAreBalanced)
{
  const bricks::BrickLattice lattice(bricks::Index3(513), bricks::ScalarType::Float32, false, 16);
  const bricks::Index3 middle = lattice.GetBricks() / bricks::Index3(2);
  for (const std::int64_t chunk : { 16, 32, 64 })
  {
    for (const int ranks : { 1, 2, 3, 4, 7, 16 })
    {
      const dsm::BlockAssigner assigner =
        bricks::DealBricks(lattice, bricks::Index3(chunk), bricks::Index3(0), ranks);
      const auto check = [&](double worst, const auto& wanted)
      {
        const std::vector<int> counts = Count(lattice, assigner, ranks, wanted);
        double sum = 0.0;
        for (const int count : counts)
        {
          sum += count;
        }
        EXPECT_LE(*std::max_element(counts.begin(), counts.end()), worst * sum / ranks)
          << chunk << " samples, " << ranks << " ranks";
      };
      check(1.1, [](const bricks::Index3&) { return true; });
      const double few = ranks > 7 ? 1.6 : 1.35;
      check(few,
        [&](const bricks::Index3& brick)
        {
          const bricks::Index3 from = brick - middle;
          const double far = std::sqrt(double(from.x * from.x + from.y * from.y + from.z * from.z));
          return far > 11.0 && far < 12.5;
        });
    }
  }
}

TEST(DealBricks, EachRankHasSomeOfASmallVolume)
{
  for (const int edge : { 16, 50 })
  {
    const bricks::BrickLattice lattice(bricks::Index3(100), bricks::ScalarType::Float32, false, 16);
    for (const int ranks : { 1, 2, 4, 30 })
    {
      // One chunk of all, and chunks that are layers.
      for (const bricks::Index3& chunk :
        { bricks::Index3(100), bricks::Index3(100, 100, 1), bricks::Index3(edge) })
      {
        const dsm::BlockAssigner assigner =
          bricks::DealBricks(lattice, chunk, bricks::Index3(0), ranks);
        const std::vector<int> counts =
          Count(lattice, assigner, ranks, [](const bricks::Index3&) { return true; });
        EXPECT_GT(*std::min_element(counts.begin(), counts.end()), 0)
          << chunk.x << " " << chunk.z << " " << ranks;
      }
    }
  }
}

} // namespace
