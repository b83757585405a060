// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ConvertVolume_h
#define vol_ConvertVolume_h

#include "DSMCore/transport/Messenger.h"
#include "DSMVolumeFiles/format/VolumeFile.h"
#include "DSMVolumeFiles/write/WriteBrickFile.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace vol
{

struct ConvertOptions : WriteOptions
{
  /// Names; none: all arrays.
  std::vector<std::string> Arrays;
  int Step = 0;
};

/// Writes a brick file (BrickFileWriter) of a volume at `path`, or resumes an interrupted call. Collective;
/// every rank opens the file by itself; rank 0 writes. `tell(part)` receives the completed part on rank 0.
/// Throws the same dsm::Error on every rank.
void ConvertVolume(const std::shared_ptr<const VolumeFile>& from, const std::string& path,
  const ConvertOptions& options, dsm::Messenger& messenger,
  const std::function<void(double)>& tell);

} // namespace vol

#endif
