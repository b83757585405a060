// SPDX-License-Identifier: BSD-3-Clause
#include "tests/scenes/SceneParts.h"

using namespace SceneParts;

namespace
{

const glm::dvec3 Center(0.0);
/// One along each axis, off the samples.
const std::vector<rt::SectionPlane> AlongAxes = { { { 0.0, 0.0, 1.0 }, { 0.0, 0.0, -0.21 } },
  { { 0.0, 2.0, 0.0 }, { 0.0, 0.13, 0.0 } }, { { -1.0, 0.0, 0.0 }, { 0.07, 0.0, 0.0 } } };
const std::vector<rt::SectionPlane> Oblique = { { { 0.6, 0.5, -0.4 }, Center },
  { { 0.6, 0.5, -0.4 }, { 0.2, 0.2, 0.1 } } };

rt::LatticeSlice CreateSlice(SceneStage& stage, const Recipe& recipe,
  const std::vector<rt::SectionPlane>& planes, const glm::dmat4& place = glm::dmat4(1.0))
{
  rt::LatticeSlice slice;
  slice.Field = stage.CreateIsosurface(recipe, {}, place).Field;
  slice.ColorValues = slice.Field.Voxels;
  slice.Planes = planes;
  slice.Look.Colors =
    CreateColors(Generated::Scale(recipe.Type, 20.0), Generated::Scale(recipe.Type, 80.0));
  for (glm::vec4& color : slice.Look.Colors.Table)
  {
    color.w = 1.0f;
  }
  slice.Look.Colors.Below.w = 1.0f;
  slice.Look.Colors.Above.w = 1.0f;
  slice.Look.Surface.Lighting = false;
  return slice;
}

/// Through the samples of one layer.
std::vector<rt::SectionPlane> CreateLayer(const rt::LatticeSlice& slice, int axis, int index)
{
  const glm::dmat4& toWorld = slice.Field.IndexToWorld;
  glm::dvec4 point(0.0, 0.0, 0.0, 1.0);
  point[axis] = index;
  glm::dvec3 gradient(0.0);
  gradient[axis] = 1.0;
  return { { gradient * glm::dmat3(slice.Field.WorldToIndex), glm::dvec3(toWorld * point) } };
}

void AddSliceTypes(Scenes& scenes)
{
  for (const auto& [name, type] : Types)
  {
    Recipe recipe;
    recipe.Type = type;
    scenes.push_back({ "slice.type." + name,
      [recipe](SceneStage& stage) { stage.Add(CreateSlice(stage, recipe, AlongAxes)); } });
  }
}

void AddSliceShapes(Scenes& scenes)
{
  Recipe waves;
  Recipe holes = waves;
  holes.Holes = Recipe::Hole::NotANumber;
  Recipe blanked = waves;
  blanked.Blanked = true;
  Recipe sheet;
  sheet.Form = Recipe::Shape::Rough;
  sheet.Points = { 33, 3, 17 };
  for (const auto& [name, recipe] : Named<Recipe>{
         { "Waves", waves }, { "Holes", holes }, { "Blanked", blanked }, { "Sheet", sheet } })
  {
    scenes.push_back({ "slice." + name + ".Oblique", [recipe = recipe](SceneStage& stage) {
                        stage.Add(CreateSlice(stage, recipe, Oblique, Turn()));
                      } });
    scenes.push_back({ "slice." + name + ".Nearest",
      [recipe = recipe](SceneStage& stage)
      {
        rt::LatticeSlice slice = CreateSlice(stage, recipe, AlongAxes);
        slice.NearestValues = true;
        stage.Add(std::move(slice));
      } });
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    scenes.push_back({ std::string("slice.Layer.") + "XYZ"[axis],
      [=](SceneStage& stage)
      {
        rt::LatticeSlice slice = CreateSlice(stage, blanked, {}, Turn());
        slice.Planes = CreateLayer(slice, axis, 16);
        stage.Add(std::move(slice));
      } });
  }
  for (const auto& [name, camera] : Cameras)
  {
    scenes.push_back({ "slice.Camera." + name,
      [waves, camera = camera](SceneStage& stage)
      {
        stage.LookFrom(camera);
        stage.Add(CreateSlice(stage, waves, AlongAxes));
      } });
  }
}

void AddSliceLooks(Scenes& scenes)
{
  Recipe waves;
  Recipe ball;
  ball.Form = Recipe::Shape::Ball;
  const auto add = [&](const std::string& name, auto change)
  {
    scenes.push_back({ "slice." + name,
      [=](SceneStage& stage)
      {
        rt::LatticeSlice slice = CreateSlice(stage, waves, AlongAxes);
        change(stage, slice);
        stage.Add(std::move(slice));
      } });
  };
  add("Translucent",
    [](SceneStage& stage, rt::LatticeSlice& slice)
    {
      slice.Look.Colors = CreateColors(20.0, 80.0);
      slice.Look.Surface.Opacity = 0.7f;
      stage.Request.Layers = 4;
    });
  add("Lit",
    [](SceneStage&, rt::LatticeSlice& slice)
    {
      slice.Look.Surface.Lighting = true;
      slice.Look.Surface.Specular = 0.4f;
      slice.Look.Surface.SpecularPower = 20.0f;
    });
  add("Solid",
    [](SceneStage&, rt::LatticeSlice& slice)
    {
      slice.ColorValues = nullptr;
      slice.Look.Surface.Lighting = true;
    });
  add("OtherColors",
    [=](SceneStage& stage, rt::LatticeSlice& slice) { slice.ColorValues = stage.Publish(ball); });
  add("Cells",
    [](SceneStage&, rt::LatticeSlice& slice)
    {
      auto cells = std::make_shared<bricks::VoxelField>(*slice.Field.Voxels);
      cells->Lattice = cells->Lattice.OfCells();
      slice.ColorValues = cells;
    });
  add("Above", [](SceneStage&, rt::LatticeSlice& slice) { slice.Least = 50.0; });
  add("Below", [](SceneStage&, rt::LatticeSlice& slice) { slice.Most = 50.0; });
  add("Shadows",
    [](SceneStage& stage, rt::LatticeSlice& slice)
    {
      slice.Planes = { Oblique.front() };
      slice.Least = 30.0;
      AddFloor(stage);
      stage.World.Transport.Shadows = true;
      stage.World.Transport.AmbientOcclusionSamples = 2;
      stage.World.Transport.AmbientOcclusionDistance = 0.8;
    });
  for (const auto& [name, keptBoxes] :
    Named<std::uint32_t>{ { "Box", 1u << 13 }, { "Rest", ~(1u << 13) } })
  {
    add("Clipped." + name,
      [kept = keptBoxes](SceneStage&, rt::LatticeSlice& slice)
      {
        rt::ClipRegion::Grid boxes;
        boxes.Lower = { -0.5, -0.6, -0.7 };
        boxes.Upper = { 0.6, 0.4, 0.5 };
        boxes.Kept = kept;
        slice.Clipping.Boxes = boxes;
      });
  }
}

void AddSliceMixtures(Scenes& scenes)
{
  Recipe waves;
  Recipe ball;
  ball.Form = Recipe::Shape::Ball;
  // A solid, and the face that a cut leaves.
  for (const auto& [name, recipe] : Named<Recipe>{ { "Waves", waves }, { "Ball", ball } })
  {
    scenes.push_back({ "slice.Cap." + name,
      [recipe = recipe](SceneStage& stage)
      {
        rt::LatticeIsosurface surface = stage.CreateIsosurface(recipe, { 50.0 }, Turn());
        rt::LatticeSlice slice = CreateSlice(stage, recipe, {}, Turn());
        const rt::ClipRegion::HalfSpace half{ { -1.0, 0.2, -0.5 }, { 0.1, 0.0, 0.0 } };
        surface.Clipping.HalfSpaces = { half };
        slice.Clipping = surface.Clipping;
        slice.Planes = { { half.Normal, half.Point } };
        slice.Least = surface.Isovalues.front();
        stage.Add(std::move(surface));
        stage.Add(std::move(slice));
      } });
  }
  scenes.push_back({ "slice.InMedium",
    [=](SceneStage& stage)
    {
      stage.Add(stage.CreateMedium(
        waves, { { 20.0, { 0.2, 0.2, 1.0, 0.4 } }, { 70.0, { 1.0, 0.6, 0.2, 2.0 } } }));
      stage.Add(CreateSlice(stage, waves, { Oblique.front() }));
    } });
  scenes.push_back({ "slice.Samples",
    [=](SceneStage& stage)
    {
      stage.Add(CreateSlice(stage, waves, Oblique));
      stage.Request.Samples = 3;
      stage.SampleParts = { 1, 2 };
    } });
}

} // namespace

void AddSliceScenes(std::vector<RecordedScene>& scenes)
{
  AddSliceTypes(scenes);
  AddSliceShapes(scenes);
  AddSliceLooks(scenes);
  AddSliceMixtures(scenes);
}
