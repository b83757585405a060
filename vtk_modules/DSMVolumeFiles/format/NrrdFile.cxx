// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/BareFile.h"
#include "DSMVolumeFiles/format/HeaderFiles.h"
#include "DSMVolumeFiles/format/HeaderText.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <vector>

namespace vol
{

namespace
{

rt::ScalarType ParseType(const HeaderText& header)
{
  using Type = rt::ScalarType;
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
    { "longlong", Type::Int64 }, { "long long", Type::Int64 }, { "int64", Type::Int64 },
    { "int64_t", Type::Int64 }, { "ulonglong", Type::UInt64 },
    { "unsigned long long", Type::UInt64 }, { "uint64", Type::UInt64 },
    { "uint64_t", Type::UInt64 }, { "float", Type::Float32 }, { "double", Type::Float64 } };
  const auto known = types.find(HeaderText::ToLower(header.Get("type")));
  if (known == types.end())
  {
    header.Refuse("its values are of the type '" + header.Get("type") + "', which is not known.");
  }
  return known->second;
}

/// "(1,0,0) (0,1,0) none" as vectors; an axis without one has none.
std::vector<std::vector<double>> ParseVectors(const HeaderText& header, const std::string& name)
{
  std::vector<std::vector<double>> vectors;
  for (std::string word : HeaderText::Split(header.Get(name)))
  {
    std::vector<double> numbers;
    if (word != "none")
    {
      for (char& letter : word)
      {
        letter = letter == '(' || letter == ')' || letter == ',' ? ' ' : letter;
      }
      for (const std::string& number : HeaderText::Split(word))
      {
        numbers.push_back(std::strtod(number.c_str(), nullptr));
      }
    }
    vectors.push_back(numbers);
  }
  return vectors;
}

FileGeometry ParseGeometry(const HeaderText& header, std::size_t firstAxis)
{
  FileGeometry geometry;
  const std::vector<double> spacings = header.GetNumbers("spacings");
  const auto directions = ParseVectors(header, "space directions");
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const std::size_t number = firstAxis + axis;
    if (number < spacings.size() && spacings[number] > 0.0)
    {
      geometry.Spacing[axis] = spacings[number];
    }
    if (number < directions.size() && directions[number].size() == 3)
    {
      const std::vector<double>& way = directions[number];
      const double length = std::sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
      if (length > 0.0)
      {
        geometry.Spacing[axis] = length;
        for (std::size_t row = 0; row < 3; ++row)
        {
          geometry.Direction[3 * row + axis] = way[row] / length;
        }
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

std::shared_ptr<const VolumeFile> OpenNrrd(const std::string& path)
{
  HeaderText header(path);
  std::ifstream file(path, std::ios::binary);
  std::string line;
  std::getline(file, line);
  if (line.rfind("NRRD000", 0) != 0)
  {
    header.Refuse("it does not begin with NRRD.");
  }
  while (std::getline(file, line) && !HeaderText::Trim(line).empty())
  {
    if (line[0] != '#')
    {
      header.AddLine(line, ":");
    }
  }
  const std::string encoding = HeaderText::ToLower(header.Get("encoding"));
  if (encoding != "raw")
  {
    header.Refuse("its encoding is '" + encoding +
      "', and only 'raw' can be read in parts. Convert it, for example with 'unu save -e raw'.");
  }
  const std::vector<double> sizes = header.GetNumbers("sizes");
  if (sizes.size() != 3 && sizes.size() != 4)
  {
    header.Refuse("it has " + std::to_string(sizes.size()) +
      " axes; volumes have 3, or 4 with components first.");
  }
  const std::size_t firstAxis = sizes.size() - 3;
  BareValues values;
  values.Name = header.Has("content") ? header.Get("content") : "values";
  values.Components = firstAxis == 1 ? static_cast<int>(sizes[0]) : 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    values.Samples[axis] = static_cast<std::int64_t>(sizes[firstAxis + axis]);
  }
  values.Type = ParseType(header);
  values.BigEndian = HeaderText::ToLower(header.Get("endian")) == "big";
  const std::vector<double> skip = header.GetNumbers("byte skip", 1);
  values.Offset = skip.empty() ? 0 : static_cast<std::int64_t>(skip.front());
  if (!header.GetNumbers("line skip", 1).empty() && header.GetNumbers("line skip", 1).front() > 0)
  {
    header.Refuse("it skips lines of text, which is not supported.");
  }
  const std::string separate =
    header.Has("data file") ? header.Get("data file") : header.Get("datafile");
  if (separate.empty())
  {
    values.Path = path;
    values.Offset += values.Offset < 0 ? 0 : static_cast<std::int64_t>(file.tellg());
  }
  else if (separate == "LIST" || separate.find('%') != std::string::npos)
  {
    header.Refuse("its values are in several files, which is not supported.");
  }
  else
  {
    values.Path = (std::filesystem::path(path).parent_path() / separate).string();
  }
  return OpenBareFile(path, values, ParseGeometry(header, firstAxis));
}

} // namespace vol
