// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/cells/CellRecords.h"

#include "DSMBricks/layout/PlaceInBrick.h"

#include <glm/common.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <tuple>

namespace bricks
{

namespace
{

constexpr std::size_t WordsOfCorner = sizeof(CornerRecord) / sizeof(std::uint32_t);

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
  return corners == 4 ? 8.0 + 0.25 * 12.0 + 2.0 : 16.0 + 1.3 * 12.0 + 2.0;
}

void GetCenter(const CornerRecord* corners, int count, double center[3])
{
  for (int axis = 0; axis < 3; ++axis)
  {
    double sum = 0.0;
    for (int corner = 0; corner < count; ++corner)
    {
      sum += corners[corner].Place[axis];
    }
    center[axis] = sum / count;
  }
}

} // namespace

CellRecordReader::CellRecordReader(const CellSource& source, int corners, int rank)
  : Source(source)
  , Corners(corners)
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

std::uint64_t CellRecordReader::GetCell(std::uint64_t primitive) const
{
  const auto next = std::upper_bound(this->Runs.begin(), this->Runs.end(), primitive,
    [](std::uint64_t number, const Run& run) { return number < run.FirstPrimitive; });
  return (next - 1)->FirstCell + (primitive - (next - 1)->FirstPrimitive);
}

void CellRecordReader::FindOtherBounds(glm::dvec3& lower, glm::dvec3& upper) const
{
  lower = glm::dvec3(std::numeric_limits<double>::infinity());
  upper = -lower;
  for (const CellSource::Grid& grid : this->Source.GetGrids())
  {
    const Index3& points = grid.Points;
    const auto count = static_cast<std::uint64_t>(points.x * points.y * points.z);
    for (std::uint64_t point = grid.FirstPoint; point < grid.FirstPoint + count; ++point)
    {
      glm::dvec3 position;
      this->Source.GetPosition(point, &position.x);
      if (std::isfinite(position.x) && std::isfinite(position.y) && std::isfinite(position.z))
      {
        lower = glm::min(lower, position);
        upper = glm::max(upper, position);
      }
    }
  }
}

bool CellRecordReader::FindBounds(
  std::uint64_t primitive, glm::dvec3& lower, glm::dvec3& upper) const
{
  const std::uint64_t cell = this->GetCell(primitive);
  std::uint64_t points[CellSource::MostCorners];
  this->Source.GetCorners(cell, points);
  const int count = this->Source.HasOnlyTetrahedra() ? 4 : 8;
  lower = glm::dvec3(std::numeric_limits<double>::infinity());
  upper = -lower;
  bool isFinite = this->Source.IsShown(cell);
  for (int corner = 0; corner < count && isFinite; ++corner)
  {
    glm::dvec3 position;
    this->Source.GetPosition(points[corner], &position.x);
    isFinite = std::isfinite(position.x) && std::isfinite(position.y) && std::isfinite(position.z);
    lower = glm::min(lower, position);
    upper = glm::max(upper, position);
  }
  return isFinite;
}

bool CellRecordReader::ReadCorners(
  std::uint64_t primitive, CornerRecord corners[CellBrick::MostCorners]) const
{
  const std::uint64_t cell = this->GetCell(primitive);
  std::uint64_t points[CellSource::MostCorners];
  this->Source.GetCorners(cell, points);
  if (this->Corners == 8 && this->Source.HasOnlyTetrahedra())
  {
    // As a hexahedron among those of other ranks.
    const std::uint64_t repeated[8] = { points[0], points[1], points[2], points[2], points[3],
      points[3], points[3], points[3] };
    std::copy_n(repeated, 8, points);
  }
  bool isFinite = this->Source.IsShown(cell);
  for (int corner = 0; corner < this->Corners && isFinite; ++corner)
  {
    double position[3];
    this->Source.GetPosition(points[corner], position);
    isFinite = PlaceInBrick(this->Space, position, corners[corner].Place);
    corners[corner].Rank = this->Rank;
    corners[corner].Point = static_cast<std::uint32_t>(points[corner]);
  }
  return isFinite;
}

bool CellRecordReader::FindCode(
  std::uint64_t primitive, const MortonCode& order, std::uint64_t& code) const
{
  CornerRecord corners[CellBrick::MostCorners];
  if (!this->ReadCorners(primitive, corners))
  {
    return false;
  }
  double center[3];
  GetCenter(corners, this->Corners, center);
  code = order.Get(center);
  return true;
}

