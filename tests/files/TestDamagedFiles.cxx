// SPDX-License-Identifier: BSD-3-Clause
// Files that other programs wrote (make_files.py), damaged, changed, or taken away: what is said then.
#include "VolumeManifest.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/cache/ChunkCache.h"
#include "DSMVolumeFiles/open/SeriesFile.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <string>
#include <thread>
#include <vector>

#include <linux/capability.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace
{

using namespace dsm_test;

/// A copy that may be damaged.
class DamagedFile : public testing::Test
{
protected:
  Json Copy(const std::string& name)
  {
    Json entry = FindEntry(name);
    this->Path = GetFolder() / ("damaged_" + name);
    fs::remove_all(this->Path);
    fs::copy(GetFolder() / name, this->Path, fs::copy_options::recursive);
    entry["file"] = "damaged_" + name;
    return entry;
  }

  static void FlipByte(const fs::path& path, std::int64_t fromEnd)
  {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(-fromEnd, std::ios::end);
    const char byte = static_cast<char>(file.get());
    file.seekp(-fromEnd, std::ios::end);
    file.put(static_cast<char>(~byte));
  }

  /// Reads all; returns what goes wrong.
  static std::string Read(const Json& entry)
  {
    try
    {
      return Read(Open(entry));
    }
    catch (const dsm::Error& error)
    {
      return error.what();
    }
  }
  static std::string Read(const std::shared_ptr<const vol::VolumeFile>& file)
  {
    try
    {
      vol::ChunkCache cache(1);
      const vol::FileArray& array = file->GetArrays()[0];
      const bricks::Box whole{ bricks::Index3(0), array.Grid.Samples };
      std::vector<std::byte> bytes(
        static_cast<std::size_t>(whole.GetCount()) * array.GetSampleBytes());
      cache.ReadBox({ file, 0, 0 }, whole, bytes.data());
      return {};
    }
    catch (const dsm::Error& error)
    {
      return error.what();
    }
  }

  fs::path Path;
};

void ExpectWords(const std::string& text, std::initializer_list<const char*> words)
{
  for (const char* word : words)
  {
    EXPECT_NE(text.find(word), std::string::npos) << "'" << word << "' is not in: " << text;
  }
}

TEST_F(DamagedFile, ThatIsTruncatedSaysSo)
{
  for (const char* name : { "attached.nrrd", "attached.mha", "bare.raw" })
  {
    const Json entry = this->Copy(name);
    fs::resize_file(this->Path, fs::file_size(this->Path) - 1);
    ExpectWords(Read(entry), { name, "bytes", "expected" });
  }
  const Json chunks = this->Copy("raw_float32.zarr");
  fs::resize_file(this->Path / "1.1.1", 17);
  ExpectWords(Read(chunks), { "Chunk (1, 1, 1)", "17 bytes instead of 640" });
  const Json shards = this->Copy("three_sharded.zarr");
  fs::resize_file(this->Path / "c/0/0/0", 10);
  ExpectWords(Read(shards), { "truncated", "c/0/0/0" });
}

TEST_F(DamagedFile, WithAWrongByteSaysSo)
{
  const Json sums = this->Copy("fletcher.h5");
  // Somewhere in the values, which are behind the header.
  FlipByte(this->Path, static_cast<std::int64_t>(fs::file_size(this->Path)) / 2);
  ExpectWords(Read(sums), { "fletcher.h5", "Chunk (", "checksum" });
  const Json stream = this->Copy("zlib_float32.zarr");
  FlipByte(this->Path / "0.1.2", 3);
  ExpectWords(Read(stream), { "Chunk (2, 1, 0)", "deflate stream is damaged" });
  const Json frame = this->Copy("zstd_float32.zarr");
  FlipByte(this->Path / "0.0.0", static_cast<std::int64_t>(fs::file_size(this->Path / "0.0.0")));
  ExpectWords(Read(frame), { "Chunk (0, 0, 0)", "Zstandard" });
  const Json index = this->Copy("three_sharded.zarr");
  FlipByte(this->Path / "c/0/0/0", 20);
  ExpectWords(Read(index), { "index", "checksum" });
}

TEST_F(DamagedFile, ThatIsAnArchiveSaysSo)
{
  const Json entry = this->Copy("raw_zipped.zip");
  const auto size = static_cast<std::int64_t>(fs::file_size(this->Path));
  // The directory and its end; then wherever it is cut.
  int refused = 0;
  for (std::int64_t fromEnd = 1; fromEnd <= 3000; fromEnd += 7)
  {
    FlipByte(this->Path, fromEnd);
    const std::string what = Read(entry);
    refused += what.empty() ? 0 : 1;
    if (!what.empty())
    {
      ExpectWords(what, { "raw_zipped.zip" });
    }
    FlipByte(this->Path, fromEnd);
  }
  EXPECT_GT(refused, 100);
  EXPECT_EQ(Read(entry), "");
  for (std::int64_t bytes = size - 1; bytes > 4; bytes -= bytes > size - 40 ? 1 : size / 50)
  {
    fs::resize_file(this->Path, static_cast<std::uintmax_t>(bytes));
    ExpectWords(Read(entry), { "raw_zipped.zip", "damaged ZIP archive" });
  }
}

/// Meanwhile, root reads no more than others do. Of this thread.
class WithoutPrivileges
{
public:
  WithoutPrivileges()
  {
    __user_cap_data_struct none[_LINUX_CAPABILITY_U32S_3];
    this->Call(SYS_capget, this->Before);
    std::copy(std::begin(this->Before), std::end(this->Before), none);
    none[0].effective = none[1].effective = 0;
    this->Call(SYS_capset, none);
  }
  ~WithoutPrivileges() { this->Call(SYS_capset, this->Before); }
  WithoutPrivileges(const WithoutPrivileges&) = delete;
  void operator=(const WithoutPrivileges&) = delete;

private:
  static void Call(long what, __user_cap_data_struct* data)
  {
    __user_cap_header_struct header{ _LINUX_CAPABILITY_VERSION_3, 0 };
    ASSERT_EQ(syscall(what, &header, data), 0);
  }

  __user_cap_data_struct Before[_LINUX_CAPABILITY_U32S_3] = {};
};

TEST_F(DamagedFile, ThatMayNotBeReadSaysSo)
{
  const auto forbid = [](const fs::path& path) { fs::permissions(path, fs::perms::none); };
  for (const char* name : { "chunked.h5", "attached.nrrd", "attached.mha", "bare.raw" })
  {
    const Json entry = this->Copy(name);
    forbid(this->Path);
    const WithoutPrivileges meanwhile;
    ExpectWords(Read(entry), { name, "cannot be opened", "Permission denied" });
  }
  const Json chunks = this->Copy("raw_float32.zarr");
  forbid(this->Path / "1.1.1");
  const Json described = this->Copy("ome.zarr");
  forbid(this->Path / ".zattrs");
  const WithoutPrivileges meanwhile;
  ExpectWords(Read(chunks), { "1.1.1", "Permission denied" });
  ExpectWords(Read(described), { ".zattrs", "Permission denied" });
}

TEST_F(DamagedFile, ThatChangesOrGoesAwaySaysSo)
{
  const Json entry = this->Copy("chunked.h5");
  const auto file = Open(entry);
  EXPECT_EQ(Read(file), "");
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  FlipByte(this->Path, 100);
  ExpectWords(Read(file), { "changed", "Reload" });
  fs::remove(this->Path);
  ExpectWords(Read(entry), { "does not exist", "damaged_chunked.h5" });
  EXPECT_NE(Open(FindEntry("chunked.h5"))->GetStamp(), file->GetStamp());
}

TEST_F(DamagedFile, WithAWrongHeaderSaysWhatIsWrong)
{
  const auto write = [&](const std::string& name, const std::string& text)
  {
    std::ofstream(GetFolder() / name) << text;
    return Json{ { "file", name }, { "level", 0 }, { "dataset", "" } };
  };
  const std::string axes = "dimension: 3\nsizes: 2 2 2\n";
  ExpectWords(Read(write("a.nrrd", "NRRD0004\ntype: float\n" + axes + "encoding: hex\n\n")),
    { "a.nrrd", "hex", "gzip", "unu save" });
  ExpectWords(Read(write("b.nrrd", "NRRD0004\ntype: block\n" + axes + "encoding: raw\n\n")),
    { "type 'block'" });
  ExpectWords(Read(write("c.nrrd", "NRRD0004\ntype: float\nsizes: 2 x 2\nencoding: raw\n\n")),
    { "'x'", "'sizes'", "not a number" });
  ExpectWords(Read(write("d.mhd",
                "NDims = 3\nDimSize = 2 2 2\nCompressedData = True\nElementDataFile = e\n")),
    { "scalar type ''" });
  ExpectWords(
    Read(write("e.txt", "no volume")), { "e.txt", "unknown format", "Zarr", "Save Data" });
  ExpectWords(Read(write("e.h5", "")), { "e.h5", "is empty" });
  ExpectWords(Read(write("e.zarr.zip", "PK\x03\x04 and so on")),
    { "e.zarr.zip", "ZIP", "damaged ZIP archive" });
  ExpectWords(Read(write("f.raw", "12345678")), { "f.raw", "has no header" });
  ExpectWords(Read(write("g.h5", "\x89HDF\r\n\x1a\n and then nothing")),
    { "g.h5", "cannot be opened as HDF5" });
}

/// No part of a header is shown as values.
TEST_F(DamagedFile, WhoseValuesWouldBeginInItsHeaderIsRefused)
{
  const auto write = [&](const std::string& name, const std::string& text)
  {
    std::ofstream(GetFolder() / name) << text;
    return Json{ { "file", name }, { "level", 0 }, { "dataset", "" } };
  };
  const std::string meta = "NDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n";
  for (const char* size : { "9", "-1" })
  {
    const std::string skip = std::string("HeaderSize = ") + size + "\nElementDataFile = LOCAL\n";
    ExpectWords(Read(write("part.mha", meta + skip + "1234567")), { "part.mha", "8 of values" });
  }
  EXPECT_EQ(
    Read(write("part.mha", meta + "HeaderSize = -1\nElementDataFile = LOCAL\n12345678")), "");
  const std::string nrrd =
    "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\nbyte skip: -1\n";
  ExpectWords(Read(write("part.nrrd", nrrd + "\n1234567")), { "part.nrrd", "8 of values" });
  EXPECT_EQ(Read(write("part.nrrd", nrrd + "\n12345678")), "");
  // Nor of one that ends early.
  for (const char* size : { "", "HeaderSize = -1\n" })
  {
    ExpectWords(Read(write("part.mha", meta + size + "ElementDataFile = LOCAL")),
      { "part.mha", "ends after its header" });
  }
  for (const std::string& text : { nrrd, nrrd.substr(0, nrrd.find("byte")) })
  {
    ExpectWords(
      Read(write("part.nrrd", text)), { "part.nrrd", "ends after its header", "empty line" });
  }
}

/// Nothing of it may be reckoned with before it is checked.
TEST_F(DamagedFile, WithSizesThatCannotBeIsRefused)
{
  const auto write = [&](const std::string& name, const std::string& text)
  {
    std::ofstream(GetFolder() / name) << text;
    return Json{ { "file", name }, { "level", 0 }, { "dataset", "" } };
  };
  const auto nrrd = [&](const std::string& axes)
  {
    return write("sizes.nrrd",
      "NRRD0004\ntype: float\nencoding: raw\nendian: little\n" + axes + "\n\n" +
        std::string(64, 'v'));
  };
  ExpectWords(Read(nrrd("sizes: 0 4 4 4")), { "sizes.nrrd", "0 components" });
  ExpectWords(Read(nrrd("sizes: 4 -4 4")), { "4 x -4 x 4 samples" });
  ExpectWords(Read(nrrd("sizes: 2097152 2097152 1048576")), { "2097152 x 2097152 x 1048576" });
  ExpectWords(Read(nrrd("sizes: 2 2 2 2\nkinds: domain vector domain domain")), { "permute" });
  ExpectWords(Read(nrrd("sizes: 2 2 2 2\nkinds: domain domain domain time")), { "time" });
  ExpectWords(Read(nrrd("sizes: 2 2 2\nspace origin: (1,x,2)")), { "'x'", "space origin" });
  ExpectWords(Read(nrrd("sizes: 2 2 2\nspace directions: (1,0,0) (0,1")),
    { "without a closing parenthesis" });
  ExpectWords(Read(nrrd("sizes: 2 2 2\ndata file: LIST 2")), { "0 files instead of 2" });
  ExpectWords(Read(nrrd("sizes: 2 2 2\ndata file: a%03d.raw 1 2 1")), { "a001.raw" });
  ExpectWords(Read(nrrd("sizes: 2 2 2\nlineskip: 2")), { "fewer lines" });
  const auto meta = [&](const std::string& text)
  {
    return write("sizes.mha",
      "NDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n" + text +
        "\nElementDataFile = LOCAL\n1 2 3 4 5 6 7 8");
  };
  ExpectWords(Read(meta("ElementNumberOfChannels = 0")), { "sizes.mha", "0 components" });
  ExpectWords(Read(meta("BinaryData = False")), { "text" });
  ExpectWords(Read(meta("CompressedData = T")), { "compressed" });

  const auto zarr3 = [&](const Json& changes)
  {
    const Json entry = this->Copy("three_sharded.zarr");
    std::ifstream old(this->Path / "zarr.json");
    Json metadata = Json::parse(old);
    metadata.merge_patch(changes);
    std::ofstream(this->Path / "zarr.json") << metadata;
    return entry;
  };
  const auto shards = [&](const Json& shard, const Json& chunk)
  {
    Json codecs = Json::parse(R"([{"name": "sharding_indexed", "configuration": {
      "codecs": ["bytes"], "index_codecs": ["bytes"]}}])");
    codecs[0]["configuration"]["chunk_shape"] = chunk;
    return zarr3({ { "codecs", codecs },
      { "chunk_grid",
        { { "name", "regular" }, { "configuration", { { "chunk_shape", shard } } } } } });
  };
  ExpectWords(Read(shards({ 4, 10, 8 }, { 0, 5, 4 })), { "three_sharded", "shards" });
  ExpectWords(Read(shards({ 4, 10, 8 }, { 3, 5, 4 })), { "shards" });
  const std::int64_t many = std::int64_t(1) << 32;
  ExpectWords(Read(shards({ many, many, many }, { 1, 1, 1 })), { "shards", "too many chunks" });
  ExpectWords(Read(zarr3({ { "shape", { many, 4, 4 } } })), { "'shape'", "4294967296" });
  ExpectWords(Read(zarr3({ { "fill_value", "0x12345678f" } })), { "fill value" });
  ExpectWords(Read(zarr3({ { "data_type", { { "name", "string" } } } })), { "'string'" });
  ExpectWords(Read(zarr3({ { "codecs", { "sharding_indexed", "crc32c" } } })), { "shards" });
  const auto transposed = [&](const std::vector<std::vector<int>>& orders)
  {
    Json codecs = Json::array();
    for (const std::vector<int>& order : orders)
    {
      codecs.push_back({ { "name", "transpose" }, { "configuration", { { "order", order } } } });
    }
    codecs.push_back("bytes");
    return zarr3({ { "codecs", codecs } });
  };
  ExpectWords(Read(transposed({ { 1, 2, 0 }, { 1, 2, 0 } })), { "some of its axes" });
  ExpectWords(Read(transposed({ { 2, 1, 0 }, { 1, 0, 2 } })), { "some of its axes" });
  ExpectWords(Read(transposed({ { 1, 0 } })), { "transpose codec", "3 axes" });
  ExpectWords(Read(transposed({ { 0, 0, 0 } })), { "transpose codec", "3 axes" });
  Json ofIndex = Json::parse(R"([{"name": "sharding_indexed", "configuration": {
    "chunk_shape": [2, 5, 4], "codecs": ["bytes"], "index_codecs": [
    {"name": "transpose", "configuration": {"order": [3, 2, 1, 0]}}, "bytes"]}}])");
  ExpectWords(Read(zarr3({ { "codecs", ofIndex } })), { "index", "transposed" });

  const auto ome = [&](const Json& axes)
  {
    const Json entry = this->Copy("ome.zarr");
    std::ifstream old(this->Path / ".zattrs");
    Json attributes = Json::parse(old);
    attributes["multiscales"][0]["axes"] = axes;
    std::ofstream(this->Path / ".zattrs") << attributes;
    return entry;
  };
  ExpectWords(Read(ome({ "t", "z", "c", "y", "x" })), { "three spatial axes", "order" });
  EXPECT_EQ(Open(ome({ "c", "t", "z", "y", "x" }))->GetSteps(), 2);
  EXPECT_EQ(Open(ome({ "C", "T", "Z", "Y", "X" }))->GetSteps(), 2);
  ExpectWords(Read(ome({ "t", "c", "y", "x", "y" })), { "t, c, y, x, y", "order" });

  const auto named = [&](const std::string& name, const Json& axes)
  {
    const Json entry = this->Copy(name);
    std::ofstream(this->Path / ".zattrs") << Json{ { "_ARRAY_DIMENSIONS", axes } };
    return entry;
  };
  for (const Json& axes : { Json{ "time", "y", "x" }, Json{ "y", "x", "c" }, Json{ "Y", "X", "Y" },
         Json{ "x", "X", "y" } })
  {
    ExpectWords(
      Read(named("raw_float32.zarr", axes)), { "raw_float32.zarr", "three spatial axes", "order" });
  }
  for (const Json& axes : { Json{ "t", "c", "y", "x", "x" }, Json{ "z", "TIME", "y", "x", "c" },
         Json{ "x", "y", "z", "c", "time" } })
  {
    Json entry = named("ome.zarr", axes);
    fs::rename(this->Path / ".zattrs", this->Path / "0/.zattrs");
    entry["file"] = "damaged_ome.zarr/0";
    ExpectWords(Read(entry), { "not a volume", "three spatial axes" });
  }
}

