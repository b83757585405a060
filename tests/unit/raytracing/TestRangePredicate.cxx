// SPDX-License-Identifier: BSD-3-Clause
// The walks over macrocells leave out nothing but what the predicate does not want, whatever it is.
#include "DSMRayTracing/field/ValuePredicates.h"
#include "DSMRayTracing/field/grid/BrickWalk.h"
#include "DSMRayTracing/field/lattice/BeamDescent.h"
#include "RandomRays.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace
{

const bricks::Index3 WalkedCells(67, 45, 90);
constexpr int Edge = 3;

bricks::MacrocellHierarchy CreateHierarchy()
{
  const bricks::BrickLattice lattice(
    WalkedCells + bricks::Index3(1), bricks::ScalarType::Float32, false, Edge);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  std::vector<bricks::ValueRange> ranges(lattice.GetBrickCount());
  for (bricks::ValueRange& range : ranges)
  {
    range.First = uniform(random);
    range.Last = range.First + 0.1f * uniform(random);
    if (range.First < 0.3f)
    {
      range = { 1.0f, 0.0f }; // no data
    }
  }
  return bricks::MacrocellHierarchy(lattice, std::move(ranges));
}

bool IsAnywhere(const bricks::ValueRange&)
{
  return true;
}

/// As of a medium that can be seen where values are large.
bool IsLarge(const bricks::ValueRange& range)
{
  return range.First <= range.Last && range.Last > 0.97f;
}

template <class Predicate>
std::vector<dsm::BlockId> Walk(const bricks::MacrocellHierarchy& hierarchy, const rt::GridRay& line,
  double enter, double leave, const Predicate& mayHold)
{
  std::vector<dsm::BlockId> ids;
  rt::BrickWalk<Predicate> walk(hierarchy, line, mayHold, enter, leave);
  while (walk.Next())
  {
    ids.push_back(walk.GetId());
  }
  return ids;
}

template <class Predicate>
std::vector<dsm::BlockId> Descend(
  const bricks::MacrocellHierarchy& hierarchy, const rt::RayBeam& beam, const Predicate& mayHold)
{
  std::vector<dsm::BlockId> ids;
  for (const auto& brick : rt::BeamDescent<Predicate>(hierarchy, mayHold, beam).Find().Bricks)
  {
    ids.push_back(brick.Id);
  }
  return ids;
}

template <class Predicate>
std::vector<dsm::BlockId> Filter(const bricks::MacrocellHierarchy& hierarchy,
  const std::vector<dsm::BlockId>& ids, const Predicate& mayHold)
{
  std::vector<dsm::BlockId> kept;
  for (const dsm::BlockId id : ids)
  {
    if (mayHold(hierarchy.GetLevels().front().Ranges[id]))
    {
      kept.push_back(id);
    }
  }
  return kept;
}

} // namespace

TEST(TestRangePredicate, RaysMeetTheBricksThatItWants)
{
  const bricks::MacrocellHierarchy hierarchy = CreateHierarchy();
  const std::vector<double> isovalues{ 0.35, 0.5, 0.9 };
  const rt::IsovaluePredicate mayHold(isovalues);
  RandomRays generator(WalkedCells, 3);
  std::size_t bricks[2] = { 0, 0 };
  for (int i = 0; i < 700; ++i)
  {
    const rt::Ray ray = generator.Create(
      static_cast<RandomRays::Kind>(i % static_cast<int>(RandomRays::Kind::Count)));
    rt::GridRay line;
    double enter = ray.Min;
    double leave = ray.Max;
    ASSERT_TRUE(line.Set(&ray.Origin.x, &ray.Direction.x));
    if (!line.Clip(WalkedCells, enter, leave))
    {
      continue;
    }
    const auto all = Walk(hierarchy, line, enter, leave, IsAnywhere);
    const auto large = Walk(hierarchy, line, enter, leave, IsLarge);
    const auto surface = Walk(hierarchy, line, enter, leave, mayHold);
    ASSERT_EQ(large, Filter(hierarchy, all, IsLarge));
    ASSERT_EQ(surface, Filter(hierarchy, all, mayHold));
    bricks[0] += large.size();
    bricks[1] += surface.size();
  }
  EXPECT_GT(bricks[0], 100u);
  EXPECT_GT(bricks[1], 100u);
}

TEST(TestRangePredicate, BeamsMeetTheBricksThatItWants)
{
  const bricks::MacrocellHierarchy hierarchy = CreateHierarchy();
  const std::vector<double> isovalues{ 0.35, 0.5, 0.9 };
  const rt::IsovaluePredicate mayHold(isovalues);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::size_t bricks[2] = { 0, 0 };
  for (int i = 0; i < 100; ++i)
  {
    const double direction[3] = { uniform(random), uniform(random), uniform(random) };
    rt::GridRay lines[4];
    for (int corner = 0; corner < 4; ++corner)
    {
      const double across[2] = { corner == 1 || corner == 2 ? 4.0 : 0.0, corner > 1 ? 4.0 : 0.0 };
      const double origin[3] = { 0.5 * WalkedCells.x - 100.0 * direction[0] + across[0],
        0.5 * WalkedCells.y - 100.0 * direction[1] + across[1],
        0.5 * WalkedCells.z - 100.0 * direction[2] };
      ASSERT_TRUE(lines[corner].Set(origin, direction));
    }
    rt::RayBeam beam;
    if (!beam.Set(lines))
    {
      continue;
    }
    const auto all = Descend(hierarchy, beam, IsAnywhere);
    const auto large = Descend(hierarchy, beam, IsLarge);
    const auto surface = Descend(hierarchy, beam, mayHold);
    ASSERT_EQ(large, Filter(hierarchy, all, IsLarge));
    ASSERT_EQ(surface, Filter(hierarchy, all, mayHold));
    bricks[0] += large.size();
    bricks[1] += surface.size();
  }
  EXPECT_GT(bricks[0], 100u);
  EXPECT_GT(bricks[1], 100u);
}
