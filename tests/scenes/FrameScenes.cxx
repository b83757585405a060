// SPDX-License-Identifier: BSD-3-Clause
#include "tests/scenes/SceneParts.h"

using namespace SceneParts;

namespace
{

void AddPlaces(Scenes& scenes)
{
  glm::dmat4 shear(1.0);
  shear[1] = { 0.4, 1.0, -0.2, 0.0 };
  const Named<glm::dmat4> places = { { "Scaled", Scale({ 1.0, 0.4, 0.7 }) }, { "Turned", Turn() },
    { "Mirrored", Turn() * Scale({ -1.0, 1.0, 1.0 }) }, { "Sheared", shear } };
  const Named<glm::dmat4> worlds = { { "Far", Translate({ 3e5, -2e5, 1e5 }) },
    { "Small", Scale(glm::dvec3(1.0 / 1048576.0)) }, { "Large", Scale(glm::dvec3(65536.0)) } };
  const auto add = [](SceneStage& stage, const glm::dmat4& place)
  {
    rt::LatticeIsosurface volume = stage.CreateIsosurface({}, { 40.0, 60.0 }, place);
    volume.Look.Surface.Opacity = 0.8f;
    stage.Add(std::move(volume));
    rt::MeshObject mesh =
      stage.CreateMesh(Generated::CreateBall(5, 0.7), place * Scale(glm::dvec3(0.8)));
    mesh.Look.Surface.Opacity = 0.5f;
    mesh.Look.BackSurface = mesh.Look.Surface;
    mesh.Look.BackSurface->DiffuseColor = { 1.0f, 0.3f, 0.2f };
    stage.Add(std::move(mesh));
    stage.World.Transport.Shadows = true;
  };
  for (const auto& entry : places)
  {
    scenes.push_back({ "place." + entry.first,
      [place = entry.second, add](SceneStage& stage) { add(stage, place); } });
  }
  for (const auto& [name, world] : worlds)
  {
    for (const auto camera : { Camera::Perspective, Camera::Parallel })
    {
      scenes.push_back(
        { "place." + name + (camera == Camera::Perspective ? ".Perspective" : ".Parallel"),
          [world = world, add, camera](SceneStage& stage)
          {
            stage.LookFrom(camera);
            add(stage, world);
            stage.Move(world);
          } });
    }
  }
}

rt::ClipRegion CreateBoxes(std::uint32_t kept, const glm::dmat4& worldToGrid = glm::dmat4(1.0))
{
  rt::ClipRegion::Grid boxes;
  boxes.WorldToGrid = worldToGrid;
  boxes.Lower = { -0.4, -0.5, -0.3 };
  boxes.Upper = { 0.3, 0.45, 0.5 };
  boxes.Kept = kept;
  rt::ClipRegion region;
  region.Boxes = boxes;
  return region;
}

void AddClipping(Scenes& scenes)
{
  constexpr std::uint32_t middle = 1u << 13;
  constexpr std::uint32_t all = 0x7ffffff;
  rt::ClipRegion plane;
  plane.HalfSpaces = { { { -0.5, -0.2, -1.0 }, { 0.1, 0.0, 0.2 } } };
  rt::ClipRegion planes = plane;
  planes.HalfSpaces.push_back({ { 0.0, 1.0, 0.0 }, { 0.0, -0.4, 0.0 } });
  planes.HalfSpaces.push_back({ { 3.0, 0.0, 1.0 }, { -0.3, 0.0, 0.0 } });
  rt::ClipRegion both = CreateBoxes(all & ~middle, Turn());
  both.HalfSpaces = plane.HalfSpaces;
  const Named<rt::ClipRegion> regions = { { "Plane", plane }, { "Planes", planes },
    { "Box", CreateBoxes(middle) }, { "AllButBox", CreateBoxes(all & ~middle) },
    { "TurnedBoxes", CreateBoxes(0x2a5f93c, Turn()) }, { "PlaneAndBoxes", both } };
  for (const auto& [subjectName, subject] : Subjects)
  {
    for (const auto& [name, region] : regions)
    {
      for (const bool shadows : { false, true })
      {
        scenes.push_back({ "clip." + name + "." + subjectName + (shadows ? ".Shadows" : ""),
          [region = region, subject = subject, shadows](SceneStage& stage)
          {
            stage.World.Transport.Shadows = shadows;
            AddSubject(stage, subject, shadows ? 0.7f : 1.0f,
              [&](auto& object) { object.Clipping = region; });
          } });
      }
    }
  }
}

/// Several objects of each kind, in and through one another.
void AddCrowd(SceneStage& stage, float opacity)
{
  const auto add = [&](auto object, const glm::vec3& color)
  {
    object.Look.Surface.DiffuseColor = color;
    object.Look.Surface.Opacity = opacity;
    stage.Add(std::move(object));
  };
  Recipe ball;
  ball.Form = Recipe::Shape::Ball;
  ball.Type = bricks::ScalarType::UInt8;
  add(stage.CreateIsosurface({}, { 45.0 }), { 0.9f, 0.6f, 0.2f });
  add(
    stage.CreateMesh(Generated::CreateBall(4, 0.7), Scale(glm::dvec3(0.8))), { 0.2f, 0.6f, 0.9f });
  add(stage.CreateIsosurface(ball, { 30.0, 70.0 }, Turn()), { 0.5f, 0.9f, 0.4f });
  add(stage.CreateMesh(Generated::CreateTerrain(7, 0.9)), { 0.8f, 0.3f, 0.6f });
  add(stage.CreateIsosurface(ball, { 50.0 }, Translate({ 0.5, 0.5, 0.5 })), { 0.9f, 0.9f, 0.9f });
}

void AddCrowds(Scenes& scenes)
{
  for (const auto& entry : Cameras)
  {
    scenes.push_back({ "crowd.Opaque." + entry.first,
      [camera = entry.second](SceneStage& stage)
      {
        stage.LookFrom(camera);
        stage.World.Transport.Shadows = camera == Camera::Perspective || camera == Camera::AlongY;
        AddCrowd(stage, 1.0f);
      } });
    scenes.push_back({ "crowd.Translucent." + entry.first,
      [camera = entry.second](SceneStage& stage)
      {
        stage.LookFrom(camera);
        stage.World.Transport.Shadows = camera == Camera::Oblique || camera == Camera::AgainstX;
        AddCrowd(stage, 0.35f);
      } });
  }
  // The same place twice: of equally near surfaces the first one is seen.
  const auto addTwice = [](SceneStage& stage, const auto& create)
  {
    for (const glm::vec3& color : { glm::vec3(1.0f, 0.0f, 0.0f), glm::vec3(0.0f, 0.0f, 1.0f) })
    {
      auto object = create();
      object.Look.Surface.Opacity = 0.6f;
      object.Look.Surface.DiffuseColor = color;
      stage.Add(std::move(object));
    }
  };
  scenes.push_back({ "crowd.TwoVolumes", [addTwice](SceneStage& stage) {
                      addTwice(stage, [&] { return stage.CreateIsosurface({}); });
                    } });
  scenes.push_back({ "crowd.TwoMeshes",
    [addTwice](SceneStage& stage)
    { addTwice(stage, [&] { return stage.CreateMesh(Generated::CreateBall(4, 0.7)); }); } });
}

void AddDebugViews(Scenes& scenes)
{
  const Named<rt::DebugView> views = { { "Owner", rt::DebugView::Owner },
    { "TracingRank", rt::DebugView::TracingRank }, { "Brick", rt::DebugView::Brick },
    { "Normal", rt::DebugView::Normal }, { "Depth", rt::DebugView::Depth },
    { "NewTiles", rt::DebugView::NewTiles }, { "Misses", rt::DebugView::Misses } };
  for (const auto& [subjectName, subject] : Subjects)
  {
    for (const auto& [name, view] : views)
    {
      const bool showsRanks = view != rt::DebugView::Brick && view != rt::DebugView::Normal &&
        view != rt::DebugView::Depth;
      scenes.push_back({ "debug." + name + "." + subjectName,
        [view = view, subject = subject](SceneStage& stage)
        {
          stage.World.View = view;
          AddSubject(stage, subject, 0.8f);
        },
        showsRanks });
    }
  }
}

void AddPictures(Scenes& scenes)
{
  for (const auto& [name, parts] :
    Named<std::vector<int>>{ { "Two", { 2 } }, { "Five", { 5 } }, { "Refined", { 1, 1, 3 } } })
  {
    for (const auto& [subjectName, subject] : Subjects)
    {
      scenes.push_back({ "samples." + name + "." + subjectName,
        [parts = parts, subject = subject](SceneStage& stage)
        {
          stage.LookFrom(Camera::Perspective, 29, 23);
          stage.SampleParts = parts;
          stage.World.Transport.Shadows = true;
          stage.World.Transport.LightRadius = 0.1;
          AddSubject(stage, subject, 0.7f);
        } });
    }
  }
  for (const int layers : { 2, 3, 8 })
  {
    for (const int samples : { 1, 3 })
    {
      scenes.push_back({ "layers." + std::to_string(layers) + (samples > 1 ? ".Samples" : ""),
        [layers, samples](SceneStage& stage)
        {
          stage.Request.Layers = layers;
          stage.SampleParts = { samples };
          AddCrowd(stage, 0.35f);
        } });
    }
  }
  for (const int edge : { 1, 5, 8, 16, 17, 64 })
  {
    scenes.push_back({ "tiles.Edge" + std::to_string(edge),
      [edge](SceneStage& stage)
      {
        stage.Request.TileSize = edge;
        stage.LookFrom(Camera::Perspective, 45, 38);
        AddSubject(stage, Subject::Both, 0.6f);
      } });
  }
  for (const auto& [width, height] :
    std::vector<std::pair<int, int>>{ { 1, 1 }, { 3, 2 }, { 61, 1 }, { 1, 50 }, { 67, 33 } })
  {
    scenes.push_back({ "size." + std::to_string(width) + "x" + std::to_string(height),
      [width = width, height = height](SceneStage& stage)
      {
        stage.LookFrom(Camera::Close, width, height);
        stage.World.Transport.Shadows = true;
        AddSubject(stage, Subject::Both);
      } });
  }
  scenes.push_back({ "empty.Nothing", [](SceneStage&) {} });
  scenes.push_back({ "empty.Isovalues", [](SceneStage& stage) {
                      stage.Add(stage.CreateIsosurface({}, { -5.0, 300.0 }));
                    } });
}

} // namespace

void AddFrameScenes(std::vector<RecordedScene>& scenes)
{
  AddPlaces(scenes);
  AddClipping(scenes);
  AddCrowds(scenes);
  AddDebugViews(scenes);
  AddPictures(scenes);
}
