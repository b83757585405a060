// SPDX-License-Identifier: BSD-3-Clause
// Times the tracer and the memory below it without ParaView.
#include "AccessBenchmark.h"
#include "BenchmarkCamera.h"
#include "BenchmarkOptions.h"
#include "BenchmarkVolume.h"
#include "CellBenchmark.h"
#include "DelayedTransport.h"
#include "FilterBenchmark.h"
#include "LookBenchmark.h"
#include "MediumBenchmark.h"
#include "MeshBenchmark.h"
#include "PictureFile.h"

#include "DSMCore/store/BlockStore.h"
#include "DSMCore/transport/LoopbackTransport.h"
#include "DSMCore/transport/Messenger.h"
#include "DSMCore/transport/MpiTransport.h"
#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/frame/FrameRenderer.h"
#include "DSMRayTracing/frame/TileGrid.h"
#include "DSMVolumeFiles/cache/ChunkCache.h"

#include "tests/support/PictureHash.h"

#include <nlohmann/json.hpp>

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <iostream>
#include <limits>
#include <numeric>
#include <sstream>
#include <variant>

namespace
{

using Json = nlohmann::ordered_json;

/// What one rank did and holds.
struct RankResult
{
  std::uint64_t Accesses = 0;
  std::uint64_t Hits = 0;
  std::uint64_t Misses = 0;
  std::uint64_t Joins = 0;
  std::uint64_t Evictions = 0;
  std::uint64_t Prefetches = 0;
  std::uint64_t PrefetchesUsed = 0;
  std::uint64_t Requests = 0;
  std::uint64_t BytesReceived = 0;
  std::uint64_t Tiles = 0;
  std::uint64_t NewTiles = 0;
  std::uint64_t ResidentBytes = 0;
  std::uint64_t CacheBytes = 0;
  std::uint64_t PeakRssBytes = 0;
  std::uint64_t BytesRead = 0; ///< from the volume's file
  double WaitSeconds = 0.0;
  double IdleSeconds = 0.0;
  double BusySeconds = 0.0;

  void Add(const rt::Frame& frame)
  {
    this->Accesses += frame.Counters.Workers.Accesses;
    this->Hits += frame.Counters.Workers.Hits;
    this->Misses += frame.Counters.Workers.Misses;
    this->Joins += frame.Counters.Workers.Joins;
    this->Evictions += frame.Counters.Evictions;
    this->Prefetches += frame.Counters.Prefetches;
    this->PrefetchesUsed += frame.Counters.PrefetchesUsed;
    this->Requests += frame.Counters.Requests;
    this->BytesReceived += frame.Counters.BytesReceived;
    this->Tiles += frame.Tiles.size();
    this->NewTiles += std::count_if(
      frame.Tiles.begin(), frame.Tiles.end(), [](const rt::Tile& tile) { return tile.IsNew; });
    this->BusySeconds += frame.BusySeconds;
    this->WaitSeconds += 1e-9 * frame.Counters.Workers.WaitNanoseconds;
    this->IdleSeconds += 1e-9 * frame.IdleNanoseconds;
    this->ResidentBytes = frame.Counters.ResidentBytes;
    this->CacheBytes = std::max(this->CacheBytes, frame.Counters.PeakCachedBytes);
  }
};

Json ToJson(const RankResult& rank)
{
  return { { "accesses", rank.Accesses }, { "hits", rank.Hits }, { "misses", rank.Misses },
    { "joins", rank.Joins }, { "evictions", rank.Evictions }, { "prefetches", rank.Prefetches },
    { "prefetches_used", rank.PrefetchesUsed }, { "requests", rank.Requests },
    { "bytes_received", rank.BytesReceived }, { "tiles", rank.Tiles },
    { "new_tiles", rank.NewTiles }, { "busy_seconds", rank.BusySeconds },
    { "wait_seconds", rank.WaitSeconds }, { "idle_seconds", rank.IdleSeconds },
    { "resident_bytes", rank.ResidentBytes }, { "cache_bytes", rank.CacheBytes },
    { "peak_rss_bytes", rank.PeakRssBytes }, { "bytes_read", rank.BytesRead } };
}

std::uint64_t GetPeakRssBytes()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

/// Processor time of the tiles of a set of frames that a rank traced.
struct TracingCost
{
  double Seconds = 0.0;
  std::uint64_t LightRays = 0;

