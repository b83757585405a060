// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_CentralQueueScheduler_h
#define rt_CentralQueueScheduler_h

#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/schedule/TileScheduler.h"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <vector>

namespace rt
{

/// The paper's central demand queue (section 4.4): rank 0 holds the tiles, and the other ranks ask
/// it for more. Where we deviate: a rank asks before it runs out, so that a worker seldom waits for
/// the answer, and gets several tiles at once as long as many are left.
class CentralQueueScheduler final : public TileScheduler
{
public:
  explicit CentralQueueScheduler(dsm::Messenger& messenger);
  ~CentralQueueScheduler() override;

  void Begin(const TilePlan& plan, int workers) override;
  bool Service() override;
  void End() override;
  void Cancel() override;
  std::optional<int> Pop(dsm::WorkerSlots& slots) override;
  std::optional<int> Peek(int ahead) override;

private:
  std::optional<int> GetTile(int place) const;
  void Grant(dsm::Message&& request);
  void Receive(dsm::Message&& grant);
  bool IsSupervisor() const { return this->Messenger.GetRank() == 0; }

  dsm::Messenger& Messenger;
  std::vector<int> Left; ///< tiles of the frame; ranks ask for places in this list
  int Tiles = 0;         ///< their number
  int Workers = 1;

  /// Supervisor: place of the next tile that no rank has. Its own workers take tiles from here without a message.
  std::atomic<int> Next{ 0 };

  /// Other ranks: what rank 0 gave and no worker took yet.
  std::mutex Mutex;
  std::condition_variable Changed;
  std::deque<int> Granted;
  /// With fewer than that the rank asks for more.
  int LowWater = 1;
  bool Exhausted = false;

  /// Communication thread only.
  bool RequestUnderWay = false;
};

} // namespace rt

#endif
