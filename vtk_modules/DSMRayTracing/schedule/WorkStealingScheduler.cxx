// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/schedule/WorkStealingScheduler.h"

#include <algorithm>
#include <string>
#include <utility>

namespace rt
{

namespace
{

/// A rank asks no more than so many others in a frame, so that the messages at a frame's end grow with
/// the ranks, not with their square.
constexpr std::size_t MostVictims = 16;

/// The slowest gives away one tile in so many of its own.
constexpr std::size_t GiftPart = 64;

/// One zero bit between each of the bits of a number below 2^16.
std::uint32_t Spread(std::uint32_t x)
{
  x = (x | x << 8) & 0x00ff00ffu;
  x = (x | x << 4) & 0x0f0f0f0fu;
  x = (x | x << 2) & 0x33333333u;
  return (x | x << 1) & 0x55555555u;
}

/// Neighbors on the curve are near one another.
void SortAlongCurve(std::vector<int>& tiles, int columns)
{
  const auto place = [=](int tile)
  {
    return Spread(static_cast<std::uint32_t>(tile % columns)) |
      Spread(static_cast<std::uint32_t>(tile / columns)) << 1;
  };
  std::sort(tiles.begin(), tiles.end(), [&](int a, int b) { return place(a) < place(b); });
}

std::vector<std::byte> Pack(const std::vector<std::int32_t>& tiles)
{
  std::vector<std::byte> bytes;
  for (const std::int32_t tile : tiles)
  {
    dsm::AttachTail(bytes, tile);
  }
  return bytes;
}

} // namespace

WorkStealingScheduler::WorkStealingScheduler(dsm::Messenger& messenger)
  : Messenger(messenger)
  , Random(static_cast<std::mt19937::result_type>(messenger.GetRank()))
{
}

WorkStealingScheduler::~WorkStealingScheduler() = default;

std::vector<int> WorkStealingScheduler::CutInitially(const TilePlan& plan, int rank, int ranks)
{
  std::vector<int> tiles = plan.Left;
  SortAlongCurve(tiles, plan.Columns);
  const auto border = [&](int of)
  {
    return tiles.begin() +
      static_cast<std::ptrdiff_t>(
        tiles.size() * static_cast<std::size_t>(of) / static_cast<std::size_t>(ranks));
  };
  return { border(rank), border(rank + 1) };
}

void WorkStealingScheduler::Begin(const TilePlan& plan, int)
{
  const int rank = this->Messenger.GetRank();
  const int ranks = this->Messenger.GetSize();
  this->Tiles = plan.Tiles;
  std::vector<int> own = plan.HasHistory ? plan.Mine : CutInitially(plan, rank, ranks);
  SortAlongCurve(own, plan.Columns);
  // To and fro: a frame begins where the one before ended, whose bricks are still in the cache.
  this->Backward = plan.HasHistory && !this->Backward;
  if (this->Backward)
  {
    std::reverse(own.begin(), own.end());
  }
  this->Own.assign(own.begin(), own.end());
  this->Cancelled = false;
  this->RequestUnderWay = false;
  this->AwaitsGift = plan.Slowest >= 0 && rank == plan.Fastest;

  this->Victims.clear();
  for (int other = 0; other < ranks; ++other)
  {
    if (other != rank)
    {
      this->Victims.push_back(other);
    }
  }
  std::shuffle(this->Victims.begin(), this->Victims.end(), this->Random);
  this->Victims.resize(std::min(this->Victims.size(), MostVictims));
  this->Exhausted = this->Victims.empty() && !this->AwaitsGift;

  this->Messenger.SetHandler(dsm::MessageKind::StealRequest,
    [this](dsm::Message&& message) { this->Give(std::move(message)); });
  this->Messenger.SetHandler(dsm::MessageKind::StolenTiles,
    [this](dsm::Message&& message) { this->Receive(std::move(message)); });
  this->Messenger.SetHandler(dsm::MessageKind::GivenTiles,
    [this](dsm::Message&& message) { this->Receive(std::move(message)); });
  this->GiftReceiver = -1;
  if (rank == plan.Slowest)
  {
    this->Gift = this->TakeFromEnd(this->Own.size() / GiftPart + 1);
    this->GiftReceiver = plan.Fastest;
  }
}

void WorkStealingScheduler::End()
{
  this->Messenger.SetHandler(dsm::MessageKind::StealRequest, {});
  this->Messenger.SetHandler(dsm::MessageKind::StolenTiles, {});
  this->Messenger.SetHandler(dsm::MessageKind::GivenTiles, {});
}

void WorkStealingScheduler::Cancel()
{
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Own.clear();
    this->Exhausted = true;
    this->Cancelled = true;
  }
  this->Changed.notify_all();
}

