// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_BrickAccess_h
#define rt_BrickAccess_h

#include "DSMCore/base/Block.h"
#include "DSMCore/publish/BlockSegment.h"

namespace rt
{

/// How often a brick is acquired while a ray is in it (the paper's section 4.2).
enum class Consolidation
{
  PerSample, ///< the paper's Access1
  PerCell,   ///< Access8: for the corners of a cell
  PerBrick   ///< AccessMany, or better; what the product does
};

/// Told what a ray reads of a brick, which is held already. Acquires it again where it is not to be
/// held, to pay for that and to count it; such accesses are hits. Threads as the store's worker.
template <class Store, Consolidation Mode>
class BrickAccess
{
public:
  BrickAccess(
    Store& store, typename Store::Worker& worker, const dsm::BlockSegment& segment, dsm::BlockId id)
    : Blocks(store)
    , Self(worker)
    , Segment(segment)
    , Id(id)
  {
  }

  /// The range of a macrocell.
  void ReadRange() const
  {
    if constexpr (Mode != Consolidation::PerBrick)
    {
      this->Acquire();
    }
  }

  /// The eight corners of a cell.
  void ReadCell() const
  {
    if constexpr (Mode != Consolidation::PerBrick)
    {
      for (int time = 0; time < (Mode == Consolidation::PerSample ? 8 : 1); ++time)
      {
        this->Acquire();
      }
    }
  }

private:
  void Acquire() const { (void)this->Blocks.Acquire(this->Self, this->Segment, this->Id); }

  Store& Blocks;
  typename Store::Worker& Self;
  const dsm::BlockSegment& Segment;
  dsm::BlockId Id;
};

} // namespace rt

#endif
