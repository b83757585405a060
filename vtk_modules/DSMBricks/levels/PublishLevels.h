// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_PublishLevels_h
#define bricks_PublishLevels_h

#include "DSMBricks/levels/LevelSource.h"
#include "DSMBricks/levels/LevelVoxels.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/store/BlockStore.h"
#include "DSMCore/transport/Messenger.h"

#include <memory>
#include <string_view>

namespace bricks
{

/// Collective: the bricks of the leaves of all ranks. `scales` and `type` (Float32 or Float64, of the samples) are
/// the same on every rank. Throws the same dsm::Error on every rank.
LevelLattice DivideLevels(std::string_view what, const LevelScales& scales, ScalarType type,
  const LevelSource& source, dsm::Messenger& messenger);

/// Collective, between frames: publishes the values of all ranks' leaves in the bricks of `lattice`, as points
/// (LevelNodes). Nothing of the source is kept. Throws the same dsm::Error on every rank; then nothing stays
/// published. `progress` (may be empty) is called with this rank's part done, in [0, 1]. `threads`: for this rank's
/// work.
std::shared_ptr<LevelVoxels> PublishLevels(std::string_view what, const LevelLattice& lattice,
  const LevelSource& source, dsm::BlockStore& store, dsm::Messenger& messenger,
  dsm::BlockStore::Place place, int threads, dsm::FunctionRef<void(double)> progress = {});

} // namespace bricks

#endif
