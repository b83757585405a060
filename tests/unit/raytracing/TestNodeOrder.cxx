// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/field/lattice/NodeOrder.h"

#include <gtest/gtest.h>

#include <cstdint>

TEST(TestNodeOrder, CountsInTheDirectionOfTheRays)
{
  for (int sides = 0; sides < 8; ++sides)
  {
    const bool forward[3] = { (sides & 1) != 0, (sides & 2) != 0, (sides & 4) != 0 };
    const rt::NodeOrder order(forward);
    for (int node = 0; node < 64; ++node)
    {
      int expected = 0;
      for (int axis = 0; axis < 3; ++axis)
      {
        const int place = node >> (2 * axis) & 3;
        expected |= (forward[axis] ? place : 3 - place) << (2 * axis);
      }
      EXPECT_EQ(order.Turn(node), expected);
      EXPECT_EQ(order.Turn(expected), node);
    }
  }
}

TEST(TestNodeOrder, TurnsEveryNodeOfAWord)
{
  std::uint64_t word = 0x243f6a8885a308d3u;
  for (int round = 0; round < 200; ++round)
  {
    word = word * 6364136223846793005u + 1442695040888963407u;
    const bool forward[3] = { round % 2 == 0, round / 2 % 2 == 0, round / 4 % 2 == 0 };
    const rt::NodeOrder order(forward);
    std::uint64_t expected = 0;
    for (int node = 0; node < 64; ++node)
    {
      expected |= (word >> node & 1) << order.Turn(node);
    }
    EXPECT_EQ(order.TurnAll(word), expected);
    EXPECT_EQ(order.TurnAll(expected), word);
  }
}
