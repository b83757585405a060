// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMNestedLevels.h"

#include "DSMBricks/layout/DealBricks.h"
#include "DSMBricks/layout/VoxelBrickHeader.h"
#include "DSMBricks/levels/LevelLattice.h"
#include "vtkDSMGather.h"

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

namespace
{

using bricks::Box;
using bricks::DivideUp;
using bricks::Index3;

/// A level of so few bricks is shown whole, wherever the camera is; one of so many where the levels that a picture
/// needs are next to one another.
constexpr std::int64_t FewBricks = std::int64_t(1) << 12;
constexpr std::int64_t SomeBricks = std::int64_t(1) << 18;

/// How far a level's samples may be from where whole numbers of the finest ones are.
constexpr double MostStretch = 0.1;

std::int64_t CountBricks(const Box& cells)
{
  const Index3 bricks = DivideUp(cells.GetSize(), Index3(vtkDSMNestedLevels::Edge));
  return bricks.x * bricks.y * bricks.z;
}

/// Finest samples in one of another level along each axis; none where the levels do not lie along the same axes.
std::optional<Index3> FindScale(const glm::dmat4& toFinest)
{
  Index3 scale;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double size = toFinest[axis][axis];
    scale[axis] = std::max<std::int64_t>(1, std::llround(size));
    for (int other = 0; other < 3; ++other)
    {
      if (other != axis && std::abs(toFinest[axis][other]) > 1e-6 * std::abs(size))
      {
        return std::nullopt;
      }
    }
    if (!(std::abs(size / static_cast<double>(scale[axis]) - 1.0) < MostStretch))
    {
      return std::nullopt;
    }
  }
  return scale;
}

} // namespace

/// Reads bricks, and keeps the ranges of those whose values are the same in every box.
class vtkDSMNestedLevels::NotingReader final : public dsm::BlockReader
{
public:
  NotingReader(std::shared_ptr<const vtkDSMNestedLevels> levels,
    std::shared_ptr<const vol::FileBrickReader> reader, const bricks::BrickLattice& lattice,
    const bricks::Box& box, int level)
    : Levels(std::move(levels))
    , Reader(std::move(reader))
    , Lattice(lattice)
    , Box(box)
    , Level(level)
  {
  }

  void Read(dsm::BlockId id, std::byte* block, std::size_t bytes) const override
  {
    this->Reader->Read(id, block, bytes);
    this->Note(id, block);
  }
  bool ReadWithoutWaiting(dsm::BlockId id, std::byte* block, std::size_t bytes) const override
  {
    const bool isRead = this->Reader->ReadWithoutWaiting(id, block, bytes);
    if (isRead)
    {
      this->Note(id, block);
    }
    return isRead;
  }
  bool MayPrefetch() const override { return this->Reader->MayPrefetch(); }
  void Prefetch(const std::vector<dsm::BlockId>& ids) const override
  {
    this->Reader->Prefetch(ids);
  }

private:
  void Note(dsm::BlockId id, const std::byte* block) const
  {
    const Index3 brick = this->Lattice.GetBrick(id);
    if (this->Levels->ContinuesCoarser(this->Box, this->Level, brick))
    {
      return;
    }
    bricks::VoxelBrickHeader header;
    std::memcpy(&header, block, sizeof(header));
    const std::lock_guard<std::mutex> lock(this->Levels->RangesLock);
    this->Levels->ReadRanges.push_back({ this->Level,
      this->Levels->GetNumber(this->Box, this->Level, brick), { header.First, header.Last } });
  }

  std::shared_ptr<const vtkDSMNestedLevels> Levels;
  std::shared_ptr<const vol::FileBrickReader> Reader;
  bricks::BrickLattice Lattice;
  bricks::Box Box;
  int Level;
};

std::shared_ptr<vtkDSMNestedLevels> vtkDSMNestedLevels::Create(
  Volumes volumes, const bricks::BrickLattice& lattice)
{
  if (volumes.empty() || lattice.HasCellMask() || lattice.IsOfCells() ||
    volumes.front()->IsOfCells())
  {
    return nullptr;
  }
  std::shared_ptr<vtkDSMNestedLevels> levels(new vtkDSMNestedLevels);
  levels->FileType = lattice.GetScalarType();
  // Means of integers are not integers; a float holds those of 16 bits.
  levels->Type =
    levels->FileType == bricks::ScalarType::Float32 || bricks::GetBytes(levels->FileType) <= 2
    ? bricks::ScalarType::Float32
    : bricks::ScalarType::Float64;
  const std::shared_ptr<const vtkDSMFileVolume> finest = volumes.front();
  for (std::size_t level = 0; level < volumes.size(); ++level)
  {
    std::shared_ptr<const vtkDSMFileVolume>& volume = volumes[level];
    const std::optional<Index3> scale = FindScale(finest->GetIndexOf(*volume));
    const bool isNext = scale &&
      (levels->Scales.empty() ||
        (*scale != levels->Scales.back() &&
          glm::all(glm::equal(*scale % levels->Scales.back(), Index3(0)))));
    if (isNext)
    {
      levels->Scales.push_back(*scale);
      levels->Volume.push_back(std::move(volume));
      levels->FileLevels.push_back(static_cast<int>(level));
    }
  }
  levels->Ranges.resize(levels->Volume.size());
  return levels->GetCount() > 1 ? levels : nullptr;
}

