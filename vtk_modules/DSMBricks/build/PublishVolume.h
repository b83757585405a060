// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_PublishVolume_h
#define bricks_PublishVolume_h

#include "DSMBricks/build/VoxelSource.h"
#include "DSMBricks/layout/VoxelField.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/publish/FragmentDigests.h"
#include "DSMCore/store/BlockStore.h"
#include "DSMCore/transport/Messenger.h"

#include <memory>
#include <string_view>
#include <vector>

namespace bricks
{

struct VolumeSettings
{
  dsm::BlockStore::Place Place = dsm::BlockStore::Place::Memory;
  /// Receives what this rank contributes to each brick, so that the volume can be updated; null: it is not noted.
  dsm::FragmentDigests* Digests = nullptr;
  /// Each piece is cut by a thread of its own.
  bool IsConcurrent = false;
};

/// Collective, between frames: publishes a volume in bricks of `lattice`. Every rank gives its own pieces; nothing is
/// kept of them. Throws the same dsm::Error on every rank; then nothing stays published. `progress` (may be empty) is
/// called with this rank's part done, in [0, 1].
std::shared_ptr<VoxelField> PublishVolume(std::string_view what, const BrickLattice& lattice,
  const std::vector<std::shared_ptr<const VoxelSource>>& pieces, dsm::BlockStore& store,
  dsm::Messenger& messenger, const VolumeSettings& settings = {},
  dsm::FunctionRef<void(double)> progress = {});

} // namespace bricks

#endif
