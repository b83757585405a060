// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/build/VoxelIndex.h"

#include "DSMBricks/base/ByteHash.h"
#include "DSMBricks/base/ParallelFor.h"
#include "DSMBricks/layout/FillValues.h"
#include "DSMBricks/layout/VoxelBrickHeader.h"
#include "DSMCore/base/Error.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <type_traits>
#include <utility>

namespace bricks
{

namespace
{

/// Number of times that the ranks agree whether to continue.
constexpr std::size_t Rounds = 64;

std::uint64_t Hash(const std::byte* bytes, std::size_t count)
{
  ByteHash hash;
  hash.Add(bytes, count);
  return hash.Get();
}

/// Assigns bricks to ranks: a rank reports those that it has seen, and its part of those that no
/// rank has seen.
class Division
{
public:
  /// `seen`: boxes of all ranks. If several ranks have seen the same bricks, the first one reports
  /// them.
  Division(
    const BrickLattice& lattice, const std::vector<dsm::BlockId>& order, std::vector<Box> seen)
    : Seen(std::move(seen))
  {
    for (std::size_t rank = 0; rank < this->Seen.size(); ++rank)
    {
      const auto isSeenToo = [&](const Box& other)
      { return !Intersect(this->Seen[rank], other).IsEmpty(); };
      const auto self = this->Seen.begin() + static_cast<std::ptrdiff_t>(rank);
      if (std::any_of(this->Seen.begin(), self, isSeenToo))
      {
        *self = {};
      }
    }
    std::vector<bool> isSeen(order.size());
    for (const Box& bricks : this->Seen)
    {
      ForEachIndex(bricks, [&](const Index3& brick) { isSeen[lattice.GetId(brick)] = true; });
    }
    std::copy_if(order.begin(), order.end(), std::back_inserter(this->Others),
      [&](dsm::BlockId id) { return !isSeen[id]; });
  }

