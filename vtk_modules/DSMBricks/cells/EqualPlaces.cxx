// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/cells/EqualPlaces.h"

#include "DSMBricks/base/ParallelFor.h"
#include "DSMCore/base/Error.h"
#include "DSMCore/memory/BlockArena.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

namespace bricks
{

namespace
{

/// Points whose hashes begin with the same bits are compared together, in a table that a core's cache holds.
constexpr std::uint64_t PointsOfPart = 4096;
constexpr int MostPartBits = 20;
constexpr std::uint64_t LeastChunk = std::uint64_t(1) << 16;

/// Of points without a place. All others are odd.
constexpr std::uint64_t NoHash = 0;

/// A point, and the first one of its place.
using LaterPoint = std::pair<std::uint32_t, std::uint32_t>;

class PlaceSearch
{
public:
  PlaceSearch(std::uint64_t count, GetPlaceFunction getPlace, int threads)
    : Count(count)
    , GetPlace(getPlace)
    , Threads(threads)
    , ChunkSize(std::max(LeastChunk, count / (4 * static_cast<std::uint64_t>(threads)) + 1))
  {
    while (this->PartBits < MostPartBits && (count >> this->PartBits) > PointsOfPart)
    {
      ++this->PartBits;
    }
  }

  EqualPlaces Run()
  {
    this->Sort();
    std::vector<std::vector<LaterPoint>> found(this->GetPartCount());
    constexpr std::size_t partsTogether = 16;
    ParallelForChunks(this->Threads, found.size(), partsTogether,
      [&](std::size_t begin, std::size_t end, std::size_t, int)
      {
        std::vector<std::uint32_t> table;
        for (std::size_t part = begin; part < end; ++part)
        {
          found[part] = this->Search(part, table);
        }
      });
    return Collect(found);
  }

private:
  struct Entry
  {
    std::uint32_t Key; ///< other bits of the hash
    std::uint32_t Point;
  };

  std::size_t GetPartCount() const { return std::size_t(1) << this->PartBits; }
  std::size_t GetPart(std::uint64_t hash) const
  {
    return this->PartBits == 0 ? 0 : static_cast<std::size_t>(hash >> (64 - this->PartBits));
  }

  /// Writes the hashes of all points, and returns how many of each chunk are in each part.
  std::vector<std::uint32_t> FindHashes(std::uint64_t* hashes) const
  {
    const std::size_t parts = this->GetPartCount();
    const std::size_t chunks = (this->Count + this->ChunkSize - 1) / this->ChunkSize;
    std::vector<std::uint32_t> counts(chunks * parts, 0);
    ParallelForChunks(this->Threads, this->Count, this->ChunkSize,
      [&](std::size_t begin, std::size_t end, std::size_t chunk, int)
      {
        for (std::size_t point = begin; point < end; ++point)
        {
          float place[3];
          hashes[point] = this->GetPlace(point, place) ? HashPlace(place) | 1u : NoHash;
          if (hashes[point] != NoHash)
          {
            ++counts[chunk * parts + this->GetPart(hashes[point])];
          }
        }
      });
    return counts;
  }

  /// By the first bits of the hash; points of a part stay in ascending order.
  void Sort()
  {
    const std::size_t parts = this->GetPartCount();
    const dsm::BlockArena hashMemory(this->Count * sizeof(std::uint64_t));
    auto* const hashes = reinterpret_cast<std::uint64_t*>(hashMemory.GetData());
    std::vector<std::uint32_t> places = this->FindHashes(hashes);
    const std::size_t chunks = places.size() / parts;
    this->Begins.assign(parts + 1, 0);
    std::uint32_t sum = 0;
    for (std::size_t part = 0; part < parts; ++part)
    {
      this->Begins[part] = sum;
      for (std::size_t chunk = 0; chunk < chunks; ++chunk)
      {
        sum += std::exchange(places[chunk * parts + part], sum);
      }
    }
    this->Begins[parts] = sum;
    this->Memory = dsm::BlockArena(sum * sizeof(Entry));
    this->Entries = reinterpret_cast<Entry*>(this->Memory.GetData());
    ParallelForChunks(this->Threads, this->Count, this->ChunkSize,
      [&](std::size_t begin, std::size_t end, std::size_t chunk, int)
      {
        for (std::size_t point = begin; point < end; ++point)
        {
          if (const std::uint64_t hash = hashes[point]; hash != NoHash)
          {
            this->Entries[places[chunk * parts + this->GetPart(hash)]++] = {
              static_cast<std::uint32_t>(hash >> 8), static_cast<std::uint32_t>(point)
            };
          }
        }
      });
  }

