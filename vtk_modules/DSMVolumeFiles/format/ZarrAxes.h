// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ZarrAxes_h
#define vol_ZarrAxes_h

#include "DSMBricks/base/Box.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vol
{

/// What the axes of a Zarr array are, of which the slowest is the first. The last three are in space, or those before a
/// last one that has the components of a sample; those before them are time, or channels.
struct ZarrAxes
{
  static constexpr std::size_t InSpace = 3;

  int Time = -1;            ///< which one; -1: none
  std::int64_t Leading = 0; ///< how many are before those of space
  std::size_t Behind = 0;   ///< how many are behind them: 1 where the last one has components
  bool FromX = false;       ///< those of space are x, y, z, not z, y, x

  /// Of an array of so many axes, at least three, in this folder. `named`: names, or what OME says of each; null, or
  /// of another count, where it is not told: then the first of five is time. Case does not count, and of a name that
  /// is not known nothing is. A last one of four or five that has channels has components. Throws dsm::Error where the
  /// last three of the others, and no more, are not in space, or in another order.
  static ZarrAxes Find(const std::string& folder, const nlohmann::json& named, std::size_t count);

  /// Which one of an array, or of its transformation, of so many axes is x, y or z.
  std::size_t FindInSpace(std::size_t count, int axis) const;
  /// Of the shape of an array, or of its chunks.
  bricks::Index3 GetSpace(const std::vector<std::int64_t>& shape) const;
  /// Likewise; 1 where no axis has them.
  std::int64_t GetComponents(const std::vector<std::int64_t>& shape) const
  {
    return this->Behind > 0 ? shape.back() : 1;
  }
};

} // namespace vol

#endif