Index3 vtkDSMNestedLevels::GetCells(int level) const
{
  return DivideUp(this->GetVolume(0).GetPoints() - Index3(1), this->GetScale(level));
}

double vtkDSMNestedLevels::GetDepth(const rt::SeenPart& seen, int level, double pixels) const
{
  return pixels > 0.0 ? seen.GetWidth(glm::dvec3(this->GetScale(level))) / pixels
                      : std::numeric_limits<double>::infinity();
}

int vtkDSMNestedLevels::FindLevel(const rt::SeenPart& seen, double depth, double pixels) const
{
  int level = this->GetCount() - 1;
  while (level > 0 && this->GetDepth(seen, level, pixels) > depth)
  {
    --level;
  }
  return level;
}

int vtkDSMNestedLevels::FindFarLevel(
  const rt::FrameRequest& request, const glm::dmat4& indexToWorld, double pixels) const
{
  const rt::SeenPart seen = this->FindSeen(request, indexToWorld);
  const auto all = seen.Find(std::numeric_limits<double>::infinity());
  return all
    ? this->FileLevels[static_cast<std::size_t>(this->FindLevel(seen, all->Farthest, pixels))]
    : 0;
}

vtkDSMNestedLevels::Boxes vtkDSMNestedLevels::FindBoxes(const rt::FrameRequest& request,
  const glm::dmat4& indexToWorld, double pixels, bool& isCoarse) const
{
  isCoarse = false;
  const int coarsest = this->GetCount() - 1;
  const rt::SeenPart seen = this->FindSeen(request, indexToWorld);
  const auto all = seen.Find(std::numeric_limits<double>::infinity());
  if (!all)
  {
    return {};
  }
  const int near = this->FindLevel(seen, all->Nearest, pixels);
  const std::int64_t bricks = CountBricks({ Index3(0), this->GetCells(near) });
  if (bricks <= FewBricks ||
    (bricks <= SomeBricks && this->FindLevel(seen, all->Farthest, pixels) <= near + 1))
  {
    return {};
  }
  Boxes boxes(static_cast<std::size_t>(this->GetCount()));
  boxes.back() = { Index3(0), this->GetCells(coarsest) };
  for (int level = coarsest - 1; level >= 0; --level)
  {
    const auto part = seen.Find(this->GetDepth(seen, level + 1, pixels));
    if (!part)
    {
      break;
    }
    // Whole bricks of the coarser level.
    const Index3 ratio = this->GetRatio(level);
    const glm::dvec3 brick(this->GetScale(level + 1) * Index3(Edge));
    const Index3 first(glm::floor(part->Lower / brick));
    const Index3 end = glm::max(Index3(glm::ceil(part->Upper / brick)), first + Index3(1));
    const Box& coarser = boxes[static_cast<std::size_t>(level) + 1];
    const Box box = bricks::Intersect({ glm::max(first * Index3(Edge), coarser.Min) * ratio,
                                        glm::min(end * Index3(Edge), coarser.Max) * ratio },
      { Index3(0), this->GetCells(level) });
    isCoarse = CountBricks(box) > MostBricks;
    if (box.IsEmpty() || isCoarse)
    {
      break;
    }
    boxes[static_cast<std::size_t>(level)] = box;
  }
  return boxes;
}

bricks::BrickLattice vtkDSMNestedLevels::GetLattice(const Boxes& boxes, int level) const
{
  return bricks::BrickLattice(
    boxes[static_cast<std::size_t>(level)].GetSize() + Index3(1), this->Type, false, Edge);
}

glm::dmat4 vtkDSMNestedLevels::GetToFinest(const Boxes& boxes, int level) const
{
  const glm::dvec3 scale(this->GetScale(level));
  const glm::dvec3 first(boxes[static_cast<std::size_t>(level)].Min);
  glm::dmat4 matrix(1.0);
  for (int axis = 0; axis < 3; ++axis)
  {
    matrix[axis][axis] = scale[axis];
    matrix[3][axis] = scale[axis] * first[axis];
  }
  return matrix;
}

Box vtkDSMNestedLevels::FindHole(const Boxes& boxes, int level) const
{
  if (level == 0 || boxes[static_cast<std::size_t>(level) - 1].IsEmpty())
  {
    return {};
  }
  const Box& own = boxes[static_cast<std::size_t>(level)];
  const Box& finer = boxes[static_cast<std::size_t>(level) - 1];
  const Index3 ratio = this->GetRatio(level - 1);
  return { finer.Min / ratio - own.Min, DivideUp(finer.Max, ratio) - own.Min };
}

