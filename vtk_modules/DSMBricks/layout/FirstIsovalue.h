// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_FirstIsovalue_h
#define bricks_FirstIsovalue_h

#include "DSMBricks/layout/IsovalueSurvey.h"
#include "DSMBricks/layout/VoxelField.h"
#include "DSMCore/transport/Messenger.h"

#include <memory>
#include <optional>
#include <vector>

namespace bricks
{

/// Isovalue and range of values for a first image of a volume.
struct FirstLook
{
  /// Empty if no surface passes at any value.
  std::optional<double> Isovalue;
  /// Range of the values without fills (FillValues.h); Least > Greatest if there are no values.
  ValueLimits Values{ 1.0, 0.0 };
};

/// Collective. Suggests an isovalue for a first image, if the user has not chosen one: a value that divides the
/// volume into two parts whose values differ most (Otsu, A Threshold Selection Method from Gray-Level Histograms,
/// 1979). It prefers surfaces that the volume's border does not cut open. Fill values do not count. All criteria
/// use the ranges of the macrocells, so no sample is read; every rank examines the bricks that it owns. The result
/// depends on the values only, not on the number of ranks. `fields`: one for each lattice, some null. `others`: a
/// survey of further bricks, the same on every rank; null: none.
FirstLook FindFirstLook(const std::vector<std::shared_ptr<const VoxelField>>& fields,
  dsm::Messenger& messenger, const IsovalueSurvey* others = nullptr);

} // namespace bricks

#endif
