// SPDX-License-Identifier: BSD-3-Clause
#include "tests/scenes/SceneParts.h"

#include <functional>

using namespace SceneParts;

namespace
{

void AddLights(Scenes& scenes)
{
  const rt::PositionalLight lamp{ { 1.2, 2.2, 1.9 }, { 1.0f, 0.0f, 0.0f } };
  const rt::PositionalLight attenuated{ lamp.Position, { 0.2f, 0.1f, 0.2f } };
  const auto place = [](SceneStage& stage, const rt::LightKind& kind) -> rt::Light&
  {
    rt::Light& light = stage.AddLight({ -0.3, -1.0, -0.6 });
    light.Kind = kind;
    return light;
  };
  const rt::ConeLight cone{ lamp, 0.85f, 3.0f };
  const Named<std::function<void(SceneStage&)>> lights = {
    { "None", [](SceneStage& stage) { stage.World.Lights.clear(); } },
    { "Headlight",
      [](SceneStage& stage)
      {
        stage.World.Lights.clear();
        stage.AddLight({ -2.2, -1.6, -3.0 }).IsLoneHeadlight = true;
      } },
    { "Positional", [=](SceneStage& stage) { place(stage, lamp); } },
    { "Attenuated", [=](SceneStage& stage) { place(stage, attenuated); } },
    { "Cone", [=](SceneStage& stage) { place(stage, cone); } },
    { "Three",
      [=](SceneStage& stage)
      {
        place(stage, cone).Color = { 0.9f, 0.2f, 0.2f };
        stage.AddLight({ 1.0, -0.4, -0.2 }).Color = { 0.1f, 0.3f, 0.9f };
      } }
  };
  for (const auto& [subjectName, subject] : Subjects)
  {
    for (const auto& [name, add] : lights)
    {
      for (const bool shadows : { false, true })
      {
        scenes.push_back({ "light." + name + "." + subjectName + (shadows ? ".Shadows" : ""),
          [add = add, subject = subject, shadows](SceneStage& stage)
          {
            stage.World.Transport.Shadows = shadows;
            add(stage);
            AddSubject(stage, subject, 1.0f,
              [](auto& object)
              {
                object.Look.Surface.Specular = 0.6f;
                object.Look.Surface.SpecularPower = 12.0f;
                object.Look.Surface.SpecularColor = { 1.0f, 0.9f, 0.6f };
                object.Look.Surface.Ambient = 0.1f;
              });
          } });
      }
    }
  }
  scenes.push_back({ "light.Unlit",
    [](SceneStage& stage)
    {
      AddSubject(
        stage, Subject::Both, 0.5f, [](auto& object) { object.Look.Surface.Lighting = false; });
    } });
}

void AddTransport(Scenes& scenes)
{
  const auto surround = [](rt::LightTransport& transport)
  {
    transport.Surroundings.Up = { 0.6, 0.8, 0.0 };
    transport.Surroundings.Lower = { 0.3f, 0.2f, 0.1f };
    transport.Surroundings.Upper = { 0.4f, 0.6f, 0.9f };
  };
  const auto lookAround = [](rt::LightTransport& transport, double distance)
  {
    transport.AmbientOcclusionSamples = 2;
    transport.AmbientOcclusionDistance = distance;
  };
  const auto soften = [](rt::LightTransport& transport)
  {
    transport.Shadows = true;
    transport.LightRadius = 0.15;
  };
  const Named<std::function<void(rt::LightTransport&)>> ways = { { "SoftShadows", soften },
    { "Occlusion", [=](rt::LightTransport& transport) { lookAround(transport, 0.8); } },
    { "NearOcclusion", [=](rt::LightTransport& transport) { lookAround(transport, 0.05); } },
    { "Surroundings", surround },
    { "OccludedSurroundings",
      [=](rt::LightTransport& transport)
      {
        surround(transport);
        lookAround(transport, 100.0);
      } },
    { "Everything",
      [=](rt::LightTransport& transport)
      {
        surround(transport);
        lookAround(transport, 1.0);
        soften(transport);
      } } };
  for (const auto& [subjectName, subject] : Subjects)
  {
    for (const auto& [name, set] : ways)
    {
      for (const float opacity : { 1.0f, 0.5f })
      {
        scenes.push_back(
          { "transport." + name + "." + subjectName + (opacity < 1.0f ? ".Translucent" : ""),
            [set = set, subject = subject, opacity](SceneStage& stage)
            {
              set(stage.World.Transport);
              AddSubject(stage, subject, opacity);
            } });
      }
    }
    for (const int bounces : { 0, 1, 3 })
    {
      scenes.push_back({ "mirror.Bounces" + std::to_string(bounces) + "." + subjectName,
        [bounces, subject = subject](SceneStage& stage)
        {
          stage.World.Transport.MaxBounces = bounces;
          stage.World.Transport.Shadows = bounces == 3;
          stage.World.Transport.Background = { 0.3f, 0.5f, 0.7f };
          AddSubject(stage, subject, bounces == 3 ? 0.8f : 1.0f,
            [](auto& object) { object.Look.Surface.Reflectivity = 0.7f; });
          rt::MeshObject wall = stage.CreateMesh(Generated::CreateTerrain(4, 0.05),
            Translate({ -0.6, 0.2, -1.2 }) * Scale(glm::dvec3(1.2)));
          wall.Look.Surface.Reflectivity = 0.9f;
          wall.Look.Edges = rt::EdgeLines{ { 0.9f, 0.2f, 0.2f }, 2.0f, 0.8f };
          stage.Add(std::move(wall));
        } });
    }
  }
}

void AddShadows(Scenes& scenes)
{
  // Tinted shadows of what has colors of several opacities.
  scenes.push_back({ "shadow.ColorMap",
    [](SceneStage& stage)
    {
      stage.World.Transport.Shadows = true;
      rt::LatticeIsosurface object = stage.CreateIsosurface({}, { 35.0, 60.0 });
      Recipe recipe;
      recipe.Seed = 20;
      object.ColorValues = stage.Publish(recipe);
      object.Look.Colors = CreateColors(20.0, 80.0);
      stage.Add(std::move(object));
      AddFloor(stage);
    } });
  scenes.push_back({ "shadow.Texture",
    [](SceneStage& stage)
    {
      stage.World.Transport.Shadows = true;
      rt::MeshObject object = stage.CreateMesh(Generated::CreateScan(8), Scale(glm::dvec3(0.7)));
      object.Look.Picture = CreateTexture();
      object.Look.ColoredBy = rt::MeshLook::Coloring::Colors;
      object.Look.Surface.Opacity = 0.8f;
      stage.Add(std::move(object));
      AddFloor(stage);
    } });
  scenes.push_back({ "shadow.Opacities",
    [](SceneStage& stage)
    {
      stage.World.Transport.Shadows = true;
      rt::LatticeIsosurface object = stage.CreateIsosurface({}, { 35.0, 50.0, 60.0 });
      object.Look.Opacities = { 0.2f, 1.0f, 0.0f };
      stage.Add(std::move(object));
      AddFloor(stage);
    } });
  scenes.push_back({ "shadow.BackSurface",
    [](SceneStage& stage)
    {
      stage.World.Transport.Shadows = true;
      rt::MeshObject object = stage.CreateMesh(Generated::CreateScan(8), Scale(glm::dvec3(0.7)));
      object.Look.BackSurface = object.Look.Surface;
      object.Look.BackSurface->Opacity = 0.3f;
      stage.Add(std::move(object));
      AddFloor(stage);
    } });
  scenes.push_back({ "shadow.Invisible",
    [](SceneStage& stage)
    {
      stage.World.Transport.Shadows = true;
      AddSubject(stage, Subject::Both, 0.0f);
    } });
  scenes.push_back({ "shadow.Rough",
    [](SceneStage& stage)
    {
      stage.World.Transport.Shadows = true;
      Recipe recipe;
      recipe.Form = Recipe::Shape::Rough;
      stage.Add(stage.CreateIsosurface(recipe));
      stage.Add(stage.CreateMesh(Generated::CreateSoup(200)));
    } });
}

} // namespace

void AddLightScenes(std::vector<RecordedScene>& scenes)
{
  AddLights(scenes);
  AddTransport(scenes);
  AddShadows(scenes);
}
