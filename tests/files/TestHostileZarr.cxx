// SPDX-License-Identifier: BSD-3-Clause
// Zarr folders whose metadata and chunks are made to mislead: each is refused, soon, without much memory.
#include "WatchedReading.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/codec/ChunkCodec.h"
#include "DSMVolumeFiles/open/OpenVolumeFile.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdint>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include <sys/stat.h>

namespace
{

using namespace dsm_test;
using Json = nlohmann::json;

Json GetVersion2()
{
  return Json::parse(R"({"zarr_format": 2, "shape": [4, 4, 4], "chunks": [4, 4, 4], "dtype": "<f4",
    "fill_value": 0, "order": "C", "filters": null, "compressor": null})");
}

Json GetVersion3()
{
  return Json::parse(R"({"zarr_format": 3, "node_type": "array", "shape": [4, 4, 4],
    "data_type": "float32", "chunk_grid": {"name": "regular",
    "configuration": {"chunk_shape": [4, 4, 4]}}, "chunk_key_encoding": {"name": "default"},
    "fill_value": 0, "codecs": [{"name": "bytes", "configuration": {"endian": "little"}}]})");
}

/// Writes an array of version 2, or 3, with changes.
fs::path Write2(const std::string& name, const Json& changes, const Json& attributes = {})
{
  const fs::path folder = MakeFolder(name);
  Json metadata = GetVersion2();
  metadata.update(changes.is_null() ? Json::object() : changes);
  WriteText(folder / ".zarray", metadata.dump());
  if (!attributes.is_null())
  {
    WriteText(folder / ".zattrs", attributes.dump());
  }
  return folder;
}

fs::path Write3(const std::string& name, const Json& changes)
{
  const fs::path folder = MakeFolder(name);
  Json metadata = GetVersion3();
  metadata.update(changes);
  WriteText(folder / "zarr.json", metadata.dump());
  return folder;
}

