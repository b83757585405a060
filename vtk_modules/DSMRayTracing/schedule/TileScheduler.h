// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TileScheduler_h
#define rt_TileScheduler_h

#include "DSMCore/WorkerSlots.h"

#include <optional>

namespace rt
{

/// Decides which rank, and which worker of it, traces which tile of a frame. Every tile of the frame
/// is given out exactly once over all ranks.
class TileScheduler
{
public:
  virtual ~TileScheduler() = default;

  /// Communication thread, before the frame's session begins: the frame has tiles 0 .. tiles - 1,
  /// and `workers` workers of this rank will ask for them.
  virtual void Begin(int tiles, int workers) = 0;

  /// Communication thread, often during the frame; returns whether it did anything.
  virtual bool Service() = 0;

  /// Communication thread, after all ranks have finished the frame.
  virtual void End() = 0;

  /// Any thread: this rank, and where this rank gives tiles to others also they, get no more tiles.
  virtual void Cancel() = 0;

  /// Worker, which has one of the slots: the next tile to trace; waits for an answer from other ranks
  /// where that is needed, without the slot. Empty when the frame has no tile left for this rank.
  virtual std::optional<int> Pop(dsm::WorkerSlots& slots) = 0;
};

} // namespace rt

#endif
