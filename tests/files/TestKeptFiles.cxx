// SPDX-License-Identifier: BSD-3-Clause
// Files in the user's cache directory are used only if they are what the program kept there.
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/open/OpenVolumeFile.h"
#include "DSMVolumeFiles/range/KeptFile.h"
#include "DSMVolumeFiles/range/ValueRanges.h"

#include <gtest/gtest.h>

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace
{

namespace fs = std::filesystem;
using Bytes = std::vector<std::byte>;

class TestKeptFiles : public testing::Test
{
protected:
  TestKeptFiles()
  {
    fs::remove_all(this->Folder);
    fs::create_directories(this->Folder);
    setenv("XDG_CACHE_HOME", this->Caches.c_str(), 1);
    const fs::path raw = this->Folder / "values.raw";
    std::ofstream(raw, std::ios::binary) << std::string(8, '\1') << std::string(56, '\2');
    vol::OpenOptions options;
    options.Bare.Samples = bricks::Index3(4);
    this->File = vol::OpenVolumeFile(raw.string(), options);
  }
  ~TestKeptFiles() override { fs::remove_all(this->Folder); }

  vol::KeptFile GetKept() const { return { { this->File, 0, 0 }, this->Whole, "test1" }; }
  /// The only entry of the folder.
  fs::path FindOnly() const
  {
    const fs::directory_iterator all(this->Caches / "dsm-ray-tracer");
    EXPECT_EQ(std::distance(fs::begin(all), fs::end(all)), 1);
    return fs::directory_iterator(this->Caches / "dsm-ray-tracer")->path();
  }
  vol::ValueRanges Find() const
  {
    return *vol::FindRanges({ this->File, 0, 0 }, this->Whole, 1, [](double) { return true; });
  }

  const fs::path Folder = fs::path(DSM_TEST_FILES) / "kept";
  const fs::path Caches = Folder / "caches";
  const bricks::Box Whole{ bricks::Index3(0), bricks::Index3(4) };
  std::shared_ptr<const vol::VolumeFile> File;
};

Bytes MakeBytes(std::size_t count, int first)
{
  Bytes bytes(count);
  for (std::size_t at = 0; at < count; ++at)
  {
    bytes[at] = static_cast<std::byte>(static_cast<int>(at) * 37 + first);
  }
  return bytes;
}

void Overwrite(const fs::path& path, const Bytes& bytes)
{
  std::ofstream(path, std::ios::binary)
    .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

} // namespace

TEST_F(TestKeptFiles, WhatIsKeptIsLoaded)
{
  const Bytes bytes = MakeBytes(1001, 5);
  EXPECT_TRUE(this->GetKept().Load(bytes.size()).empty());
  this->GetKept().Keep(bytes.data(), bytes.size());
  EXPECT_EQ(this->GetKept().Load(bytes.size()), bytes);
  EXPECT_TRUE(this->GetKept().Load(bytes.size() - 1).empty());
  EXPECT_TRUE(this->GetKept().Load(bytes.size() + 1).empty());
  const Bytes others = MakeBytes(1001, 6);
  this->GetKept().Keep(others.data(), others.size());
  EXPECT_EQ(this->GetKept().Load(others.size()), others);
  this->FindOnly();
}

TEST_F(TestKeptFiles, WhatIsDamagedIsNot)
{
  const Bytes bytes = MakeBytes(300, 1);
  this->GetKept().Keep(bytes.data(), bytes.size());
  const fs::path path = this->FindOnly();
  const std::string text = vol::ReadWhole(path.string(), 1 << 20);
  Bytes whole(text.size());
  std::memcpy(whole.data(), text.data(), text.size());
  Overwrite(path, Bytes(whole.size()));
  EXPECT_TRUE(this->GetKept().Load(bytes.size()).empty());
  Overwrite(path, Bytes(whole.size(), std::byte{ 0xff }));
  EXPECT_TRUE(this->GetKept().Load(bytes.size()).empty());
  for (std::size_t at = 0; at < whole.size(); ++at)
  {
    Bytes damaged = whole;
    damaged[at] ^= std::byte{ 1 };
    Overwrite(path, damaged);
    EXPECT_TRUE(this->GetKept().Load(bytes.size()).empty()) << at;
  }
  for (const std::size_t count :
    { std::size_t(0), std::size_t(1), std::size_t(23), whole.size() / 2 })
  {
    Overwrite(path, Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(count)));
    EXPECT_TRUE(this->GetKept().Load(bytes.size()).empty()) << count;
    EXPECT_TRUE(this->GetKept().Load(count).empty()) << count;
  }
  // A whole file under the name of another one.
  const fs::path other = path.parent_path() /
    ("test1-1-" + path.filename().string().substr(path.filename().string().rfind('-') + 1));
  Overwrite(path, whole);
  EXPECT_EQ(this->GetKept().Load(bytes.size()), bytes);
  fs::rename(path, other);
  vol::KeptFile({ this->File, 0, 0 }, this->Whole, "test2").Keep(bytes.data(), bytes.size());
  for (const auto& entry : fs::directory_iterator(path.parent_path()))
  {
    if (entry.path() != other)
    {
      fs::copy_file(other, entry.path(), fs::copy_options::overwrite_existing);
    }
  }
  EXPECT_TRUE(vol::KeptFile({ this->File, 0, 0 }, this->Whole, "test2").Load(bytes.size()).empty());
}

