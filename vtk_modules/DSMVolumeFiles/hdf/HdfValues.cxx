// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/hdf/HdfValues.h"

#include "DSMVolumeFiles/base/ByteBuffer.h"

#include <algorithm>
#include <cstddef>
#include <map>

namespace vol
{

namespace
{

std::string GetMemberName(hid_t type, unsigned member)
{
  char* const read = H5Tget_member_name(type, member);
  std::string name(read ? read : "");
  H5free_memory(read);
  return name.size() > FileLimits::NameBytes ? std::string() : name;
}

/// A type of the machine's numbers, or of a compound that has nothing but such a member.
HdfHandle MakeMemoryType(bricks::ScalarType type, const std::string& member)
{
  if (member.empty())
  {
    return { H5Tcopy(GetHdfType(type)), &H5Tclose };
  }
  HdfHandle compound(H5Tcreate(H5T_COMPOUND, bricks::GetBytes(type)), &H5Tclose);
  H5Tinsert(compound.Get(), member.c_str(), 0, GetHdfType(type));
  return compound;
}

std::optional<HdfValues> FindValuesOfType(const HdfHandle& stored)
{
  using Type = bricks::ScalarType;
  const std::size_t bytes = H5Tget_size(stored.Get());
  constexpr std::size_t mostOfIntegers = 8;
  constexpr std::size_t mostOfFloats = 16;
  const bool isFloat = H5Tget_class(stored.Get()) == H5T_FLOAT;
  if (bytes == 0 || bytes > (isFloat ? mostOfFloats : mostOfIntegers) || !IsHdfNumber(stored.Get()))
  {
    return std::nullopt;
  }
  HdfValues values;
  values.Swapped = bytes > 1 && H5Tget_order(stored.Get()) != H5Tget_order(H5T_NATIVE_INT);
  if (isFloat)
  {
    values.Type = bytes <= 4 ? Type::Float32 : Type::Float64;
  }
  else if (H5Tget_class(stored.Get()) == H5T_INTEGER)
  {
    const bool isSigned = H5Tget_sign(stored.Get()) == H5T_SGN_2;
    const Type types[2][4] = { { Type::UInt8, Type::UInt16, Type::UInt32, Type::UInt64 },
      { Type::Int8, Type::Int16, Type::Int32, Type::Int64 } };
    int size = 0; // the smallest that has as many bytes
    while (size < 3 && bytes > std::size_t(1) << size)
    {
      ++size;
    }
    values.Type = types[isSigned ? 1 : 0][size];
  }
  else
  {
    return std::nullopt;
  }
  // Fewer bits than bytes have, or other exponents, are left to the library.
  const HdfHandle same(H5Tcopy(GetHdfType(values.Type)), &H5Tclose);
  values.IsPlain = H5Tset_order(same.Get(), H5Tget_order(stored.Get())) >= 0 &&
    H5Tequal(same.Get(), stored.Get()) > 0;
  return values;
}

} // namespace

std::vector<HdfValues> FindHdfValues(hid_t dataset)
{
  std::vector<HdfValues> found;
  const HdfHandle stored(H5Dget_type(dataset), &H5Tclose);
  const auto add = [&](const HdfHandle& type, const std::string& member)
  {
    const bool isEnum = H5Tget_class(type.Get()) == H5T_ENUM;
    auto values = isEnum ? FindValuesOfType(HdfHandle(H5Tget_super(type.Get()), &H5Tclose))
                         : FindValuesOfType(type);
    if (values)
    {
      values->Member = member;
      values->IsPlain = values->IsPlain && member.empty();
      found.push_back(std::move(*values));
    }
  };
  if (H5Tget_class(stored.Get()) != H5T_COMPOUND)
  {
    add(stored, {});
    return found;
  }
  const int count = H5Tget_nmembers(stored.Get());
  for (int number = 0; number < count; ++number)
  {
    const auto member = static_cast<unsigned>(number);
    const std::string name = GetMemberName(stored.Get(), member);
    const HdfHandle type(H5Tget_member_type(stored.Get(), member), &H5Tclose);
    const std::size_t first = H5Tget_member_offset(stored.Get(), member);
    const std::size_t bytes = H5Tget_size(stored.Get());
    if (!name.empty() && type.IsOpen() && first <= bytes &&
      H5Tget_size(type.Get()) <= bytes - first)
    {
      add(type, name);
    }
  }
  return found;
}

std::optional<HdfValues> FindHdfValues(hid_t dataset, const std::string& member)
{
  std::vector<HdfValues> all = FindHdfValues(dataset);
  const auto found = std::find_if(
    all.begin(), all.end(), [&](const HdfValues& one) { return one.Member == member; });
  return found == all.end() ? std::nullopt : std::optional<HdfValues>(std::move(*found));
}

std::string DescribeHdfType(hid_t dataset)
{
  const HdfHandle type(H5Dget_type(dataset), &H5Tclose);
  const H5T_class_t kind = H5Tget_class(type.Get());
  static const std::map<H5T_class_t, std::string> names{ { H5T_INTEGER, "integers" },
    { H5T_FLOAT, "floating point" }, { H5T_STRING, "text" }, { H5T_OPAQUE, "opaque" },
    { H5T_COMPOUND, "compound without numbers" }, { H5T_REFERENCE, "references" },
    { H5T_VLEN, "lists of any length" }, { H5T_ARRAY, "arrays" }, { H5T_BITFIELD, "bit fields" } };
  const auto known = names.find(kind);
  const bool hasBytes = kind == H5T_INTEGER || kind == H5T_FLOAT || kind == H5T_OPAQUE;
  return known == names.end() ? "of a type that this HDF5 library does not know"
    : hasBytes ? known->second + ", " + std::to_string(H5Tget_size(type.Get())) + " bytes"
               : known->second;
}

std::vector<std::byte> GetHdfFill(hid_t dataset, bricks::ScalarType type, int components)
{
  std::vector<std::byte> one(bricks::GetBytes(type), std::byte(0));
  const HdfHandle properties(H5Dget_create_plist(dataset), &H5Pclose);
  H5D_fill_value_t state = H5D_FILL_VALUE_UNDEFINED;
  if (H5Pfill_value_defined(properties.Get(), &state) >= 0 && state == H5D_FILL_VALUE_USER_DEFINED)
  {
    H5Pget_fill_value(properties.Get(), GetHdfType(type), one.data());
  }
  std::vector<std::byte> all;
  for (int component = 0; component < components; ++component)
  {
    all.insert(all.end(), one.begin(), one.end());
  }
  return all;
}

bool ReadHdfBox(hid_t dataset, bricks::ScalarType type, const std::string& member,
  const HdfAxes& axes, std::size_t frame, const bricks::Box& box, std::byte* out)
{
  const bricks::Index3 size = box.GetSize();
  const hsize_t components = std::max<hsize_t>(1, axes.Components);
  std::vector<hsize_t> first = axes.Place;
  std::vector<hsize_t> count(first.size(), 1);
  for (std::size_t place = 0; place < axes.Order.size(); ++place)
  {
    if (axes.Space[place])
    {
      first[*axes.Space[place]] = static_cast<hsize_t>(box.Min[axes.Order[place]]);
      count[*axes.Space[place]] = static_cast<hsize_t>(size[axes.Order[place]]);
    }
  }
  if (axes.Time)
  {
    first[*axes.Time] = frame;
  }
  if (axes.Component)
  {
    count[*axes.Component] = components;
  }
  const std::size_t sampleBytes = bricks::GetBytes(type) * static_cast<std::size_t>(components);
  const std::size_t bytes = static_cast<std::size_t>(box.GetCount()) * sampleBytes;
  ByteBuffer ordered(axes.Order != FastestX ? bytes : 0);
  std::byte* const to = ordered.empty() ? out : ordered.data();
  std::fill_n(to, bytes, std::byte(0));
  const HdfHandle all(H5Dget_space(dataset), &H5Sclose);
  const HdfHandle part(
    H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), &H5Sclose);
  const HdfHandle inMemory = MakeMemoryType(type, member);
  const bool isRead = H5Sselect_hyperslab(all.Get(), H5S_SELECT_SET, first.data(), nullptr,
                        count.data(), nullptr) >= 0 &&
    H5Dread(dataset, inMemory.Get(), part.Get(), all.Get(), H5P_DEFAULT, to) >= 0;
  if (!ordered.empty())
  {
    CopyOrdered(to, size, axes.Order, out, size, sampleBytes);
  }
  return isRead;
}