TEST_F(DamagedFile, WithOtherChunksThanItsSeriesSaysSo)
{
  const auto path = [](const char* name) { return (GetFolder() / name).string(); };
  const auto file =
    vol::OpenVolumeSeries({ path("chunked.h5"), path("blosc.h5"), path("contiguous.h5") }, {});
  std::vector<std::byte> bytes(21 * 13 * 10 * 4);
  file->ReadChunk(0, 1, bricks::Index3(0), bytes.data());
  try
  {
    file->ReadChunk(0, 2, bricks::Index3(0), bytes.data());
    ADD_FAILURE() << "it is taken";
  }
  catch (const dsm::Error& error)
  {
    ExpectWords(error.what(),
      { "contiguous.h5' cannot be a time step",
        "chunks of 21 x 13 x 10 samples instead of 8 x 5 x 4" });
  }
}

/// A chunk of one channel, or of all of them one behind the other, has no samples in one piece.
TEST_F(DamagedFile, WhoseChannelsAreApartSaysSo)
{
  const auto change = [&](const char* name, const char* field, const Json& value)
  {
    const Json entry = this->Copy(name);
    std::ifstream old(this->Path / ".zarray");
    Json metadata = Json::parse(old);
    metadata[field] = value;
    std::ofstream(this->Path / ".zarray") << metadata;
    return entry;
  };
  ExpectWords(Read(change("components.zarr", "chunks", { 4, 5, 8, 1 })),
    { "damaged_components.zarr'", "chunks of 4 x 5 x 8 x 1.", "all 3 channels" });
  ExpectWords(Read(change("components_x.zarr", "order", "F")),
    { "damaged_components_x.zarr'", "chunks of 8 x 5 x 4 x 3 in Fortran order" });
}

