// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/layout/IsovalueSurvey.h"

#include "DSMRayTracing/layout/VoxelBrick.h"

#include <algorithm>

namespace rt
{

namespace
{

/// What a macrocell counts for in all intervals together; a number that many counts divide, so that
/// the sums are exact, in whatever order.
constexpr std::int64_t Unit = 1 << 20;

void CountMacrocell(IsovalueSurvey& survey, int first, int last, bool atBorder)
{
  const std::int64_t share = Unit / (last - first + 1);
  survey.Values[first] += share;
  survey.Values[last + 1] -= share;
  ++survey.Crossed[first];
  --survey.Crossed[last];
  ++survey.All;
  if (atBorder)
  {
    ++survey.CutOpen[first];
    --survey.CutOpen[last];
    ++survey.AtBorder;
  }
}

template <class T>
void CountTyped(const VoxelBrick<T>& brick, const Box& cells, const Index3& end,
  const ValueRange& range, IsovalueSurvey& survey)
{
  constexpr int intervals = IsovalueSurvey::Intervals;
  const double first = range.First;
  const double scale = intervals / (static_cast<double>(range.Last) - first);
  const auto findInterval = [=](T value)
  {
    const double place = (static_cast<double>(value) - first) * scale;
    return static_cast<int>(std::clamp(place, 0.0, intervals - 1.0));
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
          CountMacrocell(survey, findInterval(macrocell->Min), findInterval(macrocell->Max),
            rowAtBorder || isAtBorder(0, x));
        }
      }
    }
  }
}

} // namespace

void IsovalueSurvey::CountBrick(
  const BrickLattice& lattice, dsm::BlockId id, const std::byte* block, const ValueRange& range)
{
  this->Range = range;
  Dispatch(lattice.GetScalarType(),
    [&](auto sample)
    {
      CountTyped(VoxelBrick<decltype(sample)>(block), lattice.GetCellsOfBrick(id),
        lattice.GetCells(), range, *this);
    });
}

void IsovalueSurvey::Add(const IsovalueSurvey& other)
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

void IsovalueSurvey::Accumulate()
{
  for (int interval = 0; interval < Intervals; ++interval)
  {
    this->Values[interval + 1] += this->Values[interval];
    this->Crossed[interval + 1] += this->Crossed[interval];
    this->CutOpen[interval + 1] += this->CutOpen[interval];
  }
}

} // namespace rt
