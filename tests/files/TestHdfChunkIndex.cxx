// SPDX-License-Identifier: BSD-3-Clause
// Where the chunks of an HDF5 dataset are, read from each kind of index that the library writes. A chunk holds its own
// number, so that the file itself tells which one it is.
#include "DSMVolumeFiles/hdf/HdfChunkTable.h"
#include "DSMVolumeFiles/hdf/HdfLibrary.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <tuple>
#include <vector>

namespace
{

using Index = vol::HdfChunkLayout::Index;
using Shape = std::vector<hsize_t>;
using Place = std::vector<std::uint64_t>;

constexpr hsize_t Any = H5S_UNLIMITED;
/// Samples of a chunk: along the last axis, which is its only one of more than one sample.
constexpr hsize_t Edge = 2;

struct Case
{
  std::string Name;
  Index Kind;
  H5F_libver_t Version; ///< of the library that the file is for
  Shape Chunks;         ///< along each axis
  Shape Most;           ///< chunks that the dataset may grow to
  bool IsFiltered;
  hsize_t Written; ///< along the first axis
  bool IsEarly = false;
};

std::ostream& operator<<(std::ostream& out, const Case& one)
{
  return out << one.Name;
}

/// A file of one dataset; of its first chunks along the first axis, so many are written.
void Write(const std::string& path, const Case& one)
{
  const std::size_t axes = one.Chunks.size();
  Shape samples = one.Chunks;
  Shape most = one.Most;
  Shape edges(axes, 1);
  edges.back() = Edge;
  samples.back() *= Edge;
  most.back() = most.back() == Any ? Any : most.back() * Edge;
  const vol::HdfHandle access(H5Pcreate(H5P_FILE_ACCESS), &H5Pclose);
  H5Pset_libver_bounds(access.Get(), one.Version, H5F_LIBVER_LATEST);
  const vol::HdfHandle file(
    H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.Get()), &H5Fclose);
  const int rank = static_cast<int>(axes);
  const vol::HdfHandle space(H5Screate_simple(rank, samples.data(), most.data()), &H5Sclose);
  const vol::HdfHandle creation(H5Pcreate(H5P_DATASET_CREATE), &H5Pclose);
  H5Pset_chunk(creation.Get(), rank, edges.data());
  if (one.IsFiltered)
  {
    H5Pset_fletcher32(creation.Get()); // adds four bytes, and changes none
  }
  if (one.IsEarly)
  {
    H5Pset_alloc_time(creation.Get(), H5D_ALLOC_TIME_EARLY);
  }
  const vol::HdfHandle dataset(H5Dcreate2(file.Get(), "values", H5T_NATIVE_UINT32, space.Get(),
                                 H5P_DEFAULT, creation.Get(), H5P_DEFAULT),
    &H5Dclose);
  ASSERT_TRUE(dataset.IsOpen());
  // With so many attributes the header is in several parts.
  const vol::HdfHandle scalar(H5Screate(H5S_SCALAR), &H5Sclose);
  for (int number = 0; number < 7; ++number)
  {
    const std::string name = "attribute " + std::to_string(number);
    const vol::HdfHandle attribute(H5Acreate2(dataset.Get(), name.c_str(), H5T_NATIVE_INT,
                                     scalar.Get(), H5P_DEFAULT, H5P_DEFAULT),
      &H5Aclose);
    H5Awrite(attribute.Get(), H5T_NATIVE_INT, &number);
  }
  Shape count = samples;
  count.front() = std::min(one.Written * edges.front(), samples.front());
  std::size_t all = 1;
  for (const hsize_t along : count)
  {
    all *= along;
  }
  std::vector<std::uint32_t> values(all);
  for (std::size_t sample = 0; sample < all; ++sample)
  {
    values[sample] = static_cast<std::uint32_t>(sample / Edge);
  }
  const Shape first(axes, 0);
  const vol::HdfHandle memory(H5Screate_simple(rank, count.data(), nullptr), &H5Sclose);
  H5Sselect_hyperslab(space.Get(), H5S_SELECT_SET, first.data(), nullptr, count.data(), nullptr);
  ASSERT_GE(H5Dwrite(dataset.Get(), H5T_NATIVE_UINT32, memory.Get(), space.Get(), H5P_DEFAULT,
              values.data()),
    0);
}

struct Found
{
  Index Kind;
  std::map<Place, std::tuple<std::uint64_t, std::uint32_t, std::uint32_t>> Chunks;

  bool operator==(const Found& other) const
  {
    return this->Kind == other.Kind && this->Chunks == other.Chunks;
  }
};

