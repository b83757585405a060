// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_CellExchange_h
#define bricks_CellExchange_h

#include "DSMBricks/build/CellAverages.h"
#include "DSMBricks/build/LatticePlan.h"
#include "DSMCore/transport/Messenger.h"

#include <cstddef>
#include <map>
#include <memory>
#include <string_view>
#include <vector>

namespace bricks
{

/// Gives every piece of a lattice the values of the cells around it, which other pieces have, or
/// which ghost cells copy.
namespace CellExchange
{

/// One piece of the lattice; the same list on every rank.
struct Piece
{
  int Rank;    ///< that has it
  bool IsUsed; ///< it has the array
  bool HasMask;
  Box Cells;
  Box Reach; ///< see CellReader
};

/// Collective. `own`: this rank's, by number of piece; all that are used. A layer goes only to the ranks of the pieces
/// beside it. Ghost cells are sent only where no piece has the cells. Throws the same dsm::Error on every rank when any
/// fails.
void Run(dsm::Messenger& messenger, std::string_view what, const std::vector<Piece>& pieces,
  const std::map<std::size_t, std::shared_ptr<CellAverages>>& own);

} // namespace CellExchange

} // namespace bricks

#endif
