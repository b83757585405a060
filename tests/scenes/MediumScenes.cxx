// SPDX-License-Identifier: BSD-3-Clause
#include "tests/scenes/SceneParts.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

using namespace SceneParts;

namespace
{

using Nodes = std::vector<std::pair<double, glm::dvec4>>;

/// Nothing below 30, and denser and redder up from there.
const Nodes Fog = { { 0.0, { 0.1, 0.2, 0.9, 0.0 } }, { 30.0, { 0.1, 0.3, 0.9, 0.0 } },
  { 60.0, { 0.4, 0.9, 0.2, 1.5 } }, { 100.0, { 0.9, 0.2, 0.1, 6.0 } } };
/// Three values that are seen, and a little around them.
const Nodes Peaks = { { 0.0, { 0.9, 0.9, 0.2, 0.0 } }, { 29.8, { 0.9, 0.9, 0.2, 0.0 } },
  { 30.0, { 0.9, 0.9, 0.2, 40.0 } }, { 30.2, { 0.9, 0.9, 0.2, 0.0 } },
  { 49.8, { 0.2, 0.8, 0.9, 0.0 } }, { 50.0, { 0.2, 0.8, 0.9, 60.0 } },
  { 50.2, { 0.2, 0.8, 0.9, 0.0 } }, { 79.5, { 0.9, 0.2, 0.6, 0.0 } },
  { 80.0, { 0.9, 0.2, 0.6, 200.0 } }, { 80.5, { 0.9, 0.2, 0.6, 0.0 } },
  { 100.0, { 1.0, 1.0, 1.0, 0.0 } } };
/// All values are seen, and those beyond the ends.
const Nodes Everything = { { 20.0, { 0.2, 0.2, 1.0, 0.4 } }, { 70.0, { 1.0, 0.6, 0.2, 2.0 } } };
/// Walls that nothing gets through.
const Nodes Walls = { { 0.0, { 0.2, 0.9, 0.3, 0.0 } }, { 49.0, { 0.2, 0.9, 0.3, 0.0 } },
  { 51.0, { 0.9, 0.5, 0.3, 5000.0 } }, { 100.0, { 0.3, 0.4, 0.9, 5000.0 } } };

const Named<Nodes> Functions = { { "Fog", Fog }, { "Peaks", Peaks }, { "Everything", Everything },
  { "Walls", Walls } };

void AddTypes(Scenes& scenes)
{
  for (const auto& [name, type] : Types)
  {
    Recipe recipe;
    recipe.Type = type;
    scenes.push_back({ "medium.type." + name,
      [recipe](SceneStage& stage) { stage.Add(stage.CreateMedium(recipe, Fog)); } });
  }
}

/// All of the recipe's values are in one or two even bins, which have two steps and a peak.
rt::LatticeMedium CreateDivided(SceneStage& stage, const Recipe& recipe)
{
  const double low = Generated::Scale(recipe.Type, 35.0);
  const double high = Generated::Scale(recipe.Type, 65.0);
  const double middle = 0.5 * (low + high);
  const double width = 0.02 * (high - low);
  const auto look = [=](double value)
  {
    const double part = std::clamp((value - low) / (high - low), 0.0, 1.0);
    const double peak = std::max(0.0, 1.0 - std::abs(value - middle) / width);
    return glm::dvec4(0.9, part, 1.0 - part, value < low || value > high ? 0.0 : 1.0 + 40.0 * peak);
  };
  rt::LatticeMedium medium = stage.CreateMedium(recipe, Fog);
  const double far = 1e5 * (high - low);
  medium.Function = rt::TransferFunction::Create(
    low - far, high + far, look, { low, middle - width, middle, middle + width, high }, 0.0, 0.0);
  return medium;
}

void AddShapes(Scenes& scenes)
{
  Recipe waves;
  Recipe rough;
  rough.Form = Recipe::Shape::Rough;
  rough.Points = { 12, 11, 10 };
  Recipe holes = waves;
  holes.Holes = Recipe::Hole::NotANumber;
  Recipe blanked = waves;
  blanked.Blanked = true;
  Recipe sheet = rough;
  sheet.Points = { 33, 3, 17 };
  for (const auto& [name, recipe] : Named<Recipe>{ { "Waves", waves }, { "Rough", rough },
         { "Holes", holes }, { "Blanked", blanked }, { "Sheet", sheet } })
  {
    for (const auto& [functionName, nodes] : Functions)
    {
      scenes.push_back({ "medium." + name + "." + functionName,
        [recipe = recipe, nodes = nodes](SceneStage& stage)
        { stage.Add(stage.CreateMedium(recipe, nodes)); } });
    }
    scenes.push_back({ "medium." + name + ".Divided",
      [recipe = recipe](SceneStage& stage) { stage.Add(CreateDivided(stage, recipe)); } });
  }
  for (const auto& [name, camera] : Cameras)
  {
    scenes.push_back({ "medium.Camera." + name,
      [rough, camera = camera](SceneStage& stage)
      {
        stage.LookFrom(camera);
        stage.Add(stage.CreateMedium(rough, Fog));
      } });
  }
}

void AddMixtures(Scenes& scenes)
{
  Recipe waves;
  Recipe ball;
  ball.Form = Recipe::Shape::Ball;
  const glm::dmat4 beside = glm::translate(glm::dmat4(1.0), glm::dvec3(0.4, 0.2, -0.3)) * Turn();
  const auto addBoth = [=](SceneStage& stage)
  {
    stage.Add(stage.CreateMedium(waves, Fog));
    stage.Add(stage.CreateMedium(ball, Peaks, beside));
  };
  scenes.push_back({ "medium.Two", addBoth });
  scenes.push_back({ "medium.Two.Reversed",
    [=](SceneStage& stage)
    {
      stage.Add(stage.CreateMedium(ball, Peaks, beside));
      stage.Add(stage.CreateMedium(waves, Fog));
    } });
  for (const float opacity : { 1.0f, 0.4f })
  {
    scenes.push_back({ opacity < 1.0f ? "medium.Around.Translucent" : "medium.Around.Opaque",
      [=](SceneStage& stage)
      {
        rt::LatticeIsosurface surface = stage.CreateIsosurface(ball);
        surface.Look.Surface.Opacity = opacity;
        stage.Add(std::move(surface));
        stage.Add(stage.CreateMedium(waves, Everything));
        if (opacity < 1.0f)
        {
          stage.Request.Layers = 4;
          stage.Add(stage.CreateMedium(ball, Fog, beside));
        }
      } });
  }
  scenes.push_back({ "medium.Shadows",
    [=](SceneStage& stage)
    {
      rt::LatticeIsosurface surface = stage.CreateIsosurface(
        waves, { 50.0 }, glm::translate(glm::dmat4(1.0), { 0.0, -1.0, 0.0 }));
      stage.Add(std::move(surface));
      stage.Add(stage.CreateMedium(ball, Everything, beside));
      stage.World.Transport.Shadows = true;
      stage.World.Transport.AmbientOcclusionSamples = 2;
      stage.World.Transport.AmbientOcclusionDistance = 0.8;
    } });
  // So smooth that rays take macrocells as a whole.
  for (const auto& [name, type] : Types)
  {
    if (type == bricks::ScalarType::Float32 || type == bricks::ScalarType::UInt16)
    {
      Recipe smooth;
      smooth.Type = type;
      smooth.Points = { 83, 70, 65 };
      scenes.push_back({ "medium.Smooth." + std::string(name),
        [smooth](SceneStage& stage) { stage.Add(stage.CreateMedium(smooth, Fog)); } });
    }
  }
  scenes.push_back({ "medium.Mirror",
    [=](SceneStage& stage)
    {
      rt::LatticeIsosurface surface = stage.CreateIsosurface(ball);
      surface.Look.Surface.Reflectivity = 0.7f;
      stage.Add(std::move(surface));
      stage.World.Transport.MaxBounces = 2;
      stage.Add(stage.CreateMedium(waves, Everything, beside));
    } });
  scenes.push_back({ "medium.Clipped",
    [=](SceneStage& stage)
    {
      rt::LatticeMedium medium = stage.CreateMedium(waves, Everything);
      rt::ClipRegion::HalfSpace half;
      half.Normal = { 1.0, 0.5, -0.3 };
      medium.Clipping.HalfSpaces.push_back(half);
      stage.Add(std::move(medium));
    } });
  scenes.push_back({ "medium.Samples",
    [=](SceneStage& stage)
    {
      addBoth(stage);
      stage.Request.Samples = 3;
      stage.SampleParts = { 1, 2 };
    } });
}

void AddLit(Scenes& scenes)
{
  rt::MediumLook shaded;
  shaded.Shade = true;
  shaded.Surface.Ambient = 0.2f;
  shaded.Surface.Specular = 0.4f;
  shaded.Surface.SpecularPower = 20.0f;
  rt::MediumLook scattering;
  scattering.Scattering = 1.0;
  scattering.Anisotropy = 0.4;
  rt::MediumLook edges;
  edges.Gradients = std::make_shared<const rt::GradientOpacity>(
    rt::GradientOpacity{ 20.0, { 0.0, 0.1, 0.5, 1.0, 1.0 } });
  rt::MediumLook mixed = shaded;
  mixed.Scattering = 0.5;
  mixed.Gradients = edges.Gradients;
  Recipe waves;
  Recipe rough;
  rough.Form = Recipe::Shape::Rough;
  rough.Points = { 12, 11, 10 };
  Recipe blanked = waves;
  blanked.Blanked = true;
  const auto add = [&](const char* name, const Recipe& recipe, const Nodes& nodes,
                     const rt::MediumLook& look, bool shadows, int samples)
  {
    scenes.push_back({ std::string("medium.Lit.") + name,
      [=](SceneStage& stage)
      {
        rt::LatticeMedium medium = stage.CreateMedium(recipe, nodes);
        medium.Look = look;
        stage.Add(std::move(medium));
        stage.World.Transport.Shadows = shadows;
        stage.World.Transport.AmbientOcclusionSamples = shadows ? samples : 0;
        stage.World.Transport.AmbientOcclusionDistance = 0.8;
        stage.Request.Samples = samples;
        stage.SampleParts = { samples };
      } });
  };
  add("Fog", waves, Fog, shaded, false, 1);
  add("Walls", waves, Walls, shaded, false, 1);
  add("Peaks", rough, Peaks, shaded, false, 1);
  add("Blanked", blanked, Everything, shaded, false, 1);
  add("Shadows", waves, Fog, shaded, true, 1);
  add("Shadows.Samples", waves, Everything, shaded, true, 3);
  add("Scattering", waves, Fog, scattering, true, 1);
  add("Scattering.Rough", rough, Everything, scattering, true, 2);
  add("Edges", waves, Everything, edges, false, 1);
  add("Edges.Rough", rough, Fog, mixed, true, 1);
  // Shadows without occlusion are found while rays march.
  rt::MediumLook both = shaded;
  both.Scattering = 0.5;
  both.Anisotropy = 0.4;
  for (const bool isBehindSurface : { false, true })
  {
    scenes.push_back({ isBehindSurface ? "medium.Lit.Lamps.Behind" : "medium.Lit.Lamps",
      [=](SceneStage& stage)
      {
        rt::LatticeMedium medium = stage.CreateMedium(waves, Fog);
        medium.Look = isBehindSurface ? both : shaded;
        stage.Add(std::move(medium));
        if (isBehindSurface)
        {
          Recipe ball;
          ball.Form = Recipe::Shape::Ball;
          rt::LatticeIsosurface surface = stage.CreateIsosurface(ball);
          surface.Look.Surface.Opacity = 0.5f;
          stage.Add(std::move(surface));
        }
        stage.World.Transport.Shadows = true;
      } });
  }
  scenes.push_back({ "medium.Lit.Mixture",
    [=](SceneStage& stage)
    {
      Recipe ball;
      ball.Form = Recipe::Shape::Ball;
      rt::LatticeIsosurface surface = stage.CreateIsosurface(ball);
      surface.Look.Surface.Reflectivity = 0.5f;
      stage.Add(std::move(surface));
      rt::LatticeMedium medium = stage.CreateMedium(waves, Fog);
      medium.Look = mixed;
      stage.Add(std::move(medium));
      stage.Add(stage.CreateMedium(
        ball, Peaks, glm::translate(glm::dmat4(1.0), glm::dvec3(0.4, 0.2, -0.3)) * Turn()));
      stage.World.Transport.Shadows = true;
      stage.World.Transport.MaxBounces = 2;
    } });
}

/// Media of a group, and such as have their colors from other values.
void AddComponents(Scenes& scenes)
{
  Recipe waves;
  Recipe ball;
  ball.Form = Recipe::Shape::Ball;
  for (const bool isLit : { false, true })
  {
    scenes.push_back({ isLit ? "medium.Components.Lit" : "medium.Components",
      [=](SceneStage& stage)
      {
        for (const int group : { 1, 2 })
        {
          const glm::dmat4 place =
            Translate(group == 1 ? glm::dvec3(0.0) : glm::dvec3(0.5, 0.3, -0.2));
          for (const Recipe& recipe : { waves, ball })
          {
            rt::LatticeMedium medium =
              stage.CreateMedium(recipe, recipe.Form == ball.Form ? Everything : Fog, place);
            medium.Group = group;
            medium.Look.Shade = isLit;
            medium.Look.Scattering = isLit && recipe.Form == ball.Form ? 0.5 : 0.0;
            stage.Add(std::move(medium));
          }
        }
        stage.Add(stage.CreateIsosurface(ball, { 80.0 }));
        stage.World.Transport.Shadows = isLit;
      } });
  }
  for (const bool areDirect : { false, true })
  {
    scenes.push_back({ areDirect ? "medium.Colors.Direct" : "medium.Colors.Mapped",
      [=](SceneStage& stage)
      {
        Recipe colors = waves;
        colors.Type = areDirect ? bricks::ScalarType::UInt32 : bricks::ScalarType::Float32;
        rt::LatticeMedium medium = stage.CreateMedium(ball, Fog);
        medium.ColorValues = stage.Publish(colors);
        if (!areDirect)
        {
          medium.Colors = std::make_shared<const rt::ColorMap>(CreateColors(20.0, 80.0));
        }
        stage.Add(std::move(medium));
      } });
  }
}

/// What is shown of all values along a ray is one value.
enum class Blending
{
  Maximum,
  Minimum,
  Mean,
  Sum
};
const Named<Blending> Blendings = { { "Maximum", Blending::Maximum },
  { "Minimum", Blending::Minimum }, { "Mean", Blending::Mean }, { "Sum", Blending::Sum } };

/// `clipping`: of the medium.
void AddBlended(SceneStage& stage, const Recipe& recipe, const Nodes& nodes, Blending blending,
  const rt::ClipRegion& clipping = {})
{
  if (blending == Blending::Maximum || blending == Blending::Minimum)
  {
    rt::LatticeExtremum medium = stage.CreateExtremum(recipe, nodes, blending == Blending::Minimum);
    medium.Clipping = clipping;
    stage.Add(std::move(medium));
  }
  else
  {
    rt::LatticeSum medium = stage.CreateSum(recipe, nodes, blending == Blending::Mean);
    medium.Clipping = clipping;
    stage.Add(std::move(medium));
  }
}

void AddBlendings(Scenes& scenes)
{
  Recipe waves;
  Recipe rough;
  rough.Form = Recipe::Shape::Rough;
  rough.Points = { 12, 11, 10 };
  Recipe holes = waves;
  holes.Holes = Recipe::Hole::NotANumber;
  Recipe blanked = waves;
  blanked.Blanked = true;
  Recipe ball;
  ball.Form = Recipe::Shape::Ball;
  for (const auto& [blendingName, blending] : Blendings)
  {
    const std::string begin = "medium." + blendingName + ".";
    const auto add = [&scenes, begin](const std::string& name, const auto& change) {
      scenes.push_back({ begin + name, change });
    };
    for (const auto& [name, recipe] : Named<Recipe>{
           { "Waves", waves }, { "Rough", rough }, { "Holes", holes }, { "Blanked", blanked } })
    {
      add(name,
        [recipe = recipe, blending = blending](SceneStage& stage)
        { AddBlended(stage, recipe, Everything, blending); });
    }
    for (const auto& [name, camera] :
      Named<Camera>{ { "AlongZ", Camera::AlongZ }, { "Inside", Camera::Inside } })
    {
      add(name,
        [camera = camera, rough, blending = blending](SceneStage& stage)
        {
          stage.LookFrom(camera);
          AddBlended(stage, rough, Fog, blending);
        });
    }
    add("Clipped",
      [waves, blending = blending](SceneStage& stage)
      {
        rt::ClipRegion clipping;
        clipping.Boxes = { glm::dmat4(1.0), glm::dvec3(-0.3), glm::dvec3(0.4), ~(1u << 13) };
        AddBlended(stage, waves, Fog, blending, clipping);
      });
    add("Shadows",
      [waves, ball, blending = blending](SceneStage& stage)
      {
        AddBlended(stage, waves, Fog, blending);
        stage.Add(stage.CreateIsosurface(ball));
        stage.Add(stage.CreateMedium(ball, Everything, Translate({ 0.4, 0.2, -0.3 })));
        stage.World.Transport.Shadows = true;
      });
  }
  for (const auto& [name, view] :
    Named<rt::DebugView>{ { "Owner", rt::DebugView::Owner }, { "Brick", rt::DebugView::Brick },
      { "Normal", rt::DebugView::Normal }, { "Depth", rt::DebugView::Depth } })
  {
    scenes.push_back({ "medium.View." + name,
      [waves, ball, view = view](SceneStage& stage)
      {
        stage.World.View = view;
        stage.Add(stage.CreateMedium(waves, Fog));
        stage.Add(stage.CreateExtremum(ball, Fog, false, Translate({ 0.9, 0.4, -0.3 })));
      },
      view == rt::DebugView::Owner });
  }
  for (const auto& [name, type] : Types)
  {
    Recipe recipe;
    recipe.Type = type;
    for (const bool isMinimum : { false, true })
    {
      scenes.push_back({ std::string("medium.type.") + (isMinimum ? "Minimum." : "Maximum.") + name,
        [recipe, isMinimum](SceneStage& stage)
        { stage.Add(stage.CreateExtremum(recipe, Everything, isMinimum)); } });
    }
  }
}

} // namespace

void AddMediumScenes(std::vector<RecordedScene>& scenes)
{
  AddTypes(scenes);
  AddShapes(scenes);
  AddMixtures(scenes);
  AddLit(scenes);
  AddComponents(scenes);
  AddBlendings(scenes);
}
