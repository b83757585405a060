// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/cells/CellRecords.h"

#include "DSMBricks/base/ParallelFor.h"
#include "DSMBricks/base/PrefetchLine.h"
#include "DSMBricks/cells/ShownCells.h"
#include "DSMCore/memory/BlockArena.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <tuple>
#include <utility>

namespace bricks
{

namespace
{

/// Points, when their positions are looked through.
enum PointState : std::uint8_t
{
  Unused,   ///< by any cell
  Used,     ///< by a shown cell of finite corners, or by a structured grid
  NotFinite ///< the position
};

/// Ascending by place, then by source.
bool IsBefore(const CornerRecord& one, const CornerRecord& other)
{
  const auto tie = [](const CornerRecord& corner) {
    return std::tie(corner.Place[0], corner.Place[1], corner.Place[2], corner.Rank, corner.Point);
  };
  return tie(one) < tie(other);
}

/// Bytes of a cell in a brick, approximately: corners, points, and nodes.
double EstimateBytes(int corners)
{
  return corners == 4 ? 6.0 + 0.25 * 8.0 + 2.0 : 11.0 + 1.25 * 8.0 + 2.0;
}

void GetCenter(const CornerRecord* corners, int count, double center[3])
{
  const double perCorner = count == 4 ? 0.25 : 0.125;
  for (int axis = 0; axis < 3; ++axis)
  {
    double sum = 0.0;
    for (int corner = 0; corner < count; ++corner)
    {
      sum += corners[corner].Place[axis];
    }
    center[axis] = sum * perCorner;
  }
}

} // namespace

CellRecordReader::CellRecordReader(const CellSource& source, int corners, int rank)
  : Source(source)
  , Corners(corners)
  , GivenCorners(source.HasOnlyTetrahedra() ? 4 : CellSource::MostCorners)
  , Rank(static_cast<std::uint32_t>(rank))
{
  std::uint64_t cell = 0;
  const auto addUpTo = [&](std::uint64_t end)
  {
    if (end > cell)
    {
      this->Runs.push_back({ this->Count, cell });
      this->Count += end - cell;
    }
  };
  for (const CellSource::Grid& grid : source.GetGrids())
  {
    addUpTo(grid.FirstCell);
    const Index3 cells = grid.Points - Index3(1);
    cell = grid.FirstCell + static_cast<std::uint64_t>(cells.x * cells.y * cells.z);
  }
  addUpTo(source.GetCellCount());
}

RecordKind CellRecordReader::GetKind() const
{
  return { "grid", "cells", static_cast<std::size_t>(this->Corners) * sizeof(CornerRecord),
    EstimateBytes(this->Corners),
    // Each cell may have points of its own.
    this->Corners == 4 ? CellBrickHeader::MostPoints / 4 : CellBrickHeader::MostPoints / 8 };
}

const CellRecordReader::Run& CellRecordReader::FindRun(std::uint64_t primitive) const
{
  const auto next = std::upper_bound(this->Runs.begin(), this->Runs.end(), primitive,
    [](std::uint64_t number, const Run& run) { return number < run.FirstPrimitive; });
  return *(next - 1);
}

template <class Visit>
void CellRecordReader::ForEachPrimitive(
  std::uint64_t begin, std::uint64_t end, const Visit& visit) const
{
  while (begin < end)
  {
    const Run& run = this->FindRun(begin);
    const std::uint64_t endOfRun =
      &run == &this->Runs.back() ? end : std::min(end, (&run + 1)->FirstPrimitive);
    const std::uint64_t toPrimitive = run.FirstPrimitive - run.FirstCell; // may wrap around
    ForEachCellRead(this->Source, begin - toPrimitive, endOfRun - toPrimitive,
      [&](std::uint64_t cell, const std::uint64_t* points, bool isShown)
      { visit(cell + toPrimitive, points, isShown); });
    begin = endOfRun;
  }
}

PositionBounds CellRecordReader::FindBounds(int threads) const
{
  constexpr std::size_t chunkSize = std::size_t(1) << 14;
  using State = std::atomic<std::uint8_t>;
  const std::uint64_t points = this->Source.GetPointCount();
  const dsm::BlockArena memory(points * sizeof(State));
  auto* const states = reinterpret_cast<State*>(memory.GetData());
  const auto getPosition = [this](std::uint64_t point)
  {
    glm::dvec3 position;
    this->Source.GetPosition(point, &position.x);
    return position;
  };
  const auto setStates = [&](std::uint64_t first, std::uint64_t count, PointState ofFinite)
  {
    ParallelForChunks(threads, count, chunkSize,
      [&](std::size_t begin, std::size_t end, std::size_t, int)
      {
        for (std::uint64_t point = first + begin; point < first + end; ++point)
        {
          const glm::dvec3 at = getPosition(point);
          const bool isFinite = std::isfinite(at.x) && std::isfinite(at.y) && std::isfinite(at.z);
          states[point].store(isFinite ? ofFinite : NotFinite, std::memory_order_relaxed);
        }
      });
  };
  setStates(0, points, Unused);
  for (const CellSource::Grid& grid : this->Source.GetGrids())
  {
    const Index3& size = grid.Points;
    setStates(grid.FirstPoint, static_cast<std::uint64_t>(size.x * size.y * size.z), Used);
  }
  ParallelForChunks(threads, this->Count, chunkSize,
    [&](std::size_t first, std::size_t last, std::size_t, int)
    {
      this->ForEachPrimitive(first, last,
        [&](std::uint64_t, const std::uint64_t* corners, bool isShown)
        {
          const auto isFinite = [states](std::uint64_t point)
          { return states[point].load(std::memory_order_relaxed) != NotFinite; };
          if (isShown && std::all_of(corners, corners + this->GivenCorners, isFinite))
          {
            std::for_each(corners, corners + this->GivenCorners,
              [states](std::uint64_t point)
              { states[point].store(Used, std::memory_order_relaxed); });
          }
        });
    });
  return FindPositionBounds(threads, points,
    [&](std::uint64_t point, PositionBounds& bounds)
    {
      if (states[point].load(std::memory_order_relaxed) == Used)
      {
        bounds.Add(getPosition(point));
      }
    });
}

void CellRecordReader::SetSpace(const BrickSpace& space, int threads)
{
  this->Places = PointPlaces(this->Source, space, threads);
}

void CellRecordReader::Expand(
  const std::uint64_t* given, std::uint64_t points[CellSource::MostCorners]) const
{
  if (this->GivenCorners == this->Corners)
  {
    std::copy_n(given, this->Corners, points);
    return;
  }
  // As a hexahedron among those of other ranks.
  const std::uint64_t repeated[8] = { given[0], given[1], given[2], given[2], given[3], given[3],
    given[3], given[3] };
  std::copy_n(repeated, 8, points);
}

void CellRecordReader::FindCodes(
  std::uint64_t begin, std::uint64_t end, const MortonCode& order, std::uint64_t* codes) const
{
  this->ForEachPrimitive(begin, end,
    [&](std::uint64_t primitive, const std::uint64_t* given, bool isShown)
    {
      std::uint64_t& code = codes[primitive - begin];
      code = NoCode;
      if (!isShown)
      {
        return;
      }
      std::uint64_t points[CellSource::MostCorners];
      this->Expand(given, points);
      CornerRecord corners[CellSource::MostCorners];
      bool isFinite = true;
      for (int corner = 0; corner < this->Corners; ++corner)
      {
        const float* const place = this->Places.Get(points[corner]);
        isFinite = isFinite && PointPlaces::IsFinite(place);
        std::copy_n(place, 3, corners[corner].Place);
      }
      if (isFinite)
      {
        double center[3];
        GetCenter(corners, this->Corners, center);
        code = order.Get(center);
      }
    });
}

void CellRecordReader::ReadRecords(
  const std::uint64_t* primitives, std::size_t count, std::uint32_t* records) const
{
  auto* const corners = reinterpret_cast<CornerRecord*>(records);
  for (std::size_t done = 0; done < count; done += CellsTogether)
  {
    this->ReadBatch(primitives + done, std::min(CellsTogether, count - done),
      corners + done * static_cast<std::size_t>(this->Corners));
  }
}

void CellRecordReader::ReadBatch(
  const std::uint64_t* primitives, std::size_t count, CornerRecord* corners) const
{
  std::uint64_t cells[CellsTogether] = {};
  for (std::size_t number = 0; number < count; ++number)
  {
    const Run& run = this->FindRun(primitives[number]);
    cells[number] = run.FirstCell + (primitives[number] - run.FirstPrimitive);
  }
  std::uint64_t given[CellsTogether][CellSource::MostCorners];
  this->Source.ReadCorners(cells, count, given);
  // Cells are in the order of space, and their points anywhere in memory.
  for (std::size_t number = 0; number < count; ++number)
  {
    std::for_each(given[number], given[number] + this->GivenCorners,
      [this](std::uint64_t point) { PrefetchLine(this->Places.Get(point)); });
  }
  for (std::size_t number = 0; number < count; ++number)
  {
    std::uint64_t points[CellSource::MostCorners];
    this->Expand(given[number], points);
    for (int corner = 0; corner < this->Corners; ++corner, ++corners)
    {
      std::copy_n(this->Places.Get(points[corner]), 3, corners->Place);
      corners->Rank = this->Rank;
      corners->Point = static_cast<std::uint32_t>(points[corner]);
    }
  }
}

std::unique_ptr<RecordBrickBuilder> CellRecordReader::CreateBuilder(
  const MortonCode& order, std::uint32_t largestCount) const
{
  return std::make_unique<CellRecordBuilder>(this->Corners, order, largestCount);
}

CellRecordBuilder::CellRecordBuilder(
  int corners, const MortonCode& order, std::uint32_t largestCount)
  : Corners(corners)
  , Curve(order)
  , LargestCount(largestCount)
{
}

std::vector<RecordBrick> CellRecordBuilder::Build(const std::uint32_t* records, std::size_t count)
{
  this->SortCells(records, count);
  const std::size_t parts = (count + this->LargestCount - 1) / this->LargestCount;
  std::vector<RecordBrick> bricks;
  bricks.reserve(parts);
  for (std::size_t part = 0; part < parts; ++part)
  {
    const std::size_t begin = count * part / parts;
    bricks.push_back(
      this->BuildBrick(this->Keys.data() + begin, count * (part + 1) / parts - begin));
  }
  return bricks;
}

void CellRecordBuilder::SortCells(const std::uint32_t* records, std::size_t count)
{
  const auto* const corners = reinterpret_cast<const CornerRecord*>(records);
  const auto each = static_cast<std::size_t>(this->Corners);
  this->Keys.resize(count);
  this->AreOfOneRank = true;
  for (std::size_t index = 0; index < count; ++index)
  {
    const CornerRecord* const record = corners + index * each;
    this->AreOfOneRank = this->AreOfOneRank && record->Rank == corners->Rank;
    double center[3];
    GetCenter(record, this->Corners, center);
    this->Keys[index] = { this->Curve.Get(center), record };
  }
  const auto isBefore = [each](const Key& a, const Key& b)
  {
    return a.Code != b.Code ? a.Code < b.Code
                            : std::lexicographical_compare(
                                a.Record, a.Record + each, b.Record, b.Record + each, IsBefore);
  };
  // They are where they come from one rank.
  if (!std::is_sorted(this->Keys.begin(), this->Keys.end(), isBefore))
  {
    std::sort(this->Keys.begin(), this->Keys.end(), isBefore);
  }
}

RecordBrick CellRecordBuilder::BuildBrick(const Key* keys, std::size_t count)
{
  this->CollectPoints(keys, count);
  RecordBrick brick = this->Writer.Write(this->Points, this->CornerNumbers, this->Corners);
  brick.Notes.reserve(2 * this->Found.size());
  for (const std::uint16_t point : this->Writer.GetPointOrder())
  {
    brick.Notes.push_back(this->Found[point].Rank);
    brick.Notes.push_back(this->Found[point].Point);
  }
  return brick;
}

inline CellRecordBuilder::Entry& CellRecordBuilder::FindEntry(const CornerRecord& corner)
{
  std::uint64_t hash = ((std::uint64_t(corner.Rank) << 32) ^ corner.Point) * 0x9e3779b97f4a7c15u;
  hash ^= hash >> 32;
  Entry* const table = this->Table.data();
  const std::size_t mask = this->Table.size() - 1;
  for (std::size_t place = hash & mask;; place = (place + 1) & mask)
  {
    Entry& entry = table[place];
    if (entry.Number == 0 ||
      (entry.Point == corner.Point &&
        (this->AreOfOneRank || this->Found[entry.Number - 1].Rank == corner.Rank)))
    {
      return entry;
    }
  }
}

inline std::uint32_t CellRecordBuilder::FindPoint(const CornerRecord& corner)
{
  Entry& entry = this->FindEntry(corner);
  if (entry.Number != 0)
  {
    return entry.Number - 1;
  }
  this->Found.push_back(corner);
  const auto number = static_cast<std::uint32_t>(this->Found.size());
  entry = { corner.Point, number };
  if (2 * this->Found.size() > this->Table.size())
  {
    this->EnlargeTable(2 * this->Table.size());
  }
  return number - 1;
}

void CellRecordBuilder::CollectPoints(const Key* keys, std::size_t count)
{
  const auto each = static_cast<std::size_t>(this->Corners);
  std::size_t size = 64;
  while (size < 2 * count)
  {
    size *= 2;
  }
  this->Found.clear();
  this->EnlargeTable(size);
  this->CornerNumbers.resize(each * count);
  std::uint16_t* number = this->CornerNumbers.data();
  for (std::size_t cell = 0; cell < count; ++cell)
  {
    for (std::size_t corner = 0; corner < each; ++corner)
    {
      *number++ = static_cast<std::uint16_t>(this->FindPoint(keys[cell].Record[corner]));
    }
  }
  this->Points.clear();
  for (const CornerRecord& point : this->Found)
  {
    this->Points.insert(this->Points.end(), point.Place, point.Place + 3);
  }
}

void CellRecordBuilder::EnlargeTable(std::size_t size)
{
  this->Table.assign(size, { 0, 0 });
  for (std::size_t point = 0; point < this->Found.size(); ++point)
  {
    this->FindEntry(
      this->Found[point]) = { this->Found[point].Point, static_cast<std::uint32_t>(point + 1) };
  }
}

} // namespace bricks
