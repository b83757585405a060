// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/hdf/HdfChunks.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/FileLimits.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace vol
{

namespace
{

/// The function's parameter type has another name in each release of the library.
template <class Info>
haddr_t FindHeader(herr_t (*ask)(hid_t, Info*, unsigned), hid_t dataset)
{
  Info info{};
  return ask(dataset, &info, H5O_INFO_BASIC) < 0 ? HADDR_UNDEF : info.addr;
}

/// Returns whether addresses in the file count from its first byte, in 8 bytes.
bool IsPlain(hid_t dataset)
{
  const HdfHandle file(H5Iget_file_id(dataset), &H5Fclose);
  const HdfHandle properties(H5Fget_create_plist(file.Get()), &H5Pclose);
  hsize_t before = 1;
  std::size_t addressBytes = 0;
  std::size_t lengthBytes = 0;
  return H5Pget_userblock(properties.Get(), &before) >= 0 && before == 0 &&
    H5Pget_sizes(properties.Get(), &addressBytes, &lengthBytes) >= 0 && addressBytes == 8 &&
    lengthBytes == 8;
}

[[noreturn]] void RefuseDamaged(
  const std::string& path, const std::string& name, const std::string& what)
{
  throw FileError({ path, name, {} }, "is damaged: it has " + what + ".");
}

} // namespace

std::vector<hsize_t> GetHdfChunkEdges(
  hid_t dataset, const std::string& path, const std::string& name)
{
  const HdfHandle space(H5Dget_space(dataset), &H5Sclose);
  const HdfHandle properties(H5Dget_create_plist(dataset), &H5Pclose);
  const int axes = H5Sget_simple_extent_ndims(space.Get());
  std::vector<hsize_t> edges(H5S_MAX_RANK, 0);
  const int axesOfChunks =
    H5Pget_chunk(properties.Get(), static_cast<int>(edges.size()), edges.data());
  if (axes != axesOfChunks)
  {
    RefuseDamaged(path, name,
      std::to_string(axes) + " axes, but its chunks have " + std::to_string(axesOfChunks));
  }
  edges.resize(static_cast<std::size_t>(std::max(0, axes)));
  if (edges.empty() || std::find(edges.begin(), edges.end(), hsize_t(0)) != edges.end())
  {
    RefuseDamaged(path, name, "chunks without samples");
  }
  return edges;
}

haddr_t FindHdfValuesPlace(
  hid_t dataset, const PositionedFile& file, const FileArray& array, std::uint64_t slices)
{
  // With a block of the user's own before all, the library (1.10) adds its size to an undefined place, too.
  H5D_space_status_t status = H5D_SPACE_STATUS_NOT_ALLOCATED;
  const haddr_t first = H5Dget_offset(dataset);
  if (first == HADDR_UNDEF || H5Dget_space_status(dataset, &status) < 0 ||
    status == H5D_SPACE_STATUS_NOT_ALLOCATED)
  {
    return HADDR_UNDEF;
  }
  const std::uint64_t has = file.GetBytes();
  const auto samples =
    static_cast<std::uint64_t>(bricks::Box{ bricks::Index3(0), array.Grid.Samples }.GetCount());
  const auto needed = MultiplyWithin(has, { samples, array.GetSampleBytes(), slices });
  if (first > has || !needed || *needed > has - first)
  {
    throw FileError(file.GetPath(),
      "ends before the values of its dataset '" + array.Name +
        "'. The file is truncated or damaged.");
  }
  return first;
}

void CheckHdfStored(hid_t dataset, const std::string& path, const std::string& name)
{
  H5D_space_status_t status = H5D_SPACE_STATUS_NOT_ALLOCATED;
  if (H5Dget_space_status(dataset, &status) >= 0 && status == H5D_SPACE_STATUS_NOT_ALLOCATED)
  {
    return; // all have the fill value
  }
  const HdfHandle space(H5Dget_space(dataset), &H5Sclose);
  const HdfHandle type(H5Dget_type(dataset), &H5Tclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space.Get());
  const auto needed = MultiplyWithin(H5Dget_storage_size(dataset),
    { static_cast<std::uint64_t>(std::max<hssize_t>(0, count)), H5Tget_size(type.Get()) });
  if (count < 0 || !needed)
  {
    RefuseDamaged(path, name, "fewer values than its shape declares");
  }
}

std::optional<HdfChunkTable> FindHdfChunks(hid_t dataset, const PositionedFile& file,
  const std::string& name, const std::vector<hsize_t>& edges, const HdfAxes& axes,
  const std::function<bool()>& goesOn)
{
  const haddr_t header = IsPlain(dataset) ? FindHeader(&H5Oget_info2, dataset) : HADDR_UNDEF;
  const std::optional<HdfChunkLayout> layout =
    header == HADDR_UNDEF ? std::nullopt : HdfChunkLayout::Find(file, header);
  if (!layout)
  {
    return std::nullopt;
  }
  const HdfHandle space(H5Dget_space(dataset), &H5Sclose);
  std::vector<hsize_t> samples(edges.size());
  std::vector<hsize_t> most(edges.size());
  H5Sget_simple_extent_dims(space.Get(), samples.data(), most.data());
  std::vector<std::uint64_t> counts(edges.size());
  for (std::size_t axis = 0; axis < edges.size(); ++axis)
  {
    counts[axis] = samples[axis] / edges[axis] + (samples[axis] % edges[axis] != 0 ? 1 : 0);
  }
  const auto all = MultiplyWithin(FileLimits::ArrayBytes, counts);
  if (!all)
  {
    throw FileError(file.GetPath(),
      "has an invalid header: the dataset '" + name + "' declares too many chunks.");
  }
  constexpr std::size_t oftenEnough = 1 << 14;
  bool isStopped = false;
  const HdfHandle properties(H5Dget_create_plist(dataset), &H5Pclose);
  const bool isFiltered = H5Pget_nfilters(properties.Get()) != 0;
  // The last one is the bytes of a sample.
  const std::uint64_t plainBytes = MultiplyWithin(UINT32_MAX, layout->Edges).value_or(0);
  HdfChunkTable table;
  // Each takes at least an address in the index.
  table.Reserve(std::min(*all, file.GetBytes() / sizeof(std::uint64_t)));
  const HdfHandle type(H5Dget_type(dataset), &H5Tclose);
  std::vector<std::uint64_t> expected(edges.begin(), edges.end());
  expected.push_back(H5Tget_size(type.Get()));
  const bool isRight = layout->Edges == expected &&
    HdfChunkIndex::Read(file, *layout, { most.begin(), most.end() },
      [&](const std::uint64_t* place, const HdfChunk& chunk)
      {
        // The library reads beyond the bytes of a chunk that has too few.
        if (!isFiltered && chunk.Bytes != plainBytes)
        {
          return false;
        }
        std::uint64_t number = 0;
        for (std::size_t axis = 0; axis < edges.size(); ++axis)
        {
          if (place[axis] >= counts[axis])
          {
            return false;
          }
          number = number * counts[axis] + place[axis];
        }
        if (axes.Has(place, edges))
        {
          table.Add(number, chunk);
        }
        isStopped = table.GetCount() % oftenEnough == 0 && goesOn && !goesOn();
        if (table.GetCount() > FileLimits::Chunks)
        {
          CheckLimit(file.GetPath(), "chunks of the dataset '" + name + "'", table.GetCount(),
            FileLimits::Chunks);
        }
        return !isStopped;
      }) &&
    table.Sort();
  if (isStopped)
  {
    throw dsm::Error("Opening '" + file.GetPath() + "' was aborted.");
  }
  if (!isRight)
  {
    RefuseDamaged(file.GetPath(), name, "an invalid index of its chunks");
  }
  return table;
}

} // namespace vol
