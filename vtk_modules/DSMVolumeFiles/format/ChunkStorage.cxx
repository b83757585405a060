// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/ChunkStorage.h"

#include <glm/common.hpp>

namespace vol
{

namespace
{

/// Size in bytes of chunks of rows.
constexpr std::int64_t ChunkBytes = 1 << 18;

/// Size of chunks that are boxes: bytes of a row, and number of rows along y and z.
constexpr std::int64_t RowBytes = 1024;
constexpr std::int64_t Rows = 32;

/// Chunks are cut if those that a box of so many samples lies in are large together.
constexpr std::int64_t BoxSamples = 33;

/// Chunks with at least so many planes, or with longer rows, are cut into boxes.
constexpr std::int64_t LeastPlanes = 16;
constexpr std::uint64_t LongestRow = std::uint64_t(1) << 20;

} // namespace

ChunkGrid CutIntoBoxes(const bricks::Index3& samples, std::size_t sampleBytes)
{
  const std::int64_t width =
    std::max<std::int64_t>(1, RowBytes / static_cast<std::int64_t>(sampleBytes));
  // Samples of many components take more than a row's bytes each.
  std::int64_t rows = Rows;
  while (rows > 1 &&
    rows * rows * width * static_cast<std::int64_t>(sampleBytes) > RowBytes * Rows * Rows)
  {
    rows /= 2;
  }
  return { samples, glm::min(samples, bricks::Index3(width, rows, rows)) };
}

ChunkGrid CutIntoRows(const bricks::Index3& samples, std::size_t sampleBytes)
{
  const std::int64_t row =
    std::max<std::int64_t>(1, samples.x) * static_cast<std::int64_t>(sampleBytes);
  const std::int64_t rows =
    std::clamp<std::int64_t>(ChunkBytes / row, 1, std::max<std::int64_t>(1, samples.y));
  const std::int64_t planes = rows < samples.y
    ? 1
    : std::clamp<std::int64_t>(ChunkBytes / (row * rows), 1, std::max<std::int64_t>(1, samples.z));
  return { samples, { std::max<std::int64_t>(1, samples.x), rows, planes } };
}

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
