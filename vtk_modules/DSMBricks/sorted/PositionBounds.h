// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_PositionBounds_h
#define bricks_PositionBounds_h

#include "DSMBricks/base/ParallelFor.h"

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace bricks
{

/// Bounds of positions in the dataset's space; Lower > Upper: there are none. Plain.
struct PositionBounds
{
  glm::dvec3 Lower{ std::numeric_limits<double>::infinity() };
  glm::dvec3 Upper{ -std::numeric_limits<double>::infinity() };

  bool IsEmpty() const { return this->Lower.x > this->Upper.x; }
  void Add(const glm::dvec3& position)
  {
    this->Lower = glm::min(this->Lower, position);
    this->Upper = glm::max(this->Upper, position);
  }
  void Add(const PositionBounds& other)
  {
    this->Lower = glm::min(this->Lower, other.Lower);
    this->Upper = glm::max(this->Upper, other.Upper);
  }
};

/// Joins the bounds of all items [0, count): add(item, bounds) adds those of one item. Called by `threads` threads.
template <class AddItem>
PositionBounds FindPositionBounds(int threads, std::uint64_t count, const AddItem& add)
{
  constexpr std::size_t chunkSize = std::size_t(1) << 16;
  std::vector<PositionBounds> ofThread(static_cast<std::size_t>(std::max(threads, 1)));
  ParallelForChunks(static_cast<int>(ofThread.size()), count, chunkSize,
    [&](std::size_t begin, std::size_t end, std::size_t, int thread)
    {
      PositionBounds bounds;
      for (std::size_t item = begin; item < end; ++item)
      {
        add(item, bounds);
      }
      ofThread[static_cast<std::size_t>(thread)].Add(bounds);
    });
  PositionBounds all;
  for (const PositionBounds& bounds : ofThread)
  {
    all.Add(bounds);
  }
  return all;
}

} // namespace bricks

#endif
