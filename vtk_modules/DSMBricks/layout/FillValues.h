// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_FillValues_h
#define bricks_FillValues_h

#include "DSMBricks/base/ValueRange.h"
#include "DSMBricks/layout/IsovalueSurvey.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/transport/Messenger.h"

#include <vector>

namespace bricks
{

/// Surveys the macrocells whose values are all within limits. Collective: returns the sum over all ranks.
using LimitedLook = dsm::FunctionRef<LimitedSurvey(const ValueLimits&)>;

/// Collective. Leaves fill values that nothing declares out of a survey, so that they decide neither the
/// first isovalue nor the range in which it is sought. Two kinds are found, from the ranges of macrocells:
/// - giants: magnitudes of at least ValidValues::LeastGiant that are at least a million times as large as all
///   other values, with three empty decades between (1e20, 9.97e36, -3.4e38, -1.8e308);
/// - a lowest value of at most -999 that fills at least one macrocell in 256, and that is farther from
///   the other values than four times their range (-9999, -32768); or that is below the Hounsfield scale,
///   which begins at -1024, as all other values are not (-2000 and -3024, the padding of CT scanners).
/// A fill that touches every macrocell (a box of 5 x 5 x 5 samples) is not found. `bricks`: ranges of all bricks,
/// of each lattice; they rule most data out, so that `look` is seldom called. `all` and `bricks` are the same on
/// every rank. Returns `all` if no value is a fill.
IsovalueSurvey LeaveOutFills(const IsovalueSurvey& all,
  const std::vector<const std::vector<ValueRange>*>& bricks, LimitedLook look);

/// Collective. The sum of every rank's surveys.
LimitedSurvey AddSurveys(const LimitedSurvey& mine, dsm::Messenger& messenger);

} // namespace bricks

#endif
