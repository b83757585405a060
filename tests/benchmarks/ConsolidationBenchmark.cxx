// SPDX-License-Identifier: BSD-3-Clause
#include "ConsolidationBenchmark.h"

#include "AccessFrame.h"
#include "BenchmarkCamera.h"
#include "BenchmarkVolume.h"
#include "RepeatedAccess.h"

#include "DSMRayTracing/field/lattice/IsosurfaceSearch.h"
#include "DSMRayTracing/frame/PixelRays.h"
#include "DSMRayTracing/frame/TileGrid.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <iomanip>
#include <iostream>
#include <sstream>

namespace
{

using Json = nlohmann::ordered_json;

/// What one rank counted in one pattern's frames.
struct Counts
{
  std::uint64_t Accesses = 0;
  std::uint64_t Misses = 0;
  std::uint64_t Hits = 0; ///< pixels that show a surface
};

/// Traces this rank's tiles of a frame; collective.
template <template <class> class Access, class Store>
void TraceFrame(dsm::Messenger& messenger, Store& store, rt::WorkerPool& pool,
  const rt::LatticeIsosurface& object, const rt::FrameRequest& request, Counts& counts)
{
  const rt::PixelRays rays(request);
  const rt::TileGrid grid(request.Width, request.Height, request.TileSize);
  std::atomic<int> next{ messenger.GetRank() };
  std::atomic<std::uint64_t> covered{ 0 };
  AccessTiming::RunFrame<Store>(messenger, store, pool, store.GetSettings().Workers,
    [&](typename Store::Worker& worker, int)
    {
      const rt::IsosurfaceSearch<Store, Access> tracer(store, worker);
      std::uint64_t hits = 0;
      for (int index; (index = next.fetch_add(messenger.GetSize())) < grid.GetCount();)
      {
        const rt::Tile tile = grid.CreateTile(index);
        for (int y = tile.Y; y < tile.Y + tile.Height; ++y)
        {
          for (int x = tile.X; x < tile.X + tile.Width; ++x)
          {
            rt::LatticeHit hit;
            hits += tracer.Intersect(object, rays.GetRay(x, y), hit) ? 1 : 0;
          }
        }
        store.Quiesce(worker);
      }
      covered += hits;
    });
  const dsm::WorkerCounters workers = store.GetCounters().Workers;
  counts.Accesses += workers.Accesses;
  counts.Misses += workers.Misses;
  counts.Hits += covered;
}

template <class Store>
void TraceFrame(const std::string& pattern, dsm::Messenger& messenger, Store& store,
  rt::WorkerPool& pool, const rt::LatticeIsosurface& object, const rt::FrameRequest& request,
  Counts& counts)
{
  if (pattern == "one")
  {
    TraceFrame<AccessPerSample>(messenger, store, pool, object, request, counts);
  }
  else if (pattern == "eight")
  {
    TraceFrame<AccessPerCell>(messenger, store, pool, object, request, counts);
  }
  else
  {
    TraceFrame<rt::BrickAccess>(messenger, store, pool, object, request, counts);
  }
}

} // namespace

void ConsolidationBenchmark::Options::AddTo(CLI::App& app)
{
  this->Overlap = 1;
  this->BenchmarkOptions::AddTo(app);
  app
    .add_option(
      "--access", this->Patterns, "how often a brick is acquired, with commas (default all)")
    ->delimiter(',')
    ->allow_extra_args(false)
    ->check(CLI::IsMember({ "one", "eight", "many" }));
}

void ConsolidationBenchmark::Run(const Options& options, dsm::Messenger& messenger)
{
  dsm::BlockStore::Settings settings = options.CreateSettings(messenger);
  dsm::BlockStore store(messenger, settings);
  rt::LatticeIsosurface object =
    PublishBenchmarkVolume(options.Volume, options.BrickEdge, settings.Workers, store, messenger);
  object.Isovalues = options.Isovalues;
  std::sort(object.Isovalues.begin(), object.Isovalues.end());
  settings.CacheBytes = static_cast<std::size_t>(
    options.CacheFraction * object.Field.Voxels->Segment->GetDirectory().GetTotalBytes());
  store.SetSettings(settings);
  if (!store.IsSettled())
  {
    store.Settle();
  }

  const std::vector<Position> positions = GetPositions(options);
  rt::WorkerPool pool;
  Json rows = Json::array();
  std::ostringstream table;
  table << "pattern   accesses/worker/frame   misses/worker/frame   frames/s\n";
  for (const std::string& pattern : options.Patterns)
  {
    double best = std::numeric_limits<double>::infinity();
    Counts mine;
    for (int repetition = 0; repetition < options.Repeat; ++repetition)
    {
      mine = {};
      const auto start = std::chrono::steady_clock::now();
      for (const Position& position : positions)
      {
        rt::FrameRequest request;
        request.Width = options.Width;
        request.Height = options.Height;
        request.WorldToClip =
          GetCamera(object, static_cast<double>(options.Width) / options.Height, position)
            .WorldToClip;
        store.Visit([&](auto& blocks)
          { TraceFrame(pattern, messenger, blocks, pool, object, request, mine); });
      }
      best = std::min(
        best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    Counts total;
    for (const Counts& counts : messenger.AllGatherValue(mine))
    {
      total.Accesses += counts.Accesses;
      total.Misses += counts.Misses;
      total.Hits += counts.Hits;
    }
    const double frames = static_cast<double>(positions.size());
    const double parts = frames * settings.Workers * messenger.GetSize();
    const double accesses = static_cast<double>(total.Accesses) / parts;
    const double misses = static_cast<double>(total.Misses) / parts;
    rows.push_back({ { "access", pattern }, { "accesses_per_worker_frame", accesses },
      { "misses_per_worker_frame", misses }, { "frames_per_second", frames / best },
      { "covered_pixels", total.Hits } });
    table << std::left << std::setw(10) << pattern << std::right << std::fixed
          << std::setprecision(1) << std::setw(21) << accesses << std::setw(22) << misses
          << std::setprecision(3) << std::setw(11) << frames / best << '\n';
  }
  if (messenger.GetRank() != 0)
  {
    return;
  }
  const Json result = { { "volume", options.Volume }, { "isovalues", options.Isovalues },
    { "store", dsm::GetText(store.GetOrganization()) }, { "ranks", messenger.GetSize() },
    { "threads", settings.Workers }, { "cache_fraction", options.CacheFraction },
    { "patterns", rows } };
  RunOptions::Write(options.Json, result.dump(2), table.str());
}
