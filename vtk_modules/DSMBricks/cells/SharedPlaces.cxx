// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/cells/SharedPlaces.h"

#include "DSMBricks/base/ParallelFor.h"
#include "DSMBricks/cells/RankExchange.h"
#include "DSMCore/base/Error.h"

#include <algorithm>
#include <limits>

namespace bricks
{

namespace
{

constexpr std::size_t PointsOfChunk = std::size_t(1) << 16;

/// Of places; Lower > Upper if there are none.
struct PlaceBounds
{
  float Lower[3];
  float Upper[3];

  static PlaceBounds MakeEmpty()
  {
    constexpr float none = std::numeric_limits<float>::infinity();
    return { { none, none, none }, { -none, -none, -none } };
  }
  void Add(const PlaceBounds& other)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Lower[axis] = std::min(this->Lower[axis], other.Lower[axis]);
      this->Upper[axis] = std::max(this->Upper[axis], other.Upper[axis]);
    }
  }
  bool Meets(const PlaceBounds& other) const
  {
    bool meets = true;
    for (int axis = 0; axis < 3; ++axis)
    {
      meets =
        meets && this->Lower[axis] <= other.Upper[axis] && other.Lower[axis] <= this->Upper[axis];
    }
    return meets;
  }
};

PlaceBounds MakeBounds(const float place[3])
{
  return { { place[0], place[1], place[2] }, { place[0], place[1], place[2] } };
}

PlaceBounds FindPlaceBounds(std::uint64_t points, GetPlaceFunction getPlace, int threads)
{
  std::vector<PlaceBounds> bounds(
    (points + PointsOfChunk - 1) / PointsOfChunk, PlaceBounds::MakeEmpty());
  ParallelForChunks(threads, points, PointsOfChunk,
    [&](std::size_t begin, std::size_t end, std::size_t chunk, int)
    {
      for (std::size_t point = begin; point < end; ++point)
      {
        float place[3];
        if (getPlace(point, place))
        {
          bounds[chunk].Add(MakeBounds(place));
        }
      }
    });
  PlaceBounds all = PlaceBounds::MakeEmpty();
  for (const PlaceBounds& one : bounds)
  {
    all.Add(one);
  }
  return all;
}

/// The rank that looks after a place. Other bits of the hash than those by which FindEqualPlaces sorts.
std::size_t FindKeeper(const float place[3], std::size_t ranks)
{
  const std::uint64_t mixed = HashPlace(place) * 0x9e3779b97f4a7c15u;
  return static_cast<std::size_t>((mixed >> 32) * ranks >> 32);
}

bool HasBit(const std::vector<std::uint64_t>& bits, std::uint64_t index)
{
  return !bits.empty() && (bits[index / 64] >> index % 64 & 1u) != 0;
}

void ThrowUnexpectedRecords()
{
  throw dsm::Error("Values arrived for points that this rank does not share. Do all ranks run the "
                   "same build?");
}

std::vector<std::uint64_t> CountAll(const std::vector<std::vector<std::uint32_t>>& lists)
{
  std::vector<std::uint64_t> counts;
  counts.reserve(lists.size());
  for (const std::vector<std::uint32_t>& list : lists)
  {
    counts.push_back(list.size());
  }
  return counts;
}

} // namespace

struct SharedPlaces::Candidates
{
  struct Place
  {
    float At[3];
  };
  std::vector<std::vector<Place>> OfRanks;
};

SharedPlaces::SharedPlaces(std::string_view what, std::uint64_t points, GetPlaceFunction getPlace,
  int threads, dsm::Messenger& messenger)
  : Messages(messenger)
{
  const auto getPositive = [&](std::uint64_t point, float place[3])
  {
    const bool hasPlace = getPlace(point, place);
    for (int axis = 0; axis < 3; ++axis)
    {
      place[axis] += 0.0f; // makes zeros positive
    }
    return hasPlace;
  };
  messenger.RunTogether(what, [&] { this->FindOwn(points, getPositive, threads); });
  if (messenger.GetSize() > 1)
  {
    this->FindOthers(what, points, getPositive, threads);
  }
}

