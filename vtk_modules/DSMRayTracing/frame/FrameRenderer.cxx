// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/FrameRenderer.h"

#include "DSMCore/base/FirstFailure.h"
#include "DSMRayTracing/frame/BeamHistory.h"
#include "DSMRayTracing/frame/FrameAgreement.h"
#include "DSMRayTracing/frame/PixelRays.h"
#include "DSMRayTracing/frame/SceneDigest.h"
#include "DSMRayTracing/frame/TileGrid.h"
#include "DSMRayTracing/frame/TileSampler.h"
#include "DSMRayTracing/frame/TileSource.h"

#include <time.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <exception>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
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
glm::vec3 GetTint(DebugView view, int rank, const Tile& tile)
{
  switch (view)
  {
    case DebugView::TracingRank:
      return GetNumberColor(static_cast<std::uint64_t>(rank));
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

/// The first failure among a rank's workers and its communication thread.
class SharedFailure
{
public:
  void Keep(std::exception_ptr failure)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->First.Keep(failure);
  }
  bool IsEmpty() const
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    return this->First.IsEmpty();
  }
  std::string GetText() const
  {
    try
    {
      const std::lock_guard<std::mutex> lock(this->Mutex);
      this->First.Throw();
      return {};
    }
    catch (...)
    {
      return dsm::Messenger::DescribeException();
    }
  }

private:
  mutable std::mutex Mutex;
  dsm::FirstFailure First;
};

/// Tells when a rank's workers have neither computed nor got a brick for too long.
class Standstill
{
public:
  explicit Standstill(double limit)
    : Limit(limit)
  {
  }
  /// `getWork`: processor time and bytes so far, of which any growth is a sign of life. To be called often.
  template <class GetWork>
  bool IsOver(const GetWork& getWork)
  {
    const double interval = this->Limit / Looks;
    const double passed = SecondsSince(this->LastLook);
    if (this->Limit == 0.0 || passed < interval)
    {
      return false;
    }
    this->LastLook = Clock::now();
    const std::pair<double, std::uint64_t> work = getWork();
    const bool hasWorked =
      work.first > this->Work.first + LeastSeconds || work.second != this->Work.second;
    // Not more than that: this process may have been stopped.
    this->Silence = hasWorked ? 0.0 : this->Silence + std::min(passed, 2.0 * interval);
    this->Work = work;
    return this->Silence > this->Limit;
  }

private:
  static constexpr double Looks = 8.0;
  static constexpr double LeastSeconds = 1e-5;

  double Limit;
  double Silence = 0.0;
  Clock::time_point LastLook = Clock::now();
  std::pair<double, std::uint64_t> Work{ 0.0, 0 };
};

/// Everything that must be equal on all ranks for a frame to make sense.
struct RequestDigest
{
  std::uint64_t Scene; ///< with the camera
  std::int64_t FirstSample;
  std::int64_t Samples;
  std::int64_t Scheduling;
  std::int64_t IsPreview;
};

/// What a rank brings to the frame.
struct Entry
{
  RequestDigest Request;
  std::uint64_t Settled;    ///< whether its store is
  std::uint64_t MayBegin;   ///< whether its store may begin the frame without asking others
  std::uint64_t LastNumber; ///< of the last frame, when it had the same tiles; else 0
  std::uint64_t LastTiles;
  double LastBusySeconds;
};

/// Bricks are asked for so many tiles, for each worker, before the tile that will need them.
constexpr int LeadOfWorker = 4;

/// A slowest rank is one that took so much longer than the fastest.
constexpr double Unbalanced = 1.02;

RequestDigest GetDigest(const FrameRequest& request, const Scene& scene)
{
  return { GetSceneDigest(scene, request), request.FirstSample, request.Samples,
    static_cast<std::int64_t>(request.Scheduling), request.IsPreview };
}

Entry CreateEntry(
  const FrameRequest& request, const Scene& scene, const Frame* last, dsm::BlockStore& store)
{
  const bool mayBegin = store.Visit([](auto& blocks) { return blocks.MayBeginFrame(); });
  Entry entry{ GetDigest(request, scene), store.IsSettled(), mayBegin, 0, 0, 0.0 };
  if (last && last->Width == request.Width && last->Height == request.Height &&
    last->TileSize == request.TileSize)
  {
    entry.LastNumber = last->Number;
    entry.LastTiles = last->Tiles.size();
    entry.LastBusySeconds = last->BusySeconds;
  }
  return entry;
}

