// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TransferTest_h
#define rt_TransferTest_h

#include "DSMBricks/layout/MacrocellHierarchy.h"
#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/base/Lanes.h"
#include "DSMRayTracing/field/lattice/NodeOrder.h"
#include "DSMRayTracing/look/TransferFunction.h"

#include <cstddef>
#include <cstdint>

namespace rt
{

/// Tells of a range of values whether a medium may be seen there: what BeamDescent asks. Keeps a reference.
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

private:
  const TransferFunction& Function;
};

/// What TypedPacketBrick asks about a medium; see IsovalueTest. Keeps a reference.
template <class T>
class TransferTest
{
public:
  explicit TransferTest(const TransferFunction& function)
    : Function(function)
  {
  }

  std::uint64_t FindMacrocells(
    const bricks::MacrocellRange<T>* ranges, std::ptrdiff_t row, std::ptrdiff_t slice) const
  {
    std::uint64_t found = 0;
    for (int number = 0; number < 64; ++number)
    {
      const bricks::MacrocellRange<T>& range =
        ranges[number % 4 + number / 4 % 4 * row + number / 16 * slice];
      found |= std::uint64_t{ this->MayHold(range) } << number;
    }
    return found;
  }
  bool MayHold(const bricks::MacrocellRange<T>& range) const
  {
    return range.Min <= range.Max &&
      this->Function.IsSeen(static_cast<double>(range.Min), static_cast<double>(range.Max));
  }

  /// All cells of the macrocell: what is seen in them is found out when they are crossed.
  std::uint64_t FindCells(const bricks::VoxelBrick<T>&, const int*, const int counts[3]) const
  {
    return GetNodeBox(counts);
  }

  double GetSubtracted() const { return this->Function.GetFirst(); }
  Lanes::Half SubtractPair(const T* samples) const
  {
    return Lanes::Half{ static_cast<double>(samples[0]), static_cast<double>(samples[1]) } -
      this->Function.GetFirst();
  }

private:
  const TransferFunction& Function;
};

} // namespace rt

#endif