/// As Python writes them, which JSON does not have.
TEST_F(DamagedFile, WithABareWordForAFillValueHasIt)
{
  for (const char* word : { "NaN", "Infinity", "-Infinity" })
  {
    const Json entry = this->Copy("holes.zarr");
    std::ifstream old(this->Path / ".zarray");
    std::string text{ std::istreambuf_iterator<char>(old), {} };
    text.replace(text.find("42.0"), 4, word);
    std::ofstream(this->Path / ".zarray") << text;
    vol::ChunkCache cache(1);
    float value = 0.0f;
    const bricks::Box last{ bricks::Index3(20, 12, 9), bricks::Index3(21, 13, 10) };
    cache.ReadBox({ Open(entry), 0, 0 }, last, reinterpret_cast<std::byte*>(&value));
    const float expected = std::strtof(word, nullptr);
    EXPECT_TRUE(value == expected || (std::isnan(value) && std::isnan(expected))) << value;
  }
}

/// What is kept of it is of other values, or lies elsewhere; but not when attributes change that are not read.
TEST_F(DamagedFile, WhoseAttributesChangeHasAnotherStamp)
{
  const auto change = [&](const Json& entry, const char* pointer, const Json& value)
  {
    const std::uint64_t before = Open(entry)->GetStamp();
    std::ifstream old(this->Path / ".zattrs");
    Json attributes = Json::parse(old);
    attributes[Json::json_pointer(pointer)] = value;
    std::ofstream(this->Path / ".zattrs") << attributes;
    return Open(entry)->GetStamp() != before;
  };
  const Json ome = this->Copy("ome.zarr");
  EXPECT_FALSE(change(ome, "/of_no_use", 1));
  EXPECT_TRUE(change(ome, "/multiscales/0/axes", { "t", "c", "x", "y", "z" }));
  EXPECT_TRUE(change(ome, "/multiscales/0/axes", { "c", "t", "x", "y", "z" }));
  EXPECT_TRUE(change(ome, "/omero/channels/0/label", "blue"));
  EXPECT_TRUE(change(ome, "/multiscales/0/datasets/0/coordinateTransformations/0/scale/4", 7));
  const Json named = this->Copy("from_x.zarr");
  EXPECT_FALSE(change(named, "/of_no_use", 1));
  EXPECT_TRUE(change(named, "/_ARRAY_DIMENSIONS", { "z", "y", "x" }));
}