/// Throws, on every rank alike, when the ranks were asked for different frames, or for an impossible
/// one.
void CheckRequest(const std::vector<Entry>& entries, const FrameRequest& request)
{
  for (std::size_t rank = 0; rank < entries.size(); ++rank)
  {
    if (std::memcmp(&entries[rank].Request, &entries.front().Request, sizeof(RequestDigest)) != 0)
    {
      throw dsm::Error("Rank " + std::to_string(rank) +
        " was asked to draw another picture than rank 0 (camera, "
        "size, objects, their look, or the lights differ); the frame was left out.");
    }
  }
  // All ranks have the same request now, so all throw or none.
  if (request.Width < 1 || request.Height < 1 || request.TileSize < 1)
  {
    throw dsm::Error("A frame of " + std::to_string(request.Width) + " x " +
      std::to_string(request.Height) + " pixels cannot be traced.");
  }
}

/// What the ranks know together of the last frame; `mine`: what this rank traced of it.
TilePlan CreatePlan(
  const std::vector<Entry>& entries, const FrameRequest& request, const Frame* last)
{
  TilePlan plan;
  const int tiles = TileGrid(request.Width, request.Height, request.TileSize).GetCount();
  std::uint64_t traced = 0;
  for (const Entry& entry : entries)
  {
    traced += entry.LastTiles;
    if (entry.LastNumber == 0 || entry.LastNumber != entries.front().LastNumber)
    {
      return plan;
    }
  }
  if (traced != static_cast<std::uint64_t>(tiles))
  {
    return plan;
  }
  plan.HasHistory = true;
  for (const Tile& tile : last->Tiles)
  {
    plan.Mine.push_back(tile.Index);
  }
  const auto isFaster = [](const Entry& a, const Entry& b)
  { return a.LastBusySeconds < b.LastBusySeconds; };
  const auto [fastest, slowest] = std::minmax_element(entries.begin(), entries.end(), isFaster);
  if (slowest->LastBusySeconds > Unbalanced * fastest->LastBusySeconds)
  {
    plan.Slowest = static_cast<int>(slowest - entries.begin());
    plan.Fastest = static_cast<int>(fastest - entries.begin());
  }
  return plan;
}

} // namespace

FrameRenderer::FrameRenderer(dsm::Messenger& messenger)
  : Messenger(messenger)
  , Queue(messenger)
  , Stealing(messenger)
{
}

FrameRenderer::~FrameRenderer() = default;

Frame FrameRenderer::Render(
  dsm::BlockStore& store, const Scene& scene, const FrameRequest& request, const Frame* last)
{
  TileScheduler& scheduler = request.Scheduling == TileScheduling::CentralQueue
    ? static_cast<TileScheduler&>(this->Queue)
    : this->Stealing;
  NewTiles tiles(TileGrid(request.Width, request.Height, request.TileSize), scheduler);
  Frame frame;
  this->RenderTiles(store, scene, request, last, tiles, frame);
  return frame;
}

void FrameRenderer::Refine(
  dsm::BlockStore& store, const Scene& scene, const FrameRequest& request, Frame& frame)
{
  KeptTiles tiles(std::move(frame.Tiles), request.FirstSample + request.Samples);
  frame.Tiles.clear();
  frame.Number = 0; // as long as it has no tiles
  this->RenderTiles(store, scene, request, nullptr, tiles, frame);
}

