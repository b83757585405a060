// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/BeamHistory.h"

#include <gtest/gtest.h>

namespace
{

using rt::BeamHistory;
constexpr int Edge = BeamHistory::Edge;

} // namespace

TEST(BeamHistory, NothingKnownPredictsNothing)
{
  const BeamHistory history(100, 50, 2);
  EXPECT_EQ(history.Predict(0, 0, 0), 0u);
  EXPECT_EQ(history.Predict(99, 49, 1), 0u);
}

TEST(BeamHistory, BeamsForetellTheirNeighboursOfTheSameObject)
{
  BeamHistory history(10 * Edge, 10 * Edge, 2);
  history.Record(5 * Edge, 5 * Edge, 1, 3);
  for (int row = 0; row < 10; ++row)
  {
    for (int column = 0; column < 10; ++column)
    {
      const bool isNear = row >= 4 && row <= 6 && column >= 4 && column <= 6;
      EXPECT_EQ(history.Predict(column * Edge + 3, row * Edge + 15, 1), isNear ? 3u : 0u);
      EXPECT_EQ(history.Predict(column * Edge, row * Edge, 0), 0u);
    }
  }
}

TEST(BeamHistory, MeanIsOfThoseAround)
{
  BeamHistory history(3 * Edge, Edge, 1);
  history.Record(0, 0, 0, 0);
  history.Record(Edge, 0, 0, 4);
  history.Record(2 * Edge, 0, 0, 14);
  EXPECT_EQ(history.Predict(0, 0, 0), 2u);
  EXPECT_EQ(history.Predict(Edge, 0, 0), 6u);
  EXPECT_EQ(history.Predict(2 * Edge, 0, 0), 9u);
}

TEST(BeamHistory, PartsOfABeamCountAsTheDeepest)
{
  BeamHistory history(Edge, Edge, 1);
  history.Record(0, 0, 0, 5);
  history.Record(8, 8, 0, 2);
  EXPECT_EQ(history.Predict(0, 0, 0), 5u);
}

TEST(BeamHistory, TheLastFrameCountsUntilABeamIsTraced)
{
  BeamHistory first(Edge, Edge, 1);
  first.Record(0, 0, 0, 6);
  const BeamHistory unseen(Edge, Edge, 1, &first); // another rank traced it
  BeamHistory third(Edge, Edge, 1, &unseen);
  EXPECT_EQ(third.Predict(0, 0, 0), 6u);
  third.Record(0, 0, 0, 1);
  EXPECT_EQ(third.Predict(0, 0, 0), 1u);
  EXPECT_EQ(BeamHistory(Edge, Edge, 1, &third).Predict(0, 0, 0), 1u);
}

TEST(BeamHistory, AnotherSizeOrNumberOfObjectsBeginsAnew)
{
  BeamHistory last(2 * Edge, Edge, 1);
  last.Record(0, 0, 0, 6);
  EXPECT_EQ(BeamHistory(3 * Edge, Edge, 1, &last).Predict(0, 0, 0), 0u);
  EXPECT_EQ(BeamHistory(2 * Edge, 2 * Edge, 1, &last).Predict(0, 0, 0), 0u);
  EXPECT_EQ(BeamHistory(2 * Edge, Edge, 2, &last).Predict(0, 0, 0), 0u);
}

TEST(BeamHistory, VeryDeepBeamsAreCutOff)
{
  BeamHistory history(1, 1, 1);
  history.Record(0, 0, 0, 1000);
  EXPECT_EQ(history.Predict(0, 0, 0), 254u);
}
