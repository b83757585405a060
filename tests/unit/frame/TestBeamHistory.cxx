// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/BeamHistory.h"

#include <gtest/gtest.h>

#include <numeric>

namespace
{

using rt::BeamHistory;
using Ids = std::vector<dsm::BlockId>;

constexpr int Edge = BeamHistory::Edge;

/// Bricks 100, 101, ..., of which rays have come to the first `reached`.
rt::BeamBricks CreateBeam(std::size_t count, std::size_t reached = 0)
{
  rt::BeamBricks beam;
  beam.Usable = true;
  beam.Bricks.resize(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    beam.Bricks[i].Id = static_cast<dsm::BlockId>(100 + i);
  }
  beam.Reached = reached;
  return beam;
}

Ids GetFirst(std::size_t count)
{
  Ids ids(count);
  std::iota(ids.begin(), ids.end(), 100);
  return ids;
}

} // namespace

TEST(BeamHistory, NothingKnownPredictsNothing)
{
  const BeamHistory history(100, 50, 2);
  EXPECT_EQ(history.Predict(0, 0, 0, CreateBeam(9)), Ids());
  EXPECT_EQ(history.Predict(99, 49, 1, CreateBeam(9)), Ids());
}

TEST(BeamHistory, BeamsForetellTheirNeighboursOfTheSameObject)
{
  BeamHistory history(10 * Edge, 10 * Edge, 2);
  history.Record(5 * Edge, 5 * Edge, 1, CreateBeam(9, 3));
  for (int row = 0; row < 10; ++row)
  {
    for (int column = 0; column < 10; ++column)
    {
      const bool isNear = row >= 4 && row <= 6 && column >= 4 && column <= 6;
      EXPECT_EQ(history.Predict(column * Edge + 3, row * Edge + 15, 1, CreateBeam(9)),
        GetFirst(isNear ? 3 : 0));
      EXPECT_EQ(history.Predict(column * Edge, row * Edge, 0, CreateBeam(9)), Ids());
    }
  }
  EXPECT_EQ(history.Predict(5 * Edge, 5 * Edge, 1, CreateBeam(2)), GetFirst(2)) << "a shorter list";
}

TEST(BeamHistory, TheMeanCounts)
{
  BeamHistory history(3 * Edge, Edge, 1);
  history.Record(0, 0, 0, CreateBeam(20, 0));
  history.Record(Edge, 0, 0, CreateBeam(20, 4));
  history.Record(2 * Edge, 0, 0, CreateBeam(20, 14));
  EXPECT_EQ(history.Predict(0, 0, 0, CreateBeam(20)), GetFirst(2));
  EXPECT_EQ(history.Predict(Edge, 0, 0, CreateBeam(20)), GetFirst(6));
  EXPECT_EQ(history.Predict(2 * Edge, 0, 0, CreateBeam(20)), GetFirst(9));
}

TEST(BeamHistory, PartsOfABeamCountAsTheDeepest)
{
  BeamHistory history(Edge, Edge, 1);
  history.Record(0, 0, 0, CreateBeam(20, 5));
  history.Record(8, 8, 0, CreateBeam(20, 2));
  EXPECT_EQ(history.Predict(0, 0, 0, CreateBeam(20)), GetFirst(5));
}

TEST(BeamHistory, TheLastFrameCountsUntilABeamIsTraced)
{
  BeamHistory first(Edge, Edge, 1);
  first.Record(0, 0, 0, CreateBeam(9, 6));
  const BeamHistory unseen(Edge, Edge, 1, &first); // another rank traced it
  BeamHistory third(Edge, Edge, 1, &unseen);
  EXPECT_EQ(third.Predict(0, 0, 0, CreateBeam(9)), GetFirst(6));
  third.Record(0, 0, 0, CreateBeam(9, 1));
  EXPECT_EQ(third.Predict(0, 0, 0, CreateBeam(9)), GetFirst(1));
  EXPECT_EQ(BeamHistory(Edge, Edge, 1, &third).Predict(0, 0, 0, CreateBeam(9)), GetFirst(1));
}

TEST(BeamHistory, AnotherSizeOrNumberOfObjectsBeginsAnew)
{
  BeamHistory last(2 * Edge, Edge, 1);
  last.Record(0, 0, 0, CreateBeam(9, 6));
  EXPECT_EQ(BeamHistory(3 * Edge, Edge, 1, &last).Predict(0, 0, 0, CreateBeam(9)), Ids());
  EXPECT_EQ(BeamHistory(2 * Edge, 2 * Edge, 1, &last).Predict(0, 0, 0, CreateBeam(9)), Ids());
  EXPECT_EQ(BeamHistory(2 * Edge, Edge, 2, &last).Predict(0, 0, 0, CreateBeam(9)), Ids());
}

TEST(BeamHistory, VeryDeepBeamsAreCutOff)
{
  BeamHistory history(1, 1, 1);
  history.Record(0, 0, 0, CreateBeam(1000, 1000));
  EXPECT_EQ(history.Predict(0, 0, 0, CreateBeam(1000)), GetFirst(254));
}
