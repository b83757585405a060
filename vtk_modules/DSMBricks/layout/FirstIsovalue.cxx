// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/layout/FirstIsovalue.h"

#include "DSMBricks/layout/IsovalueSurvey.h"

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

/// Collective. Surveys the fields that have no survey yet.
IsovalueSurvey LookThrough(
  const std::vector<std::shared_ptr<const VoxelField>>& fields, dsm::Messenger& messenger)
{
  IsovalueSurvey mine;
  messenger.RunTogether("Surveying the macrocells",
    [&]
    {
      for (const auto& field : fields)
      {
        if (field && !field->Survey)
        {
          field->Segment->ForEachResident([&](dsm::BlockId id, const std::byte* block, std::size_t)
            { mine.CountBrick(field->Lattice, id, block); });
        }
      }
    });
  IsovalueSurvey all;
  for (const IsovalueSurvey& one : messenger.AllGatherValue(mine))
  {
    all.Add(one);
  }
  return all;
}

} // namespace

std::optional<double> FindFirstIsovalue(
  const std::vector<std::shared_ptr<const VoxelField>>& fields, dsm::Messenger& messenger,
  const IsovalueSurvey* others)
{
  // The same on every rank.
  const auto isAny = [&](const auto& holds)
  {
    return std::any_of(
      fields.begin(), fields.end(), [&](const auto& field) { return field && holds(*field); });
  };
  const auto mayHaveSurface = [](const VoxelField& field)
  { return field.Hierarchy.GetRange().First < field.Hierarchy.GetRange().Last; };
  if (!isAny(mayHaveSurface) && !(others && others->Least < others->Greatest))
  {
    return std::nullopt;
  }
  IsovalueSurvey all;
  if (isAny([](const VoxelField& field) { return !field.Survey; }))
  {
    all = LookThrough(fields, messenger);
  }
  for (const auto& field : fields)
  {
    if (field && field->Survey)
    {
      all.Add(*field->Survey);
    }
  }
  if (others)
  {
    all.Add(*others);
  }
  all.Accumulate();
  const auto worths = FindWorths(all);
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
  return all.GetBorder(border);
}

} // namespace bricks
