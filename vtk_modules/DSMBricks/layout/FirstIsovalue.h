// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_FirstIsovalue_h
#define bricks_FirstIsovalue_h

#include "DSMBricks/layout/IsovalueSurvey.h"
#include "DSMBricks/layout/VoxelField.h"
#include "DSMCore/transport/Messenger.h"

#include <optional>
#include <vector>

namespace bricks
{

/// Bricks of one field.
struct SurveyedBricks
{
  /// Survey of all of them, the same on every rank; null: the bricks of Field are examined.
  const IsovalueSurvey* Survey;
  /// A lattice's field, whose fill values are found by its bricks; null for other fields.
  const VoxelField* Field = nullptr;
};

/// Isovalue and macrocells that a first image of a volume shows.
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
/// depends on the values only, not on the number of ranks.
FirstLook FindFirstLook(const std::vector<SurveyedBricks>& all, dsm::Messenger& messenger);

} // namespace bricks

#endif
