// SPDX-License-Identifier: BSD-3-Clause
// Where the chunks of an HDF5 dataset are, read from its tree at once: as the library says of each.
#include "DSMVolumeFiles/format/HdfChunkTree.h"
#include "DSMVolumeFiles/format/HdfLibrary.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace
{

using Place = std::array<hsize_t, 3>;

constexpr Place Edges{ 4, 8, 2 };
constexpr Place Samples{ 30, 100, 60 }; // 8 x 13 x 30 chunks, in several levels of the tree
const std::string Path = std::string(DSM_TEST_FILES) + "/tree.h5";

/// A dataset of which only the chunks with an even first axis are written, with so many attributes that its header is
/// in several parts.
void Write(H5F_libver_t low, H5F_libver_t high)
{
  const vol::HdfHandle access(H5Pcreate(H5P_FILE_ACCESS), &H5Pclose);
  H5Pset_libver_bounds(access.Get(), low, high);
  const vol::HdfHandle file(
    H5Fcreate(Path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.Get()), &H5Fclose);
  const vol::HdfHandle space(H5Screate_simple(3, Samples.data(), nullptr), &H5Sclose);
  const vol::HdfHandle creation(H5Pcreate(H5P_DATASET_CREATE), &H5Pclose);
  H5Pset_chunk(creation.Get(), 3, Edges.data());
  H5Pset_deflate(creation.Get(), 1);
  const vol::HdfHandle dataset(H5Dcreate2(file.Get(), "values", H5T_NATIVE_INT, space.Get(),
                                 H5P_DEFAULT, creation.Get(), H5P_DEFAULT),
    &H5Dclose);
  const vol::HdfHandle scalar(H5Screate(H5S_SCALAR), &H5Sclose);
  for (int number = 0; number < 40; ++number)
  {
    const std::string name = "attribute " + std::to_string(number);
    const vol::HdfHandle attribute(H5Acreate2(dataset.Get(), name.c_str(), H5T_NATIVE_INT,
                                     scalar.Get(), H5P_DEFAULT, H5P_DEFAULT),
      &H5Aclose);
    H5Awrite(attribute.Get(), H5T_NATIVE_INT, &number);
  }
  const Place count{ Edges[0], Samples[1], Samples[2] };
  const vol::HdfHandle memory(H5Screate_simple(3, count.data(), nullptr), &H5Sclose);
  std::vector<int> values(count[0] * count[1] * count[2]);
  for (hsize_t first = 0; first + Edges[0] <= Samples[0]; first += 2 * Edges[0])
  {
    for (std::size_t sample = 0; sample < values.size(); ++sample)
    {
      values[sample] = static_cast<int>(first + sample * sample % 97);
    }
    const Place start{ first, 0, 0 };
    H5Sselect_hyperslab(space.Get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
    ASSERT_GE(H5Dwrite(dataset.Get(), H5T_NATIVE_INT, memory.Get(), space.Get(), H5P_DEFAULT,
                values.data()),
      0);
  }
}

/// Opens the dataset, and reads its tree.
class Tree
{
public:
  Tree()
    : File(H5Fopen(Path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), &H5Fclose)
    , Dataset(H5Dopen2(this->File.Get(), "values", H5P_DEFAULT), &H5Dclose)
  {
    this->Header = FindHeader(&H5Oget_info2);
  }

  bool Read()
  {
    this->Chunks.clear();
    return vol::HdfChunkTree::Read(vol::PositionedFile(Path), this->Header, 3,
      [&](const std::uint64_t* first, const vol::HdfChunk& chunk) {
        this->Chunks[{ first[0], first[1], first[2] }] = chunk;
      });
  }

  void ExpectAsTheLibrarySays() const
  {
    std::size_t written = 0;
    Place first{};
    for (first[0] = 0; first[0] < Samples[0]; first[0] += Edges[0])
    {
      for (first[1] = 0; first[1] < Samples[1]; first[1] += Edges[1])
      {
        for (first[2] = 0; first[2] < Samples[2]; first[2] += Edges[2])
        {
          haddr_t address = HADDR_UNDEF;
          hsize_t bytes = 0;
          unsigned skipped = 0;
          ASSERT_GE(H5Dget_chunk_info_by_coord(
                      this->Dataset.Get(), first.data(), &skipped, &address, &bytes),
            0);
          const auto found = this->Chunks.find(first);
          ASSERT_EQ(found != this->Chunks.end(), address != HADDR_UNDEF);
          if (found != this->Chunks.end())
          {
            ++written;
            EXPECT_EQ(found->second.First, address);
            EXPECT_EQ(found->second.Bytes, bytes);
            EXPECT_EQ(found->second.SkippedFilters, skipped);
          }
        }
      }
    }
    EXPECT_EQ(written, this->Chunks.size());
    EXPECT_EQ(written, 4u * 13u * 30u);
  }

private:
  /// What the function takes has another name in each release of the library.
  template <class Info>
  haddr_t FindHeader(herr_t (*ask)(hid_t, Info*, unsigned)) const
  {
    Info info{};
    return ask(this->Dataset.Get(), &info, H5O_INFO_BASIC) < 0 ? HADDR_UNDEF : info.addr;
  }

  vol::HdfHandle File;
  vol::HdfHandle Dataset;
  std::uint64_t Header = 0;
  std::map<Place, vol::HdfChunk> Chunks;
};

TEST(HdfChunkTree, TellsWhatTheLibraryTells)
{
  // The header is of the first kind, then of the second.
  for (const H5F_libver_t low : { H5F_LIBVER_EARLIEST, H5F_LIBVER_V18 })
  {
    Write(low, H5F_LIBVER_V18);
    Tree tree;
    ASSERT_TRUE(tree.Read());
    tree.ExpectAsTheLibrarySays();
  }
}

TEST(HdfChunkTree, IsNotTakenForWhatHasNone)
{
  Write(H5F_LIBVER_V110, H5F_LIBVER_V110);
  EXPECT_FALSE(Tree().Read());
}

/// Whatever byte is wrong: an answer, or none, but no end of the process.
TEST(HdfChunkTree, SurvivesDamage)
{
  Write(H5F_LIBVER_EARLIEST, H5F_LIBVER_V18);
  Tree tree;
  const auto bytes = std::filesystem::file_size(Path);
  for (std::uint64_t place = 0; place < bytes; place += 199)
  {
    std::fstream file(Path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(static_cast<std::streamoff>(place));
    const auto byte = static_cast<char>(file.get());
    file.seekp(static_cast<std::streamoff>(place));
    file.put(static_cast<char>(byte ^ 0x5a));
    file.close();
    tree.Read();
    file.open(Path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(place));
    file.put(byte);
  }
  ASSERT_TRUE(tree.Read());
  tree.ExpectAsTheLibrarySays();
}

} // namespace
