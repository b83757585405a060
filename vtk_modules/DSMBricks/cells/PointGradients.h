// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_PointGradients_h
#define bricks_PointGradients_h

#include "DSMBricks/cells/CellSource.h"
#include "DSMBricks/cells/PackedGradient.h"
#include "DSMBricks/cells/SharedPlaces.h"
#include "DSMBricks/layout/BrickSpace.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/transport/Messenger.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace bricks
{

/// Collective: finds gradients of values at points, in the space of the bricks. Returns one for each of this rank's
/// points: the mean of those of the tetrahedra around its place, on all ranks, weighted by their volumes. Hexahedra are
/// split by SplitHexahedron in the order of the places of their corners. A point without a tetrahedron of any volume
/// has a gradient of 0. The result is the same, bit for bit, for any distribution of the cells, as long as at most 2^20
/// tetrahedra meet in a place.
///
/// `places`: of this rank's points, in the space of the bricks. `getValue(point)`: called by any thread, once a point.
/// Cells with a corner without a finite value or place do not count. Takes 64 bytes a point while it runs.
/// `progress` may be empty; what it throws ends the work on all ranks. Throws the same dsm::Error on every rank.
std::vector<PackedGradient> FindPointGradients(std::string_view what, const CellSource& source,
  const BrickSpace& space, const SharedPlaces& places,
  dsm::FunctionRef<double(std::uint64_t point)> getValue, int threads, dsm::Messenger& messenger,
  dsm::FunctionRef<void(double)> progress = {});

} // namespace bricks

#endif
