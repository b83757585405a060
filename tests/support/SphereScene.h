// SPDX-License-Identifier: BSD-3-Clause
#ifndef SphereScene_h
#define SphereScene_h

#include "DSMBricks/build/PublishVolume.h"
#include "DSMBricks/sample/SampleVolume.h"
#include "DSMCore/store/BlockStore.h"
#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/frame/FrameRequest.h"
#include "DSMRayTracing/scene/Scene.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <memory>
#include <vector>

/// A small scene for tests of whole frames: a noisy sphere in many small bricks.
namespace SphereScene
{

constexpr int Points = 40;
constexpr int BrickEdge = 8;

/// Of a store in which bricks are fetched, as by ranks on different hosts.
inline dsm::BlockStore::Settings CreateSettings(std::size_t cacheBytes, int workers,
  dsm::MemoryOrganization organization = dsm::MemoryOrganization::ObjectBased)
{
  dsm::BlockStore::Settings settings;
  settings.Organization = organization;
  settings.CacheBytes = cacheBytes;
  settings.Workers = workers;
  settings.HostSharing = false;
  return settings;
}

/// A noisy sphere; rank r has the r-th slab, the last rank none when there are several.
inline std::shared_ptr<bricks::VoxelField> Publish(
  dsm::Messenger& messenger, dsm::BlockStore& store)
{
  const bricks::SampleVolume volume(bricks::SampleVolume::Kind::Sphere, bricks::Index3(Points));
  const bricks::BrickLattice lattice(
    bricks::Index3(Points), bricks::ScalarType::Float32, false, BrickEdge);
  const int rank = messenger.GetRank();
  const int parts = std::max(messenger.GetSize() - 1, 1);
  std::vector<std::shared_ptr<const bricks::VoxelSource>> pieces;
  if (rank < parts)
  {
    const bricks::Box cells{ { 0, 0, (Points - 1) * rank / parts },
      { Points - 1, Points - 1, (Points - 1) * (rank + 1) / parts } };
    pieces.push_back(
      std::make_shared<bricks::SampleVolumeSource>(volume, cells, bricks::ScalarType::Float32));
  }
  return bricks::PublishVolume("sphere", lattice, pieces, store, messenger);
}

inline rt::FrameRequest CreateRequest(int width, int height)
{
  rt::FrameRequest request;
  request.Width = width;
  request.Height = height;
  request.WorldToClip =
    glm::perspective(glm::radians(30.0), static_cast<double>(width) / height, 1.0, 400.0) *
    glm::lookAt(
      glm::dvec3(60.0, 45.0, 100.0), glm::dvec3(0.5 * (Points - 1)), glm::dvec3(0.0, 1.0, 0.0));
  return request;
}

inline rt::Scene CreateScene(const std::shared_ptr<bricks::VoxelField>& field, float opacity)
{
  rt::Scene scene;
  scene.Lights.emplace_back();
  rt::LatticeIsosurface object;
  object.Field.Voxels = field;
  object.Isovalues = { 0.3, 0.5 };
  object.Look.Surface.Opacity = opacity;
  scene.Objects.push_back(object);
  return scene;
}

} // namespace SphereScene

#endif
