// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_WorkStealingScheduler_h
#define rt_WorkStealingScheduler_h

#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/schedule/TileScheduler.h"

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <random>
#include <vector>

namespace rt
{

/// The paper's distributed load balancing (section 4.4): a rank begins with the tiles that it traced
/// in the last frame, whose bricks it has; without a tile left it steals from other ranks in random
/// order; and the rank that was the slowest gives some away at the start. No rank sees all tiles, and
/// as long as all have work no message is sent. Where we deviate: the first frame is cut along a
/// space-filling curve; a victim gives half of what it has left, so that steals are few; the
/// slowest gives to the fastest, which every rank knows; and a rank goes through its tiles along the
/// curve, to and fro from frame to frame, so that it begins with bricks that it has just used.
class WorkStealingScheduler final : public TileScheduler
{
public:
  explicit WorkStealingScheduler(dsm::Messenger& messenger);
  ~WorkStealingScheduler() override;

  void Begin(const TilePlan& plan, int workers) override;
  bool Service() override;
  void End() override;
  void Cancel() override;
  std::optional<int> Pop(dsm::WorkerSlots& slots) override;
  std::optional<int> Peek(int ahead) override;

  /// The tiles that a rank begins with when nothing is known of a last frame: an equal part of a
  /// Z-order curve through all.
  static std::vector<int> CutInitially(const TilePlan& plan, int rank, int ranks);

private:
  void Give(dsm::Message&& request);
  void Receive(dsm::Message&& message);
  /// From the end, which this rank would come to last.
  std::vector<std::int32_t> TakeFromEnd(std::size_t count);
  /// Under the lock: no tile will come any more, unless one is under way.
  void EndIfNothingComes();

  dsm::Messenger& Messenger;
  int Tiles = 0;
  bool Backward = false;
  std::mt19937 Random;

  // Communication thread only.
  /// Whom to ask, the last one first; who answered that it has nothing is not asked again.
  std::vector<int> Victims;
  bool RequestUnderWay = false;
  bool AwaitsGift = false;
  /// Rank that gets the tiles when the frame has begun; negative: none.
  int GiftReceiver = -1;
  std::vector<std::int32_t> Gift;

  std::mutex Mutex;
  std::condition_variable Changed;
  std::deque<int> Own;
  /// Nothing will be added to Own any more.
  bool Exhausted = false;
  bool Cancelled = false;
};

} // namespace rt

#endif