bool FindHdfSteps(hid_t properties, std::vector<CodecStep>& steps)
{
  const int count = H5Pget_nfilters(properties);
  for (int index = 0; index < count; ++index)
  {
    unsigned flags = 0;
    std::size_t parameterCount = 8;
    unsigned parameters[8] = {};
    unsigned config = 0;
    const H5Z_filter_t filter = H5Pget_filter2(properties, static_cast<unsigned>(index), &flags,
      &parameterCount, parameters, 0, nullptr, &config);
    const Codec* const codec = FindHdfCodec(filter);
    // The library may have a plugin for what this build lacks.
    if (!codec || (!codec->LackingPackage.empty() && H5Zfilter_avail(filter) > 0))
    {
      return false;
    }
    steps.emplace_back(
      codec, CodecParameters{ filter == H5Z_FILTER_SHUFFLE ? std::max(1u, parameters[0]) : 1u });
  }
  return true;
}

namespace
{

/// How to get the plugin of a filter of https://github.com/HDFGroup/hdf5_plugins.
std::string DescribePlugin(H5Z_filter_t filter)
{
  switch (filter)
  {
    case 32008:
      return "Install the package bitshuffle and name its folder bitshuffle/plugin in "
             "HDF5_PLUGIN_PATH";
    case 32013:
      return "Install the package hdf5-filter-plugin-zfp-serial";
    case 32017: // SZ
    case 32018: // FCIDECOMP
    case 32024: // SZ3
    case 32026: // Blosc2
    case 32028: // SPERR
      return "Install the Python package hdf5plugin and name its folder hdf5plugin.PLUGIN_PATH in "
             "HDF5_PLUGIN_PATH";
    default:
      return "Install its plugin in a directory of HDF5_PLUGIN_PATH";
  }
}

} // namespace

std::string FindLackingHdfFilter(hid_t dataset)
{
  const HdfHandle properties(H5Dget_create_plist(dataset), &H5Pclose);
  const int count = H5Pget_nfilters(properties.Get());
  for (int index = 0; index < count; ++index)
  {
    unsigned flags = 0;
    std::size_t parameterCount = 0;
    char name[64] = {};
    const H5Z_filter_t filter = H5Pget_filter2(properties.Get(), static_cast<unsigned>(index),
      &flags, &parameterCount, nullptr, sizeof(name) - 1, name, nullptr);
    if (H5Zfilter_avail(filter) <= 0)
    {
      return "the HDF5 filter " + std::to_string(filter) + " (" + name + ") is not available. " +
        DescribePlugin(filter) + ", or convert the file to deflate: 'h5repack -f GZIP=3'.";
    }
  }
  return {};
}

} // namespace vol