/// What the library calls it has another name in each of its releases.
template <class Info>
haddr_t AskForHeader(herr_t (*ask)(hid_t, Info*, unsigned), hid_t dataset)
{
  Info info{};
  return ask(dataset, &info, H5O_INFO_BASIC) < 0 ? HADDR_UNDEF : info.addr;
}

haddr_t FindHeader(const std::string& path)
{
  const vol::HdfHandle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), &H5Fclose);
  const vol::HdfHandle dataset(H5Dopen2(file.Get(), "values", H5P_DEFAULT), &H5Dclose);
  return AskForHeader(&H5Oget_info2, dataset.Get());
}

/// Nothing where it is refused.
std::optional<Found> Read(const std::string& path, std::uint64_t header, const Case& one)
{
  const vol::PositionedFile file(path);
  const auto layout = vol::HdfChunkLayout::Find(file, header);
  if (!layout || layout->Edges.size() != one.Chunks.size() + 1)
  {
    return std::nullopt;
  }
  std::vector<std::uint64_t> most(one.Most.begin(), one.Most.end());
  most.back() *= most.back() == UINT64_MAX ? 1 : Edge;
  Found found{ layout->Kind, {} };
  const bool isRead = vol::HdfChunkIndex::Read(file, *layout, most,
    [&](const std::uint64_t* place, const vol::HdfChunk& chunk)
    {
      return found.Chunks
        .emplace(Place(place, place + one.Chunks.size()),
          std::make_tuple(chunk.First, chunk.Bytes, chunk.SkippedFilters))
        .second;
    });
  return isRead ? std::optional<Found>(std::move(found)) : std::nullopt;
}

class HdfChunkIndex : public testing::TestWithParam<Case>
{
protected:
  void SetUp() override { Write(this->Path, this->GetParam()); }

  const std::string Path = std::string(DSM_TEST_FILES) + "/index.h5";
};

TEST_P(HdfChunkIndex, LeadsToEachChunk)
{
  const Case& one = this->GetParam();
  const auto found = Read(this->Path, FindHeader(this->Path), one);
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->Kind, one.Kind);
  std::size_t written = one.IsEarly ? one.Chunks.front() : one.Written;
  for (std::size_t axis = 1; axis < one.Chunks.size(); ++axis)
  {
    written *= one.Chunks[axis];
  }
  ASSERT_EQ(found->Chunks.size(), written);
  std::ifstream file(this->Path, std::ios::binary);
  for (const auto& [place, chunk] : found->Chunks)
  {
    std::uint32_t number = 0;
    for (std::size_t axis = 0; axis < place.size(); ++axis)
    {
      ASSERT_LT(place[axis], one.Chunks[axis]);
      number = number * static_cast<std::uint32_t>(one.Chunks[axis]) +
        static_cast<std::uint32_t>(place[axis]);
    }
    ASSERT_EQ(std::get<1>(chunk), Edge * sizeof(std::uint32_t) + (one.IsFiltered ? 4 : 0));
    ASSERT_EQ(std::get<2>(chunk), 0u);
    std::uint32_t value = ~number;
    file.seekg(static_cast<std::streamoff>(std::get<0>(chunk)));
    file.read(reinterpret_cast<char*>(&value), sizeof(value));
    ASSERT_EQ(value, place.front() < one.Written ? number : 0);
  }
}

/// Whatever byte is wrong: the index has a checksum, so it is refused, or is what it was.
TEST_P(HdfChunkIndex, IsRefusedWhereItIsDamaged)
{
  const Case& one = this->GetParam();
  const std::uint64_t header = FindHeader(this->Path);
  const auto whole = Read(this->Path, header, one);
  ASSERT_TRUE(whole.has_value());
  const auto bytes = static_cast<std::streamoff>(std::filesystem::file_size(this->Path));
  const bool hasChecksums = one.Kind != Index::Tree1;
  int refused = 0;
  std::fstream file(this->Path, std::ios::in | std::ios::out | std::ios::binary);
  const auto flip = [&](std::streamoff place)
  {
    file.seekg(place);
    const auto byte = static_cast<char>(file.get() ^ 0x5a);
    file.seekp(place);
    file.put(byte);
    file.flush();
  };
  // All of the header and of what is near it, and places further on; fewer where there are many chunks to read.
  const bool isLarge = whole->Chunks.size() > 1000;
  const std::streamoff dense = std::min<std::streamoff>(bytes, isLarge ? 0 : 2000);
  const std::streamoff step = std::max<std::streamoff>(1, (bytes - dense) / (isLarge ? 40 : 150));
  for (std::streamoff place = 0; place < bytes; place += place < dense ? 3 : step)
  {
    flip(place);
    const auto damaged = Read(this->Path, header, one);
    flip(place);
    refused += damaged ? 0 : 1;
    if (damaged && hasChecksums)
    {
      ASSERT_EQ(*damaged, *whole) << "with another byte " << place;
    }
    else if (damaged)
    {
      ASSERT_LT(damaged->Chunks.size(), static_cast<std::size_t>(bytes));
    }
  }
  EXPECT_GT(refused, 0);
  file.close();
  EXPECT_EQ(Read(this->Path, header, one), whole);
}

