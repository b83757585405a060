// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MovingDetail_h
#define rt_MovingDetail_h

#include "DSMCore/store/BlockStore.h"

#include <chrono>
#include <vector>

namespace rt
{

/// Chooses the level of detail of pictures while the camera moves, if data in files have coarser ones. The finest
/// level is tried first, and given up when it waits for bricks for longer than a moving camera allows. Bricks that
/// it has read until then stay in memory, so a later try gets through. The level that got through the last time
/// takes its place; if that one had all of its bricks, the next finer one is tried every other time. Local, but all
/// ranks choose the same, because they use only numbers that they have agreed on.
class MovingDetail
{
public:
  /// Levels to try, one after the other, of so many below the finest (0). Only the last is traced whatever it takes.
  std::vector<int> GetTries(int coarser) const;

  /// A try begins.
  void Begin();
  /// Rank 0, while it is traced: whether to give it up. Cheap to ask again and again.
  bool IsTooLong(dsm::BlockStore& store);

  /// Records the result of a try: the level that was shown, the number of brick misses, and the
  /// time in seconds; the same on every rank.
  void Note(int level, std::int64_t misses, double seconds);

private:
  using Clock = std::chrono::steady_clock;

  int Level = 1;        ///< below the finest, that got through
  bool MayRise = false; ///< it waited for nothing
  bool IsOdd = false;   ///< every other picture that is not of the finest
  double Seconds = 0.0; ///< that a picture takes that waits for nothing
  Clock::time_point Start;
  Clock::time_point NextLook;
};

} // namespace rt

#endif
