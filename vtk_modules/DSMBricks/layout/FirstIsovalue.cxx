// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/layout/FirstIsovalue.h"

#include "DSMBricks/layout/FillValues.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace bricks
{

namespace
{

/// How much less a surface is worth that is cut open as often as one that fills the volume evenly.
constexpr double OpenPenalty = 0.35;

/// Worths that are this near to the best are as good; the middle of them is taken.
constexpr double Tolerance = 0.02;

/// Returns the worth of the surface at each border; negative where there is none.
std::array<double, IsovalueSurvey::Intervals> FindWorths(const IsovalueSurvey& survey)
{
  const std::size_t intervals = survey.CountIntervals();
  double all = 0.0;
  double moment = 0.0;
  for (std::size_t interval = 0; interval < intervals; ++interval)
  {
    const auto count = static_cast<double>(survey.Values[interval]);
    all += count;
    moment += count * static_cast<double>(interval);
  }
  const double evenly = static_cast<double>(survey.AtBorder) /
    static_cast<double>(std::max<std::int64_t>(survey.All, 1));
  std::array<double, IsovalueSurvey::Intervals> worths;
  worths.fill(-1.0);
  double below = 0.0;
  double momentBelow = 0.0;
  for (std::size_t border = 0; border + 1 < intervals; ++border)
  {
    const auto count = static_cast<double>(survey.Values[border]);
    below += count;
    momentBelow += count * static_cast<double>(border);
    if (survey.Crossed[border] == 0 || below == 0.0 || below == all)
    {
      continue;
    }
    const double distance = (moment - momentBelow) / (all - below) - momentBelow / below;
    const double cut =
      static_cast<double>(survey.CutOpen[border]) / static_cast<double>(survey.Crossed[border]);
    const double open = evenly > 0.0 ? std::min(cut / evenly, 1.0) : 0.0;
    worths[border] = below * (all - below) * distance * distance * (1.0 - OpenPenalty * open);
  }
  return worths;
}

/// Collective. Surveys the fields that have no survey yet, within limits.
LimitedSurvey LookThrough(
  const std::vector<SurveyedBricks>& all, dsm::Messenger& messenger, const ValueLimits& limits)
{
  LimitedSurvey mine;
  messenger.RunTogether("Surveying the macrocells",
    [&]
    {
      for (const SurveyedBricks& one : all)
      {
        if (!one.Survey)
        {
          const BrickLattice& lattice = one.Field->Lattice;
          one.Field->Segment->ForEachResident(
            [&](dsm::BlockId id, const std::byte* block, std::size_t)
            { mine.CountBrick(lattice.GetCellsOfBrick(id), lattice.GetCells(), block, limits); });
        }
      }
    });
  return AddSurveys(mine, messenger);
}

/// Adds a survey that cannot be divided; if any of its values are beyond the limits, all are.
void AddWhole(const IsovalueSurvey& survey, const ValueLimits& limits, LimitedSurvey& sum)
{
  sum.All += survey.All;
  if (limits.Hold(survey.Least, survey.Greatest))
  {
    sum.Within.Add(survey);
  }
  else if (survey.Least == survey.Greatest)
  {
    sum.Constant += survey.All;
  }
}

/// Returns the isovalue of most worth.
std::optional<double> Choose(IsovalueSurvey survey)
{
  survey.Accumulate();
  const auto worths = FindWorths(survey);
  const auto best = std::max_element(worths.begin(), worths.end());
  if (*best <= 0.0)
  {
    return std::nullopt;
  }
  const auto isAsGood = [&](double worth) { return worth >= (1.0 - Tolerance) * *best; };
  auto first = best;
  while (first != worths.begin() && isAsGood(*(first - 1)))
  {
    --first;
  }
  const auto last = std::find_if_not(best, worths.end(), isAsGood) - 1;
  const double border =
    0.5 * static_cast<double>((first - worths.begin()) + (last - worths.begin()));
  return survey.GetBorder(border);
}

} // namespace

FirstLook FindFirstLook(const std::vector<SurveyedBricks>& all, dsm::Messenger& messenger)
{
  // The same on every rank.
  const auto mayHaveSurface = [](const SurveyedBricks& one)
  {
    return one.Field ? one.Field->Hierarchy.GetRange().First < one.Field->Hierarchy.GetRange().Last
                     : one.Survey->Least < one.Survey->Greatest;
  };
  if (std::none_of(all.begin(), all.end(), mayHaveSurface))
  {
    return {};
  }
  const bool isSurveyed = std::all_of(
    all.begin(), all.end(), [](const SurveyedBricks& one) { return one.Survey != nullptr; });
  const auto look = [&](const ValueLimits& limits)
  {
    LimitedSurvey sum = isSurveyed ? LimitedSurvey() : LookThrough(all, messenger, limits);
    for (const SurveyedBricks& one : all)
    {
      if (one.Survey)
      {
        AddWhole(*one.Survey, limits, sum);
      }
    }
    return sum;
  };
  std::vector<const std::vector<ValueRange>*> bricks;
  for (const SurveyedBricks& one : all)
  {
    if (one.Field)
    {
      bricks.push_back(&one.Field->Hierarchy.GetLevels().front().Ranges);
    }
  }
  const IsovalueSurvey survey = LeaveOutFills(look({}).Within, bricks, look);
  return { Choose(survey), { survey.Least, survey.Greatest } };
}

} // namespace bricks
