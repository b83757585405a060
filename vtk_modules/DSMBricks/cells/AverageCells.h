// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_AverageCells_h
#define bricks_AverageCells_h

#include "DSMBricks/cells/CellSource.h"
#include "DSMBricks/cells/SharedPlaces.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/transport/Messenger.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace bricks
{

/// Collective: turns values of cells into values of points. Returns one for each of this rank's points: the mean of the
/// values of the shown cells, on all ranks, with a corner at its place; NaN if there is none. A cell counts once, also
/// if several of its corners are there. Values that are not finite do not count. The result is the same, bit for bit,
/// for any distribution of the cells, as long as at most 2^20 cells meet in a place.
///
/// `places`: of this rank's points. `getCellValue(cell)`: called by any thread. `progress` may be empty; what it throws
/// ends the work on all ranks. Takes 24 bytes a point while it runs. Throws the same dsm::Error on every rank.
std::vector<float> AverageCells(std::string_view what, const CellSource& source,
  const SharedPlaces& places, dsm::FunctionRef<double(std::uint64_t cell)> getCellValue,
  int threads, dsm::Messenger& messenger, dsm::FunctionRef<void(double)> progress = {});

} // namespace bricks

#endif
