// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/schedule/CentralQueueScheduler.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace rt
{

namespace
{

struct TileRequest
{
  std::int32_t Count;
};

/// Places [First, First + Count) in the list of tiles; none: the frame has no further tiles.
struct TileGrant
{
  std::int32_t First;
  std::int32_t Count;
};

/// A grant is this part of a rank's fair share of what is left: large at first, so that messages are
/// few, and ever smaller, so that all ranks finish together (guided self-scheduling).
constexpr int SharesLeft = 4;

} // namespace

CentralQueueScheduler::CentralQueueScheduler(dsm::Messenger& messenger)
  : Messenger(messenger)
{
}

CentralQueueScheduler::~CentralQueueScheduler() = default;

void CentralQueueScheduler::Begin(const TilePlan& plan, int workers)
{
  this->Left = plan.Left;
  this->Tiles = static_cast<int>(this->Left.size());
  this->Workers = std::max(workers, 1);
  this->LowWater = this->Workers;
  this->Next = 0;
  this->Granted.clear();
  this->Exhausted = false;
  this->RequestUnderWay = false;
  if (this->IsSupervisor())
  {
    this->Messenger.SetHandler(dsm::MessageKind::TileRequest,
      [this](dsm::Message&& message) { this->Grant(std::move(message)); });
  }
  else
  {
    this->Messenger.SetHandler(dsm::MessageKind::TileGrant,
      [this](dsm::Message&& message) { this->Receive(std::move(message)); });
  }
}

void CentralQueueScheduler::End()
{
  this->Messenger.SetHandler(dsm::MessageKind::TileRequest, {});
  this->Messenger.SetHandler(dsm::MessageKind::TileGrant, {});
}

void CentralQueueScheduler::Cancel()
{
  this->Next = this->Tiles;
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Granted.clear();
    this->Exhausted = true;
  }
  this->Changed.notify_all();
}

void CentralQueueScheduler::Grant(dsm::Message&& request)
{
  const auto wanted = dsm::Decode<TileRequest>(request, dsm::MessageKind::TileRequest);
  const int left = std::max(this->Tiles - this->Next.load(), 0);
  const int share = left / (SharesLeft * this->Messenger.GetSize());
  const int count = std::max(share, std::clamp(wanted.Count, 1, this->Tiles));
  const int first = this->Next.fetch_add(count);
  // Towards the end of the frame the queue holds less than that, or nothing.
  const TileGrant grant{ first, std::clamp(this->Tiles - first, 0, count) };
  this->Messenger.Post(request.Source, dsm::MessageKind::TileGrant, dsm::Encode(grant));
}

void CentralQueueScheduler::Receive(dsm::Message&& message)
{
  const auto grant = dsm::Decode<TileGrant>(message, dsm::MessageKind::TileGrant);
  if (grant.Count < 0 ||
    (grant.Count > 0 && (grant.First < 0 || grant.First + grant.Count > this->Tiles)))
  {
    throw dsm::Error(
      "Rank 0 assigned tiles that the frame does not have. Do all ranks run the same build?");
  }
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    // After a Cancel the tiles are dropped: the frame has failed anyway.
    for (int place = grant.First; !this->Exhausted && place < grant.First + grant.Count; ++place)
    {
      this->Granted.push_back(this->Left[static_cast<std::size_t>(place)]);
    }
    this->Exhausted = this->Exhausted || grant.Count == 0;
    this->LowWater = std::max(this->Workers, grant.Count / 2);
  }
  this->RequestUnderWay = false;
  this->Changed.notify_all();
}

bool CentralQueueScheduler::Service()
{
  if (this->IsSupervisor() || this->RequestUnderWay)
  {
    return false;
  }
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    if (this->Exhausted || static_cast<int>(this->Granted.size()) >= this->LowWater)
    {
      return false;
    }
  }
  this->RequestUnderWay = true;
  this->Messenger.Post(0, dsm::MessageKind::TileRequest, dsm::Encode(TileRequest{ this->Workers }));
  return true;
}

std::optional<int> CentralQueueScheduler::GetTile(int place) const
{
  return place < this->Tiles ? std::optional<int>(this->Left[static_cast<std::size_t>(place)])
                             : std::nullopt;
}

std::optional<int> CentralQueueScheduler::Pop(dsm::WorkerSlots& slots)
{
  if (this->IsSupervisor())
  {
    return this->GetTile(this->Next.fetch_add(1));
  }
  std::unique_lock<std::mutex> lock(this->Mutex);
  const auto isSettled = [this] { return this->Exhausted || !this->Granted.empty(); };
  while (!isSettled())
  {
    dsm::WaitWithoutSlot(&slots, lock, this->Changed, isSettled);
  }
  if (this->Granted.empty())
  {
    return std::nullopt;
  }
  const int tile = this->Granted.front();
  this->Granted.pop_front();
  const bool low = static_cast<int>(this->Granted.size()) < this->LowWater;
  lock.unlock();
  if (low)
  {
    this->Messenger.WakeUp();
  }
  return tile;
}

std::optional<int> CentralQueueScheduler::Peek(int ahead)
{
  if (this->IsSupervisor())
  {
    return this->GetTile(this->Next.load() + ahead);
  }
  const std::lock_guard<std::mutex> lock(this->Mutex);
  const auto index = static_cast<std::size_t>(ahead);
  return index < this->Granted.size() ? std::optional<int>(this->Granted[index]) : std::nullopt;
}

} // namespace rt
