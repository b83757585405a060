// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfAxes_h
#define vol_HdfAxes_h

#include "DSMBricks/base/Box.h"
#include "DSMVolumeFiles/format/AxisNotes.h"
#include "DSMVolumeFiles/format/VolumeShape.h"
#include "DSMVolumeFiles/hdf/HdfLibrary.h"

#include <array>
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

/// The axes of an HDF5 dataset that holds a volume, the slowest first: three in space, or two where
/// a name says that another one is time or channels; maybe one of time; maybe one of components
/// behind those in space. Each position along further axes is a volume of its own.
struct HdfAxes
{
  std::vector<hsize_t> Lengths;
  std::optional<std::size_t> Time; ///< which one
  /// The axes in space, the slowest first. If there are only two, the first of the three is empty: it would have
  /// one sample.
  std::array<std::optional<std::size_t>, 3> Space;
  SpaceOrder Order = FastestX; ///< of these
  std::optional<std::size_t> Component;
  std::vector<std::size_t> Further; ///< of more than one position
  std::vector<hsize_t> Place;       ///< of the volume along the further axes; 0 along all others

  hsize_t Frames = 0; ///< along the axis of time; 0: it has none
  bricks::Index3 Samples{ 0 };
  hsize_t Components = 0; ///< 0: it has no axis of them

  VolumeShape GetShape() const
  {
    return { this->Samples, static_cast<std::int64_t>(this->Frames) };
  }
  enum class Kind
  {
    Unknown, ///< as FindByNames does
    Still,   ///< of four axes the last one has components
    InTime   ///< the first one is time
  };
  /// `notes`: what is known of the axes, or none. Returns false if the dataset is not a volume. `tooLong`: set to
  /// what an axis of a volume has more of than FileLimits allow, such as "time steps"; then it returns false, too.
  bool Find(const std::vector<hsize_t>& shape, Kind kind, const AxisNotes& notes,
    std::string* tooLong = nullptr);

  /// Throws dsm::Error, which says that a dataset declares what is `tooLong`.
  [[noreturn]] static void RefuseLength(
    const std::string& path, const std::string& dataset, const std::string& tooLong);

  /// The volumes at each position along the further axes, the last axis fastest.
  std::vector<HdfAxes> Split() const;

  /// Samples of a box of chunks of so many samples along each axis of the dataset.
  bricks::Index3 GetSpace(const std::vector<hsize_t>& edges) const;
  /// Boxes of samples in such a chunk, of the axes of time and further ones.
  hsize_t CountSlices(const std::vector<hsize_t>& edges) const;
  /// Which one of these has the volume at a frame.
  hsize_t FindSlice(const std::vector<hsize_t>& edges, hsize_t frame) const;
  /// The number of a chunk, along all axes of which the last one is the fastest. `chunk`: in space.
  std::uint64_t FindChunk(
    const std::vector<hsize_t>& edges, hsize_t frame, const bricks::Index3& chunk) const;
  /// Returns whether the samples of such a box lie together: the axes in space are behind all
  /// others but the components'.
  bool IsTogether() const;
  /// Returns whether a chunk at a place, in chunks along each axis, has samples of the volume at
  /// any frame.
  bool Has(const std::uint64_t* place, const std::vector<hsize_t>& edges) const;

private:
  /// Axes have the meaning of their names. Without names, the last three are in space: of four and
  /// more axes, the last one has components where it is short, and one of the others, with more
  /// than one position, is time.
  bool FindByNames(const AxisNotes& notes);
  bool FindInOrder(Kind kind);
  bool IsInSpace(std::size_t axis) const;
  hsize_t GetPlace(std::size_t axis, hsize_t frame) const
  {
    return axis == this->Time ? frame : this->Place[axis];
  }
};

} // namespace vol

#endif