  const Box& GetSeen(std::size_t rank) const { return this->Seen[rank]; }
  const dsm::BlockId* GetBegin(std::size_t rank) const
  {
    return this->Others.data() + this->Others.size() * rank / this->Seen.size();
  }
  std::size_t CountOthers(std::size_t rank) const
  {
    return static_cast<std::size_t>(this->GetBegin(rank + 1) - this->GetBegin(rank));
  }

private:
  std::vector<Box> Seen;
  std::vector<dsm::BlockId> Others;
};

} // namespace

std::vector<std::byte> VoxelIndex::Encode() const
{
  std::vector<std::byte> bytes;
  const auto add = [&](const void* from, std::size_t count)
  {
    const auto* first = static_cast<const std::byte*>(from);
    bytes.insert(bytes.end(), first, first + count);
  };
  bytes.reserve(CountBytes(this->Bricks.size()));
  add(this->Bricks.data(), this->Bricks.size() * sizeof(ValueRange));
  add(&this->Survey, sizeof(IsovalueSurvey));
  add(this->Digests.data(), this->Digests.size() * sizeof(dsm::ByteDigest));
  const std::uint64_t hash = Hash(bytes.data(), bytes.size());
  add(&hash, sizeof(hash));
  return bytes;
}

std::size_t VoxelIndex::CountBytes(std::size_t bricks)
{
  return bricks * (sizeof(ValueRange) + sizeof(dsm::ByteDigest)) + sizeof(IsovalueSurvey) +
    sizeof(std::uint64_t);
}

std::optional<VoxelIndex> VoxelIndex::Decode(
  const std::vector<std::byte>& bytes, std::size_t bricks)
{
  // The first comparison keeps the products from wrapping around.
  if (bricks > bytes.size() || bytes.size() != CountBytes(bricks))
  {
    return std::nullopt;
  }
  const std::size_t endOfSurvey = bricks * sizeof(ValueRange) + sizeof(IsovalueSurvey);
  const std::size_t end = endOfSurvey + bricks * sizeof(dsm::ByteDigest);
  std::uint64_t hash = 0;
  std::memcpy(&hash, bytes.data() + end, sizeof(hash));
  if (hash != Hash(bytes.data(), end))
  {
    return std::nullopt;
  }
  VoxelIndex index;
  index.Bricks.resize(bricks);
  index.Digests.resize(bricks);
  std::memcpy(index.Bricks.data(), bytes.data(), bricks * sizeof(ValueRange));
  std::memcpy(&index.Survey, bytes.data() + bricks * sizeof(ValueRange), sizeof(IsovalueSurvey));
  std::memcpy(index.Digests.data(), bytes.data() + endOfSurvey, bricks * sizeof(dsm::ByteDigest));
  // The checksum detects damage, not a file that was made to deceive.
  return index.IsValid() ? std::optional<VoxelIndex>(std::move(index)) : std::nullopt;
}

bool VoxelIndex::IsValid() const
{
  constexpr std::int64_t edge = BrickLattice::LargestEdge / MacrocellEdge;
  const auto bricks = static_cast<std::int64_t>(this->Bricks.size());
  return this->Survey.IsValid(bricks * edge * edge * edge) &&
    std::none_of(this->Bricks.begin(), this->Bricks.end(),
      [](const ValueRange& range) { return std::isnan(range.First) || std::isnan(range.Last); });
}

VoxelIndex VoxelIndex::CreateUnknown(const BrickLattice& lattice, const IsovalueSurvey& survey)
{
  VoxelIndex index;
  index.Survey = survey;
  const ValueRange any = Dispatch(lattice.GetScalarType(),
    [](auto zero)
    {
      using Limits = std::numeric_limits<decltype(zero)>;
      using FloatLimits = std::numeric_limits<float>;
      return std::is_floating_point_v<decltype(zero)>
        ? ValueRange{ FloatLimits::lowest(), FloatLimits::max() }
        : ValueRange{ static_cast<float>(Limits::lowest()), static_cast<float>(Limits::max()) };
    });
  index.Bricks.assign(lattice.GetBrickCount(), any);
  return index;
}

std::vector<bool> VoxelIndex::Compare(const std::vector<dsm::ByteDigest>& digests,
  const std::vector<dsm::ByteDigest>& others, std::size_t bricks)
{
  std::vector<bool> differ(bricks, true);
  if (digests.size() == bricks && others.size() == bricks)
  {
    for (std::size_t brick = 0; brick < bricks; ++brick)
    {
      differ[brick] = digests[brick] != others[brick];
    }
  }
  return differ;
}

VoxelIndex VoxelIndex::Find(dsm::Messenger& messenger, const BrickLattice& lattice,
  const dsm::BlockReader& reader, const Pass& pass, dsm::FunctionRef<void(double)> progress)
{
  const char* const what = "Indexing the volume";
  const auto self = static_cast<std::size_t>(messenger.GetRank());
  const int threads = std::max(1, pass.Threads);
  const bool hasSeen = pass.Seen && pass.Seen->Lattice == lattice;
  std::vector<Box> boxes = messenger.AllGatherValue(hasSeen ? pass.Seen->Bricks : Box{});
  std::optional<Division> division;
  std::optional<BrickLooker> looker;
  std::vector<SeenBrick> seen; // in the order of the division
  messenger.RunTogether(what,
    [&]
    {
      division.emplace(lattice, pass.Order, std::move(boxes));
      if (!division->GetSeen(self).IsEmpty())
      {
        seen = pass.Seen->Seen;
      }
      seen.resize(seen.size() + division->CountOthers(self));
      looker.emplace(lattice, reader, threads, pass.IsFiller);
    });
  const std::size_t others = division->CountOthers(self);
  SeenBrick* const found = seen.data() + (seen.size() - others);
  for (std::size_t round = 0; round < Rounds; ++round)
  {
    messenger.RunTogether(what,
      [&]
      {
        const std::size_t first = others * round / Rounds;
        ParallelFor(threads, others * (round + 1) / Rounds - first,
          [&](std::size_t number, int thread)
          {
            const dsm::BlockId id = division->GetBegin(self)[first + number];
            looker->Read(id, thread);
            found[first + number] = looker->See(id, thread);
          });
        if (progress)
        {
          progress(static_cast<double>(round + 1) / Rounds);
        }
      });
  }
  const auto parts = messenger.GatherTogether(what,
    [&]
    {
      std::vector<std::byte> bytes(seen.size() * sizeof(SeenBrick));
      std::memcpy(bytes.data(), seen.data(), bytes.size());
      return bytes;
    });
  VoxelIndex index;
  messenger.RunTogether(what,
    [&]
    {
      index.Bricks.resize(lattice.GetBrickCount());
      index.Digests.resize(lattice.GetBrickCount());
      for (std::size_t rank = 0; rank < parts.size(); ++rank)
      {
        const std::byte* from = parts[rank].data();
        const auto take = [&](dsm::BlockId id)
        {
          SeenBrick one;
          std::memcpy(&one, from, sizeof(SeenBrick));
          from += sizeof(SeenBrick);
          index.Bricks[id] = one.Range;
          index.Digests[id] = one.Digest;
        };
        ForEachIndex(
          division->GetSeen(rank), [&](const Index3& brick) { take(lattice.GetId(brick)); });
        std::for_each(division->GetBegin(rank), division->GetBegin(rank + 1), take);
      }
    });
  IsovalueSurvey mine = looker->GetSurvey();
  if (!division->GetSeen(self).IsEmpty())
  {
    mine.Add(pass.Seen->Survey);
  }
  for (const IsovalueSurvey& survey : messenger.AllGatherValue(mine))
  {
    index.Survey.Add(survey);
  }
  return index;
}

void VoxelIndex::LeaveOutFills(dsm::Messenger& messenger, const BrickLattice& lattice,
  const dsm::BlockReader& reader, int threads)
{
  constexpr std::size_t mostBricks = 128;
  std::vector<dsm::BlockId> mine;
  const auto choose = [&]
  {
    std::vector<dsm::BlockId> all;
    for (std::size_t id = 0; id < this->Bricks.size(); ++id)
    {
      if (this->Bricks[id].First <= this->Bricks[id].Last)
      {
        all.push_back(static_cast<dsm::BlockId>(id));
      }
    }
    const std::size_t count = std::min(all.size(), mostBricks);
    const auto ranks = static_cast<std::size_t>(messenger.GetSize());
    for (auto number = static_cast<std::size_t>(messenger.GetRank()); number < count;
         number += ranks)
    {
      mine.push_back(all[all.size() * number / count]);
    }
  };
  const auto look = [&](const ValueLimits& limits)
  {
    LimitedSurvey sum;
    messenger.RunTogether("Indexing the volume",
      [&]
      {
        if (mine.empty())
        {
          choose();
        }
        const auto workers = static_cast<std::size_t>(std::max(1, threads));
        BrickLooker looker(lattice, reader, static_cast<int>(workers));
        std::vector<LimitedSurvey> parts(workers);
        ParallelFor(static_cast<int>(workers), mine.size(),
          [&](std::size_t number, int thread)
          {
            const dsm::BlockId id = mine[number];
            const std::byte* const block = looker.Read(id, thread);
            parts[static_cast<std::size_t>(thread)].CountBrick(
              lattice.GetCellsOfBrick(id), lattice.GetCells(), block, limits);
          });
        for (const LimitedSurvey& part : parts)
        {
          sum.Add(part);
        }
      });
    return AddSurveys(sum, messenger);
  };
  this->Survey = bricks::LeaveOutFills(this->Survey, { &this->Bricks }, look);
}

} // namespace bricks
