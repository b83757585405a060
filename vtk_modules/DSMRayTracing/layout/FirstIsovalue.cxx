// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/layout/FirstIsovalue.h"

#include "DSMRayTracing/layout/IsovalueSurvey.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace rt
{

namespace
{

constexpr int Intervals = IsovalueSurvey::Intervals;
constexpr int Borders = IsovalueSurvey::Borders;

/// How much less a surface is worth that is cut open as often as one that fills the volume evenly.
constexpr double OpenPenalty = 0.35;

/// Worths that are this near to the best are as good; the middle of them is taken.
constexpr double Tolerance = 0.02;

/// The range of all fields; empty (First > Last) when none holds data.
ValueRange FindRange(const std::vector<std::shared_ptr<const VoxelField>>& fields)
{
  ValueRange range{ 1.0f, -1.0f };
  for (const auto& field : fields)
  {
    if (!field || field->Hierarchy.GetRange().First > field->Hierarchy.GetRange().Last)
    {
      continue;
    }
    const ValueRange& one = field->Hierarchy.GetRange();
    const bool isFirst = range.First > range.Last;
    range.First = isFirst ? one.First : std::min(range.First, one.First);
    range.Last = isFirst ? one.Last : std::max(range.Last, one.Last);
  }
  return range;
}

void CountField(const VoxelField& field, const ValueRange& range, IsovalueSurvey& survey)
{
  field.Segment->ForEachResident([&](dsm::BlockId id, const std::byte* block, std::size_t)
    { survey.CountBrick(field.Lattice, id, block, range); });
}

/// Of each border, how much its surface is worth; negative where there is none.
std::array<double, Borders> FindWorths(const IsovalueSurvey& survey)
{
  double all = 0.0;
  double moment = 0.0;
  for (int interval = 0; interval < Intervals; ++interval)
  {
    const auto count = static_cast<double>(survey.Values[interval]);
    all += count;
    moment += count * interval;
  }
  const double evenly = static_cast<double>(survey.AtBorder) /
    static_cast<double>(std::max<std::int64_t>(survey.All, 1));
  std::array<double, Borders> worths;
  double below = 0.0;
  double momentBelow = 0.0;
  for (int border = 0; border < Borders; ++border)
  {
    const auto count = static_cast<double>(survey.Values[border]);
    below += count;
    momentBelow += count * border;
    if (survey.Crossed[border] == 0)
    {
      worths[border] = -1.0;
      continue;
    }
    // Below and above hold something of the macrocells that are crossed.
    const double distance = (moment - momentBelow) / (all - below) - momentBelow / below;
    const double cut =
      static_cast<double>(survey.CutOpen[border]) / static_cast<double>(survey.Crossed[border]);
    const double open = evenly > 0.0 ? std::min(cut / evenly, 1.0) : 0.0;
    worths[border] = below * (all - below) * distance * distance * (1.0 - OpenPenalty * open);
  }
  return worths;
}

/// Null where the bricks must be looked through.
const IsovalueSurvey* FindKnownSurvey(
  const std::vector<std::shared_ptr<const VoxelField>>& fields, const ValueRange& range)
{
  const VoxelField* const only = fields.size() == 1 ? fields.front().get() : nullptr;
  return only && only->Survey && only->Survey->IsOf(range) ? &*only->Survey : nullptr;
}

/// Collective.
IsovalueSurvey LookThrough(const std::vector<std::shared_ptr<const VoxelField>>& fields,
  const ValueRange& range, dsm::Messenger& messenger)
{
  IsovalueSurvey mine;
  messenger.RunTogether("Looking through the macrocells",
    [&]
    {
      for (const auto& field : fields)
      {
        if (field)
        {
          CountField(*field, range, mine);
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
  const std::vector<std::shared_ptr<const VoxelField>>& fields, dsm::Messenger& messenger)
{
  const ValueRange range = FindRange(fields); // the same on every rank
  if (!(range.First < range.Last) || !std::isfinite(range.First) || !std::isfinite(range.Last))
  {
    return std::nullopt;
  }
  IsovalueSurvey all;
  if (const IsovalueSurvey* known = FindKnownSurvey(fields, range))
  {
    all = *known;
  }
  else
  {
    all = LookThrough(fields, range, messenger);
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
  const double width = (static_cast<double>(range.Last) - range.First) / Intervals;
  return range.First + (border + 1.0) * width;
}

bool AreBeyondFloats(const std::vector<std::shared_ptr<const VoxelField>>& fields)
{
  const ValueRange range = FindRange(fields);
  const float width = range.Last - range.First;
  return width > 0.0f && (std::isinf(width) || width < std::numeric_limits<float>::min());
}

} // namespace rt
