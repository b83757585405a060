// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_VoxelBrickReader_h
#define bricks_VoxelBrickReader_h

#include "DSMBricks/build/VoxelBrickBuilder.h"
#include "DSMBricks/build/VoxelSource.h"
#include "DSMBricks/layout/BrickLattice.h"
#include "DSMCore/fetch/BlockReader.h"

#include <memory>

namespace bricks
{

/// Cuts a brick out of a source that has all of the volume, whenever it is wanted; the same bytes as
/// fragments would make.
class VoxelBrickReader final : public dsm::BlockReader
{
public:
  /// Throws dsm::Error when the source has not all of the lattice's cells, or a cell mask that the lattice lacks.
  VoxelBrickReader(const BrickLattice& lattice, std::shared_ptr<const VoxelSource> source);
  void Read(dsm::BlockId id, std::byte* block, std::size_t bytes) const override;
  /// Returns whether the source says that all samples of a brick have its fill value (VoxelSource::IsFill): all such
  /// bricks of one size have the same bytes.
  bool IsFiller(dsm::BlockId id) const;

private:
  BrickLattice Lattice;
  std::shared_ptr<const VoxelSource> Source;
};

} // namespace bricks

#endif