void SharedPlaces::FindOwn(std::uint64_t points, GetPlaceFunction getPlace, int threads)
{
  this->Own = FindEqualPlaces(points, getPlace, threads);
  if (this->Own.Points.empty())
  {
    return;
  }
  this->IsLater.resize((points + 63) / 64, 0);
  this->FirstOfLater.reserve(this->Own.Points.size() - this->Own.Ends.size());
  this->Own.ForEach(
    [this](const std::uint32_t* equal, std::uint32_t count)
    {
      for (std::uint32_t index = 1; index < count; ++index)
      {
        this->IsLater[equal[index] / 64] |= std::uint64_t(1) << equal[index] % 64;
        this->FirstOfLater.emplace_back(equal[index], equal[0]);
      }
    });
  std::sort(this->FirstOfLater.begin(), this->FirstOfLater.end());
}

std::uint64_t SharedPlaces::GetFirst(std::uint64_t point) const
{
  if (!HasBit(this->IsLater, point))
  {
    return point;
  }
  const auto place = std::lower_bound(this->FirstOfLater.begin(), this->FirstOfLater.end(),
    std::make_pair(static_cast<std::uint32_t>(point), std::uint32_t(0)));
  return place->second;
}

void SharedPlaces::FindOthers(
  std::string_view what, std::uint64_t points, GetPlaceFunction getPlace, int threads)
{
  const auto bounds = this->Messages.GatherValueTogether(
    what, [&] { return FindPlaceBounds(points, getPlace, threads); });
  const auto rank = static_cast<std::size_t>(this->Messages.GetRank());
  const std::size_t ranks = bounds.size();

  PointsByRank mine;
  this->Messages.RunTogether(what,
    [&]
    {
      std::vector<PlaceBounds> others;
      for (std::size_t other = 0; other < ranks; ++other)
      {
        if (other != rank && bounds[other].Meets(bounds[rank]))
        {
          others.push_back(bounds[other]);
        }
      }
      std::vector<PointsByRank> found((points + PointsOfChunk - 1) / PointsOfChunk);
      ParallelForChunks(threads, others.empty() ? 0 : points, PointsOfChunk,
        [&](std::size_t begin, std::size_t end, std::size_t chunk, int)
        {
          found[chunk].resize(ranks);
          for (std::size_t point = begin; point < end; ++point)
          {
            float place[3];
            if (!HasBit(this->IsLater, point) && getPlace(point, place) &&
              std::any_of(others.begin(), others.end(),
                [&](const PlaceBounds& other) { return other.Meets(MakeBounds(place)); }))
            {
              found[chunk][FindKeeper(place, ranks)].push_back(static_cast<std::uint32_t>(point));
            }
          }
        });
      mine.resize(ranks);
      for (const PointsByRank& ofChunk : found)
      {
        for (std::size_t keeper = 0; keeper < ofChunk.size(); ++keeper)
        {
          mine[keeper].insert(mine[keeper].end(), ofChunk[keeper].begin(), ofChunk[keeper].end());
        }
      }
    });

  const Candidates candidates = this->SendCandidates(what, mine, getPlace);
  PointsByRank answers;
  RankExchange exchange{ sizeof(std::uint32_t), {}, {}, {} };
  const auto anySlots = this->Messages.GatherValueTogether(what,
    [&]
    {
      answers = this->FillSlots(candidates, threads);
      this->Sent.resize(ranks);
      exchange.Counts = CountAll(answers);
      return static_cast<std::uint8_t>(this->SlotCount > 0);
    });
  this->AreSpread =
    std::any_of(anySlots.begin(), anySlots.end(), [](std::uint8_t any) { return any != 0; });
  if (!this->AreSpread)
  {
    return;
  }
  const auto write = [&](int to, std::uint64_t first, std::size_t count, std::byte* bytes)
  { std::memcpy(bytes, answers[to].data() + first, count * sizeof(std::uint32_t)); };
  const auto read = [&](int from, std::uint64_t, std::size_t count, const std::byte* bytes)
  {
    for (std::size_t index = 0; index < count; ++index)
    {
      std::uint32_t candidate;
      std::memcpy(&candidate, bytes + index * sizeof(candidate), sizeof(candidate));
      if (candidate >= mine[from].size())
      {
        ThrowUnexpectedRecords();
      }
      this->Sent[from].push_back(mine[from][candidate]);
    }
  };
  exchange.WriteRecords = write;
  exchange.ReadRecords = read;
  exchange.Run(what, this->Messages);
}

