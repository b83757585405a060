// SPDX-License-Identifier: BSD-3-Clause
#include "MediumBenchmark.h"

#include "BenchmarkCamera.h"
#include "BenchmarkVolume.h"
#include "MediumReference.h"
#include "PictureFile.h"

#include "DSMRayTracing/frame/FrameRenderer.h"

#include "tests/support/PictureHash.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <sstream>

namespace
{

using Json = nlohmann::ordered_json;

/// Pixels along each edge of the picture that is compared with the reference.
constexpr int ReferenceEdge = 128;

/// The frames of one medium in one store.
class MediumFrames
{
public:
  MediumFrames(const MediumBenchmark::Options& options, dsm::Messenger& messenger,
    dsm::BlockStore& store, const rt::LatticeField& field)
    : Settings(options)
    , Messenger(messenger)
    , Store(store)
    , Field(field)
    , Renderer(messenger)
    , Positions(GetPositions(options))
  {
    this->World.Lights.emplace_back();
    this->World.Transport = CreateTransport(options, field);
    this->World.Transport.MediumErrors = options.Errors;
  }

  void SetMedium(const std::shared_ptr<const rt::TransferFunction>& function, bool shade)
  {
    rt::LatticeMedium medium;
    medium.Field = this->Field;
    medium.Function = function;
    medium.Look.Shade = shade;
    this->World.Media.assign(1, medium);
  }

  /// Times all positions. Writes the picture of the first one if it has a file.
  Json Time(const std::string& picturePath)
  {
    std::vector<double> fastest(this->Positions.size(), std::numeric_limits<double>::infinity());
    double sum = 0.0;
    std::uint64_t hash = 0;
    for (int repetition = 0; repetition < this->Settings.Repeat; ++repetition)
    {
      for (std::size_t number = 0; number < this->Positions.size(); ++number)
      {
        const rt::Frame& frame =
          this->Trace(this->Positions[number], this->Settings.Width, this->Settings.Height);
        fastest[number] = std::min(fastest[number], frame.Seconds);
        sum += frame.Seconds;
        if (repetition > 0)
        {
          continue;
        }
        const rt::Picture picture = rt::GatherFrame(this->Messenger, frame);
        hash = hash * 0x100000001b3ull ^ GetPictureHash(picture);
        if (number == 0 && !picturePath.empty() && this->Messenger.GetRank() == 0)
        {
          WritePicture(picture, picturePath);
        }
      }
    }
    const double frames = static_cast<double>(this->Positions.size());
    const double seconds = std::accumulate(fastest.begin(), fastest.end(), 0.0) / frames;
    char hexadecimal[17];
    std::snprintf(
      hexadecimal, sizeof(hexadecimal), "%016llx", static_cast<unsigned long long>(hash));
    return { { "seconds", seconds }, { "mean_seconds", sum / frames / this->Settings.Repeat },
      { "rays_per_second", this->Settings.Width * this->Settings.Height / seconds },
      { "image_hash", hexadecimal } };
  }

  /// Collective.
  Json Compare(const MediumReference& reference, const MediumFunction& function)
  {
    const rt::Frame& frame = this->Trace(this->Positions.front(), ReferenceEdge, ReferenceEdge);
    MediumReference::Difference all;
    for (const auto& mine :
      this->Messenger.AllGatherValue(reference.Compare(frame, this->Request, function)))
    {
      all.Add(mine);
    }
    return { { "mean_difference", all.GetMean() }, { "largest_difference", all.Largest },
      { "pixels", all.Seen } };
  }

private:
  const rt::Frame& Trace(const Position& position, int width, int height)
  {
    const Camera camera = GetCamera(this->Field, static_cast<double>(width) / height, position);
    this->World.Lights.front() = CreateLamp(this->Settings, camera);
    this->Request = CreateRequest(this->Settings, camera);
    this->Request.Width = width;
    this->Request.Height = height;
    this->Last = this->Renderer.Render(this->Store, this->World, this->Request, &this->Last);
    return this->Last;
  }

  const MediumBenchmark::Options& Settings;
  dsm::Messenger& Messenger;
  dsm::BlockStore& Store;
  const rt::LatticeField& Field;
  rt::FrameRenderer Renderer;
  std::vector<Position> Positions;
  rt::Scene World;
  rt::FrameRequest Request;
  rt::Frame Last;
};

bool IsListed(const std::vector<std::string>& names, const std::string& name)
{
  return std::any_of(names.begin(), names.end(),
    [&](const std::string& listed) { return listed == name || listed == "all"; });
}

/// PATH.ppm becomes PATH.NAME.ppm.
std::string NamePicture(const std::string& path, const std::string& name)
{
  const std::size_t dot = std::min(path.rfind('.'), path.size());
  return path.empty() ? path : path.substr(0, dot) + "." + name + path.substr(dot);
}

} // namespace

