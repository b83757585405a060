// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/sorted/SortedBrickBuilder.h"

#include "DSMBricks/base/ParallelFor.h"
#include "DSMBricks/base/SharedProgress.h"
#include "DSMCore/base/Error.h"
#include "DSMCore/memory/HostMemory.h"
#include "DSMCore/publish/ConcurrentFragmentSource.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>

namespace bricks
{

namespace
{

/// Approximate shares of the time: bounds, sorting, records of other ranks, building.
constexpr double EndOfBounds = 0.05;
constexpr double EndOfSorting = 0.2;
constexpr double EndOfRecords = 0.3;
constexpr double EndOfBricks = 0.9;

/// Beyond this, products of coordinates leave the range of floats; bricks have them in a larger unit.
constexpr double LargestUnscaled = 1e18;

/// The camera and the depth of VTK and OpenGL end soon after this.
constexpr double LargestCoordinate = 1e30;

/// Memory for each primitive of a rank's own piece during sorting, in bytes.
constexpr double OwnPrimitiveBytes = 32.0;

/// Summary of a brick, for messages between ranks.
struct BrickSummary
{
  float Lower[3];
  float Upper[3];
  ValueRange Range;
  std::uint32_t Bytes;
  /// How many more bricks the same cell has behind this one.
  std::uint32_t Following;
};

} // namespace

SortedBrickBuilder::SortedBrickBuilder(std::string_view what, RecordReader& reader,
  const SortedBrickSettings& settings, dsm::Messenger& messenger,
  dsm::FunctionRef<void(double)> progress)
  : What(what)
  , Reader(reader)
  , Kind(reader.GetKind())
  , Settings(settings)
  , Messages(messenger)
{
  this->Settings.Threads = std::max(settings.Threads, 1);
  for (const std::uint64_t count : this->Messages.AllGatherValue(this->Reader.GetCount()))
  {
    this->GivenCount += count;
  }
  this->CheckMemory();
  this->FindSpace();
  // Halving a cell that is too large leaves cells that are seven tenths full on the average.
  this->LargestCount =
    static_cast<std::uint32_t>(std::clamp(1.4 * this->Settings.BrickBytes / this->Kind.BrickBytes,
      1.0, static_cast<double>(this->Kind.LargestCount)));
  const auto ofSorting = [&](double done)
  { progress(EndOfBounds + (EndOfSorting - EndOfBounds) * done); };
  this->Cells.emplace(this->What, this->Reader, this->Order, this->LargestCount,
    this->Settings.Threads, this->Messages,
    progress ? dsm::FunctionRef<void(double)>(ofSorting) : progress);
  for (std::uint64_t cell = 0; cell < this->Cells->GetCount(); ++cell)
  {
    this->Count += this->Cells->GetPrimitiveCount(cell);
  }
}

void SortedBrickBuilder::CheckMemory()
{
  const int ranksOnHost = this->Messages.GetRanksOnHost();
  this->Messages.RunTogether(this->What,
    [&]
    {
      const std::uint64_t available = this->Settings.MemoryBytes > 0
        ? this->Settings.MemoryBytes
        : dsm::GetAvailableHostMemory() / static_cast<std::uint64_t>(ranksOnHost);
      const auto mine = static_cast<double>(this->Reader.GetCount());
      const double own = OwnPrimitiveBytes * mine;
      const auto all = static_cast<double>(this->GivenCount);
      const double ofRank = all / this->Messages.GetSize();
      // Only records of other ranks' primitives are kept.
      const auto recordBytes = static_cast<double>(this->Kind.RecordBytes);
      const double share =
        ofRank * this->Kind.BrickBytes + std::min(ofRank, all - mine) * recordBytes;
      if (own + share > static_cast<double>(available))
      {
        const std::string dataset = this->Kind.Dataset;
        const std::string primitives = this->Kind.Primitives;
        throw dsm::Error("The " + dataset + " has " + std::to_string(this->GivenCount) + " " +
          primitives + ". To cut them into bricks, this rank needs about " +
          dsm::FormatMebibytes(static_cast<std::uint64_t>(own + share)) + ", but has " +
          dsm::FormatMebibytes(available) + ". Use at least " +
          std::to_string(static_cast<std::uint64_t>(
            std::ceil(all * (OwnPrimitiveBytes + recordBytes + this->Kind.BrickBytes) /
              static_cast<double>(available)))) +
          " ranks with as much memory, each with a part of the " + dataset + ", or a " + dataset +
          " with fewer " + primitives + ".");
      }
    });
}

void SortedBrickBuilder::FindSpace()
{
  PositionBounds all;
  for (const PositionBounds& bounds : this->Messages.GatherValueTogether(
         this->What, [&] { return this->Reader.FindBounds(this->Settings.Threads); }))
  {
    all.Add(bounds);
  }
  if (!all.IsEmpty())
  {
    this->SetSpace(all.Lower, all.Upper);
  }
  this->Messages.RunTogether(
    this->What, [&] { this->Reader.SetSpace(this->Space, this->Settings.Threads); });
}

void SortedBrickBuilder::SetSpace(const glm::dvec3& lower, const glm::dvec3& upper)
{
  const glm::dvec3 size = upper - lower;
  const double extent = std::max({ size.x, size.y, size.z });
  double farthest = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    farthest = std::max({ farthest, std::abs(lower[axis]), std::abs(upper[axis]) });
  }
  if (farthest > LargestCoordinate)
  {
    char text[32];
    std::snprintf(text, sizeof(text), "%g", farthest);
    throw dsm::Error(std::string(this->What) + ": The " + this->Kind.Dataset +
      " has a coordinate of size " + text +
      "; the maximum is 1e30. Scale the dataset or remove the point.");
  }
  if (farthest > LargestUnscaled)
  {
    this->Space.Scale = std::exp2(std::ceil(std::log2(farthest / LargestUnscaled)));
  }
  const double perUnit = 1.0 / this->Space.Scale;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double middle = 0.5 * lower[axis] + 0.5 * upper[axis];
    if (extent > 0.0 && std::abs(middle) > 4.0 * extent)
    {
      const double unit = std::exp2(std::ceil(std::log2(extent)));
      this->Space.Origin[axis] = std::round(middle / unit) * unit;
    }
  }
  float corner[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    const double origin = this->Space.Origin[axis];
    corner[axis] = static_cast<float>((lower[axis] - origin) * perUnit);
    this->Space.Lower[axis] = corner[axis];
    this->Space.Upper[axis] = static_cast<float>((upper[axis] - origin) * perUnit);
  }
  this->Order = MortonCode(corner, extent * perUnit);
}