SharedPlaces::Candidates SharedPlaces::SendCandidates(
  std::string_view what, const PointsByRank& points, GetPlaceFunction getPlace) const
{
  Candidates candidates;
  RankExchange exchange{ sizeof(Candidates::Place), {}, {}, {} };
  this->Messages.RunTogether(what,
    [&]
    {
      candidates.OfRanks.resize(points.size());
      exchange.Counts = CountAll(points);
    });
  const auto write = [&](int to, std::uint64_t first, std::size_t count, std::byte* bytes)
  {
    for (std::size_t index = 0; index < count; ++index)
    {
      Candidates::Place place{};
      getPlace(points[to][first + index], place.At);
      std::memcpy(bytes + index * sizeof(place), &place, sizeof(place));
    }
  };
  const auto read = [&](int from, std::uint64_t, std::size_t count, const std::byte* bytes)
  {
    std::vector<Candidates::Place>& places = candidates.OfRanks[from];
    const std::size_t before = places.size();
    places.resize(before + count);
    std::memcpy(places.data() + before, bytes, count * sizeof(Candidates::Place));
  };
  exchange.WriteRecords = write;
  exchange.ReadRecords = read;
  exchange.Run(what, this->Messages);
  return candidates;
}

SharedPlaces::PointsByRank SharedPlaces::FillSlots(const Candidates& candidates, int threads)
{
  const std::size_t ranks = candidates.OfRanks.size();
  std::vector<std::uint64_t> begins(1, 0);
  for (const std::vector<Candidates::Place>& ofRank : candidates.OfRanks)
  {
    begins.push_back(begins.back() + ofRank.size());
  }
  const auto findRank = [&](std::uint64_t candidate)
  {
    return static_cast<std::size_t>(
      std::upper_bound(begins.begin(), begins.end(), candidate) - begins.begin() - 1);
  };
  const EqualPlaces equal = FindEqualPlaces(
    begins.back(),
    [&](std::uint64_t candidate, float place[3])
    {
      const std::size_t rank = findRank(candidate);
      std::copy_n(candidates.OfRanks[rank][candidate - begins[rank]].At, 3, place);
      return true;
    },
    threads);

  // A rank sends each place once: equal places are of several ranks.
  std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> found(ranks);
  equal.ForEach(
    [&](const std::uint32_t* places, std::uint32_t count)
    {
      for (std::uint32_t index = 0; index < count; ++index)
      {
        const std::size_t rank = findRank(places[index]);
        found[rank].emplace_back(
          static_cast<std::uint32_t>(places[index] - begins[rank]), this->SlotCount);
      }
      ++this->SlotCount;
    });
  PointsByRank answers(ranks);
  this->Slots.resize(ranks);
  for (std::size_t rank = 0; rank < ranks; ++rank)
  {
    std::sort(found[rank].begin(), found[rank].end());
    for (const auto& [candidate, slot] : found[rank])
    {
      answers[rank].push_back(candidate);
      this->Slots[rank].push_back(slot);
    }
  }
  return answers;
}

void SharedPlaces::Sum(std::string_view what, std::int64_t* records, std::size_t width) const
{
  const std::size_t bytes = width * sizeof(std::int64_t);
  this->CombineRecords(what,
    { bytes,
      [&](std::uint64_t point, std::byte* record)
      { std::memcpy(record, records + point * width, bytes); },
      [&](std::uint64_t point, const std::byte* record)
      { std::memcpy(records + point * width, record, bytes); },
      [&](std::byte* record, const std::byte* other)
      {
        for (std::size_t offset = 0; offset < bytes; offset += sizeof(std::int64_t))
        {
          std::uint64_t sum;
          std::uint64_t more;
          std::memcpy(&sum, record + offset, sizeof(sum));
          std::memcpy(&more, other + offset, sizeof(more));
          sum += more;
          std::memcpy(record + offset, &sum, sizeof(sum));
        }
      } });
}

