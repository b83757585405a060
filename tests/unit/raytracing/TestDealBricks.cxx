// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/layout/DealBricks.h"

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
std::vector<int> Count(const rt::BrickLattice& lattice, const dsm::BlockAssigner& assigner,
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
  const rt::BrickLattice lattice(rt::Index3(257), rt::ScalarType::Float32, false, 16);
  const dsm::BlockAssigner assigner = rt::DealBricks(lattice, rt::Index3(64), rt::Index3(0), 3);
  std::map<rt::Index3, int, bool (*)(const rt::Index3&, const rt::Index3&)> owners(
    [](const rt::Index3& a, const rt::Index3& b)
    { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
  for (dsm::BlockId id = 0; id < lattice.GetBrickCount(); ++id)
  {
    const rt::Index3 chunk = lattice.GetCellsOfBrick(id).Min / rt::Index3(64);
    EXPECT_EQ(owners.emplace(chunk, assigner.GetOwner(id)).first->second, assigner.GetOwner(id));
  }
  EXPECT_EQ(owners.size(), 64u);
}

TEST(DealBricks, APartThatBeginsWithinAChunkIsCutWhereTheChunksAre)
{
  const rt::BrickLattice lattice(rt::Index3(193), rt::ScalarType::Float32, false, 16);
  const dsm::BlockAssigner assigner =
    rt::DealBricks(lattice, rt::Index3(64), rt::Index3(48, 0, 0), 2);
  std::set<int> owners;
  for (int x = 1; x < 5; ++x)
  {
    owners.insert(assigner.GetOwner(lattice.GetId({ x, 0, 0 })));
  }
  EXPECT_EQ(owners.size(), 1u) << "these four are in the second chunk";
}

TEST(DealBricks, SurfacesAreBalanced)
{
  const rt::BrickLattice lattice(rt::Index3(513), rt::ScalarType::Float32, false, 16);
  const rt::Index3 middle = lattice.GetBricks() / rt::Index3(2);
  for (const std::int64_t chunk : { 16, 32, 64 })
  {
    for (const int ranks : { 1, 2, 3, 4, 7, 16 })
    {
      const dsm::BlockAssigner assigner =
        rt::DealBricks(lattice, rt::Index3(chunk), rt::Index3(0), ranks);
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
      check(1.1, [](const rt::Index3&) { return true; });
      const double few = ranks > 7 ? 1.6 : 1.35;
      check(few,
        [&](const rt::Index3& brick)
        {
          const rt::Index3 from = brick - middle;
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
    const rt::BrickLattice lattice(rt::Index3(100), rt::ScalarType::Float32, false, 16);
    for (const int ranks : { 1, 2, 4, 30 })
    {
      // One chunk of all, and chunks that are layers.
      for (const rt::Index3& chunk : { rt::Index3(100), rt::Index3(100, 100, 1), rt::Index3(edge) })
      {
        const dsm::BlockAssigner assigner = rt::DealBricks(lattice, chunk, rt::Index3(0), ranks);
        const std::vector<int> counts =
          Count(lattice, assigner, ranks, [](const rt::Index3&) { return true; });
        EXPECT_GT(*std::min_element(counts.begin(), counts.end()), 0)
          << chunk.x << " " << chunk.z << " " << ranks;
      }
    }
  }
}

} // namespace
