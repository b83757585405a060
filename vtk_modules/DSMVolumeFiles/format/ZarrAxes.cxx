// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/ZarrAxes.h"

#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/format/HeaderText.h"
#include "DSMVolumeFiles/format/ZarrJson.h"

namespace vol
{

namespace
{

using Json = nlohmann::json;

std::string GetText(const Json& axis, const char* field)
{
  const Json& found = axis.is_object() ? ZarrJson::Find(axis, field) : axis;
  return found.is_string() ? found.get<std::string>() : std::string();
}

std::string GetName(const Json& axis)
{
  return HeaderText::ToLower(GetText(axis, "name"));
}

/// "time", "channel" or "space"; empty where it is not told.
std::string FindType(const Json& axis)
{
  const std::string name = GetName(axis);
  const std::string type =
    axis.is_object() ? HeaderText::ToLower(GetText(axis, "type")) : std::string();
  return !type.empty()                          ? type
    : name == "t" || name == "time"             ? "time"
    : name == "c" || name == "channel"          ? "channel"
    : name == "x" || name == "y" || name == "z" ? "space"
                                                : "";
}

/// Returns whether the names allow the axes from this one on to be these three.
bool MayBe(const Json& named, std::size_t first, const std::string& order)
{
  const std::string known = "xyz";
  bool isRight = true;
  for (std::size_t place = 0; place < order.size(); ++place)
  {
    const std::string name = GetName(named[first + place]);
    isRight = isRight &&
      (name.size() != 1 || known.find(name) == std::string::npos || name[0] == order[place]);
  }
  return isRight;
}

[[noreturn]] void Refuse(const std::string& folder, const Json& named)
{
  std::string names;
  for (const Json& axis : named)
  {
    names += (names.empty() ? "" : ", ") + GetText(axis, "name");
  }
  throw FileError(folder,
    "is not a volume that can be read. Its axes are " + Quote(names) +
      ". It needs exactly three spatial axes, in the order z, y, x or x, y, z, and after them at "
      "most one axis of channels. Write it with its axes in that order.");
}

} // namespace

ZarrAxes ZarrAxes::Find(const std::string& folder, const Json& named, std::size_t count)
{
  ZarrAxes found;
  found.Leading = static_cast<std::int64_t>(count - InSpace);
  if (!named.is_array() || named.size() != count)
  {
    found.Time = found.Leading == 2 ? 0 : -1;
    return found;
  }
  found.Behind = count > InSpace && FindType(named.back()) == "channel" ? 1 : 0;
  found.Leading -= static_cast<std::int64_t>(found.Behind);
  const auto first = static_cast<std::size_t>(found.Leading);
  for (std::size_t axis = 0; axis < first + InSpace; ++axis)
  {
    const std::string type = FindType(named[axis]);
    if (axis < first ? type == "space" : !type.empty() && type != "space")
    {
      Refuse(folder, named);
    }
    found.Time = type == "time" ? static_cast<int>(axis) : found.Time;
  }
  found.FromX = !MayBe(named, first, "zyx");
  if (found.FromX && !MayBe(named, first, "xyz"))
  {
    Refuse(folder, named);
  }
  return found;
}

std::size_t ZarrAxes::FindInSpace(std::size_t count, int axis) const
{
  const auto place = static_cast<std::size_t>(axis);
  const std::size_t end = count - this->Behind;
  return this->FromX ? end - InSpace + place : end - 1 - place;
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
