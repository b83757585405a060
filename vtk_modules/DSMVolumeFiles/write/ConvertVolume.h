// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ConvertVolume_h
#define vol_ConvertVolume_h

#include "DSMCore/transport/Messenger.h"
#include "DSMVolumeFiles/cache/ChunkCache.h"
#include "DSMVolumeFiles/write/BrickFileWriter.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace vol
{

struct ConvertOptions
{
  /// Names; none: all arrays.
  std::vector<std::string> Arrays;
  int Step = 0;
  /// Cells along an axis of a brick; 0: what the renderer takes for the arrays' type (of several, the first).
  int BrickEdge = 0;
  Compression Pressed = Compression::None;
  /// Of values and chunks in memory, on each rank; what the HDF5 library keeps of the index comes on top.
  std::size_t MemoryBytes = std::size_t(512) << 20;
  int Threads = 1; ///< of each rank
};

/// Writes a brick file (BrickFileWriter) of a volume at `path`, or goes on where an earlier call was ended. Collective;
/// every rank opens the file by itself; rank 0 writes. `tell(part)` is called on rank 0 with how much is done. Throws
/// the same dsm::Error on every rank.
void ConvertVolume(const std::shared_ptr<const VolumeFile>& from, const std::string& path,
  const ConvertOptions& options, dsm::Messenger& messenger,
  const std::function<void(double)>& tell);

} // namespace vol

#endif
