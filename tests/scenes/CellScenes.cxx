// SPDX-License-Identifier: BSD-3-Clause
#include "tests/scenes/SceneParts.h"
#include "tests/support/PublishedCells.h"

#include <cmath>

using namespace SceneParts;

namespace
{

using bricks::Index3;
using Kind = CellModel::Kind;

/// How the cells of a model lie, with the same bits on every machine.
enum class Shape
{
  Bent,    ///< a block that is bent inside
  Stepped, ///< with cells of no height, and of no extent
  Globe    ///< a shell, closed, with poles in which a layer's points meet
};

/// In [-1, 1]^3.
glm::dvec3 MovePlace(Shape shape, const glm::dvec3& place)
{
  switch (shape)
  {
    case Shape::Bent:
    {
      const glm::dvec3 inside = place * (1.0 - place);
      const double bend = 8.0 * inside.x * inside.y * inside.z;
      return 2.0 * place - 1.0 + bend * glm::dvec3(place.y - 0.4, 0.5 - place.z, 0.3);
    }
    case Shape::Stepped:
    {
      const double height = std::max(place.z - 0.3, 0.0) / 0.7;
      const double narrow = place.x < 0.5 ? std::max(0.2 - place.y, 0.0) : place.y;
      return 2.0 * glm::dvec3(place.x, 0.5 * (place.y + narrow), height) - 1.0;
    }
    case Shape::Globe:
    {
      // Rational circles; the last meridian is the first one.
      const auto turn = [](double part)
      {
        const double half = 2.0 * (2.0 * part - std::floor(2.0 * part)) - 1.0;
        const double scale = 1.0 / (1.0 + half * half);
        const glm::dvec2 ofHalf(2.0 * half * scale, (1.0 - half * half) * scale);
        return part - std::floor(part) < 0.5 ? ofHalf : -ofHalf;
      };
      const glm::dvec2 around = turn(place.x);
      const bool isPole = place.y <= 0.0 || place.y >= 1.0;
      const glm::dvec2 up = turn(0.5 * place.y);
      const double radius = 0.55 + 0.45 * place.z;
      return radius *
        glm::dvec3(isPole ? 0.0 : up.y * around.x, isPole ? (place.y > 0.5 ? 1.0 : -1.0) : up.x,
          isPole ? 0.0 : up.y * around.y);
    }
  }
  return place;
}

struct CellOptions
{
  Shape Place = Shape::Bent;
  bool IsGrid = false;
  bool OnlyTetrahedra = false;
  bool IsMixed = true;
  bool HasHoles = false;
  unsigned Seed = 1;
};

/// Boxes are dealt to the ranks in turn.
rt::CellField PublishCellField(SceneStage& stage, const CellOptions& options)
{
  dsm::Messenger& messenger = stage.GetMessenger();
  CellModel::Settings settings;
  settings.Boxes = options.Place == Shape::Globe ? Index3(16, 9, 5) : Index3(11, 9, 10);
  settings.Move = [shape = options.Place](const glm::dvec3& place)
  { return MovePlace(shape, place); };
  settings.IsGrid = options.IsGrid;
  settings.OnlyTetrahedra = options.OnlyTetrahedra;
  settings.KindOf = [=](const Index3& box)
  {
    return options.OnlyTetrahedra ? Kind::Tetrahedra
      : options.IsMixed           ? static_cast<Kind>((box.x + 3 * box.y + 2 * box.z) % 4)
                                  : Kind::Hexahedron;
  };
  settings.IsOwn = [&, hasHoles = options.HasHoles](const Index3& box)
  {
    const bool isThere = !hasHoles || (5 * box.x + 3 * box.y + 7 * box.z) % 11 > 1;
    return isThere && (box.x / 3 + box.y / 2 + box.z) % messenger.GetSize() == messenger.GetRank();
  };
  rt::CellField field;
  field.Voxels = PublishCellModel(
    CellModel(std::move(settings)),
    [seed = options.Seed](const glm::dvec3& p)
    { return 100.0 * Generated::Noise(2.9 * p.x, 2.7 * p.y, 3.1 * p.z, seed); },
    messenger, stage.GetStore(), 4096);
  return field;
}

rt::IsosurfaceOf<rt::CellField> CreateCellSurface(
  SceneStage& stage, const CellOptions& options, const std::vector<double>& isovalues)
{
  rt::IsosurfaceOf<rt::CellField> object;
  object.Field = PublishCellField(stage, options);
  object.Isovalues = isovalues;
  object.Look.Surface.DiffuseColor = { 0.5f, 0.8f, 0.6f };
  return object;
}

CellOptions OfShape(Shape shape, bool isGrid = false)
{
  CellOptions options;
  options.Place = shape;
  options.IsGrid = isGrid;
  return options;
}

void AddCellSurfaces(Scenes& scenes)
{
  for (const auto& [name, camera] : Cameras)
  {
    scenes.push_back({ std::string("cells.Mixed.") + name,
      [camera = camera](SceneStage& stage)
      {
        stage.LookFrom(camera);
        stage.Add(CreateCellSurface(stage, CellOptions(), { 40.0, 60.0 }));
      } });
  }
  const auto add = [&](const char* name, const CellOptions& options, float opacity)
  {
    scenes.push_back({ std::string("cells.") + name,
      [=](SceneStage& stage)
      {
        auto object = CreateCellSurface(stage, options, { 42.0, 58.0 });
        object.Look.Surface.Opacity = opacity;
        stage.Add(std::move(object));
      } });
  };
  CellOptions tetrahedra;
  tetrahedra.OnlyTetrahedra = true;
  add("Tetrahedra", tetrahedra, 1.0f);
  CellOptions holes;
  holes.HasHoles = true;
  add("Holes", holes, 0.6f);
  holes.IsGrid = true;
  add("Grid.Holes", holes, 0.6f);
  CellOptions hexahedra;
  hexahedra.IsMixed = false;
  add("Hexahedra", hexahedra, 1.0f);
  hexahedra.IsGrid = true;
  add("Grid", hexahedra, 1.0f);
  add("Stepped", OfShape(Shape::Stepped), 0.7f);
  add("Grid.Stepped", OfShape(Shape::Stepped, true), 0.7f);
  add("Globe", OfShape(Shape::Globe), 1.0f);
  add("Grid.Globe", OfShape(Shape::Globe, true), 1.0f);
}

void AddCellLooks(Scenes& scenes)
{
  scenes.push_back({ "cells.Light",
    [](SceneStage& stage)
    {
      stage.World.Transport.Shadows = true;
      stage.World.Transport.AmbientOcclusionSamples = 4;
      stage.Add(CreateCellSurface(stage, CellOptions(), { 50.0 }));
      AddFloor(stage);
    } });
  scenes.push_back({ "cells.Colors",
    [](SceneStage& stage)
    {
      auto object = CreateCellSurface(stage, OfShape(Shape::Bent, true), { 50.0 });
      CellOptions colors = OfShape(Shape::Bent, true);
      colors.Seed = 9;
      object.ColorValues = PublishCellField(stage, colors).Voxels;
      object.Look.Colors = CreateColors(10.0, 70.0);
      stage.Add(std::move(object));
    } });
  scenes.push_back({ "cells.Slices",
    [](SceneStage& stage)
    {
      rt::SliceOf<rt::CellField> slice;
      CellOptions options;
      options.HasHoles = true;
      slice.Field = PublishCellField(stage, options);
      slice.ColorValues = slice.Field.Voxels;
      slice.Planes = { { { 0.0, 0.0, 1.0 }, { 0.0, 0.0, -0.21 } },
        { { 0.6, 0.5, -0.4 }, glm::dvec3(0.0) } };
      slice.Look.Colors = CreateColors(20.0, 80.0);
      slice.Look.Surface.Lighting = false;
      stage.Add(std::move(slice));
    } });
}

void AddCellMedia(Scenes& scenes)
{
  const std::vector<std::pair<double, glm::dvec4>> nodes = { { 20.0, { 0.1, 0.2, 0.9, 0.0 } },
    { 50.0, { 0.2, 0.9, 0.3, 1.5 } }, { 80.0, { 0.9, 0.1, 0.1, 6.0 } } };
  const auto add = [&](const char* name, const CellOptions& options, bool isShaded)
  {
    scenes.push_back({ std::string("cells.Medium.") + name,
      [=](SceneStage& stage)
      {
        rt::MediumOf<rt::CellField> medium;
        medium.Field = PublishCellField(stage, options);
        medium.Function = SceneStage::CreateFunction({}, nodes);
        medium.Look.Shade = isShaded;
        stage.Add(std::move(medium));
      } });
  };
  CellOptions holes;
  holes.HasHoles = true;
  add("Mixed", holes, false);
  add("Shaded", CellOptions(), true);
  add("Grid.Globe", OfShape(Shape::Globe, true), false);
  add("Stepped", OfShape(Shape::Stepped), false);
  scenes.push_back({ "cells.Maximum",
    [](SceneStage& stage)
    {
      rt::ExtremumOf<rt::CellField> medium;
      medium.Field = PublishCellField(stage, CellOptions());
      medium.Colors = std::make_shared<const rt::ColorMap>(CreateColors(20.0, 80.0));
      stage.Add(std::move(medium));
    } });
}

} // namespace

void AddCellScenes(Scenes& scenes)
{
  AddCellSurfaces(scenes);
  AddCellLooks(scenes);
  AddCellMedia(scenes);
}
