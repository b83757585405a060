// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMGridCells_h
#define vtkDSMGridCells_h

#include "DSMBricks/cells/CellSource.h"
#include "vtkDSMCutCells.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <cstdint>
#include <memory>
#include <vector>

class vtkDataArray;
class vtkDataObject;
class vtkPointSet;
class vtkUnsignedCharArray;

/// The cells of this rank's vtkStructuredGrid and vtkUnstructuredGrid, one grid after the other. Reads points and cells
/// where they lie. Left out are cells without a volume, ghost cells, hidden cells, and cells with a hidden point.
///
/// A grid's cells are numbered as VTK numbers them; then follow the linear cells that others were cut into
/// (vtkDSMCutCells), of which the whole is left out. Points likewise, whatever the cells are for. VTK 9.7 turns the
/// order of a wedge's points; the wedge is the same.
class vtkDSMGridCells final : public bricks::CellSource
{
public:
  using Grids = std::vector<vtkSmartPointer<vtkPointSet>>;
  /// One for each grid; null where no cell is cut. They depend on points and cells alone.
  using Cuts = std::vector<std::shared_ptr<const vtkDSMCutCells>>;

  /// Returns the data if they are a grid of these kinds; else null.
  static vtkPointSet* FindGrid(vtkDataObject* data);
  /// Returns whether a grid has cells with a volume.
  static bool HasVolume(vtkPointSet* grid);
  /// The types of an unstructured grid's cells; empty for a structured one. `threads`: the calling one included.
  static std::vector<std::uint8_t> ReadTypes(vtkPointSet* grid, int threads);
  /// Local. Throws dsm::Error for a cell with a point that does not exist.
  static Cuts Cut(const Grids& grids, int threads);

  /// The use of the cells.
  enum class Use
  {
    Bricks,
    /// For means of the values of cells at points: each cell that is cut counts once, at the points that the grid has.
    Means
  };
  /// Local. Throws dsm::Error for grids that are damaged, or too large.
  vtkDSMGridCells(const Grids& grids, const Cuts& cuts, int threads, Use use = Use::Bricks);
  ~vtkDSMGridCells() override;

  std::uint64_t GetCellCount() const override { return this->Cells; }
  std::uint64_t GetPointCount() const override { return this->Points; }
  /// Returns whether there are points that no grid has.
  bool HasFurtherPoints() const;
  std::vector<Grid> GetGrids() const override;
  bool HasOnlyTetrahedra() const override { return this->OnlyTetrahedra; }
  void GetCorners(std::uint64_t cell, std::uint64_t points[MostCorners]) const override;
  bool IsShown(std::uint64_t cell) const override;
  void ReadCells(std::uint64_t first, std::size_t count, std::uint64_t (*points)[MostCorners],
    bool* areShown) const override;
  void ReadCorners(const std::uint64_t* cells, std::size_t count,
    std::uint64_t (*points)[MostCorners]) const override;
  void GetPosition(std::uint64_t point, double position[3]) const override;

