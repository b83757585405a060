// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_ValidSource_h
#define bricks_ValidSource_h

#include "DSMBricks/base/ValidValues.h"
#include "DSMBricks/build/VoxelSource.h"
#include "DSMBricks/layout/BrickLattice.h"

#include <memory>

namespace bricks
{

/// The samples of another source, with a mask: cells with a corner, or of a lattice of cells those with a value, that
/// is missing hold no data.
class ValidSource final : public VoxelSource
{
public:
  /// Returns the source itself where no value of the lattice's type is missing. Else the lattice must have a mask.
  static std::shared_ptr<const VoxelSource> Make(std::shared_ptr<const VoxelSource> source,
    const BrickLattice& lattice, const ValidValues& valid);

  ValidSource(std::shared_ptr<const VoxelSource> source, const BrickLattice& lattice,
    const ValidValues& valid);

  Box GetCells() const override { return this->Source->GetCells(); }
  void ReadSamples(const Box& points, std::byte* out) const override
  {
    this->Source->ReadSamples(points, out);
  }
  bool IsFill(const Box& points) const override { return this->Source->IsFill(points); }
  bool HasCellMask() const override { return true; }
  void ReadCellMask(const Box& cells, std::uint8_t* out) const override;

private:
  std::shared_ptr<const VoxelSource> Source;
  ScalarType Type;
  bool OfCells;
  ValidValues Valid;
};

} // namespace bricks

#endif
