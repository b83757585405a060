// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_PartState_h
#define vol_PartState_h

#include "DSMVolumeFiles/write/BrickFileWriter.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vol
{

/// Says how many chunks of a brick file are written (PartFiles::GetState), so that a later process that writes the same
/// values can resume. Used by the process that holds the path's PathClaim.
class PartState
{
public:
  /// `source` identifies the values that are written. Names in `layout` and `source` may contain any bytes.
  PartState(
    std::string path, const BrickFileLayout& layout, const std::string& source, bool isResumable);

  /// Returns how many chunks of each array an earlier process has written, or nothing where it wrote other values, was
  /// interrupted while it wrote chunks, or the state is damaged.
  std::optional<std::vector<std::int64_t>> Load() const;
  /// Throws dsm::Error, which says what to do, where an earlier process has written chunks and can be resumed.
  void CheckNothingIsLost() const;
  /// Replaces the state, and waits until it is on the disk. `isWhole`: the file on the disk has exactly these chunks.
  /// Throws dsm::Error.
  void Save(bool isWhole, const std::vector<std::int64_t>& chunks) const;

private:
  /// Null where there is no state, or it is damaged.
  nlohmann::json Read() const;

  std::string Path;
  bool IsResumable;
  std::vector<std::int64_t> MostChunks; ///< for each array
  nlohmann::json Description;
};

} // namespace vol

#endif