  /// A cell or a point of one of the grids.
  struct Place
  {
    std::size_t Grid;
    vtkIdType Number;
  };
  /// The cell of a grid that a cell is, or is cut from.
  Place FindOwner(std::uint64_t cell) const;
  /// Returns whether a cell of a grid is shown, as it is or cut.
  bool IsShown(const Place& cell) const;
  /// The point of a point of a grid.
  std::uint64_t GetPoint(const Place& place) const
  {
    return this->Pieces[place.Grid].FirstPoint + static_cast<std::uint64_t>(place.Number);
  }
  /// A value at a point: `read(place)` of a point of a grid, or the mean of these at a point that no grid has.
  template <class Read>
  double GetValue(std::uint64_t point, const Read& read) const
  {
    const std::size_t index = this->FindByPoint(point);
    const Piece& piece = this->Pieces[index];
    const std::uint64_t number = point - piece.FirstPoint;
    if (number < piece.OwnPoints)
    {
      return read(Place{ index, static_cast<vtkIdType>(number) });
    }
    double sum = 0.0;
    piece.Cut->ForEachWeighted(static_cast<std::size_t>(number - piece.OwnPoints),
      [&](std::uint32_t own, double weight) {
        sum += weight * read(Place{ index, static_cast<vtkIdType>(own) });
      });
    return sum;
  }

private:
  /// Numbers in an array of 32 or 64 bits.
  struct Numbers
  {
    const vtkTypeInt32* Narrow = nullptr;
    const vtkTypeInt64* Wide = nullptr;
    std::vector<vtkTypeInt64> Copied; ///< of any other array
    void Set(vtkDataArray* array);
    std::int64_t Get(std::uint64_t index) const
    {
      return this->Narrow ? this->Narrow[index] : this->Wide[index];
    }
    const void* GetAddress(std::uint64_t index) const
    {
      return this->Narrow ? static_cast<const void*>(this->Narrow + index) : this->Wide + index;
    }
  };
  /// At most eight points of a cell that is cut.
  struct Group
  {
    vtkIdType Cell;
    std::int64_t Begin; ///< index in Connectivity
    std::int64_t End;
  };
  struct Piece
  {
    vtkSmartPointer<vtkPointSet> Data;
    std::shared_ptr<const vtkDSMCutCells> Cut; ///< may be null
    vtkUnsignedCharArray* CellGhosts = nullptr;
    vtkUnsignedCharArray* PointGhosts = nullptr;
    vtkDataArray* Positions = nullptr;
    const float* Floats = nullptr;   ///< positions, if they are floats, three by three
    const double* Doubles = nullptr; ///< or doubles
    bricks::Index3 Size{ 0 }; ///< points along the axes of a structured grid; 0: unstructured
    std::vector<std::uint8_t> Types; ///< of the cells of an unstructured grid
    Numbers Offsets;
    Numbers Connectivity;
    std::vector<Group> Groups;         ///< in place of linear cells, if cells are for means
    std::vector<double> FurtherPlaces; ///< of the points that no grid has, three by three
    std::uint64_t OwnPoints = 0;
    std::uint64_t OwnCells = 0;
    std::uint64_t FirstPoint = 0;
    std::uint64_t FirstCell = 0;
  };

  void Add(vtkPointSet* grid, std::shared_ptr<const vtkDSMCutCells> cut, int threads, Use use);
  static void AddGroups(Piece& piece);
  static void FindFurtherPlaces(Piece& piece);
  std::size_t FindByPoint(std::uint64_t point) const;
  std::size_t FindByCell(std::uint64_t cell) const;
  /// The cell of a piece that one of its cells is, or is cut from.
  std::uint64_t FindOwner(const Piece& piece, std::uint64_t cell) const;
  /// The point at an index of Connectivity. Throws dsm::Error where the piece has no such point.
  static std::uint64_t FindPoint(const Piece& piece, std::uint64_t cell, std::int64_t at)
  {
    const std::int64_t point = piece.Connectivity.Get(static_cast<std::uint64_t>(at));
    if (point < 0 || static_cast<std::uint64_t>(point) >= piece.OwnPoints)
    {
      ThrowForPoint(piece, cell, point);
    }
    return static_cast<std::uint64_t>(point);
  }
  [[noreturn]] static void ThrowForPoint(
    const Piece& piece, std::uint64_t cell, std::int64_t point);
  [[noreturn]] static void ThrowForCount(std::uint64_t cell, std::int64_t given, int needed);
  /// Finds the points of a cell of an unstructured grid, by the piece's numbers; returns how many.
  int FindOwnCorners(
    const Piece& piece, std::uint64_t cell, std::uint64_t points[MostCorners]) const;
  /// Finds the points of a cell of a piece, by the piece's numbers; returns how many.
  int FindCorners(const Piece& piece, std::uint64_t cell, std::uint64_t points[MostCorners]) const;

  /// Returns whether a cell, of the grid itself, is not a ghost cell and not hidden.
  bool IsVisible(const Piece& piece, std::uint64_t cell) const;
  /// Likewise.
  bool HasHiddenPoint(const Piece& piece, std::uint64_t cell) const;

  std::vector<Piece> Pieces;
  std::uint64_t Cells = 0;
  std::uint64_t Points = 0;
  bool OnlyTetrahedra = true;
};

#endif
