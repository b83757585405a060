// SPDX-License-Identifier: BSD-3-Clause
#ifndef RepeatedAccess_h
#define RepeatedAccess_h

#include "DSMCore/base/Block.h"
#include "DSMCore/publish/BlockSegment.h"

/// In place of rt::BrickAccess: acquires the brick again for every range that is read, and as often as
/// PerCell for the corners of a cell, to pay for that and to count it; such accesses are hits. Threads as
/// the store's worker.
template <class Store, int PerCell>
class RepeatedAccess
{
public:
  RepeatedAccess(
    Store& store, typename Store::Worker& worker, const dsm::BlockSegment& segment, dsm::BlockId id)
    : Blocks(store)
    , Self(worker)
    , Segment(segment)
    , Id(id)
  {
  }

  void ReadRange() const { this->Acquire(); }
  void ReadCell() const
  {
    for (int time = 0; time < PerCell; ++time)
    {
      this->Acquire();
    }
  }

private:
  void Acquire() const { (void)this->Blocks.Acquire(this->Self, this->Segment, this->Id); }

  Store& Blocks;
  typename Store::Worker& Self;
  const dsm::BlockSegment& Segment;
  dsm::BlockId Id;
};

/// The paper's Access1 and Access8 (section 4.2); rt::BrickAccess is AccessMany, or better.
template <class Store>
using AccessPerSample = RepeatedAccess<Store, 8>;
template <class Store>
using AccessPerCell = RepeatedAccess<Store, 1>;

#endif
