// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/plain/BareFile.h"
#include "DSMVolumeFiles/plain/HeaderFiles.h"
#include "DSMVolumeFiles/plain/HeaderText.h"
#include "DSMVolumeFiles/plain/NrrdSpace.h"
#include "DSMVolumeFiles/plain/ValueNames.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

namespace vol
{

namespace
{

bricks::ScalarType ParseNrrdType(const HeaderText& header)
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
  const auto known = types.find(ToLower(header.Get("type")));
  if (known == types.end())
  {
    header.Refuse("scalar type " + Quote(header.Get("type")) +
      " is not supported. Integers of 8 to 64 bits, 'float' and 'double' are.");
  }
  return known->second;
}

/// Returns which of four axes has the components, where the header says nothing of them: the first
/// one, as is usual, or else the last one, if that alone is short enough.
std::size_t GuessComponents(const HeaderText& header, const std::vector<std::int64_t>& sizes,
  std::vector<std::string>& warnings)
{
  constexpr std::int64_t most = 9; // a tensor's
  const std::int64_t first = sizes.front();
  const std::int64_t last = sizes.back();
  if (first <= most && (first <= last || last > most))
  {
    return 0;
  }
  if (first <= most || last > most)
  {
    header.Refuse("it has four axes (" + header.Get("sizes") +
      ") without 'kinds', and its components may lie along the first one or the last one. Add the "
      "line 'kinds: vector domain domain domain' or 'kinds: domain domain domain vector' to the "
      "header. If an axis is time, save each time step as a separate file.");
  }
  if (last > 1)
  {
    warnings.push_back("has four axes (" + header.Get("sizes") +
      ") without 'kinds': the last one is taken for components.");
  }
  return sizes.size() - 1;
}

/// Returns which axes are those of space; what lies along the others are components.
std::vector<std::size_t> FindDomain(const HeaderText& header,
  const std::vector<std::int64_t>& sizes, std::vector<std::string>& warnings)
{
  const std::size_t axes = sizes.size();
  std::vector<std::string> kinds = HeaderText::Split(ToLower(header.Get("kinds")));
  if (kinds.size() != axes)
  {
    kinds.assign(axes, "none");
  }
  const auto directions = ParseNrrdVectors(header, "space directions");
  std::vector<std::optional<bool>> inSpace(axes); // none: nothing is told
  for (std::size_t axis = 0; axis < axes; ++axis)
  {
    const std::string& kind = kinds[axis];
    if (kind == "time")
    {
      header.Refuse("one of its axes is time. Save each time step as a separate file.");
    }
    if (kind != "none" && kind != "???")
    {
      inSpace[axis] = kind == "domain" || kind == "space";
    }
    else if (directions.size() == axes)
    {
      inSpace[axis] = !directions[axis].empty();
    }
  }
  const auto known = std::count(inSpace.begin(), inSpace.end(), std::optional<bool>(true));
  if (axes == 4 && std::count(inSpace.begin(), inSpace.end(), std::nullopt) == 4)
  {
    inSpace[GuessComponents(header, sizes, warnings)] = false;
  }
  std::vector<std::size_t> domain;
  for (std::size_t axis = 0; axis < axes; ++axis)
  {
    if (inSpace[axis].value_or(known < 3))
    {
      domain.push_back(axis);
    }
  }
  return domain;
}

/// "\"mm\" \"mm\" \"\"": texts in quotation marks.
std::vector<std::string> ParseTexts(const HeaderText& header, const std::string& name)
{
  std::vector<std::string> texts;
  const std::string text = header.Get(name);
  for (std::size_t at = text.find('"'); at != std::string::npos; at = text.find('"', at))
  {
    const std::size_t end = std::min(text.find('"', at + 1), text.size());
    texts.push_back(text.substr(at + 1, end - at - 1));
    at = std::min(end + 1, text.size());
  }
  return texts;
}

/// Fields that would make another picture, and are not honored.
void AddWarnings(const HeaderText& header, const std::vector<std::size_t>& domain,
  const BareValues& values, std::vector<std::string>& warnings)
{
  for (const char* name : { "space units", "units" })
  {
    const std::vector<std::string> units = ParseTexts(header, name);
    const bool isOfSpace = std::string(name) != "units";
    std::string first;
    bool differs = false;
    for (std::size_t axis = 0;
         axis < (isOfSpace ? std::min<std::size_t>(3, units.size()) : domain.size()); ++axis)
    {
      const std::size_t number = isOfSpace ? axis : domain[axis];
      const std::string unit = number < units.size() ? units[number] : "";
      differs = differs || (!unit.empty() && !first.empty() && unit != first);
      first = first.empty() ? unit : first;
    }
    if (differs)
    {
      warnings.push_back("has different units along its axes ('" + std::string(name) + ": " +
        header.Get(name) + "'): its numbers are taken as if they were of one unit.");
    }
  }
  if (values.Components == 3 && header.Has("measurement frame"))
  {
    const auto frame = ParseNrrdVectors(header, "measurement frame");
    const std::vector<std::vector<double>> same{ { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    if (frame != same)
    {
      warnings.push_back(
        "has a 'measurement frame', which is not honored: components of vectors are "
        "shown as they are stored.");
    }
  }
  const std::vector<double> spacings = header.GetNumbers("spacings");
  const std::vector<double> thicknesses = header.GetNumbers("thicknesses");
  for (const std::size_t axis : domain)
  {
    const bool hasSpacing = header.Has("space directions") || header.Has("axis maxs") ||
      (axis < spacings.size() && std::isfinite(spacings[axis]));
    if (!hasSpacing && axis < thicknesses.size() && std::isfinite(thicknesses[axis]))
    {
      warnings.push_back(
        "has 'thicknesses' and no 'spacings' along an axis: the spacing there is 1.");
      break;
    }
  }
  if (header.Has("old min") || header.Has("old max"))
  {
    warnings.push_back(
      "has 'old min' and 'old max', which are not honored: quantized values are shown as "
      "they are stored.");
  }
}

StreamEncoding ParseEncoding(const HeaderText& header)
{
  const std::string encoding = ToLower(header.Get("encoding"));
  if (encoding == "raw")
  {
    return StreamEncoding::Plain;
  }
  if (encoding == "gzip" || encoding == "gz")
  {
    return StreamEncoding::Deflate;
  }
  if (encoding == "bzip2" || encoding == "bz2")
  {
    return StreamEncoding::Bzip2;
  }
  header.Refuse("its encoding is " + Quote(header.Get("encoding")) +
    "; 'raw', 'gzip' and 'bzip2' are supported. Convert the file, for example with 'unu save -f "
    "nrrd "
    "-e raw -i IN.nrrd -o OUT.nrrd' (Debian: teem-unu).");
}

} // namespace

std::shared_ptr<VolumeFile> OpenNrrd(const std::string& path, const OpenOptions& options)
{
  HeaderText header(path,
    { { "byte skip", "byteskip" }, { "line skip", "lineskip" }, { "data file", "datafile" },
      { "axis mins", "axismins" }, { "axis maxs", "axismaxs" }, { "old min", "oldmin" },
      { "old max", "oldmax" }, { "centers", "centerings" } });
  HeaderLines lines(path);
  std::string line;
  lines.Next(line);
  if (line.rfind("NRRD000", 0) != 0)
  {
    header.Refuse("it does not start with NRRD.");
  }
  bool isList = false; // of files: it ends the header
  while (!isList && lines.Next(line) && !HeaderText::Trim(line).empty())
  {
    // "key:=value" lines are the user's own, not fields.
    const std::size_t colon = std::min(line.find(':'), line.size());
    if (line[0] != '#' && line.compare(colon, 2, ":=") != 0)
    {
      header.AddLine(line, ":");
      const std::string name = ToLower(HeaderText::Trim(line.substr(0, colon)));
      isList = (name == "data file" || name == "datafile") &&
        IsList(line.substr(std::min(colon + 1, line.size())));
    }
  }
  const StreamEncoding encoding = ParseEncoding(header);
  const std::vector<std::int64_t> sizes = header.GetIntegers("sizes");
  BareValues values;
  const std::vector<std::size_t> domain = FindDomain(header, sizes, values.Warnings);
  const bool hasComponents = domain.size() < sizes.size();
  if (domain.size() < 2 || domain.size() > 3 || sizes.size() > domain.size() + 1)
  {
    header.Refuse("it has " + std::to_string(sizes.size()) + " axes, " +
      std::to_string(domain.size()) +
      " of them spatial. A volume has three spatial axes and may have one axis of components.");
  }
  const bool isLast = domain.front() == 0 && domain.back() + 1 == domain.size();
  if (hasComponents && domain.front() == 0 && !isLast)
  {
    header.Refuse("its axis of components is neither the first nor the last axis. Reorder the "
                  "axes, for example "
                  "with 'unu permute'.");
  }
  values.Name = header.Get("content").empty() ? options.GetArrayName(path) : header.Get("content");
  values.Components = !hasComponents ? 1 : isLast ? sizes.back() : sizes.front();
  values.ComponentsApart = hasComponents && isLast;
  values.Samples = bricks::Index3(1);
  for (std::size_t axis = 0; axis < domain.size(); ++axis)
  {
    values.Samples[static_cast<int>(axis)] = sizes[domain[axis]];
  }
  values.Type = ParseNrrdType(header);
  values.Encoding = encoding;
  const std::string endian = ToLower(header.Get("endian"));
  values.BigEndian = endian == "big";
  if (endian != "big" && endian != "little" && bricks::GetBytes(values.Type) > 1)
  {
    values.Warnings.push_back(
      "has no 'endian' that is 'big' or 'little': its values are taken for little-endian.");
  }
  // Bytes to skip are those of what is unpacked.
  const std::int64_t skip = header.GetInteger("byte skip", 0, -1);
  const bool isPlain = encoding == StreamEncoding::Plain;
  values.Offset = isPlain ? skip : 0;
  values.Skip = isPlain ? 0 : skip;
  values.Lines = header.GetInteger("line skip", 0, 0);
  if (header.Get("data file").empty())
  {
    if (lines.HasEnded())
    {
      header.Refuse("the file ends after its header: the empty line and the values are missing.");
    }
    values.Paths = { path };
    values.Least = lines.GetPlace();
    values.Offset += values.Offset < 0 ? 0 : values.Least;
  }
  else
  {
    values.Paths = FindValueFiles(header, "data file", lines, sizes);
  }
  const FileGeometry geometry = PlaceNrrd(header, domain, values.Samples, values.Warnings);
  AddWarnings(header, domain, values, values.Warnings);
  return OpenBareFile(path, values, geometry, options);
}

} // namespace vol
