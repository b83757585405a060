// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/FrameRenderer.h"

#include "DSMRayTracing/frame/FieldReading.h"
#include "DSMRayTracing/frame/FrameTracing.h"
#include "DSMRayTracing/frame/SceneDigest.h"
#include "DSMRayTracing/frame/TileGrid.h"
#include "DSMRayTracing/frame/TileSource.h"
#include "DSMRayTracing/object/ObjectDigest.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>

namespace rt
{

namespace
{

double SecondsSince(std::chrono::steady_clock::time_point start)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Most bytes of the first hits that a rank keeps: also of its memory limit, so many parts.
constexpr std::size_t MostBytesForHits = std::size_t{ 256 } << 20;
constexpr std::uint64_t PartsForHits = 16;

std::size_t GetBytesForHits(const dsm::BlockStore::Settings& settings)
{
  return settings.MemoryBytes == 0 ? MostBytesForHits
                                   : static_cast<std::size_t>(std::min<std::uint64_t>(
                                       MostBytesForHits, settings.MemoryBytes / PartsForHits));
}

/// All that the first hits of a picture's rays depend on, and how bricks are kept: statistics of another way are those
/// of a picture that reads them.
KeptHits::Key GetHitsKey(
  const dsm::BlockStore& store, const Scene& scene, const FrameRequest& request)
{
  ObjectDigest digest;
  const std::uint64_t shapes = GetShapeDigest(scene);
  digest.AddAll(request.Width, request.Height, request.TileSize, request.WorldToClip,
    request.Limits, shapes, store.GetOrganization(), store.GetSettings().HostSharing,
    store.GetSettings().CacheBytes);
  return { digest.Get(), shapes, store.CountPublications() };
}

/// What a frame did before it was aborted.
struct Earlier
{
  double Seconds = 0.0;
  double BusySeconds = 0.0;
  std::uint64_t IdleNanoseconds = 0;
  dsm::StoreCounters Counters;
  std::vector<dsm::WorkerCounters> WorkerCounters;
};

Earlier GetEarlier(const Frame& frame)
{
  return frame.IsAborted ? Earlier{ frame.Seconds, frame.BusySeconds, frame.IdleNanoseconds,
    frame.Counters, frame.WorkerCounters }
                         : Earlier();
}

/// Describes this rank's store and its activity in the frame so far.
void Describe(dsm::BlockStore& store, const Earlier& earlier, Frame& frame)
{
  frame.Counters = store.GetCounters();
  frame.Counters.AddActivity(earlier.Counters);
  frame.WorkerCounters = store.GetWorkerCounters();
  const std::size_t workers = std::min(frame.WorkerCounters.size(), earlier.WorkerCounters.size());
  for (std::size_t worker = 0; worker < workers; ++worker)
  {
    frame.WorkerCounters[worker] += earlier.WorkerCounters[worker];
  }
  frame.Explanation = store.GetExplanation();
  frame.Organization = store.GetOrganization();
  frame.IdleNanoseconds = store.GetSlots().GetIdleNanoseconds() + earlier.IdleNanoseconds;
}

/// Collective. Returns the tiles of the grid that no rank has, ascending.
std::vector<int> FindLeft(dsm::Messenger& messenger, const TileGrid& grid, const Frame& frame)
{
  constexpr int bits = 64;
  std::vector<std::uint64_t> left;
  messenger.RunTogether("Ending the frame",
    [&]
    {
      left.assign(static_cast<std::size_t>((grid.GetCount() + bits - 1) / bits), ~std::uint64_t(0));
      for (const Tile& tile : frame.Tiles)
      {
        left[static_cast<std::size_t>(tile.Index / bits)] &=
          ~(std::uint64_t(1) << tile.Index % bits);
      }
    });
  messenger.Reduce(left, [](std::uint64_t& some, std::uint64_t others) { some &= others; });
  std::vector<int> tiles;
  messenger.Insist(
    [&]
    {
      tiles.clear();
      for (int tile = 0; tile < grid.GetCount(); ++tile)
      {
        if ((left[static_cast<std::size_t>(tile / bits)] >> tile % bits & 1) != 0)
        {
          tiles.push_back(tile);
        }
      }
    });
  return tiles;
}

} // namespace

FrameRenderer::FrameRenderer(dsm::Messenger& messenger)
  : Messenger(messenger)
  , Queue(messenger)
  , Stealing(messenger)
  , Filter(messenger, this->Pool)
{
}

FrameRenderer::~FrameRenderer() = default;

Frame FrameRenderer::Render(dsm::BlockStore& store, const Scene& scene, const FrameRequest& request,
  const Frame* last, const Records& records)
{
  Frame frame;
  const TileGrid grid(request.Width, request.Height, request.TileSize);
  std::vector<int> left;
  this->Messenger.Insist([&] { left = grid.ListTiles(); });
  this->RenderLeft(store, scene, request, std::move(left), last, records, frame);
  return frame;
}

void FrameRenderer::Resume(dsm::BlockStore& store, const Scene& scene, const FrameRequest& request,
  Frame& frame, const Frame* last, const Records& records)
{
  this->RenderLeft(store, scene, request, std::move(frame.Left), last, records, frame);
}

void FrameRenderer::RenderLeft(dsm::BlockStore& store, const Scene& scene,
  const FrameRequest& request, std::vector<int> left, const Frame* last, const Records& records,
  Frame& frame)
{
  TileScheduler& scheduler = request.Scheduling == TileScheduling::CentralQueue
    ? static_cast<TileScheduler&>(this->Queue)
    : this->Stealing;
  const TileGrid grid(request.Width, request.Height, request.TileSize);
  NewTiles tiles(grid, scheduler, std::move(left), std::move(frame.Tiles));
  frame.Tiles.clear();
  frame.Number = 0; // as long as it has no tiles
  this->RenderTiles(store, scene, request, last, records, tiles, frame);
  if (frame.IsAborted)
  {
    frame.Left = FindLeft(this->Messenger, grid, frame);
  }
}

void FrameRenderer::Refine(dsm::BlockStore& store, const Scene& scene, const FrameRequest& request,
  Frame& frame, const Records& records)
{
  KeptTiles tiles(std::move(frame.Tiles), request.FirstSample + request.Samples);
  frame.Tiles.clear();
  frame.Number = 0; // as long as it has no tiles
  this->RenderTiles(store, scene, request, nullptr, records, tiles, frame);
}

Frame FrameRenderer::FilterLight(
  const dsm::BlockStore& store, const glm::dmat4& worldToClip, const Frame& frame)
{
  return this->Filter.Apply(store.GetSettings().Workers, worldToClip, frame);
}

void FrameRenderer::Read(
  const char* what, dsm::BlockStore& store, dsm::FunctionRef<void(FieldReader&)> read)
{
  const auto settled = this->Messenger.AllGatherValue(std::uint8_t{ store.IsSettled() });
  if (std::find(settled.begin(), settled.end(), 0) != settled.end())
  {
    store.Settle();
  }
  dsm::WorkerSlots& slots = store.GetSlots();
  slots.BeginFrame(store.GetSettings().Workers);
  store.Visit(
    [&](auto& blocks)
    {
      blocks.BeginFrame();
      FieldReading<std::decay_t<decltype(blocks)>>(blocks, this->Messenger, this->Pool, slots)
        .Read(what, read);
    });
}

void FrameRenderer::RenderTiles(dsm::BlockStore& store, const Scene& scene,
  const FrameRequest& request, const Frame* last, const Records& records, TileSource& tiles,
  Frame& frame)
{
  const auto start = std::chrono::steady_clock::now();
  const Earlier earlier = GetEarlier(frame);
  std::vector<FrameEntry> gathered;
  if (records.Entries.empty())
  {
    gathered = this->Messenger.GatherValueTogether(
      "Cannot begin the frame", [&] { return FrameEntry::Create(store, scene, request, last); });
  }
  const std::vector<FrameEntry>& entries = records.Entries.empty() ? gathered : records.Entries;
  FrameEntry::Check(entries, request);
  const bool settled = std::all_of(
    entries.begin(), entries.end(), [](const FrameEntry& each) { return each.Settled; });
  if (!settled)
  {
    store.Settle();
  }
  const bool agreed = settled &&
    std::all_of(
      entries.begin(), entries.end(), [](const FrameEntry& each) { return each.MayBegin; });
  const auto makePlan = [&] { return FrameEntry::CreatePlan(entries, request, last); };
  const auto report = [&](Frame& traced)
  {
    Describe(store, earlier, traced);
    traced.Seconds = earlier.Seconds + SecondsSince(start);
    return records.Report ? records.Report(traced) : std::vector<std::byte>();
  };
  bool usesHits = false;
  this->Messenger.Insist(
    [&]
    {
      usesHits = this->Hits.Begin(GetHitsKey(store, scene, request),
        TileGrid(request.Width, request.Height, request.TileSize).GetCount(),
        GetBytesForHits(store.GetSettings()), request.KeepsHits);
    });
  const std::shared_ptr<const BeamHistory> history = last ? last->Beams : frame.Beams;
  dsm::WorkerSlots& slots = store.GetSlots();
  slots.BeginFrame(store.GetSettings().Workers);
  store.Visit(
    [&](auto& blocks)
    {
      blocks.BeginFrame(agreed);
      FrameTracing<std::decay_t<decltype(blocks)>> tracing(blocks,
        { this->Messenger, this->Pool, slots, this->Watch, scene, request, history.get(),
          usesHits ? &this->Hits : nullptr, tiles, report });
      tracing.Trace(makePlan);
      tracing.GiveTo(frame);
    });
  this->Messenger.Insist([&] { Describe(store, earlier, frame); });
  frame.Seconds = earlier.Seconds + SecondsSince(start);
  frame.BusySeconds += earlier.BusySeconds;
  if (frame.IsAborted)
  {
    frame.Reports = this->Messenger.GatherTogether("Ending the frame",
      [&] { return records.Report ? records.Report(frame) : std::vector<std::byte>(); });
  }
}

} // namespace rt