  void Add(const rt::Frame& frame)
  {
    for (const rt::Tile& tile : frame.Tiles)
    {
      this->Seconds += tile.Seconds;
      this->LightRays += tile.LightRays;
    }
  }
  void Add(const TracingCost& other)
  {
    this->Seconds += other.Seconds;
    this->LightRays += other.LightRays;
  }
};

/// Rays per second of one core: primary rays by frames without light rays, light rays by what they
/// add to them. Collective.
Json CompareRays(const BenchmarkOptions& options, dsm::Messenger& messenger, std::size_t frames,
  const TracingCost& with, const TracingCost& without)
{
  TracingCost all;
  TracingCost primary;
  for (const TracingCost& cost : messenger.AllGatherValue(with))
  {
    all.Add(cost);
  }
  for (const TracingCost& cost : messenger.AllGatherValue(without))
  {
    primary.Add(cost);
  }
  const double pixels = static_cast<double>(frames) * options.Width * options.Height;
  const double primaryRate = pixels / primary.Seconds;
  const double lightRate = static_cast<double>(all.LightRays) / (all.Seconds - primary.Seconds);
  return { { "light_rays", all.LightRays }, { "primary_rays_per_second_and_core", primaryRate },
    { "light_rays_per_second_and_core", lightRate },
    { "light_over_primary", lightRate / primaryRate },
    { "frame_over_primary_frame", all.Seconds / primary.Seconds } };
}

/// How long one repetition took, and what it drew.
struct Timing
{
  std::size_t Frames = 0;
  double BestSeconds = 0.0; ///< of a session as a whole; of an orbit, position by position
  double FirstSeconds = 0.0;
  double LastSeconds = 0.0;
  double OpeningSeconds = 0.0; ///< of an orbit's first picture, when no brick is there
  std::uint64_t Hash = 0;
};

/// Counts are sums over the ranks and the frames of the last repetition; bytes held are the largest
/// of any rank.
Json Summarise(const BenchmarkOptions& options, const dsm::BlockStore& store, const Timing& timing,
  const std::vector<RankResult>& ranks)
{
  RankResult total;
  Json each = Json::array();
  for (const RankResult& rank : ranks)
  {
    total.Accesses += rank.Accesses;
    total.Hits += rank.Hits;
    total.Misses += rank.Misses;
    total.Joins += rank.Joins;
    total.Prefetches += rank.Prefetches;
    total.PrefetchesUsed += rank.PrefetchesUsed;
    total.Requests += rank.Requests;
    total.BytesRead += rank.BytesRead;
    total.WaitSeconds += rank.WaitSeconds;
    total.BytesReceived += rank.BytesReceived;
    total.NewTiles += rank.NewTiles;
    total.IdleSeconds += rank.IdleSeconds;
    total.ResidentBytes = std::max(total.ResidentBytes, rank.ResidentBytes);
    total.CacheBytes = std::max(total.CacheBytes, rank.CacheBytes);
    total.PeakRssBytes = std::max(total.PeakRssBytes, rank.PeakRssBytes);
    each.push_back(ToJson(rank));
  }
  const int threads = store.GetSettings().Workers;
  const double frames = static_cast<double>(timing.Frames);
  const double framesPerSecond = frames / timing.BestSeconds;
  char hexadecimal[17];
  std::snprintf(
    hexadecimal, sizeof(hexadecimal), "%016llx", static_cast<unsigned long long>(timing.Hash));
  return { { "volume", options.Volume }, { "isovalues", options.Isovalues },
    { "size", { options.Width, options.Height } }, { "frames", timing.Frames },
    { "repeat", options.Repeat }, { "store", dsm::GetText(store.GetOrganization()) },
    { "host_sharing", options.HostSharing }, { "cache_fraction", options.CacheFraction },
    { "rank_count", ranks.size() }, { "threads", threads },
    { "overlap", store.GetSettings().Overlap }, { "prefetch", store.GetSettings().Prefetch },
    { "frames_per_second", framesPerSecond },
    { "first_frames_per_second", frames / timing.FirstSeconds },
    { "rays_per_second", framesPerSecond * options.Width * options.Height },
    { "accesses", total.Accesses }, { "hits", total.Hits }, { "misses", total.Misses },
    { "joins", total.Joins }, { "prefetches", total.Prefetches },
    { "prefetches_used", total.PrefetchesUsed }, { "requests", total.Requests },
    { "bytes_received", total.BytesReceived }, { "wait_seconds", total.WaitSeconds },
    { "new_tiles", total.NewTiles },
    { "idle_part", total.IdleSeconds / (timing.LastSeconds * threads * ranks.size()) },
    { "resident_bytes", total.ResidentBytes }, { "cache_bytes", total.CacheBytes },
    { "peak_rss_bytes", total.PeakRssBytes }, { "bytes_read", total.BytesRead },
    { "image_hash", hexadecimal }, { "ranks", each } };
}

/// Sums of what each rank adds up for each tile; collective.
std::vector<double> SumTileSeconds(dsm::Messenger& messenger, const std::vector<double>& mine)
{
  std::vector<std::byte> bytes(mine.size() * sizeof(double));
  std::memcpy(bytes.data(), mine.data(), bytes.size());
  std::vector<double> sums(mine.size());
  for (const auto& part : messenger.AllGather(std::move(bytes)))
  {
    std::vector<double> theirs(part.size() / sizeof(double));
    std::memcpy(theirs.data(), part.data(), part.size());
    std::transform(sums.begin(), sums.end(), theirs.begin(), sums.begin(), std::plus<double>());
  }
  return sums;
}

void RunIsosurface(const BenchmarkOptions& options, dsm::Messenger& messenger)
{
  dsm::BlockStore::Settings settings = options.CreateSettings(messenger);
  settings.MemoryBytes = options.Mebibytes << 20;
  dsm::BlockStore store(messenger, settings);

  rt::Scene scene;
  scene.Objects.push_back(
    PublishBenchmarkVolume(options.Volume, options.BrickEdge, settings.Workers, store, messenger));
  auto& object = std::get<rt::LatticeIsosurface>(scene.Objects.front());
  object.Isovalues = options.Isovalues;
  std::sort(object.Isovalues.begin(), object.Isovalues.end());
  object.Look.Surface.Opacity = options.Opacity;
  settings.CacheBytes = static_cast<std::size_t>(
    options.CacheFraction * object.Field.Voxels->Segment->GetDirectory().GetTotalBytes());
  store.SetSettings(settings);

  rt::FrameRenderer renderer(messenger);
  scene.Lights.emplace_back();
  scene.Transport = CreateTransport(options, object.Field);
  const std::vector<double> isovalues = object.Isovalues;
  const std::vector<Position> positions = GetPositions(options);
  rt::Frame frame;
  const auto trace = [&](const Position& position)
  {
    const Camera camera =
      GetCamera(object.Field, static_cast<double>(options.Width) / options.Height, position);
    std::transform(isovalues.begin(), isovalues.end(), object.Isovalues.begin(),
      [&](double isovalue) { return position.IsovalueFactor * isovalue; });
    scene.Lights.front() = CreateLamp(options, camera);
    frame = renderer.Render(store, scene, CreateRequest(options, camera), &frame);
  };

  Timing timing;
  timing.Frames = positions.size();
  timing.BestSeconds = std::numeric_limits<double>::infinity();
  RankResult opening;
  const auto getBytesRead = [] { return vol::ChunkCache::GetShared().GetBytesRead(); };
  if (options.Session.empty())
  {
    const std::uint64_t before = getBytesRead();
    trace(positions.front());
    opening.Add(frame);
    opening.BytesRead = getBytesRead() - before;
    timing.OpeningSeconds = frame.Seconds;
  }
  std::vector<double> fastest(positions.size(), std::numeric_limits<double>::infinity());
  std::vector<double> tiles(static_cast<std::size_t>(
    rt::TileGrid(options.Width, options.Height, options.TileSize).GetCount()));
  RankResult mine;
  const rt::LightTransport transport = scene.Transport;
  const bool hasLightRays = transport.Shadows || transport.AmbientOcclusionSamples > 0;
  std::vector<TracingCost> with(positions.size());
  std::vector<TracingCost> without(positions.size());
  const auto keepLeast = [&](TracingCost& least)
  {
    TracingCost cost;
    cost.Add(frame);
    least = least.Seconds > 0.0 && least.Seconds < cost.Seconds ? least : cost;
  };
  for (int repetition = 0; repetition < options.Repeat; ++repetition)
  {
    mine = {};
    const std::uint64_t before = getBytesRead();
    tiles.assign(tiles.size(), 0.0);
    timing.LastSeconds = 0.0;
    for (std::size_t number = 0; number < positions.size(); ++number)
    {
      if (hasLightRays)
      {
        scene.Transport.Shadows = false;
        scene.Transport.AmbientOcclusionSamples = 0;
        trace(positions[number]);
        keepLeast(without[number]);
        scene.Transport = transport;
      }
      trace(positions[number]);
      keepLeast(with[number]);
      fastest[number] = std::min(fastest[number], frame.Seconds);
      timing.LastSeconds += frame.Seconds;
      for (const rt::Tile& tile : frame.Tiles)
      {
        tiles[static_cast<std::size_t>(tile.Index)] +=
          tile.Seconds / static_cast<double>(positions.size());
      }
      mine.Add(frame);
      if (repetition == 0)
      {
        const rt::Picture picture = rt::GatherFrame(messenger, frame);
        timing.Hash = timing.Hash * 0x100000001b3ull ^ GetPictureHash(picture);
        if (number == 0 && !options.Picture.empty() && messenger.GetRank() == 0)
        {
          WritePicture(picture, options.Picture);
        }
      }
    }
    mine.BytesRead = getBytesRead() - before;
    timing.FirstSeconds = repetition == 0 ? timing.LastSeconds : timing.FirstSeconds;
    timing.BestSeconds = std::min(timing.BestSeconds, timing.LastSeconds);
  }
  if (options.Session.empty())
  {
    timing.BestSeconds = std::accumulate(fastest.begin(), fastest.end(), 0.0);
  }
  mine.PeakRssBytes = GetPeakRssBytes();
  const auto ranks = messenger.AllGatherValue(mine);
  const auto openings = messenger.AllGatherValue(opening);
  const std::vector<double> tileSeconds = SumTileSeconds(messenger, tiles);
  TracingCost sums[2];
  for (std::size_t number = 0; number < positions.size(); ++number)
  {
    sums[0].Add(with[number]);
    sums[1].Add(without[number]);
  }
  const Json rates = CompareRays(options, messenger, positions.size(), sums[0], sums[1]);
  const Camera first =
    GetCamera(object.Field, static_cast<double>(options.Width) / options.Height, positions.front());
  scene.Lights.front() = CreateLamp(options, first);
  const Json looks = options.Looks ? BenchmarkLooks(messenger, store, renderer, scene,
                                       CreateRequest(options, first), options.Repeat)
                                   : Json();
  const Json filter = options.Filter ? BenchmarkFilter(messenger, store, renderer, scene,
                                         CreateRequest(options, first), options.Repeat)
                                     : Json();
  if (messenger.GetRank() == 0)
  {
    Json result = Summarise(options, store, timing, ranks);
    result["brick_bytes"] = object.Field.Voxels->Segment->GetDirectory().GetLargest();
    result["opening"] = { { "seconds", timing.OpeningSeconds }, { "ranks", Json::array() } };
    for (const RankResult& rank : openings)
    {
      result["opening"]["ranks"].push_back(ToJson(rank));
    }
    if (options.TileSeconds)
    {
      result["tile_seconds"] = tileSeconds;
    }
    if (hasLightRays)
    {
      result.update(rates);
    }
    if (options.Looks)
    {
      result["looks"] = looks;
    }
    if (options.Filter)
    {
      result["filter"] = filter;
    }
    std::ostringstream text;
    text << options.Volume << ": " << result["frames_per_second"].get<double>() << " frames/s, "
         << 1e-6 * result["rays_per_second"].get<double>() << " million rays/s, picture "
         << result["image_hash"].get<std::string>() << '\n';
    if (hasLightRays)
    {
      text << "by processor time of a core: "
           << 1e-6 * rates["primary_rays_per_second_and_core"].get<double>()
           << " million primary rays/s, "
           << 1e-6 * rates["light_rays_per_second_and_core"].get<double>()
           << " million light rays/s (" << rates["light_over_primary"].get<double>()
           << "); the frame takes " << rates["frame_over_primary_frame"].get<double>()
           << " times that of primary rays\n";
    }
    if (options.Looks)
    {
      text << "other looks over the first one: " << looks.dump() << '\n';
    }
    if (options.Filter)
    {
      text << "filtered, beside one and many samples: " << filter.dump() << '\n';
    }
    RunOptions::Write(options.Json, result.dump(2), text.str());
  }
}

/// What `dsm_bench write` was asked to do.
struct WriteOptions
{
  std::string Volume = "sphere:128:float";
  std::string File;

