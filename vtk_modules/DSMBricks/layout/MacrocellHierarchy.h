// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_MacrocellHierarchy_h
#define bricks_MacrocellHierarchy_h

#include "DSMBricks/base/ValueRange.h"
#include "DSMBricks/layout/BrickLattice.h"
#include "DSMCore/publish/BlockSegment.h"
#include "DSMCore/transport/Messenger.h"

#include <cstdint>
#include <vector>

namespace bricks
{

/// Minimum and maximum over ever coarser boxes of bricks (the paper, section 4.1), whole on every
/// rank: level 0 has one macrocell a brick, each further level one for 4 x 4 x 4 of the level
/// below, up to a single one. The levels finer than a brick lie inside the bricks.
class MacrocellHierarchy
{
public:
  /// log2 of the edge ratio between levels.
  static constexpr int Shift = 2;

  /// One level; x fastest.
  struct Level
  {
    int Size[3];
    double Edge; ///< edge length of a macrocell, in cells
    double InverseEdge;
    std::vector<ValueRange> Ranges;
  };

  MacrocellHierarchy() = default;
  /// Collective: gathers the ranges that the bricks know of themselves.
  MacrocellHierarchy(
    const BrickLattice& lattice, const dsm::BlockSegment& segment, dsm::Messenger& messenger);
  /// Local: builds the levels over the ranges of all bricks, in order of their ids.
  MacrocellHierarchy(const BrickLattice& lattice, std::vector<ValueRange> bricks);

  /// Collective: the ranges that the bricks of a segment of voxel bricks know of themselves, by number.
  static std::vector<ValueRange> GatherRanges(
    const dsm::BlockSegment& segment, dsm::Messenger& messenger);

  /// Returns the bytes of all levels.
  static std::uint64_t CountBytes(const BrickLattice& lattice);

  /// Level 0 is the finest.
  const std::vector<Level>& GetLevels() const { return this->Levels; }
  /// The range of the whole volume.
  const ValueRange& GetRange() const { return this->Levels.back().Ranges.front(); }

private:
  std::vector<Level> Levels;
};

} // namespace bricks

#endif
