// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/sorted/SortedCells.h"

#include "DSMBricks/base/ParallelFor.h"
#include "DSMBricks/base/SharedProgress.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <functional>

namespace bricks
{

namespace
{

constexpr std::size_t KeyChunk = std::size_t(1) << 14;

/// Part of the time that reading the keys takes.
constexpr double ShareOfReading = 0.6;

/// Bits that are counted in the first round, and in each further one.
constexpr int FirstBits = 12;
constexpr int FurtherBits = 6;

/// Cells that are divided at a time; bounds what counting their parts takes.
constexpr std::size_t MostCells = std::size_t(1) << 14;

} // namespace

SortedCells::SortedCells(std::string_view what, const RecordReader& reader, const MortonCode& order,
  std::uint64_t largestCount, int threads, dsm::Messenger& messenger,
  dsm::FunctionRef<void(double)> progress)
{
  messenger.RunTogether(what,
    [&]
    {
      this->ReadKeys(reader, order, threads, progress);
      this->SortKeys(threads, progress);
    });
  this->FindCells(what, largestCount, messenger);
}

void SortedCells::ReadKeys(const RecordReader& reader, const MortonCode& order, int threads,
  dsm::FunctionRef<void(double)> progress)
{
  const std::uint64_t count = reader.GetCount();
  this->Memory = dsm::BlockArena(count * sizeof(Key));
  this->Keys = reinterpret_cast<Key*>(this->Memory.GetData());
  this->KeyCount = count;
  std::atomic<bool> isAnyLeftOut{ false };
  SharedProgress advance(progress, 0.0, ShareOfReading, count);
  ParallelForChunks(threads, count, KeyChunk,
    [&](std::size_t begin, std::size_t end, std::size_t, int thread)
    {
      std::vector<std::uint64_t> codes(end - begin);
      reader.FindCodes(begin, end, order, codes.data());
      for (std::size_t primitive = begin; primitive < end; ++primitive)
      {
        this->Keys[primitive] = { codes[primitive - begin], primitive };
      }
      if (std::find(codes.begin(), codes.end(), RecordReader::NoCode) != codes.end())
      {
        isAnyLeftOut = true;
      }
      advance.Add(thread, end - begin);
    });
  if (isAnyLeftOut)
  {
    const Key* const end = std::remove_if(this->Keys, this->Keys + count,
      [](const Key& key) { return key.Code == RecordReader::NoCode; });
    this->KeyCount = static_cast<std::size_t>(end - this->Keys);
  }
}

void SortedCells::SortKeys(int threads, dsm::FunctionRef<void(double)> progress)
{
  // One pass over the highest bits, then the buckets by themselves.
  constexpr int bucketBits = 12;
  constexpr std::size_t buckets = std::size_t(1) << bucketBits;
  const auto bucketOf = [](const Key& key) { return key.Code >> (MortonCode::Bits - bucketBits); };
  const std::size_t count = this->KeyCount;
  const std::size_t chunkSize = std::max(KeyChunk, count / (4 * threads) + 1);
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
  dsm::BlockArena memory(count * sizeof(Key));
  Key* const sorted = reinterpret_cast<Key*>(memory.GetData());
  ParallelForChunks(threads, count, chunkSize,
    [&](std::size_t begin, std::size_t end, std::size_t chunk, int)
    {
      for (std::size_t index = begin; index < end; ++index)
      {
        sorted[places[chunk][bucketOf(this->Keys[index])]++] = this->Keys[index];
      }
    });
  SharedProgress advance(progress, ShareOfReading, 1.0, buckets);
  ParallelFor(threads, buckets,
    [&](std::size_t bucket, int thread)
    {
      std::sort(sorted + bounds[bucket], sorted + bounds[bucket + 1],
        [](const Key& a, const Key& b) { return a.Code < b.Code; });
      advance.Add(thread);
    });
  this->Memory = std::move(memory);
  this->Keys = sorted;
}

void SortedCells::ReadRecords(
  const RecordReader& reader, std::uint64_t begin, std::uint64_t end, std::uint32_t* records) const
{
  constexpr std::uint64_t together = 64;
  const std::size_t words = reader.GetKind().RecordBytes / sizeof(std::uint32_t);
  std::uint64_t primitives[together] = {};
  while (begin < end)
  {
    const auto count = static_cast<std::size_t>(std::min(together, end - begin));
    for (std::size_t number = 0; number < count; ++number)
    {
      primitives[number] = this->Keys[begin + number].Primitive;
    }
    reader.ReadRecords(primitives, count, records);
    records += count * words;
    begin += count;
  }
}

std::vector<std::uint64_t> SortedCells::Divide(const Cell& cell, int bits) const
{
  const std::size_t parts = std::size_t(1) << bits;
  std::vector<std::uint64_t> bounds(parts + 1, cell.Begin);
  const Key* const end = this->Keys + cell.End;
  for (std::size_t part = 1; part < parts; ++part)
  {
    const std::uint64_t code = cell.Code + (part << (MortonCode::Bits - cell.Bits - bits));
    const Key* const first = std::lower_bound<const Key*>(this->Keys + bounds[part - 1], end, code,
      [](const Key& key, std::uint64_t value) { return key.Code < value; });
    bounds[part] = static_cast<std::uint64_t>(first - this->Keys);
  }
  bounds[parts] = cell.End;
  return bounds;
}

void SortedCells::FindCells(
  std::string_view what, std::uint64_t largestCount, dsm::Messenger& messenger)
{
  // All cells of one generation have the same number of bits.
  std::vector<Cell> open;
  std::vector<Cell> next;
  std::vector<std::uint64_t> counts;
  std::vector<std::vector<std::uint64_t>> bounds;
  const auto add = [&](const Cell& cell)
  {
    if (cell.Count > largestCount && cell.Bits < MortonCode::Bits)
    {
      next.push_back(cell);
    }
    else if (cell.Count > 0)
    {
      this->Cells.push_back(cell);
    }
  };
  messenger.RunTogether(what, [&] { counts.assign(1, this->KeyCount); });
  messenger.Sum(counts);
  messenger.RunTogether(what, [&] { add({ 0, 0, 0, this->KeyCount, counts.front() }); });
  for (int step = FirstBits; !next.empty(); step = FurtherBits)
  {
    open = std::exchange(next, {});
    const int bits = std::min(step, MortonCode::Bits - open.front().Bits);
    const std::size_t parts = std::size_t(1) << bits;
    for (std::size_t first = 0; first < open.size(); first += MostCells)
    {
      const std::size_t last = std::min(first + MostCells, open.size());
      messenger.RunTogether(what,
        [&]
        {
          bounds.clear();
          counts.clear();
          for (std::size_t cell = first; cell < last; ++cell)
          {
            bounds.push_back(this->Divide(open[cell], bits));
            for (std::size_t part = 0; part < parts; ++part)
            {
              counts.push_back(bounds.back()[part + 1] - bounds.back()[part]);
            }
          }
        });
      messenger.Sum(counts);
      messenger.RunTogether(what,
        [&]
        {
          for (std::size_t cell = first; cell < last; ++cell)
          {
            const std::uint64_t* partCounts = counts.data() + (cell - first) * parts;
            const auto& partBounds = bounds[cell - first];
            const Cell& whole = open[cell];
            // Halves until it fits, or the parts that were counted are reached.
            const std::function<void(std::size_t, int)> halve = [&](std::size_t begin, int depth)
            {
              const std::size_t size = parts >> depth;
              std::uint64_t count = 0;
              for (std::size_t part = begin; part < begin + size; ++part)
              {
                count += partCounts[part];
              }
              if (count > largestCount && size > 1)
              {
                halve(begin, depth + 1);
                halve(begin + size / 2, depth + 1);
                return;
              }
              add({ whole.Code + (begin << (MortonCode::Bits - whole.Bits - bits)),
                whole.Bits + depth, partBounds[begin], partBounds[begin + size], count });
            };
            halve(0, 0);
          }
        });
    }
  }
  std::sort(this->Cells.begin(), this->Cells.end(),
    [](const Cell& a, const Cell& b) { return a.Code < b.Code; });
}

} // namespace bricks
