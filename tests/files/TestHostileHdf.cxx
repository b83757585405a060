// SPDX-License-Identifier: BSD-3-Clause
// HDF5 files whose numbers are made to mislead, or are only unusual.
#include "WatchedReading.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/hdf/HdfLibrary.h"
#include "DSMVolumeFiles/open/OpenVolumeFile.h"

#include <gtest/gtest.h>

#include <climits>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include <sys/stat.h>

namespace
{

using namespace dsm_test;
using vol::HdfHandle;
using Shape = std::vector<hsize_t>;

/// An HDF5 file that is being written.
class Writer
{
public:
  explicit Writer(fs::path path, hsize_t userBlock = 0, bool isLatest = false)
    : Path(std::move(path))
    , File(Create(this->Path, userBlock, isLatest), &H5Fclose)
  {
  }

  void AddGroup(const char* name)
  {
    const HdfHandle group(
      H5Gcreate2(this->File.Get(), name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), &H5Gclose);
  }

  /// Of bytes, unless a type is given. `chunk`: empty for values in one piece.
  HdfHandle Add(const std::string& name, const Shape& shape, const Shape& chunk,
    hid_t type = H5T_NATIVE_UINT8, const HdfHandle& creation = CreateProperties())
  {
    const int axes = static_cast<int>(shape.size());
    const HdfHandle space(H5Screate_simple(axes, shape.data(), nullptr), &H5Sclose);
    if (!chunk.empty())
    {
      H5Pset_chunk(creation.Get(), static_cast<int>(chunk.size()), chunk.data());
    }
    HdfHandle dataset(H5Dcreate2(this->File.Get(), name.c_str(), type, space.Get(), H5P_DEFAULT,
                        creation.Get(), H5P_DEFAULT),
      &H5Dclose);
    EXPECT_TRUE(dataset.IsOpen()) << name.substr(0, 100);
    return dataset;
  }

  static HdfHandle CreateProperties()
  {
    return HdfHandle(H5Pcreate(H5P_DATASET_CREATE), &H5Pclose);
  }

  template <class T>
  void AddAttribute(const char* object, const char* name, hid_t type, const std::vector<T>& values)
  {
    const HdfHandle group(H5Oopen(this->File.Get(), object, H5P_DEFAULT), &H5Oclose);
    const hsize_t count = values.size();
    const HdfHandle space(H5Screate_simple(1, &count, nullptr), &H5Sclose);
    const HdfHandle attribute(
      H5Acreate2(group.Get(), name, type, space.Get(), H5P_DEFAULT, H5P_DEFAULT), &H5Aclose);
    H5Awrite(attribute.Get(), type, values.data());
  }

  void AddImage(const std::vector<long long>& extent)
  {
    this->AddGroup("VTKHDF");
    this->AddGroup("VTKHDF/PointData");
    this->AddAttribute("VTKHDF", "WholeExtent", H5T_NATIVE_LLONG, extent);
  }