  void AddTo(CLI::App& app)
  {
    app.add_option("--volume", this->Volume, "a sample volume, as in isosurface")
      ->capture_default_str();
    app.add_option("--file", this->File, "for the samples, x fastest, as bare numbers")->required();
  }
};

/// Writes the samples on rank 0, which also prints where they are in space. Collective.
void WriteVolume(const WriteOptions& options, dsm::Messenger& messenger)
{
  const int threads = messenger.GetCoresPerRank();
  messenger.RunTogether("Writing the volume",
    [&]
    {
      if (messenger.GetRank() != 0)
      {
        return;
      }
      const BenchmarkSamples samples = ReadBenchmarkSamples(options.Volume, threads);
      std::ofstream file(options.File, std::ios::binary);
      file.write(reinterpret_cast<const char*>(samples.Bytes.data()),
        static_cast<std::streamsize>(samples.Bytes.size()));
      if (!file.flush())
      {
        throw dsm::Error("Cannot write '" + options.File + "'.");
      }
      const glm::dmat4& matrix = samples.IndexToWorld;
      const Json result{ { "points", { samples.Points.x, samples.Points.y, samples.Points.z } },
        { "spacing", { matrix[0][0], matrix[1][1], matrix[2][2] } },
        { "origin", { matrix[3][0], matrix[3][1], matrix[3][2] } } };
      std::cout << result.dump() << std::endl;
    });
}

} // namespace

