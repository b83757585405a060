// SPDX-License-Identifier: BSD-3-Clause
#include "MeshBenchmark.h"

#include "DSMCore/store/BlockStore.h"
#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/frame/FrameRenderer.h"
#include "DSMRayTracing/frame/PixelRays.h"
#include "DSMRayTracing/mesh/MeshSearch.h"

#include "tests/support/PictureHash.h"
#ifdef DSM_HAS_EMBREE
#include "EmbreeMesh.h"
#endif

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <fstream>
#include <functional>
#include <iomanip>
#include <iostream>
#include <map>
#include <optional>
#include <thread>
#include <utility>

namespace
{

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;
using Order = BenchmarkMesh::Order;

const std::map<std::string, Order> OrdersByName{ { "sorted", Order::Sorted },
  { "original", Order::Original }, { "random", Order::Random } };

[[maybe_unused]] double SecondsSince(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

const std::string& GetText(Order order)
{
  return std::find_if(OrdersByName.begin(), OrdersByName.end(),
    [=](const auto& entry) { return entry.second == order; })
    ->first;
}

/// A camera around the mesh, 20 degrees above, near enough that the mesh fills the picture.
struct Orbit
{
  glm::dvec3 Center;
  double Radius;

  explicit Orbit(const bricks::TriangleMesh& mesh)
    : Center(0.5 * (mesh.Lower + mesh.Upper) + mesh.Origin)
    , Radius(0.5 * glm::length(mesh.Upper - mesh.Lower))
  {
  }

  rt::FrameRequest GetRequest(const MeshBenchmark::Options& options, int position) const
  {
    const double azimuth = glm::radians(options.Arc) * position / options.Frames;
    const double elevation = glm::radians(20.0);
    const double distance = 3.2 * this->Radius;
    const glm::dvec3 outward(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
      std::cos(elevation) * std::cos(azimuth));
    rt::FrameRequest request;
    request.Width = options.Width;
    request.Height = options.Height;
    request.WorldToClip =
      glm::perspective(glm::radians(30.0), static_cast<double>(options.Width) / options.Height,
        distance - 1.01 * this->Radius, distance + 1.01 * this->Radius) *
      glm::lookAt(this->Center + distance * outward, this->Center, glm::dvec3(0.0, 1.0, 0.0));
    return request;
  }
};

/// What a set of frames did, over all ranks.
struct FrameResult
{
  double Seconds = 0.0; ///< of all positions, the fastest of each
  std::uint64_t Accesses = 0;
  std::uint64_t Misses = 0;
  std::uint64_t Hash = 0;
};

FrameResult TraceFrames(const MeshBenchmark::Options& options,
  const std::shared_ptr<const bricks::TriangleMesh>& mesh, dsm::BlockStore& store,
  dsm::Messenger& messenger)
{
  rt::Scene scene;
  scene.Lights.emplace_back();
  rt::MeshObject object;
  object.Instance = std::make_shared<rt::MeshInstance>(mesh, glm::dmat4(1.0));
  scene.Objects.push_back(object);
  const Orbit orbit(*mesh);
  rt::FrameRenderer renderer(messenger);
  rt::Frame frame;
  FrameResult result;
  std::vector<double> fastest(options.Frames, 1e300);
  struct Counts
  {
    std::uint64_t Accesses = 0;
    std::uint64_t Misses = 0;
  };
  Counts mine;
  for (int repeat = 0; repeat < options.Repeat; ++repeat)
  {
    mine = {};
    for (int position = 0; position < options.Frames; ++position)
    {
      frame = renderer.Render(store, scene, orbit.GetRequest(options, position), &frame);
      fastest[position] = std::min(fastest[position], frame.Seconds);
      mine.Accesses += frame.Counters.Workers.Accesses;
      mine.Misses += frame.Counters.Workers.Misses;
      if (repeat == 0)
      {
        result.Hash =
          result.Hash * 0x100000001b3ull ^ GetPictureHash(rt::GatherFrame(messenger, frame));
      }
    }
  }
  for (const Counts& counts : messenger.AllGatherValue(mine))
  {
    result.Accesses += counts.Accesses;
    result.Misses += counts.Misses;
  }
  for (const double seconds : fastest)
  {
    result.Seconds += seconds;
  }
  return result;
}

#ifdef DSM_HAS_EMBREE

/// What tracing a ray through every pixel took. `start(worker)` gives what finds the hits of a box of 8 x 8 pixels, in
/// blocks of 4 x 4, for a worker: rt::RayMask(const rt::Ray*, rt::RayMask wanted, double* t).
struct RayResult
{
  double Seconds = 0.0;
  /// Of processor, all threads together: other programs of the machine count less.
  double ProcessorSeconds = 0.0;
  std::uint64_t Hits = 0;
  double Sum = 0.0; ///< of T

  /// Adds a position, whose `rounds` all gave the same hits.
  void AddFastest(const std::vector<RayResult>& rounds)
  {
    const auto lowest = [&](double RayResult::*member)
    {
      double value = 1e300;
      for (const RayResult& round : rounds)
      {
        value = std::min(value, round.*member);
      }
      return value;
    };
    this->Seconds += lowest(&RayResult::Seconds);
    this->ProcessorSeconds += lowest(&RayResult::ProcessorSeconds);
    this->Hits += rounds.front().Hits;
    this->Sum += rounds.front().Sum;
  }
};

double GetProcessorSeconds()
{
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

template <class Start>
RayResult TraceRays(const MeshBenchmark::Options& options, const Orbit& orbit, int threads,
  int position, const Start& start)
{
  const rt::FrameRequest request = orbit.GetRequest(options, position);
  const rt::PixelRays pixels(request);
  std::vector<RayResult> results(threads);
  std::atomic<int> next{ 0 };
  constexpr int tileEdge = 16;
  constexpr int boxEdge = 8;
  constexpr int blockEdge = 4;
  const int columns = (request.Width + tileEdge - 1) / tileEdge;
  const int tiles = columns * ((request.Height + tileEdge - 1) / tileEdge);
  const auto traceBox = [&](auto& intersect, int left, int bottom, RayResult& result)
  {
    rt::Ray rays[rt::MaxRays];
    double t[rt::MaxRays];
    rt::RayMask wanted = 0;
    for (int index = 0; index < rt::MaxRays; ++index)
    {
      const int block = index / (blockEdge * blockEdge);
      const int pixel = index % (blockEdge * blockEdge);
      constexpr int blocks = boxEdge / blockEdge;
      const int x = left + block % blocks * blockEdge + pixel % blockEdge;
      const int y = bottom + block / blocks * blockEdge + pixel / blockEdge;
      if (x < request.Width && y < request.Height)
      {
        rays[index] = pixels.GetRay(x, y);
        wanted |= rt::GetBit(index);
      }
    }
    rt::ForEachRay(intersect(rays, wanted, t),
      [&](int index)
      {
        ++result.Hits;
        result.Sum += t[index];
      });
  };
  const auto work = [&](int worker)
  {
    auto&& intersect = start(worker);
    RayResult mine;
    const double begin = GetProcessorSeconds();
    for (int tile = next++; tile < tiles; tile = next++)
    {
      for (int box = 0; box < tileEdge * tileEdge / (boxEdge * boxEdge); ++box)
      {
        constexpr int across = tileEdge / boxEdge;
        traceBox(intersect, tile % columns * tileEdge + box % across * boxEdge,
          tile / columns * tileEdge + box / across * boxEdge, mine);
      }
    }
    mine.ProcessorSeconds = GetProcessorSeconds() - begin;
    results[worker] = mine;
  };
  const auto begin = Clock::now();
  std::vector<std::thread> workers;
  for (int worker = 0; worker < threads; ++worker)
  {
    workers.emplace_back(work, worker);
  }
  for (std::thread& worker : workers)
  {
    worker.join();
  }
  RayResult result;
  result.Seconds = SecondsSince(begin);
  for (const RayResult& one : results)
  {
    result.ProcessorSeconds += one.ProcessorSeconds;
    result.Hits += one.Hits;
    result.Sum += one.Sum;
  }
  return result;
}

/// Finds the hits of rays one by one; `intersect` is bool(const rt::Ray&, double& t).
template <class Intersect>
rt::RayMask TraceOneByOne(
  const rt::Ray* rays, rt::RayMask wanted, double* t, const Intersect& intersect)
{
  return rt::FindRays(wanted, [&](int index) { return intersect(rays[index], t[index]); });
}

/// One rank has all bricks, so nothing needs to be served.
template <class Store>
RayResult TraceOwnRays(const MeshBenchmark::Options& options, const Orbit& orbit, int threads,
  int position, const rt::MeshInstance& instance, bool together, Store& store)
{
  struct Session
  {
    Session(Store& blocks, int worker)
      : Blocks(blocks)
      , Self(blocks.GetWorker(worker))
    {
      this->Blocks.Enter(this->Self);
    }
    ~Session() { this->Blocks.Leave(this->Self); }
    Store& Blocks;
    typename Store::Worker& Self;
  };
  store.BeginFrame();
  const RayResult result = TraceRays(options, orbit, threads, position,
    [&](int worker)
    {
      auto session = std::make_shared<Session>(store, worker);
      return [session, tracer = rt::MeshSearch<Store>(store, session->Self), &instance, together](
               const rt::Ray* rays, rt::RayMask wanted, double* t)
      {
        if (!together)
        {
          return TraceOneByOne(rays, wanted, t,
            [&](const rt::Ray& ray, double& at)
            {
              rt::MeshHit hit;
              const bool found = tracer.Intersect(instance, ray, hit);
              at = hit.T;
              return found;
            });
        }
        return tracer.Intersect(instance, rays, wanted,
          [=](int index, double at) -> rt::MeshHit*
          {
            t[index] = at;
            return nullptr;
          });
      };
    });
  store.EndFrame();
  return result;
}

Json CompareWithEmbree(const MeshBenchmark::Options& options, const MeshFile::Mesh& triangles,
  const std::shared_ptr<const bricks::TriangleMesh>& mesh, double buildSeconds, int threads,
  dsm::BlockStore& store)
{
  const EmbreeMesh embree(triangles, threads);
  const rt::MeshInstance instance(mesh, glm::dmat4(1.0));
  const Orbit orbit(*mesh);
  // In turn, so that a change of the machine's load meets all alike.
  const std::pair<const char*, std::function<RayResult(int)>> tracers[] = {
    { "packets",
      [&](int position)
      {
        return store.Visit([&](auto& blocks)
          { return TraceOwnRays(options, orbit, threads, position, instance, true, blocks); });
      } },
    { "single_rays",
      [&](int position)
      {
        return store.Visit([&](auto& blocks)
          { return TraceOwnRays(options, orbit, threads, position, instance, false, blocks); });
      } },
    { "embree_packets",
      [&](int position)
      {
        return TraceRays(options, orbit, threads, position,
          [&](int)
          {
            return [&](const rt::Ray* rays, rt::RayMask wanted, double* t)
            { return embree.IntersectPackets(rays, wanted, t); };
          });
      } },
    { "embree_single_rays",
      [&](int position)
      {
        return TraceRays(options, orbit, threads, position,
          [&](int)
          {
            return [&](const rt::Ray* rays, rt::RayMask wanted, double* t)
            {
              return TraceOneByOne(rays, wanted, t,
                [&](const rt::Ray& ray, double& at) { return embree.Intersect(ray, at); });
            };
          });
      } },
  };
  std::map<std::string, RayResult> results;
  for (int position = 0; position < options.Frames; ++position)
  {
    std::map<std::string, std::vector<RayResult>> rounds;
    for (int repeat = 0; repeat < options.Repeat; ++repeat)
    {
      for (const auto& [name, trace] : tracers)
      {
        rounds[name].push_back(trace(position));
      }
    }
    for (const auto& [name, round] : rounds)
    {
      results[name].AddFastest(round);
    }
  }
  const double rays = static_cast<double>(options.Width) * options.Height * options.Frames;
  const auto getRatio = [&](const char* theirs, double RayResult::*seconds, const RayResult& mine)
  { return results.at(theirs).*seconds / (mine.*seconds); };
  Json compared{ { "embree", EmbreeMesh::GetVersion() } };
  for (const auto& [name, trace] : tracers)
  {
    const RayResult& result = results.at(name);
    compared[name] = { { "rays_per_second", rays / result.Seconds },
      { "rays_per_processor_second", rays / result.ProcessorSeconds }, { "hits", result.Hits },
      { "mean_distance", result.Sum / static_cast<double>(result.Hits) },
      { "ratio", getRatio("embree_single_rays", &RayResult::Seconds, result) },
      { "processor_ratio", getRatio("embree_single_rays", &RayResult::ProcessorSeconds, result) },
      { "packet_ratio", getRatio("embree_packets", &RayResult::Seconds, result) },
      { "packet_processor_ratio",
        getRatio("embree_packets", &RayResult::ProcessorSeconds, result) } };
  }
  compared["build_seconds"] = buildSeconds;
  compared["embree_build_seconds"] = embree.GetBuildSeconds();
  compared["build_ratio"] = buildSeconds / embree.GetBuildSeconds();
  return compared;
}

#endif

} // namespace

void MeshBenchmark::Options::AddTo(CLI::App& app)
{
  app.add_option("--mesh", this->Mesh, "grid:N (2 N^2 triangles), or a PLY or OBJ file")
    ->capture_default_str();
  app.add_option("--subdivide", this->Subdivisions, "times that each triangle becomes four")
    ->capture_default_str()
    ->check(CLI::NonNegativeNumber);
  app.add_option("--arc", this->Arc, "degrees of the way around the mesh")
    ->capture_default_str()
    ->check(CLI::NonNegativeNumber);
  app
    .add_option("--order", this->Orders,
      "how triangles share bricks, with commas (default sorted). A ray must visit nearly all "
      "bricks of a mesh in random order, so take a small one")
    ->delimiter(',')
    ->allow_extra_args(false)
    ->transform(CLI::CheckedTransformer(OrdersByName));
  app
    .add_option("--cache-fraction", this->CacheFractions,
      "caches per rank, as parts of the bytes of all bricks, with commas (default 1)")
    ->delimiter(',')
    ->allow_extra_args(false)
    ->check(CLI::NonNegativeNumber);
  this->RunOptions::AddTo(app);
}

void MeshBenchmark::Run(const Options& options, dsm::Messenger& messenger)
{
  const bool speaks = messenger.GetRank() == 0;
  dsm::BlockStore::Settings settings = options.CreateSettings(messenger);
  const int threads = settings.Workers;
  dsm::BlockStore store(messenger, settings);
  std::optional<BenchmarkMesh> source;
  messenger.RunTogether(
    "Reading the mesh", [&] { source.emplace(options.Mesh, options.Subdivisions); });

  Json result{ { "mesh", options.Mesh }, { "subdivisions", options.Subdivisions },
    { "triangles", source->GetTriangles().GetTriangleCount() },
    { "size", { options.Width, options.Height } }, { "frames", options.Frames },
    { "arc", options.Arc }, { "repeat", options.Repeat }, { "rank_count", messenger.GetSize() },
    { "threads", threads }, { "host_sharing", options.HostSharing }, { "orders", Json::array() } };
  std::ostringstream silence;
  std::ostream& table = speaks && options.Json != "-" ? std::cout : silence;
  table << std::fixed;
  for (const Order order : options.Orders)
  {
    double seconds = 0.0;
    const auto mesh = source->Publish(order, threads, store, messenger, seconds);
    const double bytes = static_cast<double>(mesh->Segment->GetDirectory().GetTotalBytes());
    const double each =
      (bytes + static_cast<double>(mesh->Bricks.GetBytes())) / static_cast<double>(mesh->Triangles);
    Json ofOrder{ { "order", GetText(order) },
      { "bricks", mesh->Segment->GetDirectory().GetCount() }, { "build_seconds", seconds },
      { "bytes_per_triangle", each }, { "caches", Json::array() } };
    table << options.Mesh << ", " << mesh->Triangles << " triangles, " << GetText(order) << ": "
          << std::setprecision(1) << each << " bytes a triangle, built in " << std::setprecision(2)
          << seconds << " s\n";
    for (const double fraction : options.CacheFractions)
    {
      settings.CacheBytes = static_cast<std::size_t>(fraction * bytes);
      store.SetSettings(settings);
      const FrameResult frames = TraceFrames(options, mesh, store, messenger);
      const double framesPerSecond = options.Frames / frames.Seconds;
      char hash[17];
      std::snprintf(hash, sizeof(hash), "%016llx", static_cast<unsigned long long>(frames.Hash));
      ofOrder["caches"].push_back(
        { { "cache_fraction", fraction }, { "frames_per_second", framesPerSecond },
          { "accesses", frames.Accesses }, { "misses", frames.Misses }, { "image_hash", hash } });
      table << "  cache " << std::setprecision(2) << fraction << ": " << framesPerSecond
            << " frames/s, " << frames.Accesses / options.Frames << " accesses and "
            << frames.Misses / options.Frames << " misses a frame, picture " << hash << std::endl;
    }
#ifdef DSM_HAS_EMBREE
    if (messenger.GetSize() == 1)
    {
      const Json peer =
        CompareWithEmbree(options, source->GetTriangles(), mesh, seconds, threads, store);
      ofOrder["peer"] = peer;
      const auto write = [&](const char* name)
      {
        table << "  " << name << ": " << std::setprecision(2)
              << 1e-6 * peer[name]["rays_per_second"].get<double>() << " million/s, "
              << 1e-6 * peer[name]["rays_per_processor_second"].get<double>()
              << " a processor second: " << peer[name]["ratio"].get<double>() << " and "
              << peer[name]["processor_ratio"].get<double>() << " of Embree's single rays, "
              << peer[name]["packet_ratio"].get<double>() << " and "
              << peer[name]["packet_processor_ratio"].get<double>() << " of its packets\n";
      };
      write("packets");
      write("single_rays");
      write("embree_packets");
      write("embree_single_rays");
      table << "  building took " << peer["build_ratio"].get<double>() << " x as long\n";
    }
#endif
    result["orders"].push_back(ofOrder);
    result["store"] = dsm::GetText(store.GetOrganization());
    store.Retire(mesh->Segment);
  }
  if (speaks && options.Json == "-")
  {
    std::cout << result.dump(2) << std::endl;
  }
  else if (speaks && !options.Json.empty())
  {
    std::ofstream(options.Json) << result.dump(2) << '\n';
  }
}
