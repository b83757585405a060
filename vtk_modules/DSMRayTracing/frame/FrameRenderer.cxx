// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/FrameRenderer.h"

#include "DSMRayTracing/frame/FieldReading.h"
#include "DSMRayTracing/frame/FrameTracing.h"
#include "DSMRayTracing/frame/TileGrid.h"
#include "DSMRayTracing/frame/TileSource.h"

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

/// Describes this rank's store and its activity in the frame so far.
void Describe(dsm::BlockStore& store, Frame& frame)
{
  frame.Counters = store.GetCounters();
  frame.WorkerCounters = store.GetWorkerCounters();
  frame.Explanation = store.GetExplanation();
  frame.Organization = store.GetOrganization();
  frame.IdleNanoseconds = store.GetSlots().GetIdleNanoseconds();
}

} // namespace

FrameRenderer::FrameRenderer(dsm::Messenger& messenger)
  : Messenger(messenger)
  , Queue(messenger)
  , Stealing(messenger)
{
}

FrameRenderer::~FrameRenderer() = default;

Frame FrameRenderer::Render(dsm::BlockStore& store, const Scene& scene, const FrameRequest& request,
  const Frame* last, const Records& records)
{
  TileScheduler& scheduler = request.Scheduling == TileScheduling::CentralQueue
    ? static_cast<TileScheduler&>(this->Queue)
    : this->Stealing;
  NewTiles tiles(TileGrid(request.Width, request.Height, request.TileSize), scheduler);
  Frame frame;
  this->RenderTiles(store, scene, request, last, records, tiles, frame);
  return frame;
}

void FrameRenderer::Refine(dsm::BlockStore& store, const Scene& scene, const FrameRequest& request,
  Frame& frame, const Records& records)
{
  KeptTiles tiles(std::move(frame.Tiles), request.FirstSample + request.Samples);
  frame.Tiles.clear();
  frame.Number = 0; // as long as it has no tiles
  this->RenderTiles(store, scene, request, nullptr, records, tiles, frame);
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
  const double before = frame.IsAborted ? frame.Seconds : 0.0;
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
    Describe(store, traced);
    traced.Seconds = before + SecondsSince(start);
    return records.Report ? records.Report(traced) : std::vector<std::byte>();
  };
  const std::shared_ptr<const BeamHistory> history = last ? last->Beams : frame.Beams;
  dsm::WorkerSlots& slots = store.GetSlots();
  slots.BeginFrame(store.GetSettings().Workers);
  store.Visit(
    [&](auto& blocks)
    {
      blocks.BeginFrame(agreed);
      FrameTracing<std::decay_t<decltype(blocks)>> tracing(blocks,
        { this->Messenger, this->Pool, slots, this->Watch, scene, request, history.get(), tiles,
          report });
      tracing.Trace(makePlan);
      tracing.GiveTo(frame);
    });
  this->Messenger.Insist([&] { Describe(store, frame); });
  frame.Seconds = before + SecondsSince(start);
}

} // namespace rt
