// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/surface/BlockLooks.h"

#include "DSMRayTracing/object/ObjectDigest.h"

#include <glm/vector_relational.hpp>

#include <algorithm>

namespace rt
{

namespace
{

/// So many blocks are asked one after the other.
constexpr std::size_t MostTogether = 4;

bool Holds(const bricks::Box& box, const bricks::Index3& cell)
{
  return glm::all(glm::lessThanEqual(box.Min, cell)) && glm::all(glm::lessThan(cell, box.Max));
}

int FindLongestAxis(const bricks::Index3& size)
{
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

} // namespace

BlockLooks::BlockLooks(std::vector<Block> blocks)
  : Blocks(std::move(blocks))
{
  this->Blocks.erase(std::remove_if(this->Blocks.begin(), this->Blocks.end(),
                       [](const Block& block) { return block.Cells.IsEmpty(); }),
    this->Blocks.end());
  if (!this->Blocks.empty())
  {
    this->Build(0, this->Blocks.size());
  }
}

void BlockLooks::Build(std::size_t first, std::size_t last)
{
  const std::size_t number = this->Nodes.size();
  Node node{ this->Blocks[first].Cells, first, last, 0 };
  for (std::size_t index = first; index < last; ++index)
  {
    node.Cells.Min = glm::min(node.Cells.Min, this->Blocks[index].Cells.Min);
    node.Cells.Max = glm::max(node.Cells.Max, this->Blocks[index].Cells.Max);
  }
  this->Nodes.push_back(node);
  if (last - first <= MostTogether)
  {
    return;
  }
  const int axis = FindLongestAxis(node.Cells.GetSize());
  const std::size_t middle = (first + last) / 2;
  const auto at = [this](std::size_t index)
  { return this->Blocks.begin() + static_cast<std::ptrdiff_t>(index); };
  std::nth_element(at(first), at(middle), at(last),
    [axis](const Block& a, const Block& b) { return a.Cells.Min[axis] < b.Cells.Min[axis]; });
  this->Build(first, middle);
  this->Nodes[number].Second = this->Nodes.size();
  this->Build(middle, last);
}

const BlockLooks::Look* BlockLooks::Find(const bricks::Index3& cell) const
{
  // As many as halvings of 2^64 blocks.
  std::size_t waiting[64] = { 0 };
  std::size_t count = this->Nodes.empty() ? 0 : 1;
  while (count > 0)
  {
    const std::size_t number = waiting[--count];
    const Node& node = this->Nodes[number];
    if (!Holds(node.Cells, cell))
    {
      continue;
    }
    if (node.Second > 0)
    {
      waiting[count++] = node.Second;
      waiting[count++] = number + 1;
      continue;
    }
    for (std::size_t index = node.First; index < node.Last; ++index)
    {
      if (Holds(this->Blocks[index].Cells, cell))
      {
        return &this->Blocks[index].Appearance;
      }
    }
  }
  return nullptr;
}

bool BlockLooks::AreOpaque() const
{
  return std::all_of(this->Blocks.begin(), this->Blocks.end(),
    [](const Block& block)
    {
      const Look& look = block.Appearance;
      return (!look.Color || look.Color->w >= 1.0f) && look.Opacity.value_or(1.0f) >= 1.0f;
    });
}

bool BlockLooks::AnyIsSeen() const
{
  return std::any_of(this->Blocks.begin(), this->Blocks.end(),
    [](const Block& block) { return block.Appearance.Opacity.value_or(0.0f) > 0.0f; });
}

void BlockLooks::AddTo(ObjectDigest& digest) const
{
  digest.Add(this->Blocks.size());
  for (const Block& block : this->Blocks)
  {
    const auto& [cells, appearance] = block;
    const auto& [color, opacity] = appearance;
    digest.AddAll(cells, color, opacity);
  }
}

} // namespace rt