std::unique_ptr<dsm::FragmentSource> SortedBrickBuilder::CreateRecordSource() const
{
  std::vector<std::unique_ptr<dsm::FragmentSource>> sources;
  const std::uint64_t threads =
    this->Messages.GetSize() > 1 ? static_cast<std::uint64_t>(this->Settings.Threads) : 0;
  const std::uint64_t cells = this->Cells->GetCount();
  for (std::uint64_t thread = 0; thread < threads; ++thread)
  {
    sources.push_back(std::make_unique<RecordSource>(this->Reader, *this->Cells,
      cells * thread / threads, cells * (thread + 1) / threads,
      dsm::RoundRobinAssigner(this->Messages.GetSize()), this->Messages.GetRank()));
  }
  return std::make_unique<dsm::ConcurrentFragmentSource>(std::move(sources));
}

SortedBricks SortedBrickBuilder::Build(dsm::FunctionRef<void(double)> progress)
{
  using Progress = dsm::FunctionRef<void(double)>;
  const auto ofReading = [&](double done)
  { progress(EndOfSorting + (EndOfRecords - EndOfSorting) * done); };
  BricksOfCells bricksOfCells;
  {
    std::unique_ptr<dsm::FragmentSource> source;
    this->Messages.RunTogether(this->What, [&] { source = this->CreateRecordSource(); });
    const ArrivedRecords records(this->What, *this->Cells, this->Kind.RecordBytes, *source,
      this->Messages, progress ? Progress(ofReading) : Progress());
    this->Messages.RunTogether(
      this->What, [&] { bricksOfCells = this->BuildOwnBricks(records, progress); });
  }
  SortedBricks bricks = this->GatherBricks(std::move(bricksOfCells));
  this->Cells.reset();
  return bricks;
}