std::vector<std::int32_t> WorkStealingScheduler::TakeFromEnd(std::size_t count)
{
  const auto first =
    this->Own.end() - static_cast<std::ptrdiff_t>(std::min(count, this->Own.size()));
  std::vector<std::int32_t> tiles(first, this->Own.end());
  this->Own.erase(first, this->Own.end());
  return tiles;
}

void WorkStealingScheduler::EndIfNothingComes()
{
  this->Exhausted =
    this->Exhausted || (this->Victims.empty() && !this->RequestUnderWay && !this->AwaitsGift);
}

void WorkStealingScheduler::Give(dsm::Message&& request)
{
  if (request.Session != this->Messenger.GetSession())
  {
    return; // the message belongs to a frame that failed
  }
  std::vector<std::int32_t> tiles;
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    tiles = this->TakeFromEnd(this->Own.size() / 2);
  }
  this->Messenger.Post(request.Source, dsm::MessageKind::StolenTiles, Pack(tiles));
}

void WorkStealingScheduler::Receive(dsm::Message&& message)
{
  if (message.Session != this->Messenger.GetSession())
  {
    return;
  }
  const bool isGift = message.Kind == dsm::MessageKind::GivenTiles;
  const auto tiles = message.Payload.empty()
    ? std::vector<std::int32_t>()
    : dsm::DecodeSeveral<std::int32_t>(message, message.Kind);
  for (const std::int32_t tile : tiles)
  {
    if (tile < 0 || tile >= this->Tiles)
    {
      throw dsm::Error("Rank " + std::to_string(message.Source) + " transferred tile " +
        std::to_string(tile) + ", which the frame does not have. Do all ranks run the same build?");
    }
  }
  if (isGift)
  {
    this->AwaitsGift = false;
  }
  else
  {
    this->RequestUnderWay = false;
    if (tiles.empty() && !this->Victims.empty())
    {
      this->Victims.pop_back();
    }
  }
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    if (!this->Cancelled)
    {
      this->Own.insert(this->Own.end(), tiles.begin(), tiles.end());
    }
    this->EndIfNothingComes();
  }
  this->Changed.notify_all();
}

bool WorkStealingScheduler::Service()
{
  if (this->GiftReceiver >= 0)
  {
    this->Messenger.Post(
      std::exchange(this->GiftReceiver, -1), dsm::MessageKind::GivenTiles, Pack(this->Gift));
    return true;
  }
  if (this->RequestUnderWay || this->Victims.empty())
  {
    return false;
  }
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    if (this->Exhausted || !this->Own.empty())
    {
      return false;
    }
  }
  this->RequestUnderWay = true;
  this->Messenger.Post(this->Victims.back(), dsm::MessageKind::StealRequest, {});
  return true;
}

std::optional<int> WorkStealingScheduler::Pop(dsm::WorkerSlots& slots)
{
  std::unique_lock<std::mutex> lock(this->Mutex);
  const auto isSettled = [this] { return this->Exhausted || !this->Own.empty(); };
  while (!isSettled())
  {
    this->Messenger.WakeUp();
    dsm::WaitWithoutSlot(&slots, lock, this->Changed, isSettled);
  }
  if (this->Own.empty())
  {
    return std::nullopt;
  }
  const int tile = this->Own.front();
  this->Own.pop_front();
  const bool last = this->Own.empty();
  lock.unlock();
  if (last)
  {
    this->Messenger.WakeUp(); // to steal while the last ones are traced
  }
  return tile;
}

std::optional<int> WorkStealingScheduler::Peek(int ahead)
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  const auto index = static_cast<std::size_t>(ahead);
  return index < this->Own.size() ? std::optional<int>(this->Own[index]) : std::nullopt;
}

} // namespace rt
