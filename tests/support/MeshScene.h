// SPDX-License-Identifier: BSD-3-Clause
#ifndef MeshScene_h
#define MeshScene_h

#include "tests/support/SphereScene.h"
#include "tests/unit/mesh/TestMesh.h"

#include "DSMBricks/build/PublishMesh.h"

/// The noisy sphere's isosurfaces, a blob of triangles that cuts through them, and a colored
/// terrain of squares below, with edges, shadows and translucency across the objects.
namespace MeshScene
{

constexpr std::uint32_t BrickBytes = 2048;

/// Rank r has the r-th part of the shuffled triangles, the last rank none when there are several.
inline std::shared_ptr<bricks::TriangleMesh> Publish(
  const TestMesh::Mesh& mesh, dsm::Messenger& messenger, dsm::BlockStore& store)
{
  const auto parts = static_cast<std::uint64_t>(std::max(messenger.GetSize() - 1, 1));
  const auto rank = static_cast<std::uint64_t>(messenger.GetRank());
  const TestMesh::Mesh piece =
    rank < parts ? TestMesh::TakePart(mesh, rank, parts, 7) : TestMesh::Mesh();
  bricks::TriangleMeshSettings settings;
  settings.BrickBytes = BrickBytes;
  settings.Threads = 2;
  return bricks::PublishMesh("mesh", piece, settings, store, messenger);
}

inline rt::Scene Create(dsm::Messenger& messenger, dsm::BlockStore& store)
{
  rt::Scene scene = SphereScene::CreateScene(SphereScene::Publish(messenger, store), 0.6f);
  scene.Lights.front().Direction = glm::normalize(glm::dvec3(-0.3, -1.0, -0.4));
  scene.Transport.Shadows = true;
  const double middle = 0.5 * (SphereScene::Points - 1);

  const glm::dmat4 blobToWorld = glm::scale(
    glm::translate(glm::dmat4(1.0), glm::dvec3(middle + 10.0, middle, middle)), glm::dvec3(9.0));
  rt::MeshObject blob;
  blob.Instance = std::make_shared<rt::MeshInstance>(
    Publish(TestMesh::CreateBlob(4), messenger, store), blobToWorld);
  blob.Look.Surface.Opacity = 0.8f;
  blob.Look.Surface.DiffuseColor = { 1.0f, 0.5f, 0.2f };
  blob.Look.BackSurface = blob.Look.Surface;
  blob.Look.BackSurface->DiffuseColor = { 0.1f, 0.2f, 1.0f };
  blob.Look.Edges = rt::EdgeLines{ { 0.2f, 0.0f, 0.0f }, 1.1f };
  scene.Objects.push_back(blob);

  const glm::dmat4 terrainToWorld = glm::scale(
    glm::rotate(glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 4.0, SphereScene::Points)),
      -glm::half_pi<double>(), glm::dvec3(1.0, 0.0, 0.0)),
    glm::dvec3(SphereScene::Points));
  TestMesh::Mesh squares = TestMesh::CreateTerrain(24);
  for (std::uint64_t square = 0; square < squares.GetTriangleCount() / 2; ++square)
  {
    squares.EdgeFlags.insert(squares.EdgeFlags.end(), { 0b011, 0b110 });
  }
  rt::MeshObject terrain;
  terrain.Instance =
    std::make_shared<rt::MeshInstance>(Publish(squares, messenger, store), terrainToWorld);
  terrain.Look.Edges = rt::EdgeLines{ { 1.0f, 1.0f, 1.0f }, 2.0f, 0.5f };
  terrain.Look.ColoredBy = rt::MeshLook::Coloring::Values;
  auto colors = std::make_shared<rt::ColorMap>();
  colors->First = -2.0;
  colors->Last = 3.0;
  colors->Table = { { 0.0f, 0.0f, 1.0f, 1.0f }, { 0.0f, 1.0f, 0.0f, 1.0f },
    { 1.0f, 0.0f, 0.0f, 1.0f } };
  terrain.Look.Colors = colors;
  scene.Objects.push_back(terrain);
  return scene;
}

} // namespace MeshScene

#endif
