// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TileSource_h
#define rt_TileSource_h

#include "DSMRayTracing/frame/Frame.h"
#include "DSMRayTracing/frame/TileGrid.h"
#include "DSMRayTracing/schedule/TileScheduler.h"

#include <atomic>
#include <optional>
#include <utility>
#include <vector>

namespace rt
{

/// Where the workers of a rank get the tiles of one frame from. Threads as in TileScheduler.
class TileSource
{
public:
  virtual ~TileSource() = default;
  /// `plan`: with what is known of the last frame; the tiles are the source's own.
  virtual void Begin(TilePlan plan, int workers) = 0;
  virtual bool Service() = 0;
  virtual void End() = 0;
  virtual void Cancel() = 0;
  virtual std::optional<Tile> Pop(dsm::WorkerSlots& slots) = 0;
};

/// New tiles, dealt out between the ranks.
class NewTiles : public TileSource
{
public:
  NewTiles(const TileGrid& grid, TileScheduler& scheduler)
    : Grid(grid)
    , Scheduler(scheduler)
  {
  }

  void Begin(TilePlan plan, int workers) override
  {
    plan.Tiles = this->Grid.GetCount();
    plan.Columns = this->Grid.GetColumns();
    this->Scheduler.Begin(plan, workers);
  }
  bool Service() override { return this->Scheduler.Service(); }
  void End() override { this->Scheduler.End(); }
  void Cancel() override { this->Scheduler.Cancel(); }
  std::optional<Tile> Pop(dsm::WorkerSlots& slots) override
  {
    const std::optional<int> number = this->Scheduler.Pop(slots);
    return number ? std::optional<Tile>(this->Grid.CreateTile(*number)) : std::nullopt;
  }

private:
  const TileGrid Grid;
  TileScheduler& Scheduler;
};

/// The tiles that a rank has traced already, with their sums: further samples of them cost about
/// what the first ones did, so the balance that was found for those holds.
class KeptTiles : public TileSource
{
public:
  explicit KeptTiles(std::vector<Tile> tiles)
    : Tiles(std::move(tiles))
  {
  }

  void Begin(TilePlan, int) override {}
  bool Service() override { return false; }
  void End() override {}
  void Cancel() override { this->Next = this->Tiles.size(); }
  std::optional<Tile> Pop(dsm::WorkerSlots&) override
  {
    const std::size_t index = this->Next.fetch_add(1);
    return index < this->Tiles.size() ? std::optional<Tile>(std::move(this->Tiles[index]))
                                      : std::nullopt;
  }

private:
  std::vector<Tile> Tiles;
  std::atomic<std::size_t> Next{ 0 };
};

} // namespace rt

#endif