  template <class T>
  static void WriteAll(const HdfHandle& dataset, hid_t type, const std::vector<T>& values)
  {
    EXPECT_GE(H5Dwrite(dataset.Get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  }

  hid_t Get() const { return this->File.Get(); }

  /// Closes the file; then replaces bytes, which must be there.
  void Replace(const std::string& old, const std::string& changed)
  {
    this->File.Reset();
    std::string bytes = ReadBytes(this->Path);
    const std::size_t place = bytes.find(old);
    ASSERT_NE(place, std::string::npos);
    bytes.replace(place, changed.size(), changed);
    WriteText(this->Path, bytes);
  }

  static std::string ReadBytes(const fs::path& path)
  {
    std::ifstream file(path, std::ios::binary);
    return { std::istreambuf_iterator<char>(file), {} };
  }

private:
  static hid_t Create(const fs::path& path, hsize_t userBlock, bool isLatest)
  {
    const HdfHandle creation(H5Pcreate(H5P_FILE_CREATE), &H5Pclose);
    const HdfHandle access(H5Pcreate(H5P_FILE_ACCESS), &H5Pclose);
    H5Pset_userblock(creation.Get(), userBlock);
    // Metadata of the latest formats have checksums, so that the library refuses bytes that are replaced in them.
    const H5F_libver_t format = isLatest ? H5F_LIBVER_LATEST : H5F_LIBVER_EARLIEST;
    H5Pset_libver_bounds(access.Get(), format, H5F_LIBVER_LATEST);
    return H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.Get(), access.Get());
  }

  fs::path Path;
  HdfHandle File;
};

template <class T>
std::string Bytes(const std::vector<T>& numbers)
{
  std::string bytes(numbers.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

using Words = std::vector<std::uint32_t>;
using LongWords = std::vector<std::uint64_t>;

/// Expects that opening the file fails. HDF5 2 refuses its dataset 'a' by itself, with another message.
void ExpectRefusalOfDataset(const fs::path& path, std::initializer_list<const char*> words)
{
#if H5_VERSION_GE(2, 0, 0)
  EXPECT_NE(words.size(), 0u);
  ExpectRefusal(path, { "'a'", "cannot open" });
#else
  ExpectRefusal(path, words);
#endif
}

TEST(HostileHdf, AxesWithoutABoundAreRefused)
{
  const fs::path folder = MakeFolder("axes");
  const std::uint64_t huge = std::uint64_t(1) << 34;
  {
    Writer file(folder / "time.h5");
    file.Add("a", { 1000, 1024, 1024, 1024 }, { 1, 1, 1, 1 });
    file.Replace(Bytes(LongWords{ 1000, 1024, 1024, 1024 }), Bytes(LongWords{ huge }));
  }
  ExpectRefusalOfDataset(folder / "time.h5", { "'a'", "17179869184 time steps", "at most" });
  {
    Writer file(folder / "along.h5");
    file.Add("a", { 1000, 1024, 1024 }, { 1, 1, 1 });
    file.Replace(Bytes(LongWords{ 1000, 1024, 1024 }), Bytes(LongWords{ huge }));
  }
  ExpectRefusalOfDataset(folder / "along.h5", { "'a'", "17179869184 samples along z" });
  {
    Writer file(folder / "components.vtkhdf");
    file.AddImage({ 0, 1, 0, 0, 0, 0 });
    file.Add("VTKHDF/PointData/a", { 1, 1, 2, INT_MAX }, { 1, 1, 1, 1 << 20 }, H5T_NATIVE_DOUBLE);
  }
  ExpectRefusal(folder / "components.vtkhdf", { "'a'", "2147483647 components" });
  {
    Writer file(folder / "steps.vtkhdf");
    file.AddImage({ 0, 1, 0, 1, 0, 1 });
    file.AddGroup("VTKHDF/Steps");
    file.Add("VTKHDF/Steps/Values", { huge }, { 1 << 20 }, H5T_NATIVE_DOUBLE);
    file.Add("VTKHDF/PointData/a", { 2, 2, 2 }, {});
  }
  ExpectRefusal(folder / "steps.vtkhdf", { "Steps/Values", "time steps" });
}

/// The product of their numbers would wrap around, or takes more memory than there is; nothing is stored.
TEST(HostileHdf, ChunksThatAreNotThereTakeNoMemory)
{
  const fs::path folder = MakeFolder("sparse");
  {
    Writer file(folder / "table.h5");
    file.Add("a", { 2048, 1024, 1024 }, { 1, 1, 1 });
  }
  EXPECT_EQ(ReadWatched(folder / "table.h5"), "");
  {
    Writer file(folder / "wrap.h5");
    file.Add("a", { 1000, 1024, 1024 }, { 1, 1, 1 });
    const std::uint64_t most = INT_MAX;
    file.Replace(Bytes(LongWords{ 1000, 1024, 1024 }), Bytes(LongWords{ most, most, most }));
  }
  ExpectRefusalOfDataset(folder / "wrap.h5", { "samples" });
}

TEST(HostileHdf, ChunksOfOtherAxesAreRefused)
{
  const fs::path folder = MakeFolder("rank");
  for (const bool hasMore : { false, true })
  {
    const fs::path path = folder / (hasMore ? "more.h5" : "less.h5");
    Writer file(path);
    file.Add("a", { 6, 7, 8, 9 }, { 4, 4, 4, 4 });
    if (hasMore)
    {
      // The dataspace: version, number of axes, whether they may grow, five bytes that are not used, and the axes.
      const std::string axes = std::string(5, '\0') + Bytes(LongWords{ 6, 7, 8, 9 });
      file.Replace(std::string{ 1, 4, 1 } + axes, std::string{ 1, 3, 1 });
    }
    else
    {
      // The layout: version, that it is of chunks, and the number of their axes, one more for the bytes.
      file.Replace(std::string{ 3, 2, 5 }, std::string{ 3, 2, 4 });
    }
    ExpectRefusalOfDataset(
      path, { "'a'", hasMore ? "3 axes, but its chunks have 4" : "but its chunks have 3" });
  }
}

TEST(HostileHdf, DamagedObjectsAreTold)
{
  const fs::path path = MakeFolder("damaged") / "damaged.h5";
  for (const bool isAlone : { true, false })
  {
    Writer file(path, 0, true);
    file.Add("b", { 5, 6, 7 }, {});
    if (!isAlone)
    {
      file.Add("a", { 4, 4, 4 }, {});
    }
    file.Replace(Bytes(LongWords{ 5, 6, 7 }), Bytes(LongWords{ 5, 6, 8 }));
    if (isAlone)
    {
      ExpectRefusal(path, { "no numeric dataset", "damaged" });
      continue;
    }
    const auto opened = vol::OpenVolumeFile(path.string());
    ASSERT_EQ(opened->GetWarnings().size(), 1u);
    EXPECT_NE(opened->GetWarnings().front().find("damaged"), std::string::npos);
  }
}

/// As h5py's, which accepts any opaque type, and then fails.
herr_t ConvertForOthers(
  hid_t, hid_t, H5T_cdata_t* data, size_t, size_t, size_t, void*, void*, hid_t)
{
  data->need_bkg = H5T_BKG_NO;
  return data->command == H5T_CONV_CONV ? -1 : 0;
}

/// Sizes in the heap of texts and references, which the library follows wherever they lead. Other code in the
/// process may have conversions of its own.
TEST(HostileHdf, DamagedHeapsAreRefused)
{
  const HdfHandle anyList(H5Tvlen_create(H5T_NATIVE_CHAR), &H5Tclose);
  const HdfHandle anyOpaque(H5Tcreate(H5T_OPAQUE, 8), &H5Tclose);
  H5Tregister(H5T_PERS_SOFT, "others", anyList.Get(), anyOpaque.Get(), &ConvertForOthers);
  const fs::path path = MakeFolder("heap") / "heap.h5";
  const std::uint64_t sizes[] = { std::uint64_t(1) << 44, ~std::uint64_t(15), 24 };
  for (const bool areTexts : { true, false })
  {
    const auto write = [&]
    {
      Writer file(path);
      file.Add("a", { 4, 4, 4 }, {});
      if (areTexts)
      {
        const HdfHandle text(H5Tcopy(H5T_C_S1), &H5Tclose);
        H5Tset_size(text.Get(), H5T_VARIABLE);
        const std::vector<const char*> names{ "zzzzzzz", "y", "x" };
        file.AddAttribute("a", "DIMENSION_LABELS", text.Get(), names);
        return;
      }
      const HdfHandle list(H5Tvlen_create(H5T_STD_REF_OBJ), &H5Tclose);
      hobj_ref_t scale = 0;
      Writer::WriteAll(
        file.Add("s", { 4 }, {}), H5T_NATIVE_UINT8, std::vector<std::uint8_t>{ 0, 1, 2, 3 });
      H5Rcreate(&scale, file.Get(), "s", H5R_OBJECT, -1);
      const std::vector<hvl_t> lists(3, hvl_t{ 1, &scale });
      file.AddAttribute("a", "DIMENSION_LIST", list.Get(), lists);
    };
    write();
    EXPECT_EQ(ReadWatched(path), "");
    const std::string whole = Writer::ReadBytes(path);
    const std::size_t heap = whole.find("GCOL");
    ASSERT_NE(heap, std::string::npos);
    // The size of the heap, of each object, and of what is free behind them; an index.
    for (const std::size_t place : { 8, 24, 48, 72, 96 })
    {
      for (const std::uint64_t size : sizes)
      {
        std::string bytes = whole;
        bytes.replace(heap + place, 8, Bytes(LongWords{ size }));
        WriteText(path, bytes);
        ExpectRefusal(path, { "'DIMENSION_L", "of '/a'", "global heap" });
      }
    }
    std::string bytes = whole;
    bytes[heap + 16] = '\7';
    WriteText(path, bytes);
    ExpectRefusal(path, { "global heap" });
  }
  H5Tunregister(H5T_PERS_SOFT, "others", anyList.Get(), anyOpaque.Get(), &ConvertForOthers);
}

TEST(HostileHdf, ExtentsBeyondTheIndicesOfVtkAreRefused)
{
  const fs::path folder = MakeFolder("extent");
  constexpr long long far = 1LL << 32;
  constexpr long long last = std::numeric_limits<long long>::max();
  for (const std::vector<long long>& extent :
    { std::vector<long long>{ -far, 3 - far, 0, 3, 0, 3 }, { 0, 3, far, far + 3, 0, 3 },
      { 0, 3, 0, 3, -last - 1, last }, { 3, 0, 0, 3, 0, 3 }, { 0, 3, -last - 1, 3 - last, 0, 3 } })
  {
    const fs::path path = folder / "extent.vtkhdf";
    {
      Writer file(path);
      file.AddImage(extent);
      file.Add("VTKHDF/PointData/a", { 4, 4, 4 }, { 2, 2, 2 });
    }
    ExpectRefusal(path, { "WholeExtent" });
  }
}

TEST(HostileHdf, TimesThatAreNotNumbersAreRefused)
{
  const fs::path path = MakeFolder("times") / "times.vtkhdf";
  {
    Writer file(path);
    file.AddImage({ 0, 1, 0, 1, 0, 1 });
    file.AddGroup("VTKHDF/Steps");
    Writer::WriteAll(file.Add("VTKHDF/Steps/Values", { 3 }, {}, H5T_NATIVE_DOUBLE),
      H5T_NATIVE_DOUBLE, std::vector<double>{ 0.0, std::nan(""), 2.0 });
    file.Add("VTKHDF/PointData/a", { 3, 2, 2, 2 }, {});
  }
  ExpectRefusal(path, { "Steps/Values", "not finite" });
}

/// More than the 255 bytes of a file's name: nothing of it is cut off.
TEST(HostileHdf, LongNamesAreRead)
{
  const fs::path path = MakeFolder("names") / "names.vtkhdf";
  const std::string name(1000, 'n');
  {
    Writer file(path);
    file.AddImage({ 0, 1, 0, 1, 0, 1 });
    file.Add("VTKHDF/PointData/" + name, { 2, 2, 2 }, {});
    file.Add("VTKHDF/PointData/Dichte\xe9%s", { 2, 2, 2 }, {});
  }
  EXPECT_EQ(ReadWatched(path), "");
  const auto file = vol::OpenVolumeFile(path.string());
  ASSERT_EQ(file->GetArrays().size(), 2u);
  EXPECT_EQ(file->GetArrays()[0].Name, "Dichte\xe9%s");
  EXPECT_EQ(file->GetArrays()[1].Name, name);
  const fs::path longer = path.parent_path() / "longer.vtkhdf";
  {
    Writer other(longer);
    other.AddImage({ 0, 1, 0, 1, 0, 1 });
    other.Add("VTKHDF/PointData/" + std::string(5000, 'n'), { 2, 2, 2 }, {});
  }
  ExpectRefusal(longer, { "name", "4096 bytes" });
}

/// An index that the file declares, and does not have, is not read.
TEST(HostileHdf, IndicesOfBricksAreBounded)
{
  const fs::path path = MakeFolder("index") / "index.vtkhdf";
  {
    Writer file(path);
    file.AddImage({ 0, 3, 0, 3, 0, 3 });
    file.Add("VTKHDF/PointData/a", { 4, 4, 4 }, {});
    for (const char* group : { "DSM", "DSM/PointData", "DSM/PointData/a" })
    {
      file.AddGroup(group);
    }
    file.AddAttribute("DSM", "BrickEdge", H5T_NATIVE_INT, std::vector<int>{ 16 });
    file.Add("DSM/PointData/a/BrickIndex", { std::uint64_t(1) << 36 }, { 1 << 20 });
    file.Add("DSM/PointData/a/ValueRanges", { std::uint64_t(1) << 33 }, { 1 << 20 });
  }
  EXPECT_EQ(ReadWatched(path), "");
  const auto index = vol::OpenVolumeFile(path.string())->ReadIndex(0, 0);
  EXPECT_TRUE(index.Bricks.empty());
  EXPECT_TRUE(index.Ranges.empty());
}

/// A tree of few nodes that is walked along every way takes 2^32 steps.
TEST(HostileHdf, ATreeWhoseNodesMeetAgainIsRefused)
{
  const fs::path path = MakeFolder("tree") / "tree.h5";
  {
    Writer file(path);
    Writer::WriteAll(
      file.Add("a", { 4, 4, 4 }, { 4, 4, 4 }), H5T_NATIVE_UINT8, std::vector<std::uint8_t>(64, 1));
  }
  std::string bytes = Writer::ReadBytes(path);
  const std::size_t layout = bytes.find(Bytes(Words{ 4, 4, 4, 1 }));
  const std::size_t tree = bytes.rfind("TREE");
  ASSERT_NE(layout, std::string::npos);
  ASSERT_NE(tree, std::string::npos);
  std::uint64_t address = 0;
  std::memcpy(&address, bytes.data() + layout - 8, 8);
  ASSERT_EQ(address, tree);
  const std::string key = bytes.substr(tree + 24, 40);
  std::uint64_t child = address;
  for (char level = 1; level <= 32; ++level)
  {
    const std::string pointer = key + Bytes(LongWords{ child });
    child = bytes.size();
    bytes += "TREE" + std::string{ 1, level, 2, 0 } + Bytes(LongWords{ UINT64_MAX, UINT64_MAX }) +
      pointer + pointer + key;
  }
  std::memcpy(bytes.data() + layout - 8, &child, 8);
  const std::uint64_t end = bytes.size();
  std::memcpy(bytes.data() + 40, &end, 8); // in the superblock
  WriteText(path, bytes);
  ExpectRefusal(path, { "'a'", "index of its chunks" });
}

/// The library adds the size of the block to a place that is none.
TEST(HostileHdf, ValuesBehindAUserBlockThatWereNotWrittenHaveTheFillValue)
{
  const fs::path path = MakeFolder("block") / "block.h5";
  {
    Writer file(path, 512);
    const HdfHandle creation = Writer::CreateProperties();
    const float fill = 7.5f;
    H5Pset_fill_value(creation.Get(), H5T_NATIVE_FLOAT, &fill);
    file.Add("a", { 4, 4, 4 }, {}, H5T_NATIVE_FLOAT, creation);
  }
  EXPECT_EQ(ReadWatched(path), "");
  std::vector<float> values(64);
  const auto file = vol::OpenVolumeFile(path.string());
  file->ReadChunk(0, 0, bricks::Index3(0), reinterpret_cast<std::byte*>(values.data()));
  EXPECT_EQ(values, std::vector<float>(64, 7.5f));
}

/// Where the number is in the name of a folder, the search ends at the same file for each.
TEST(HostileHdf, SourcesOfAVirtualDatasetAreCountedOnce)
{
  const fs::path folder = MakeFolder("virtual");
  fs::create_directories(folder / "part0");
  Writer::WriteAll(Writer(folder / "part0/data.h5").Add("a", { 4, 8, 8 }, {}), H5T_NATIVE_UINT8,
    std::vector<std::uint8_t>(256, 1));
  {
    Writer file(folder / "data.h5", 0, true);
    const Shape shape{ 4, 8, 8 };
    const Shape most{ H5S_UNLIMITED, 8, 8 };
    const HdfHandle space(H5Screate_simple(3, shape.data(), most.data()), &H5Sclose);
    const HdfHandle source(H5Screate_simple(3, shape.data(), nullptr), &H5Sclose);
    const HdfHandle selected(H5Scopy(space.Get()), &H5Sclose);
    const Shape start{ 0, 0, 0 };
    const Shape count{ H5S_UNLIMITED, 1, 1 };
    const Shape stride{ 4, 1, 1 };
    H5Sselect_hyperslab(
      selected.Get(), H5S_SELECT_SET, start.data(), stride.data(), count.data(), shape.data());
    const HdfHandle creation = Writer::CreateProperties();
    H5Pset_virtual(creation.Get(), selected.Get(), "part%b/data.h5", "a", source.Get());
    const HdfHandle dataset(H5Dcreate2(file.Get(), "a", H5T_NATIVE_UINT8, space.Get(), H5P_DEFAULT,
                              creation.Get(), H5P_DEFAULT),
      &H5Dclose);
    ASSERT_TRUE(dataset.IsOpen());
  }
  EXPECT_EQ(ReadWatched(folder / "data.h5"), "");
}

/// The library would show memory behind them.
TEST(HostileHdf, FewerStoredValuesThanTheShapeHasAreRefused)
{
  const fs::path path = MakeFolder("fewer") / "fewer.h5";
  const HdfHandle compound(H5Tcreate(H5T_COMPOUND, 8), &H5Tclose);
  H5Tinsert(compound.Get(), "m", 4, H5T_NATIVE_FLOAT);
  Writer file(path);
  Writer::WriteAll(
    file.Add("a", { 5, 6, 7 }, {}, compound.Get()), compound.Get(), std::vector<double>(5 * 6 * 7));
  file.Replace(Bytes(LongWords{ 5, 6, 7 }), Bytes(LongWords{ 5, 6, 9 }));
  ExpectRefusal(path, { "'a/m'", "fewer values than its shape declares" });
}

/// Reading from a pipe would wait for whoever writes to it.
TEST(HostileHdf, ValuesInAPipeAreRefused)
{
  const fs::path folder = MakeFolder("pipes");
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  {
    Writer file(folder / "external.h5");
    const HdfHandle creation = Writer::CreateProperties();
    H5Pset_external(creation.Get(), (folder / "pipe").c_str(), 0, H5F_UNLIMITED);
    file.Add("a", { 4, 4, 4 }, {}, H5T_NATIVE_UINT8, creation);
  }
  ExpectRefusal(folder / "external.h5", { "pipe", "does not exist or is not a regular file" });
  {
    Writer file(folder / "linked.vtkhdf");
    file.AddImage({ 0, 3, 0, 3, 0, 3 });
    H5Lcreate_external("pipe", "/a", file.Get(), "VTKHDF/PointData/a", H5P_DEFAULT, H5P_DEFAULT);
  }
  ExpectRefusal(folder / "linked.vtkhdf", { "no numeric array" });
  {
    Writer file(folder / "virtual.h5", 0, true);
    const Shape shape{ 4, 4, 4 };
    const HdfHandle space(H5Screate_simple(3, shape.data(), nullptr), &H5Sclose);
    const HdfHandle creation = Writer::CreateProperties();
    H5Pset_virtual(creation.Get(), space.Get(), "pipe", "a", space.Get());
    file.Add("a", shape, {}, H5T_NATIVE_UINT8, creation);
  }
  ExpectRefusal(folder / "virtual.h5", { "pipe", "does not exist" });
}

/// As h5py writes them with libver="latest", and programs of detectors do.
TEST(HostileHdf, ManyChunksOfTheNewFormatsAreOpenedAtOnce)
{
  const fs::path path = MakeFolder("latest") / "latest.h5";
  {
    Writer file(path, 0, true);
    Writer::WriteAll(file.Add("a", { 64, 64, 64 }, { 2, 2, 2 }), H5T_NATIVE_UINT8,
      std::vector<std::uint8_t>(64 * 64 * 64, 9));
  }
  EXPECT_EQ(ReadWatched(path), "");
  int asked = 0;
  vol::OpenOptions options;
  options.GoesOn = [&] { return ++asked < 2; };
  ExpectRefusal(path, { "was aborted" }, options);
  EXPECT_EQ(asked, 2);
}

} // namespace
