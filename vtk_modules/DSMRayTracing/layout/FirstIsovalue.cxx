// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/layout/FirstIsovalue.h"

#include "DSMRayTracing/layout/VoxelBrick.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace rt
{

namespace
{

/// Intervals that the range of the values is divided into, and the borders between them, which are
/// the isovalues to choose from.
constexpr int Intervals = 256;
constexpr int Borders = Intervals - 1;

/// What a macrocell counts for in all intervals together; a number that many counts divide, so that
/// the sums are exact, in whatever order.
constexpr std::int64_t Unit = 1 << 20;

/// How much less a surface is worth that is cut open as often as one that fills the volume evenly.
constexpr double OpenPenalty = 0.35;

/// Worths that are this near to the best are as good; the middle of them is taken.
constexpr double Tolerance = 0.02;

/// Macrocells by their values. Until it is accumulated, each entry is what changes there.
struct Survey
{
  std::array<std::int64_t, Intervals + 1> Values{};  ///< their number, in Units
  std::array<std::int64_t, Intervals + 1> Crossed{}; ///< a surface passes
  std::array<std::int64_t, Intervals + 1> CutOpen{}; ///< so it does, and the volume ends there
  std::int64_t All = 0;
  std::int64_t AtBorder = 0;

  void Count(int first, int last, bool atBorder)
  {
    const std::int64_t share = Unit / (last - first + 1);
    this->Values[first] += share;
    this->Values[last + 1] -= share;
    ++this->Crossed[first];
    --this->Crossed[last];
    ++this->All;
    if (atBorder)
    {
      ++this->CutOpen[first];
      --this->CutOpen[last];
      ++this->AtBorder;
    }
  }

  void Add(const Survey& other)
  {
    for (int interval = 0; interval <= Intervals; ++interval)
    {
      this->Values[interval] += other.Values[interval];
      this->Crossed[interval] += other.Crossed[interval];
      this->CutOpen[interval] += other.CutOpen[interval];
    }
    this->All += other.All;
    this->AtBorder += other.AtBorder;
  }

  void Accumulate()
  {
    for (int interval = 0; interval < Intervals; ++interval)
    {
      this->Values[interval + 1] += this->Values[interval];
      this->Crossed[interval + 1] += this->Crossed[interval];
      this->CutOpen[interval + 1] += this->CutOpen[interval];
    }
  }
};

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

template <class T>
void CountBrick(const VoxelBrick<T>& brick, const Box& cells, const Index3& end,
  const ValueRange& range, Survey& survey)
{
  const double first = range.First;
  const double scale = Intervals / (static_cast<double>(range.Last) - first);
  const auto findInterval = [=](T value)
  {
    const double place = (static_cast<double>(value) - first) * scale;
    return static_cast<int>(std::clamp(place, 0.0, Intervals - 1.0));
  };
  const MacrocellRange<T>* macrocell = brick.GetMacrocellRanges();
  const auto isAtBorder = [&](int axis, int number)
  {
    const auto from = cells.Min[axis] + number * MacrocellEdge;
    return from == 0 || from + MacrocellEdge >= end[axis];
  };
  for (int z = 0; z < brick.GetMacrocells(2); ++z)
  {
    for (int y = 0; y < brick.GetMacrocells(1); ++y)
    {
      const bool rowAtBorder = isAtBorder(2, z) || isAtBorder(1, y);
      for (int x = 0; x < brick.GetMacrocells(0); ++x, ++macrocell)
      {
        if (macrocell->Min <= macrocell->Max)
        {
          survey.Count(findInterval(macrocell->Min), findInterval(macrocell->Max),
            rowAtBorder || isAtBorder(0, x));
        }
      }
    }
  }
}

void CountField(const VoxelField& field, const ValueRange& range, Survey& survey)
{
  field.Segment->ForEachResident(
    [&](dsm::BlockId id, const std::byte* block, std::size_t)
    {
      Dispatch(field.Lattice.GetScalarType(),
        [&](auto sample)
        {
          CountBrick(VoxelBrick<decltype(sample)>(block), field.Lattice.GetCellsOfBrick(id),
            field.Lattice.GetCells(), range, survey);
        });
    });
}

/// Of each border, how much its surface is worth; negative where there is none.
std::array<double, Borders> FindWorths(const Survey& survey)
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

} // namespace

std::optional<double> FindFirstIsovalue(
  const std::vector<std::shared_ptr<const VoxelField>>& fields, dsm::Messenger& messenger)
{
  const ValueRange range = FindRange(fields); // the same on every rank
  if (!(range.First < range.Last) || !std::isfinite(range.First) || !std::isfinite(range.Last))
  {
    return std::nullopt;
  }
  Survey mine;
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
  Survey all;
  for (const Survey& one : messenger.AllGatherValue(mine))
  {
    all.Add(one);
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

} // namespace rt
