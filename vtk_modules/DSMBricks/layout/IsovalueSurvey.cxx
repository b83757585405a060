// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/layout/IsovalueSurvey.h"

#include "DSMBricks/layout/VoxelBrick.h"

#include <algorithm>
#include <cmath>

namespace bricks
{

namespace
{

constexpr int LowestExponent = -1000;

/// Returns the interval of a value, for intervals of equal width.
std::int64_t FindInterval(double value, double perWidth)
{
  const double place = value * perWidth;
  const auto interval = static_cast<std::int64_t>(place);
  return static_cast<double>(interval) > place ? interval - 1 : interval;
}

/// In how many intervals, one less, a range lies.
std::int64_t FindSpan(double least, double greatest, std::int64_t exponent)
{
  const double perWidth = std::ldexp(1.0, static_cast<int>(-exponent));
  return FindInterval(greatest, perWidth) - FindInterval(least, perWidth);
}

/// The least with which the intervals reach over a range, and their numbers fit their type; it grows with the range.
std::int64_t FindExponent(double least, double greatest)
{
  constexpr int bits = 60;
  const auto getExponent = [](double value)
  { return value > 0.0 ? std::ilogb(value) : LowestExponent; };
  const double magnitude = std::max(std::abs(least), std::abs(greatest));
  // The range itself may be more than a double holds.
  const int ofRange =
    getExponent(0.5 * greatest - 0.5 * least) + 1 - std::ilogb(double(IsovalueSurvey::Intervals));
  std::int64_t exponent = std::max({ getExponent(magnitude) - bits, ofRange, LowestExponent });
  while (FindSpan(least, greatest, exponent) >= IsovalueSurvey::Intervals)
  {
    ++exponent;
  }
  return exponent;
}

/// Calls visit(range, atBorder) for the macrocells of a brick that hold data.
template <class T, class Visit>
void ForEachMacrocell(
  const VoxelBrick<T>& brick, const Box& cells, const Index3& end, const Visit& visit)
{
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
          visit(*macrocell, rowAtBorder || isAtBorder(0, x));
        }
      }
    }
  }
}

/// Puts entries where they belong among intervals that are 2^shift times as wide, the first of which is number
/// `first` instead of `oldFirst` of the old ones.
void Move(
  IsovalueSurvey::Counts& counts, std::int64_t oldFirst, std::int64_t shift, std::int64_t first)
{
  IsovalueSurvey::Counts moved{};
  for (std::size_t interval = 0; interval < counts.size(); ++interval)
  {
    if (counts[interval] != 0)
    {
      const std::int64_t to = ((oldFirst + static_cast<std::int64_t>(interval)) >> shift) - first;
      // Always true for a valid survey.
      if (to >= 0 && to < IsovalueSurvey::Intervals)
      {
        moved[static_cast<std::size_t>(to)] += counts[interval];
      }
    }
  }
  counts = moved;
}

/// Returns whether at most `most` macrocells cross each border, and none crosses the last. `counts`
/// are not accumulated.
bool AreCrossings(const IsovalueSurvey::Counts& counts, std::size_t intervals, std::int64_t most)
{
  std::int64_t crossed = 0;
  for (std::size_t interval = 0; interval < counts.size(); ++interval)
  {
    const std::int64_t change = counts[interval];
    if (change < -most || change > most || (interval >= intervals && change != 0))
    {
      return false;
    }
    crossed += change;
    if (crossed < 0 || crossed > most)
    {
      return false;
    }
  }
  return crossed == 0;
}

} // namespace

bool IsovalueSurvey::IsValid(std::int64_t mostMacrocells) const
{
  constexpr std::int64_t valuesOfMacrocell = 4;
  constexpr std::int64_t highestExponent = 1023; // borders are finite numbers
  if (this->All < 0 || this->All > mostMacrocells || this->AtBorder < 0 ||
    this->AtBorder > this->All)
  {
    return false;
  }
  std::size_t intervals = 0;
  if (this->All > 0)
  {
    if (!std::isfinite(this->Least) || !std::isfinite(this->Greatest) ||
      this->Least > this->Greatest || this->Exponent > highestExponent ||
      this->Exponent < FindExponent(this->Least, this->Greatest) ||
      this->First != FindInterval(this->Least, std::ldexp(1.0, static_cast<int>(-this->Exponent))))
    {
      return false;
    }
    intervals = this->CountIntervals(); // at most Intervals, as the exponent is high enough
  }
  else if (std::isnan(this->Least) || std::isnan(this->Greatest) || this->Least <= this->Greatest)
  {
    return false;
  }
  std::int64_t left = valuesOfMacrocell * this->All;
  for (std::size_t interval = 0; interval < this->Values.size(); ++interval)
  {
    const std::int64_t count = this->Values[interval];
    if (count < 0 || count > left || (interval >= intervals && count != 0))
    {
      return false;
    }
    left -= count;
  }
  return left == 0 && AreCrossings(this->Crossed, intervals, this->All) &&
    AreCrossings(this->CutOpen, intervals, this->AtBorder);
}

void IsovalueSurvey::Reach(double least, double greatest)
{
  const bool isFirst = this->Least > this->Greatest;
  if (!isFirst && least >= this->Least && greatest <= this->Greatest)
  {
    return;
  }
  this->Least = std::min(least, this->Least);
  this->Greatest = std::max(greatest, this->Greatest);
  const std::int64_t exponent = FindExponent(this->Least, this->Greatest);
  this->Widen(isFirst ? exponent : std::max(exponent, this->Exponent));
}

