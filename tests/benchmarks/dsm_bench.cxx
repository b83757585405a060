// SPDX-License-Identifier: BSD-3-Clause
// Times the tracer and the memory below it without ParaView. See the Usage of each benchmark.
#include "AccessBenchmark.h"
#include "BenchmarkOptions.h"
#include "BenchmarkVolume.h"
#include "MeshBenchmark.h"

#include "DSMCore/BlockStore.h"
#include "DSMCore/LoopbackTransport.h"
#include "DSMCore/Messenger.h"
#include "DSMCore/MpiTransport.h"
#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/frame/FrameRenderer.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>

#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <iostream>

namespace
{

using Json = nlohmann::ordered_json;

/// Where the camera is for one position of an orbit: around the volume's centre, elevation 20
/// degrees, four half-extents of the longest axis away, view angle 30 degrees.
struct OrbitCamera
{
  glm::dmat4 WorldToClip;
  glm::dvec3 ViewDirection;
};

OrbitCamera GetCamera(const rt::IsosurfaceObject& object, double aspect, double turn)
{
  const glm::dvec3 last(object.Field->Lattice.GetCells());
  const glm::dvec3 center(object.IndexToWorld * glm::dvec4(0.5 * last, 1.0));
  glm::dvec3 halfExtents(0.0);
  for (int axis = 0; axis < 3; ++axis)
  {
    halfExtents += 0.5 * last[axis] * glm::abs(glm::dvec3(object.IndexToWorld[axis]));
  }
  const double distance = 4.0 * std::max({ halfExtents.x, halfExtents.y, halfExtents.z });
  const double elevation = glm::radians(20.0);
  const double azimuth = turn * glm::two_pi<double>();
  const glm::dvec3 outward(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
    std::cos(elevation) * std::cos(azimuth));
  const double radius = glm::length(halfExtents);
  return { glm::perspective(
             glm::radians(30.0), aspect, distance - 1.01 * radius, distance + 1.01 * radius) *
      glm::lookAt(center + distance * outward, center, glm::dvec3(0.0, 1.0, 0.0)),
    -outward };
}

void WritePicture(const rt::Picture& picture, const std::string& path)
{
  std::ofstream file(path, std::ios::binary);
  file << "P6\n" << picture.Width << ' ' << picture.Height << "\n255\n";
  for (int y = picture.Height - 1; y >= 0; --y)
  {
    for (int x = 0; x < picture.Width; ++x)
    {
      const std::size_t pixel = static_cast<std::size_t>(y) * picture.Width + x;
      file.write(reinterpret_cast<const char*>(&picture.Color[4 * pixel]), 3);
    }
  }
}

/// What one rank did and holds.
struct RankResult
{
  std::uint64_t Accesses = 0;
  std::uint64_t Hits = 0;
  std::uint64_t Misses = 0;
  std::uint64_t Evictions = 0;
  std::uint64_t BytesReceived = 0;
  std::uint64_t Tiles = 0;
  std::uint64_t ResidentBytes = 0;
  std::uint64_t CacheBytes = 0;
  std::uint64_t PeakRssBytes = 0;
  double WaitSeconds = 0.0;

