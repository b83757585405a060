// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/range/LookThrough.h"

#include "DSMRayTracing/base/ParallelFor.h"
#include "DSMRayTracing/build/VoxelBrickReader.h"
#include "DSMRayTracing/layout/VoxelBrickHeader.h"
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
  const rt::Index3& chunk = array.Grid.ChunkSamples;
  const double chunkBytes =
    static_cast<double>(chunk.x * chunk.y * chunk.z) * static_cast<double>(array.GetSampleBytes());
  const double held =
    static_cast<double>(ChunkCache::GetShared().GetRoom()) / std::max(chunkBytes, 1.0);
  return static_cast<std::int64_t>(std::max(1.0, std::sqrt(0.5 * held) - 1.0));
}

/// Bricks that have samples of a box.
rt::Box FindBricks(const rt::BrickLattice& lattice, const rt::Box& box)
{
  const rt::Index3 edge(lattice.GetEdge());
  const rt::Index3 first = glm::min(box.Min / edge, lattice.GetBricks() - rt::Index3(1));
  const rt::Index3 last = glm::min(
    glm::max((box.Max - rt::Index3(2)) / edge, first), lattice.GetBricks() - rt::Index3(1));
  return { first, last + rt::Index3(1) };
}

/// Bricks of which the first cell is among the cells between a box's samples.
rt::Box FindOwnBricks(const rt::BrickLattice& lattice, const rt::Box& box)
{
  const rt::Index3 edge(lattice.GetEdge());
  const auto getNext = [&](const rt::Index3& cell) { return (cell + edge - rt::Index3(1)) / edge; };
  return { getNext(box.Min), getNext(box.Max - rt::Index3(1)) };
}

} // namespace

std::vector<dsm::BlockId> OrderBricks(const rt::BrickLattice& lattice, const rt::Box& bricks,
  const FileArray& array, const rt::Index3& first)
{
  const rt::Index3 edge(lattice.GetEdge());
  const rt::Index3& chunk = array.Grid.ChunkSamples;
  const rt::Index3 begin = (bricks.Min * edge + first) / chunk;
  const rt::Index3 end = ((bricks.Max - rt::Index3(1)) * edge + first) / chunk + rt::Index3(1);
  std::vector<dsm::BlockId> order;
  order.reserve(static_cast<std::size_t>(bricks.GetCount()));
  const auto addColumn = [&](const rt::Box& chunks)
  {
    // Those that begin in a chunk, chunk after chunk.
    const auto getNext = [&](const rt::Index3& at)
    {
      const rt::Index3 sample = glm::max(at * chunk - first, rt::Index3(0));
      return (sample + edge - rt::Index3(1)) / edge;
    };
    rt::ForEachIndex(chunks,
      [&](const rt::Index3& at)
      {
        rt::ForEachIndex(rt::Intersect({ getNext(at), getNext(at + rt::Index3(1)) }, bricks),
          [&](const rt::Index3& brick) { order.push_back(lattice.GetId(brick)); });
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
  constexpr std::int64_t leastWidth = 3; // of narrower columns most chunks would be read twice
  const rt::Index3& samples = array.Grid.Samples;
  return array.Components == 1 && !array.OnCells &&
    std::min({ samples.x, samples.y, samples.z }) > 1 && FindColumnWidth(array) >= leastWidth;
}

std::optional<Look> LookThrough(const std::shared_ptr<const VolumeFile>& file, std::size_t number,
  int step, const rt::Box& box, int threads, const std::function<bool(double)>& goesOn)
{
  const FileArray& array = file->GetArrays()[number];
  const rt::BrickLattice lattice(array.Grid.Samples, array.Type, /*cellMask=*/false);
  const rt::VoxelBrickReader reader(
    lattice, std::make_shared<FileSamples>(file, number, step, ChunkCache::GetShared()));
  Look look{ ValueRanges(1), { lattice, FindOwnBricks(lattice, box), {}, {} } };
  rt::SeenBricks& bricks = look.Bricks;
  bricks.Seen.resize(static_cast<std::size_t>(bricks.Bricks.GetCount()));
  const std::vector<dsm::BlockId> order =
    OrderBricks(lattice, FindBricks(lattice, box), array, rt::Index3(0));
  rt::BrickLooker looker(lattice, reader, threads);
  std::vector<ValueRanges> parts(static_cast<std::size_t>(threads), look.Ranges);
  std::atomic<std::size_t> done{ 0 };
  std::atomic<bool> stopped{ false };
  constexpr std::size_t together = 64; // who goes on is not asked more often
  rt::ParallelForChunks(threads, order.size(), together,
    [&](std::size_t begin, std::size_t end, std::size_t, int thread)
    {
      for (std::size_t index = begin; index < end && !stopped; ++index)
      {
        const dsm::BlockId id = order[index];
        const std::byte* const block = looker.Read(id, thread);
        rt::VoxelBrickHeader header;
        std::memcpy(&header, block, sizeof(header));
        const rt::Box cells = lattice.GetCellsOfBrick(id);
        const rt::Box have{ cells.Min, cells.Max + rt::Index3(1) };
        parts[static_cast<std::size_t>(thread)].Add(
          array, block + header.SampleOffset, have, rt::Intersect(have, box));
        const rt::Index3 brick = lattice.GetBrick(id);
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
