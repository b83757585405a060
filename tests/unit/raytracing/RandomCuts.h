// SPDX-License-Identifier: BSD-3-Clause
#ifndef RandomCuts_h
#define RandomCuts_h

#include "DSMBricks/base/Box.h"

#include <algorithm>
#include <random>
#include <vector>

/// Cuts a box at random planes until `cuts` are made; pieces may be one cell thick.
inline std::vector<bricks::Box> CutAtRandom(
  const bricks::Box& whole, int cuts, std::mt19937& random)
{
  std::vector<bricks::Box> boxes{ whole };
  for (int cut = 0; cut < cuts; ++cut)
  {
    const std::size_t which = random() % boxes.size();
    const int axis = static_cast<int>(random() % 3);
    const std::int64_t size = boxes[which].GetSize()[axis];
    if (size < 2)
    {
      continue;
    }
    const std::int64_t plane = boxes[which].Min[axis] + 1 + random() % (size - 1);
    bricks::Box upper = boxes[which];
    boxes[which].Max[axis] = plane;
    upper.Min[axis] = plane;
    boxes.push_back(upper);
  }
  std::shuffle(boxes.begin(), boxes.end(), random);
  return boxes;
}

#endif
