// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_IsovalueSurvey_h
#define bricks_IsovalueSurvey_h

#include "DSMBricks/layout/BrickLattice.h"
#include "DSMCore/base/Block.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace bricks
{

/// Closed interval of values. Plain.
struct ValueLimits
{
  double Least = -std::numeric_limits<double>::infinity();
  double Greatest = std::numeric_limits<double>::infinity();

  /// Returns whether all values from `least` to `greatest` are within.
  bool Hold(double least, double greatest) const
  {
    return least >= this->Least && greatest <= this->Greatest;
  }
};

/// Histogram of a volume's macrocells over their values, in intervals of equal width; FindFirstIsovalue uses
/// it. The range of the values need not be known before: intervals are 2^Exponent wide, begin at multiples of
/// that, and become wider when values outside of them are added. So the result depends on the counted values
/// only, and not on their order. Plain, for messages between ranks and for files. Any thread, one at a time.
struct IsovalueSurvey
{
  /// At most so many have something in them, and at least half as many where the values are not all the same.
  static constexpr int Intervals = 512;
  using Counts = std::array<std::int64_t, Intervals>;

  /// Returns whether CountBrick and Add can have produced these numbers from at most
  /// `mostMacrocells` macrocells. A survey that was copied out of a file must pass before any other
  /// call. Returns false after Accumulate.
  bool IsValid(std::int64_t mostMacrocells) const;

  /// Counts the macrocells of a brick.
  void CountBrick(const BrickLattice& lattice, dsm::BlockId id, const std::byte* block);
  /// The same of a brick of these cells, of a lattice of cells from 0 to `end`. Macrocells that have
  /// values beyond the limits do not count.
  void CountBrick(
    const Box& cells, const Index3& end, const std::byte* block, const ValueLimits& limits = {});
  /// Counts a macrocell, or a group of other cells, by the range of its values, which is finite. `atBorder`: the volume
  /// ends there.
  void CountRange(double least, double greatest, bool atBorder);
  /// The same of a brick whose cells all hold data, and whose samples all are `value`, which is finite.
  void CountUniform(const Box& cells, const Index3& end, double value);
  /// Both surveys must be valid.
  void Add(const IsovalueSurvey& other);
  /// To be called once, after all is counted: sums up the entries of Crossed and CutOpen, which were changes from
  /// one interval to the next.
  void Accumulate();

  /// Intervals from the first to the last that has something in it.
  std::size_t CountIntervals() const;
  /// The value between an interval and the next one; `border` may lie between two.
  double GetBorder(double border) const;

  Counts Values{}; ///< four of each macrocell, which divide its range evenly
  /// Macrocells whose surface crosses the border between an interval and the next.
  Counts Crossed{};
  Counts CutOpen{}; ///< so it does, and the volume ends there
  std::int64_t All = 0;
  std::int64_t AtBorder = 0;
  std::int64_t First = 0; ///< the first interval begins at First * 2^Exponent
  std::int64_t Exponent = 0;
  double Least = std::numeric_limits<double>::max(); ///< range of all counted values
  double Greatest = std::numeric_limits<double>::lowest();

private:
  /// Intervals reach from `least` to `greatest` then, too.
  void Reach(double least, double greatest);
  void Widen(std::int64_t exponent);
};

/// Survey of the macrocells whose values are all within limits. Plain, for messages between ranks.
struct LimitedSurvey
{
  IsovalueSurvey Within;
  std::int64_t All = 0;      ///< macrocells, also those that are not within
  std::int64_t Constant = 0; ///< macrocells beyond the limits that have one value only

  /// Counts the macrocells of a brick, as IsovalueSurvey::CountBrick does.
  void CountBrick(
    const Box& cells, const Index3& end, const std::byte* block, const ValueLimits& limits);
  void Add(const LimitedSurvey& other);
};

} // namespace bricks

#endif
