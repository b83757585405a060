// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_CellAverages_h
#define bricks_CellAverages_h

#include "DSMBricks/build/CellReader.h"
#include "DSMBricks/build/VoxelSource.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace bricks
{

/// One piece of a volume whose values are at cells, as a source of point values: the value of a point is the mean of
/// the cells around it that hold data, in the arithmetic and the order of vtkCellDataToPointData, so that it does not
/// depend on the pieces. Integers are rounded. A point without such cells has the value 0.
class CellAverages final : public VoxelSource
{
public:
  /// Cells around the piece count once they are added.
  explicit CellAverages(std::shared_ptr<const CellReader> piece);

  Box GetCells() const override { return this->Piece->GetCells(); }
  void ReadSamples(const Box& points, std::byte* out) const override;
  bool HasCellMask() const override { return this->Piece->HasMask(); }
  void ReadCellMask(const Box& cells, std::uint8_t* out) const override;

  const CellReader& GetPiece() const { return *this->Piece; }
  /// The layer of cells around a piece, as boxes that do not overlap. It has cells outside of the
  /// lattice, too: ghost cells may be copies of cells that lie in no lattice, or in another one.
  static std::vector<Box> GetLayer(const Box& piece);
  /// Adds neighboring cells, which lie within one box of the layer, of a piece of that number: their states, then their
  /// values, component by component, in native byte order. For each cell the lowest piece counts that has it, or else
  /// that has a copy of it. Throws dsm::Error where they do not fit.
  void AddNeighbors(
    std::uint32_t piece, const Box& cells, const std::byte* bytes, std::size_t count);

private:
  struct Neighbors
  {
    Box Cells;
    /// Empty before the first are added.
    std::vector<std::uint8_t> States;
    std::vector<std::uint64_t> Origins; ///< the lowest counts
    std::vector<std::byte> Values;      ///< component by component
  };
  template <class T>
  void Average(const Box& points, std::byte* out) const;
  std::size_t CountBytesOfCell() const;

  std::shared_ptr<const CellReader> Piece;
  std::vector<Neighbors> Layer;
};

} // namespace bricks

#endif
