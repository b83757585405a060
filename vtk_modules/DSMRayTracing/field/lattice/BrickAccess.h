// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_BrickAccess_h
#define rt_BrickAccess_h

#include "DSMCore/base/Block.h"
#include "DSMCore/publish/BlockSegment.h"

namespace rt
{

/// Notified of what a ray reads of a brick. Does nothing: the brick is held for as long as the ray is in it.
/// Measurements of what that saves put another class in its place.
template <class Store>
class BrickAccess
{
public:
  BrickAccess(Store&, typename Store::Worker&, const dsm::BlockSegment&, dsm::BlockId) {}

  /// The range of a macrocell.
  void ReadRange() const {}
  /// The eight corners of a cell.
  void ReadCell() const {}
};

} // namespace rt

#endif
