// SPDX-License-Identifier: BSD-3-Clause
#ifndef tests_scenes_SceneParts_h
#define tests_scenes_SceneParts_h

#include "tests/scenes/RecordedScenes.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

/// What the lists of scenes have in common.
namespace SceneParts
{

using Generated::Recipe;
using Camera = SceneStage::Camera;
using Scenes = std::vector<RecordedScene>;
template <class T>
using Named = std::vector<std::pair<std::string, T>>;

inline const Named<Camera> Cameras = { { "Perspective", Camera::Perspective },
  { "Close", Camera::Close }, { "Inside", Camera::Inside }, { "Parallel", Camera::Parallel },
  { "Oblique", Camera::Oblique }, { "AlongX", Camera::AlongX }, { "AgainstX", Camera::AgainstX },
  { "AlongY", Camera::AlongY }, { "AgainstY", Camera::AgainstY }, { "AlongZ", Camera::AlongZ },
  { "AgainstZ", Camera::AgainstZ } };

inline const Named<bricks::ScalarType> Types = { { "Int8", bricks::ScalarType::Int8 },
  { "UInt8", bricks::ScalarType::UInt8 }, { "Int16", bricks::ScalarType::Int16 },
  { "UInt16", bricks::ScalarType::UInt16 }, { "Int32", bricks::ScalarType::Int32 },
  { "UInt32", bricks::ScalarType::UInt32 }, { "Int64", bricks::ScalarType::Int64 },
  { "UInt64", bricks::ScalarType::UInt64 }, { "Float32", bricks::ScalarType::Float32 },
  { "Float64", bricks::ScalarType::Float64 } };

/// What several features are tried on.
enum class Subject
{
  Volume,
  Mesh,
  Both
};
inline const Named<Subject> Subjects = { { "Volume", Subject::Volume }, { "Mesh", Subject::Mesh },
  { "Both", Subject::Both } };

inline rt::ColorMap CreateColors(double first, double last)
{
  rt::ColorMap colors;
  colors.First = first;
  colors.Last = last;
  colors.Table = { { 0.1f, 0.2f, 0.9f, 1.0f }, { 0.2f, 0.9f, 0.3f, 0.7f },
    { 0.9f, 0.9f, 0.1f, 1.0f }, { 0.9f, 0.1f, 0.1f, 0.5f }, { 0.6f, 0.2f, 0.8f, 1.0f } };
  colors.Below = { 0.0f, 0.0f, 0.0f, 0.9f };
  colors.Above = { 1.0f, 1.0f, 1.0f, 0.4f };
  colors.NotANumber = { 1.0f, 0.0f, 1.0f, 1.0f };
  return colors;
}

inline std::shared_ptr<rt::Texture> CreateTexture()
{
  auto texture = std::make_shared<rt::Texture>();
  texture->Width = 5;
  texture->Height = 3;
  for (int byte = 0; byte < 4 * 5 * 3; ++byte)
  {
    texture->Texels.push_back(
      static_cast<std::uint8_t>(byte % 4 == 3 ? 200 + byte % 50 : Generated::Hash(byte) % 256));
  }
  return texture;
}

/// A rotation by the angles of right triangles with whole sides; no sine that depends on a machine.
inline glm::dmat4 Turn()
{
  glm::dmat4 aroundZ(1.0);
  aroundZ[0] = { 0.8, 0.6, 0.0, 0.0 };
  aroundZ[1] = { -0.6, 0.8, 0.0, 0.0 };
  glm::dmat4 aroundX(1.0);
  aroundX[1] = { 0.0, 5.0 / 13.0, 12.0 / 13.0, 0.0 };
  aroundX[2] = { 0.0, -12.0 / 13.0, 5.0 / 13.0, 0.0 };
  return aroundX * aroundZ;
}

inline glm::dmat4 Scale(const glm::dvec3& factors)
{
  return glm::scale(glm::dmat4(1.0), factors);
}

inline glm::dmat4 Translate(const glm::dvec3& way)
{
  return glm::translate(glm::dmat4(1.0), way);
}

/// Lies below everything, and catches shadows.
inline void AddFloor(SceneStage& stage)
{
  stage.Add(stage.CreateMesh(Generated::CreateTerrain(10, 0.3),
    Translate({ 0.0, -1.0, 0.0 }) *
      glm::dmat4({ 0, 0, 1.8, 0 }, { 1.8, 0, 0, 0 }, { 0, 1, 0, 0 }, { 0, 0, 0, 1 })));
}

/// The floor, and above it the subject, changed by `change`: translucent when `opacity` says so.
template <class Change>
void AddSubject(SceneStage& stage, Subject subject, float opacity, const Change& change)
{
  if (subject != Subject::Mesh)
  {
    Recipe recipe;
    recipe.Form = Recipe::Shape::Ball;
    rt::LatticeIsosurface ball =
      stage.CreateIsosurface(recipe, { 40.0, 80.0 }, Translate({ -0.3, 0.1, 0.0 }));
    ball.Look.Surface.Opacity = opacity;
    change(ball);
    stage.Add(std::move(ball));
  }
  if (subject != Subject::Volume)
  {
    rt::MeshObject ball = stage.CreateMesh(
      Generated::CreateBall(5, 0.8), Translate({ 0.4, 0.2, 0.3 }) * Scale(glm::dvec3(0.7)));
    ball.Look.Surface.Opacity = opacity;
    change(ball);
    stage.Add(std::move(ball));
  }
  AddFloor(stage);
}

inline void AddSubject(SceneStage& stage, Subject subject, float opacity = 1.0f)
{
  AddSubject(stage, subject, opacity, [](auto&) {});
}

} // namespace SceneParts

#endif
