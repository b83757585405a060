// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/plain/BareFile.h"
#include "DSMVolumeFiles/plain/HeaderFiles.h"
#include "DSMVolumeFiles/plain/HeaderText.h"
#include "DSMVolumeFiles/plain/ValueNames.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

namespace vol
{

namespace
{

bricks::ScalarType ParseElementType(const HeaderText& header)
{
  using Type = bricks::ScalarType;
  static const std::map<std::string, Type> types = { { "met_char", Type::Int8 },
    { "met_uchar", Type::UInt8 }, { "met_short", Type::Int16 }, { "met_ushort", Type::UInt16 },
    { "met_int", Type::Int32 }, { "met_uint", Type::UInt32 }, { "met_long", Type::Int32 },
    { "met_ulong", Type::UInt32 }, { "met_long_long", Type::Int64 },
    { "met_ulong_long", Type::UInt64 }, { "met_float", Type::Float32 },
    { "met_double", Type::Float64 } };
  std::string name = ToLower(header.Get("elementtype"));
  const std::string ofArray = "_array";
  if (name.size() > ofArray.size() &&
    name.compare(name.size() - ofArray.size(), ofArray.size(), ofArray) == 0)
  {
    name.resize(name.size() - ofArray.size());
  }
  const auto known = types.find(name);
  if (known == types.end())
  {
    header.Refuse("scalar type " + Quote(header.Get("elementtype")) + " is not supported.");
  }
  return known->second;
}

bool IsTrue(const HeaderText& header, const std::string& name)
{
  const std::string text = ToLower(header.Get(name));
  return !text.empty() && (text.front() == 't' || text.front() == '1');
}

} // namespace

std::shared_ptr<VolumeFile> OpenMetaImage(const std::string& path, const OpenOptions& options)
{
  HeaderText header(path);
  HeaderLines lines(path);
  std::string line;
  // The name of the values' file is the last line; they may follow it.
  while (!header.Has("elementdatafile") && lines.Next(line))
  {
    header.AddLine(line, line.find('=') != std::string::npos ? "=" : ":");
  }
  if (header.Get("elementdatafile").empty() || header.Get("ndims") != "3")
  {
    header.Refuse("it is not a three-dimensional MetaImage.");
  }
  if (header.Has("binarydata") && !IsTrue(header, "binarydata"))
  {
    header.Refuse("its values are text ('BinaryData = False'), which cannot be read in parts. Save "
                  "it as binary, for "
                  "example with ParaView's Meta Image reader and Save Data.");
  }
  BareValues values;
  values.Name = options.GetArrayName(path);
  const std::vector<std::int64_t> size = header.GetIntegers("dimsize", 3);
  for (std::size_t axis = 0; axis < size.size(); ++axis)
  {
    values.Samples[static_cast<int>(axis)] = size[axis];
  }
  values.Type = ParseElementType(header);
  values.Components = header.GetInteger("elementnumberofchannels", 1);
  values.BigEndian =
    IsTrue(header, "binarydatabyteordermsb") || IsTrue(header, "elementbyteordermsb");
  // MetaIO counts from the beginning of the file with the values, also where that has a header; -1: they end it.
  values.Offset = header.GetInteger("headersize", 0, -1);
  if (IsTrue(header, "compresseddata"))
  {
    values.Encoding = StreamEncoding::Deflate;
    values.PackedBytes = header.GetInteger("compresseddatasize", 0, 0);
    if (values.Offset < 0 && values.PackedBytes == 0)
    {
      header.Refuse("its compressed values end the file ('HeaderSize = -1'), but it has no "
                    "'CompressedDataSize'.");
    }
  }
  if (ToLower(header.Get("elementdatafile")) == "local")
  {
    if (lines.HasEnded())
    {
      header.Refuse("the file ends after its header and has no values.");
    }
    values.Paths = { path };
    values.Least = lines.GetPlace();
    values.Offset = values.Offset == 0 ? values.Least : values.Offset;
  }
  else
  {
    values.Paths = FindValueFiles(header, "elementdatafile", lines, size);
  }
  FileGeometry geometry;
  const auto take = [&](std::initializer_list<const char*> names, double* out, std::size_t count)
  {
    for (const char* name : names)
    {
      if (header.Has(name))
      {
        const std::vector<double> numbers = header.GetNumbers(name, count);
        std::copy(numbers.begin(), numbers.end(), out);
        return;
      }
    }
  };
  take({ "offset", "origin", "position" }, geometry.Origin, 3);
  take({ "elementspacing", "elementsize" }, geometry.Spacing, 3);
  for (double& step : geometry.Spacing)
  {
    step = std::abs(step); // as MetaIO reads it
  }
  double rows[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
  take({ "transformmatrix", "rotation", "orientation" }, rows, 9);
  // One axis of the image after the other.
  for (int axis = 0; axis < 3; ++axis)
  {
    for (int row = 0; row < 3; ++row)
    {
      geometry.Direction[3 * row + axis] = rows[3 * axis + row];
    }
  }
  // MetaIO leaves these to the program, and ITK and VTK show the values as they are stored.
  for (const auto& [name, field, same] :
    { std::make_tuple("elementtointensityfunctionslope", "ElementToIntensityFunctionSlope", 1.0),
      std::make_tuple(
        "elementtointensityfunctionoffset", "ElementToIntensityFunctionOffset", 0.0) })
  {
    const std::vector<double> number = header.GetNumbers(name, 1);
    if (!number.empty() && number.front() != same)
    {
      values.Warnings.push_back("has '" + std::string(field) + " = " + header.Get(name) +
        "', which is not honored: values are shown as they are stored.");
    }
  }
  return OpenBareFile(path, values, geometry, options);
}

} // namespace vol
