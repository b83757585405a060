// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_IsovaluePredicate_h
#define rt_IsovaluePredicate_h

#include "DSMBricks/base/ValueRange.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace rt
{

/// Returns whether one of some isovalues may be within a range of values: for walks over macrocells (BeamDescent,
/// BrickWalk) and over hierarchies of boxes (ChildrenInRange) that look for isosurfaces.
class IsovaluePredicate
{
public:
  /// `isovalues`: as in LevelSets; kept by reference.
  explicit IsovaluePredicate(const std::vector<double>& isovalues)
    : Isovalues(isovalues)
    , Lowest(isovalues.empty() ? std::numeric_limits<double>::infinity() : isovalues.front())
    , Highest(isovalues.empty() ? -std::numeric_limits<double>::infinity() : isovalues.back())
  {
  }

  bool operator()(const bricks::ValueRange& range) const
  {
    if (!(range.First < this->Highest && this->Lowest <= range.Last))
    {
      return false;
    }
    return this->Isovalues.size() == 1 || this->MayHoldAny(range);
  }

private:
  bool MayHoldAny(const bricks::ValueRange& range) const
  {
    return std::any_of(this->Isovalues.begin(), this->Isovalues.end(),
      [&](double isovalue) { return range.MayHold(isovalue); });
  }

  const std::vector<double>& Isovalues;
  double Lowest;
  double Highest;
};

} // namespace rt

#endif
