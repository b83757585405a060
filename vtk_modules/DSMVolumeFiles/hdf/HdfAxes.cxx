// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/hdf/HdfAxes.h"

#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/FileLimits.h"

#include <algorithm>
#include <utility>

namespace vol
{

namespace
{

constexpr std::size_t InSpace = 3;
/// Components that a last axis may stand for.
constexpr hsize_t MostComponents = 9;
/// Volumes in a dataset, each of which becomes an array.
constexpr hsize_t MostVolumes = 1000;

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

bool HdfAxes::IsInSpace(std::size_t axis) const
{
  return std::find(this->Space.begin(), this->Space.end(), axis) != this->Space.end();
}

bool HdfAxes::FindInOrder(Kind kind)
{
  const std::size_t first = kind == Kind::InTime && this->Lengths.size() > InSpace ? 1 : 0;
  const std::size_t behind = this->Lengths.size() - first - InSpace;
  if (behind > 1)
  {
    return false;
  }
  this->Time = first > 0 ? std::optional<std::size_t>(0) : std::nullopt;
  this->Component = behind > 0 ? std::optional<std::size_t>(first + InSpace) : std::nullopt;
  this->Space = { first, first + 1, first + 2 };
  return true;
}

bool HdfAxes::FindByNames(const AxisNotes& notes)
{
  std::vector<std::size_t> left; // may be in space
  bool areNamed = false;
  for (std::size_t axis = 0; axis < notes.size(); ++axis)
  {
    const std::string type = notes[axis].GetType();
    if (type == "time")
    {
      const bool isFirst = !this->Time || this->Lengths[*this->Time] == 1;
      this->Time = isFirst ? axis : this->Time;
    }
    else if (type == "channel")
    {
      this->Component = axis;
    }
    else
    {
      left.push_back(axis);
    }
    areNamed = areNamed || type == "time" || type == "channel" || notes[axis].FindSpaceAxis();
  }
  if (!this->Component && left.size() > InSpace && !notes[left.back()].FindSpaceAxis() &&
    this->Lengths[left.back()] <= MostComponents)
  {
    this->Component = left.back();
    left.pop_back();
  }
  // Letters come before other names, and the last axes before those in front.
  const auto getRank = [&](std::size_t axis) {
    return !notes[axis].FindSpaceAxis() ? 2 : notes[axis].Name.size() > 1 ? 1 : 0;
  };
  std::reverse(left.begin(), left.end());
  std::stable_sort(left.begin(), left.end(),
    [&](std::size_t a, std::size_t b) { return getRank(a) < getRank(b); });
  left.resize(std::min(left.size(), InSpace));
  std::sort(left.begin(), left.end());
  if (left.size() + 1 < InSpace)
  {
    return false;
  }
  std::copy(left.rbegin(), left.rend(), this->Space.rbegin());
  AxisNotes inSpace;
  for (const auto& axis : this->Space)
  {
    inSpace.push_back(axis ? notes[*axis] : AxisNote());
  }
  const std::optional<SpaceOrder> order = FindSpaceOrder(inSpace, 0);
  this->Order = order.value_or(FastestX);
  if (this->Component && *this->Component < left.back())
  {
    this->Component.reset(); // each channel is a volume
  }
  std::vector<std::size_t> others;
  for (std::size_t axis = 0; axis < notes.size(); ++axis)
  {
    if (this->Lengths[axis] > 1 && !this->IsInSpace(axis) && axis != this->Time &&
      axis != this->Component)
    {
      others.push_back(axis);
    }
  }
  const bool isFirst = others.size() == 1 && others.front() < left.front();
  if (isFirst && !this->Time && notes[others.front()].GetType().empty() &&
    !notes[others.front()].FindSpaceAxis())
  {
    this->Time = others.front();
    others.clear();
  }
  this->Further = std::move(others);
  return order && (areNamed || this->Further.empty());
}

bool HdfAxes::Find(
  const std::vector<hsize_t>& shape, Kind kind, const AxisNotes& notes, std::string* tooLong)
{
  this->Lengths = shape;
  this->Place.assign(shape.size(), 0);
  if (shape.size() < InSpace || std::count(shape.begin(), shape.end(), hsize_t(0)) > 0)
  {
    return false;
  }
  const bool isFound = kind == Kind::Unknown
    ? this->FindByNames(notes.size() == shape.size() ? notes : AxisNotes(shape.size()))
    : this->FindInOrder(kind);
  if (!isFound)
  {
    return false;
  }
  const auto exceeds = [&](hsize_t count, std::uint64_t most, const std::string& what)
  {
    if (count > most && tooLong)
    {
      *tooLong =
        std::to_string(count) + " " + what + "; at most " + std::to_string(most) + " are supported";
    }
    return count > most;
  };
  hsize_t volumes = 1;
  for (const std::size_t axis : this->Further)
  {
    volumes = MultiplyWithin(FileLimits::ArrayBytes, { volumes, shape[axis] })
                .value_or(FileLimits::ArrayBytes);
  }
  this->Frames = this->Time ? shape[*this->Time] : 0;
  this->Components = this->Component ? shape[*this->Component] : 0;
  bool isTooLong = exceeds(this->Frames, FileLimits::Steps, "time steps") ||
    exceeds(this->Components, FileLimits::Components, "components") ||
    exceeds(volumes, MostVolumes, "positions along axes other than space, time and components");
  for (std::size_t place = 0; place < InSpace && !isTooLong; ++place)
  {
    const hsize_t count = this->Space[place] ? shape[*this->Space[place]] : 1;
    isTooLong = exceeds(count, FileLimits::Samples,
      std::string("samples along ") + "xyz"[static_cast<std::size_t>(this->Order[place])]);
  }
  this->Samples = isTooLong ? bricks::Index3(0) : this->GetSpace(shape);
  return !isTooLong;
}

std::vector<HdfAxes> HdfAxes::Split() const
{
  std::vector<HdfAxes> all{ *this };
  for (const std::size_t axis : this->Further)
  {
    std::vector<HdfAxes> more;
    for (const HdfAxes& one : all)
    {
      for (hsize_t place = 0; place < this->Lengths[axis]; ++place)
      {
        more.push_back(one);
        more.back().Place[axis] = place;
      }
    }
    all = std::move(more);
  }
  return all;
}

void HdfAxes::RefuseLength(
  const std::string& path, const std::string& dataset, const std::string& tooLong)
{
  throw FileError(
    path, "has an invalid header: its dataset '" + dataset + "' declares " + tooLong + ".");
}

bricks::Index3 HdfAxes::GetSpace(const std::vector<hsize_t>& edges) const
{
  bricks::Index3 space(1);
  for (std::size_t place = 0; place < InSpace; ++place)
  {
    if (this->Space[place])
    {
      space[this->Order[place]] = static_cast<std::int64_t>(edges[*this->Space[place]]);
    }
  }
  return space;
}

hsize_t HdfAxes::CountSlices(const std::vector<hsize_t>& edges) const
{
  hsize_t count = 1;
  for (std::size_t axis = 0; axis < edges.size(); ++axis)
  {
    const bool isOther = !this->IsInSpace(axis) && axis != this->Component;
    count = MultiplyWithin(FileLimits::ArrayBytes, { count, isOther ? edges[axis] : 1 })
              .value_or(FileLimits::ArrayBytes);
  }
  return count;
}

hsize_t HdfAxes::FindSlice(const std::vector<hsize_t>& edges, hsize_t frame) const
{
  hsize_t slice = 0;
  for (std::size_t axis = 0; axis < edges.size(); ++axis)
  {
    if (!this->IsInSpace(axis) && axis != this->Component)
    {
      slice = slice * edges[axis] + this->GetPlace(axis, frame) % edges[axis];
    }
  }
  return slice;
}

std::uint64_t HdfAxes::FindChunk(
  const std::vector<hsize_t>& edges, hsize_t frame, const bricks::Index3& chunk) const
{
  std::uint64_t number = 0;
  for (std::size_t axis = 0; axis < edges.size(); ++axis)
  {
    const auto found = std::find(this->Space.begin(), this->Space.end(), axis);
    const hsize_t place = found == this->Space.end()
      ? this->GetPlace(axis, frame) / edges[axis]
      : static_cast<hsize_t>(
          chunk[this->Order[static_cast<std::size_t>(found - this->Space.begin())]]);
    const hsize_t partial = this->Lengths[axis] % edges[axis] != 0 ? 1 : 0;
    number = number * (this->Lengths[axis] / edges[axis] + partial) + place;
  }
  return number;
}

bool HdfAxes::IsTogether() const
{
  std::size_t next = this->Lengths.size() - (this->Component ? 1 : 0);
  bool isTogether = !this->Component || *this->Component == next;
  for (auto axis = this->Space.rbegin(); axis != this->Space.rend(); ++axis)
  {
    isTogether = isTogether && (!*axis || **axis == next - 1);
    --next;
  }
  return isTogether;
}

bool HdfAxes::Has(const std::uint64_t* place, const std::vector<hsize_t>& edges) const
{
  return std::all_of(this->Further.begin(), this->Further.end(),
    [&](std::size_t axis) { return place[axis] == this->Place[axis] / edges[axis]; });
}

} // namespace vol
