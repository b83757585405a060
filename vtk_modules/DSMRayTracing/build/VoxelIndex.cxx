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

  void Look(const dsm::BlockId* ids, std::size_t count, ValueRange* ranges)
  {
    ParallelFor(this->Threads, count,
      [&](std::size_t index, int thread)
      {
        std::vector<std::byte>& block = this->Blocks[static_cast<std::size_t>(thread)];
        block.resize(this->Lattice.GetBlockBytes(ids[index]));
        this->Reader.Read(ids[index], block.data(), block.size());
        VoxelBrickHeader header;
        std::memcpy(&header, block.data(), sizeof(header));
        ranges[index] = { header.First, header.Last };
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
  bytes.reserve(
    this->Bricks.size() * sizeof(ValueRange) + sizeof(IsovalueSurvey) + sizeof(std::uint64_t));
  add(this->Bricks.data(), this->Bricks.size() * sizeof(ValueRange));
  add(&this->Survey, sizeof(IsovalueSurvey));
  const std::uint64_t hash = Hash(bytes.data(), bytes.size());
  add(&hash, sizeof(hash));
  return bytes;
}

std::optional<VoxelIndex> VoxelIndex::Decode(
  const std::vector<std::byte>& bytes, std::size_t bricks)
{
  const std::size_t end = bricks * sizeof(ValueRange) + sizeof(IsovalueSurvey);
  std::uint64_t hash = 0;
  if (bytes.size() != end + sizeof(hash))
  {
    return std::nullopt;
  }
  std::memcpy(&hash, bytes.data() + end, sizeof(hash));
  if (hash != Hash(bytes.data(), end))
  {
    return std::nullopt;
  }
  VoxelIndex index;
  index.Bricks.resize(bricks);
  std::memcpy(index.Bricks.data(), bytes.data(), bricks * sizeof(ValueRange));
  std::memcpy(&index.Survey, bytes.data() + bricks * sizeof(ValueRange), sizeof(IsovalueSurvey));
  return index;
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
  std::vector<ValueRange> ranges;
  std::optional<Looker> looker;
  messenger.RunTogether(what,
    [&]
    {
      ranges.resize(mine);
      looker.emplace(lattice, reader, pass.Guess, pass.Threads);
    });
  for (std::size_t round = 0; round < Rounds; ++round)
  {
    messenger.RunTogether(what,
      [&]
      {
        const std::size_t first = mine * round / Rounds;
        looker->Look(pass.Order.data() + begin + first, mine * (round + 1) / Rounds - first,
          ranges.data() + first);
        if (progress)
        {
          progress(static_cast<double>(round + 1) / Rounds);
        }
      });
  }
  const auto parts = messenger.GatherTogether(what,
    [&]
    {
      std::vector<std::byte> bytes(mine * sizeof(ValueRange));
      std::memcpy(bytes.data(), ranges.data(), bytes.size());
      return bytes;
    });
  VoxelIndex index;
  messenger.RunTogether(what,
    [&]
    {
      index.Bricks.resize(count);
      for (std::size_t rank = 0; rank < ranks; ++rank)
      {
        for (std::size_t place = getBegin(rank); place < getBegin(rank + 1); ++place)
        {
          std::memcpy(&index.Bricks[pass.Order[place]],
            parts[rank].data() + (place - getBegin(rank)) * sizeof(ValueRange), sizeof(ValueRange));
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
