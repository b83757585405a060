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

/// Collective. Suggests an isovalue for a first image, if the user has not chosen one: a value that divides
/// the volume into two parts whose values differ most (Otsu, A Threshold Selection Method from Gray-Level
/// Histograms, 1979). It prefers surfaces that the volume's border does not cut open. Both criteria use the
/// ranges of the macrocells, so no sample is read; every rank examines the bricks that it owns. The result
/// depends on the values only, not on the number of ranks. `fields`: one for each lattice, some null. `others`: a survey of further
/// bricks, the same on every rank; null: none. Returns nothing if no surface passes at any value.
std::optional<double> FindFirstIsovalue(
  const std::vector<std::shared_ptr<const VoxelField>>& fields, dsm::Messenger& messenger,
  const IsovalueSurvey* others = nullptr);

} // namespace bricks

#endif
