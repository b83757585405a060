// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_WriteBrickFile_h
#define vol_WriteBrickFile_h

#include "DSMCore/transport/Messenger.h"
#include "DSMVolumeFiles/write/BrickFileWriter.h"
#include "DSMVolumeFiles/write/ValueOrigin.h"

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <string>

namespace vol
{

struct WriteOptions
{
  /// Cells along an axis of a brick; 0: what the renderer takes for the arrays' type (of several, the first).
  int BrickEdge = 0;
  Compression Pressed = Compression::None;
  /// Coarser levels beside the values, each with half the samples along each axis (ReducedOrigin), or as many as there
  /// are until one is a single brick.
  int Levels = 0;
  static constexpr int AllLevels = std::numeric_limits<int>::max();
  /// Of values and chunks in memory, on each rank; what the HDF5 library keeps of the index comes on top.
  std::size_t MemoryBytes = std::size_t(512) << 20;
  int Threads = 1; ///< of each rank
  /// Whether a later call can resume one that fails or is interrupted. If not, a call that fails removes its files.
  bool IsResumable = true;
  /// See BrickFileLayout.
  bool HasHaloRecords = true;
};

/// Writes a brick file (BrickFileWriter) at `path`, or goes on where an earlier call with the same values was ended.
/// Collective; rank 0 writes, and every rank looks through the bricks in the end, so all must see the file. The origin
/// goes when its values are written; what it has in memory should be at most half of MemoryBytes. `tell(part)` is called
/// on rank 0 with how much is done. Throws the same dsm::Error on every rank.
void WriteBrickFile(std::unique_ptr<ValueOrigin> from, const std::string& path,
  const WriteOptions& options, dsm::Messenger& messenger, const std::function<void(double)>& tell);

} // namespace vol

#endif