void WriteBytes(const fs::path& path, const vol::ByteBuffer& bytes)
{
  WriteText(path, std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

std::string MakeDeep(std::size_t levels)
{
  return std::string(levels, '[') + std::string(levels, ']');
}

TEST(HostileZarr, DeepMetadataAreRefused)
{
  const fs::path attributes = Write2("deep", {});
  WriteText(attributes / ".zattrs", "{\"a\":" + MakeDeep(100000) + "}");
  ExpectRefusal(attributes, { ".zattrs", "nested" });
  const fs::path fill = MakeFolder("deepfill");
  std::string text = GetVersion2().dump();
  const std::string before = "\"fill_value\":0";
  text.replace(text.find(before), before.size(), "\"fill_value\":" + MakeDeep(100000));
  WriteText(fill / ".zarray", text);
  ExpectRefusal(fill, { ".zarray", "nested" });
}

TEST(HostileZarr, LargeMetadataAreRefused)
{
  const fs::path sparse = MakeFolder("longjson");
  WriteSparse(sparse / ".zarray", std::uintmax_t(3) << 30);
  ExpectRefusal(sparse, { ".zarray", "3221225472 bytes" });
  const fs::path many = Write2("manyvalues", {});
  std::string text = "{\"a\":[0";
  for (int value = 0; value < 3000000; ++value)
  {
    text += ",0";
  }
  WriteText(many / ".zattrs", text + "]}");
  ExpectRefusal(many, { ".zattrs", "values" });
  const fs::path objects = Write2("manyobjects", {});
  text = "{\"a\":[{}";
  for (int value = 0; value < 120000; ++value)
  {
    text += ",{\"a\":{}}";
  }
  WriteText(objects / ".zattrs", text + "]}");
  ExpectRefusal(objects, { ".zattrs", "values" });
}

/// They are copies of what other files have, and may be many.
TEST(HostileZarr, ConsolidatedMetadataDoNotCount)
{
  Json all = Json::object();
  for (int array = 0; array < 10000; ++array)
  {
    all["array" + std::to_string(array)] = { 1, 2, { { "a", { 3, 4, 5, 6 } } } };
  }
  const fs::path folder = Write3("consolidated", { { "consolidated_metadata", all } });
  EXPECT_EQ(ReadWatched(folder), "");
}

TEST(HostileZarr, TextThatIsNotJsonIsRefused)
{
  const fs::path folder = Write2("bytes", {});
  for (const char* text : { "{\"a\": \"b\xe9ta\"}", "{\"a\": 1e999}", "{", "", "[1, 2" })
  {
    WriteText(folder / ".zattrs", text);
    ExpectRefusal(folder, { ".zattrs", "damaged", "byte" });
  }
}

TEST(HostileZarr, NumbersOutOfRangeAreRefused)
{
  const Json names = { { "_ARRAY_DIMENSIONS", { "t", "z", "y", "x" } } };
  const std::int64_t most = 0x7fffffff;
  ExpectRefusal(
    Write2("time", { { "shape", { most, 2, 2, 2 } }, { "chunks", { 1, 2, 2, 2 } } }, names),
    { "2147483647 time steps" });
  const Json channels = { { "_ARRAY_DIMENSIONS", { "z", "y", "x", "channel" } } };
  ExpectRefusal(
    Write2("components",
      { { "shape", { 2, 2, 2, most } }, { "chunks", { 1, 1, 1, most } }, { "dtype", "<f8" } },
      channels),
    { "2147483647 components" });
  for (const Json& length : { Json(1e300), Json(-4), Json(4.7), Json("4"), Json(nullptr),
         Json(std::uint64_t(1) << 63), Json::array({ 4 }) })
  {
    const fs::path shape = Write2("shape", { { "shape", { 4, length, 4 } } });
    ExpectRefusal(shape, { "'shape'", "not an integer" });
    const fs::path chunks = Write2("chunks", { { "chunks", { 4, length, 4 } } });
    ExpectRefusal(chunks, { "'chunks'", "not an integer" });
    const Json grid = { { "name", "regular" },
      { "configuration", { { "chunk_shape", { 4, length, 4 } } } } };
    ExpectRefusal(Write3("grid", { { "chunk_grid", grid } }), { "'chunk_shape'" });
  }
  for (const Json& chunks :
    { Json::array(), Json({ 0, 4, 4 }), Json({ 4, 4 }), Json({ 4, 4, 4, 4 }) })
  {
    ExpectRefusal(Write2("fewer", { { "chunks", chunks } }), { "not a volume" });
  }
  ExpectRefusal(Write2("missing", { { "shape", nullptr } }), { "'shape'", "missing" });
  ExpectRefusal(Write2("whole", { { "shape", { most, most, most } } }), { "samples" });
  ExpectRefusal(Write2("wholechunk",
                  { { "chunks", { most, most, most } }, { "compressor", { { "id", "zlib" } } } }),
    { "samples" });
  ExpectRefusal(Write2("largechunk",
                  { { "chunks", { 2048, 2048, 2048 } }, { "compressor", { { "id", "zlib" } } } }),
    { "chunks of 2048 x 2048 x 2048", "smaller chunks" });
  for (const Json& fill : { Json(300), Json(-1), Json(0.5), Json(1e300), Json::array({ 1 }),
         Json("NaN"), Json::object() })
  {
    ExpectRefusal(Write2("fill", { { "fill_value", fill }, { "dtype", "|u1" } }), { "fill value" });
  }
  EXPECT_EQ(ReadWatched(Write2("fills", { { "fill_value", 7.0 }, { "dtype", "|u1" } })), "");
}

/// Numbers that are too many are seen before any of them is worked with.
TEST(HostileZarr, ManyAxesAndFiltersAreRefused)
{
  constexpr int count = 200000;
  std::vector<int> order(count);
  std::iota(order.rbegin(), order.rend(), 0);
  const Json transpose = { { "name", "transpose" }, { "configuration", { { "order", order } } } };
  const Json codecs = { transpose, GetVersion3()["codecs"][0] };
  ExpectRefusal(
    Write3("order", { { "shape", std::vector<int>(count / 2, 1) }, { "codecs", codecs } }),
    { "zarr.json", "values" });
  ExpectRefusal(Write3("axes", { { "shape", std::vector<int>(1000, 1) } }), { "1000", "'shape'" });
  order.assign(1000, 0);
  const Json shorter = { { "name", "transpose" }, { "configuration", { { "order", order } } } };
  ExpectRefusal(Write3("order", { { "codecs", { shorter } } }), { "1000", "'order'" });

  const auto repeat = [](const Json& what, std::size_t times)
  { return Json(std::vector<Json>(times, what)); };
  const Json zlib = { { "id", "zlib" } };
  const fs::path filters = Write2("filters", { { "filters", repeat(zlib, 300) } });
  WriteText(filters / "0.0.0", std::string(256, '\0'));
  ExpectRefusal(filters, { "300 filters" });
  ExpectRefusal(Write2("fewerfilters", { { "filters", repeat(zlib, 30) } }), { "30 filters" });
  ExpectRefusal(Write3("codecs", { { "codecs", repeat("crc32c", 300) } }), { "300 codecs" });
  ExpectRefusal(Write3("zstds", { { "codecs", repeat("zstd", 30) } }), { "30 of which" });
  for (const Json& width : { Json(-1), Json(1e300), Json(0.5), Json("4") })
  {
    const Json shuffle = { { "id", "shuffle" }, { "elementsize", width } };
    ExpectRefusal(Write2("width", { { "filters", { shuffle } } }), { "'elementsize'" });
  }
  const Json levels = repeat({ { "path", "0" } }, 1000);
  const fs::path scales = MakeFolder("scales");
  WriteText(scales / ".zgroup", "{}");
  WriteText(scales / ".zattrs", Json({ { "multiscales", { { { "datasets", levels } } } } }).dump());
  ExpectRefusal(scales, { "1000 levels" });
}

/// A file is not read for a chunk that cannot be as large.
TEST(HostileZarr, ChunksThatCannotBeSoLargeAreNotRead)
{
  for (const char* compressor : { "", "zlib", "zstd", "blosc" })
  {
    const Json codec = *compressor ? Json({ { "id", compressor } }) : Json();
    const fs::path folder = Write2("sparse", { { "compressor", codec } });
    WriteSparse(folder / "0.0.0", std::uintmax_t(40) * 1000 * 1000 * 1000);
    ExpectRefusal(folder, { "0.0.0", "Chunk (0, 0, 0)", "40000000000 bytes" });
  }
  // A few samples of a large chunk that lies plain in its file, and of one that has the order of Fortran.
  const Json large = { { "chunks", { 1024, 1024, 512 } } };
  const fs::path plain = Write2("largechunk", large);
  WriteSparse(plain / "0.0.0", std::uintmax_t(2) << 30);
  EXPECT_EQ(ReadWatched(plain), "");
  const Json slices = { { "chunks", { 1024, 1024, 16, 16 } }, { "shape", { 4, 4, 4, 4 } } };
  const fs::path several = Write2("slices", slices);
  WriteSparse(several / "0.0.0.0", std::uintmax_t(1) << 30);
  EXPECT_EQ(ReadWatched(several), "");
}

/// Of a plain chunk with several times and channels, only the rows of one are read.
TEST(HostileZarr, SlicesOfALargeChunkAreReadByThemselves)
{
  const Json shape = { { "shape", { 2, 3, 2, 8, 2048 } }, { "chunks", { 2, 3, 3, 512, 4096 } },
    { "dtype", "|u1" } };
  const fs::path folder = Write2("manyslices", shape);
  constexpr std::size_t row = 4096;
  constexpr std::size_t slice = 3 * 512 * row;
  std::string text(6 * slice, '\0');
  for (std::size_t place = 0; place < 6 * 3; ++place)
  {
    text[place * 512 * row + 7 * row + 5] = static_cast<char>(place + 1);
  }
  WriteText(folder / "0.0.0.0.0", text);
  const auto file = vol::OpenVolumeFile(folder.string());
  ASSERT_EQ(file->GetArrays().size(), 3u);
  ASSERT_EQ(file->GetSteps(), 2);
  const bricks::Box box = file->GetArrays()[0].Grid.GetBox(bricks::Index3(0));
  ASSERT_EQ(box.GetSize(), bricks::Index3(2048, 8, 2));
  for (int step = 0; step < 2; ++step)
  {
    for (std::size_t array = 0; array < 3; ++array)
    {
      std::vector<std::byte> values(2048 * 8 * 2, std::byte{ 77 });
      file->ReadChunk(array, step, bricks::Index3(0), values.data());
      for (std::size_t z = 0; z < 2; ++z)
      {
        const std::size_t place = (static_cast<std::size_t>(step) * 3 + array) * 3 + z;
        EXPECT_EQ(values[(z * 8 + 7) * 2048 + 5], static_cast<std::byte>(place + 1));
        EXPECT_EQ(values[(z * 8 + 7) * 2048 + 6], std::byte{ 0 });
      }
      std::byte part{ 77 };
      const bricks::Box one{ bricks::Index3(5, 7, 1), bricks::Index3(6, 8, 2) };
      EXPECT_TRUE(file->ReadPart(array, step, bricks::Index3(0), one, &part));
      EXPECT_EQ(part, values[(8 + 7) * 2048 + 5]);
    }
  }
}

/// What unpacks to more, or less, than a chunk has is damaged.
TEST(HostileZarr, ChunksThatUnpackToAnotherSizeAreRefused)
{
  const vol::ByteBuffer zeros(std::size_t(200) << 20, std::byte{ 0 });
  const std::vector<std::pair<const char*, const char*>> codecs = { { "zlib", "deflate" },
    { "zstd", "zstd" } };
  for (const auto& [name, kind] : codecs)
  {
    const vol::ChunkCodec codec({ { kind } });
    const Json compressor = { { "compressor", { { "id", name } } } };
    const fs::path bomb = Write2("bomb", compressor);
    const vol::ByteBuffer packed = codec.Encode(zeros);
    WriteBytes(bomb / "0.0.0", packed);
    ExpectRefusal(bomb, { "0.0.0", "Chunk (0, 0, 0)" });
    WriteBytes(bomb / "0.0.0", codec.Encode(vol::ByteBuffer(zeros.begin(), zeros.begin() + 9)));
    ExpectRefusal(bomb, { "0.0.0", "9 bytes instead of 256" });
    // A chunk of 4 GiB that a few bytes cannot become.
    Json huge = compressor;
    huge["chunks"] = { 1024, 1024, 1024 };
    const fs::path few = Write2("few", huge);
    WriteBytes(few / "0.0.0", codec.Encode(vol::ByteBuffer(9)));
    ExpectRefusal(few, { "0.0.0", "more than it can expand to" });
  }
  const fs::path blosc = Write2("blosc", { { "compressor", { { "id", "blosc" } } } });
  // Version, version of the format, flags, size of a value, then bytes, of a block, and as stored.
  for (const std::string& sizes : { std::string("\xff\xff\xff\x7f\x10\0\0\0\x14\0\0\0", 12),
         std::string("\0\x01\0\0\xff\xff\xff\xff\x14\0\0\0", 12),
         std::string("\0\x01\0\0\0\0\0\0\x14\0\0\0", 12) })
  {
    WriteText(blosc / "0.0.0", std::string("\x02\x01\0\0", 4) + sizes + "abcd");
    ExpectRefusal(blosc, { "0.0.0", "Blosc" });
    WriteText(blosc / "0.0.0", std::string("\x02\x01\x12\xff", 4) + sizes + "abcd");
    ExpectRefusal(blosc, { "0.0.0", "Blosc" });
  }
  EXPECT_THROW(vol::ChunkCodec({ { "shuffle", 0 } }), dsm::Error);
  EXPECT_THROW(vol::ChunkCodec(std::vector<vol::CodecStep>(33, { "crc32c" })), dsm::Error);
  std::vector<std::byte> out(3);
  const vol::ChunkCodec wide({ { "shuffle", 64 } });
  EXPECT_TRUE(wide.Decode(vol::ByteBuffer(3), 0, out.data(), out.size()));
  const vol::ChunkCodec sums({ { "fletcher32" }, { "crc32c" } });
  EXPECT_THROW(sums.Decode(vol::ByteBuffer(3), 0, out.data(), out.size()), dsm::Error);
}

/// A few bytes that say they become many, and what no such compressor writes.
TEST(HostileZarr, ChunksOfOtherCompressorsAreRefused)
{
  const std::string xz = std::string("\xfd") + "7zXZ" + std::string(1, '\0');
  // Properties, a dictionary of 4 GiB, an unknown size.
  const std::string alone = std::string("\x5d") + std::string(12, '\xff');
  const Json raw = Json::array({ { { "id", 0x21 }, { "dict_size", 0xffffffffu } } });
  const struct
  {
    const char* Name;
    Json Compressor;
    std::string Chunk;
    const char* Words;
  } cases[] = { { "lz4", { { "id", "lz4" } }, std::string(4, '\xff') + "abcd", "LZ4" },
    { "lz4short", { { "id", "lz4" } }, "abc", "LZ4" },
    { "lz4block", { { "id", "lz4" } }, std::string("\0\1\0\0\xff\xff\xff", 7), "LZ4" },
    { "bz2", { { "id", "bz2" } }, "BZh91AY&SY and so on", "bzip2" },
    { "lzma", { { "id", "lzma" } }, xz + "and so on, for some bytes", "LZMA" },
    { "alone", { { "id", "lzma" }, { "format", 2 } }, alone + "abcdefgh", "bytes to be unpacked" },
    { "raw", { { "id", "lzma" }, { "format", 3 }, { "filters", raw } }, "\x01\x7f\xff", "LZMA" } };
  for (const auto& one : cases)
  {
    SCOPED_TRACE(one.Name);
    const fs::path folder = Write2(one.Name, { { "compressor", one.Compressor } });
    WriteText(folder / "0.0.0", one.Chunk + std::string(16, 'x'));
    ExpectRefusal(folder, { "0.0.0", one.Words });
  }
}

/// They name the codec, the member, and what there is instead.
TEST(HostileZarr, ParametersOfCodecsAreChecked)
{
  const auto refuse = [](const Json& codec, std::initializer_list<const char*> words) {
    ExpectRefusal(Write2("codec", { { "filters", { codec } } }), words);
  };
  refuse({ { "id", "pcodec" } }, { "'pcodec'", "fixedscaleoffset, fletcher32", "zarr-python" });
  refuse({ { "id", "delta" }, { "dtype", "<c8" } }, { "'delta'", "'<c8'", "'dtype'" });
  refuse({ { "id", "delta" }, { "dtype", 4 } }, { "'delta'", "no text", "'dtype'" });
  refuse({ { "id", "fixedscaleoffset" }, { "scale", "10" } }, { "'fixedscaleoffset'", "'scale'" });
  refuse({ { "id", "shuffle" }, { "elementsize", 1e9 } }, { "'shuffle'", "'elementsize'" });
  refuse({ { "id", "lzma" }, { "format", 4 } }, { "'lzma'", "'format'" });
  refuse({ { "id", "lzma" }, { "format", 3 } }, { "'lzma'", "'filters'" });
  const Json unknown = Json::array({ { { "id", 77 } } });
  refuse({ { "id", "lzma" }, { "format", 3 }, { "filters", unknown } }, { "'lzma'", "'id'" });
  // Numbers of another size than the array's.
  const Json widens = { { "id", "astype" }, { "decode_dtype", "<f8" }, { "encode_dtype", "<f4" } };
  const fs::path wide = Write2("wide", { { "filters", { widens } } });
  WriteText(wide / "0.0.0", std::string(130, 'x'));
  ExpectRefusal(wide, { "0.0.0", "numbers" });
}

/// Most chunks of a large array may be nowhere.
TEST(HostileZarr, ALargeArrayWithoutChunksIsRight)
{
  const fs::path folder = Write2("large",
    { { "shape", { 32768, 32768, 32768 } }, { "chunks", { 64, 64, 64 } }, { "dtype", "|u1" } });
  EXPECT_EQ(ReadWatched(folder), "");
  const fs::path single = Write2("single",
    { { "shape", { 2097152, 2097152, 524288 } }, { "chunks", { 1, 1, 1 } }, { "dtype", "|u1" } });
  EXPECT_EQ(ReadWatched(single), "");
}

/// A folder is listed when a chunk is missing there. A chunk that is written later is read all the same.
TEST(HostileZarr, ChunksThatAreNowhereAreKnownAndMayCome)
{
  const Json sizes = { { "shape", { 8, 8, 8 } }, { "dtype", "|u1" }, { "fill_value", 7 } };
  struct Case
  {
    const char* Name;
    const char* Separator;
    const char* There;
    const char* Later;
  };
  for (const Case& one : { Case{ "flat", ".", "0.0.0", "1.1.1" },
         Case{ "nested", "/", "1/0/0", "1/1/1" }, Case{ "below", "/", "0/1/1", "1/1/1" } })
  {
    SCOPED_TRACE(one.Name);
    Json changes = sizes;
    changes["dimension_separator"] = one.Separator;
    const fs::path folder = Write2(one.Name, changes);
    const auto write = [&](const std::string& chunk)
    {
      fs::create_directories((folder / chunk).parent_path());
      WriteText(folder / chunk, std::string(64, 'x'));
    };
    write(one.There);
    const auto file = vol::OpenVolumeFile(folder);
    const bricks::Box part{ { 5, 5, 5 }, { 8, 8, 8 } };
    const bricks::Box whole{ { 0, 0, 0 }, { 8, 8, 8 } };
    const auto read = [&]
    {
      std::byte samples[64];
      file->ReadChunk(0, 0, { 1, 1, 1 }, samples);
      return std::to_integer<int>(samples[63]);
    };
    EXPECT_EQ(read(), 7);
    EXPECT_FALSE(file->IsFill(0, 0, part)) << "of a folder that was just written";
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    EXPECT_EQ(read(), 7);
    EXPECT_TRUE(file->IsFill(0, 0, part));
    EXPECT_FALSE(file->IsFill(0, 0, whole));
    EXPECT_FALSE(file->IsFill(0, 0, { { 5, 5, 5 }, { 5, 8, 8 } }));
    EXPECT_EQ(read(), 7);
    write(one.Later);
    EXPECT_EQ(read(), 'x');
    EXPECT_FALSE(file->IsFill(0, 0, part));
    fs::remove_all(folder);
    EXPECT_THROW(read(), dsm::Error);
  }
}

fs::path WriteShards(const std::string& name, const Json& shard, const Json& chunk,
  const Json& indexCodecs = { "bytes" })
{
  const Json codec = { { "name", "sharding_indexed" },
    { "configuration",
      { { "chunk_shape", chunk }, { "codecs", { "bytes" } }, { "index_codecs", indexCodecs } } } };
  return Write3(name,
    { { "codecs", { codec } },
      { "chunk_grid",
        { { "name", "regular" }, { "configuration", { { "chunk_shape", shard } } } } } });
}

TEST(HostileZarr, WrongShardsAreRefused)
{
  ExpectRefusal(
    WriteShards("many", { 1 << 20, 1 << 20, 4 }, { 1, 1, 4 }), { "shards", "too many chunks" });
  ExpectRefusal(WriteShards("apart", { 4, 4, 5 }, { 4, 4, 4 }), { "shards" });
  ExpectRefusal(WriteShards("zero", { 4, 4, 0 }, { 4, 4, 4 }), { "shards" });
  ExpectRefusal(WriteShards("flat", { 4, 4 }, { 4, 4, 4 }), { "shards" });
  ExpectRefusal(WriteShards("packed", { 4, 4, 4 }, { 4, 4, 4 }, { "bytes", "zstd" }),
    { "index", "compressed" });
  const fs::path folder = WriteShards("index", { 4, 4, 4 }, { 4, 4, 4 });
  const fs::path shard = folder / "c/0/0/0";
  fs::create_directories(shard.parent_path());
  const std::vector<std::pair<std::uint64_t, std::uint64_t>> places = {
    { ~std::uint64_t(0) - 8, 256 }, { 8, ~std::uint64_t(0) - 4 }, { 200, 256 },
    { std::uint64_t(1) << 63, std::uint64_t(1) << 63 }
  };
  for (const auto& [offset, bytes] : places)
  {
    std::string text(256, '\0');
    text.append(reinterpret_cast<const char*>(&offset), 8);
    text.append(reinterpret_cast<const char*>(&bytes), 8);
    WriteText(shard, text);
    ExpectRefusal(folder, { "c/0/0/0", "index is wrong" });
  }
  const fs::path large = WriteShards("largeindex", { 128, 128, 128 }, { 1, 1, 1 });
  fs::create_directories(large / "c/0/0");
  WriteSparse(large / "c/0/0/0", std::uintmax_t(1) << 40);
  ExpectRefusal(large, { "c/0/0/0", "bytes instead of" });
}

TEST(HostileZarr, NamesThatLeadElsewhereAreRefused)
{
  for (const char* separator : { "", "/../", "..", "\\", "0" })
  {
    const Json changes = { { "shape", { 48, 48, 48 } }, { "dimension_separator", separator } };
    ExpectRefusal(Write2("separator", changes), { "'dimension_separator'", "valid" });
    const Json encoding = { { "name", "v2" }, { "configuration", { { "separator", separator } } } };
    ExpectRefusal(Write3("encoding", { { "chunk_key_encoding", encoding } }), { "'separator'" });
  }
  for (const char* path : { "../other", "/etc", "a/../../b", "", ".." })
  {
    const fs::path folder = MakeFolder("outside");
    WriteText(folder / ".zgroup", "{}");
    WriteText(folder / ".zattrs",
      Json({ { "multiscales", { { { "datasets", { { { "path", path } } } } } } } }).dump());
    ExpectRefusal(folder, { "outside the folder" });
  }
}

TEST(HostileZarr, ALinkThatLeadsToItselfIsNamed)
{
  const fs::path folder = MakeFolder("loop");
  WriteText(folder / ".zgroup", "{}");
  fs::create_directory(folder / "a");
  WriteText(folder / "a/.zarray", GetVersion2().dump());
  fs::create_symlink("b", folder / "b");
  ExpectRefusal(folder, { "loop/b'", "symbolic links" });
  ExpectRefusal(folder / "b", { "symbolic links" });
  const fs::path chunks = Write2("loopchunk", {});
  fs::create_symlink("0.0.0", chunks / "0.0.0");
  ExpectRefusal(chunks, { "0.0.0", "symbolic links" });
}

TEST(HostileZarr, LongNamesAreRefused)
{
  const fs::path folder = MakeFolder("label");
  WriteText(folder / ".zgroup", "{}");
  fs::create_directory(folder / "0");
  WriteText(folder / "0/.zarray", GetVersion2().dump());
  const Json channel = { { "label", std::string(100000, 'a') } };
  WriteText(folder / ".zattrs",
    Json({ { "multiscales", { { { "datasets", { { { "path", "0" } } } } } } },
           { "omero", { { "channels", { channel } } } } })
      .dump());
  ExpectRefusal(folder, { "'label'", "100000 bytes" });
  const std::string type(1000000, 'a');
  ExpectRefusal(Write2("type", { { "dtype", type } }), { "'dtype'" });
  ExpectRefusal(Write2("filter", { { "compressor", { { "id", type } } } }), { "'id'" });
  ExpectRefusal(Write3("name", { { "codecs", { type } } }), { "not supported" });
  ExpectRefusal(Write3("type3", { { "data_type", type } }), { "not supported" });
}

/// None is waited for, and none is read as values.
TEST(HostileZarr, PipesFoldersAndDevicesAreRefused)
{
  for (const char* name : { ".zarray", ".zattrs", "zarr.json", "0.0.0" })
  {
    const auto prepare = [&]
    {
      const fs::path folder = Write2("pipe", {});
      fs::remove(folder / name);
      return folder;
    };
    const fs::path pipe = prepare();
    ASSERT_EQ(mkfifo((pipe / name).c_str(), 0600), 0);
    ExpectRefusal(pipe, { name, "pipe" });
    EXPECT_TRUE(vol::MayBeVolumeFile(pipe.string()) || std::string(name) == ".zarray");
    prepare();
    fs::create_directory(pipe / name);
    ExpectRefusal(pipe, { name });
    prepare();
    fs::create_symlink("/dev/zero", pipe / name);
    ExpectRefusal(pipe, { name, "device" });
  }
}

TEST(HostileZarr, PlacesThatAreNotFiniteAreRefused)
{
  const fs::path folder = MakeFolder("places");
  WriteText(folder / ".zgroup", "{}");
  fs::create_directory(folder / "0");
  WriteText(folder / "0/.zarray", GetVersion2().dump());
  const Json scale = { { "type", "scale" }, { "scale", { 1, 1e200, 1 } } };
  const auto write = [&](const Json& transformations)
  {
    WriteText(folder / ".zattrs",
      Json({ { "multiscales",
             { { { "datasets",
               { { { "path", "0" }, { "coordinateTransformations", transformations } } } } } } } })
        .dump());
  };
  write(Json::array({ scale }));
  EXPECT_EQ(ReadWatched(folder), "");
  write({ scale, scale });
  ExpectRefusal(folder, { "invalid spacing" });
  write({ 1, 2 });
  ExpectRefusal(folder, { "coordinate transformation" });
  write(Json::array({ Json{ { "type", "displacements" } } }));
  ExpectRefusal(folder, { "'displacements'", "cannot be shown" });
  Json nested = Json::array({ scale });
  for (int depth = 0; depth < 10; ++depth)
  {
    nested = Json::array({ Json{ { "type", "sequence" }, { "transformations", nested } } });
  }
  write(nested);
  ExpectRefusal(folder, { "'sequence'", "nested too deeply" });
  write(
    Json::array({ Json{ { "type", "sequence" }, { "transformations", Json::array({ scale }) } } }));
  EXPECT_EQ(ReadWatched(folder), "");
  write(scale);
  ExpectRefusal(folder, { "'coordinateTransformations' is not an array" });
  write(Json::array({ Json{ { "type", "scale" }, { "scale", { "a", 1, 1 } } } }));
  ExpectRefusal(folder, { "'scale' has 'a'", "not a finite number" });
  WriteText(folder / ".zattrs", "{\"multiscales\": [{\"datasets\": 1}]}");
  ExpectRefusal(folder, { "'datasets' is missing or not an array" });
  for (const char* text : { "[]", "1", "{\"ome\": 1}", "{\"ome\": []}", "{\"multiscales\": [1]}",
         "{\"multiscales\": [{\"datasets\": 1}]}", "{\"multiscales\": [{\"datasets\": [1]}]}",
         "{\"multiscales\": {\"a\": 1}}" })
  {
    WriteText(folder / ".zattrs", text);
    const std::string wrong = ReadWatched(folder);
    EXPECT_TRUE(wrong.empty() || wrong.find("places") != std::string::npos) << wrong;
    EXPECT_EQ(wrong.find("exception"), std::string::npos) << wrong;
  }
}

} // namespace
