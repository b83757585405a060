// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_OmeScales_h
#define vol_OmeScales_h

#include "DSMVolumeFiles/format/AxisNotes.h"

#include <nlohmann/json.hpp>

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vol
{

/// A level of detail of OME-Zarr (0.1 to 0.6): its array, its axes, and where they lie.
struct OmeLevel
{
  std::string Array; ///< path of the array in the group
  /// Of the array's axes; empty in 0.1 and 0.2, which have no names.
  AxisNotes Axes;
  /// Columns are the directions of x, y and z, row by row, where they are not along the world's axes; as in
  /// FileGeometry::Direction.
  std::optional<std::array<double, 9>> Direction;

  /// Returns the numbers of an array in the group.
  using ReadNumbers = std::function<std::vector<double>(const std::string& path)>;
  /// `folder`: the group. `scale`: one of its "multiscales"; `level`: one of its datasets. If `readNumbers` is
  /// empty, all transformations are left out. Coarser levels of an image whose levels have scales only lie as means
  /// of the finest level's samples do. Throws dsm::Error, which names the folder, and the transformation if it
  /// cannot be shown.
  static OmeLevel Find(const std::string& folder, const nlohmann::json& scale, std::size_t level,
    const ReadNumbers& readNumbers, std::vector<std::string>& warnings);
};

} // namespace vol

#endif
