// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/zarr/ZarrSource.h"

namespace vol
{

ZarrSource::Index ZarrSource::FindIndex(
  int step, const bricks::Index3& chunk, std::size_t* slice) const
{
  const ZarrMetadata& data = *this->Data;
  Index index{};
  for (int axis = 0; axis < 3; ++axis)
  {
    index[this->Axes.FindInSpace(data.Shape.size(), axis)] = chunk[axis];
  }
  for (std::size_t axis = 0; axis < this->Channel.size(); ++axis)
  {
    const std::int64_t at = static_cast<int>(axis) == this->Axes.Time ? step : this->Channel[axis];
    index[axis] = at / data.ChunkShape[axis];
    if (slice)
    {
      *slice = *slice * static_cast<std::size_t>(data.ChunkShape[axis]) +
        static_cast<std::size_t>(at % data.ChunkShape[axis]);
    }
  }
  return index;
}

ZarrSource::Index ZarrSource::GetFileIndex(Index index) const
{
  const ZarrMetadata& data = *this->Data;
  for (std::size_t axis = 0; data.Shards && axis < data.Shape.size(); ++axis)
  {
    index[axis] /= data.Shards->ShardShape[axis] / data.ChunkShape[axis];
  }
  return index;
}

} // namespace vol
