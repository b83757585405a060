// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/HdfAxes.h"

#include "DSMVolumeFiles/base/FileLimits.h"

#include <algorithm>
#include <vector>

namespace vol
{

namespace
{

/// Components that a last axis may stand for.
constexpr hsize_t MostComponents = 9;

std::vector<hsize_t> GetDimensions(hid_t dataset)
{
  const HdfHandle space(H5Dget_space(dataset), &H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space.Get());
  std::vector<hsize_t> shape(static_cast<std::size_t>(std::max(0, rank)));
  if (rank > 0)
  {
    H5Sget_simple_extent_dims(space.Get(), shape.data(), nullptr);
  }
  return shape;
}

} // namespace

bool HdfAxes::Find(hid_t dataset, Time time, std::string* tooLong)
{
  const std::vector<hsize_t> shape = GetDimensions(dataset);
  const bool isShort = !shape.empty() && (time != Time::Unknown || shape.back() <= MostComponents);
  const std::size_t axes = shape.size();
  if (axes < 3 || axes > 5 || (axes == 5 && (!isShort || time == Time::None)) ||
    std::find(shape.begin(), shape.end(), hsize_t(0)) != shape.end())
  {
    return false;
  }
  const bool hasTime = axes == 5 || (axes == 4 && (time == Time::First || !isShort));
  const std::size_t first = hasTime ? 1 : 0;
  const bool hasComponents = axes - first == 4;
  const auto exceeds = [&](std::size_t axis, std::uint64_t most, const char* what)
  {
    if (shape[axis] > most && tooLong)
    {
      *tooLong = std::to_string(shape[axis]) + " " + what + "; at most " + std::to_string(most) +
        " are supported";
    }
    return shape[axis] > most;
  };
  if ((hasTime && exceeds(0, FileLimits::Steps, "time steps")) ||
    (hasComponents && exceeds(axes - 1, FileLimits::Components, "components")) ||
    exceeds(first, FileLimits::Samples, "samples along z") ||
    exceeds(first + 1, FileLimits::Samples, "samples along y") ||
    exceeds(first + 2, FileLimits::Samples, "samples along x"))
  {
    return false;
  }
  this->Frames = hasTime ? shape.front() : 0;
  this->Components = hasComponents ? shape.back() : 0;
  this->Samples = { static_cast<std::int64_t>(shape[first + 2]),
    static_cast<std::int64_t>(shape[first + 1]), static_cast<std::int64_t>(shape[first]) };
  return true;
}

} // namespace vol
