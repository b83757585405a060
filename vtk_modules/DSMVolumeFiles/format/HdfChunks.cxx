// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/HdfChunks.h"

#include "DSMCore/base/Error.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>

namespace vol
{

namespace
{

/// What the function takes has another name in each release of the library.
template <class Info>
haddr_t FindHeader(herr_t (*ask)(hid_t, Info*, unsigned), hid_t dataset)
{
  Info info{};
  return ask(dataset, &info, H5O_INFO_BASIC) < 0 ? HADDR_UNDEF : info.addr;
}

/// Whether places in the file count from its first byte, in 8 bytes.
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

std::vector<hsize_t> FindCounts(hid_t dataset, const std::vector<hsize_t>& edges)
{
  const HdfHandle space(H5Dget_space(dataset), &H5Sclose);
  std::vector<hsize_t> counts(edges.size());
  H5Sget_simple_extent_dims(space.Get(), counts.data(), nullptr);
  for (std::size_t axis = 0; axis < edges.size(); ++axis)
  {
    counts[axis] = (counts[axis] + edges[axis] - 1) / edges[axis];
  }
  return counts;
}

bool ReadTree(hid_t dataset, const PositionedFile& file, const std::vector<hsize_t>& edges,
  const std::vector<hsize_t>& counts, std::vector<HdfChunk>& chunks)
{
  const haddr_t header = IsPlain(dataset) ? FindHeader(&H5Oget_info2, dataset) : HADDR_UNDEF;
  bool fits = header != HADDR_UNDEF;
  return fits &&
    HdfChunkTree::Read(file, header, edges.size(),
      [&](const std::uint64_t* first, const HdfChunk& chunk)
      {
        hsize_t number = 0;
        for (std::size_t axis = 0; axis < edges.size(); ++axis)
        {
          const hsize_t place = first[axis] / edges[axis];
          fits = fits && place < counts[axis] && first[axis] % edges[axis] == 0;
          number = number * counts[axis] + place;
        }
        if (fits)
        {
          chunks[number] = chunk;
        }
      }) &&
    fits;
}

/// One after the other.
void AskLibrary(hid_t dataset, const PositionedFile& file, const std::vector<hsize_t>& edges,
  const std::vector<hsize_t>& counts, std::vector<HdfChunk>& chunks)
{
  std::vector<hsize_t> first(edges.size());
  for (std::size_t number = 0; number < chunks.size(); ++number)
  {
    hsize_t rest = number;
    for (std::size_t axis = edges.size(); axis-- > 0;)
    {
      first[axis] = rest % counts[axis] * edges[axis];
      rest /= counts[axis];
    }
    haddr_t address = HADDR_UNDEF;
    hsize_t bytes = 0;
    unsigned skipped = 0;
    if (H5Dget_chunk_info_by_coord(dataset, first.data(), &skipped, &address, &bytes) < 0)
    {
      throw dsm::Error("The file '" + file.GetPath() +
        "' does not tell where the chunks of an array are; it is damaged.");
    }
    chunks[number] = address == HADDR_UNDEF
      ? HdfChunk{}
      : HdfChunk{ address, static_cast<std::uint32_t>(bytes), skipped };
  }
}

} // namespace

std::vector<hsize_t> GetHdfChunkEdges(hid_t properties)
{
  std::vector<hsize_t> edges(5, 1);
  const int axes = H5Pget_chunk(properties, static_cast<int>(edges.size()), edges.data());
  edges.resize(static_cast<std::size_t>(std::max(0, axes)));
  return edges;
}

std::vector<HdfChunk> FindHdfChunks(
  hid_t dataset, const PositionedFile& file, const std::vector<hsize_t>& edges)
{
  const std::vector<hsize_t> counts = FindCounts(dataset, edges);
  const auto count = static_cast<std::size_t>(
    std::accumulate(counts.begin(), counts.end(), hsize_t(1), std::multiplies<>()));
  std::vector<HdfChunk> chunks(count);
  if (!ReadTree(dataset, file, edges, counts, chunks))
  {
    AskLibrary(dataset, file, edges, counts, chunks);
  }
  return chunks;
}

} // namespace vol