void CellRecordReader::ReadRecord(std::uint64_t primitive, std::uint32_t* record) const
{
  CornerRecord corners[CellBrick::MostCorners];
  this->ReadCorners(primitive, corners);
  std::memcpy(record, corners, static_cast<std::size_t>(this->Corners) * sizeof(CornerRecord));
}

std::unique_ptr<RecordBrickBuilder> CellRecordReader::CreateBuilder(
  const MortonCode& order, std::uint32_t largestCount) const
{
  return std::make_unique<CellRecordBuilder>(this->Corners, order, largestCount);
}

CellRecordBuilder::CellRecordBuilder(
  int corners, const MortonCode& order, std::uint32_t largestCount)
  : Corners(corners)
  , Order(order)
  , LargestCount(largestCount)
{
}

std::vector<RecordBrick> CellRecordBuilder::Build(const std::uint32_t* records, std::size_t count)
{
  this->Sort(records, count);
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

void CellRecordBuilder::Sort(const std::uint32_t* records, std::size_t count)
{
  const auto* const corners = reinterpret_cast<const CornerRecord*>(records);
  const auto each = static_cast<std::size_t>(this->Corners);
  this->Keys.resize(count);
  for (std::size_t index = 0; index < count; ++index)
  {
    const CornerRecord* const record = corners + index * each;
    double center[3];
    GetCenter(record, this->Corners, center);
    this->Keys[index] = { this->Order.Get(center), record };
  }
  std::sort(this->Keys.begin(), this->Keys.end(),
    [each](const Key& a, const Key& b)
    {
      return a.Code != b.Code ? a.Code < b.Code
                              : std::lexicographical_compare(
                                  a.Record, a.Record + each, b.Record, b.Record + each, IsBefore);
    });
}

RecordBrick CellRecordBuilder::BuildBrick(const Key* keys, std::size_t count)
{
  this->CollectPoints(keys, count);
  RecordBrick brick = this->Writer.Write(this->Points, this->CornerNumbers, this->Corners);
  brick.Notes.reserve(2 * this->Found.size());
  for (const CornerRecord& point : this->Found)
  {
    brick.Notes.push_back(point.Rank);
    brick.Notes.push_back(point.Point);
  }
  return brick;
}

void CellRecordBuilder::CollectPoints(const Key* keys, std::size_t count)
{
  const auto each = static_cast<std::size_t>(this->Corners);
  std::size_t places = 64;
  while (places < 2 * each * count)
  {
    places *= 2;
  }
  this->Table.assign(places, 0);
  this->Found.clear();
  this->CornersFound.clear();
  for (std::size_t cell = 0; cell < count; ++cell)
  {
    for (std::size_t corner = 0; corner < each; ++corner)
    {
      this->CornersFound.push_back(this->FindPoint(keys[cell].Record[corner]));
    }
  }
  std::vector<std::uint32_t> order(this->Found.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
    [this](std::uint32_t one, std::uint32_t other)
    { return IsBefore(this->Found[one], this->Found[other]); });
  this->Numbers.resize(order.size());
  this->Points.clear();
  std::vector<CornerRecord> sorted;
  sorted.reserve(order.size());
  for (const std::uint32_t point : order)
  {
    this->Numbers[point] = static_cast<std::uint16_t>(sorted.size());
    sorted.push_back(this->Found[point]);
    this->Points.insert(this->Points.end(), sorted.back().Place, sorted.back().Place + 3);
  }
  this->Found.swap(sorted);
  this->CornerNumbers.clear();
  for (const std::uint32_t point : this->CornersFound)
  {
    this->CornerNumbers.push_back(this->Numbers[point]);
  }
}

std::uint32_t CellRecordBuilder::FindPoint(const CornerRecord& corner)
{
  std::uint64_t hash = ((std::uint64_t(corner.Rank) << 32) ^ corner.Point) * 0x9e3779b97f4a7c15u;
  hash ^= hash >> 32;
  const std::size_t mask = this->Table.size() - 1;
  for (std::size_t place = hash & mask;; place = (place + 1) & mask)
  {
    std::uint32_t& entry = this->Table[place];
    if (entry == 0)
    {
      this->Found.push_back(corner);
      entry = static_cast<std::uint32_t>(this->Found.size());
      return entry - 1;
    }
    const CornerRecord& known = this->Found[entry - 1];
    if (known.Rank == corner.Rank && known.Point == corner.Point)
    {
      return entry - 1;
    }
  }
}

} // namespace bricks
