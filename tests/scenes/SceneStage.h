// SPDX-License-Identifier: BSD-3-Clause
#ifndef tests_scenes_SceneStage_h
#define tests_scenes_SceneStage_h

#include "tests/scenes/GeneratedMesh.h"
#include "tests/scenes/GeneratedVolume.h"
#include "tests/unit/mesh/TestMesh.h"

#include "DSMBricks/build/PublishMesh.h"
#include "DSMBricks/build/PublishVolume.h"
#include "DSMCore/store/BlockStore.h"
#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/frame/FrameRequest.h"
#include "DSMRayTracing/scene/Scene.h"

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

/// Where a scene is put together on the ranks of a test: the one place that knows how objects get
/// into an rt::Scene. Everything lies in [-1, 1]^3, about.
class SceneStage
{
public:
  enum class Camera
  {
    Perspective,
    Close,  ///< what is near is cut off by the near plane
    Inside, ///< in the middle of everything
    Parallel,
    Oblique, ///< parallel, but the picture is sheared
    AlongX,  ///< parallel, in the direction of the axis
    AgainstX,
    AlongY,
    AgainstY,
    AlongZ,
    AgainstZ
  };

  /// Of all ranks; between frames.
  SceneStage(dsm::Messenger& messenger, dsm::BlockStore& store)
    : Messenger(messenger)
    , Store(store)
  {
    this->LookFrom(Camera::Perspective, 48, 40);
    this->AddLight({ -0.48, -0.6, -0.64 });
  }

  dsm::Messenger& GetMessenger() { return this->Messenger; }
  dsm::BlockStore& GetStore() { return this->Store; }

  rt::Scene World;
  rt::FrameRequest Request;
  /// In how many parts the samples of a pixel are traced.
  std::vector<int> SampleParts{ 1 };

  void Add(rt::SceneObject object) { this->World.Objects.push_back(std::move(object)); }
  void Add(rt::SceneMedium medium) { this->World.Media.push_back(std::move(medium)); }

  rt::Light& AddLight(const glm::dvec3& direction)
  {
    this->World.Lights.emplace_back();
    this->World.Lights.back().Direction = glm::normalize(direction);
    return this->World.Lights.back();
  }

  /// Rank r has the r-th slab, the last rank none when there are several.
  std::shared_ptr<bricks::VoxelField> Publish(const Generated::Recipe& recipe)
  {
    const bricks::BrickLattice lattice(
      recipe.Points, recipe.Type, recipe.Blanked, recipe.BrickEdge);
    const int rank = this->Messenger.GetRank();
    const int parts = std::max(this->Messenger.GetSize() - 1, 1);
    std::vector<std::shared_ptr<const bricks::VoxelSource>> pieces;
    if (rank < parts)
    {
      bricks::Box cells{ bricks::Index3(0), lattice.GetCells() };
      cells.Min.z = cells.Max.z * rank / parts;
      cells.Max.z = cells.Max.z * (rank + 1) / parts;
      pieces.push_back(std::make_shared<Generated::Volume>(recipe, cells));
    }
    const auto field =
      bricks::PublishVolume("volume", lattice, pieces, this->Store, this->Messenger);
    field->Planes = Generated::CreatePlanes(recipe);
    return field;
  }

  /// The longest axis is [-1, 1], and `place` comes after that; `levels` in [0, 100].
  rt::LatticeIsosurface CreateIsosurface(const Generated::Recipe& recipe,
    const std::vector<double>& levels = { 50.0 }, const glm::dmat4& place = glm::dmat4(1.0))
  {
    rt::LatticeIsosurface object;
    object.Field.Voxels = this->Publish(recipe);
    const glm::dvec3 cells(recipe.Points - bricks::Index3(1));
    const double spacing = 2.0 / std::max({ cells.x, cells.y, cells.z });
    object.Field.SetIndexToWorld(place * glm::scale(glm::dmat4(1.0), glm::dvec3(spacing)) *
      glm::translate(glm::dmat4(1.0), -0.5 * cells));
    for (const double level : levels)
    {
      object.Isovalues.push_back(Generated::Scale(recipe.Type, level));
    }
    object.Look.Surface.DiffuseColor = { 0.9f, 0.7f, 0.4f };
    return object;
  }

