// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/FrameRenderer.h"

#include "DSMRayTracing/frame/FrameAgreement.h"
#include "DSMRayTracing/frame/PixelRays.h"
#include "DSMRayTracing/frame/TileGrid.h"
#include "DSMRayTracing/frame/TileSource.h"
#include "DSMRayTracing/frame/TileTracer.h"

#include <time.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <iterator>
#include <mutex>
#include <string>
#include <utility>

namespace rt
{

namespace
{

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Processor time of the calling thread: what a tile costs, not what it waits.
double GetThreadSeconds()
{
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// What a whole tile is tinted with.
glm::vec3 GetTint(DebugView view, int rank, double seconds)
{
  switch (view)
  {
    case DebugView::TracingRank:
      return GetNumberColor(static_cast<std::uint64_t>(rank));
    case DebugView::TileTime:
      return GetHeatColor(std::min(seconds / LongTileSeconds, 1.0));
    default:
      return glm::vec3(1.0f);
  }
}

/// The first failure among a rank's workers and its communication thread.
class FirstFailure
{
public:
  void Set(const std::string& cause)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    if (this->Cause.empty())
    {
      this->Cause = cause.empty() ? "unknown failure" : cause;
    }
  }
  std::string Get() const
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    return this->Cause;
  }

private:
  mutable std::mutex Mutex;
  std::string Cause;
};

/// Everything that must be equal on all ranks for a frame to make sense.
struct RequestDigest
{
  std::int64_t Width;
  std::int64_t Height;
  std::int64_t FirstSample;
  std::int64_t Samples;
  std::int64_t Objects;
  double WorldToClip[16];
};

/// What a rank brings to the frame.
struct Entry
{
  RequestDigest Request;
  std::uint64_t Settled; ///< whether its store is
};

RequestDigest GetDigest(const FrameRequest& request, const Scene& scene)
{
  RequestDigest digest{ request.Width, request.Height, request.FirstSample, request.Samples,
    static_cast<std::int64_t>(scene.Isosurfaces.size() + scene.Meshes.size()), {} };
  for (int element = 0; element < 16; ++element)
  {
    digest.WorldToClip[element] = request.WorldToClip[element / 4][element % 4];
  }
  return digest;
}

/// Returns whether every rank's store is settled.
bool CheckRequest(
  dsm::Messenger& messenger, const FrameRequest& request, const Scene& scene, bool settled)
{
  const auto entries = messenger.AllGatherValue(Entry{ GetDigest(request, scene), settled });
  for (std::size_t rank = 0; rank < entries.size(); ++rank)
  {
    if (std::memcmp(&entries[rank].Request, &entries.front().Request, sizeof(RequestDigest)) != 0)
    {
      throw dsm::Error("Rank " + std::to_string(rank) +
        " was asked to draw another picture than rank 0 (camera, size or objects differ); the "
        "frame was left out.");
    }
  }
  // All ranks have the same request now, so all throw or none.
  if (request.Width < 1 || request.Height < 1 || request.TileSize < 1)
  {
    throw dsm::Error("A frame of " + std::to_string(request.Width) + " x " +
      std::to_string(request.Height) + " pixels cannot be traced.");
  }
  return std::all_of(
    entries.begin(), entries.end(), [](const Entry& entry) { return entry.Settled != 0; });
}

} // namespace

FrameRenderer::FrameRenderer(dsm::Messenger& messenger)
  : Messenger(messenger)
  , Scheduler(messenger)
{
}

FrameRenderer::~FrameRenderer() = default;

Frame FrameRenderer::Render(dsm::BlockStore& store, const Scene& scene, const FrameRequest& request)
{
  NewTiles tiles(TileGrid(request.Width, request.Height, request.TileSize), this->Scheduler);
  Frame frame;
  this->RenderTiles(store, scene, request, tiles, frame);
  return frame;
}

void FrameRenderer::Refine(
  dsm::BlockStore& store, const Scene& scene, const FrameRequest& request, Frame& frame)
{
  KeptTiles tiles(std::move(frame.Tiles));
  frame.Tiles.clear();
  this->RenderTiles(store, scene, request, tiles, frame);
}

