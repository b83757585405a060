// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_ValuePredicates_h
#define rt_ValuePredicates_h

#include "DSMBricks/base/ValueRange.h"
#include "DSMRayTracing/look/TransferFunction.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace rt
{

/// Returns whether one of some isovalues may be within a range of values: what walks over macrocells (BeamDescent,
/// BrickWalk), hierarchies of boxes (ChildrenInRange) and segments (FieldSegment) ask for isosurfaces.
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

/// Returns whether a medium may be visible within a range of values. Keeps a reference.
class TransferPredicate
{
public:
  explicit TransferPredicate(const TransferFunction& function)
    : Function(function)
  {
  }

  bool operator()(const bricks::ValueRange& range) const
  {
    return this->Function.IsSeen(range.First, range.Last);
  }
  /// Returns whether it is visible everywhere in the range, as far as that is easily told.
  bool HoldsAll(const bricks::ValueRange& range) const
  {
    return range.First <= range.Last &&
      this->Function.AreAllBinsSeen(this->Function.GetBin(this->Function.GetPlace(range.First)),
        this->Function.GetBin(this->Function.GetPlace(range.Last)));
  }

private:
  const TransferFunction& Function;
};

/// Returns whether any value of a range is above a limit, all times a sign.
class ExtremumPredicate
{
public:
  ExtremumPredicate(double sign, double limit)
    : Sign(sign)
    , Limit(limit)
  {
  }

  bool operator()(const bricks::ValueRange& range) const
  {
    return (*this)(static_cast<double>(range.First), static_cast<double>(range.Last));
  }
  bool operator()(double first, double last) const
  {
    return first <= last && this->Sign * (this->Sign > 0.0 ? last : first) > this->Limit;
  }

private:
  double Sign;
  double Limit;
};

} // namespace rt

#endif
