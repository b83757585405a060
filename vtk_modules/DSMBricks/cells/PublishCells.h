// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_PublishCells_h
#define bricks_PublishCells_h

#include "DSMBricks/cells/CellBricks.h"
#include "DSMBricks/cells/CellSource.h"
#include "DSMBricks/cells/CornerRoutes.h"
#include "DSMBricks/cells/PackedGradient.h"
#include "DSMBricks/sorted/SortedBrickBuilder.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/store/BlockStore.h"
#include "DSMCore/transport/Messenger.h"

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

namespace bricks
{

/// Collective, between frames: sorts the cells of all ranks in space, and publishes them in bricks. `routes` receives
/// where this rank's points are in the bricks; nothing else is kept of the source. Throws the same dsm::Error on every
/// rank. `progress` may be empty.
std::shared_ptr<CellBricks> PublishCells(std::string_view what, const CellSource& source,
  const SortedBrickSettings& settings, dsm::BlockStore& store, dsm::Messenger& messenger,
  dsm::BlockStore::Place place, CornerRoutes& routes, dsm::FunctionRef<void(double)> progress = {});

/// Collective, likewise: publishes values for cells that are in bricks; neither cells nor hierarchies move.
/// `getValue(point)`: of a point of this rank's source; NaN: it has none. Called by any thread. `gradients`: of the
/// source's points, in the space of the bricks (PointGradients.h); empty on every rank: surfaces are shaded by the
/// planes of tetrahedra.
std::shared_ptr<CellValues> PublishCellValues(std::string_view what,
  const std::shared_ptr<const CellBricks>& cells, const CornerRoutes& routes,
  dsm::FunctionRef<double(std::uint64_t)> getValue, const std::vector<PackedGradient>& gradients,
  int threads, dsm::BlockStore& store, dsm::Messenger& messenger, dsm::BlockStore::Place place,
  dsm::FunctionRef<void(double)> progress = {});

} // namespace bricks

#endif