void FrameRenderer::RenderTiles(dsm::BlockStore& store, const Scene& scene,
  const FrameRequest& request, TileSource& tiles, Frame& frame)
{
  const auto start = Clock::now();
  if (!CheckRequest(this->Messenger, request, scene, store.IsSettled()))
  {
    store.Settle();
  }
  dsm::WorkerSlots& slots = store.GetSlots();
  slots.BeginFrame(store.GetSettings().Workers);
  frame.Tiles = store.Visit(
    [&](auto& blocks) { return this->TraceTiles(blocks, slots, scene, request, tiles); });
  frame.Width = request.Width;
  frame.Height = request.Height;
  frame.Counters = store.GetCounters();
  frame.IdleNanoseconds = slots.GetIdleNanoseconds();
  frame.WorkerCounters = store.GetWorkerCounters();
  frame.Organization = store.GetOrganization();
  frame.Explanation = store.GetExplanation();
  frame.Seconds = SecondsSince(start);
}

template <class Store>
std::vector<Tile> FrameRenderer::TraceTiles(Store& store, dsm::WorkerSlots& slots,
  const Scene& scene, const FrameRequest& request, TileSource& tiles)
{
  const PixelRays rays(request);
  const int workers = store.GetSettings().Workers;
  std::vector<std::vector<Tile>> tilesOfWorker(workers);
  FirstFailure failure;

  store.BeginFrame();
  tiles.Begin(workers);
  std::atomic<bool> stopped{ false }; // by another rank's failure, which that rank reports
  FrameAgreement agreement(this->Messenger,
    [&]
    {
      stopped = true;
      tiles.Cancel();
    });
  this->Messenger.BeginSession();

  const auto fail = [&](const std::string& cause)
  {
    if (!stopped)
    {
      failure.Set(cause);
    }
    tiles.Cancel();
  };
  const auto work = [&](int index)
  {
    auto& worker = store.GetWorker(index);
    const dsm::WorkerSlots::Hold slot(slots);
    try
    {
      const TileTracer<Store> tracer(store, worker, scene, rays, request);
      while (std::optional<Tile> tile = tiles.Pop(slots))
      {
        const double tileStart = GetThreadSeconds();
        store.Enter(worker);
        tracer.Trace(*tile);
        store.Leave(worker);
        tile->Seconds = GetThreadSeconds() - tileStart;
        tracer.Finish(*tile, GetTint(scene.View, this->Messenger.GetRank(), tile->Seconds));
        tilesOfWorker[index].push_back(std::move(*tile));
        slots.LetOthersResume();
      }
    }
    catch (...)
    {
      store.Leave(worker);
      fail(dsm::Messenger::DescribeException());
    }
  };

  bool cancelled = false;
  const auto service = [&]
  {
    bool didSomething = false;
    try
    {
      didSomething = store.Service();
      didSomething = tiles.Service() || didSomething;
    }
    catch (...)
    {
      fail(dsm::Messenger::DescribeException());
    }
    const bool idle = this->Pool.GetRunning() == 0; // asked first: a worker fails before it stops
    const std::string cause = failure.Get();
    if ((stopped || !cause.empty()) && !cancelled)
    {
      cancelled = true;
      store.Cancel(cause.empty() ? "another rank has failed" : cause);
    }
    if (!cause.empty())
    {
      agreement.ReportFailure(cause);
    }
    if (!agreement.IsDone() && idle)
    {
      agreement.ReportDone();
      didSomething = true;
    }
    return didSomething;
  };

  try
  {
    this->Pool.Start(workers, work, [this] { this->Messenger.WakeUp(); });
  }
  catch (...)
  {
    fail(dsm::Messenger::DescribeException());
  }
  this->Messenger.ServeUntil([&] { return agreement.IsOver(); }, service, fail);
  this->Pool.Wait();
  tiles.End();
  store.EndFrame();
  // What was posted last must leave before the application goes about something else.
  this->Messenger.ProgressUntil([this] { return this->Messenger.GetUnsentBytes() == 0; });

  const dsm::Status& outcome = agreement.GetOutcome();
  if (!outcome.IsOk())
  {
    // A rank that gave up may not have taken what it had asked for; it takes it while it waits here.
    this->Messenger.Barrier();
    throw dsm::Error("The frame could not be traced. Rank " + std::to_string(outcome.FailedRank) +
      ": " + outcome.Cause);
  }
  std::vector<Tile> traced;
  for (auto& some : tilesOfWorker)
  {
    std::move(some.begin(), some.end(), std::back_inserter(traced));
  }
  return traced;
}

} // namespace rt
