// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/BeamHistory.h"

#include <algorithm>
#include <limits>

namespace rt
{

BeamHistory::BeamHistory(int width, int height, std::size_t objects, const BeamHistory* last)
  : Columns((width + Edge - 1) / Edge)
  , Rows((height + Edge - 1) / Edge)
  , Objects(objects)
  , Last(static_cast<std::size_t>(this->Columns) * this->Rows * objects)
  , Now(this->Last.size())
{
  if (last && last->Columns == this->Columns && last->Rows == this->Rows &&
    last->Objects == objects)
  {
    // This rank may have traced a beam before that another rank traced in the last frame.
    std::transform(last->Now.begin(), last->Now.end(), last->Last.begin(), this->Last.begin(),
      [](const std::atomic<Depth>& now, Depth before)
      {
        const Depth depth = now.load(std::memory_order_relaxed);
        return depth != 0 ? depth : before;
      });
  }
}

std::size_t BeamHistory::GetPlace(int column, int row, std::size_t object) const
{
  return (static_cast<std::size_t>(row) * this->Columns + column) * this->Objects + object;
}

std::size_t BeamHistory::Predict(int x, int y, std::size_t object) const
{
  const int column = x / Edge;
  const int row = y / Edge;
  std::size_t sum = 0;
  std::size_t known = 0;
  for (int j = std::max(row - 1, 0); j <= std::min(row + 1, this->Rows - 1); ++j)
  {
    for (int i = std::max(column - 1, 0); i <= std::min(column + 1, this->Columns - 1); ++i)
    {
      const std::size_t place = this->GetPlace(i, j, object);
      const Depth now = this->Now[place].load(std::memory_order_relaxed);
      const Depth depth = now != 0 ? now : this->Last[place];
      if (depth != 0)
      {
        sum += depth - std::size_t{ 1 };
        ++known;
      }
    }
  }
  return known > 0 ? (sum + known / 2) / known : 0;
}

void BeamHistory::Record(int x, int y, std::size_t object, std::size_t reached)
{
  constexpr std::size_t most = std::numeric_limits<Depth>::max();
  const auto depth = static_cast<Depth>(std::min(reached + 1, most));
  std::atomic<Depth>& now = this->Now[this->GetPlace(x / Edge, y / Edge, object)];
  // Two workers that meet here, with parts of one tile, lose nothing but a guess.
  now.store(std::max(now.load(std::memory_order_relaxed), depth), std::memory_order_relaxed);
}

} // namespace rt
