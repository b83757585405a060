// SPDX-License-Identifier: BSD-3-Clause
// Pictures of all features are bit for bit those on record, whoever traces them and however bricks
// are kept.
//
//   scene_pictures FILE                 compares with the hashes in FILE: a line for each scene
//   scene_pictures FILE --vectors NAME  the same, on one rank, with the vectors that Highway calls
//                                       so; 77 when this processor does not have them
//   scene_pictures --record             prints the hashes
//   scene_pictures --show NAME FILE     writes the picture of a scene, on white, as a PPM file
//
// A hash is GetPictureHash: of the size, the 8-bit colors and the bits of the depths. What is traced
// is made of sums, products, quotients and roots alone, none of them contracted. Only colors use the
// mathematical library: pow (highlights, cones), log10 (color maps), sin and cos (directions of
// random light rays). The last bit of these may be another on another machine; colors are rounded
// to 8 bits, so that this all but never shows.
#include "tests/scenes/RecordedScenes.h"
#include "tests/support/LoopbackCluster.h"
#include "tests/support/PictureHash.h"

#include "DSMCore/base/Error.h"
#include "DSMRayTracing/field/lattice/PacketKernel.h"
#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/frame/FrameRenderer.h"
#include "DSMRayTracing/mesh/MeshKernel.h"

#include <hwy/targets.h>

