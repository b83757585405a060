// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ZarrAxes_h
#define vol_ZarrAxes_h

#include "DSMBricks/base/Box.h"
#include "DSMVolumeFiles/format/AxisNotes.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vol
{

/// Meaning of the axes of a Zarr array, the slowest axis first. The last three are in space, or the three before a
/// last axis that has the components of a sample; those before them are time, or channels.
struct ZarrAxes
{
  static constexpr std::size_t InSpace = 3;

  int Time = -1;            ///< which one; -1: none
  std::int64_t Leading = 0; ///< how many are before those of space
  std::size_t Behind = 0;   ///< how many are behind them: 1 where the last one has components
  SpaceOrder Order = FastestX;

  /// Finds the axes of an array in this folder that has `count` axes, at least three. `notes`: as many, or else
  /// nothing is known, and the first of five axes is time. A last axis of four or five that has channels has
  /// components. Throws dsm::Error if the last three of the other axes, and only these, are not in space.
  static ZarrAxes Find(const std::string& folder, const AxisNotes& notes, std::size_t count);

  /// Which one of an array, or of its transformation, of so many axes is x, y or z.
  std::size_t FindInSpace(std::size_t count, int axis) const;
  /// Returns the extents in space, from the shape of an array or of its chunks.
  bricks::Index3 GetSpace(const std::vector<std::int64_t>& shape) const;
  /// Likewise, the number of components; 1 if no axis has them.
  std::int64_t GetComponents(const std::vector<std::int64_t>& shape) const
  {
    return this->Behind > 0 ? shape.back() : 1;
  }
};

} // namespace vol

#endif