  void Add(const rt::Frame& frame)
  {
    this->Accesses += frame.Counters.Workers.Accesses;
    this->Hits += frame.Counters.Workers.Hits;
    this->Misses += frame.Counters.Workers.Misses;
    this->Evictions += frame.Counters.Evictions;
    this->BytesReceived += frame.Counters.BytesReceived;
    this->Tiles += frame.Tiles.size();
    this->WaitSeconds += 1e-9 * frame.Counters.Workers.WaitNanoseconds;
    this->ResidentBytes = frame.Counters.ResidentBytes;
    this->CacheBytes = std::max(this->CacheBytes, frame.Counters.PeakCachedBytes);
  }
};

Json ToJson(const RankResult& rank)
{
  return { { "accesses", rank.Accesses }, { "hits", rank.Hits }, { "misses", rank.Misses },
    { "evictions", rank.Evictions }, { "bytes_received", rank.BytesReceived },
    { "tiles", rank.Tiles }, { "wait_seconds", rank.WaitSeconds },
    { "resident_bytes", rank.ResidentBytes }, { "cache_bytes", rank.CacheBytes },
    { "peak_rss_bytes", rank.PeakRssBytes } };
}

std::uint64_t GetPeakRssBytes()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

/// Counts are sums over the ranks and the frames of the last orbit; bytes held are the largest of
/// any rank.
Json Summarise(const BenchmarkOptions& options, int threads, double orbitSeconds,
  std::uint64_t hash, dsm::MemoryOrganization organization, const std::vector<RankResult>& ranks)
{
  RankResult total;
  Json each = Json::array();
  for (const RankResult& rank : ranks)
  {
    total.Accesses += rank.Accesses;
    total.Hits += rank.Hits;
    total.Misses += rank.Misses;
    total.BytesReceived += rank.BytesReceived;
    total.ResidentBytes = std::max(total.ResidentBytes, rank.ResidentBytes);
    total.CacheBytes = std::max(total.CacheBytes, rank.CacheBytes);
    total.PeakRssBytes = std::max(total.PeakRssBytes, rank.PeakRssBytes);
    each.push_back(ToJson(rank));
  }
  const double framesPerSecond = options.Frames / orbitSeconds;
  char hexadecimal[17];
  std::snprintf(hexadecimal, sizeof(hexadecimal), "%016llx", static_cast<unsigned long long>(hash));
  return { { "volume", options.Volume }, { "isovalues", options.Isovalues },
    { "size", { options.Width, options.Height } }, { "frames", options.Frames },
    { "repeat", options.Repeat }, { "store", dsm::GetText(organization) },
    { "host_sharing", options.HostSharing }, { "cache_fraction", options.CacheFraction },
    { "rank_count", ranks.size() }, { "threads", threads },
    { "frames_per_second", framesPerSecond },
    { "rays_per_second", framesPerSecond * options.Width * options.Height },
    { "accesses", total.Accesses }, { "hits", total.Hits }, { "misses", total.Misses },
    { "bytes_received", total.BytesReceived }, { "resident_bytes", total.ResidentBytes },
    { "cache_bytes", total.CacheBytes }, { "peak_rss_bytes", total.PeakRssBytes },
    { "image_hash", hexadecimal }, { "ranks", each } };
}

void RunIsosurface(const BenchmarkOptions& options, dsm::Messenger& messenger)
{
  dsm::BlockStore::Settings settings = options.CreateSettings(messenger);
  settings.MemoryBytes = options.MemoryBytes;
  dsm::BlockStore store(messenger, settings);

  rt::Scene scene;
  scene.Isosurfaces.push_back(
    PublishBenchmarkVolume(options.Volume, options.BrickEdge, settings.Workers, store, messenger));
  rt::IsosurfaceObject& object = scene.Isosurfaces.front();
  object.Isovalues = options.Isovalues;
  std::sort(object.Isovalues.begin(), object.Isovalues.end());
  settings.CacheBytes = static_cast<std::size_t>(
    options.CacheFraction * object.Field->Segment->GetDirectory().GetTotalBytes());
  store.SetSettings(settings);

  rt::FrameRenderer renderer(messenger);
  scene.Lights.emplace_back();
  const auto trace = [&](int position)
  {
    const OrbitCamera camera =
      GetCamera(object, static_cast<double>(options.Width) / options.Height,
        static_cast<double>(position) / options.Frames);
    scene.Lights.front().Direction = camera.ViewDirection;
    rt::FrameRequest request;
    request.Width = options.Width;
    request.Height = options.Height;
    request.WorldToClip = camera.WorldToClip;
    return renderer.Render(store, scene, request);
  };

  trace(0);
  std::vector<double> fastest(options.Frames, 1e300);
  std::uint64_t hash = 0;
  RankResult mine;
  for (int orbit = 0; orbit < options.Repeat; ++orbit)
  {
    mine = {};
    for (int position = 0; position < options.Frames; ++position)
    {
      const rt::Frame frame = trace(position);
      fastest[position] = std::min(fastest[position], frame.Seconds);
      mine.Add(frame);
      if (orbit == 0)
      {
        const rt::Picture picture = rt::GatherFrame(messenger, frame);
        hash = hash * 0x100000001b3ull ^ rt::GetHash(picture);
        if (position == 0 && !options.Picture.empty() && messenger.GetRank() == 0)
        {
          WritePicture(picture, options.Picture);
        }
      }
    }
  }
  mine.PeakRssBytes = GetPeakRssBytes();
  const auto ranks = messenger.AllGatherValue(mine);
  if (messenger.GetRank() == 0)
  {
    double orbitSeconds = 0.0;
    for (const double seconds : fastest)
    {
      orbitSeconds += seconds;
    }
    const Json result =
      Summarise(options, settings.Workers, orbitSeconds, hash, store.GetOrganization(), ranks);
    if (options.Json == "-")
    {
      std::cout << result.dump(2) << std::endl;
    }
    else if (!options.Json.empty())
    {
      std::ofstream(options.Json) << result.dump(2) << '\n';
    }
    if (options.Json != "-")
    {
      std::cout << options.Volume << ": " << result["frames_per_second"].get<double>()
                << " frames/s, " << 1e-6 * result["rays_per_second"].get<double>()
                << " million rays/s, picture " << result["image_hash"].get<std::string>() << '\n';
    }
  }
}

} // namespace

int main(int argc, char** argv)
{
  const dsm::MpiTransport::Environment environment(argc, argv);
  auto transport = dsm::MpiTransport::Create(nullptr);
  dsm::Messenger messenger(
    transport ? std::move(transport) : std::move(dsm::LoopbackTransport::CreateGroup(1).front()));
  try
  {
    const std::string name = argc > 1 ? argv[1] : "";
    if (name == "isosurface")
    {
      RunIsosurface(BenchmarkOptions::Parse(argc, argv), messenger);
    }
    else if (name == "access")
    {
      AccessBenchmark::Run(AccessBenchmark::Parse(argc, argv), messenger);
    }
    else if (name == "mesh")
    {
      MeshBenchmark::Run(MeshBenchmark::Parse(argc, argv), messenger);
    }
    else
    {
      throw dsm::Error(std::string("The first argument names the benchmark.\n") +
        BenchmarkOptions::Usage() + AccessBenchmark::Usage() + MeshBenchmark::Usage());
    }
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