  /// The same; `nodes` (levels in [0, 100], ascending; red, green, blue, and opacity in a unit of the world) are
  /// connected by lines.
  rt::LatticeMedium CreateMedium(const Generated::Recipe& recipe,
    const std::vector<std::pair<double, glm::dvec4>>& nodes,
    const glm::dmat4& place = glm::dmat4(1.0))
  {
    rt::LatticeMedium medium;
    medium.Field = this->CreateIsosurface(recipe, {}, place).Field;
    medium.Function = CreateFunction(recipe, nodes);
    return medium;
  }

  /// The nodes' colors and opacities as those of extrema.
  rt::LatticeExtremum CreateExtremum(const Generated::Recipe& recipe,
    const std::vector<std::pair<double, glm::dvec4>>& nodes, bool isMinimum,
    const glm::dmat4& place = glm::dmat4(1.0))
  {
    auto colors = std::make_shared<rt::ColorMap>();
    colors->First = Generated::Scale(recipe.Type, nodes.front().first);
    colors->Last = Generated::Scale(recipe.Type, nodes.back().first);
    for (const glm::dvec4& sample : Sample(nodes))
    {
      colors->Table.emplace_back(glm::dvec3(sample), sample.w / (1.0 + sample.w));
    }
    colors->Below = colors->Table.front();
    colors->Above = colors->Table.back();
    rt::LatticeExtremum medium;
    medium.Field = this->CreateIsosurface(recipe, {}, place).Field;
    medium.Colors = colors;
    medium.IsMinimum = isMinimum;
    return medium;
  }

  /// The nodes' red, in a unit of the world; values above the middle of their range count for a mean.
  rt::LatticeSum CreateSum(const Generated::Recipe& recipe,
    const std::vector<std::pair<double, glm::dvec4>>& nodes, bool isMean,
    const glm::dmat4& place = glm::dmat4(1.0))
  {
    std::vector<rt::LatticeSum::Sample> samples;
    for (const glm::dvec4& sample : Sample(nodes))
    {
      const bool counts = !isMean || 2 * samples.size() >= rt::TransferFunction::Bins;
      samples.push_back({ sample.x, counts ? 1.0 : 0.0 });
    }
    rt::LatticeSum medium;
    medium.Field = this->CreateIsosurface(recipe, {}, place).Field;
    medium.Function =
      rt::LatticeSum::CreateFunction(Generated::Scale(recipe.Type, nodes.front().first),
        Generated::Scale(recipe.Type, nodes.back().first), samples, 1.0);
    medium.IsMean = isMean;
    return medium;
  }

  static std::shared_ptr<const rt::TransferFunction> CreateFunction(
    const Generated::Recipe& recipe, const std::vector<std::pair<double, glm::dvec4>>& nodes)
  {
    return std::make_shared<rt::TransferFunction>(
      Generated::Scale(recipe.Type, nodes.front().first),
      Generated::Scale(recipe.Type, nodes.back().first), Sample(nodes));
  }

  /// TransferFunction::Bins + 1 of the lines between the nodes.
  static std::vector<glm::dvec4> Sample(const std::vector<std::pair<double, glm::dvec4>>& nodes)
  {
    std::vector<glm::dvec4> samples;
    const double first = nodes.front().first;
    const double last = nodes.back().first;
    std::size_t node = 1;
    for (int sample = 0; sample <= rt::TransferFunction::Bins; ++sample)
    {
      const double level = first + (last - first) * sample / rt::TransferFunction::Bins;
      while (node + 1 < nodes.size() && nodes[node].first < level)
      {
        ++node;
      }
      const auto& [low, before] = nodes[node - 1];
      const auto& [high, after] = nodes[node];
      samples.push_back(before + (level - low) / (high - low) * (after - before));
    }
    return samples;
  }

