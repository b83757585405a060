// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_IsovalueSurvey_h
#define rt_IsovalueSurvey_h

#include "DSMCore/base/Block.h"
#include "DSMRayTracing/layout/BrickLattice.h"
#include "DSMRayTracing/layout/MacrocellHierarchy.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace rt
{

/// How many macrocells of a volume have which values, in intervals of a range: what FindFirstIsovalue
/// chooses by. Plain, so that it travels between ranks, and is kept. Any thread, one at a time.
struct IsovalueSurvey
{
  /// Intervals that the range of the values is divided into, and the borders between them, which are
  /// the isovalues to choose from.
  static constexpr int Intervals = 256;
  static constexpr int Borders = Intervals - 1;

  /// Counts the macrocells of a brick. `range`: the same for all bricks that are counted.
  void CountBrick(
    const BrickLattice& lattice, dsm::BlockId id, const std::byte* block, const ValueRange& range);
  void Add(const IsovalueSurvey& other);
  /// When all is counted: entries are numbers from then on, no more what changes there.
  void Accumulate();

  /// Whether it was made with this range.
  bool IsOf(const ValueRange& range) const
  {
    return this->Range.First == range.First && this->Range.Last == range.Last;
  }

  std::array<std::int64_t, Intervals + 1>
    Values{}; ///< their number, in units that many counts divide
  std::array<std::int64_t, Intervals + 1> Crossed{}; ///< a surface passes
  std::array<std::int64_t, Intervals + 1> CutOpen{}; ///< so it does, and the volume ends there
  std::int64_t All = 0;
  std::int64_t AtBorder = 0;
  ValueRange Range{ 1.0f, -1.0f };
};

} // namespace rt

#endif