void IsovalueSurvey::Widen(std::int64_t exponent)
{
  constexpr std::int64_t most = 63; // then all is in the intervals on both sides of 0
  const std::int64_t shift = std::clamp<std::int64_t>(exponent - this->Exponent, 0, most);
  const std::int64_t first =
    FindInterval(this->Least, std::ldexp(1.0, static_cast<int>(-exponent)));
  for (Counts* counts : { &this->Values, &this->Crossed, &this->CutOpen })
  {
    Move(*counts, this->First, shift, first);
  }
  this->First = first;
  this->Exponent = exponent;
}

void IsovalueSurvey::CountBrick(
  const BrickLattice& lattice, dsm::BlockId id, const std::byte* block)
{
  this->CountBrick(lattice.GetCellsOfBrick(id), lattice.GetCells(), block);
}

void IsovalueSurvey::CountBrick(
  const Box& cells, const Index3& end, const std::byte* block, const ValueLimits& limits)
{
  Dispatch(reinterpret_cast<const VoxelBrickHeader*>(block)->Type,
    [&](auto sample)
    {
      using T = decltype(sample);
      const VoxelBrick<T> brick(block);
      const auto forEach = [&](const auto& visit)
      {
        ForEachMacrocell(brick, cells, end,
          [&](const MacrocellRange<T>& range, bool atBorder)
          {
            if (limits.Hold(static_cast<double>(range.Min), static_cast<double>(range.Max)))
            {
              visit(range, atBorder);
            }
          });
      };
      double least = std::numeric_limits<double>::max();
      double greatest = std::numeric_limits<double>::lowest();
      forEach(
        [&](const MacrocellRange<T>& range, bool)
        {
          least = std::min(least, static_cast<double>(range.Min));
          greatest = std::max(greatest, static_cast<double>(range.Max));
        });
      if (least > greatest)
      {
        return;
      }
      this->Reach(least, greatest);
      forEach(
        [&](const MacrocellRange<T>& range, bool atBorder) {
          this->CountRange(
            static_cast<double>(range.Min), static_cast<double>(range.Max), atBorder);
        });
    });
}

void IsovalueSurvey::CountRange(double least, double greatest, bool atBorder)
{
  this->Reach(least, greatest);
  const double perWidth = std::ldexp(1.0, static_cast<int>(-this->Exponent));
  const auto find = [&](double value)
  { return static_cast<std::size_t>(FindInterval(value, perWidth) - this->First); };
  for (const double part : { 0.125, 0.375, 0.625, 0.875 })
  {
    ++this->Values[find(std::clamp(least * (1.0 - part) + greatest * part, least, greatest))];
  }
  const std::size_t first = find(least);
  const std::size_t last = find(greatest);
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

void LimitedSurvey::CountBrick(
  const Box& cells, const Index3& end, const std::byte* block, const ValueLimits& limits)
{
  this->Within.CountBrick(cells, end, block, limits);
  Dispatch(reinterpret_cast<const VoxelBrickHeader*>(block)->Type,
    [&](auto sample)
    {
      using T = decltype(sample);
      ForEachMacrocell(VoxelBrick<T>(block), cells, end,
        [&](const MacrocellRange<T>& range, bool)
        {
          const auto min = static_cast<double>(range.Min);
          const auto max = static_cast<double>(range.Max);
          ++this->All;
          this->Constant += min == max && !limits.Hold(min, max) ? 1 : 0;
        });
    });
}

void LimitedSurvey::Add(const LimitedSurvey& other)
{
  this->Within.Add(other.Within);
  this->All += other.All;
  this->Constant += other.Constant;
}

void IsovalueSurvey::CountUniform(const Box& cells, const Index3& end, double value)
{
  const Index3 macrocells = (cells.GetSize() + Index3(MacrocellEdge - 1)) / Index3(MacrocellEdge);
  Index3 inside = macrocells;
  for (int axis = 0; axis < 3; ++axis)
  {
    inside[axis] -= (cells.Min[axis] == 0 ? 1 : 0) + (cells.Max[axis] == end[axis] ? 1 : 0);
    inside[axis] = std::max<std::int64_t>(0, inside[axis]);
  }
  const std::int64_t count = macrocells.x * macrocells.y * macrocells.z;
  this->Reach(value, value);
  const double perWidth = std::ldexp(1.0, static_cast<int>(-this->Exponent));
  // A macrocell with one value crosses no border between intervals.
  this->Values[static_cast<std::size_t>(FindInterval(value, perWidth) - this->First)] += 4 * count;
  this->All += count;
  this->AtBorder += count - inside.x * inside.y * inside.z;
}

void IsovalueSurvey::Add(const IsovalueSurvey& other)
{
  if (other.All == 0)
  {
    return;
  }
  IsovalueSurvey same = other;
  this->Reach(other.Least, other.Greatest);
  same.Reach(this->Least, this->Greatest);
  for (std::size_t interval = 0; interval < this->Values.size(); ++interval)
  {
    this->Values[interval] += same.Values[interval];
    this->Crossed[interval] += same.Crossed[interval];
    this->CutOpen[interval] += same.CutOpen[interval];
  }
  this->All += same.All;
  this->AtBorder += same.AtBorder;
}

void IsovalueSurvey::Accumulate()
{
  for (std::size_t interval = 1; interval < this->Values.size(); ++interval)
  {
    this->Crossed[interval] += this->Crossed[interval - 1];
    this->CutOpen[interval] += this->CutOpen[interval - 1];
  }
}

std::size_t IsovalueSurvey::CountIntervals() const
{
  return this->All == 0
    ? 0
    : static_cast<std::size_t>(FindSpan(this->Least, this->Greatest, this->Exponent) + 1);
}

double IsovalueSurvey::GetBorder(double border) const
{
  return std::ldexp(
    static_cast<double>(this->First) + border + 1.0, static_cast<int>(this->Exponent));
}

} // namespace bricks
