// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/cells/PointPlaces.h"

#include "DSMBricks/base/ParallelFor.h"
#include "DSMBricks/layout/PlaceInBrick.h"

#include <cstddef>
#include <limits>

namespace bricks
{

PointPlaces::PointPlaces(const CellSource& source, const BrickSpace& space, int threads)
  : Memory(source.GetPointCount() * 3 * sizeof(float))
  , Places(reinterpret_cast<float*>(this->Memory.GetData()))
{
  constexpr std::size_t chunkSize = std::size_t(1) << 14;
  ParallelForChunks(threads, source.GetPointCount(), chunkSize,
    [&](std::size_t begin, std::size_t end, std::size_t, int)
    {
      for (std::size_t point = begin; point < end; ++point)
      {
        double position[3];
        source.GetPosition(point, position);
        float* const place = this->Places + 3 * point;
        if (!PlaceInBrick(space, position, place))
        {
          place[0] = std::numeric_limits<float>::quiet_NaN();
        }
      }
    });
}

} // namespace bricks
