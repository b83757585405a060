// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfAxes_h
#define vol_HdfAxes_h

#include "DSMBricks/base/Box.h"
#include "DSMVolumeFiles/format/HdfLibrary.h"
#include "DSMVolumeFiles/format/VolumeShape.h"

#include <cstddef>
#include <cstdint>
#include <string>

namespace vol
{

/// The axes of an HDF5 dataset that holds a volume.
struct HdfAxes
{
  hsize_t Frames = 0; ///< along a first axis of time; 0: it has none
  bricks::Index3 Samples{ 0 };
  hsize_t Components = 0; ///< along a last axis; 0: it has none

  VolumeShape GetShape() const
  {
    return { this->Samples, static_cast<std::int64_t>(this->Frames) };
  }
  std::size_t GetBeforeSpace() const { return this->Frames > 0 ? 1 : 0; }
  enum class Time
  {
    Unknown, ///< if there are four axes: a short last axis has components, otherwise the first axis is time
    None,
    First
  };
  /// Three are z, y and x. A fourth one is time or has components, of five the first and the last are. Returns false for
  /// what is no volume. `tooLong`: set to what an axis of a volume has more of than FileLimits allow, such as "time steps";
  /// then it returns false, too. The caller has GetHdfLock.
  bool Find(hid_t dataset, Time time, std::string* tooLong = nullptr);
};

} // namespace vol

#endif
