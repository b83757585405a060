// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/AxisNotes.h"

#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/SmallFile.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <utility>

namespace vol
{

namespace
{

/// Returns the meters of a unit of length, by its name in UDUNITS-2, which OME-Zarr and CF use. Returns nothing if
/// the unit is not a length.
std::optional<double> FindMeters(const std::string& unit)
{
  static const std::map<std::string, double> units = { { "angstrom", 1e-10 }, { "\u00c5", 1e-10 },
    { "inch", 0.0254 }, { "foot", 0.3048 }, { "feet", 0.3048 }, { "ft", 0.3048 },
    { "yard", 0.9144 }, { "mile", 1609.344 }, { "micron", 1e-6 }, { "microns", 1e-6 },
    { "parsec", 3.0856775814913673e16 }, { "pc", 3.0856775814913673e16 } };
  static const std::pair<const char*, double> prefixes[] = { { "yocto", 1e-24 }, { "zepto", 1e-21 },
    { "atto", 1e-18 }, { "femto", 1e-15 }, { "pico", 1e-12 }, { "nano", 1e-9 }, { "micro", 1e-6 },
    { "milli", 1e-3 }, { "centi", 1e-2 }, { "deci", 1e-1 }, { "deca", 1e1 }, { "hecto", 1e2 },
    { "kilo", 1e3 }, { "mega", 1e6 }, { "giga", 1e9 }, { "tera", 1e12 }, { "peta", 1e15 },
    { "exa", 1e18 }, { "zetta", 1e21 }, { "yotta", 1e24 } };
  static const std::pair<const char*, double> symbols[] = { { "pm", 1e-12 }, { "nm", 1e-9 },
    { "um", 1e-6 }, { "\u00b5m", 1e-6 }, { "\u03bcm", 1e-6 }, { "mm", 1e-3 }, { "cm", 1e-2 },
    { "dm", 1e-1 }, { "m", 1.0 }, { "km", 1e3 }, { "Mm", 1e6 } };
  for (const auto& [symbol, meters] : symbols)
  {
    if (unit == symbol)
    {
      return meters;
    }
  }
  std::string name = ToLower(unit);
  const auto known = units.find(name);
  if (known != units.end())
  {
    return known->second;
  }
  for (const char* const ending : { "meters", "metres", "meter", "metre" })
  {
    const std::size_t length = std::char_traits<char>::length(ending);
    if (name.size() >= length && name.compare(name.size() - length, length, ending) == 0)
    {
      name.resize(name.size() - length);
      const auto prefix = std::find_if(std::begin(prefixes), std::end(prefixes),
        [&](const auto& one) { return name == one.first; });
      return name.empty()              ? std::optional<double>(1.0)
        : prefix != std::end(prefixes) ? std::optional<double>(prefix->second)
                                       : std::nullopt;
    }
  }
  return std::nullopt;
}

/// Returns whether a unit is one of those that axes of weather and ocean have beside lengths:
/// angles, and what CF tells heights by.
bool IsNoLength(const std::string& unit)
{
  static const std::set<std::string> others = { "deg", "radian", "radians", "rad", "pa", "hpa",
    "kpa", "mbar", "mb", "millibar", "millibars", "bar", "dbar", "decibar", "1", "level", "layer",
    "sigma_level", "k" };
  const std::string name = ToLower(unit);
  return name.rfind("degree", 0) == 0 || others.count(name) > 0;
}

/// Multiplies positions and distances.
void Scale(double factor, AxisNote& note)
{
  note.Origin *= factor;
  note.Spacing *= factor;
  for (double& coordinate : note.Coordinates)
  {
    coordinate *= factor;
  }
}

/// Converts lengths to one unit.
void Unify(std::array<AxisNote, 3>& notes, std::vector<std::string>& warnings)
{
  std::string unit; // of the first axis that has a length
  std::string units;
  std::set<std::string> unknown;
  bool differ = false;
  for (AxisNote& note : notes)
  {
    const auto meters = FindMeters(note.Unit);
    units += (units.empty() ? "" : ", ") + (note.Unit.empty() ? "no unit" : Quote(note.Unit));
    if (!meters && IsNoLength(note.Unit))
    {
      continue;
    }
    if (!meters)
    {
      unknown.insert(note.Unit);
      continue;
    }
    unit = unit.empty() ? note.Unit : unit;
    differ = differ || note.Unit != unit;
    Scale(*meters / *FindMeters(unit), note);
  }
  if (!unknown.empty() && !unit.empty())
  {
    warnings.push_back("has axes x, y, z with the units " + units +
      ", which are not all lengths. Lengths are shown in " + Quote(unit) +
      ", the others in their own numbers.");
  }
  else if (differ)
  {
    warnings.push_back(
      "has axes x, y, z with the units " + units + ". All are shown in " + Quote(unit) + ".");
  }
}

bool Ascend(const std::vector<double>& numbers)
{
  // NaN fails the comparison.
  for (std::size_t index = 1; index < numbers.size(); ++index)
  {
    if (!(numbers[index - 1] < numbers[index]))
    {
      return false;
    }
  }
  return true;
}

/// Makes coordinates that are evenly spaced, but for rounding, origin and spacing.
void Even(AxisNote& note)
{
  constexpr double tolerance = 1e-3; // of the distance
  std::vector<double>& all = note.Coordinates;
  const double step =
    all.size() > 1 ? (all.back() - all.front()) / static_cast<double>(all.size() - 1) : 1.0;
  bool isEven = true;
  for (std::size_t index = 0; index < all.size(); ++index)
  {
    const double expected = all.front() + static_cast<double>(index) * step;
    isEven = isEven && std::abs(all[index] - expected) <= tolerance * std::abs(step);
  }
  if (isEven && !all.empty())
  {
    note.Origin = all.front();
    note.Spacing = step;
    all.clear();
  }
}

} // namespace

std::string AxisNote::GetType() const
{
  const std::string name = ToLower(this->Name);
  const std::string type = ToLower(this->Type);
  const bool isSince = ToLower(this->Unit).find(" since ") != std::string::npos;
  return !type.empty()                          ? type
    : name == "t" || name == "time" || isSince  ? "time"
    : name == "c" || name == "channel"          ? "channel"
    : name == "x" || name == "y" || name == "z" ? "space"
                                                : "";
}

std::optional<int> AxisNote::FindSpaceAxis() const
{
  static const std::map<std::string, int> names = { { "x", 0 }, { "lon", 0 }, { "longitude", 0 },
    { "easting", 0 }, { "y", 1 }, { "lat", 1 }, { "latitude", 1 }, { "northing", 1 }, { "z", 2 },
    { "lev", 2 }, { "level", 2 }, { "plev", 2 }, { "depth", 2 }, { "altitude", 2 } };
  const auto known = names.find(ToLower(this->Name));
  if (known != names.end())
  {
    return known->second;
  }
  // degree_east, degrees_E, degreesE and so on.
  const std::string unit = ToLower(this->Unit);
  const std::size_t side = unit.rfind("degree", 0) == 0
    ? unit.find_first_not_of("s_", std::char_traits<char>::length("degree"))
    : std::string::npos;
  return side == std::string::npos ? std::nullopt
    : unit[side] == 'e'            ? std::optional<int>(0)
    : unit[side] == 'n'            ? std::optional<int>(1)
                                   : std::nullopt;
}

std::optional<SpaceOrder> FindSpaceOrder(const AxisNotes& notes, std::size_t first)
{
  SpaceOrder order{ -1, -1, -1 };
  std::set<int> left{ 0, 1, 2 };
  // The letters come before other names.
  for (const bool isLetter : { true, false })
  {
    for (std::size_t place = 0; place < order.size(); ++place)
    {
      const AxisNote& note = notes[first + place];
      const auto axis = note.FindSpaceAxis();
      if (axis && (note.Name.size() == 1) == isLetter)
      {
        const bool isFree = left.erase(*axis) > 0;
        if (isLetter && !isFree)
        {
          return std::nullopt;
        }
        order[place] = isFree ? *axis : -1;
      }
    }
  }
  for (int& axis : order)
  {
    if (axis < 0)
    {
      axis = *left.rbegin();
      left.erase(axis);
    }
  }
  return order;
}

void PlaceAxes(const std::string& path, const std::array<const AxisNote*, 3>& notes,
  FileGeometry& geometry, GridCoordinates& coordinates, std::vector<std::string>& warnings)
{
  std::array<AxisNote, 3> own;
  for (std::size_t axis = 0; axis < own.size(); ++axis)
  {
    own[axis] = notes[axis] ? *notes[axis] : AxisNote();
  }
  Unify(own, warnings);
  for (int axis = 0; axis < 3; ++axis)
  {
    AxisNote& note = own[static_cast<std::size_t>(axis)];
    const auto refuse = [&](const std::string& why)
    {
      throw FileError(path,
        "has coordinates along " + std::string(1, "xyz"[axis]) + " (" + Quote(note.Name) +
          ") that " + why +
          ". Enter Spacing (and Origin) of the reader to place the samples yourself.");
    };
    if (!Ascend(note.Coordinates) &&
      !Ascend({ note.Coordinates.rbegin(), note.Coordinates.rend() }))
    {
      refuse("neither rise nor fall everywhere");
    }
    if (!std::all_of(note.Coordinates.begin(), note.Coordinates.end(),
          [](double number) { return std::isfinite(number); }))
    {
      refuse("are not finite");
    }
    Even(note);
    geometry.Origin[axis] = note.Origin;
    geometry.Spacing[axis] = note.Spacing;
    coordinates[static_cast<std::size_t>(axis)] = std::move(note.Coordinates);
  }
}

void TakeVoxelSize(const std::function<std::vector<double>(const char* attribute)>& getNumbers,
  AxisNotes& notes, const std::array<std::optional<std::size_t>, 3>& inSpace)
{
  if (!inSpace[0])
  {
    return;
  }
  const auto find = [&](const char* name)
  {
    std::vector<double> numbers = getNumbers(name);
    if (numbers.size() == notes.size())
    {
      numbers = { numbers[*inSpace[0]], numbers[*inSpace[1]], numbers[*inSpace[2]] };
    }
    const bool isRight = numbers.size() == 3 &&
      std::all_of(
        numbers.begin(), numbers.end(), [](double number) { return std::isfinite(number); });
    return isRight ? numbers : std::vector<double>();
  };
  for (const char* const name : { "element_size_um", "voxel_size", "resolution" })
  {
    const std::vector<double> sizes = find(name);
    if (!sizes.empty() && std::count(sizes.begin(), sizes.end(), 0.0) == 0)
    {
      const std::vector<double> offsets = find("offset");
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        notes[*inSpace[axis]].Spacing = sizes[axis];
        notes[*inSpace[axis]].Origin = offsets.empty() ? 0.0 : offsets[axis];
      }
      return;
    }
  }
}