  /// Rank r has the r-th part of the shuffled triangles, the last rank none when there are several.
  rt::MeshObject CreateMesh(const Generated::Mesh& mesh, const glm::dmat4& place = glm::dmat4(1.0),
    rt::MeshCulling cull = {})
  {
    const auto parts = static_cast<std::uint64_t>(std::max(this->Messenger.GetSize() - 1, 1));
    const auto rank = static_cast<std::uint64_t>(this->Messenger.GetRank());
    const Generated::Mesh piece =
      rank < parts ? TestMesh::TakePart(mesh, rank, parts, 7) : Generated::Mesh();
    bricks::TriangleMeshSettings settings;
    settings.BrickBytes = 2048;
    rt::MeshInstance instance(
      bricks::PublishMesh("mesh", piece, settings, this->Store, this->Messenger), place);
    instance.Culling = cull;
    rt::MeshObject object;
    object.Instance = std::make_shared<rt::MeshInstance>(std::move(instance));
    object.Look.Surface.DiffuseColor = { 0.4f, 0.8f, 0.6f };
    return object;
  }

  void LookFrom(Camera camera, int width, int height)
  {
    this->Request.Width = width;
    this->Request.Height = height;
    const double up = camera == Camera::Close ? 0.9 : 1.3;
    const double side = up * width / height;
    this->Request.WorldToClip = GetProjection(camera, side, up) * GetView(camera);
  }
  void LookFrom(Camera camera)
  {
    this->LookFrom(camera, this->Request.Width, this->Request.Height);
  }

  /// All that is placed so far, seen as before, at another place of the world.
  void Move(const glm::dmat4& matrix) { this->Request.WorldToClip *= glm::inverse(matrix); }

private:
  static glm::dmat4 GetProjection(Camera camera, double side, double up)
  {
    switch (camera)
    {
      case Camera::Perspective:
        return glm::frustum(-0.25 * side, 0.25 * side, -0.25 * up, 0.25 * up, 1.0, 20.0);
      case Camera::Close:
        return glm::frustum(-0.5 * side, 0.5 * side, -0.5 * up, 0.5 * up, 1.0, 3.0);
      case Camera::Inside:
        return glm::frustum(-0.01 * side, 0.01 * side, -0.01 * up, 0.01 * up, 0.01, 10.0);
      case Camera::Oblique:
      {
        glm::dmat4 shear(1.0);
        shear[2] = { 0.3, -0.2, 1.0, 0.0 };
        return glm::ortho(-side - 1.2, side - 1.2, -up + 0.8, up + 0.8, 1.0, 20.0) * shear;
      }
      default:
        return glm::ortho(-side, side, -up, up, 1.0, 20.0);
    }
  }

  static glm::dmat4 GetView(Camera camera)
  {
    const auto look = [](const glm::dvec3& eye, const glm::dvec3& up = { 0.0, 1.0, 0.0 })
    { return glm::lookAt(eye, glm::dvec3(0.0), up); };
    switch (camera)
    {
      case Camera::Close:
        return look({ 0.9, 0.8, 1.5 });
      case Camera::Inside:
        return glm::lookAt(
          glm::dvec3(0.05, 0.02, 0.1), glm::dvec3(-1.0, 0.4, -0.3), glm::dvec3(0.0, 1.0, 0.0));
      case Camera::AlongX:
        return look({ -4.0, 0.0, 0.0 });
      case Camera::AgainstX:
        return look({ 4.0, 0.0, 0.0 });
      case Camera::AlongY:
        return look({ 0.0, -4.0, 0.0 }, { 0.0, 0.0, 1.0 });
      case Camera::AgainstY:
        return look({ 0.0, 4.0, 0.0 }, { 0.0, 0.0, 1.0 });
      case Camera::AlongZ:
        return look({ 0.0, 0.0, -4.0 });
      case Camera::AgainstZ:
        return look({ 0.0, 0.0, 4.0 });
      default:
        return look({ 2.2, 1.6, 3.0 });
    }
  }

  dsm::Messenger& Messenger;
  dsm::BlockStore& Store;
};

#endif
