// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/sorted/SortedBrickBuilder.h"

#include "DSMBricks/base/ParallelFor.h"
#include "DSMCore/base/Error.h"
#include "DSMCore/memory/HostMemory.h"
#include "DSMCore/publish/ConcurrentFragmentSource.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <string>

namespace bricks
{

namespace
{

constexpr std::size_t ChunkSize = std::size_t(1) << 16;

/// Beyond this, products of coordinates leave the range of floats; bricks have them in a larger unit.
constexpr double LargestUnscaled = 1e18;

/// The camera and the depth of VTK and OpenGL end soon after this.
constexpr double LargestCoordinate = 1e30;

/// Memory for each primitive of a rank's own piece during sorting, in bytes.
constexpr double OwnPrimitiveBytes = 32.0;

struct Bounds
{
  glm::dvec3 Lower{ std::numeric_limits<double>::infinity() };
  glm::dvec3 Upper{ -std::numeric_limits<double>::infinity() };

  void Add(const Bounds& other)
  {
    this->Lower = glm::min(this->Lower, other.Lower);
    this->Upper = glm::max(this->Upper, other.Upper);
  }
};

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
  const SortedBrickSettings& settings, dsm::Messenger& messenger)
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
  this->Cells.emplace(
    this->Reader, this->Order, this->LargestCount, this->Settings.Threads, this->Messages);
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
      const double own = OwnPrimitiveBytes * static_cast<double>(this->Reader.GetCount());
      const double each = static_cast<double>(this->Kind.RecordBytes) + this->Kind.BrickBytes;
      const auto all = static_cast<double>(this->GivenCount);
      const double share = all * each / this->Messages.GetSize();
      if (own + share > static_cast<double>(available))
      {
        const std::string dataset = this->Kind.Dataset;
        const std::string primitives = this->Kind.Primitives;
        throw dsm::Error("The " + dataset + " has " + std::to_string(this->GivenCount) + " " +
          primitives + ". To cut them into bricks, this rank needs about " +
          dsm::FormatMebibytes(static_cast<std::uint64_t>(own + share)) + ", but has " +
          dsm::FormatMebibytes(available) + ". Use at least " +
          std::to_string(static_cast<std::uint64_t>(
            std::ceil(all * (OwnPrimitiveBytes + each) / static_cast<double>(available)))) +
          " ranks with as much memory, each with a part of the " + dataset + ", or a " + dataset +
          " with fewer " + primitives + ".");
      }
    });
}

void SortedBrickBuilder::FindSpace()
{
  Bounds mine;
  this->Messages.RunTogether(this->What,
    [&]
    {
      std::vector<Bounds> ofThread(this->Settings.Threads);
      ParallelForChunks(this->Settings.Threads, this->Reader.GetCount(), ChunkSize,
        [&](std::size_t begin, std::size_t end, std::size_t, int thread)
        {
          Bounds bounds;
          for (std::size_t primitive = begin; primitive < end; ++primitive)
          {
            Bounds own;
            if (this->Reader.FindBounds(primitive, own.Lower, own.Upper))
            {
              bounds.Add(own);
            }
          }
          ofThread[thread].Add(bounds);
        });
      for (const Bounds& bounds : ofThread)
      {
        mine.Add(bounds);
      }
      Bounds others;
      this->Reader.FindOtherBounds(others.Lower, others.Upper);
      if (others.Lower.x <= others.Upper.x)
      {
        mine.Add(others);
      }
    });
  Bounds all;
  for (const Bounds& bounds : this->Messages.AllGatherValue(mine))
  {
    all.Add(bounds);
  }
  if (all.Lower.x <= all.Upper.x)
  {
    this->SetSpace(all.Lower, all.Upper);
  }
  this->Reader.SetSpace(this->Space);
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
  const std::uint64_t threads = static_cast<std::uint64_t>(this->Settings.Threads);
  const std::uint64_t cells = this->Cells->GetCount();
  for (std::uint64_t thread = 0; thread < threads; ++thread)
  {
    sources.push_back(std::make_unique<RecordSource>(
      this->Reader, *this->Cells, cells * thread / threads, cells * (thread + 1) / threads));
  }
  return std::make_unique<dsm::ConcurrentFragmentSource>(std::move(sources));
}

SortedBricks SortedBrickBuilder::Build(dsm::FunctionRef<void(double)> progress)
{
  using Progress = dsm::FunctionRef<void(double)>;
  // Approximate shares of the time: reading, building, copying.
  const auto ofReading = [&](double done) { progress(0.2 + 0.3 * done); };
  BricksOfCells bricksOfCells;
  {
    std::unique_ptr<dsm::FragmentSource> source;
    this->Messages.RunTogether(this->What, [&] { source = this->CreateRecordSource(); });
    const RecordBlocks records(this->What, *this->Cells, this->Reader, *source, this->Messages,
      progress ? Progress(ofReading) : Progress());
    this->Messages.RunTogether(this->What, [&] { bricksOfCells = this->BuildOwnBricks(records); });
  }
  SortedBricks bricks = this->GatherBricks(std::move(bricksOfCells));
  this->Cells.reset();
  return bricks;
}

SortedBrickBuilder::BricksOfCells SortedBrickBuilder::BuildOwnBricks(
  const RecordBlocks& records) const
{
  BricksOfCells bricks(records.GetCount());
  std::vector<std::unique_ptr<RecordBrickBuilder>> builders(this->Settings.Threads);
  for (auto& builder : builders)
  {
    builder = this->Reader.CreateBuilder(this->Order, this->LargestCount);
  }
  ParallelFor(this->Settings.Threads, bricks.size(),
    [&](std::size_t index, int thread)
    {
      bricks[index] = builders[thread]->Build(
        records.GetRecords(index), this->Cells->GetPrimitiveCount(records.GetCell(index)));
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