TEST_F(TestKeptFiles, NothingIsWaitedForOrReadThatIsNoSuchFile)
{
  const Bytes bytes = MakeBytes(300, 1);
  this->GetKept().Keep(bytes.data(), bytes.size());
  const fs::path path = this->FindOnly();
  const auto begin = std::chrono::steady_clock::now();
  fs::remove(path);
  ASSERT_EQ(mkfifo(path.c_str(), 0666), 0);
  EXPECT_TRUE(this->GetKept().Load(bytes.size()).empty());
  fs::remove(path);
  fs::create_directory(path);
  EXPECT_TRUE(this->GetKept().Load(bytes.size()).empty());
  this->GetKept().Keep(bytes.data(), bytes.size());
  EXPECT_TRUE(fs::is_directory(this->FindOnly()));
  fs::remove(path);
  fs::create_symlink("/dev/zero", path);
  EXPECT_TRUE(this->GetKept().Load(bytes.size()).empty());
  fs::remove(path);
  Overwrite(path, {});
  fs::resize_file(path, std::uintmax_t(1) << 36);
  EXPECT_TRUE(this->GetKept().Load(bytes.size()).empty());
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(1));
  this->GetKept().Keep(bytes.data(), bytes.size());
  EXPECT_EQ(this->GetKept().Load(bytes.size()), bytes);
  // Without a folder nothing is kept, and no call fails.
  fs::remove_all(this->Caches);
  Overwrite(this->Caches, {});
  this->GetKept().Keep(bytes.data(), bytes.size());
  EXPECT_TRUE(this->GetKept().Load(bytes.size()).empty());
}

