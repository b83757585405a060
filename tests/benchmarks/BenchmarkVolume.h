// SPDX-License-Identifier: BSD-3-Clause
#ifndef BenchmarkVolume_h
#define BenchmarkVolume_h

#include "DSMCore/store/BlockStore.h"
#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/scene/Scene.h"

#include <string>

/// Publishes the volume that `description` names (see BenchmarkOptions::AddTo): each rank makes or
/// reads a slab of its own. Returns the object without isovalues. Collective; throws dsm::Error.
rt::LatticeIsosurface PublishBenchmarkVolume(const std::string& description, int brickEdge,
  int threads, dsm::BlockStore& store, dsm::Messenger& messenger);

#endif
