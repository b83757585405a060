// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_DealBricks_h
#define bricks_DealBricks_h

#include "DSMBricks/layout/BrickLattice.h"
#include "DSMCore/base/BlockAssigner.h"

namespace bricks
{

/// Deals the bricks of a volume whose owners cut them out of chunks of a file. Neighboring bricks are cut out of
/// the same chunks, so they are dealt in boxes: as small ones as it takes for each rank to get several, which
/// a surface then meets about as often as another rank's; and of whole chunks, unless these are so large that
/// some rank would get too few. `chunk`: its samples along each axis; `first`: index of the lattice's
/// first point in the file.
dsm::BlockAssigner DealBricks(
  const BrickLattice& lattice, const Index3& chunk, const Index3& first, int ranks);

} // namespace bricks

#endif
