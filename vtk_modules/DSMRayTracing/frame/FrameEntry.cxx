// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/FrameEntry.h"

#include "DSMCore/base/Error.h"
#include "DSMRayTracing/frame/SceneDigest.h"
#include "DSMRayTracing/frame/TileGrid.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace rt
{

namespace
{

/// A slowest rank is one that took so much longer than the fastest.
constexpr double Unbalanced = 1.02;

} // namespace

FrameEntry FrameEntry::Create(
  dsm::BlockStore& store, const Scene& scene, const FrameRequest& request, const Frame* last)
{
  const bool mayBegin = store.Visit([](auto& blocks) { return blocks.MayBeginFrame(); });
  const Digest digest{ GetSceneDigest(scene, request), request.FirstSample, request.Samples,
    static_cast<std::int64_t>(request.Scheduling) };
  FrameEntry entry{ digest, store.IsSettled(), mayBegin, 0, 0, 0.0 };
  if (last && last->Width == request.Width && last->Height == request.Height &&
    last->TileSize == request.TileSize)
  {
    entry.LastNumber = last->Number;
    entry.LastTiles = last->Tiles.size();
    entry.LastBusySeconds = last->BusySeconds;
  }
  return entry;
}

void FrameEntry::Refuse(std::size_t rank)
{
  throw dsm::Error("Scene or camera on rank " + std::to_string(rank) +
    " differs from rank 0 (camera, size, objects, materials or lights); frame skipped.");
}

void FrameEntry::Check(const std::vector<FrameEntry>& entries, const FrameRequest& request)
{
  for (std::size_t rank = 0; rank < entries.size(); ++rank)
  {
    if (std::memcmp(&entries[rank].Request, &entries.front().Request, sizeof(Digest)) != 0)
    {
      Refuse(rank);
    }
  }
  // All ranks have the same request now, so all throw or none.
  if (request.Width < 1 || request.Height < 1 || request.TileSize < 1)
  {
    throw dsm::Error("A frame of " + std::to_string(request.Width) + " x " +
      std::to_string(request.Height) + " pixels cannot be traced.");
  }
}

TilePlan FrameEntry::CreatePlan(
  const std::vector<FrameEntry>& entries, const FrameRequest& request, const Frame* last)
{
  TilePlan plan;
  const int tiles = TileGrid(request.Width, request.Height, request.TileSize).GetCount();
  std::uint64_t traced = 0;
  for (const FrameEntry& entry : entries)
  {
    traced += entry.LastTiles;
    if (!last || entry.LastNumber == 0 || entry.LastNumber != entries.front().LastNumber)
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
  const auto isFaster = [](const FrameEntry& a, const FrameEntry& b)
  { return a.LastBusySeconds < b.LastBusySeconds; };
  const auto [fastest, slowest] = std::minmax_element(entries.begin(), entries.end(), isFaster);
  if (slowest->LastBusySeconds > Unbalanced * fastest->LastBusySeconds)
  {
    plan.Slowest = static_cast<int>(slowest - entries.begin());
    plan.Fastest = static_cast<int>(fastest - entries.begin());
  }
  return plan;
}

} // namespace rt