  std::vector<LaterPoint> Search(std::size_t part, std::vector<std::uint32_t>& table) const
  {
    const Entry* const entries = this->Entries + this->Begins[part];
    const std::uint32_t count = this->Begins[part + 1] - this->Begins[part];
    std::size_t size = 16;
    while (size < 2 * std::size_t(count))
    {
      size *= 2;
    }
    constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    table.assign(size, none);
    std::vector<LaterPoint> later;
    for (std::uint32_t index = 0; index < count; ++index)
    {
      std::size_t slot = entries[index].Key & (size - 1);
      while (table[slot] != none && !this->AreEqual(entries[table[slot]], entries[index]))
      {
        slot = (slot + 1) & (size - 1);
      }
      if (table[slot] == none)
      {
        table[slot] = index;
      }
      else
      {
        later.emplace_back(entries[table[slot]].Point, entries[index].Point);
      }
    }
    std::sort(later.begin(), later.end());
    return later;
  }

  bool AreEqual(const Entry& one, const Entry& other) const
  {
    float place[3];
    float otherPlace[3];
    return one.Key == other.Key && this->GetPlace(one.Point, place) &&
      this->GetPlace(other.Point, otherPlace) && std::equal(place, place + 3, otherPlace);
  }

  static EqualPlaces Collect(const std::vector<std::vector<LaterPoint>>& found)
  {
    EqualPlaces equal;
    for (const std::vector<LaterPoint>& later : found)
    {
      for (std::size_t index = 0; index < later.size(); ++index)
      {
        if (index == 0 || later[index].first != later[index - 1].first)
        {
          equal.Points.push_back(later[index].first);
          equal.Ends.push_back(0);
        }
        equal.Points.push_back(later[index].second);
        equal.Ends.back() = static_cast<std::uint32_t>(equal.Points.size());
      }
    }
    return equal;
  }

  std::uint64_t Count;
  GetPlaceFunction GetPlace;
  int Threads;
  std::uint64_t ChunkSize;
  int PartBits = 0;
  std::vector<std::uint32_t> Begins; ///< of parts, in Entries
  dsm::BlockArena Memory;
  Entry* Entries = nullptr; ///< in Memory
};

} // namespace

std::uint64_t HashPlace(const float place[3])
{
  std::uint32_t words[3];
  std::memcpy(words, place, sizeof(words));
  // The last steps are those of MurmurHash3.
  std::uint64_t hash = (std::uint64_t(words[0]) << 32 | words[1]) * 0x9e3779b97f4a7c15u;
  hash ^= hash >> 32 ^ words[2] * 0xd6e8feb86659fd93u;
  hash = (hash ^ hash >> 33) * 0xff51afd7ed558ccdu;
  hash = (hash ^ hash >> 33) * 0xc4ceb9fe1a85ec53u;
  return hash ^ hash >> 33;
}

EqualPlaces FindEqualPlaces(std::uint64_t count, GetPlaceFunction getPlace, int threads)
{
  if (count >= std::numeric_limits<std::uint32_t>::max())
  {
    throw dsm::Error("A rank has " + std::to_string(count) +
      " points of cells, more than 32 bits can number. Use more ranks.");
  }
  return PlaceSearch(count, getPlace, std::max(threads, 1)).Run();
}

} // namespace bricks
