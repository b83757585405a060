// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/build/VoxelIndex.h"

#include "DSMCore/base/Error.h"
#include "DSMRayTracing/base/ByteHash.h"
#include "DSMRayTracing/base/ParallelFor.h"
#include "DSMRayTracing/layout/MacrocellBuilder.h"
#include "DSMRayTracing/layout/VoxelBrickHeader.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace rt
{

namespace
{

/// The ranks ask one another so often whether to go on.
constexpr std::size_t Rounds = 64;

std::uint64_t Hash(const std::byte* bytes, std::size_t count)
{
  ByteHash hash;
  hash.Add(bytes, count);
  return hash.Get();
}

bool IsSurveyable(const ValueRange& range)
{
  return range.First < range.Last && std::isfinite(range.First) && std::isfinite(range.Last);
}

/// What is found of a brick.
struct Seen
{
  ValueRange Range;
  dsm::ByteDigest Digest;
};

/// Looks through a rank's bricks, with several threads.
class Looker
{
public:
  Looker(const BrickLattice& lattice, const dsm::BlockReader& reader, const ValueRange& guess,
    int threads)
    : Lattice(lattice)
    , Reader(reader)
    , Guess(guess)
    , Threads(std::max(1, threads))
    , Surveys(static_cast<std::size_t>(this->Threads))
    , Blocks(static_cast<std::size_t>(this->Threads))
  {
  }

  void Look(const dsm::BlockId* ids, std::size_t count, Seen* seen)
  {
    ParallelFor(this->Threads, count,
      [&](std::size_t index, int thread)
      {
        std::vector<std::byte>& block = this->Blocks[static_cast<std::size_t>(thread)];
        block.resize(this->Lattice.GetBlockBytes(ids[index]));
        this->Reader.Read(ids[index], block.data(), block.size());
        VoxelBrickHeader header;
        std::memcpy(&header, block.data(), sizeof(header));
        seen[index] = { { header.First, header.Last }, {} };
        seen[index].Digest.Add(block.data(), block.size());
        if (IsSurveyable(this->Guess))
        {
          this->Surveys[static_cast<std::size_t>(thread)].CountBrick(
            this->Lattice, ids[index], block.data(), this->Guess);
        }
      });
  }

  IsovalueSurvey GetSurvey() const
  {
    IsovalueSurvey sum;
    for (const IsovalueSurvey& one : this->Surveys)
    {
      sum.Add(one);
    }
    sum.Range = this->Guess;
    return sum;
  }

private:
  const BrickLattice& Lattice;
  const dsm::BlockReader& Reader;
  ValueRange Guess;
  int Threads;
  std::vector<IsovalueSurvey> Surveys;
  std::vector<std::vector<std::byte>> Blocks;
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
  bytes.reserve(this->Bricks.size() * (sizeof(ValueRange) + sizeof(dsm::ByteDigest)) +
    sizeof(IsovalueSurvey) + sizeof(std::uint64_t));
  add(this->Bricks.data(), this->Bricks.size() * sizeof(ValueRange));
  add(&this->Survey, sizeof(IsovalueSurvey));
  add(this->Digests.data(), this->Digests.size() * sizeof(dsm::ByteDigest));
  const std::uint64_t hash = Hash(bytes.data(), bytes.size());
  add(&hash, sizeof(hash));
  return bytes;
}

std::optional<VoxelIndex> VoxelIndex::Decode(
  const std::vector<std::byte>& bytes, std::size_t bricks)
{
  const std::size_t endOfSurvey = bricks * sizeof(ValueRange) + sizeof(IsovalueSurvey);
  const std::size_t digestBytes = bricks * sizeof(dsm::ByteDigest);
  std::uint64_t hash = 0;
  const bool hasDigests = bytes.size() == endOfSurvey + digestBytes + sizeof(hash);
  if (!hasDigests && bytes.size() != endOfSurvey + sizeof(hash))
  {
    return std::nullopt;
  }
  const std::size_t end = bytes.size() - sizeof(hash);
  std::memcpy(&hash, bytes.data() + end, sizeof(hash));
  if (hash != Hash(bytes.data(), end))
  {
    return std::nullopt;
  }
  VoxelIndex index;
  index.Bricks.resize(bricks);
  std::memcpy(index.Bricks.data(), bytes.data(), bricks * sizeof(ValueRange));
  std::memcpy(&index.Survey, bytes.data() + bricks * sizeof(ValueRange), sizeof(IsovalueSurvey));
  if (hasDigests)
  {
    index.Digests.resize(bricks);
    std::memcpy(index.Digests.data(), bytes.data() + endOfSurvey, digestBytes);
  }
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

ValueRange VoxelIndex::Round(ScalarType type, double least, double greatest)
{
  return least > greatest
    ? ValueRange{ 1.0f, -1.0f }
    : Dispatch(type,
        [&](auto zero)
        {
          using T = decltype(zero);
          return ValueRange{ RoundDown(static_cast<T>(least)), RoundUp(static_cast<T>(greatest)) };
        });
}

VoxelIndex VoxelIndex::Find(dsm::Messenger& messenger, const BrickLattice& lattice,
  const dsm::BlockReader& reader, const Pass& pass, dsm::FunctionRef<void(double)> progress)
{
  const char* const what = "Looking through the volume";
  const auto ranks = static_cast<std::size_t>(messenger.GetSize());
  const std::size_t count = pass.Order.size();
  const auto getBegin = [=](std::size_t rank) { return count * rank / ranks; };
  const std::size_t begin = getBegin(static_cast<std::size_t>(messenger.GetRank()));
  const std::size_t mine = getBegin(static_cast<std::size_t>(messenger.GetRank()) + 1) - begin;
  std::vector<Seen> seen;
  std::optional<Looker> looker;
  messenger.RunTogether(what,
    [&]
    {
      seen.resize(mine);
      looker.emplace(lattice, reader, pass.Guess, pass.Threads);
    });
  for (std::size_t round = 0; round < Rounds; ++round)
  {
    messenger.RunTogether(what,
      [&]
      {
        const std::size_t first = mine * round / Rounds;
        looker->Look(pass.Order.data() + begin + first, mine * (round + 1) / Rounds - first,
          seen.data() + first);
        if (progress)
        {
          progress(static_cast<double>(round + 1) / Rounds);
        }
      });
  }
  const auto parts = messenger.GatherTogether(what,
    [&]
    {
      std::vector<std::byte> bytes(mine * sizeof(Seen));
      std::memcpy(bytes.data(), seen.data(), bytes.size());
      return bytes;
    });
  VoxelIndex index;
  messenger.RunTogether(what,
    [&]
    {
      index.Bricks.resize(count);
      index.Digests.resize(count);
      for (std::size_t rank = 0; rank < ranks; ++rank)
      {
        for (std::size_t place = getBegin(rank); place < getBegin(rank + 1); ++place)
        {
          Seen one;
          std::memcpy(
            &one, parts[rank].data() + (place - getBegin(rank)) * sizeof(Seen), sizeof(Seen));
          index.Bricks[pass.Order[place]] = one.Range;
          index.Digests[pass.Order[place]] = one.Digest;
        }
      }
    });
  for (const IsovalueSurvey& survey : messenger.AllGatherValue(looker->GetSurvey()))
  {
    index.Survey.Add(survey);
  }
  index.Survey.Range = pass.Guess;
  const ValueRange all = MacrocellHierarchy(lattice, index.Bricks).GetRange();
  if (!index.Survey.IsOf(all) && IsSurveyable(all))
  {
    Pass again = pass;
    again.Guess = all;
    return Find(messenger, lattice, reader, again, progress);
  }
  return index;
}

} // namespace rt
