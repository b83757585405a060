// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TileSource_h
#define rt_TileSource_h

#include "DSMRayTracing/frame/Frame.h"
#include "DSMRayTracing/frame/TileGrid.h"
#include "DSMRayTracing/schedule/TileScheduler.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

namespace rt
{

/// Source of the tiles of one frame for the workers of a rank. Threads as in TileScheduler.
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
  /// As TileScheduler; without pixels.
  virtual std::optional<Tile> Peek(int ahead) = 0;
  /// About how many tiles this one of so many ranks will trace.
  virtual double EstimateShare(int ranks) const = 0;
  /// After the workers have stopped: how many tiles with pixels were not given out; adds them to `tiles`,
  /// which has room for them.
  virtual std::size_t CountRest() const = 0;
  virtual void TakeRest(std::vector<Tile>& tiles) = 0;
};

/// New tiles, dealt out between the ranks: those that are left of a frame.
class NewTiles : public TileSource
{
public:
  /// `left`: ascending, the same on every rank. `traced`: this rank's other tiles.
  NewTiles(
    const TileGrid& grid, TileScheduler& scheduler, std::vector<int> left, std::vector<Tile> traced)
    : Grid(grid)
    , Scheduler(scheduler)
    , Left(std::move(left))
    , Traced(std::move(traced))
  {
  }

  void Begin(TilePlan plan, int workers) override
  {
    plan.Tiles = this->Grid.GetCount();
    plan.Columns = this->Grid.GetColumns();
    plan.Left = this->Left;
    const auto isTraced = [this](int tile)
    { return !std::binary_search(this->Left.begin(), this->Left.end(), tile); };
    plan.Mine.erase(std::remove_if(plan.Mine.begin(), plan.Mine.end(), isTraced), plan.Mine.end());
    if (!this->Left.empty())
    {
      this->Scheduler.Begin(plan, workers);
    }
  }
  bool Service() override { return !this->Left.empty() && this->Scheduler.Service(); }
  void End() override
  {
    if (!this->Left.empty())
    {
      this->Scheduler.End();
    }
  }
  void Cancel() override { this->Scheduler.Cancel(); }
  std::optional<Tile> Pop(dsm::WorkerSlots& slots) override
  {
    return this->Create(this->Left.empty() ? std::nullopt : this->Scheduler.Pop(slots));
  }
  std::optional<Tile> Peek(int ahead) override
  {
    return this->Create(this->Left.empty() ? std::nullopt : this->Scheduler.Peek(ahead));
  }
  double EstimateShare(int ranks) const override
  {
    return static_cast<double>(this->Left.size()) / ranks;
  }

  std::size_t CountRest() const override { return this->Traced.size(); }
  void TakeRest(std::vector<Tile>& tiles) override
  {
    std::move(this->Traced.begin(), this->Traced.end(), std::back_inserter(tiles));
    this->Traced.clear();
  }

private:
  std::optional<Tile> Create(std::optional<int> number) const
  {
    return number ? std::optional<Tile>(this->Grid.CreateTile(*number)) : std::nullopt;
  }

  const TileGrid Grid;
  TileScheduler& Scheduler;
  const std::vector<int> Left;
  std::vector<Tile> Traced;
};

/// The tiles that a rank has traced already, with their sums: further samples of them cost about
/// what the first ones did, so the balance that was found for those holds. Tiles that have `samples`
/// samples, because such a frame was aborted before, are not given out.
class KeptTiles : public TileSource
{
public:
  KeptTiles(std::vector<Tile> tiles, int samples)
    : Tiles(std::move(tiles))
    , Samples(samples)
  {
  }

  void Begin(TilePlan, int) override {}
  bool Service() override { return false; }
  void End() override {}
  void Cancel() override { this->Next = this->Tiles.size(); }
  std::optional<Tile> Pop(dsm::WorkerSlots&) override
  {
    for (;;)
    {
      const std::size_t index = this->Next.fetch_add(1);
      if (index >= this->Tiles.size())
      {
        return std::nullopt;
      }
      Tile& tile = this->Tiles[index];
      if (tile.Samples < this->Samples)
      {
        std::optional<Tile> given = std::move(tile);
        tile.Index = Given;
        return given;
      }
    }
  }

  /// Nothing: the bricks of a still picture are where they were.
  std::optional<Tile> Peek(int) override { return std::nullopt; }
  double EstimateShare(int) const override { return static_cast<double>(this->Tiles.size()); }

  std::size_t CountRest() const override
  {
    return static_cast<std::size_t>(
      std::count_if(this->Tiles.begin(), this->Tiles.end(), &KeptTiles::IsLeft));
  }
  void TakeRest(std::vector<Tile>& tiles) override
  {
    std::copy_if(std::make_move_iterator(this->Tiles.begin()),
      std::make_move_iterator(this->Tiles.end()), std::back_inserter(tiles), &KeptTiles::IsLeft);
    this->Tiles.clear();
  }

private:
  static constexpr int Given = -1;
  static bool IsLeft(const Tile& tile) { return tile.Index != Given; }

  std::vector<Tile> Tiles;
  int Samples;
  std::atomic<std::size_t> Next{ 0 };
};

} // namespace rt

#endif
