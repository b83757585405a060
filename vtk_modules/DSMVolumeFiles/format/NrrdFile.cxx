// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/format/BareFile.h"
#include "DSMVolumeFiles/format/HeaderFiles.h"
#include "DSMVolumeFiles/format/HeaderText.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <vector>

namespace vol
{

namespace
{

bricks::ScalarType ParseType(const HeaderText& header)
{
  using Type = bricks::ScalarType;
  static const std::map<std::string, Type> types = { { "signed char", Type::Int8 },
    { "int8", Type::Int8 }, { "int8_t", Type::Int8 }, { "uchar", Type::UInt8 },
    { "unsigned char", Type::UInt8 }, { "uint8", Type::UInt8 }, { "uint8_t", Type::UInt8 },
    { "short", Type::Int16 }, { "short int", Type::Int16 }, { "signed short", Type::Int16 },
    { "signed short int", Type::Int16 }, { "int16", Type::Int16 }, { "int16_t", Type::Int16 },
    { "ushort", Type::UInt16 }, { "unsigned short", Type::UInt16 },
    { "unsigned short int", Type::UInt16 }, { "uint16", Type::UInt16 },
    { "uint16_t", Type::UInt16 }, { "int", Type::Int32 }, { "signed int", Type::Int32 },
    { "int32", Type::Int32 }, { "int32_t", Type::Int32 }, { "uint", Type::UInt32 },
    { "unsigned int", Type::UInt32 }, { "uint32", Type::UInt32 }, { "uint32_t", Type::UInt32 },
    { "longlong", Type::Int64 }, { "long long", Type::Int64 }, { "long long int", Type::Int64 },
    { "signed long long", Type::Int64 }, { "signed long long int", Type::Int64 },
    { "int64", Type::Int64 }, { "int64_t", Type::Int64 }, { "ulonglong", Type::UInt64 },
    { "unsigned long long", Type::UInt64 }, { "unsigned long long int", Type::UInt64 },
    { "uint64", Type::UInt64 }, { "uint64_t", Type::UInt64 }, { "float", Type::Float32 },
    { "double", Type::Float64 } };
  const auto known = types.find(HeaderText::ToLower(header.Get("type")));
  if (known == types.end())
  {
    header.Refuse("scalar type " + Quote(header.Get("type")) + " is not supported.");
  }
  return known->second;
}

/// "(1, 0, 0) (0,1,0) none" as vectors; an axis without one has none.
std::vector<std::vector<double>> ParseVectors(const HeaderText& header, const std::string& name)
{
  std::vector<std::vector<double>> vectors;
  const std::string text = header.Get(name);
  for (std::size_t at = 0; (at = text.find_first_not_of(" \t\r", at)) != std::string::npos;)
  {
    if (vectors.size() == FileLimits::Axes)
    {
      header.Refuse(
        "its field '" + name + "' has more than " + std::to_string(FileLimits::Axes) + " vectors.");
    }
    std::vector<double> numbers;
    std::size_t end = text.find_first_of(text[at] == '(' ? ")" : " \t\r", at);
    if (text[at] == '(')
    {
      if (end == std::string::npos)
      {
        header.Refuse("its field '" + name + "' has a vector without a closing parenthesis.");
      }
      std::string inner = text.substr(at + 1, end - at - 1);
      std::replace(inner.begin(), inner.end(), ',', ' ');
      numbers = header.ToNumbers(name, inner);
      ++end;
    }
    else if (const std::string word = text.substr(at, end - at); word != "none")
    {
      header.Refuse(Quote(word) + " in its field '" + name + "' is not a vector.");
    }
    vectors.push_back(numbers);
    at = std::min(end, text.size());
  }
  return vectors;
}

/// Which of its axes are those of space, or of time; what lies along the others are components.
std::vector<std::size_t> FindDomain(const HeaderText& header, std::size_t axes)
{
  const std::vector<std::string> kinds =
    HeaderText::Split(HeaderText::ToLower(header.Get("kinds")));
  const auto directions = ParseVectors(header, "space directions");
  std::vector<std::size_t> domain;
  for (std::size_t axis = 0; axis < axes; ++axis)
  {
    const std::string kind = kinds.size() == axes ? kinds[axis] : "";
    const bool isKnown = !kind.empty() && kind != "none" && kind != "???";
    const bool isDomain = isKnown ? kind == "domain" || kind == "space" || kind == "time"
      : directions.size() == axes ? !directions[axis].empty()
                                  : axes < 4 || axis > 0;
    if (isDomain && kind == "time")
    {
      header.Refuse("one of its axes is time. Save each time step as a separate file.");
    }
    if (isDomain)
    {
      domain.push_back(axis);
    }
  }
  return domain;
}

/// Sets origin and spacing along an axis of a header without vectors. "axis mins" are the positions
/// of the first samples, or of where their cells begin.
void LocateByAxis(
  const HeaderText& header, std::size_t axis, std::int64_t samples, FileGeometry& geometry, int to)
{
  const std::vector<double> spacings = header.GetNumbers("spacings");
  const std::vector<double> mins = header.GetNumbers("axis mins");
  const std::vector<double> maxs = header.GetNumbers("axis maxs");
  const auto get = [axis](const std::vector<double>& numbers)
  { return axis < numbers.size() ? numbers[axis] : std::numeric_limits<double>::quiet_NaN(); };
  const std::vector<std::string> centers =
    HeaderText::Split(HeaderText::ToLower(header.Get("centers")));
  const bool ofCells = axis < centers.size() && centers[axis] == "cell";
  double step = get(spacings);
  if (!std::isfinite(step) || step == 0.0)
  {
    const auto between = static_cast<double>(ofCells ? samples : samples - 1);
    step = between > 0.0 ? (get(maxs) - get(mins)) / between : 1.0;
  }
  step = std::isfinite(step) && step != 0.0 ? step : 1.0;
  geometry.Spacing[to] = std::abs(step);
  geometry.Direction[4 * to] = step < 0.0 ? -1.0 : 1.0;
  if (std::isfinite(get(mins)))
  {
    geometry.Origin[to] = get(mins) + (ofCells ? 0.5 * step : 0.0);
  }
}

FileGeometry ParseGeometry(
  const HeaderText& header, const std::vector<std::size_t>& domain, const bricks::Index3& samples)
{
  FileGeometry geometry;
  const auto directions = ParseVectors(header, "space directions");
  for (std::size_t place = 0; place < domain.size(); ++place)
  {
    const std::size_t number = domain[place];
    const auto axis = static_cast<int>(place);
    LocateByAxis(header, number, samples[axis], geometry, axis);
    if (number < directions.size() && directions[number].size() == 3)
    {
      const std::vector<double>& way = directions[number];
      // An axis of no length has no direction: OpenVolumeFile refuses that of all formats.
      const double length = std::hypot(way[0], way[1], way[2]);
      geometry.Spacing[axis] = length > 0.0 ? length : 1.0;
      for (std::size_t row = 0; row < 3; ++row)
      {
        geometry.Direction[3 * row + place] = way[row] / geometry.Spacing[axis];
      }
    }
  }
  const auto origin = ParseVectors(header, "space origin");
  if (!origin.empty() && origin.front().size() == 3)
  {
    std::copy_n(origin.front().begin(), 3, geometry.Origin);
  }
  return geometry;
}

} // namespace

std::shared_ptr<VolumeFile> OpenNrrd(const std::string& path)
{
  HeaderText header(path, { "byte skip", "line skip", "data file", "axis mins", "axis maxs" });
  HeaderLines lines(path);
  std::string line;
  lines.Next(line);
  if (line.rfind("NRRD000", 0) != 0)
  {
    header.Refuse("it does not start with NRRD.");
  }
  while (lines.Next(line) && !HeaderText::Trim(line).empty())
  {
    // "key:=value" lines are the user's own, not fields.
    const std::size_t colon = line.find(':');
    if (line[0] != '#' && line.compare(colon == std::string::npos ? 0 : colon, 2, ":=") != 0)
    {
      header.AddLine(line, ":");
    }
  }
  const std::string encoding = HeaderText::ToLower(header.Get("encoding"));
  if (encoding != "raw")
  {
    header.Refuse("its encoding is " + Quote(encoding) +
      ", but only 'raw' can be read in parts. Convert the file, for example with 'unu save -e "
      "raw'.");
  }
  const std::vector<std::int64_t> sizes = header.GetIntegers("sizes");
  const std::vector<std::size_t> domain = FindDomain(header, sizes.size());
  const bool hasComponents = domain.size() < sizes.size();
  if (domain.size() < 2 || domain.size() > 3 || sizes.size() > domain.size() + 1)
  {
    header.Refuse("it has " + std::to_string(sizes.size()) + " axes, " +
      std::to_string(domain.size()) +
      " of them spatial. A volume has three spatial axes and may have one axis of components.");
  }
  if (hasComponents && domain.front() == 0)
  {
    header.Refuse("its axis of components is not the first axis. Reorder the axes, for example "
                  "with 'unu permute'.");
  }
  BareValues values;
  values.Name = header.Get("content").empty() ? "values" : header.Get("content");
  values.Components = hasComponents ? sizes.front() : 1;
  values.Samples = bricks::Index3(1);
  for (std::size_t axis = 0; axis < domain.size(); ++axis)
  {
    values.Samples[static_cast<int>(axis)] = sizes[domain[axis]];
  }
  values.Type = ParseType(header);
  values.BigEndian = HeaderText::ToLower(header.Get("endian")) == "big";
  values.Offset = header.GetInteger("byte skip", 0, -1);
  if (header.GetInteger("line skip", 0) > 0)
  {
    header.Refuse("it sets 'line skip', which is not supported.");
  }
  const std::string separate = header.Get("data file");
  if (separate.empty())
  {
    if (lines.HasEnded())
    {
      header.Refuse("the file ends after its header: the empty line and the values are missing.");
    }
    values.Path = path;
    values.Least = lines.GetPlace();
    values.Offset += values.Offset < 0 ? 0 : values.Least;
  }
  else
  {
    values.Path = header.FindValues("data file");
  }
  return OpenBareFile(path, values, ParseGeometry(header, domain, values.Samples));
}

} // namespace vol