std::vector<Case> GetCases()
{
  const auto old = H5F_LIBVER_EARLIEST;
  const auto latest = H5F_LIBVER_V110;
  return {
    { "Tree1", Index::Tree1, old, { 8, 13, 30 }, { 8, 13, 30 }, false, 5 },
    { "Tree1OfFilteredChunks", Index::Tree1, old, { 8, 13, 30 }, { 8, 13, 30 }, true, 8 },
    { "Tree1InANewHeader", Index::Tree1, H5F_LIBVER_V18, { 3, 4, 5 }, { 3, 4, 5 }, true, 2 },
    { "Single", Index::Single, latest, { 1, 1, 1 }, { 1, 1, 1 }, false, 1 },
    { "SingleFiltered", Index::Single, latest, { 1, 1, 1 }, { 1, 1, 1 }, true, 1 },
    { "Implicit", Index::Implicit, latest, { 3, 4, 5 }, { 3, 4, 5 }, false, 2, true },
    { "FixedArray", Index::FixedArray, latest, { 3, 4, 5 }, { 3, 4, 5 }, false, 2 },
    { "FixedArrayOfFilteredChunks", Index::FixedArray, latest, { 3, 4, 5 }, { 3, 4, 5 }, true, 3 },
    { "FixedArrayInPages", Index::FixedArray, latest, { 8, 13, 30 }, { 8, 13, 30 }, true, 5 },
    { "FixedArrayThatMayGrow", Index::FixedArray, latest, { 3, 4, 5 }, { 9, 8, 7 }, false, 2 },
    { "ExtensibleArray", Index::ExtensibleArray, latest, { 3, 4, 5 }, { Any, 4, 5 }, false, 2 },
    { "ExtensibleArrayAlongY", Index::ExtensibleArray, latest, { 3, 4, 5 }, { 3, Any, 6 }, true,
      3 },
    { "ExtensibleArrayAlongX", Index::ExtensibleArray, latest, { 8, 13, 30 }, { 9, 13, Any }, false,
      8 },
    { "ExtensibleArrayInPages", Index::ExtensibleArray, latest, { 1500, 10, 10 }, { Any, 10, 10 },
      true, 1470 },
    { "Tree2", Index::Tree2, latest, { 3, 4, 5 }, { Any, Any, 5 }, false, 2 },
    { "Tree2OfFilteredChunks", Index::Tree2, latest, { 8, 13, 30 }, { Any, Any, Any }, true, 7 },
    { "Tree2Deep", Index::Tree2, latest, { 150, 20, 10 }, { Any, Any, 10 }, false, 149 },
    { "NothingWritten", Index::Tree2, latest, { 3, 4, 5 }, { Any, Any, 5 }, false, 0 },
  };
}

INSTANTIATE_TEST_SUITE_P(Kinds, HdfChunkIndex, testing::ValuesIn(GetCases()),
  [](const auto& info) { return info.param.Name; });

TEST(HdfChunkTable, FindsWhatIsThere)
{
  vol::HdfChunkTable table;
  for (const std::uint64_t number : { 7u, 0u, 2u, 1u, 1000u })
  {
    table.Add(number, { 10 * number, 1, 2 });
  }
  ASSERT_TRUE(table.Sort());
  for (const std::uint64_t number : { 0u, 1u, 2u, 3u, 6u, 7u, 8u, 999u, 1000u, 1001u })
  {
    const vol::HdfChunk* const chunk = table.Find(number);
    const bool isThere = number < 3 || number == 7 || number == 1000;
    ASSERT_EQ(chunk != nullptr, isThere) << number;
    EXPECT_TRUE(!chunk || chunk->First == 10 * number);
  }
  table.Add(7, {});
  EXPECT_FALSE(table.Sort());
}

} // namespace
