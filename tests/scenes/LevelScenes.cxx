// SPDX-License-Identifier: BSD-3-Clause
#include "tests/scenes/SceneParts.h"
#include "tests/support/LevelModel.h"

#include "DSMBricks/levels/PublishLevels.h"

using namespace SceneParts;

namespace
{

/// With the same bits on every machine, as the values of Generated::Recipe: within [0, 100].
LevelModel CreateModel(unsigned seed, bool withHoles = false)
{
  LevelModel model = CreateRandomLevels(seed, withHoles);
  model.Function = [seed](int, const glm::dvec3& place)
  { return 100.0 * Generated::Noise(0.9 * place.x, 0.8 * place.y, 0.7 * place.z, seed); };
  return model;
}

/// The coarsest leaves of one value, the next of another, and so on.
LevelModel CreateSteps(unsigned seed)
{
  LevelModel model = CreateModel(seed);
  model.Function = [](int level, const glm::dvec3&) { return 20.0 * level + 10.0; };
  return model;
}

/// Leaves are dealt to the ranks in turn, by parts of the coarsest cells; the longest axis is [-1, 1].
rt::LevelField Publish(SceneStage& stage, const LevelModel& model)
{
  dsm::Messenger& messenger = stage.GetMessenger();
  const LevelModelSource source(model,
    [&](int level, const bricks::Index3& cell)
    {
      const bricks::Index3 part = cell / bricks::Index3(3);
      return (part.x + 5 * part.y + 7 * part.z + level) % messenger.GetSize() ==
        messenger.GetRank();
    });
  const bricks::LevelLattice lattice = bricks::DivideLevels(
    "levels", bricks::LevelScales(model.Scales), model.Type, source, messenger);
  rt::LevelField field;
  field.Voxels = bricks::PublishLevels(
    "levels", lattice, source, stage.GetStore(), messenger, dsm::BlockStore::Place::Memory, 1);
  const glm::dvec3 roots(model.Roots);
  field.SetIndexToWorld(
    Scale(glm::dvec3(2.0 / std::max({ roots.x, roots.y, roots.z }))) * Translate(-0.5 * roots));
  return field;
}

rt::LevelIsosurface CreateIsosurface(
  SceneStage& stage, const LevelModel& model, const std::vector<double>& isovalues)
{
  rt::LevelIsosurface object;
  object.Field = Publish(stage, model);
  object.Isovalues = isovalues;
  object.Look.Surface.DiffuseColor = { 0.9f, 0.7f, 0.4f };
  return object;
}

void AddSurfaces(Scenes& scenes)
{
  for (const auto& [name, camera] : Cameras)
  {
    for (const unsigned seed : { 0u, 4u })
    {
      scenes.push_back({ "levels." + std::to_string(seed) + "." + name,
        [seed, camera = camera](SceneStage& stage)
        {
          stage.LookFrom(camera);
          stage.Add(CreateIsosurface(stage, CreateModel(seed), { 40.0, 60.0 }));
        } });
    }
  }
  for (const unsigned seed : { 1u, 2u, 3u, 5u, 6u, 7u })
  {
    scenes.push_back({ "levels." + std::to_string(seed) + ".Holes",
      [seed](SceneStage& stage)
      {
        LevelModel model = CreateModel(seed, true);
        model.Type = seed % 2 == 0 ? bricks::ScalarType::Float64 : model.Type;
        model.OfPoints = seed % 3 == 0;
        rt::LevelIsosurface object = CreateIsosurface(stage, model, { 35.0, 50.0, 65.0 });
        object.Look.Surface.Opacity = 0.6f;
        stage.Add(std::move(object));
      } });
  }
  scenes.push_back({ "levels.Steps", [](SceneStage& stage) {
                      stage.Add(CreateIsosurface(stage, CreateSteps(4), { 22.0, 48.0 }));
                    } });
}

void AddLooks(Scenes& scenes)
{
  scenes.push_back({ "levels.Light",
    [](SceneStage& stage)
    {
      stage.World.Transport.Shadows = true;
      stage.World.Transport.AmbientOcclusionSamples = 4;
      stage.Add(CreateIsosurface(stage, CreateModel(4), { 45.0 }));
      AddFloor(stage);
    } });
  scenes.push_back({ "levels.Colors",
    [](SceneStage& stage)
    {
      rt::LevelIsosurface object = CreateIsosurface(stage, CreateModel(2), { 50.0 });
      LevelModel colors = CreateModel(2);
      colors.Function = [](int level, const glm::dvec3& place)
      { return 15.0 * level + 12.0 * place.x; };
      object.ColorValues = Publish(stage, colors).Voxels;
      object.Look.Colors = CreateColors(10.0, 70.0);
      stage.Add(std::move(object));
    } });
  scenes.push_back({ "levels.Slices",
    [](SceneStage& stage)
    {
      rt::LevelSlice slice;
      slice.Field = Publish(stage, CreateModel(7, true));
      slice.ColorValues = slice.Field.Voxels;
      slice.Planes = { { { 0.0, 0.0, 1.0 }, { 0.0, 0.0, -0.21 } },
        { { 0.6, 0.5, -0.4 }, glm::dvec3(0.0) } };
      slice.Look.Colors = CreateColors(20.0, 80.0);
      slice.Look.Surface.Lighting = false;
      stage.Add(std::move(slice));
    } });
}

void AddMedia(Scenes& scenes)
{
  const std::vector<std::pair<double, glm::dvec4>> nodes = { { 20.0, { 0.1, 0.2, 0.9, 0.0 } },
    { 50.0, { 0.2, 0.9, 0.3, 1.5 } }, { 80.0, { 0.9, 0.1, 0.1, 6.0 } } };
  for (const unsigned seed : { 0u, 4u, 7u })
  {
    scenes.push_back({ "levels.Medium." + std::to_string(seed),
      [=](SceneStage& stage)
      {
        rt::LevelMedium medium;
        medium.Field = Publish(stage, CreateModel(seed, seed == 7));
        medium.Function = SceneStage::CreateFunction({}, nodes);
        stage.Add(std::move(medium));
      } });
    scenes.push_back({ "levels.Maximum." + std::to_string(seed),
      [=](SceneStage& stage)
      {
        rt::LevelExtremum medium;
        medium.Field = Publish(stage, CreateModel(seed, seed == 7));
        medium.Colors = std::make_shared<rt::ColorMap>(CreateColors(20.0, 80.0));
        medium.IsMinimum = seed == 4;
        stage.Add(std::move(medium));
      } });
  }
}

} // namespace

void AddLevelScenes(Scenes& scenes)
{
  AddSurfaces(scenes);
  AddLooks(scenes);
  AddMedia(scenes);
}
