// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/FrameRenderer.h"

#include "DSMRayTracing/frame/FrameTracing.h"
#include "DSMRayTracing/frame/SceneDigest.h"
#include "DSMRayTracing/frame/TileGrid.h"
#include "DSMRayTracing/frame/TileSource.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory>
#include <string>
#include <type_traits>
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
  frame.Channels = request.Channels;
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
      blocks.BeginFrame(agreed);
      FrameTracing<std::decay_t<decltype(blocks)>> tracing(blocks,
        { this->Messenger, this->Pool, slots, this->Watch, scene, request, history.get(), tiles });
      tracing.Trace(makePlan);
      tracing.GiveTo(frame);
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

} // namespace rt