/// The library would take it for what it was, for as long as anybody has it open.
TEST_F(DamagedFile, ThatIsWrittenAnewInPlaceIsOpenedAsItIs)
{
  for (const char* name : { "deflate.h5", "bits12.h5", "contiguous.h5" })
  {
    SCOPED_TRACE(name);
    const auto before = Open(this->Copy(name));
    EXPECT_EQ(Read(before), "");
    std::ifstream other(GetFolder() / "ball.h5", std::ios::binary);
    std::ofstream(this->Path, std::ios::binary) << other.rdbuf();
    const auto after = vol::OpenVolumeFile(this->Path.string());
    EXPECT_EQ(after->GetGeometry().Points, bricks::Index3(48, 40, 36));
    EXPECT_EQ(Read(after), "");
    ExpectWords(Read(before), { name, "changed", "Reload" });
  }
}

/// What was read before must not meet other values: chunks are files that are opened anew.
TEST_F(DamagedFile, WhoseChunksChangeOrGoAwaySaysSo)
{
  const Json plain = this->Copy("raw_float32.zarr");
  const auto file = Open(plain);
  EXPECT_EQ(Read(file), "");
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  FlipByte(this->Path / "1.1.1", 5);
  ExpectWords(Read(file), { "1.1.1", "changed", "Reload" });
  EXPECT_EQ(Read(plain), "");
  fs::remove(this->Path / "1.1.1");
  ExpectWords(Read(file), { "1.1.1", "was deleted" });
  const auto rest = Open(plain);
  fs::remove_all(this->Path);
  ExpectWords(Read(rest), { "raw_float32", "was deleted" });

  const Json shards = this->Copy("three_sharded.zarr");
  const auto sharded = Open(shards);
  EXPECT_EQ(Read(sharded), "");
  const fs::path shard = this->Path / "c/0/0/0";
  fs::copy_file(shard, shard.string() + ".new");
  fs::rename(shard.string() + ".new", shard);
  ExpectWords(Read(sharded), { "c/0/0/0", "was replaced" });
}