void SharedPlaces::CombineRecords(std::string_view what, const Records& records) const
{
  this->Messages.RunTogether(what,
    [&]
    {
      std::vector<std::byte> sum(records.Bytes);
      std::vector<std::byte> other(records.Bytes);
      this->Own.ForEach(
        [&](const std::uint32_t* equal, std::uint32_t count)
        {
          records.Get(equal[0], sum.data());
          for (std::uint32_t index = 1; index < count; ++index)
          {
            records.Get(equal[index], other.data());
            records.Combine(sum.data(), other.data());
          }
          records.Set(equal[0], sum.data());
        });
    });
  if (this->AreSpread)
  {
    this->CombineAcrossRanks(what, records);
  }
  this->Messages.RunTogether(what,
    [&]
    {
      std::vector<std::byte> sum(records.Bytes);
      this->Own.ForEach(
        [&](const std::uint32_t* equal, std::uint32_t count)
        {
          records.Get(equal[0], sum.data());
          std::for_each(
            equal + 1, equal + count, [&](std::uint32_t point) { records.Set(point, sum.data()); });
        });
    });
}

void SharedPlaces::CombineAcrossRanks(std::string_view what, const Records& records) const
{
  const std::size_t bytes = records.Bytes;
  std::vector<std::byte> sums;
  std::vector<std::uint8_t> areFilled;
  RankExchange toKeepers{ bytes, {}, {}, {} };
  RankExchange fromKeepers{ bytes, {}, {}, {} };
  this->Messages.RunTogether(what,
    [&]
    {
      sums.resize(this->SlotCount * bytes);
      areFilled.resize(this->SlotCount, 0);
      toKeepers.Counts = CountAll(this->Sent);
      fromKeepers.Counts = CountAll(this->Slots);
    });

  const auto writeOwn = [&](int to, std::uint64_t first, std::size_t count, std::byte* out)
  {
    for (std::size_t index = 0; index < count; ++index)
    {
      records.Get(this->Sent[to][first + index], out + index * bytes);
    }
  };
  const auto combine = [&](int from, std::uint64_t first, std::size_t count, const std::byte* in)
  {
    const std::vector<std::uint32_t>& slots = this->Slots[from];
    if (first + count > slots.size())
    {
      ThrowUnexpectedRecords();
    }
    for (std::size_t index = 0; index < count; ++index)
    {
      const std::uint32_t slot = slots[first + index];
      std::byte* const sum = sums.data() + slot * bytes;
      if (areFilled[slot] != 0)
      {
        records.Combine(sum, in + index * bytes);
      }
      else
      {
        std::copy_n(in + index * bytes, bytes, sum);
        areFilled[slot] = 1;
      }
    }
  };
  toKeepers.WriteRecords = writeOwn;
  toKeepers.ReadRecords = combine;
  toKeepers.Run(what, this->Messages);

  const auto writeSums = [&](int to, std::uint64_t first, std::size_t count, std::byte* out)
  {
    for (std::size_t index = 0; index < count; ++index)
    {
      std::copy_n(sums.data() + this->Slots[to][first + index] * bytes, bytes, out + index * bytes);
    }
  };
  const auto replace = [&](int from, std::uint64_t first, std::size_t count, const std::byte* in)
  {
    const std::vector<std::uint32_t>& points = this->Sent[from];
    if (first + count > points.size())
    {
      ThrowUnexpectedRecords();
    }
    for (std::size_t index = 0; index < count; ++index)
    {
      records.Set(points[first + index], in + index * bytes);
    }
  };
  fromKeepers.WriteRecords = writeSums;
  fromKeepers.ReadRecords = replace;
  fromKeepers.Run(what, this->Messages);
}

} // namespace bricks