TEST_F(TestKeptFiles, ThreadsMayKeepTheSameAtOnce)
{
  std::vector<std::thread> threads;
  for (int number = 0; number < 8; ++number)
  {
    threads.emplace_back(
      [&, number]
      {
        for (int time = 0; time < 20; ++time)
        {
          const Bytes bytes = MakeBytes(5000, number);
          this->GetKept().Keep(bytes.data(), bytes.size());
          EXPECT_EQ(this->GetKept().Load(bytes.size()).size(), bytes.size());
        }
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  this->FindOnly();
}

/// The folder may have files of any name.
TEST_F(TestKeptFiles, BoxesOutsideOfTheArrayAreNone)
{
  const Bytes bytes = MakeBytes(8, 0);
  this->GetKept().Keep(bytes.data(), bytes.size());
  const std::string path = this->FindOnly().string();
  const std::string beginning = path.substr(0, path.rfind('-') + 1);
  for (const char* const name : { "0_0_0_4_4_5", "-1_0_0_4_4_4", "1_1_1_1_2_2", "3_0_0_2_4_4",
         "0_0_0_9223372036854775807_9223372036854775807_9223372036854775807",
         "0_0_0_99999999999999999999_4_4", "0_0_0_4_4", "", "x", "0_0_0_4_4_4_", "00_0_0_4_4_4",
         "%s%n", "\xff" })
  {
    Overwrite(beginning + name, bytes);
  }
  Overwrite(beginning + "1_2_3_4_4_4", bytes);
  const auto boxes = vol::KeptFile::FindBoxes({ this->File, 0, 0 }, "test1");
  ASSERT_EQ(boxes.size(), 2u);
  for (const bricks::Box& box : boxes)
  {
    EXPECT_TRUE(box.Min == bricks::Index3(0) || box.Min == bricks::Index3(1, 2, 3));
    EXPECT_EQ(box.Max, bricks::Index3(4));
  }
}

TEST_F(TestKeptFiles, RangesThatCannotBeAreFoundAnew)
{
  const vol::ValueRanges found = this->Find();
  EXPECT_EQ(found.All[0].Least, 1.0);
  EXPECT_EQ(found.All[0].Greatest, 2.0);
  const auto load = [&] { return vol::LoadRanges({ this->File, 0, 0 }, this->Whole, true); };
  vol::KeepRanges({ this->File, 0, 0 }, this->Whole, found);
  ASSERT_TRUE(load());
  EXPECT_EQ(load()->Finite[0].Greatest, 2.0);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const vol::ValueRange& range : { vol::ValueRange{ nan, nan }, vol::ValueRange{ nan, 2.0 },
         vol::ValueRange{ 1.0, nan }, vol::ValueRange{ 2.0, 1.0 }, vol::ValueRange{ -1.0, 2.0 },
         vol::ValueRange{ 0.0, 256.0 }, vol::ValueRange{ 0.0, HUGE_VAL } })
  {
    vol::ValueRanges ranges = found;
    ranges.All[0] = range;
    vol::KeepRanges({ this->File, 0, 0 }, this->Whole, ranges);
    EXPECT_FALSE(load()) << range.Least << " " << range.Greatest;
    ranges = found;
    ranges.Finite[0] = range;
    vol::KeepRanges({ this->File, 0, 0 }, this->Whole, ranges);
    EXPECT_FALSE(load()) << "finite " << range.Least << " " << range.Greatest;
  }
  // A file filled with zeros is no range of (0, 0).
  vol::KeepRanges({ this->File, 0, 0 }, this->Whole, found);
  const fs::path path = this->FindOnly();
  Overwrite(path, Bytes(static_cast<std::size_t>(fs::file_size(path))));
  EXPECT_FALSE(load());
}

TEST(TestValueRanges, OfFloatsMayBeInfiniteOrNone)
{
  const auto isValid = [](vol::ValueRange all, vol::ValueRange finite, bricks::ScalarType type)
  {
    vol::ValueRanges ranges(1);
    ranges.All[0] = all;
    ranges.Finite[0] = finite;
    return ranges.IsValid(type);
  };
  const vol::ValueRange none;
  for (const auto type : { bricks::ScalarType::Float32, bricks::ScalarType::Float64 })
  {
    EXPECT_TRUE(isValid(none, none, type));
    EXPECT_TRUE(isValid({ -HUGE_VAL, HUGE_VAL }, none, type));
    EXPECT_TRUE(isValid({ HUGE_VAL, HUGE_VAL }, none, type));
    EXPECT_TRUE(isValid({ -HUGE_VAL, HUGE_VAL }, { -1e30, 1.0 }, type));
    EXPECT_FALSE(isValid({ -HUGE_VAL, HUGE_VAL }, { -HUGE_VAL, 1.0 }, type));
    EXPECT_FALSE(isValid({ 0.0, 1.0 }, { 0.0, 2.0 }, type));
    EXPECT_FALSE(isValid(none, { 0.0, 2.0 }, type));
  }
  EXPECT_FALSE(isValid({ 0.0, 300.0 }, { 0.0, 30.0 }, bricks::ScalarType::UInt8));
  EXPECT_TRUE(isValid({ 0.0, 0x1p64 }, { 0.0, 0x1p64 }, bricks::ScalarType::UInt64));
  vol::ValueRanges vectors(3); // of bytes; the magnitude of three
  for (std::vector<vol::ValueRange>* const list : { &vectors.All, &vectors.Finite })
  {
    std::fill(list->begin(), list->end(), vol::ValueRange{ 0.0, 255.0 });
    list->back().Greatest = 441.7;
  }
  EXPECT_TRUE(vectors.IsValid(bricks::ScalarType::UInt8));
  vectors.All.back().Least = -1.0;
  EXPECT_FALSE(vectors.IsValid(bricks::ScalarType::UInt8));
}

/// Compressed values have a copy, which is made once, and again where it is damaged.
TEST_F(TestKeptFiles, ACopyOfUnpackedValuesIsMadeOnce)
{
  const fs::path packed = this->Folder / "packed.nrrd";
  fs::copy_file(fs::path(DSM_TEST_FILES) / "gzip.nrrd", packed);
  const auto read = [&](const std::function<bool()>& goesOn = nullptr)
  {
    vol::OpenOptions options;
    options.GoesOn = goesOn;
    const auto file = vol::OpenVolumeFile(packed.string(), options);
    const vol::FileArray& array = file->GetArrays().front();
    const bricks::Index3 chunk(0);
    Bytes bytes(
      static_cast<std::size_t>(array.Grid.GetBox(chunk).GetCount()) * array.GetSampleBytes());
    file->ReadChunk(0, 0, chunk, bytes.data());
    return bytes;
  };
  EXPECT_THROW(read([] { return false; }), dsm::Error);
  EXPECT_TRUE(fs::is_empty(this->Caches / "dsm-ray-tracer"));
  std::vector<Bytes> found(6);
  std::vector<std::thread> threads;
  for (Bytes& mine : found)
  {
    threads.emplace_back([&] { mine = read(); });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_EQ(static_cast<int>(found[0][2]), 3); // the second of 16 bits
  EXPECT_EQ(found, std::vector<Bytes>(6, found[0]));
  const fs::path copy = this->FindOnly();
  const auto made = fs::last_write_time(copy);
  const auto size = fs::file_size(copy);
  EXPECT_EQ(read(), found[0]);
  EXPECT_EQ(fs::last_write_time(copy), made);
  for (const std::uintmax_t rest : { std::uintmax_t(0), size - 1 })
  {
    fs::resize_file(copy, rest);
    fs::resize_file(copy, rest == 0 ? size : rest);
    EXPECT_EQ(read(), found[0]);
    EXPECT_EQ(this->FindOnly(), copy);
    EXPECT_EQ(fs::file_size(copy), size);
  }
  fs::last_write_time(packed, fs::last_write_time(packed) + std::chrono::seconds(1));
  EXPECT_EQ(read(), found[0]);
  const fs::directory_iterator all(this->Caches / "dsm-ray-tracer");
  EXPECT_EQ(std::distance(fs::begin(all), fs::end(all)), 2); // another file, for all that is known
  setenv("XDG_CACHE_HOME", (this->Folder / "values.raw").c_str(), 1);
  try
  {
    read();
    ADD_FAILURE();
  }
  catch (const dsm::Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("XDG_CACHE_HOME"), std::string::npos) << error.what();
  }
}