/// Values that an HDF5 file has from others change with those.
TEST_F(DamagedFile, WhoseOriginsChangeOrGoAwaySaysSo)
{
  const auto see = [](const std::string& folder, const std::string& name, const std::string& origin)
  {
    SCOPED_TRACE(name);
    const fs::path path = GetFolder() / folder / origin;
    const Json entry = { { "file", folder + "/" + name }, { "level", 0 }, { "dataset", "" } };
    const auto file = Open(entry);
    EXPECT_EQ(Read(file), "");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    FlipByte(path, 9);
    ExpectWords(Read(file), { origin.c_str(), "changed", "Reload" });
    EXPECT_NE(Open(entry)->GetStamp(), file->GetStamp());
    const std::string away = path.string() + ".away";
    fs::rename(path, away);
    ExpectWords(Read(file), { origin.c_str(), "was deleted" });
    EXPECT_NE(Read(entry), "");
    fs::rename(away, path);
  };
  this->Copy("origins");
  see("damaged_origins", "virtual.h5", "b.bin");
  see("damaged_origins", "link.h5", "d.bin");
  see("origins", "changed.h5", "changed.bin"); // which has its whole path
}

TEST_F(DamagedFile, WhoseTimesDescendSaysSo)
{
  const Json entry = { { "file", "descending.vtkhdf" }, { "level", 0 }, { "dataset", "" } };
  ExpectWords(Read(entry), { "descending.vtkhdf", "is not in ascending order" });
}

} // namespace
