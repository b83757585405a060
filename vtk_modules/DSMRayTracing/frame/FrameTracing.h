// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_FrameTracing_h
#define rt_FrameTracing_h

#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/base/WorkerSlots.h"
#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/frame/BeamHistory.h"
#include "DSMRayTracing/frame/Frame.h"
#include "DSMRayTracing/frame/FrameRequest.h"
#include "DSMRayTracing/frame/KeptHits.h"
#include "DSMRayTracing/frame/PixelRays.h"
#include "DSMRayTracing/frame/ServedWork.h"
#include "DSMRayTracing/frame/TileSampler.h"
#include "DSMRayTracing/frame/TileSource.h"
#include "DSMRayTracing/frame/WorkerPool.h"
#include "DSMRayTracing/scene/Scene.h"
#include "DSMRayTracing/scene/SceneTracers.h"

#include <time.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace rt
{

/// The tracing of one frame's tiles on one rank, from the store's BeginFrame to its EndFrame.
template <class Store>
class FrameTracing final : private ServedWork<Store>
{
public:
  /// Data that all of the frame's ranks have in common, and this rank's resources. Kept by
  /// reference.
  struct Input
  {
    dsm::Messenger& Messenger;
    WorkerPool& Pool;
    dsm::WorkerSlots& Slots;
    const std::function<bool(double)>& Watch; ///< see FrameRenderer::SetWatch
    const rt::Scene& Scene;
    const FrameRequest& Request;
    const BeamHistory* Last; ///< history of the view's last frame; may be null
    KeptHits* Hits;          ///< null: none are known or kept
    TileSource& Tiles;
    /// For all ranks, when this one has traced its part; see FrameRenderer::Records.
    dsm::FunctionRef<std::vector<std::byte>(Frame&)> Report;
  };

  /// Collective; the store's BeginFrame is called before.
  FrameTracing(Store& store, const Input& input)
    : ServedWork<Store>(store, input.Messenger, input.Pool)
    , In(input)
    , Workers(store.GetSettings().Workers)
    , Share(input.Tiles.EstimateShare(input.Messenger.GetSize()))
  {
  }

  /// Traces tiles until all ranks have stopped, and ends the store's frame. Throws only when a rank is lost, and
  /// with it all that is collective. `makePlan` may fail.
  void Trace(dsm::FunctionRef<TilePlan()> makePlan)
  {
    this->Run(this->Workers, [&] { this->Prepare(makePlan); });
  }

  /// Moves this rank's tiles and figures to `frame`. Throws the same dsm::Error on every rank when
  /// one has failed. Collective.
  void GiveTo(Frame& frame)
  {
    this->Finish("Cannot trace the frame.");
    frame = std::move(this->Traced);
    frame.IsAborted = this->Agreement.IsAborted();
    frame.BusySeconds = this->BusySeconds;
    frame.Reports = this->Agreement.TakeReports();
  }

private:
  using Clock = std::chrono::steady_clock;

  /// Bricks are asked for so many tiles, for each worker, before the tile that will need them.
  static constexpr int LeadOfWorker = 4;

  /// Processor time of the calling thread: what a tile costs, not what it waits.
  static double GetThreadSeconds()
  {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  void Prepare(dsm::FunctionRef<TilePlan()> makePlan)
  {
    const FrameRequest& request = this->In.Request;
    this->Rays.emplace(request);
    if (this->Blocks.MayPrefetch())
    {
      this->Beams = std::make_shared<BeamHistory>(request.Width, request.Height,
        this->In.Scene.Objects.size() + this->In.Scene.Media.size(), this->In.Last);
    }
    this->Plan = makePlan();
    this->Mine = this->Plan.Mine;
    std::sort(this->Mine.begin(), this->Mine.end());
    this->TilesOfWorker.resize(static_cast<std::size_t>(this->Workers));
    this->In.Tiles.Begin(this->Plan, this->Workers);
  }

  /// Until there are no more tiles.
  void Work(int index) override
  {
    auto& worker = this->Blocks.GetWorker(index);
    const dsm::WorkerSlots::Hold slot(this->In.Slots);
    std::uint64_t misses = 0; // of the tiles before
    bool looksAhead = true;   // as long as bricks are absent
    const SceneTracers tracers = CreateSceneTracers(this->Blocks, worker, this->In.Scene);
    const TileSampler sampler(
      tracers, this->In.Scene, *this->Rays, this->In.Request, this->Beams.get(), this->In.Hits);
    while (std::optional<Tile> tile = this->In.Tiles.Pop(this->In.Slots))
    {
      const double start = GetThreadSeconds();
      this->Blocks.Enter(worker);
      if (this->Beams && looksAhead)
      {
        const std::optional<Tile> later = this->In.Tiles.Peek(LeadOfWorker * this->Workers);
        looksAhead = later && sampler.Prefetch(*later);
      }
      sampler.Trace(*tile);
      this->Blocks.Leave(worker);
      tile->Seconds = GetThreadSeconds() - start;
      const std::uint64_t before = std::exchange(misses, this->Blocks.GetMisses(worker));
      tile->Misses += misses - before;
      looksAhead = looksAhead || misses > before;
      tile->IsNew = tile->IsNew || this->IsNew(*tile);
      sampler.Finish(*tile, this->GetTint(*tile));
      this->TilesOfWorker[static_cast<std::size_t>(index)].push_back(std::move(*tile));
      ++this->TracedTiles;
      this->In.Slots.LetOthersResume();
    }
  }

  void FinishWorker() override
  {
    this->BusySeconds = std::chrono::duration<double>(Clock::now() - this->Start).count();
  }

  void Cancel() override { this->In.Tiles.Cancel(); }
  void End() override { this->In.Tiles.End(); }

  /// Returns whether another rank traced the tile in the last frame.
  bool IsNew(const Tile& tile) const
  {
    return this->Plan.HasHistory &&
      !std::binary_search(this->Mine.begin(), this->Mine.end(), tile.Index);
  }

  /// Returns the tint of a whole tile.
  glm::vec3 GetTint(const Tile& tile) const
  {
    switch (this->In.Scene.View)
    {
      case DebugView::TracingRank:
        return GetNumberColor(static_cast<std::uint64_t>(this->In.Messenger.GetRank()));
      case DebugView::TileTime:
        return GetHeatColor(std::min(tile.Seconds / LongTileSeconds, 1.0));
      case DebugView::NewTiles:
        return tile.IsNew ? GetNewTileColor() : glm::vec3(1.0f);
      case DebugView::Misses:
        return GetHeatColor(std::min(static_cast<double>(tile.Misses) / ManyMisses, 1.0));
      default:
        return glm::vec3(1.0f);
    }
  }

  /// Other ranks' requests for tiles, and the user's wish to end the frame.
  bool ServeMore() override
  {
    const bool didSomething = this->In.Tiles.Service();
    const bool isWatched = this->In.Watch && this->In.Messenger.GetRank() == 0;
    if (isWatched && !this->Agreement.IsAborted() && !this->Agreement.IsOver() &&
      this->In.Watch(this->GetPart()))
    {
      this->Agreement.Abort();
    }
    return didSomething;
  }

  /// About the part of the frame that is traced.
  double GetPart() const
  {
    return this->Share > 0.0 ? std::min(1.0, this->TracedTiles / this->Share) : 1.0;
  }

  std::vector<std::byte> Collect() override
  {
    std::vector<Tile>& tiles = this->Traced.Tiles;
    std::size_t count = this->In.Tiles.CountRest();
    for (const auto& some : this->TilesOfWorker)
    {
      count += some.size();
    }
    tiles.reserve(count);
    for (auto& some : this->TilesOfWorker)
    {
      std::move(some.begin(), some.end(), std::back_inserter(tiles));
      some.clear();
    }
    this->In.Tiles.TakeRest(tiles);
    this->Traced.Width = this->In.Request.Width;
    this->Traced.Height = this->In.Request.Height;
    this->Traced.TileSize = this->In.Request.TileSize;
    this->Traced.Channels = this->In.Request.Channels;
    this->Traced.Number = this->Number;
    this->Traced.Beams = this->Beams;
    return this->IsInVain() ? std::vector<std::byte>() : this->In.Report(this->Traced);
  }

  const Input In;
  const int Workers;
  const Clock::time_point Start = Clock::now();

  std::optional<PixelRays> Rays;
  std::shared_ptr<BeamHistory> Beams;
  TilePlan Plan;
  std::vector<int> Mine; ///< this rank's tiles in the plan, ascending

  std::vector<std::vector<Tile>> TilesOfWorker;
  std::atomic<int> TracedTiles{ 0 };
  std::atomic<double> BusySeconds{ 0.0 };
  const double Share; ///< tiles that this rank will trace, about
  Frame Traced;       ///< this rank's part
};

} // namespace rt

#endif
