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
  /// Memory limit in bytes for values and chunks, on each rank; memory of the HDF5 library for the index is not
  /// included.
  std::size_t MemoryBytes = std::size_t(512) << 20;
  int Threads = 1; ///< on each rank
  /// Allows a later call to resume one that fails or is interrupted. If false, a call that fails removes its files.
  bool IsResumable = true;
  /// See BrickFileLayout.
  bool HasHaloRecords = true;
};

/// Writes a brick file (BrickFileWriter) at `path`, or resumes an interrupted call with the same values.
/// Collective; rank 0 writes, and every rank examines the bricks at the end, so all must have access to the
/// file. The origin is destroyed when its values are written; its memory should be at most half of
/// MemoryBytes. `tell(part)` receives the completed part on rank 0. Throws the same dsm::Error on every rank.
void WriteBrickFile(std::unique_ptr<ValueOrigin> from, const std::string& path,
  const WriteOptions& options, dsm::Messenger& messenger, const std::function<void(double)>& tell);

} // namespace vol

#endif
