// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/ChunkStorage.h"

#include "DSMVolumeFiles/format/BareFile.h"

#include <glm/common.hpp>

namespace vol
{

namespace
{

/// Chunks are cut if those that a box of so many samples lies in are large together.
constexpr std::int64_t BoxSamples = 33;

/// Chunks with at least so many planes, or with longer rows, are cut into boxes.
constexpr std::int64_t LeastPlanes = 16;
constexpr std::uint64_t LongestRow = std::uint64_t(1) << 20;

} // namespace

void CutPlainChunks(FileArray& array, ChunkStorage& storage)
{
  ChunkGrid& grid = array.Grid;
  if (!storage.Codec.KeepsPlaces() || storage.Slices != 1 || storage.Order != FastestX ||
    storage.HasHalo ||
    grid.CountBytesOfChunks(BoxSamples, array.GetSampleBytes()) <= MostChunkBytesTogether)
  {
    return;
  }
  const bricks::Index3 size = glm::min(grid.ChunkSamples, grid.Samples);
  const bool isShort = static_cast<std::uint64_t>(size.x) * array.GetSampleBytes() <= LongestRow;
  const auto cut = size.z < LeastPlanes && isShort ? &CutIntoRows : &CutIntoBoxes;
  bricks::Index3 part = cut(size, array.GetSampleBytes()).ChunkSamples;
  for (int axis = 0; axis < 3; ++axis)
  {
    // No part lies in two chunks of the file.
    while (grid.GetCounts()[axis] > 1 && grid.ChunkSamples[axis] % part[axis] != 0)
    {
      --part[axis];
    }
  }
  storage.StoredSamples = grid.ChunkSamples;
  grid.ChunkSamples = part;
}

} // namespace vol
