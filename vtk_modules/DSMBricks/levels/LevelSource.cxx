// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/levels/LevelSource.h"

namespace bricks
{

std::size_t LevelCubes::Find(int level, const Index3& cell)
{
  const Index3 place = cell / Index3(LevelLattice::Edge);
  const auto [known, isNew] =
    this->Numbers.emplace(std::make_tuple(level, place.z, place.y, place.x), this->All.size());
  if (isNew)
  {
    LevelCube cube{};
    cube.Level = level;
    for (int axis = 0; axis < 3; ++axis)
    {
      cube.Place[axis] = static_cast<std::int32_t>(place[axis]);
      cube.Min[axis] = static_cast<std::uint8_t>(LevelLattice::Edge);
    }
    this->All.push_back(cube);
  }
  return known->second;
}

} // namespace bricks
