// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/zarr/ZarrAxes.h"

#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/SmallFile.h"

#include <algorithm>
#include <optional>

namespace vol
{

namespace
{

[[noreturn]] void Refuse(const std::string& folder, const AxisNotes& notes)
{
  std::string names;
  for (const AxisNote& note : notes)
  {
    names += (names.empty() ? "" : ", ") + note.Name;
  }
  throw FileError(folder,
    "is not a volume that can be read. Its axes are " + Quote(names) +
      ". It needs exactly three spatial axes, next to one another, and after them at most one axis "
      "of channels. Write it with its axes in that order.");
}

} // namespace

ZarrAxes ZarrAxes::Find(const std::string& folder, const AxisNotes& notes, std::size_t count)
{
  ZarrAxes found;
  found.Leading = static_cast<std::int64_t>(count - InSpace);
  const bool areKnown = std::any_of(notes.begin(), notes.end(),
    [](const AxisNote& note) { return !note.Name.empty() || !note.Type.empty(); });
  if (notes.size() != count || !areKnown)
  {
    found.Time = found.Leading == 2 ? 0 : -1;
    return found;
  }
  found.Behind = count > InSpace && notes.back().GetType() == "channel" ? 1 : 0;
  found.Leading -= static_cast<std::int64_t>(found.Behind);
  const auto first = static_cast<std::size_t>(found.Leading);
  for (std::size_t axis = 0; axis < first + InSpace; ++axis)
  {
    const std::string type = notes[axis].GetType();
    if (axis < first ? type == "space" : !type.empty() && type != "space")
    {
      Refuse(folder, notes);
    }
    found.Time = type == "time" ? static_cast<int>(axis) : found.Time;
  }
  const std::optional<SpaceOrder> order = FindSpaceOrder(notes, first);
  if (!order)
  {
    Refuse(folder, notes);
  }
  found.Order = *order;
  return found;
}

std::size_t ZarrAxes::FindInSpace(std::size_t count, int axis) const
{
  const auto place = std::find(this->Order.begin(), this->Order.end(), axis) - this->Order.begin();
  return count - this->Behind - InSpace + static_cast<std::size_t>(place);
}

bricks::Index3 ZarrAxes::GetSpace(const std::vector<std::int64_t>& shape) const
{
  bricks::Index3 space;
  for (int axis = 0; axis < 3; ++axis)
  {
    space[axis] = shape[this->FindInSpace(shape.size(), axis)];
  }
  return space;
}

} // namespace vol