int main(int argc, char** argv)
{
  const dsm::MpiTransport::Environment environment(argc, argv);
  auto transport = dsm::MpiTransport::Create(nullptr);
  auto delayed = std::make_unique<DelayedTransport>(
    transport ? std::move(transport) : std::move(dsm::LoopbackTransport::CreateGroup(1).front()));
  DelayedTransport& network = *delayed;
  dsm::Messenger messenger(std::move(delayed));
  CLI::App app("Times the tracer and the memory below it, alone or under mpirun");
  app.require_subcommand(1);
  BenchmarkOptions isosurface;
  AccessBenchmark::Options access;
  CellBenchmark::Options cells;
  MediumBenchmark::Options medium;
  MeshBenchmark::Options mesh;
  WriteOptions write;
  const auto add = [&](const char* name, auto& options, const char* text, auto run)
  {
    CLI::App& benchmark = *app.add_subcommand(name, text);
    options.AddTo(benchmark);
    benchmark.callback([&options, run] { run(options); });
  };
  add("isosurface", isosurface, "frames of a volume",
    [&](const BenchmarkOptions& options)
    {
      network.SetLatency(1e-6 * options.Latency);
      RunIsosurface(options, messenger);
    });
  add("access", access, "the paper's Table 1",
    [&](const AccessBenchmark::Options& options) { AccessBenchmark::Run(options, messenger); });
  add("cells", cells, "frames of curvilinear and unstructured grids",
    [&](const CellBenchmark::Options& options)
    {
      network.SetLatency(1e-6 * options.Latency);
      CellBenchmark::Run(options, messenger);
    });
  add("medium", medium, "frames of a volume as a medium",
    [&](const MediumBenchmark::Options& options)
    {
      network.SetLatency(1e-6 * options.Latency);
      MediumBenchmark::Run(options, messenger);
    });
  add("mesh", mesh, "frames of a mesh",
    [&](const MeshBenchmark::Options& options)
    {
      network.SetLatency(1e-6 * options.Latency);
      MeshBenchmark::Run(options, messenger);
    });
  add("write", write, "the samples of a volume to a file",
    [&](const WriteOptions& options) { WriteVolume(options, messenger); });
  try
  {
    app.parse(argc, argv);
  }
  catch (const CLI::CallForHelp&)
  {
    std::cout << (messenger.GetRank() == 0 ? app.help() : "");
  }
  catch (const std::exception& error)
  {
    // Whatever is thrown here was agreed on by all ranks, so one speaks for all.
    if (messenger.GetRank() == 0)
    {
      std::cerr << "dsm_bench: " << error.what() << std::endl;
    }
    return 1;
  }
  return 0;
}
