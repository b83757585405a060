// SPDX-License-Identifier: BSD-3-Clause
#ifndef BenchmarkVolume_h
#define BenchmarkVolume_h

#include "DSMBricks/base/Box.h"
#include "DSMBricks/base/ScalarType.h"
#include "DSMCore/store/BlockStore.h"
#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/scene/Scene.h"

#include <glm/mat4x4.hpp>

#include <cstddef>
#include <string>
#include <vector>

/// Publishes the volume that `description` names (see BenchmarkOptions::AddTo): each rank makes or
/// reads a slab of its own. Returns the object without isovalues. Collective; throws dsm::Error.
rt::LatticeIsosurface PublishBenchmarkVolume(const std::string& description, int brickEdge,
  int threads, dsm::BlockStore& store, dsm::Messenger& messenger);

/// All samples of a volume in memory, x fastest.
struct BenchmarkSamples
{
  bricks::Index3 Points;
  bricks::ScalarType Type;
  glm::dmat4 IndexToWorld;
  std::vector<std::byte> Bytes;
};

/// Makes or reads the same volume as one array. Throws dsm::Error where planes are in tables, and for files other than
/// .vti.
BenchmarkSamples ReadBenchmarkSamples(const std::string& description, int threads);

#endif
