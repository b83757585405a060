// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_VoxelSource_h
#define bricks_VoxelSource_h

#include "DSMBricks/base/Box.h"

#include <cstddef>
#include <cstdint>

namespace bricks
{

/// One piece of a volume, as this rank has it: samples at the corners of a box of cells of the
/// global lattice. Ghost cells are outside of the box. Implemented over vtkImageData, and by
/// generators that store nothing.
class VoxelSource
{
public:
  virtual ~VoxelSource() = default;

  /// The cells this piece has, in global lattice indices.
  virtual Box GetCells() const = 0;

  /// The samples at `points` (within the piece's points; its cells, where the lattice is of cells), x
  /// fastest, in the lattice's scalar type, native byte order. `out` has room for all of them.
  virtual void ReadSamples(const Box& points, std::byte* out) const = 0;

  /// Returns whether all samples at `points`, and their masks, are as in every such box of the source: one value,
  /// which is known without reading.
  virtual bool IsFill(const Box& /*points*/) const { return false; }

  /// Returns whether any cells of the box hold no data (blanked cells).
  virtual bool HasCellMask() const { return false; }

  /// One byte a cell of `cells`, x fastest: 1 holds data, 0 does not. Only when HasCellMask.
  virtual void ReadCellMask(const Box& cells, std::uint8_t* out) const;
};

} // namespace bricks

#endif