void FrameRenderer::RenderTiles(dsm::BlockStore& store, const Scene& scene,
  const FrameRequest& request, const Frame* last, TileSource& tiles, Frame& frame)
{
  const auto start = Clock::now();
  const auto entries = this->Messenger.GatherValueTogether(
    "The frame cannot begin", [&] { return CreateEntry(request, scene, last, store); });
  CheckRequest(entries, request);
  const bool settled =
    std::all_of(entries.begin(), entries.end(), [](const Entry& each) { return each.Settled; });
  if (!settled)
  {
    store.Settle();
  }
  const bool agreed = settled &&
    std::all_of(entries.begin(), entries.end(), [](const Entry& each) { return each.MayBegin; });
  const auto makePlan = [&] { return CreatePlan(entries, request, last); };
  const std::shared_ptr<const BeamHistory> history = last ? last->Beams : frame.Beams;
  dsm::WorkerSlots& slots = store.GetSlots();
  slots.BeginFrame(store.GetSettings().Workers);
  store.Visit(
    [&](auto& blocks)
    {
      this->TraceTiles(
        blocks, agreed, slots, scene, request, makePlan, history.get(), tiles, frame);
    });
  frame.Width = request.Width;
  frame.Height = request.Height;
  frame.TileSize = request.TileSize;
  this->Messenger.Insist(
    [&]
    {
      frame.Counters = store.GetCounters();
      frame.WorkerCounters = store.GetWorkerCounters();
      frame.Explanation = store.GetExplanation();
    });
  frame.IdleNanoseconds = slots.GetIdleNanoseconds();
  frame.Organization = store.GetOrganization();
  frame.Seconds = SecondsSince(start);
}

