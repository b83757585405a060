// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/FrameRenderer.h"

#include "DSMRayTracing/frame/FrameAgreement.h"
#include "DSMRayTracing/frame/PixelRays.h"
#include "DSMRayTracing/frame/TileGrid.h"
#include "DSMRayTracing/frame/TileTracer.h"

#include <algorithm>
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
  RequestDigest digest{ request.Width, request.Height,
    static_cast<std::int64_t>(scene.Isosurfaces.size()), {} };
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
  const auto start = Clock::now();
  if (!CheckRequest(this->Messenger, request, scene, store.IsSettled()))
  {
    store.Settle();
  }
  Frame frame = store.Visit([&](auto& blocks) { return this->RenderWith(blocks, scene, request); });
  frame.Counters = store.GetCounters();
  frame.WorkerCounters = store.GetWorkerCounters();
  frame.Organization = store.GetOrganization();
  frame.Explanation = store.GetExplanation();
  frame.Seconds = SecondsSince(start);
  return frame;
}

template <class Store>
Frame FrameRenderer::RenderWith(Store& store, const Scene& scene, const FrameRequest& request)
{
  const PixelRays rays(request);
  const TileGrid grid(request.Width, request.Height, request.TileSize);
  const int workers = store.GetSettings().Workers;
  std::vector<std::vector<Tile>> tilesOfWorker(workers);
  FirstFailure failure;

  store.BeginFrame();
  this->Scheduler.Begin(grid.GetCount(), workers);
  FrameAgreement agreement(this->Messenger, [this] { this->Scheduler.Cancel(); });
  this->Messenger.BeginSession();

  const auto fail = [&](const std::string& cause)
  {
    failure.Set(cause);
    this->Scheduler.Cancel();
  };
  const auto work = [&](int index)
  {
    auto& worker = store.GetWorker(index);
    try
    {
      const TileTracer<Store> tracer(store, worker, scene, rays, request);
      while (const auto number = this->Scheduler.Pop())
      {
        const auto tileStart = Clock::now();
        Tile tile = grid.CreateTile(*number);
        store.Enter(worker);
        tracer.Trace(tile);
        store.Leave(worker);
        tile.Seconds = SecondsSince(tileStart);
        tilesOfWorker[index].push_back(std::move(tile));
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
      didSomething = this->Scheduler.Service() || didSomething;
    }
    catch (...)
    {
      fail(dsm::Messenger::DescribeException());
    }
    const std::string cause = failure.Get();
    if (!cause.empty() && !cancelled)
    {
      cancelled = true;
      store.Cancel(cause);
    }
    if (!agreement.HasReported() && this->Pool.GetRunning() == 0)
    {
      agreement.ReportDone(cause);
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
  while (!agreement.IsOver())
  {
    try
    {
      this->Messenger.ProgressUntil([&] { return agreement.IsOver(); }, service);
    }
    catch (...)
    {
      // A rejected message: this rank gives up its part, and goes on serving.
      fail(dsm::Messenger::DescribeException());
    }
  }
  this->Pool.Wait();
  this->Scheduler.End();
  store.EndFrame();
  // What was posted last must leave before the application goes about something else.
  this->Messenger.ProgressUntil([this] { return this->Messenger.GetUnsentBytes() == 0; });

  const dsm::Status& outcome = agreement.GetOutcome();
  if (!outcome.IsOk())
  {
    throw dsm::Error("The frame could not be traced. Rank " + std::to_string(outcome.FailedRank) +
      ": " + outcome.Cause);
  }
  Frame frame;
  frame.Width = request.Width;
  frame.Height = request.Height;
  for (auto& tiles : tilesOfWorker)
  {
    std::move(tiles.begin(), tiles.end(), std::back_inserter(frame.Tiles));
  }
  return frame;
}

} // namespace rt