void TakeUpDown(const std::string& positive, AxisNote& note)
{
  if (!positive.empty() && note.FindSpaceAxis() != 2)
  {
    note.Name = "Z";
  }
  if (ToLower(positive) == "down")
  {
    Scale(-1.0, note);
  }
}

void WarnOfOtherPlaces(const std::function<std::string(const char* attribute)>& getText,
  const std::function<std::size_t(const std::string& name)>& countAxes,
  std::vector<std::string>& warnings)
{
  std::istringstream words(getText("coordinates"));
  std::string curved;
  for (std::string word; words >> word;)
  {
    if (IsPlainName(word) && countAxes(word) > 1)
    {
      curved += (curved.empty() ? "'" : ", '") + word + "'";
    }
  }
  if (!curved.empty())
  {
    warnings.push_back("has 'coordinates' of several axes (" + curved +
      "), which are not honored. Its arrays are shown along their own axes.");
  }
  const std::string mapping = getText("grid_mapping");
  if (!mapping.empty())
  {
    warnings.push_back("has the 'grid_mapping' " + Quote(mapping) +
      ", which is not honored. Its arrays are shown at the coordinates of their axes.");
  }
}

std::vector<double> FindTimes(const AxisNote& note, int steps, std::vector<std::string>& warnings)
{
  std::vector<double> times = note.Coordinates;
  if (times.empty())
  {
    for (int step = 0; step < steps && (note.Origin != 0.0 || note.Spacing != 1.0); ++step)
    {
      times.push_back(note.Origin + step * note.Spacing);
    }
  }
  const bool isRight = times.size() == static_cast<std::size_t>(steps) && Ascend(times) &&
    (times.empty() || (std::isfinite(times.front()) && std::isfinite(times.back())));
  if (!isRight && !times.empty())
  {
    warnings.push_back("has times (" + Quote(note.Name) +
      ") that do not rise from step to step, or are not finite. The times of its steps are their "
      "numbers.");
  }
  return isRight ? times : std::vector<double>();
}

} // namespace vol
