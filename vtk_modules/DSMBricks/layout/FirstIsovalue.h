// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_FirstIsovalue_h
#define bricks_FirstIsovalue_h

#include "DSMBricks/layout/VoxelField.h"
#include "DSMCore/transport/Messenger.h"

#include <memory>
#include <optional>
#include <vector>

namespace bricks
{

/// Collective. An isovalue whose surface is worth a first look, where nobody has chosen one: a value
/// that divides the volume into two parts whose values differ most (Otsu, A Threshold Selection
/// Method from Gray-Level Histograms, 1979), in favour of surfaces that the volume's border does not
/// cut open. Both are told from the ranges of the macrocells, so no sample is read; every rank looks
/// through the bricks that it owns. Depends on the values only, not on the number of ranks.
/// `fields`: one a lattice, some null. Not set where no surface passes at any value.
std::optional<double> FindFirstIsovalue(
  const std::vector<std::shared_ptr<const VoxelField>>& fields, dsm::Messenger& messenger);

} // namespace bricks

#endif
