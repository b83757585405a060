// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_ExtremumTest_h
#define rt_ExtremumTest_h

#include "DSMBricks/layout/MacrocellHierarchy.h"
#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/base/Lanes.h"
#include "DSMRayTracing/field/ValuePredicates.h"
#include "DSMRayTracing/field/lattice/NodeOrder.h"
#include "DSMRayTracing/field/lattice/PacketBrick.h"

#include <cstddef>
#include <cstdint>

namespace rt
{

/// Test of TypedPacketBrick for an extremum; see IsovalueTest.
template <class T>
class ExtremumTest
{
public:
  explicit ExtremumTest(const ExtremumPredicate& isOfUse)
    : IsOfUse(isOfUse)
  {
  }

  std::uint64_t FindMacrocells(
    const bricks::MacrocellRange<T>* ranges, std::ptrdiff_t row, std::ptrdiff_t slice) const
  {
    return FindEachMacrocell(ranges, row, slice,
      [this](const bricks::MacrocellRange<T>& range) { return this->MayHold(range); });
  }
  bool MayHold(const bricks::MacrocellRange<T>& range) const
  {
    return this->IsOfUse(static_cast<double>(range.Min), static_cast<double>(range.Max));
  }

  /// All cells of the macrocell: their corners are compared when they are crossed.
  std::uint64_t FindCells(const bricks::VoxelBrick<T>&, const int*, const int counts[3]) const
  {
    return GetNodeBox(counts);
  }

  double GetSubtracted() const { return 0.0; }
  Lanes::Half SubtractPair(const T* samples) const
  {
    return Lanes::Half{ static_cast<double>(samples[0]), static_cast<double>(samples[1]) };
  }

private:
  ExtremumPredicate IsOfUse;
};

} // namespace rt

#endif
