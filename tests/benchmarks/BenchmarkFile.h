// SPDX-License-Identifier: BSD-3-Clause
#ifndef BenchmarkFile_h
#define BenchmarkFile_h

#include "DSMCore/store/BlockStore.h"
#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/scene/Scene.h"

#include <string>

/// Publishes the first array of a volume file that vol::OpenVolumeFile opens (one component, on points): its bricks
/// come from the file when rays meet them. A brick edge of 0 is the renderer's own. What they hold is taken from
/// the file's index, else found by reading it once; what of that is in memory is forgotten. Returns the object
/// without isovalues. Collective; throws dsm::Error.
rt::LatticeIsosurface PublishBenchmarkFile(
  const std::string& path, int brickEdge, dsm::BlockStore& store, dsm::Messenger& messenger);

#endif
