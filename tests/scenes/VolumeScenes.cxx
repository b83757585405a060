// SPDX-License-Identifier: BSD-3-Clause
#include "tests/scenes/SceneParts.h"

using namespace SceneParts;

namespace
{

void AddVolumeTypes(Scenes& scenes)
{
  for (const auto& [name, type] : Types)
  {
    Recipe recipe;
    recipe.Type = type;
    scenes.push_back({ "type." + name,
      [recipe](SceneStage& stage) { stage.Add(stage.CreateIsosurface(recipe)); } });
    scenes.push_back({ "type." + name + ".Isovalues",
      [recipe](SceneStage& stage)
      {
        stage.LookFrom(Camera::Parallel, 47, 41);
        rt::LatticeIsosurface object = stage.CreateIsosurface(recipe, { 30.0, 45.0, 50.0, 70.0 });
        object.Look.Surface.Opacity = 0.5f;
        object.Look.Opacities = { 1.0f, 0.4f, 0.0f, 1.5f };
        stage.Add(std::move(object));
      } });
    scenes.push_back({ "type." + name + ".Steps",
      [recipe](SceneStage& stage)
      {
        Recipe steps = recipe;
        steps.Form = Recipe::Shape::Steps;
        steps.BrickEdge = 5;
        stage.LookFrom(Camera::AgainstZ);
        stage.Add(stage.CreateIsosurface(steps, { 40.0, 75.0 }));
      } });
  }
}

void AddVolumeShapes(Scenes& scenes)
{
  Recipe waves;
  Recipe ball;
  ball.Form = Recipe::Shape::Ball;
  Recipe rough;
  rough.Form = Recipe::Shape::Rough;
  rough.Points = { 12, 11, 10 };
  Recipe steps;
  steps.Form = Recipe::Shape::Steps;
  Recipe ramp;
  ramp.Form = Recipe::Shape::Ramp;
  Recipe cell = rough;
  cell.Points = { 2, 2, 2 };
  Recipe sheet = rough;
  sheet.Points = { 33, 3, 17 };
  Recipe bytes = rough;
  bytes.Type = bricks::ScalarType::UInt8;
  bytes.Seed = 30;
  const Named<Recipe> recipes = { { "Waves", waves }, { "Ball", ball }, { "Rough", rough },
    { "Steps", steps }, { "Ramp", ramp }, { "Cell", cell }, { "Sheet", sheet },
    { "RoughBytes", bytes } };
  for (const auto& [name, recipe] : recipes)
  {
    for (const auto& entry : Cameras)
    {
      scenes.push_back({ "volume." + name + "." + entry.first,
        [recipe = recipe, camera = entry.second](SceneStage& stage)
        {
          stage.LookFrom(camera);
          stage.Add(stage.CreateIsosurface(recipe, { 30.0, 50.0 }));
        } });
    }
  }
}

void AddMissingData(Scenes& scenes)
{
  for (const auto& [name, camera] : { Cameras[0], Cameras[2], Cameras[9] })
  {
    for (const bool blanked : { false, true })
    {
      for (const auto& [holeName, holes] : Named<Recipe::Hole>{ { "None", Recipe::Hole::None },
             { "NotANumber", Recipe::Hole::NotANumber }, { "Infinite", Recipe::Hole::Infinite } })
      {
        Recipe recipe;
        recipe.Holes = holes;
        recipe.Blanked = blanked;
        recipe.Type = blanked && camera == Camera::AlongZ ? bricks::ScalarType::Float64
                                                          : bricks::ScalarType::Float32;
        if (blanked || holes != Recipe::Hole::None)
        {
          scenes.push_back({ "missing." + holeName + (blanked ? ".Blanked." : ".") + name,
            [recipe, camera = camera](SceneStage& stage)
            {
              stage.LookFrom(camera);
              rt::LatticeIsosurface object = stage.CreateIsosurface(recipe, { 40.0, 55.0 });
              object.Look.Surface.Opacity = 0.7f;
              stage.Add(std::move(object));
            } });
        }
      }
    }
  }
}

void AddBricks(Scenes& scenes)
{
  for (const int edge : { 1, 3, 4, 8, 16, 20 })
  {
    scenes.push_back({ "bricks.Edge" + std::to_string(edge),
      [edge](SceneStage& stage)
      {
        Recipe recipe;
        recipe.Points = edge == 20 ? bricks::Index3(45, 40, 43) : bricks::Index3(23, 19, 21);
        recipe.BrickEdge = edge;
        stage.World.Transport.Shadows = true;
        stage.Add(stage.CreateIsosurface(recipe, { 35.0, 60.0 }));
      } });
  }
}

void AddFieldColors(Scenes& scenes)
{
  const auto add = [&](const std::string& name, bricks::ScalarType type, double first, double last,
                     bool logarithmic, Recipe::Hole holes)
  {
    scenes.push_back({ "colors." + name,
      [=](SceneStage& stage)
      {
        rt::LatticeIsosurface object = stage.CreateIsosurface({}, { 35.0, 60.0 });
        Recipe recipe;
        recipe.Type = type;
        recipe.Seed = 20;
        recipe.Holes = holes;
        object.ColorValues = stage.Publish(recipe);
        object.Look.Colors =
          CreateColors(Generated::Scale(type, first), Generated::Scale(type, last));
        object.Look.Colors.Logarithmic = logarithmic;
        object.Look.Surface.Ambient = 0.2f;
        object.Look.Surface.AmbientColor = { 0.0f, 1.0f, 0.0f };
        stage.Add(std::move(object));
      } });
  };
  using Hole = Recipe::Hole;
  for (const auto& [name, type] : Types)
  {
    add("Linear." + name, type, 20.0, 80.0, false, Hole::None);
  }
  add("OutOfRange", bricks::ScalarType::Float32, 45.0, 55.0, false, Hole::None);
  add("Constant", bricks::ScalarType::Float32, 50.0, 50.0, false, Hole::None);
  add("Missing", bricks::ScalarType::Float32, 20.0, 80.0, false, Hole::NotANumber);
  add("Infinite", bricks::ScalarType::Float64, 20.0, 80.0, false, Hole::Infinite);
  add("Logarithmic", bricks::ScalarType::UInt16, 10.0, 90.0, true, Hole::None);
  add("LogarithmicOutOfRange", bricks::ScalarType::Float32, 40.0, 60.0, true, Hole::NotANumber);
  scenes.push_back({ "colors.Itself",
    [](SceneStage& stage)
    {
      rt::LatticeIsosurface object = stage.CreateIsosurface({}, { 30.0, 45.0, 60.0 });
      object.ColorValues = object.Field.Voxels;
      object.Look.Colors = CreateColors(25.0, 65.0);
      stage.Add(std::move(object));
    } });
}

void AddRectilinear(Scenes& scenes)
{
  Recipe waves;
  waves.Growth = 1.3;
  Recipe rough = waves;
  rough.Form = Recipe::Shape::Rough;
  rough.Points = { 12, 11, 10 };
  rough.Growth = 3.5; // a million in eleven cells
  for (const auto& [name, recipe] : Named<Recipe>{ { "Waves", waves }, { "Rough", rough } })
  {
    for (const auto camera : { SceneStage::Camera::Perspective, SceneStage::Camera::AgainstZ })
    {
      const bool isAlong = camera == SceneStage::Camera::AgainstZ;
      scenes.push_back({ "rectilinear." + name + (isAlong ? ".AgainstZ" : ".Perspective"),
        [recipe = recipe, camera](SceneStage& stage)
        {
          stage.LookFrom(camera);
          stage.World.Transport.Shadows = true;
          stage.Add(stage.CreateIsosurface(recipe, { 30.0, 50.0 }));
        } });
    }
    scenes.push_back({ "rectilinear." + name + ".Medium",
      [recipe = recipe](SceneStage& stage)
      {
        stage.Add(stage.CreateMedium(
          recipe, { { 20.0, { 0.2, 0.2, 1.0, 0.4 } }, { 70.0, { 1.0, 0.6, 0.2, 2.0 } } }));
      } });
  }
}

} // namespace

void AddVolumeScenes(std::vector<RecordedScene>& scenes)
{
  AddVolumeTypes(scenes);
  AddVolumeShapes(scenes);
  AddMissingData(scenes);
  AddBricks(scenes);
  AddFieldColors(scenes);
  AddRectilinear(scenes);
}
