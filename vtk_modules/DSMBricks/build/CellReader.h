// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_CellReader_h
#define bricks_CellReader_h

#include "DSMBricks/base/Box.h"
#include "DSMBricks/base/ScalarType.h"

#include <cstddef>
#include <cstdint>

namespace bricks
{

/// Values of the cells of one piece of a volume, as this rank has them, in one or more components. Boxes
/// are in lattice indices. Reading is safe from any thread.
class CellReader
{
public:
  enum State : std::uint8_t
  {
    NoData = 0, ///< hidden, or refined elsewhere
    Own = 1,
    Copy = 2 ///< ghost cell: a copy of a cell that another piece may have
  };

  virtual ~CellReader() = default;

  /// The cells that this piece has, without ghost cells around them.
  virtual Box GetCells() const = 0;
  /// The cells whose values can be read: also the ghost cells.
  virtual Box GetReach() const = 0;
  /// Returns whether any cell of GetCells is not Own.
  virtual bool HasMask() const = 0;
  /// One byte a cell of `cells` (within the reach), x fastest.
  virtual void ReadStates(const Box& cells, std::uint8_t* out) const = 0;

  virtual int CountComponents() const = 0;
  virtual ScalarType GetType() const = 0;
  /// The values of one component in `cells` (within the reach), x fastest, in that type.
  virtual void ReadValues(int component, const Box& cells, std::byte* out) const = 0;
  /// Turns tuples, component by component, into samples of the lattice's type.
  virtual void Combine(std::size_t count, const std::byte* values, std::byte* samples) const = 0;
};

} // namespace bricks

#endif
