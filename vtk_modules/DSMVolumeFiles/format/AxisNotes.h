// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_AxisNotes_h
#define vol_AxisNotes_h

#include "DSMVolumeFiles/base/SpaceOrder.h"
#include "DSMVolumeFiles/format/VolumeFile.h"

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vol
{

/// The notes of a file on an axis of an array.
struct AxisNote
{
  std::string Name; ///< as written; empty: none
  std::string Type; ///< "space", "time" or "channel"; empty: none is told
  std::string Unit; ///< empty: none
  /// Position of the first sample and distance of samples.
  double Origin = 0.0;
  double Spacing = 1.0;
  /// Positions of the samples, instead of these; empty: none.
  std::vector<double> Coordinates;

  /// Returns the type that is told, or that name or unit tell ("t", "time", "days since ...", "c",
  /// "channel", "x" ...).
  std::string GetType() const;
  /// Returns 0, 1 or 2 where the name is one of x, y or z, or one of their names on the earth
  /// ("lon", "lat", "depth" ...), or the unit is one of CF's for longitudes and latitudes
  /// ("degrees_east" ...).
  std::optional<int> FindSpaceAxis() const;
};
using AxisNotes = std::vector<AxisNote>; ///< the slowest axis first

/// Which of three axes, the slowest first, are x, y and z: by the names that FindSpaceAxis knows; axes
/// without such a name, or with that of another, take those that are left, z first. None where two have one letter.
std::optional<SpaceOrder> FindSpaceOrder(const AxisNotes& notes, std::size_t first);

/// Sets origin and spacing of `geometry`, which is negative where positions fall, or `coordinates` where these are
/// not evenly spaced, from the notes for x, y and z (null: none). Lengths of different units become those of x's,
/// or of the first that has one; a sentence in `warnings` says so, or which unit is not known. Throws dsm::Error,
/// which names the file, where coordinates neither rise nor fall everywhere.
void PlaceAxes(const std::string& path, const std::array<const AxisNote*, 3>& notes,
  FileGeometry& geometry, GridCoordinates& coordinates, std::vector<std::string>& warnings);

/// Takes voxel sizes and offsets of axes of space from an array's attributes, as ilastik, Fiji (element_size_um),
/// funlib and CREMI (voxel_size or resolution, offset) write them: one number for each of these axes, or for each
/// axis, the slowest first. `inSpace`: which of the notes are those of three axes in space.
void TakeVoxelSize(const std::function<std::vector<double>(const char* attribute)>& getNumbers,
  AxisNotes& notes, const std::array<std::optional<std::size_t>, 3>& inSpace);

/// Takes CF's attribute "positive" of a coordinate variable, if it has it: the axis is z, and
/// positions that count downward change their sign, as in ParaView's own reader.
void TakeUpDown(const std::string& positive, AxisNote& note);

/// Adds a sentence to `warnings` for each of CF's attributes of places that are not along the axes of an array:
/// "coordinates" of two and more axes, and "grid_mapping" of a projection. `getText(attribute)`: of the array,
/// short; empty: none. `countAxes(name)`: of an array beside it; 0: there is none.
void WarnOfOtherPlaces(const std::function<std::string(const char* attribute)>& getText,
  const std::function<std::size_t(const std::string& name)>& countAxes,
  std::vector<std::string>& warnings);

/// Returns the times of steps: a time axis's coordinates, where they are as many and rise; else none, with a sentence
/// in `warnings` where there are other ones.
std::vector<double> FindTimes(const AxisNote& note, int steps, std::vector<std::string>& warnings);

} // namespace vol

#endif
