// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfAxes_h
#define vol_HdfAxes_h

#include "DSMBricks/base/Box.h"
#include "DSMVolumeFiles/format/AxisNotes.h"
#include "DSMVolumeFiles/format/HdfLibrary.h"
#include "DSMVolumeFiles/format/VolumeShape.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vol
{

/// Lengths of a dataset's axes, the slowest first. The caller has GetHdfLock.
std::vector<hsize_t> GetHdfShape(hid_t dataset);
/// For messages: "1 x 40 x 48 x 56".
std::string DescribeHdfShape(const std::vector<hsize_t>& shape);

/// The axes of an HDF5 dataset that holds a volume, the slowest first: any of length 1, of which one may be time instead;
/// three in space; maybe one of components.
struct HdfAxes
{
  std::size_t Rank = 0;
  std::optional<std::size_t> Time; ///< which one
  std::size_t Space = 0;           ///< the first one in space
  SpaceOrder Order = FastestX;
  hsize_t Frames = 0; ///< along the axis of time; 0: it has none
  bricks::Index3 Samples{ 0 };
  hsize_t Components = 0; ///< along a last axis; 0: it has none

  VolumeShape GetShape() const
  {
    return { this->Samples, static_cast<std::int64_t>(this->Frames) };
  }
  enum class Kind
  {
    Unknown, ///< where names tell nothing, a short last axis of four or more has components
    Still,   ///< of four axes the last one has components
    InTime   ///< the first one is time
  };
  /// `notes`: what is known of the axes, or none. Returns false for what is no volume. `tooLong`: set to what an axis of a
  /// volume has more of than FileLimits allow, such as "time steps"; then it returns false, too.
  bool Find(const std::vector<hsize_t>& shape, Kind kind, const AxisNotes& notes,
    std::string* tooLong = nullptr);

  /// Throws dsm::Error, which says that a dataset declares what is `tooLong`.
  [[noreturn]] static void RefuseLength(
    const std::string& path, const std::string& dataset, const std::string& tooLong);

  /// Samples of a box of chunks of so many samples along each axis of the dataset.
  bricks::Index3 GetSpace(const std::vector<hsize_t>& edges) const;
  /// Boxes of samples in such a chunk, of the axes before those in space.
  hsize_t CountSlices(const std::vector<hsize_t>& edges) const;
};

} // namespace vol

#endif
