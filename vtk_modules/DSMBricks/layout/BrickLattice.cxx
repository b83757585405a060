// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/layout/BrickLattice.h"

#include "DSMBricks/layout/MacrocellHierarchy.h"
#include "DSMBricks/layout/VoxelBrickHeader.h"
#include "DSMCore/base/Error.h"

#include <glm/common.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace bricks
{

namespace
{

/// The default edge, doubled until the tables of all bricks, of tens of bytes each, fit a rank's memory.
int FindEdge(const Index3& points, ScalarType type)
{
  constexpr double mostBricks = 1 << 24;
  int edge = BrickLattice::GetDefaultEdge(type);
  const auto count = [&]
  {
    double bricks = 1.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      bricks *= std::ceil(static_cast<double>(points[axis] - 1) / edge);
    }
    return bricks;
  };
  while (2 * edge <= BrickLattice::LargestEdge && count() > mostBricks)
  {
    edge *= 2;
  }
  return edge;
}

} // namespace

BrickLattice::BrickLattice(const Index3& points, ScalarType type, bool cellMask)
  : BrickLattice(points, type, cellMask, FindEdge(points, type))
{
}

BrickLattice::BrickLattice(const Index3& points, ScalarType type, bool cellMask, int edge)
  : Points(points)
  , Type(type)
  , CellMask(cellMask)
  , Edge(edge)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    if (points[axis] < 2 || points[axis] > std::numeric_limits<std::int32_t>::max())
    {
      throw dsm::Error("A volume of " + std::to_string(points.x) + " x " +
        std::to_string(points.y) + " x " + std::to_string(points.z) +
        " points cannot be ray traced. Each axis must have 2 to 2147483647 points. Use a volume, "
        "not a slice.");
    }
  }
  if (edge < 1 || edge > LargestEdge)
  {
    throw dsm::Error("Invalid brick edge of " + std::to_string(edge) +
      " cells; valid edges are 1 to " + std::to_string(LargestEdge) + ".");
  }
  this->Bricks = (this->GetCells() + Index3(edge - 1)) / Index3(edge);
}

int BrickLattice::GetDefaultEdge(ScalarType type)
{
  switch (bricks::GetBytes(type))
  {
    case 1:
      return 32; // 36 KB
    case 2:
      return 24; // 31 KB
    default:
      return 16; // 20 KB and 39 KB
  }
}

dsm::BlockId BrickLattice::GetBrickCount() const
{
  return static_cast<dsm::BlockId>(this->Bricks.x * this->Bricks.y * this->Bricks.z);
}

Index3 BrickLattice::GetBrick(dsm::BlockId id) const
{
  const auto number = static_cast<std::int64_t>(id);
  return { number % this->Bricks.x, number / this->Bricks.x % this->Bricks.y,
    number / (this->Bricks.x * this->Bricks.y) };
}

dsm::BlockId BrickLattice::FindBrick(const glm::dvec3& point) const
{
  const Index3 brick =
    glm::clamp(Index3(glm::floor(point)) / Index3(this->Edge), Index3(0), this->Bricks - Index3(1));
  return static_cast<dsm::BlockId>(brick.x + this->Bricks.x * (brick.y + this->Bricks.y * brick.z));
}

Box BrickLattice::GetCellsOfBrick(dsm::BlockId id) const
{
  const Index3 first = this->GetBrick(id) * Index3(this->Edge);
  return { first, glm::min(first + Index3(this->Edge), this->GetCells()) };
}

std::uint32_t BrickLattice::GetBlockBytes(dsm::BlockId id) const
{
  return CreateVoxelBrickHeader(this->GetCellsOfBrick(id).GetSize(), this->Type, this->CellMask)
    .BlockBytes;
}

dsm::BlockDirectory BrickLattice::CreateDirectory(int ranks) const
{
  return this->CreateDirectory(dsm::RoundRobinAssigner(ranks));
}

dsm::BlockDirectory BrickLattice::CreateDirectory(const dsm::BlockAssigner& assigner) const
{
  std::vector<std::uint32_t> bytes(this->GetBrickCount());
  for (dsm::BlockId id = 0; id < bytes.size(); ++id)
  {
    bytes[id] = this->GetBlockBytes(id);
  }
  return dsm::BlockDirectory(std::move(bytes), assigner, MacrocellHierarchy::CountBytes(*this));
}

} // namespace bricks