void MediumBenchmark::Options::AddTo(CLI::App& app)
{
  app.add_option("--function", this->Functions, "shell, fog, ramp, with commas, or all (default)")
    ->delimiter(',')
    ->allow_extra_args(false)
    ->check(CLI::IsMember({ "shell", "fog", "ramp", "all" }));
  app.add_option("--shade", this->Shade, "on, off or both")
    ->capture_default_str()
    ->check(CLI::IsMember({ "on", "off", "both" }));
  app.add_option("--reference", this->Reference,
    "on: compares unshaded pictures of the first position, of 128x128 pixels, with sums of samples "
    "in double precision. Each rank holds the whole volume (default off)");
  app
    .add_option("--reference-steps", this->ReferenceSteps,
      "samples of these sums in a cell's edge. A peak of the opacity needs several samples where "
      "values change most")
    ->capture_default_str()
    ->check(CLI::PositiveNumber);
  app
    .add_option("--errors", this->Errors,
      "how much larger errors may be than those of a still picture. While the camera moves: 16")
    ->capture_default_str()
    ->check(CLI::PositiveNumber);
  this->VolumeOptions::AddTo(app);
  app.remove_option(app.get_option("--store"));
  app.add_option("--store", this->Stores, "with commas (default object)")
    ->delimiter(',')
    ->allow_extra_args(false)
    ->transform(CLI::CheckedTransformer(RunOptions::GetStores()));
}

void MediumBenchmark::Run(const Options& options, dsm::Messenger& messenger)
{
  const bool speaks = messenger.GetRank() == 0;
  dsm::BlockStore::Settings settings = options.CreateSettings(messenger);
  settings.MemoryBytes = options.Mebibytes << 20;
  const std::vector<bool> shades = options.Shade == "both"
    ? std::vector<bool>{ false, true }
    : std::vector<bool>(1, options.Shade == "on");
  std::optional<BenchmarkSamples> samples;
  std::optional<MediumReference> reference;
  if (options.Reference)
  {
    messenger.RunTogether("Reading the volume for the reference",
      [&] { samples = ReadBenchmarkSamples(options.Volume, settings.Workers); });
    reference.emplace(*samples, options.ReferenceSteps, settings.Workers);
  }
  Json result{ { "volume", options.Volume }, { "size", { options.Width, options.Height } },
    { "frames", GetPositions(options).size() }, { "repeat", options.Repeat },
    { "rank_count", messenger.GetSize() }, { "threads", settings.Workers },
    { "host_sharing", options.HostSharing }, { "media", Json::array() } };
  std::ostringstream text;
  for (const dsm::MemoryOrganization organization : options.Stores)
  {
    settings.Organization = organization;
    dsm::BlockStore store(messenger, settings);
    const rt::LatticeField field =
      PublishBenchmarkVolume(options.Volume, options.BrickEdge, settings.Workers, store, messenger)
        .Field;
    dsm::BlockStore::Settings cached = settings;
    cached.CacheBytes = static_cast<std::size_t>(
      options.CacheFraction * field.Voxels->Segment->GetDirectory().GetTotalBytes());
    store.SetSettings(cached);
    const double diagonal =
      glm::length(glm::dmat3(field.IndexToWorld) * glm::dvec3(field.Voxels->Lattice.GetCells()));
    MediumFrames frames(options, messenger, store, field);
    for (const auto& [name, kind] : MediumFunction::GetKinds())
    {
      if (!IsListed(options.Functions, name))
      {
        continue;
      }
      const MediumFunction function(
        kind, field.Voxels->Hierarchy.GetRange(), field.GetFinestLength());
      const auto integrated = function.Create(diagonal);
      for (const bool shade : shades)
      {
        frames.SetMedium(integrated, shade);
        const std::string place = std::string(dsm::GetText(store.GetOrganization()));
        Json medium{ { "function", name }, { "shade", shade }, { "store", place } };
        const std::string word = shade ? "shaded" : "unshaded";
        medium.update(frames.Time(NamePicture(options.Picture, name + "." + word)));
        text << options.Volume << ", " << name << ", " << word << ", " << place << ": "
             << medium["seconds"].get<double>() << " s a frame (mean "
             << medium["mean_seconds"].get<double>() << "), "
             << 1e-6 * medium["rays_per_second"].get<double>() << " million rays/s, picture "
             << medium["image_hash"].get<std::string>() << '\n';
        if (reference && !shade)
        {
          const Json difference = frames.Compare(*reference, function);
          text << "  beside the reference: differs by "
               << difference["mean_difference"].get<double>() << " on average, "
               << difference["largest_difference"].get<double>() << " at most, in 255ths\n";
          medium["reference"] = difference;
        }
        result["media"].push_back(medium);
      }
    }
    store.Retire(field.Voxels->Segment);
  }
  if (speaks)
  {
    RunOptions::Write(options.Json, result.dump(2), text.str());
  }
}
