// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/layout/FillValues.h"

#include "DSMBricks/base/ValidValues.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace bricks
{

namespace
{

/// A kind of fill: values beyond the limits are of this kind, if the others are as it says.
struct Kind
{
  ValueLimits Limits;
  double Fill; ///< the value farthest from the others
  bool IsGiant;

  /// Returns whether the fill stands alone beside values from `least` to `greatest`.
  bool StandsAlone(double least, double greatest) const
  {
    if (this->IsGiant)
    {
      constexpr double ratio = 1e-6;
      return std::max(std::abs(least), std::abs(greatest)) <= ratio * std::abs(this->Fill);
    }
    constexpr double airBelow = -1024.0; // the smallest number of Hounsfield that scanners store
    constexpr double ranges = 4.0;
    constexpr double rangesOfHounsfield = 0.125;
    const double gap = least - this->Fill;
    const double range = greatest - least;
    return gap > ranges * range ||
      (this->Fill < airBelow && least >= airBelow && gap >= rangesOfHounsfield * range);
  }
};

std::vector<Kind> FindKinds(const IsovalueSurvey& survey)
{
  constexpr double decades = 1e-3;
  constexpr double highestPadding = -999.0;
  std::vector<Kind> kinds;
  const double giant = std::max(std::abs(survey.Least), std::abs(survey.Greatest));
  if (giant >= ValidValues::LeastGiant)
  {
    kinds.push_back({ { -decades * giant, decades * giant }, giant, true });
  }
  if (survey.Least <= highestPadding)
  {
    const double above = std::nextafter(survey.Least, std::numeric_limits<double>::infinity());
    kinds.push_back({ { above, survey.Greatest }, survey.Least, false });
  }
  return kinds;
}

/// Bricks within the limits are made of macrocells within them, so what does not stand alone beside these bricks
/// does not beside the macrocells.
bool MayStandAlone(const Kind& kind, const std::vector<const std::vector<ValueRange>*>& bricks)
{
  ValueRange within = ValueRange::GetEmpty();
  for (const std::vector<ValueRange>* ranges : bricks)
  {
    for (const ValueRange& range : *ranges)
    {
      if (range.First <= range.Last &&
        kind.Limits.Hold(static_cast<double>(range.First), static_cast<double>(range.Last)))
      {
        within.Add(range);
      }
    }
  }
  return within.First > within.Last ||
    kind.StandsAlone(static_cast<double>(within.First), static_cast<double>(within.Last));
}

/// Returns the survey of the other values, if the kind of fill is there.
std::optional<IsovalueSurvey> LeaveOut(const Kind& kind, LimitedLook look)
{
  constexpr std::int64_t leastShare = 256; // the others are more than so many times as many
  const LimitedSurvey found = look(kind.Limits);
  const IsovalueSurvey& within = found.Within;
  const bool isThere = within.All > 0 && within.Least < within.Greatest &&
    (kind.IsGiant || found.Constant * leastShare >= found.All) &&
    kind.StandsAlone(within.Least, within.Greatest);
  return isThere ? std::optional(within) : std::nullopt;
}

} // namespace

IsovalueSurvey LeaveOutFills(const IsovalueSurvey& all,
  const std::vector<const std::vector<ValueRange>*>& bricks, LimitedLook look)
{
  IsovalueSurvey survey = all;
  constexpr int mostKinds = 8; // several fills may be in one array
  for (int number = 0; number < mostKinds && survey.All > 0; ++number)
  {
    std::optional<IsovalueSurvey> others;
    for (const Kind& kind : FindKinds(survey))
    {
      if (!others && MayStandAlone(kind, bricks))
      {
        others = LeaveOut(kind, look);
      }
    }
    if (!others)
    {
      break;
    }
    survey = *others;
  }
  return survey;
}

LimitedSurvey AddSurveys(const LimitedSurvey& mine, dsm::Messenger& messenger)
{
  LimitedSurvey sum;
  for (const LimitedSurvey& one : messenger.AllGatherValue(mine))
  {
    sum.Add(one);
  }
  return sum;
}

} // namespace bricks