template <class Store>
void FrameRenderer::TraceTiles(Store& store, bool agreed, dsm::WorkerSlots& slots,
  const Scene& scene, const FrameRequest& request, dsm::FunctionRef<TilePlan()> makePlan,
  const BeamHistory* last, TileSource& tiles, Frame& frame)
{
  store.BeginFrame(agreed);
  // From here to the agreement's end a rank leaves the frame with all others only: whatever fails is
  // kept, and reported.
  const int workers = store.GetSettings().Workers;
  SharedFailure failure;
  std::atomic<bool> stopped{ false }; // by another rank's failure, which that rank reports
  FrameAgreement agreement(
    this->Messenger,
    [&] // no more than fits in a std::function without memory
    {
      stopped = true;
      tiles.Cancel();
    },
    [&] { tiles.Cancel(); });
  const std::uint32_t number = this->Messenger.BeginSession();
  this->Messenger.BeginServing();
  const auto start = Clock::now();

  const auto fail = [&](std::exception_ptr cause)
  {
    if (!stopped)
    {
      failure.Keep(cause);
    }
    tiles.Cancel();
  };

  std::optional<PixelRays> rays;
  std::shared_ptr<BeamHistory> beams;
  TilePlan plan;
  std::vector<int> mine;
  std::vector<std::vector<Tile>> tilesOfWorker;
  std::atomic<int> tracedTiles{ 0 };
  const auto prepare = [&]
  {
    rays.emplace(request);
    if (store.MayPrefetch())
    {
      beams =
        std::make_shared<BeamHistory>(request.Width, request.Height, scene.Objects.size(), last);
    }
    plan = makePlan();
    mine = plan.Mine;
    std::sort(mine.begin(), mine.end());
    tilesOfWorker.resize(static_cast<std::size_t>(workers));
    tiles.Begin(plan, workers);
  };
  const auto work = [&](int index)
  {
    auto& worker = store.GetWorker(index);
    const dsm::WorkerSlots::Hold slot(slots);
    try
    {
      std::uint64_t misses = 0; // of the tiles before
      bool looksAhead = true;   // as long as bricks are absent
      const ObjectTracers objects = CreateObjectTracers(store, worker, scene);
      const TileSampler sampler(objects, scene, *rays, request, beams.get());
      while (std::optional<Tile> tile = tiles.Pop(slots))
      {
        const double tileStart = GetThreadSeconds();
        store.Enter(worker);
        if (beams && looksAhead)
        {
          const std::optional<Tile> later = tiles.Peek(LeadOfWorker * workers);
          looksAhead = later && sampler.Prefetch(*later);
        }
        sampler.Trace(*tile);
        store.Leave(worker);
        tile->Seconds = GetThreadSeconds() - tileStart;
        const std::uint64_t before = std::exchange(misses, store.GetMisses(worker));
        tile->Misses += misses - before;
        looksAhead = looksAhead || misses > before;
        tile->IsNew = tile->IsNew ||
          (plan.HasHistory && !std::binary_search(mine.begin(), mine.end(), tile->Index));
        sampler.Finish(*tile, GetTint(scene.View, this->Messenger.GetRank(), *tile));
        tilesOfWorker[index].push_back(std::move(*tile));
        ++tracedTiles;
        slots.LetOthersResume();
      }
    }
    catch (...)
    {
      store.Leave(worker);
      fail(std::current_exception());
    }
  };

  std::atomic<double> busySeconds{ 0.0 };
  const double share = tiles.EstimateShare(this->Messenger.GetSize());
  const auto getPart = [&] { return share > 0.0 ? std::min(1.0, tracedTiles / share) : 1.0; };
  bool cancelled = false;
  Standstill standstill(this->Messenger.GetSilenceLimit());
  std::vector<Tile> traced;
  const auto collect = [&]
  {
    std::size_t count = tiles.CountRest();
    for (const auto& some : tilesOfWorker)
    {
      count += some.size();
    }
    traced.reserve(count);
    for (auto& some : tilesOfWorker)
    {
      std::move(some.begin(), some.end(), std::back_inserter(traced));
      some.clear();
    }
    tiles.TakeRest(traced);
  };
  const auto service = [&]
  {
    bool didSomething = false;
    try
    {
      didSomething = store.Service();
      didSomething = tiles.Service() || didSomething;
      const bool isWatched = this->Watch && this->Messenger.GetRank() == 0;
      if (isWatched && !agreement.IsAborted() && !agreement.IsOver() && this->Watch(getPart()))
      {
        agreement.Abort();
      }
    }
    catch (...)
    {
      fail(std::current_exception());
    }
    const auto getWork = [&]
    { return std::make_pair(this->Pool.GetProcessorSeconds(), store.GetCounters().BytesReceived); };
    const bool idle = this->Pool.GetRunning() == 0; // asked first: a worker fails before it stops
    if (!idle && standstill.IsOver(getWork))
    {
      this->Messenger.GiveUpThisRank();
    }
    if ((stopped || !failure.IsEmpty()) && !cancelled)
    {
      this->Messenger.Insist(
        [&] { store.Cancel(failure.IsEmpty() ? "another rank has failed" : failure.GetText()); });
      cancelled = true;
    }
    const bool isThrough = !agreement.IsDone() && idle && store.Drain();
    if (isThrough)
    {
      try
      {
        collect();
      }
      catch (...)
      {
        fail(std::current_exception());
      }
    }
    if (!failure.IsEmpty() && !agreement.HasFailed())
    {
      std::string cause;
      this->Messenger.Insist([&] { cause = failure.GetText(); });
      agreement.ReportFailure(cause);
    }
    if (isThrough)
    {
      agreement.ReportDone();
    }
    return didSomething || isThrough;
  };

  try
  {
    prepare();
    this->Pool.Start(workers, work,
      [&]
      {
        busySeconds = SecondsSince(start);
        this->Messenger.WakeUp();
      });
  }
  catch (...)
  {
    fail(std::current_exception());
  }
  dsm::FirstFailure lost; // a rank, and with it all that is collective
  try
  {
    this->Messenger.ServeUntil([&] { return agreement.IsOver(); }, service, fail);
  }
  catch (...)
  {
    lost.Keep(std::current_exception());
    this->Messenger.Insist([&] { store.Cancel(failure.GetText()); });
  }
  this->Messenger.EndServing();
  this->Pool.Wait();
  tiles.End();
  store.EndFrame();
  lost.Throw();
  // What was posted last must leave before the application goes about something else.
  this->Messenger.Flush();

  const dsm::Status& outcome = agreement.GetOutcome();
  if (!outcome.IsOk() || agreement.IsAborted())
  {
    // A rank that gave up may not have taken what it had asked for; it takes it while it waits here.
    this->Messenger.Barrier();
  }
  if (!outcome.IsOk())
  {
    throw dsm::Error("The frame could not be traced. Rank " + std::to_string(outcome.FailedRank) +
      ": " + outcome.Cause);
  }
  frame.Tiles = std::move(traced);
  frame.IsAborted = agreement.IsAborted();
  frame.Number = number;
  frame.Beams = beams;
  frame.BusySeconds = busySeconds;
}

} // namespace rt
