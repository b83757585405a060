// SPDX-License-Identifier: BSD-3-Clause
#include "tests/scenes/SceneParts.h"

#include <functional>

using namespace SceneParts;

namespace
{

void AddMeshes(Scenes& scenes)
{
  const Named<Generated::Mesh> meshes = { { "Ball", Generated::CreateBall(6, 0.7) },
    { "Scan", Generated::CreateScan(16) }, { "Terrain", Generated::CreateTerrain(18, 0.8) },
    { "Soup", Generated::CreateSoup(700) }, { "Fan", Generated::CreateFan(90) },
    { "Tubes", Generated::CreateTubes(40) } };
  for (const auto& [name, mesh] : meshes)
  {
    for (const auto& entry : Cameras)
    {
      scenes.push_back({ "mesh." + name + "." + entry.first,
        [mesh = mesh, camera = entry.second](SceneStage& stage)
        {
          stage.LookFrom(camera);
          stage.Add(stage.CreateMesh(Generated::Strip(mesh)));
        } });
    }
  }
}

void AddMeshLooks(Scenes& scenes)
{
  using Coloring = rt::MeshLook::Coloring;
  using Change = std::function<void(rt::MeshObject&)>;
  const auto colorBy = [](Coloring coloring)
  {
    return [coloring](rt::MeshObject& object)
    {
      object.Look.ColoredBy = coloring;
      object.Look.Colors = std::make_shared<rt::ColorMap>(CreateColors(-1.5, 2.0));
    };
  };
  const auto layOn = [](bool repeat, bool interpolate, const glm::dmat4& transform)
  {
    return [=](rt::MeshObject& object)
    {
      auto texture = CreateTexture();
      texture->Repeat = repeat;
      texture->Interpolate = interpolate;
      texture->Transform = transform;
      object.Look.Picture = texture;
    };
  };
  const auto paintBack = [](rt::MeshObject& object)
  {
    object.Look.BackSurface = object.Look.Surface;
    object.Look.BackSurface->DiffuseColor = { 0.9f, 0.2f, 0.1f };
    object.Look.BackSurface->Opacity = 0.8f;
    object.Look.Surface.Opacity = 0.6f;
  };
  const auto drawEdges = [](float width, float opacity)
  {
    return [=](rt::MeshObject& object) {
      object.Look.Edges = rt::EdgeLines{ { 0.1f, 0.0f, 0.5f }, width, opacity };
    };
  };
  const Named<Change> looks = { { "Smooth", [](rt::MeshObject&) {} },
    { "Flat", [](rt::MeshObject& object) { object.Look.Flat = true; } },
    { "Values", colorBy(Coloring::Values) }, { "CornerValues", colorBy(Coloring::CornerValues) },
    { "Colors", colorBy(Coloring::Colors) }, { "Texture", layOn(true, false, glm::dmat4(1.0)) },
    { "TextureBetween", layOn(true, true, Turn()) },
    { "TextureBorder", layOn(false, true, Scale({ 2.0, 1.5, 1.0 })) }, { "BackSurface", paintBack },
    { "Edges", drawEdges(1.0f, 1.0f) }, { "WideEdges", drawEdges(3.0f, 0.6f) },
    { "Translucent", [](rt::MeshObject& object) { object.Look.Surface.Opacity = 0.4f; } } };
  const Generated::Mesh ball = Generated::CreateBall(5, 0.7);
  const Named<Generated::Mesh> meshes = { { "Points", ball },
    { "Triangles", Generated::MoveToTriangles(ball) }, { "Soup", Generated::CreateSoup(300) },
    { "Tubes", Generated::CreateTubes(40) } };
  for (const auto& [meshName, mesh] : meshes)
  {
    for (const auto& [name, look] : looks)
    {
      scenes.push_back({ "look." + meshName + "." + name,
        [mesh = mesh, look = look](SceneStage& stage)
        {
          rt::MeshObject object = stage.CreateMesh(mesh);
          look(object);
          stage.Add(std::move(object));
        } });
    }
  }
  for (const bool front : { false, true })
  {
    scenes.push_back({ std::string("look.Culled.") + (front ? "Front" : "Back"),
      [front](SceneStage& stage)
      {
        stage.World.Transport.Shadows = true;
        rt::MeshObject object = stage.CreateMesh(
          Generated::CreateScan(10), Scale({ 1.0, -1.0, 1.0 }), rt::MeshCulling{ front, !front });
        object.Look.Edges = rt::EdgeLines{};
        stage.Add(std::move(object));
        AddFloor(stage);
      } });
  }
}

} // namespace

void AddMeshScenes(std::vector<RecordedScene>& scenes)
{
  AddMeshes(scenes);
  AddMeshLooks(scenes);
}
