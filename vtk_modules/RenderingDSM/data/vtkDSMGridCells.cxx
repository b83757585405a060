// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMGridCells.h"

#include "DSMBricks/base/ParallelFor.h"
#include "DSMBricks/base/PrefetchLine.h"
#include "DSMCore/base/Error.h"

#include "vtkAOSDataArrayTemplate.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataSetAttributes.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkStructuredGrid.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <string>
#include <utility>

namespace
{

constexpr unsigned char CellsLeftOut = vtkDataSetAttributes::DUPLICATECELL |
  vtkDataSetAttributes::HIDDENCELL | vtkDataSetAttributes::REFINEDCELL;

/// Corners of a cell that is not cut; 0 for those without a volume, and for those that are cut.
int CountCorners(int type)
{
  switch (type)
  {
    case VTK_TETRA:
      return 4;
    case VTK_PYRAMID:
      return 5;
    case VTK_WEDGE:
      return 6;
    case VTK_HEXAHEDRON:
    case VTK_VOXEL:
      return 8;
    default:
      return 0;
  }
}

/// The corners as bricks::CellSource has them in a hexahedron, by their numbers in the cell.
const std::uint8_t* GetOrder(int type)
{
  static constexpr std::uint8_t tetrahedron[8] = { 0, 1, 2, 2, 3, 3, 3, 3 };
  static constexpr std::uint8_t pyramid[8] = { 0, 1, 2, 3, 4, 4, 4, 4 };
  static constexpr std::uint8_t wedge[8] = { 0, 1, 2, 2, 3, 4, 5, 5 };
  static constexpr std::uint8_t voxel[8] = { 0, 1, 3, 2, 4, 5, 7, 6 };
  static constexpr std::uint8_t hexahedron[8] = { 0, 1, 2, 3, 4, 5, 6, 7 };
  return type == VTK_TETRA ? tetrahedron
    : type == VTK_PYRAMID  ? pyramid
    : type == VTK_WEDGE    ? wedge
    : type == VTK_VOXEL    ? voxel
                           : hexahedron;
}

bool HasVolume(int type)
{
  return CountCorners(type) > 0 || vtkDSMCutCells::IsCut(type);
}

vtkUnsignedCharArray* FindGhosts(vtkDataSetAttributes* attributes, std::uint64_t count)
{
  auto* const ghosts = vtkUnsignedCharArray::SafeDownCast(
    attributes->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
  return ghosts && static_cast<std::uint64_t>(ghosts->GetNumberOfTuples()) == count ? ghosts
                                                                                    : nullptr;
}

} // namespace

void vtkDSMGridCells::Numbers::Set(vtkDataArray* array)
{
  // The test is for the type of the array: VTK since 9.6 has cells of a fixed size, and any other array, too.
  if (auto* const wide = vtkAOSDataArrayTemplate<vtkTypeInt64>::FastDownCast(array))
  {
    this->Wide = wide->GetPointer(0);
    return;
  }
  if (auto* const narrow = vtkAOSDataArrayTemplate<vtkTypeInt32>::FastDownCast(array))
  {
    this->Narrow = narrow->GetPointer(0);
    return;
  }
  this->Copied.resize(static_cast<std::size_t>(array->GetNumberOfTuples()));
  for (std::size_t index = 0; index < this->Copied.size(); ++index)
  {
    this->Copied[index] =
      static_cast<vtkTypeInt64>(array->GetComponent(static_cast<vtkIdType>(index), 0));
  }
  this->Wide = this->Copied.data();
}

vtkPointSet* vtkDSMGridCells::FindGrid(vtkDataObject* data)
{
  return vtkStructuredGrid::SafeDownCast(data) || vtkUnstructuredGrid::SafeDownCast(data)
    ? vtkPointSet::SafeDownCast(data)
    : nullptr;
}

bool vtkDSMGridCells::HasVolume(vtkPointSet* grid)
{
  if (auto* const structured = vtkStructuredGrid::SafeDownCast(grid))
  {
    return structured->GetDataDimension() == 3;
  }
  auto* const cells = vtkUnstructuredGrid::SafeDownCast(grid);
  for (vtkIdType cell = 0; cell < cells->GetNumberOfCells(); ++cell)
  {
    if (::HasVolume(cells->GetCellType(cell)))
    {
      return true;
    }
  }
  return false;
}

std::vector<std::uint8_t> vtkDSMGridCells::ReadTypes(vtkPointSet* grid, int threads)
{
  constexpr std::size_t cellsOfChunk = std::size_t(1) << 16;
  auto* const cells = vtkUnstructuredGrid::SafeDownCast(grid);
  std::vector<std::uint8_t> types(
    cells ? static_cast<std::size_t>(cells->GetNumberOfCells()) : std::size_t(0));
  bricks::ParallelForChunks(threads, types.size(), cellsOfChunk,
    [&](std::size_t begin, std::size_t end, std::size_t, int)
    {
      for (std::size_t cell = begin; cell < end; ++cell)
      {
        types[cell] = static_cast<std::uint8_t>(cells->GetCellType(static_cast<vtkIdType>(cell)));
      }
    });
  return types;
}

vtkDSMGridCells::Cuts vtkDSMGridCells::Cut(const Grids& grids, int threads)
{
  Cuts cuts;
  for (vtkPointSet* const grid : grids)
  {
    auto& cut = cuts.emplace_back();
    const std::vector<std::uint8_t> types = ReadTypes(grid, threads);
    if (std::any_of(types.begin(), types.end(), vtkDSMCutCells::IsCut))
    {
      cut = std::make_shared<const vtkDSMCutCells>(vtkUnstructuredGrid::SafeDownCast(grid));
    }
  }
  return cuts;
}

vtkDSMGridCells::vtkDSMGridCells(const Grids& grids, const Cuts& cuts, int threads, Use use)
{
  this->Pieces.reserve(grids.size()); // pieces have pointers into themselves
  for (std::size_t grid = 0; grid < grids.size(); ++grid)
  {
    this->Add(grids[grid], cuts[grid], threads, use);
  }
  if (this->Points > std::numeric_limits<std::uint32_t>::max())
  {
    throw dsm::Error("The grids have " + std::to_string(this->Points) +
      " points on one rank; the maximum is " +
      std::to_string(std::numeric_limits<std::uint32_t>::max()) + ". Use more ranks.");
  }
}

vtkDSMGridCells::~vtkDSMGridCells() = default;

void vtkDSMGridCells::Add(
  vtkPointSet* grid, std::shared_ptr<const vtkDSMCutCells> cut, int threads, Use use)
{
  Piece& piece = this->Pieces.emplace_back();
  piece.Data = grid;
  piece.Cut = std::move(cut);
  piece.OwnPoints = static_cast<std::uint64_t>(grid->GetNumberOfPoints());
  piece.OwnCells = static_cast<std::uint64_t>(grid->GetNumberOfCells());
  piece.CellGhosts = FindGhosts(grid->GetCellData(), piece.OwnCells);
  piece.PointGhosts = FindGhosts(grid->GetPointData(), piece.OwnPoints);
  if (grid->GetPoints())
  {
    piece.Positions = grid->GetPoints()->GetData();
    auto* const floats = vtkAOSDataArrayTemplate<float>::FastDownCast(piece.Positions);
    auto* const doubles = vtkAOSDataArrayTemplate<double>::FastDownCast(piece.Positions);
    piece.Floats = floats ? floats->GetPointer(0) : nullptr;
    piece.Doubles = doubles ? doubles->GetPointer(0) : nullptr;
  }
  if (piece.Cut && use == Use::Bricks)
  {
    FindFurtherPlaces(piece);
  }
  if (auto* const structured = vtkStructuredGrid::SafeDownCast(grid))
  {
    int size[3];
    structured->GetDimensions(size);
    piece.Size = bricks::Index3(size[0], size[1], size[2]);
    const std::uint64_t points =
      static_cast<std::uint64_t>(piece.Size.x * piece.Size.y * piece.Size.z);
    if (points != piece.OwnPoints)
    {
      throw dsm::Error("A structured grid of " + std::to_string(size[0]) + " x " +
        std::to_string(size[1]) + " x " + std::to_string(size[2]) + " points has " +
        std::to_string(piece.OwnPoints) + " points. Set as many points as its extent has.");
    }
  }
  else
  {
    auto* const unstructured = vtkUnstructuredGrid::SafeDownCast(grid);
    vtkCellArray* const cells = unstructured->GetCells();
    if (cells)
    {
      piece.Offsets.Set(cells->GetOffsetsArray());
      piece.Connectivity.Set(cells->GetConnectivityArray());
    }
    piece.Types = ReadTypes(grid, threads);
    this->OnlyTetrahedra = this->OnlyTetrahedra &&
      std::all_of(piece.Types.begin(), piece.Types.end(),
        [](int type) { return type == VTK_TETRA || CountCorners(type) == 0; });
    if (piece.Cut && use == Use::Means)
    {
      AddGroups(piece);
    }
    if (piece.Cut && (use == Use::Means || !piece.Cut->HasOnlyTetrahedra()))
    {
      this->OnlyTetrahedra = false;
    }
  }
  piece.FirstPoint = this->Points;
  piece.FirstCell = this->Cells;
  this->Points += piece.OwnPoints + (piece.Cut ? piece.Cut->GetPointCount() : 0);
  this->Cells += piece.OwnCells;
  this->Cells += piece.Cut && use == Use::Bricks ? piece.Cut->GetCount() : piece.Groups.size();
}

void vtkDSMGridCells::AddGroups(Piece& piece)
{
  for (const vtkIdType cell : piece.Cut->GetCells())
  {
    const auto number = static_cast<std::uint64_t>(cell);
    const std::int64_t end = piece.Offsets.Get(number + 1);
    for (std::int64_t begin = piece.Offsets.Get(number); begin < end; begin += MostCorners)
    {
      piece.Groups.push_back({ cell, begin, std::min(begin + MostCorners, end) });
    }
  }
}

void vtkDSMGridCells::FindFurtherPlaces(Piece& piece)
{
  const std::size_t count = piece.Cut->GetPointCount();
  piece.FurtherPlaces.resize(3 * count);
  for (std::size_t point = 0; point < count; ++point)
  {
    double* const sum = &piece.FurtherPlaces[3 * point];
    piece.Cut->ForEachWeighted(point,
      [&](std::uint32_t own, double weight)
      {
        double place[3];
        piece.Positions->GetTuple(static_cast<vtkIdType>(own), place);
        for (int axis = 0; axis < 3; ++axis)
        {
          sum[axis] += weight * place[axis];
        }
      });
  }
}

bool vtkDSMGridCells::HasFurtherPoints() const
{
  return std::any_of(this->Pieces.begin(), this->Pieces.end(),
    [](const Piece& piece) { return piece.Cut && piece.Cut->GetPointCount() > 0; });
}

std::vector<bricks::CellSource::Grid> vtkDSMGridCells::GetGrids() const
{
  std::vector<Grid> grids;
  for (const Piece& piece : this->Pieces)
  {
    if (piece.Size.x > 0)
    {
      grids.push_back({ piece.FirstCell, piece.FirstPoint, piece.Size });
    }
  }
  return grids;
}

std::size_t vtkDSMGridCells::FindByPoint(std::uint64_t point) const
{
  const auto next = std::upper_bound(this->Pieces.begin(), this->Pieces.end(), point,
    [](std::uint64_t number, const Piece& piece) { return number < piece.FirstPoint; });
  return static_cast<std::size_t>(std::prev(next) - this->Pieces.begin());
}

std::size_t vtkDSMGridCells::FindByCell(std::uint64_t cell) const
{
  const auto next = std::upper_bound(this->Pieces.begin(), this->Pieces.end(), cell,
    [](std::uint64_t number, const Piece& piece) { return number < piece.FirstCell; });
  return static_cast<std::size_t>(std::prev(next) - this->Pieces.begin());
}

void vtkDSMGridCells::ThrowForPoint(const Piece& piece, std::uint64_t cell, std::int64_t point)
{
  throw dsm::Error("Cell " + std::to_string(cell) + " of an unstructured grid refers to point " +
    std::to_string(point) + ", but the grid has only " + std::to_string(piece.OwnPoints) +
    " points. Check the dataset's cells.");
}

void vtkDSMGridCells::ThrowForCount(std::uint64_t cell, std::int64_t given, int needed)
{
  throw dsm::Error("Cell " + std::to_string(cell) + " of an unstructured grid has " +
    std::to_string(given) + " points, but its type needs " + std::to_string(needed) +
    ". Check the dataset's cells.");
}

int vtkDSMGridCells::FindCorners(
  const Piece& piece, std::uint64_t cell, std::uint64_t points[MostCorners]) const
{
  if (piece.Size.x > 0)
  {
    const auto row = static_cast<std::uint64_t>(piece.Size.x);
    const std::uint64_t layer = row * static_cast<std::uint64_t>(piece.Size.y);
    const std::uint64_t columns = row - 1;
    const std::uint64_t rows = static_cast<std::uint64_t>(piece.Size.y) - 1;
    const std::uint64_t first =
      cell % columns + row * (cell / columns % rows) + layer * (cell / columns / rows);
    const std::uint64_t corners[MostCorners] = { first, first + 1, first + row + 1, first + row,
      first + layer, first + layer + 1, first + layer + row + 1, first + layer + row };
    std::copy_n(corners, MostCorners, points);
    return MostCorners;
  }
  if (cell >= piece.OwnCells && !piece.Groups.empty())
  {
    const Group& group = piece.Groups[static_cast<std::size_t>(cell - piece.OwnCells)];
    for (std::int64_t corner = 0; corner < MostCorners; ++corner)
    {
      points[corner] = FindPoint(
        piece, this->FindOwner(piece, cell), std::min(group.Begin + corner, group.End - 1));
    }
    return MostCorners;
  }
  if (cell >= piece.OwnCells)
  {
    int count = 0;
    const std::uint32_t* const corners =
      piece.Cut->GetCorners(static_cast<std::size_t>(cell - piece.OwnCells), count);
    if (this->OnlyTetrahedra || count == MostCorners)
    {
      std::copy_n(corners, count, points);
      return count;
    }
    const std::uint8_t* const order = GetOrder(VTK_TETRA);
    std::transform(order, order + MostCorners, points,
      [corners](std::uint8_t corner) { return corners[corner]; });
    return MostCorners;
  }
  return this->FindOwnCorners(piece, cell, points);
}

inline int vtkDSMGridCells::FindOwnCorners(
  const Piece& piece, std::uint64_t cell, std::uint64_t points[MostCorners]) const
{
  const int type = piece.Types[static_cast<std::size_t>(cell)];
  const int count = CountCorners(type);
  const std::int64_t begin = piece.Offsets.Get(cell);
  const std::int64_t listed = piece.Offsets.Get(cell + 1) - begin;
  if (listed < count)
  {
    ThrowForCount(cell, listed, count);
  }
  const int given = this->OnlyTetrahedra ? count : static_cast<int>(MostCorners);
  const std::uint8_t* const order = GetOrder(this->OnlyTetrahedra ? VTK_HEXAHEDRON : type);
  for (int corner = 0; corner < given; ++corner)
  {
    points[corner] = FindPoint(piece, cell, begin + order[corner]);
  }
  return given;
}

void vtkDSMGridCells::GetCorners(std::uint64_t cell, std::uint64_t points[MostCorners]) const
{
  const Piece& piece = this->Pieces[this->FindByCell(cell)];
  const int count = this->FindCorners(piece, cell - piece.FirstCell, points);
  for (int corner = 0; corner < count; ++corner)
  {
    points[corner] += piece.FirstPoint;
  }
}

bool vtkDSMGridCells::IsShown(std::uint64_t cell) const
{
  const Piece& piece = this->Pieces[this->FindByCell(cell)];
  const std::uint64_t number = cell - piece.FirstCell;
  const bool isWhole = piece.Size.x == 0 && number < piece.OwnCells;
  return (!isWhole || CountCorners(piece.Types[static_cast<std::size_t>(number)]) > 0) &&
    this->IsVisible(piece, this->FindOwner(piece, number));
}

void vtkDSMGridCells::ReadCells(std::uint64_t first, std::size_t count,
  std::uint64_t (*points)[MostCorners], bool* areShown) const
{
  std::size_t done = 0;
  while (done < count)
  {
    const Piece& piece = this->Pieces[this->FindByCell(first + done)];
    const std::uint64_t begin = first + done - piece.FirstCell;
    const std::size_t before = done;
    if (piece.Size.x == 0 && begin < piece.OwnCells && !piece.CellGhosts && !piece.PointGhosts)
    {
      done +=
        static_cast<std::size_t>(std::min<std::uint64_t>(count - done, piece.OwnCells - begin));
      for (std::size_t number = before; number < done; ++number)
      {
        const std::uint64_t cell = begin + (number - before);
        areShown[number] = CountCorners(piece.Types[static_cast<std::size_t>(cell)]) > 0;
        if (areShown[number])
        {
          const int corners = this->FindOwnCorners(piece, cell, points[number]);
          for (int corner = 0; corner < corners; ++corner)
          {
            points[number][corner] += piece.FirstPoint;
          }
        }
      }
    }
    else
    {
      this->CellSource::ReadCells(first + done, 1, points + done, areShown + done);
      ++done;
    }
  }
}

void vtkDSMGridCells::ReadCorners(
  const std::uint64_t* cells, std::size_t count, std::uint64_t (*points)[MostCorners]) const
{
  const Piece& piece = this->Pieces.front();
  if (this->Pieces.size() == 1 && piece.Size.x == 0 && !piece.Cut)
  {
    // They are anywhere in memory. Numbers of the only piece are those of all.
    std::for_each(cells, cells + count,
      [&piece](std::uint64_t cell) { bricks::PrefetchLine(piece.Offsets.GetAddress(cell)); });
    std::for_each(cells, cells + count,
      [&piece](std::uint64_t cell)
      {
        const auto begin = static_cast<std::uint64_t>(piece.Offsets.Get(cell));
        bricks::PrefetchLine(piece.Connectivity.GetAddress(begin));
        bricks::PrefetchLine(piece.Connectivity.GetAddress(begin + 7));
        bricks::PrefetchLine(piece.Types.data() + cell);
      });
    for (std::size_t number = 0; number < count; ++number)
    {
      this->FindOwnCorners(piece, cells[number], points[number]);
    }
    return;
  }
  this->CellSource::ReadCorners(cells, count, points);
}

bool vtkDSMGridCells::IsShown(const Place& cell) const
{
  const Piece& piece = this->Pieces[cell.Grid];
  return ::HasVolume(piece.Data->GetCellType(cell.Number)) &&
    this->IsVisible(piece, static_cast<std::uint64_t>(cell.Number));
}

bool vtkDSMGridCells::IsVisible(const Piece& piece, std::uint64_t cell) const
{
  const bool isGhost = piece.CellGhosts &&
    (piece.CellGhosts->GetValue(static_cast<vtkIdType>(cell)) & CellsLeftOut) != 0;
  return !isGhost && (!piece.PointGhosts || !this->HasHiddenPoint(piece, cell));
}

bool vtkDSMGridCells::HasHiddenPoint(const Piece& piece, std::uint64_t cell) const
{
  const auto isHidden = [&piece](std::uint64_t point)
  {
    return point < piece.OwnPoints &&
      (piece.PointGhosts->GetValue(static_cast<vtkIdType>(point)) &
        vtkDataSetAttributes::HIDDENPOINT) != 0;
  };
  if (piece.Size.x > 0)
  {
    std::uint64_t points[MostCorners];
    const int count = this->FindCorners(piece, cell, points);
    return std::any_of(points, points + count, isHidden);
  }
  for (std::int64_t at = piece.Offsets.Get(cell); at < piece.Offsets.Get(cell + 1); ++at)
  {
    if (isHidden(
          static_cast<std::uint64_t>(piece.Connectivity.Get(static_cast<std::uint64_t>(at)))))
    {
      return true;
    }
  }
  return false;
}

void vtkDSMGridCells::GetPosition(std::uint64_t point, double position[3]) const
{
  const Piece& piece = this->Pieces[this->FindByPoint(point)];
  const std::uint64_t number = point - piece.FirstPoint;
  if (number >= piece.OwnPoints)
  {
    std::copy_n(
      &piece.FurtherPlaces[3 * static_cast<std::size_t>(number - piece.OwnPoints)], 3, position);
  }
  else if (piece.Floats)
  {
    std::copy_n(piece.Floats + 3 * number, 3, position);
  }
  else if (piece.Doubles)
  {
    std::copy_n(piece.Doubles + 3 * number, 3, position);
  }
  else
  {
    piece.Positions->GetTuple(static_cast<vtkIdType>(number), position);
  }
}

std::uint64_t vtkDSMGridCells::FindOwner(const Piece& piece, std::uint64_t cell) const
{
  if (cell < piece.OwnCells)
  {
    return cell;
  }
  const auto part = static_cast<std::size_t>(cell - piece.OwnCells);
  return static_cast<std::uint64_t>(
    piece.Groups.empty() ? piece.Cut->GetOwner(part) : piece.Groups[part].Cell);
}

vtkDSMGridCells::Place vtkDSMGridCells::FindOwner(std::uint64_t cell) const
{
  const std::size_t index = this->FindByCell(cell);
  const Piece& piece = this->Pieces[index];
  return { index, static_cast<vtkIdType>(this->FindOwner(piece, cell - piece.FirstCell)) };
}
