// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/levels/LevelLattice.h"

#include "DSMBricks/layout/VoxelBrickHeader.h"
#include "DSMCore/base/Error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

namespace bricks
{

namespace
{

constexpr std::int64_t Parts = LevelLattice::Edge / LevelLattice::PartEdge;

auto GetPlace(const LevelCube& cube)
{
  return std::make_tuple(cube.Level, cube.Place[2], cube.Place[1], cube.Place[0]);
}

std::vector<LevelCube> Join(std::vector<LevelCube> cubes)
{
  std::sort(cubes.begin(), cubes.end(),
    [](const LevelCube& a, const LevelCube& b) { return GetPlace(a) < GetPlace(b); });
  std::vector<LevelCube> joined;
  for (const LevelCube& cube : cubes)
  {
    if (joined.empty() || GetPlace(joined.back()) != GetPlace(cube))
    {
      joined.push_back(cube);
      continue;
    }
    LevelCube& known = joined.back();
    for (int axis = 0; axis < 3; ++axis)
    {
      known.Min[axis] = std::min(known.Min[axis], cube.Min[axis]);
      known.Max[axis] = std::max(known.Max[axis], cube.Max[axis]);
    }
    for (int part = 0; part < 64; ++part)
    {
      if (known.Leaves[part] + cube.Leaves[part] > 64)
      {
        throw dsm::Error("Blocks of the same level overlap. Remove one of them, or mark the cells "
                         "that they have twice as "
                         "duplicate in vtkGhostType.");
      }
      known.Leaves[part] = static_cast<std::uint8_t>(known.Leaves[part] + cube.Leaves[part]);
    }
  }
  return joined;
}

int CountIn(const LevelCube& cube, const Box& parts)
{
  int count = 0;
  ForEachIndex(parts,
    [&](const Index3& part) { count += cube.Leaves[part.x + Parts * (part.y + Parts * part.z)]; });
  return count;
}

} // namespace

void LevelCube::Count(const Index3& cell)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Min[axis] = std::min(this->Min[axis], static_cast<std::uint8_t>(cell[axis]));
    this->Max[axis] = std::max(this->Max[axis], static_cast<std::uint8_t>(cell[axis] + 1));
  }
  const Index3 part = cell / Index3(LevelLattice::PartEdge);
  ++this->Leaves[part.x + Parts * (part.y + Parts * part.z)];
}

Index3 DivideDown(const Index3& number, const Index3& by)
{
  Index3 result;
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::int64_t rest = number[axis] % by[axis];
    result[axis] = number[axis] / by[axis] - (rest < 0 ? 1 : 0);
  }
  return result;
}

Index3 DivideUp(const Index3& number, const Index3& by)
{
  return -DivideDown(-number, by);
}

LevelScales::LevelScales(std::vector<Index3> scales)
  : Scales(std::move(scales))
{
  for (const Index3& cells : this->Scales)
  {
    const glm::dvec3 scale(cells);
    this->Sizes.push_back(1.0 / std::cbrt(scale.x * scale.y * scale.z));
  }
}

LevelLattice::LevelLattice(LevelScales scales, const std::vector<LevelCube>& cubes, ScalarType type)
  : Scales(std::move(scales))
  , Type(type)
{
  this->Begins.push_back(0);
  this->Bounds = { glm::dvec3(std::numeric_limits<double>::infinity()),
    glm::dvec3(-std::numeric_limits<double>::infinity()) };
  for (const LevelCube& cube : Join(cubes))
  {
    while (this->Begins.size() <= static_cast<std::size_t>(cube.Level))
    {
      this->Begins.push_back(this->Bricks.size());
    }
    const dsm::BlockId first = this->Bricks.size();
    this->Cut(cube, { Index3(0), Index3(Parts) });
    const Index3 place(cube.Place[0], cube.Place[1], cube.Place[2]);
    this->Cubes.emplace(Key{ cube.Level, place }, std::make_pair(first, this->Bricks.size()));
  }
  this->Begins.resize(static_cast<std::size_t>(this->Scales.GetCount()) + 1, this->Bricks.size());
  for (const LevelBrick& brick : this->Bricks)
  {
    const glm::dvec3 scale(this->Scales.Get(brick.Level));
    this->Bounds[0] = glm::min(this->Bounds[0], glm::dvec3(brick.Cells.Min) / scale);
    this->Bounds[1] = glm::max(this->Bounds[1], glm::dvec3(brick.Cells.Max) / scale);
  }
}

void LevelLattice::Cut(const LevelCube& cube, Box parts)
{
  Box filled{ parts.Max, parts.Min };
  ForEachIndex(parts,
    [&](const Index3& part)
    {
      if (cube.Leaves[part.x + Parts * (part.y + Parts * part.z)] != 0)
      {
        filled.Min = glm::min(filled.Min, part);
        filled.Max = glm::max(filled.Max, part + Index3(1));
      }
    });
  if (filled.IsEmpty())
  {
    return;
  }
  Box cells{ filled.Min * Index3(PartEdge), filled.Max * Index3(PartEdge) };
  const Index3 place = Index3(cube.Place[0], cube.Place[1], cube.Place[2]) * Index3(Edge);
  cells = Intersect(cells,
    { Index3(cube.Min[0], cube.Min[1], cube.Min[2]),
      Index3(cube.Max[0], cube.Max[1], cube.Max[2]) });
  const int leaves = CountIn(cube, filled);
  const Index3 size = filled.GetSize();
  const std::int64_t longest = std::max({ size.x, size.y, size.z });
  // Where less than half of a box is of leaves, its halves are likely to shrink.
  if (2 * leaves < cells.GetCount() && longest > 1)
  {
    const int axis = size.x == longest ? 0 : (size.y == longest ? 1 : 2);
    Box half = filled;
    half.Max[axis] = filled.Min[axis] + (longest + 1) / 2;
    this->Cut(cube, half);
    half = filled;
    half.Min[axis] = filled.Min[axis] + (longest + 1) / 2;
    this->Cut(cube, half);
    return;
  }
  this->Leaves += static_cast<std::uint64_t>(leaves);
  this->Bricks.push_back(
    { { cells.Min + place, cells.Max + place }, cube.Level, leaves < cells.GetCount() });
}

dsm::BlockId LevelLattice::Find(int level, const Index3& cell) const
{
  static_assert(Edge == 1 << EdgeShift);
  const auto found = this->Cubes.find(
    Key{ level, Index3(cell.x >> EdgeShift, cell.y >> EdgeShift, cell.z >> EdgeShift) });
  if (found != this->Cubes.end())
  {
    for (dsm::BlockId id = found->second.first; id < found->second.second; ++id)
    {
      if (this->GetBrick(id).Has(cell))
      {
        return id;
      }
    }
  }
  return None;
}

std::uint32_t LevelLattice::GetBlockBytes(dsm::BlockId id) const
{
  const LevelBrick& brick = this->GetBrick(id);
  return CreateVoxelBrickHeader(brick.Cells.GetSize(), this->Type, brick.HasMask).BlockBytes;
}

dsm::BlockDirectory LevelLattice::CreateDirectory(int ranks) const
{
  std::vector<std::uint32_t> bytes(this->Bricks.size());
  for (dsm::BlockId id = 0; id < bytes.size(); ++id)
  {
    bytes[id] = this->GetBlockBytes(id);
  }
  const std::uint64_t indexBytes = this->Bricks.size() * (sizeof(LevelBrick) + 2 * sizeof(Key));
  return dsm::BlockDirectory(std::move(bytes), dsm::RoundRobinAssigner(ranks), indexBytes);
}

} // namespace bricks
