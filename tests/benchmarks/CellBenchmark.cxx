// SPDX-License-Identifier: BSD-3-Clause
#include "CellBenchmark.h"

#include "BenchmarkCamera.h"
#include "MediumFunction.h"
#include "PictureFile.h"

#include "DSMBricks/cells/PointGradients.h"
#include "DSMBricks/cells/PublishCells.h"
#include "DSMBricks/cells/SharedPlaces.h"
#include "DSMBricks/layout/PlaceInBrick.h"
#include "DSMRayTracing/frame/FrameRenderer.h"

#include "tests/support/CellModel.h"
#include "tests/support/PictureHash.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <sstream>

namespace
{

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

double GetSecondsSince(Clock::time_point begin)
{
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Waves whose surfaces fill the picture.
double Evaluate(const glm::dvec3& place)
{
  const glm::dvec3 way = place - 0.5;
  return glm::length(way) +
    0.05 * std::sin(20.0 * place.x) * std::sin(17.0 * place.y) * std::sin(23.0 * place.z);
}

/// The unit cube, bent inside.
glm::dvec3 Move(const glm::dvec3& place)
{
  const glm::dvec3 inside = place * (1.0 - place);
  const double bend = inside.x * inside.y * inside.z;
  return place + bend * glm::dvec3(std::sin(7.0 * place.y), 0.8, std::cos(5.0 * place.x));
}

CellModel::Settings CreateModel(
  const std::string& kind, std::uint64_t cells, dsm::Messenger& messenger)
{
  const double each = kind == "tetrahedra" ? 6.0 : kind == "mixed" ? 3.75 : 1.0;
  CellModel::Settings settings;
  settings.Boxes = bricks::Index3(std::llround(std::cbrt(static_cast<double>(cells) / each)));
  settings.Move = Move;
  settings.IsGrid = kind == "grid";
  settings.OnlyTetrahedra = kind == "tetrahedra";
  settings.KindOf = [kind](const bricks::Index3& box)
  {
    return kind == "tetrahedra" ? CellModel::Kind::Tetrahedra
      : kind == "mixed"         ? static_cast<CellModel::Kind>((box.x + box.y + box.z) % 4)
                                : CellModel::Kind::Hexahedron;
  };
  // Slabs of boxes.
  const std::int64_t size = messenger.GetSize();
  settings.IsOwn = [slabs = settings.Boxes.z, size, rank = messenger.GetRank()](
                     const bricks::Index3& box) { return box.z * size / slabs == rank; };
  return settings;
}

class CellFrames
{
public:
  CellFrames(
    const CellBenchmark::Options& options, dsm::Messenger& messenger, dsm::BlockStore& store)
    : Settings(options)
    , Messenger(messenger)
    , Store(store)
    , Renderer(messenger)
  {
  }

  Json Publish(const std::string& kind)
  {
    const CellModel model(CreateModel(kind, this->Settings.Cells, this->Messenger));
    bricks::SortedBrickSettings sorting;
    sorting.BrickBytes = std::uint32_t(64) << 10;
    sorting.Threads = this->Store.GetSettings().Workers;
    constexpr auto place = dsm::BlockStore::Place::Memory;
    bricks::CornerRoutes routes;
    auto begin = Clock::now();
    const auto cells =
      bricks::PublishCells("cells", model, sorting, this->Store, this->Messenger, place, routes);
    const double sorted = GetSecondsSince(begin);
    const auto getValue = [&](std::uint64_t point) { return Evaluate(model.GetPlaces()[point]); };
    begin = Clock::now();
    std::vector<bricks::PackedGradient> gradients;
    if (this->Settings.Gradients)
    {
      const auto getPlace = [&](std::uint64_t point, float place[3])
      {
        double position[3];
        model.GetPosition(point, position);
        return bricks::PlaceInBrick(*cells, position, place);
      };
      const bricks::SharedPlaces places(
        "places", model.GetPointCount(), getPlace, sorting.Threads, this->Messenger);
      gradients = bricks::FindPointGradients(
        "gradients", model, *cells, places, getValue, sorting.Threads, this->Messenger);
    }
    const double derived = GetSecondsSince(begin);
    begin = Clock::now();
    const auto values = bricks::PublishCellValues("values", cells, routes, getValue, gradients,
      sorting.Threads, this->Store, this->Messenger, place);
    const double filled = GetSecondsSince(begin);
    this->Field.Voxels = values;
    const auto count = static_cast<double>(cells->Cells);
    const auto bytesOf = [&](const dsm::BlockSegment& segment)
    { return static_cast<double>(segment.GetDirectory().GetTotalBytes()) / count; };
    return { { "kind", kind }, { "cells", cells->Cells },
      { "bricks", cells->Segment->GetDirectory().GetCount() }, { "sorting_seconds", sorted },
      { "gradients_seconds", derived }, { "values_seconds", filled },
      { "cell_bytes", bytesOf(*cells->Segment) }, { "value_bytes", bytesOf(*values->Segment) },
      { "index_bytes",
        static_cast<double>(cells->GetBytes() + values->Hierarchy.GetBytes()) / count } };
  }

  void Retire()
  {
    this->Store.Retire(this->Field.Voxels->Segment);
    this->Store.Retire(this->Field.Voxels->Cells->Segment);
    this->Field.Voxels.reset();
  }

  Json Time(const std::string& show)
  {
    rt::Scene scene;
    scene.Lights.emplace_back();
    if (show == "surface")
    {
      rt::IsosurfaceOf<rt::CellField> surface;
      surface.Field = this->Field;
      surface.Isovalues = { this->Settings.Isovalue };
      scene.Objects = { surface };
    }
    else
    {
      rt::MediumOf<rt::CellField> medium;
      medium.Field = this->Field;
      medium.Function = MediumFunction(MediumFunction::GetKinds().at(show),
        this->Field.Voxels->Hierarchy.GetRange(), this->Field.GetFinestLength())
                          .Create(2.0);
      scene.Media = { medium };
    }
    RunOptions const& run = this->Settings;
    rt::FrameRequest request;
    request.Width = run.Width;
    request.Height = run.Height;
    request.Scheduling = run.Scheduling;
    double sum = 0.0;
    std::uint64_t hash = 0;
    for (int frame = 0; frame < run.Frames; ++frame)
    {
      double fastest = std::numeric_limits<double>::infinity();
      Position position;
      position.Azimuth = 360.0 * frame / run.Frames + 25.0;
      const Camera camera = GetCamera(
        glm::dvec3(0.5), glm::dvec3(0.5), static_cast<double>(run.Width) / run.Height, position);
      request.WorldToClip = camera.WorldToClip;
      scene.Lights.front().Direction = camera.ViewDirection;
      for (int repetition = 0; repetition < run.Repeat; ++repetition)
      {
        this->Last = this->Renderer.Render(this->Store, scene, request, &this->Last);
        fastest = std::min(fastest, this->Last.Seconds);
      }
      const rt::Picture picture = rt::GatherFrame(this->Messenger, this->Last);
      hash = hash * 0x100000001b3ull ^ GetPictureHash(picture);
      if (frame == 0 && !this->Settings.Picture.empty() && this->Messenger.GetRank() == 0)
      {
        WritePicture(picture, this->Settings.Picture);
      }
      sum += fastest;
    }
    const double seconds = sum / run.Frames;
    return { { "show", show }, { "seconds", seconds },
      { "rays_per_second", run.Width * run.Height / seconds }, { "image_hash", hash } };
  }

private:
  const CellBenchmark::Options& Settings;
  dsm::Messenger& Messenger;
  dsm::BlockStore& Store;
  rt::FrameRenderer Renderer;
  rt::CellField Field;
  rt::Frame Last;
};

} // namespace

void CellBenchmark::Options::AddTo(CLI::App& app)
{
  app
    .add_option("--kinds", this->Kinds, "tetrahedra (default), hexahedra, mixed, grid, with commas")
    ->delimiter(',')
    ->allow_extra_args(false)
    ->check(CLI::IsMember({ "tetrahedra", "hexahedra", "mixed", "grid" }));
  app.add_option("--cells", this->Cells, "about so many")->capture_default_str();
  app.add_option("--show", this->Shows, "surface (default), shell, fog, ramp, with commas")
    ->delimiter(',')
    ->allow_extra_args(false)
    ->check(CLI::IsMember({ "surface", "shell", "fog", "ramp" }));
  app.add_option("--isovalue", this->Isovalue, "from 0 to 0.8")->capture_default_str();
  app.add_option("--gradients", this->Gradients,
    "off: surfaces are shaded by the planes of tetrahedra (default on)");
  app.add_option("--picture", this->Picture, "writes the first picture to a file (.ppm)");
  this->RunOptions::AddTo(app);
}

void CellBenchmark::Run(const Options& options, dsm::Messenger& messenger)
{
  const dsm::BlockStore::Settings settings = options.CreateSettings(messenger);
  dsm::BlockStore store(messenger, settings);
  Json result = Json::array();
  std::ostringstream text;
  for (const std::string& kind : options.Kinds)
  {
    CellFrames frames(options, messenger, store);
    Json cells = frames.Publish(kind);
    text << kind << ": " << cells["cells"].get<std::uint64_t>() << " cells in "
         << cells["bricks"].get<std::uint64_t>() << " bricks, " << cells["cell_bytes"].get<double>()
         << " + " << cells["value_bytes"].get<double>() << " + "
         << cells["index_bytes"].get<double>() << " bytes a cell, sorted in "
         << cells["sorting_seconds"].get<double>() << " s, gradients in "
         << cells["gradients_seconds"].get<double>() << " s, values in "
         << cells["values_seconds"].get<double>() << " s\n";
    for (const std::string& show : options.Shows)
    {
      const Json shown = frames.Time(show);
      text << "  " << show << ": " << shown["seconds"].get<double>() << " s a frame, "
           << 1e-6 * shown["rays_per_second"].get<double>() << " million rays/s, picture "
           << std::hex << shown["image_hash"].get<std::uint64_t>() << std::dec << '\n';
      cells["shown"].push_back(shown);
    }
    frames.Retire();
    result.push_back(cells);
  }
  if (messenger.GetRank() == 0)
  {
    RunOptions::Write(options.Json, result.dump(2), text.str());
  }
}
