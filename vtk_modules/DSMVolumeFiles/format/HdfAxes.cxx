// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/HdfAxes.h"

#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/FileLimits.h"

#include <algorithm>

namespace vol
{

namespace
{

constexpr std::size_t InSpace = 3;
/// Components that a last axis may stand for.
constexpr hsize_t MostComponents = 9;

} // namespace

std::vector<hsize_t> GetHdfShape(hid_t dataset)
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

std::string DescribeHdfShape(const std::vector<hsize_t>& shape)
{
  std::string text;
  for (const hsize_t length : shape)
  {
    text += (text.empty() ? "" : " x ") + std::to_string(length);
  }
  return text;
}

bool HdfAxes::Find(
  const std::vector<hsize_t>& shape, Kind kind, const AxisNotes& notes, std::string* tooLong)
{
  this->Rank = shape.size();
  if (this->Rank < InSpace || std::count(shape.begin(), shape.end(), hsize_t(0)) > 0)
  {
    return false;
  }
  const bool areNamed = kind == Kind::Unknown && notes.size() == this->Rank;
  bool hasComponents = false;
  if (kind != Kind::Unknown)
  {
    hasComponents = this->Rank == InSpace + (kind == Kind::InTime ? 2 : 1);
  }
  else if (this->Rank > InSpace)
  {
    const bool isInSpace = areNamed && notes.back().FindSpaceAxis();
    hasComponents = (areNamed && notes.back().GetType() == "channel") ||
      (!isInSpace && shape.back() <= MostComponents);
  }
  this->Space = this->Rank - InSpace - (hasComponents ? 1 : 0);
  for (std::size_t axis = 0; axis < this->Space; ++axis)
  {
    const bool isTime = areNamed && notes[axis].GetType() == "time";
    const bool isFirst = !this->Time || shape[*this->Time] == 1;
    if ((isTime || shape[axis] > 1) && !isFirst)
    {
      return false;
    }
    this->Time = isTime || isFirst ? axis : this->Time;
  }
  if ((kind == Kind::Still && this->Time) || (kind == Kind::InTime && this->Space > 1))
  {
    return false;
  }
  const auto exceeds = [&](std::size_t axis, std::uint64_t most, const char* what)
  {
    if (shape[axis] > most && tooLong)
    {
      *tooLong = std::to_string(shape[axis]) + " " + what + "; at most " + std::to_string(most) +
        " are supported";
    }
    return shape[axis] > most;
  };
  if ((this->Time && exceeds(*this->Time, FileLimits::Steps, "time steps")) ||
    (hasComponents && exceeds(this->Rank - 1, FileLimits::Components, "components")) ||
    exceeds(this->Space, FileLimits::Samples, "samples along z") ||
    exceeds(this->Space + 1, FileLimits::Samples, "samples along y") ||
    exceeds(this->Space + 2, FileLimits::Samples, "samples along x"))
  {
    return false;
  }
  if (areNamed)
  {
    this->Order = FindSpaceOrder(notes, this->Space).value_or(FastestX);
  }
  this->Frames = this->Time ? shape[*this->Time] : 0;
  this->Components = hasComponents ? shape.back() : 0;
  this->Samples = this->GetSpace(shape);
  return true;
}

void HdfAxes::RefuseLength(
  const std::string& path, const std::string& dataset, const std::string& tooLong)
{
  throw FileError(
    path, "has an invalid header: its dataset '" + dataset + "' declares " + tooLong + ".");
}

bricks::Index3 HdfAxes::GetSpace(const std::vector<hsize_t>& edges) const
{
  bricks::Index3 space;
  for (std::size_t place = 0; place < InSpace; ++place)
  {
    space[this->Order[place]] = static_cast<std::int64_t>(edges[this->Space + place]);
  }
  return space;
}

hsize_t HdfAxes::CountSlices(const std::vector<hsize_t>& edges) const
{
  hsize_t count = 1;
  for (std::size_t axis = 0; axis < this->Space; ++axis)
  {
    count = MultiplyWithin(FileLimits::ArrayBytes, { count, edges[axis] })
              .value_or(FileLimits::ArrayBytes);
  }
  return count;
}

} // namespace vol
