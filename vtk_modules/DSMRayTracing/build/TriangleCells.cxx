// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/build/TriangleCells.h"

#include "DSMRayTracing/base/ParallelFor.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>

namespace rt
{

namespace
{

/// Behind all codes.
constexpr std::uint64_t NoCode = ~std::uint64_t(0);

constexpr std::size_t ChunkSize = std::size_t(1) << 16;

/// Bits that are counted in the first round, and in each further one.
constexpr int FirstBits = 12;
constexpr int FurtherBits = 6;

/// The sum over the ranks, number by number.
std::vector<std::uint64_t> Sum(const std::vector<std::uint64_t>& mine, dsm::Messenger& messenger)
{
  std::vector<std::byte> bytes(mine.size() * sizeof(std::uint64_t));
  if (!mine.empty())
  {
    std::memcpy(bytes.data(), mine.data(), bytes.size());
  }
  const auto all = messenger.AllGather(std::move(bytes));
  std::vector<std::uint64_t> sum(mine.size(), 0);
  for (const auto& part : all)
  {
    if (part.size() != mine.size() * sizeof(std::uint64_t))
    {
      throw dsm::Error(
        "The ranks count different cells of a mesh. Do all ranks run the same build?");
    }
    for (std::size_t index = 0; index < sum.size(); ++index)
    {
      std::uint64_t count;
      std::memcpy(&count, part.data() + index * sizeof(count), sizeof(count));
      sum[index] += count;
    }
  }
  return sum;
}

} // namespace

TriangleCells::TriangleCells(const TriangleReader& reader, std::uint64_t triangles,
  const MortonCode& order, std::uint64_t largestCount, int threads, dsm::Messenger& messenger)
{
  messenger.RunTogether("Sorting a mesh",
    [&]
    {
      this->ReadKeys(reader, triangles, order, threads);
      this->SortKeys(threads);
    });
  this->FindCells(largestCount, messenger);
}

void TriangleCells::ReadKeys(
  const TriangleReader& reader, std::uint64_t triangles, const MortonCode& order, int threads)
{
  this->Keys.resize(triangles);
  ParallelForChunks(threads, triangles, ChunkSize,
    [&](std::size_t begin, std::size_t end, std::size_t, int)
    {
      for (std::size_t triangle = begin; triangle < end; ++triangle)
      {
        float corners[9];
        const bool canBeHit = reader.ReadCorners(triangle, corners);
        this->Keys[triangle] = { canBeHit ? order.GetOfTriangle(corners) : NoCode, triangle };
      }
    });
  const auto kept = std::remove_if(
    this->Keys.begin(), this->Keys.end(), [](const Key& key) { return key.Code == NoCode; });
  this->Dropped = static_cast<std::uint64_t>(this->Keys.end() - kept);
  this->Keys.erase(kept, this->Keys.end());
}

void TriangleCells::SortKeys(int threads)
{
  // One pass over the highest bits, then the buckets by themselves.
  constexpr int bucketBits = 12;
  constexpr std::size_t buckets = std::size_t(1) << bucketBits;
  const auto bucketOf = [](const Key& key) { return key.Code >> (MortonCode::Bits - bucketBits); };
  const std::size_t count = this->Keys.size();
  const std::size_t chunkSize = std::max(ChunkSize, count / (4 * threads) + 1);
  const std::size_t chunks = (count + chunkSize - 1) / chunkSize;
  std::vector<std::array<std::uint64_t, buckets>> places(chunks);
  ParallelForChunks(threads, count, chunkSize,
    [&](std::size_t begin, std::size_t end, std::size_t chunk, int)
    {
      places[chunk].fill(0);
      for (std::size_t index = begin; index < end; ++index)
      {
        ++places[chunk][bucketOf(this->Keys[index])];
      }
    });
  std::vector<std::uint64_t> bounds(buckets + 1, 0);
  std::uint64_t place = 0;
  for (std::size_t bucket = 0; bucket < buckets; ++bucket)
  {
    for (auto& chunk : places)
    {
      place += std::exchange(chunk[bucket], place);
    }
    bounds[bucket + 1] = place;
  }
  std::vector<Key> sorted(count);
  ParallelForChunks(threads, count, chunkSize,
    [&](std::size_t begin, std::size_t end, std::size_t chunk, int)
    {
      for (std::size_t index = begin; index < end; ++index)
      {
        sorted[places[chunk][bucketOf(this->Keys[index])]++] = this->Keys[index];
      }
    });
  ParallelFor(threads, buckets,
    [&](std::size_t bucket, int)
    {
      std::sort(sorted.begin() + bounds[bucket], sorted.begin() + bounds[bucket + 1],
        [](const Key& a, const Key& b) { return a.Code < b.Code; });
    });
  this->Keys = std::move(sorted);
}

std::vector<std::uint64_t> TriangleCells::Divide(const Cell& cell, int bits) const
{
  const std::size_t parts = std::size_t(1) << bits;
  std::vector<std::uint64_t> bounds(parts + 1, cell.Begin);
  const auto end = this->Keys.begin() + cell.End;
  for (std::size_t part = 1; part < parts; ++part)
  {
    const std::uint64_t code = cell.Code + (part << (MortonCode::Bits - cell.Bits - bits));
    const auto first = std::lower_bound(this->Keys.begin() + bounds[part - 1], end, code,
      [](const Key& key, std::uint64_t value) { return key.Code < value; });
    bounds[part] = static_cast<std::uint64_t>(first - this->Keys.begin());
  }
  bounds[parts] = cell.End;
  return bounds;
}

void TriangleCells::FindCells(std::uint64_t largestCount, dsm::Messenger& messenger)
{
  const std::uint64_t total = Sum({ this->Keys.size() }, messenger).front();
  std::vector<Cell> open;
  const auto add = [&](const Cell& cell)
  {
    if (cell.Count > largestCount && cell.Bits < MortonCode::Bits)
    {
      open.push_back(cell);
    }
    else if (cell.Count > 0)
    {
      this->Cells.push_back(cell);
    }
  };
  add({ 0, 0, 0, this->Keys.size(), total });
  for (int step = FirstBits; !open.empty(); step = FurtherBits)
  {
    const int bits = std::min(step, MortonCode::Bits - open.front().Bits);
    const std::size_t parts = std::size_t(1) << bits;
    std::vector<std::vector<std::uint64_t>> bounds;
    std::vector<std::uint64_t> counts;
    messenger.RunTogether("Sorting a mesh",
      [&]
      {
        for (const Cell& cell : open)
        {
          bounds.push_back(this->Divide(cell, bits));
          for (std::size_t part = 0; part < parts; ++part)
          {
            counts.push_back(bounds.back()[part + 1] - bounds.back()[part]);
          }
        }
      });
    counts = Sum(counts, messenger);

    const std::vector<Cell> divided = std::exchange(open, {});
    for (std::size_t index = 0; index < divided.size(); ++index)
    {
      const std::uint64_t* partCounts = counts.data() + index * parts;
      const auto& partBounds = bounds[index];
      const Cell& whole = divided[index];
      // Halves until it fits, or the parts that were counted are reached.
      const std::function<void(std::size_t, int)> halve = [&](std::size_t first, int depth)
      {
        const std::size_t size = parts >> depth;
        std::uint64_t count = 0;
        for (std::size_t part = first; part < first + size; ++part)
        {
          count += partCounts[part];
        }
        if (count > largestCount && size > 1)
        {
          halve(first, depth + 1);
          halve(first + size / 2, depth + 1);
          return;
        }
        add({ whole.Code + (first << (MortonCode::Bits - whole.Bits - bits)), whole.Bits + depth,
          partBounds[first], partBounds[first + size], count });
      };
      halve(0, 0);
    }
  }
  std::sort(this->Cells.begin(), this->Cells.end(),
    [](const Cell& a, const Cell& b) { return a.Code < b.Code; });
}

} // namespace rt
