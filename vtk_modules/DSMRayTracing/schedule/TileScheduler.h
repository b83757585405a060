// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TileScheduler_h
#define rt_TileScheduler_h

#include "DSMCore/base/WorkerSlots.h"

#include <optional>
#include <vector>

namespace rt
{

/// How tiles come to ranks.
enum class TileScheduling
{
  CentralQueue, ///< see CentralQueueScheduler
  WorkStealing  ///< see WorkStealingScheduler
};

/// The tiles of a frame, and what is known of the frame before. The same on every rank, but for
/// Mine.
struct TilePlan
{
  int Tiles = 0;   ///< numbered 0 .. Tiles - 1, row by row
  int Columns = 1; ///< tiles in a row
  /// Tiles to trace, ascending; not empty. The others have been traced already.
  std::vector<int> Left;
  /// The last frame had the same tiles, and Mine are those of Left that this rank traced; each was traced by
  /// one rank.
  bool HasHistory = false;
  std::vector<int> Mine;
  /// The ranks that finished the last frame last and first; -1 where that is not known.
  int Slowest = -1;
  int Fastest = -1;
};

/// Decides which rank, and which worker of it, traces which tile of a frame. Every tile that is left of the frame
/// is given out exactly once over all ranks. The workers of a rank share its tiles.
class TileScheduler
{
public:
  virtual ~TileScheduler() = default;

  /// Communication thread, before the frame's session begins; `workers` workers of this rank will
  /// ask for tiles.
  virtual void Begin(const TilePlan& plan, int workers) = 0;

  /// Communication thread, often during the frame; returns whether it did anything.
  virtual bool Service() = 0;

  /// Communication thread, after all ranks have finished the frame.
  virtual void End() = 0;

  /// Any thread: this rank, and where this rank gives tiles to others also they, get no more tiles.
  virtual void Cancel() = 0;

  /// Worker, which has one of the slots: the next tile to trace; waits for an answer from other ranks
  /// where that is needed, without the slot. Empty when the frame has no tile left for this rank.
  virtual std::optional<int> Pop(dsm::WorkerSlots& slots) = 0;

  /// Worker: the tile that Pop will give after `ahead` others, as far as is known here now; another rank
  /// may get it yet. Does not wait.
  virtual std::optional<int> Peek(int ahead) = 0;
};

} // namespace rt

#endif