SortedBrickBuilder::BricksOfCells SortedBrickBuilder::BuildOwnBricks(
  const ArrivedRecords& arrived, dsm::FunctionRef<void(double)> progress) const
{
  BricksOfCells bricks(arrived.GetCellCount());
  const auto threads = static_cast<std::size_t>(this->Settings.Threads);
  std::vector<std::unique_ptr<RecordBrickBuilder>> builders(threads);
  std::vector<std::vector<std::uint32_t>> recordsOfThread(threads);
  for (auto& builder : builders)
  {
    builder = this->Reader.CreateBuilder(this->Order, this->LargestCount);
  }
  const std::size_t words = this->Kind.RecordBytes / sizeof(std::uint32_t);
  SharedProgress advance(progress, EndOfRecords, EndOfBricks, bricks.size());
  ParallelFor(this->Settings.Threads, bricks.size(),
    [&](std::size_t index, int thread)
    {
      const std::uint64_t cell = arrived.GetCell(index);
      const std::size_t count = this->Cells->GetPrimitiveCount(cell);
      std::vector<std::uint32_t>& records = recordsOfThread[static_cast<std::size_t>(thread)];
      records.resize(std::max(records.size(), count * words));
      const auto [begin, end] = this->Cells->GetRange(cell);
      this->Cells->ReadRecords(this->Reader, begin, end, records.data());
      std::memcpy(
        records.data() + (end - begin) * words, arrived.GetRecords(index), arrived.GetBytes(index));
      bricks[index] = builders[static_cast<std::size_t>(thread)]->Build(records.data(), count);
      advance.Add(thread);
    });
  return bricks;
}

SortedBricks SortedBrickBuilder::GatherBricks(BricksOfCells bricksOfCells)
{
  SortedBricks sorted;
  const auto all = this->Messages.GatherTogether(this->What,
    [&]
    {
      std::vector<std::byte> mine;
      for (const auto& bricks : bricksOfCells)
      {
        for (std::size_t index = 0; index < bricks.size(); ++index)
        {
          BrickSummary summary{};
          float lower[4];
          float upper[4];
          bricks[index].Bounds.Lower.Store(lower);
          bricks[index].Bounds.Upper.Store(upper);
          std::copy_n(lower, 3, summary.Lower);
          std::copy_n(upper, 3, summary.Upper);
          summary.Range = bricks[index].Range;
          summary.Bytes = static_cast<std::uint32_t>(bricks[index].Bytes.size());
          summary.Following = static_cast<std::uint32_t>(bricks.size() - 1 - index);
          const auto* bytes = reinterpret_cast<const std::byte*>(&summary);
          mine.insert(mine.end(), bytes, bytes + sizeof(summary));
        }
      }
      return mine;
    });

  // Cells in order, and of each the bricks in order: the same numbers on every rank.
  this->Messages.RunTogether(this->What,
    [&]
    {
      const dsm::RoundRobinAssigner assigner(this->Messages.GetSize());
      std::vector<std::size_t> next(all.size(), 0);
      std::size_t own = 0;
      for (std::uint64_t cell = 0; cell < this->Cells->GetCount(); ++cell)
      {
        const auto owner = static_cast<std::size_t>(assigner.GetOwner(cell));
        const bool isOwn = static_cast<int>(owner) == this->Messages.GetRank();
        BrickSummary summary{};
        std::size_t index = 0;
        do
        {
          if (next[owner] + sizeof(summary) > all[owner].size())
          {
            throw dsm::Error("Rank " + std::to_string(owner) +
              " did not build all its bricks. Do all ranks run the same build?");
          }
          std::memcpy(&summary, all[owner].data() + next[owner], sizeof(summary));
          next[owner] += sizeof(summary);
          if (isOwn)
          {
            RecordBrick& brick = bricksOfCells[own][index++];
            sorted.Own.push_back({ sorted.Bytes.size(), std::move(brick.Bytes) });
            sorted.Notes.push_back(std::move(brick.Notes));
          }
          const float lower[4] = { summary.Lower[0], summary.Lower[1], summary.Lower[2], 0.0f };
          const float upper[4] = { summary.Upper[0], summary.Upper[1], summary.Upper[2], 0.0f };
          sorted.Boxes.push_back({ Float4::Load(lower), Float4::Load(upper) });
          sorted.Ranges.push_back(summary.Range);
          sorted.Bytes.push_back(summary.Bytes);
        } while (summary.Following > 0);
        own += isOwn ? 1 : 0;
      }
    });
  return sorted;
}

} // namespace bricks
