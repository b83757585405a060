// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/levels/LevelHierarchy.h"

#include "DSMBricks/accel/BoundingBox.h"
#include "DSMBricks/accel/BrickBvh.h"

#include <cmath>
#include <limits>
#include <utility>

namespace bricks
{

namespace
{

/// Rounded outward.
BoundingBox GetBox(const LevelLattice& lattice, const LevelBrick& brick)
{
  const glm::dvec3 scale(lattice.GetScales().Get(brick.Level));
  const glm::dvec3 lower = glm::dvec3(brick.Cells.Min) / scale;
  const glm::dvec3 upper = glm::dvec3(brick.Cells.Max) / scale;
  constexpr float infinity = std::numeric_limits<float>::infinity();
  float below[4] = {};
  float above[4] = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    below[axis] = std::nextafter(static_cast<float>(lower[axis]), -infinity);
    above[axis] = std::nextafter(static_cast<float>(upper[axis]), infinity);
  }
  BoundingBox box;
  box.Add(Float4::Load(below));
  box.Add(Float4::Load(above));
  return box;
}

} // namespace

LevelHierarchy::LevelHierarchy(const LevelLattice& lattice, std::vector<ValueRange> ranges)
  : Ranges(std::move(ranges))
{
  std::vector<BoundingBox> boxes;
  boxes.reserve(lattice.GetBricks().size());
  for (const LevelBrick& brick : lattice.GetBricks())
  {
    boxes.push_back(GetBox(lattice, brick));
  }
  for (const ValueRange& range : this->Ranges)
  {
    this->All.Add(range);
  }
  const BrickBvh tree(boxes);
  const std::vector<BrickBvh::Node> nodes(
    tree.GetNodes(), tree.GetNodes() + tree.GetBytes() / sizeof(BrickBvh::Node));
  this->Nodes =
    AddRanges(nodes, [this](std::uint32_t leaf) { return this->GetRange(GetBrick(leaf)); });
}

} // namespace bricks