std::shared_ptr<const vtkDSMNestedSource> vtkDSMNestedLevels::CreateSource(
  const Boxes& boxes, int level) const
{
  const bool isCoarsest = level + 1 == this->GetCount();
  const glm::dmat4 toFinest = this->GetVolume(0).GetIndexOf(this->GetVolume(level));
  vtkDSMNestedSource::Level of;
  of.Samples = this->GetVolume(level).CreateSamples(this->FileType);
  of.Type = this->FileType;
  of.Count = this->GetVolume(level).GetPoints();
  of.Cells = this->GetCells(level);
  for (int axis = 0; axis < 3; ++axis)
  {
    of.First[axis] = -toFinest[3][axis] / toFinest[axis][axis];
    of.Step[axis] = static_cast<double>(this->GetScale(level)[axis]) / toFinest[axis][axis];
  }
  return std::make_shared<const vtkDSMNestedSource>(of, boxes[static_cast<std::size_t>(level)],
    this->Type, isCoarsest ? nullptr : this->CreateSource(boxes, level + 1),
    isCoarsest ? Index3(1) : this->GetRatio(level));
}

dsm::BlockDirectory vtkDSMNestedLevels::CreateDirectory(
  const Boxes& boxes, int level, const bricks::BrickLattice& lattice, int ranks) const
{
  const auto source = this->CreateSource(boxes, level);
  const Index3 first = source->GetSamples({ Index3(0), Index3(1) }).Min;
  return lattice.CreateDirectory(
    bricks::DealBricks(lattice, this->GetVolume(level).GetChunk(), first, ranks));
}

std::shared_ptr<const dsm::BlockReader> vtkDSMNestedLevels::CreateReader(
  const Boxes& boxes, int level, const bricks::BrickLattice& lattice) const
{
  const auto source = this->CreateSource(boxes, level);
  const auto volume = this->Volume[static_cast<std::size_t>(level)];
  const auto prefetch = [source, volume](std::vector<Box> points)
  {
    std::transform(points.begin(), points.end(), points.begin(),
      [&](const Box& box) { return source->GetSamples(box); });
    volume->Prefetch(std::move(points));
  };
  return std::make_shared<const NotingReader>(this->shared_from_this(),
    std::make_shared<const vol::FileBrickReader>(lattice, source, prefetch), lattice,
    boxes[static_cast<std::size_t>(level)], level);
}

std::uint64_t vtkDSMNestedLevels::GetNumber(const Box& box, int level, const Index3& brick) const
{
  const Index3 all = DivideUp(this->GetCells(level), Index3(Edge));
  const Index3 at = box.Min / Index3(Edge) + brick;
  return static_cast<std::uint64_t>(at.x + all.x * (at.y + all.y * at.z));
}

bool vtkDSMNestedLevels::ContinuesCoarser(const Box& box, int level, const Index3& brick) const
{
  const Index3 last = DivideUp(box.GetSize(), Index3(Edge)) - Index3(1);
  const Index3 cells = this->GetCells(level);
  for (int axis = 0; axis < 3; ++axis)
  {
    if ((brick[axis] == 0 && box.Min[axis] > 0) ||
      (brick[axis] == last[axis] && box.Max[axis] < cells[axis]))
    {
      return true;
    }
  }
  return false;
}

std::vector<bricks::ValueRange> vtkDSMNestedLevels::FindRanges(
  const Boxes& boxes, int level, const bricks::BrickLattice& lattice) const
{
  const Box& box = boxes[static_cast<std::size_t>(level)];
  std::vector<bricks::ValueRange> ranges = bricks::VoxelIndex::CreateUnknown(lattice, {}).Bricks;
  const auto& known = this->Ranges[static_cast<std::size_t>(level)];
  const Box hole = this->FindHole(boxes, level);
  bricks::ForEachIndex({ Index3(0), lattice.GetBricks() },
    [&](const Index3& brick)
    {
      bricks::ValueRange& range = ranges[lattice.GetId(brick)];
      const auto found = known.find(this->GetNumber(box, level, brick));
      const bool isKnown = found != known.end() && !this->ContinuesCoarser(box, level, brick);
      range = isKnown ? found->second : range;
      range = hole.Has(brick * Index3(Edge)) ? bricks::ValueRange::GetEmpty() : range;
    });
  return ranges;
}

void vtkDSMNestedLevels::ExchangeRanges(dsm::Messenger& messenger)
{
  std::vector<ReadRange> mine;
  messenger.RunTogether("Exchanging ranges of bricks",
    [&]
    {
      const std::lock_guard<std::mutex> lock(this->RangesLock);
      mine.swap(this->ReadRanges);
    });
  const std::vector<ReadRange> all = vtkDSMGather::Items(messenger, mine);
  messenger.RunTogether("Exchanging ranges of bricks",
    [&]
    {
      for (const ReadRange& one : all)
      {
        this->Ranges[static_cast<std::size_t>(one.Level)][one.Brick] = one.Range;
      }
    });
}
