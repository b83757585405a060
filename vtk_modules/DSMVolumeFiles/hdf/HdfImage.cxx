// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/hdf/HdfImage.h"

#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/FileLimits.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace vol
{

namespace
{

std::vector<double> ReadTimes(hid_t group, const std::string& path)
{
  std::vector<double> times;
  if (H5Lexists(group, "Steps", H5P_DEFAULT) <= 0)
  {
    return times;
  }
  const HdfHandle steps(H5Gopen2(group, "Steps", H5P_DEFAULT), &H5Gclose);
  if (!ReadHdfWhole(steps.Get(), "Values", H5T_NATIVE_DOUBLE, FileLimits::Steps, times))
  {
    throw FileError(path,
      "has an invalid header: Steps/Values declares more than " +
        std::to_string(FileLimits::Steps) + " time steps.");
  }
  const bool areNumbers =
    std::all_of(times.begin(), times.end(), [](double time) { return std::isfinite(time); });
  if (!areNumbers || !std::is_sorted(times.begin(), times.end(), std::less_equal<>()))
  {
    throw FileError(path,
      std::string("has invalid time steps: Steps/Values ") +
        (areNumbers ? "is not in ascending order." : "contains values that are not finite."));
  }
  return times;
}

} // namespace

HdfImage HdfImage::Read(hid_t group, const std::string& path)
{
  HdfImage image;
  long long extent[6];
  if (!ReadHdfAttribute(group, "WholeExtent", H5T_NATIVE_LLONG, extent, 6))
  {
    throw FileError(path,
      "is a VTKHDF file without image data (no WholeExtent). Open it with ParaView's VTKHDF "
      "reader.");
  }
  FileGeometry& geometry = image.Geometry;
  ReadHdfAttribute(group, "Origin", H5T_NATIVE_DOUBLE, geometry.Origin, 3);
  ReadHdfAttribute(group, "Spacing", H5T_NATIVE_DOUBLE, geometry.Spacing, 3);
  ReadHdfAttribute(group, "Direction", H5T_NATIVE_DOUBLE, geometry.Direction, 9);
  // VTK's indices are int.
  constexpr long long farthest = FileLimits::Samples;
  for (int axis = 0; axis < 3; ++axis)
  {
    const long long first = extent[2 * axis];
    const long long last = extent[2 * axis + 1];
    if (first < -farthest - 1 || last >= farthest || last < first || last - first >= farthest)
    {
      throw FileError(path,
        "has an invalid header: its WholeExtent is " + std::to_string(first) + " to " +
          std::to_string(last) + " along " + "xyz"[axis] + ".");
    }
    geometry.First[axis] = first;
    geometry.Points[axis] = last - first + 1;
  }
  image.Times = ReadTimes(group, path);
  return image;
}

} // namespace vol
