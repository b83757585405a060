// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/range/LookThrough.h"

#include "DSMBricks/base/ParallelFor.h"
#include "DSMBricks/build/ValidSource.h"
#include "DSMBricks/build/VoxelBrickReader.h"
#include "DSMBricks/layout/VoxelBrickHeader.h"
#include "DSMVolumeFiles/cache/FileSamples.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>

namespace vol
{

namespace
{

/// How many chunks side by side the shared cache holds two layers of: of a brick that ends at a chunk's first samples
/// the chunk behind is there, or will be read next.
std::int64_t FindColumnWidth(const FileArray& array)
{
  const bricks::Index3& chunk = array.Grid.ChunkSamples;
  const double chunkBytes =
    static_cast<double>(chunk.x * chunk.y * chunk.z) * static_cast<double>(array.GetSampleBytes());
  const double held =
    static_cast<double>(ChunkCache::GetShared().GetRoom()) / std::max(chunkBytes, 1.0);
  return static_cast<std::int64_t>(std::max(1.0, std::sqrt(0.5 * held) - 1.0));
}

/// Bricks that have samples of a box.
bricks::Box FindBricks(const bricks::BrickLattice& lattice, const bricks::Box& box)
{
  const bricks::Index3 edge(lattice.GetEdge());
  const bricks::Index3 first = glm::min(box.Min / edge, lattice.GetBricks() - bricks::Index3(1));
  const bricks::Index3 last = glm::min(
    glm::max((box.Max - bricks::Index3(2)) / edge, first), lattice.GetBricks() - bricks::Index3(1));
  return { first, last + bricks::Index3(1) };
}

/// Bricks of which the first cell is among the cells between a box's samples.
bricks::Box FindOwnBricks(const bricks::BrickLattice& lattice, const bricks::Box& box)
{
  const bricks::Index3 edge(lattice.GetEdge());
  const auto getNext = [&](const bricks::Index3& cell)
  { return (cell + edge - bricks::Index3(1)) / edge; };
  return { getNext(box.Min), getNext(box.Max - bricks::Index3(1)) };
}

} // namespace

std::vector<dsm::BlockId> OrderBricks(const bricks::BrickLattice& lattice,
  const bricks::Box& bricks, const FileArray& array, const bricks::Index3& first)
{
  const bricks::Index3 edge(lattice.GetEdge());
  const bricks::Index3& chunk = array.Grid.ChunkSamples;
  const bricks::Index3 begin = (bricks.Min * edge + first) / chunk;
  const bricks::Index3 end =
    ((bricks.Max - bricks::Index3(1)) * edge + first) / chunk + bricks::Index3(1);
  std::vector<dsm::BlockId> order;
  order.reserve(static_cast<std::size_t>(bricks.GetCount()));
  const auto addColumn = [&](const bricks::Box& chunks)
  {
    // Those that begin in a chunk, chunk after chunk.
    const auto getNext = [&](const bricks::Index3& at)
    {
      const bricks::Index3 sample = glm::max(at * chunk - first, bricks::Index3(0));
      return (sample + edge - bricks::Index3(1)) / edge;
    };
    bricks::ForEachIndex(chunks,
      [&](const bricks::Index3& at)
      {
        bricks::ForEachIndex(
          bricks::Intersect({ getNext(at), getNext(at + bricks::Index3(1)) }, bricks),
          [&](const bricks::Index3& brick) { order.push_back(lattice.GetId(brick)); });
      });
  };
  const std::int64_t width = FindColumnWidth(array);
  for (std::int64_t y = begin.y; y < end.y; y += width)
  {
    for (std::int64_t x = begin.x; x < end.x; x += width)
    {
      addColumn(
        { { x, y, begin.z }, { std::min(x + width, end.x), std::min(y + width, end.y), end.z } });
    }
  }
  return order;
}

bool CanLookAtBricks(const FileArray& array)
{
  constexpr std::int64_t leastWidth = 3; // columns that are narrower would read most chunks twice
  const bricks::Index3& samples = array.Grid.Samples;
  return array.Components == 1 && !array.OnCells &&
    std::min({ samples.x, samples.y, samples.z }) > 1 && FindColumnWidth(array) >= leastWidth;
}

std::optional<Look> LookThrough(const ArrayStep& of, const bricks::Box& box, int threads,
  const std::function<bool(double)>& goesOn)
{
  const FileArray& array = of.Get();
  const bricks::BrickLattice lattice(
    array.Grid.Samples, array.Type, /*cellMask=*/array.Valid.Exclude(array.Type));
  const bricks::VoxelBrickReader reader(lattice,
    bricks::ValidSource::Make(
      std::make_shared<FileSamples>(of, ChunkCache::GetShared()), lattice, array.Valid));
  Look look{ ValueRanges(1), { lattice, FindOwnBricks(lattice, box), {}, {} } };
  bricks::SeenBricks& bricks = look.Bricks;
  bricks.Seen.resize(static_cast<std::size_t>(bricks.Bricks.GetCount()));
  const std::vector<dsm::BlockId> order =
    OrderBricks(lattice, FindBricks(lattice, box), array, bricks::Index3(0));
  bricks::BrickLooker looker(
    lattice, reader, threads, [&](dsm::BlockId id) { return reader.IsFiller(id); });
  std::vector<ValueRanges> parts(static_cast<std::size_t>(threads), look.Ranges);
  std::atomic<std::size_t> done{ 0 };
  std::atomic<bool> stopped{ false };
  constexpr std::size_t together = 64; // the caller is asked whether to continue once for so many
  bricks::ParallelForChunks(threads, order.size(), together,
    [&](std::size_t begin, std::size_t end, std::size_t, int thread)
    {
      for (std::size_t index = begin; index < end && !stopped; ++index)
      {
        const dsm::BlockId id = order[index];
        // A block with the same bytes has the same range.
        if (const std::byte* const block = looker.Read(id, thread))
        {
          bricks::VoxelBrickHeader header;
          std::memcpy(&header, block, sizeof(header));
          const bricks::Box cells = lattice.GetCellsOfBrick(id);
          const bricks::Box have{ cells.Min, cells.Max + bricks::Index3(1) };
          parts[static_cast<std::size_t>(thread)].Add(
            array, block + header.SampleOffset, have, bricks::Intersect(have, box));
        }
        const bricks::Index3 brick = lattice.GetBrick(id);
        if (bricks.Has(brick))
        {
          bricks.Seen[bricks.Find(brick)] = looker.See(id, thread);
        }
      }
      done += end - begin;
      if (thread == 0 && !goesOn(static_cast<double>(done) / static_cast<double>(order.size())))
      {
        stopped = true;
      }
    });
  if (stopped)
  {
    return std::nullopt;
  }
  for (const ValueRanges& part : parts)
  {
    look.Ranges.Add(part);
  }
  bricks.Survey = looker.GetSurvey();
  return look;
}

} // namespace vol