#include <algorithm>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace
{

constexpr int Skipped = 77;

struct Keeping
{
  const char* Name;
  int Ranks = 1;
  int Workers = 1;
  dsm::MemoryOrganization Organization = dsm::MemoryOrganization::Replicated;
  bool HostSharing = false;
  rt::TileScheduling Scheduling = rt::TileScheduling::WorkStealing;
  std::size_t CacheBytes = std::size_t(16) << 20;
};

/// The first one is that on record.
const Keeping Keepings[] = {
  { "one rank" },
  { "2 ranks, object based", 2, 2, dsm::MemoryOrganization::ObjectBased, false,
    rt::TileScheduling::WorkStealing, std::size_t(48) << 10 },
  { "3 ranks, page based", 3, 1, dsm::MemoryOrganization::PageBased, false,
    rt::TileScheduling::CentralQueue },
  { "2 ranks, object based, host sharing", 2, 1, dsm::MemoryOrganization::ObjectBased, true,
    rt::TileScheduling::CentralQueue },
  { "3 ranks, replicated", 3, 2, dsm::MemoryOrganization::Replicated, false,
    rt::TileScheduling::WorkStealing },
};

/// The picture that every rank has.
rt::Picture Trace(const RecordedScene& scene, const Keeping& keeping)
{
  std::vector<rt::Picture> pictures(keeping.Ranks);
  RunOnCluster(keeping.Ranks,
    [&](dsm::Messenger& messenger)
    {
      dsm::BlockStore::Settings settings;
      settings.Organization = keeping.Organization;
      settings.CacheBytes = keeping.CacheBytes;
      settings.Workers = keeping.Workers;
      settings.HostSharing = keeping.HostSharing;
      dsm::BlockStore store(messenger, settings);
      SceneStage stage(messenger, store);
      scene.Build(stage);
      stage.Request.Scheduling = keeping.Scheduling;
      rt::FrameRenderer renderer(messenger);
      rt::Frame frame;
      for (const int samples : stage.SampleParts)
      {
        stage.Request.Samples = samples;
        if (stage.Request.FirstSample == 0)
        {
          frame = renderer.Render(store, stage.World, stage.Request);
        }
        else
        {
          renderer.Refine(store, stage.World, stage.Request, frame);
        }
        stage.Request.FirstSample += samples;
      }
      pictures[messenger.GetRank()] = rt::GatherFrame(messenger, frame);
    });
  for (const rt::Picture& picture : pictures)
  {
    if (GetPictureHash(picture) != GetPictureHash(pictures.front()))
    {
      throw dsm::Error("the ranks have different pictures");
    }
  }
  return pictures.front();
}

bool ShowsSomething(const rt::Picture& picture)
{
  return std::any_of(
    picture.Depth.begin(), picture.Depth.end(), [](float depth) { return depth < 1.0f; });
}

int Record()
{
  for (const RecordedScene& scene : CreateRecordedScenes())
  {
    const std::uint64_t hash = GetPictureHash(Trace(scene, Keepings[0]));
    std::printf("%s %016" PRIx64 "\n", scene.Name.c_str(), hash);
  }
  return 0;
}

int Show(const std::string& name, const char* path)
{
  for (const RecordedScene& scene : CreateRecordedScenes())
  {
    if (scene.Name == name)
    {
      const rt::Picture picture = Trace(scene, Keepings[0]);
      std::ofstream file(path, std::ios::binary);
      file << "P6\n" << picture.Width << " " << picture.Height << "\n255\n";
      for (int pixel = 0; pixel < picture.Width * picture.Height; ++pixel)
      {
        const int line = picture.Height - 1 - pixel / picture.Width;
        const std::uint8_t* const color =
          &picture.Color[4 * (std::size_t(line) * picture.Width + pixel % picture.Width)];
        for (int channel = 0; channel < 3; ++channel)
        {
          file.put(static_cast<char>(std::min(255, color[channel] + 255 - color[3])));
        }
      }
      return file.good() ? 0 : 1;
    }
  }
  std::fprintf(stderr, "There is no scene %s.\n", name.c_str());
  return 1;
}

std::map<std::string, std::uint64_t> ReadHashes(const char* path)
{
  std::map<std::string, std::uint64_t> hashes;
  std::ifstream file(path);
  std::string name;
  std::uint64_t hash = 0;
  while (file >> name >> std::hex >> hash)
  {
    hashes[name] = hash;
  }
  return hashes;
}

/// Counts and tells what is wrong.
class Report
{
public:
  void Fail(const std::string& scene, const std::string& what)
  {
    ++this->Failures;
    std::printf("FAILED %s: %s\n", scene.c_str(), what.c_str());
  }
  int GetFailures() const { return this->Failures; }

private:
  int Failures = 0;
};

void Compare(
  const RecordedScene& scene, const Keeping& keeping, std::uint64_t expected, Report& report)
{
  try
  {
    const rt::Picture picture = Trace(scene, keeping);
    const std::uint64_t hash = GetPictureHash(picture);
    if (hash != expected)
    {
      char text[100];
      std::snprintf(text, sizeof(text), "%016" PRIx64 " in place of %016" PRIx64, hash, expected);
      report.Fail(scene.Name, std::string("another picture (") + keeping.Name + "): " + text);
    }
    if (!ShowsSomething(picture) && scene.Name.rfind("empty.", 0) != 0)
    {
      report.Fail(scene.Name, std::string("nothing is seen (") + keeping.Name + ")");
    }
  }
  catch (const std::exception& error)
  {
    report.Fail(scene.Name, std::string(keeping.Name) + ": " + error.what());
  }
}

int CompareAll(const char* path, bool everyKeeping)
{
  Report report;
  std::map<std::string, std::uint64_t> hashes = ReadHashes(path);
  const std::vector<RecordedScene> scenes = CreateRecordedScenes();
  for (const RecordedScene& scene : scenes)
  {
    const auto entry = hashes.find(scene.Name);
    if (entry == hashes.end())
    {
      report.Fail(scene.Name, "is not on record, or stands twice");
      continue;
    }
    for (const Keeping& keeping : Keepings)
    {
      if (keeping.Ranks == 1 || (everyKeeping && !scene.ShowsRanks))
      {
        Compare(scene, keeping, entry->second, report);
      }
    }
    hashes.erase(entry);
  }
  for (const auto& entry : hashes)
  {
    report.Fail(entry.first, "is on record, but not a scene");
  }
  std::printf("%zu scenes, %d failures\n", scenes.size(), report.GetFailures());
  return report.GetFailures() == 0 && scenes.size() >= 200 ? 0 : 1;
}

/// Makes the tracers use those vectors; false when this processor has none such. Before anything is
/// traced.
bool UseVectors(const std::string& name)
{
  for (const auto target : hwy::SupportedAndGeneratedTargets())
  {
    if (name == hwy::TargetName(target))
    {
      hwy::SetSupportedTargetsForTest(target);
      hwy::GetChosenTarget().Update(target);
      if (name != rt::PacketKernel::GetBest().Name || name != rt::MeshKernel::GetBest().Name)
      {
        throw dsm::Error("the tracers do not use the vectors " + name);
      }
      return true;
    }
  }
  return false;
}

} // namespace

int main(int argc, char** argv)
{
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.size() == 1 && arguments[0] == "--record")
  {
    return Record();
  }
  if (arguments.size() == 3 && arguments[1] == "--vectors")
  {
    if (!UseVectors(arguments[2]))
    {
      std::printf("skipped: there are no vectors %s\n", arguments[2].c_str());
      return Skipped;
    }
    return CompareAll(argv[1], false);
  }
  if (arguments.size() == 1)
  {
    return CompareAll(argv[1], true);
  }
  if (arguments.size() == 3 && arguments[0] == "--show")
  {
    return Show(arguments[1], argv[3]);
  }
  std::fprintf(
    stderr, "usage: scene_pictures FILE [--vectors NAME] | --record | --show NAME FILE\n");
  return 2;
}
