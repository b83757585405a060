// SPDX-License-Identifier: BSD-3-Clause
// NRRD, MetaImage and bare files whose headers, names and kinds are made to mislead, or only look so.
#include "WatchedReading.h"

#include "DSMVolumeFiles/open/OpenVolumeFile.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <iterator>
#include <locale>
#include <string>
#include <tuple>

#include <sys/stat.h>

namespace
{

using namespace dsm_test;

std::string GetNrrd(const std::string& more, const std::string& sizes = "4 4 4")
{
  return "NRRD0005\ntype: uchar\ndimension: 3\nsizes: " + sizes + "\nencoding: raw\n" + more;
}

std::string GetMeta(const std::string& more, const std::string& size = "4 4 4")
{
  return "NDims = 3\nDimSize = " + size + "\nElementType = MET_UCHAR\n" + more;
}

const std::string Local = "ElementDataFile = LOCAL\n";
const std::string Values(64, 'v');

fs::path WriteNrrd(
  const std::string& name, const std::string& more, const std::string& sizes = "4 4 4")
{
  const fs::path path = MakeFolder(name) / (name + ".nrrd");
  WriteText(path, GetNrrd(more + "\n\n", sizes) + Values);
  return path;
}

fs::path WriteMeta(
  const std::string& name, const std::string& more, const std::string& size = "4 4 4")
{
  const fs::path path = MakeFolder(name) / (name + ".mha");
  WriteText(path, GetMeta(more + "\n" + Local, size) + Values);
  return path;
}

TEST(HostileHeaders, AHeaderWithoutAnEndIsRefused)
{
  const fs::path folder = MakeFolder("endless");
  for (const char* name : { "long.mha", "long.nrrd", "short.nrrd" })
  {
    const fs::path path = folder / name;
    WriteText(path, path.extension() == ".mha" ? "NDims = 3\n" : "NRRD0005\ntype: float\n");
    fs::resize_file(path, std::string(name) == "short.nrrd" ? 100 : std::uintmax_t(3) << 30);
    ExpectRefusal(path, { std::string(name) == "short.nrrd" ? "encoding" : "does not end within" });
  }
  // Many short lines, and one long one.
  std::string lines;
  for (int line = 0; line < 400000; ++line)
  {
    lines += std::to_string(line) + ":a\n";
  }
  ExpectRefusal(WriteNrrd("lines", lines), { "does not end within" });
  ExpectRefusal(WriteMeta("lines", lines), { "does not end within" });
  ExpectRefusal(WriteNrrd("comment", "# " + std::string(2 << 20, 'a')), { "does not end within" });
  lines.resize(900000);
  EXPECT_EQ(ReadWatched(WriteNrrd("lines", lines)), "");
  EXPECT_EQ(ReadWatched(WriteMeta("lines", lines)), "");
}

TEST(HostileHeaders, AFieldWithManyWordsIsRefused)
{
  std::string numbers;
  std::string vectors;
  std::string nones;
  for (int place = 0; place < 100000; ++place)
  {
    numbers += "1 ";
    vectors += "(1,0,0)";
    nones += "none ";
  }
  ExpectRefusal(WriteNrrd("many", "", numbers), { "'sizes'", "100000 numbers" });
  ExpectRefusal(WriteMeta("many", "", numbers), { "'dimsize'", "100000 numbers" });
  ExpectRefusal(WriteNrrd("many", "space directions: " + vectors), { "vectors" });
  ExpectRefusal(WriteNrrd("many", "space directions: " + nones), { "vectors" });
  ExpectRefusal(WriteNrrd("many", "spacings: " + numbers), { "'spacings'", "100000 numbers" });
  EXPECT_EQ(ReadWatched(WriteNrrd("many", "kinds: " + nones + "\ncenters: " + nones)), "");
  const std::string name(100000, 'a');
  ExpectRefusal(WriteNrrd("name", "content: " + name), { "100000 bytes of an array's name" });
  ExpectRefusal(WriteNrrd("name", "data file: " + name), { "'data file'" });
  ExpectRefusal(WriteNrrd("name", "encoding: " + name), { "encoding" });
  ExpectRefusal(WriteNrrd("name", "type: " + name), { "type" });
}

TEST(HostileHeaders, WhatCannotBeToldApartIsRefused)
{
  for (const char* sizes : { "12 4 4 10", "8 4 4 3" })
  {
    ExpectRefusal(WriteNrrd("four", "", sizes), { sizes, "kinds: domain domain domain vector" });
  }
  const fs::path path = MakeFolder("classic") / "old.nc";
  WriteText(path, "CDF\x01" + std::string(200, '\0'));
  ExpectRefusal(path, { "netCDF-3", "nccopy -k nc4" });
}

TEST(HostileHeaders, NumbersOutOfRangeAreRefused)
{
  for (const char* number : { "1e300", "nan", "4.7", "1e19", "-1e300", "inf", "0x4", "4," })
  {
    const std::string sizes = "4 4 " + std::string(number);
    ExpectRefusal(WriteNrrd("numbers", "", sizes), {});
    ExpectRefusal(WriteMeta("numbers", "", sizes), {});
  }
  ExpectRefusal(WriteNrrd("numbers", "", "4 4 1e999"), { "1e999", "double precision" });
  ExpectRefusal(WriteNrrd("numbers", "", "4 4 4.7"), { "'sizes'", "integers" });
  ExpectRefusal(WriteNrrd("numbers", "", "4 4 -4"), { "4 x 4 x -4 samples" });
  ExpectRefusal(WriteMeta("numbers", "", "4 4 0"), { "4 x 4 x 0 samples" });
  ExpectRefusal(WriteNrrd("numbers", "", "2147483647 2147483647 2147483647"), { "samples" });
  ExpectRefusal(WriteNrrd("numbers", "", "4294967296 1 1"), { "samples" });
  const std::string kinds = "kinds: vector domain domain domain";
  ExpectRefusal(WriteNrrd("numbers", kinds, "2147483647 4 4 4"), { "2147483647 components" });
  ExpectRefusal(WriteNrrd("numbers", kinds, "4294967297 4 4 4"), { "components" });
  for (const char* skip : { "-2", "1e300", "9007199254740992", "4.5", "-9e18" })
  {
    ExpectRefusal(WriteNrrd("skip", "byte skip: " + std::string(skip)), {});
    ExpectRefusal(WriteMeta("skip", "HeaderSize = " + std::string(skip)), {});
  }
  for (const char* count : { "0", "-1", "1e300", "4294967297", "2147483647", "65537" })
  {
    ExpectRefusal(WriteMeta("channels", "ElementNumberOfChannels = " + std::string(count)), {});
  }
  vol::OpenOptions bare;
  bare.Bare.Samples = bricks::Index3(4);
  bare.Bare.HeaderBytes = ~std::uint64_t(0);
  const fs::path raw = MakeFolder("bare") / "bare.raw";
  WriteText(raw, Values);
  ExpectRefusal(raw, { "header are expected" }, bare);
  bare.Bare.HeaderBytes = 0;
  EXPECT_EQ(ReadWatched(raw, bare), "");
  bare.Bare.Samples = bricks::Index3(0x7fffffff);
  ExpectRefusal(raw, { "samples" }, bare);
  bare.Bare.Samples = bricks::Index3(-1, -1, 4);
  ExpectRefusal(raw, { "Raw Dimensions" }, bare);
}

TEST(HostileHeaders, AxesInOnePlaneAreRefused)
{
  for (const char* rows : { "1 0 0 0 1 0 1 1 0", "0 0 0 0 0 0 0 0 0", "1 0 0 1 0 0 0 0 1",
         "1e-200 0 0 1e-200 0 0 0 0 1" })
  {
    ExpectRefusal(
      WriteMeta("plane", "TransformMatrix = " + std::string(rows)), { "invalid direction matrix" });
  }
  for (const char* vectors :
    { "(1,0,0) (0,1,0) (1,1,0)", "(1,0,0) (0,0,0) (0,0,1)", "(nan,0,0) (0,1,0) (0,0,1)" })
  {
    ExpectRefusal(
      WriteNrrd("plane", "space directions: " + std::string(vectors)), { "invalid direction" });
  }
  ExpectRefusal(WriteNrrd("far", "space directions: (inf,0,0) (0,1,0) (0,0,1)"), { "invalid" });
  ExpectRefusal(WriteNrrd("far", "space origin: (nan,0,0)"), { "invalid origin" });
  ExpectRefusal(WriteMeta("far", "Offset = 0 inf 0"), { "invalid origin" });
  ExpectRefusal(WriteMeta("far", "ElementSpacing = 1 nan 1"), { "invalid spacing" });
  ExpectRefusal(WriteMeta("far", "TransformMatrix = 1 0 0 0 nan 0 0 0 1"), { "invalid direction" });
  // What is only sheared, small, or mirrored has an inverse.
  EXPECT_EQ(ReadWatched(WriteNrrd("sheared", "space directions: (1,0,0) (0,-1e-9,0) (1,0,1)")), "");
  EXPECT_EQ(ReadWatched(WriteMeta("sheared", "TransformMatrix = 1 0 0 0.9 0.1 0 0 0 -1")), "");
}

/// Reads numbers under a locale with decimal commas, of the C library and of iostreams.
void ReadWithCommas(const fs::path& locales)
{
  setenv("LOCPATH", locales.c_str(), 1);
  const bool hasLocale = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
  struct Commas : std::numpunct<char>
  {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  std::locale::global(
    std::locale(hasLocale ? std::locale("de_DE.UTF-8") : std::locale(), new Commas));
  const fs::path nrrd = WriteNrrd("half", "spacings: 0.5 +0.5 5e-1");
  const fs::path meta = WriteMeta("halfmeta", "ElementSpacing = 0.5 0.5 0.5");
  for (const fs::path& path : { nrrd, meta })
  {
    EXPECT_EQ(ReadWatched(path), "");
    EXPECT_EQ(vol::OpenVolumeFile(path.string())->GetGeometry().Spacing[1], 0.5);
  }
  ExpectRefusal(WriteNrrd("comma", "spacings: 0,5 0,5 0,5"), { "'0,5'", "not a number" });
}

/// Programs set the locale for their own texts.
TEST(HostileHeaders, NumbersDoNotDependOnTheLocale)
{
  const fs::path locales = MakeFolder("locale");
  const std::string make =
    "localedef -i de_DE -f UTF-8 '" + (locales / "de_DE.UTF-8").string() + "' > /dev/null 2>&1";
  const int outcome = std::system(make.c_str()); // not 0 where it only warns
  if (!fs::exists(locales / "de_DE.UTF-8"))
  {
    std::cout << "localedef returns " << outcome << ": only the locale of iostreams has commas.\n";
  }
  // The locale belongs to the whole process.
  EXPECT_EXIT(
    {
      ReadWithCommas(locales);
      std::_Exit(HasFailure() ? 1 : 0);
    },
    testing::ExitedWithCode(0), "");
}

/// Only a pattern with its numbers means several files, and only where no file is called so.
TEST(HostileHeaders, NamesWithPercentSignsWork)
{
  const fs::path folder = MakeFolder("percent");
  for (const char* name : { "a%b.raw", "ethanol 70%.raw", "100%d.raw", "%41.raw", "5%s",
         "%03d 1 2 1", "LIST", "b\xe9ta.raw", "LIST of things.raw" })
  {
    WriteText(folder / name, Values);
    const fs::path meta = folder / (std::string(name) + ".mhd");
    WriteText(meta, GetMeta("ElementDataFile = " + std::string(name) + "\n"));
    EXPECT_EQ(ReadWatched(meta), "");
    const fs::path nrrd = folder / (std::string(name) + ".nhdr");
    WriteText(nrrd, GetNrrd("data file: " + std::string(name) + "\n"));
    EXPECT_EQ(ReadWatched(nrrd), "");
  }
  const fs::path lost = folder / "lost.mhd";
  WriteText(lost, GetMeta("ElementDataFile = 50%.raw\n"));
  EXPECT_NE(ReadWatched(lost).find("50%.raw"), std::string::npos);
}

/// One that is missing or too short is named, and so are lists and numbers that do not fit the sizes.
TEST(HostileHeaders, SeveralFilesAreChecked)
{
  const fs::path folder = MakeFolder("several");
  const auto meta = [&](const std::string& place)
  {
    WriteText(folder / "a.mhd", GetMeta("ElementDataFile = " + place + "\n"));
    return folder / "a.mhd";
  };
  const auto nrrd = [&](const std::string& place)
  {
    WriteText(folder / "a.nhdr", GetNrrd("data file: " + place + "\n"));
    return folder / "a.nhdr";
  };
  for (int number = 1; number <= 4; ++number)
  {
    WriteText(folder / ("s" + std::to_string(number)), Values.substr(0, 16));
  }
  for (const auto& open : { std::function<fs::path(const std::string&)>(meta), { nrrd } })
  {
    for (const char* right : { "s%d 1 4 1", "s%d 1 4", "s%d 4 1 -1", "LIST\ns1\ns2\ns3\ns4",
           "LIST 2\ns1\ns2\ns3\n s4 \n", "LIST 3\ns1\ns2\ns3\ns4", "s%1d 1 4 1 2" })
    {
      EXPECT_EQ(ReadWatched(open(right)), "") << right;
    }
    for (const char* wrong : { "s%d 1 3 1", "s%d 1 5 1", "s%d 1 4 2", "LIST\ns1\ns2\ns3", "LIST",
           "LIST 1\ns1\ns2\ns3\ns4", "LIST 3\ns1\ns2\ns3" })
    {
      ExpectRefusal(open(wrong), { "files instead of" });
    }
    ExpectRefusal(open("s%d 1 4 0"), { "its numbers do not lead" });
    ExpectRefusal(open("s%d 1 4 -1"), { "its numbers do not lead" });
    ExpectRefusal(open("s%d 0 2000000000 1"), { "files of values" });
    ExpectRefusal(open("s%d 1 4 1 4"), { "4 axes of 3" });
    ExpectRefusal(open("LIST 0\ns1"), { "0 axes of 3" });
    EXPECT_NE(ReadWatched(open("s%d 2 5 1")).find("several/s5'"), std::string::npos);
    EXPECT_NE(ReadWatched(open("s%900d 1 4 1")).find(" 1' cannot"), std::string::npos);
    EXPECT_NE(ReadWatched(open("s%s 1 4 1")).find("s%s 1 4 1'"), std::string::npos);
    EXPECT_NE(ReadWatched(open("s%d%d 1 4 1")).find("s%d%d 1 4 1'"), std::string::npos);
    WriteText(folder / "s3", Values.substr(0, 15));
    const std::string text = ReadWatched(open("s%d 1 4 1"));
    EXPECT_NE(text.find("several/s3' has 15 bytes, but 16"), std::string::npos) << text;
    WriteText(folder / "s3", Values.substr(0, 16));
  }
  std::string many = "LIST";
  for (int number = 0; number < 70000; ++number)
  {
    many += "\ns1";
  }
  ExpectRefusal(meta(many), { "files of values" });
  ExpectRefusal(nrrd(many), { "files of values" });
}

/// Headers of one size, and compressed values of another one.
TEST(HostileHeaders, CompressedValuesOfAnotherSizeAreRefused)
{
  const fs::path folder = MakeFolder("packed");
  const auto write = [&](const std::string& packed, const std::string& sizes, const char* more = "")
  {
    const bool isBzip2 = fs::path(packed).extension() == ".bz2";
    const fs::path path = folder / "a.nhdr";
    WriteText(path,
      "NRRD0005\ntype: uchar\ndimension: 3\nsizes: " + sizes + "\nencoding: " +
        (isBzip2 ? "bzip2" : "gzip") + "\n" + more + "data file: " + packed + "\n");
    return path;
  };
  for (const char* name : { "zeros.gz", "zeros.bz2" })
  {
    const std::string file = name;
    fs::copy_file(fs::path(DSM_TEST_FILES) / name, folder / name);
    const auto refused = [&](const fs::path& path) { return ReadWatched(path); };
    // 256 KiB of zeros, in a few bytes.
    EXPECT_EQ(refused(write(file, "64 64 64")), "");
    EXPECT_EQ(refused(write(file, "4 4 4", "byte skip: -1\n")), "");
    EXPECT_EQ(refused(write(file, "64 64 63", "byte skip: 4096\n")), "");
    for (const auto& [sizes, more, words] :
      { std::tuple("64 64 63", "", "more than the 258048"), std::tuple("4 4 4", "", "more than"),
        std::tuple("64 64 64", "byte skip: 1\n", "262144 bytes instead of the 262145"),
        std::tuple("64 64 65", "byte skip: -1\n", "262144 bytes instead of the 266240"),
        std::tuple("64 64 64", "byte skip: 9000000000000000\n", "262144 bytes instead of"),
        std::tuple("1000000 1000000 1000000", "", name) })
    {
      const std::string text = refused(write(file, sizes, more));
      EXPECT_NE(text.find(words), std::string::npos) << text;
      EXPECT_NE(text.find(folder.string()), std::string::npos) << text;
    }
    // What ends early, or in other bytes.
    std::ifstream in(folder / name, std::ios::binary);
    const std::string whole((std::istreambuf_iterator<char>(in)), {});
    for (std::size_t bytes = 0; bytes < whole.size(); bytes += bytes < 30 ? 1 : 99)
    {
      WriteText(folder / ("cut-" + file), whole.substr(0, bytes));
      const std::string text = refused(write("cut-" + file, "64 64 64"));
      EXPECT_NE(text.find("cut-" + file), std::string::npos) << bytes << text;
      std::string other = whole;
      other[bytes] = static_cast<char>(other[bytes] ^ 0x55);
      WriteText(folder / ("cut-" + file), other);
      refused(write("cut-" + file, "64 64 64")); // names and times in a gzip header do not count
    }
    WriteText(folder / ("cut-" + file), whole + "trailing bytes unused.");
    EXPECT_EQ(refused(write("cut-" + file, "64 64 64")), "");
    EXPECT_NE(refused(write("cut-" + file, "64 64 65")).find("cut-" + file), std::string::npos);
  }
  // As many bytes as could be that large, on the disk as well.
  WriteSparse(folder / "huge.bz2", std::uintmax_t(1) << 30);
  EXPECT_NE(
    ReadWatched(write("huge.bz2", "1000000 1000000 1000")).find("MiB free"), std::string::npos);
  const fs::path meta = folder / "a.mhd";
  WriteText(meta,
    GetMeta("CompressedData = True\nCompressedDataSize = 99999\nElementDataFile = zeros.gz\n"));
  EXPECT_NE(ReadWatched(meta).find("99999 of compressed values"), std::string::npos);
  WriteText(meta, GetMeta("CompressedData = True\nHeaderSize = -1\nElementDataFile = zeros.gz\n"));
  ExpectRefusal(meta, { "CompressedDataSize" });
}

/// Names are bytes.
TEST(HostileHeaders, NamesThatAreNotUtf8Work)
{
  const fs::path folder = MakeFolder("b\xe9ta");
  WriteText(folder / "b\xe9ta.nrrd", GetNrrd("\n") + Values);
  EXPECT_EQ(ReadWatched(folder / "b\xe9ta.nrrd"), "");
  WriteText(folder / "b\xe9ta.mha", GetMeta(Local) + Values);
  EXPECT_EQ(ReadWatched(folder / "b\xe9ta.mha"), "");
  WriteText(folder / "b\xe9ta.raw", Values);
  vol::OpenOptions bare;
  bare.Bare.Samples = bricks::Index3(4);
  EXPECT_EQ(ReadWatched(folder / "b\xe9ta.raw", bare), "");
  WriteText(folder / ".zarray",
    R"({"zarr_format": 2, "shape": [4, 4, 4], "chunks": [4, 4, 4], "dtype": "|u1",
    "fill_value": 0, "order": "C", "filters": null, "compressor": null})");
  EXPECT_EQ(ReadWatched(folder), "");
  WriteText(folder / ".zattrs", "{\"b\xe9ta\": 1}");
  ExpectRefusal(folder, { ".zattrs", "JSON" });
}

TEST(HostileHeaders, PipesFoldersAndDevicesAreRefused)
{
  const fs::path folder = MakeFolder("pipes");
  for (const char* name :
    { "a.nrrd", "a.mha", "a.mhd", "a.raw", "a.h5", "a.vtkhdf", "a.zarr", "a" })
  {
    const fs::path path = folder / name;
    ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
    ExpectRefusal(path, { "pipe" });
    EXPECT_FALSE(vol::MayBeVolumeFile(path.string()));
    EXPECT_FALSE(vol::IsBareFile(path.string()));
    fs::remove(path);
    fs::create_symlink("/dev/zero", path);
    ExpectRefusal(path, { "device" });
    EXPECT_FALSE(vol::MayBeVolumeFile(path.string()));
    fs::remove(path);
    fs::create_directory(path);
    ExpectRefusal(path, {});
    EXPECT_FALSE(vol::MayBeVolumeFile(path.string()));
  }
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", folder / "device");
  fs::create_directory(folder / "folder");
  for (const char* values : { "pipe", "device", "folder", "none" })
  {
    const fs::path meta = folder / "values.mhd";
    WriteText(meta, GetMeta("ElementDataFile = " + std::string(values) + "\n"));
    EXPECT_NE(ReadWatched(meta).find((folder / values).string()), std::string::npos);
    const fs::path nrrd = folder / "values.nhdr";
    WriteText(nrrd, GetNrrd("data file: " + std::string(values) + "\n"));
    EXPECT_NE(ReadWatched(nrrd).find((folder / values).string()), std::string::npos);
  }
}

/// Samples of many components are in chunks of few of them.
TEST(HostileHeaders, ChunksOfManyComponentsStaySmall)
{
  const fs::path path = MakeFolder("wide") / "wide.mha";
  WriteText(path, GetMeta("ElementNumberOfChannels = 65536\n" + Local, "64 64 64"));
  fs::resize_file(path, fs::file_size(path) + (std::uintmax_t(1) << 34));
  EXPECT_EQ(ReadWatched(path), "");
}

} // namespace
