// SPDX-License-Identifier: BSD-3-Clause
// Files that other programs wrote (make_files.py): every value, in every format.
#include "VolumeManifest.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/cache/ChunkCache.h"
#include "DSMVolumeFiles/open/SeriesFile.h"
#include "DSMVolumeFiles/range/ValueRanges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace
{

using namespace dsm_test;

/// What make_files.py says.
double GetExpected(
  const Json& entry, const Json& array, int step, const bricks::Index3& sample, int component)
{
  if (entry.contains("zeros"))
  {
    return 0.0;
  }
  for (int axis = 0; entry.contains("fill") && axis < 3; ++axis)
  {
    if (sample[axis] >= entry["filled"][axis].get<std::int64_t>())
    {
      return entry["fill"];
    }
  }
  const bricks::Index3 at = sample * entry.value("stride", std::int64_t(1));
  const std::int64_t channel = array["channel"];
  step = array["still"] ? 0 : step;
  const auto number = static_cast<double>(
    (3 * at.x + 5 * at.y + 7 * at.z + component + 11 * channel + 13 * step) % 101);
  if (!entry.contains("packing"))
  {
    return number;
  }
  const Json& packing = entry["packing"];
  const std::vector<double> missing = packing["missing"];
  return std::count(missing.begin(), missing.end(), number) > 0
    ? std::nan("")
    : packing["scale"].get<double>() * number + packing["offset"].get<double>();
}

int CountWrong(const std::shared_ptr<const vol::VolumeFile>& file, const Json& entry,
  std::size_t number, int step, const bricks::Box& box, vol::ChunkCache& cache,
  bool scattered = false)
{
  const vol::FileArray& array = file->GetArrays()[number];
  std::vector<std::byte> bytes(static_cast<std::size_t>(box.GetCount()) * array.GetSampleBytes());
  scattered ? cache.ReadScattered({ file, number, step }, box, bytes.data())
            : cache.ReadBox({ file, number, step }, box, bytes.data());
  return bricks::Dispatch(array.Type,
    [&](auto zero)
    {
      using T = decltype(zero);
      int wrong = 0;
      std::size_t at = 0;
      for (std::int64_t z = box.Min.z; z < box.Max.z; ++z)
      {
        for (std::int64_t y = box.Min.y; y < box.Max.y; ++y)
        {
          for (std::int64_t x = box.Min.x; x < box.Max.x; ++x)
          {
            for (int component = 0; component < array.Components; ++component)
            {
              T value;
              std::memcpy(&value, bytes.data() + at, sizeof(T));
              at += sizeof(T);
              const double expected =
                GetExpected(entry, entry["arrays"][number], step, { x, y, z }, component);
              const bool areMissing =
                std::isnan(expected) && std::isnan(static_cast<double>(value));
              wrong += !areMissing && static_cast<double>(value) != expected;
            }
          }
        }
      }
      return wrong;
    });
}

void ExpectGeometry(const vol::VolumeFile& file, const Json& entry)
{
  const vol::FileGeometry& geometry = file.GetGeometry();
  for (int axis = 0; axis < 3; ++axis)
  {
    EXPECT_EQ(geometry.Points[axis], entry["size"][axis].get<std::int64_t>());
    EXPECT_EQ(geometry.First[axis], entry.value("first", Json({ 0, 0, 0 }))[axis]);
    EXPECT_DOUBLE_EQ(geometry.Origin[axis], entry.value("origin", Json({ 0.0, 0.0, 0.0 }))[axis]);
    EXPECT_DOUBLE_EQ(geometry.Spacing[axis], entry.value("spacing", Json({ 1.0, 1.0, 1.0 }))[axis]);
    const std::vector<double> none;
    EXPECT_EQ(file.GetCoordinates()[static_cast<std::size_t>(axis)],
      entry.contains("coordinates") ? entry["coordinates"][axis].get<std::vector<double>>() : none);
  }
  for (int element = 0; element < 9; ++element)
  {
    const double none = element % 4 == 0 ? 1.0 : 0.0;
    EXPECT_DOUBLE_EQ(geometry.Direction[element],
      entry.contains("direction") ? entry["direction"][element].get<double>() : none);
  }
}

/// One warning for each of the words.
void ExpectWarnings(const std::vector<std::string>& warnings, const Json& entry)
{
  const Json words = entry.value("warnings", Json::array());
  EXPECT_EQ(warnings.size(), words.size()) << testing::PrintToString(warnings);
  for (std::size_t number = 0; number < std::min(warnings.size(), words.size()); ++number)
  {
    EXPECT_NE(warnings[number].find(words[number].get<std::string>()), std::string::npos)
      << warnings[number];
  }
}

TEST(VolumeFiles, HaveTheValuesThatOtherProgramsWrote)
{
  const Json manifest = ReadManifest();
  ASSERT_GT(manifest.size(), 35u);
  for (const Json& entry : manifest)
  {
    SCOPED_TRACE(entry.at("file").get<std::string>());
    try
    {
      const auto file = Open(entry);
      ExpectGeometry(*file, entry);
      ExpectWarnings(file->GetWarnings(), entry);
      EXPECT_EQ(file->GetSteps(), entry["steps"]);
      for (int step = 0; entry.contains("times") && step < file->GetSteps(); ++step)
      {
        EXPECT_EQ(file->GetTime(step), entry["times"][step]);
      }
      EXPECT_EQ(file->GetLevels(), entry.value("levels", 1));
      ASSERT_EQ(file->GetArrays().size(), entry["arrays"].size());
      // One chunk at a time, so that all are evicted, and one that has everything.
      for (const std::size_t cacheBytes : { std::size_t(1), std::size_t(1) << 20 })
      {
        vol::ChunkCache cache(cacheBytes);
        for (std::size_t number = 0; number < file->GetArrays().size(); ++number)
        {
          const vol::FileArray& array = file->GetArrays()[number];
          const Json& expected = entry["arrays"][number];
          EXPECT_EQ(array.Name, expected["name"]);
          EXPECT_EQ(array.Type, ToType(expected["type"]));
          EXPECT_EQ(array.Components, expected["components"]);
          EXPECT_EQ(array.OnCells, expected["cells"]);
          for (int step = 0; step < file->GetSteps(); ++step)
          {
            const bricks::Box whole{ bricks::Index3(0), array.Grid.Samples };
            EXPECT_EQ(CountWrong(file, entry, number, step, whole, cache), 0) << array.Name;
            const bricks::Box part{ whole.Max / bricks::Index3(3), whole.Max - bricks::Index3(1) };
            vol::ChunkCache cold(cacheBytes);
            EXPECT_EQ(CountWrong(file, entry, number, step, part, cold, true), 0) << array.Name;
            EXPECT_EQ(CountWrong(file, entry, number, step, part, cache), 0) << array.Name;
          }
        }
        EXPECT_LE(cache.GetBytes(), cacheBytes);
      }
    }
    catch (const dsm::Error& error)
    {
      ADD_FAILURE() << error.what();
    }
  }
}

/// Slices, all values in one piece, and cubes: nobody has to hold a whole one for a brick.
TEST(VolumeFiles, LargeChunksThatAreNotCompressedAreShownInParts)
{
  std::mt19937 random(5);
  for (const char* name : { "slices.h5", "slices.zarr", "whole.h5", "cubes.h5", "big_endian.h5" })
  {
    SCOPED_TRACE(name);
    const auto file = vol::OpenVolumeFile((GetFolder() / "large" / name).string(), {});
    const vol::FileArray& array = file->GetArrays().front();
    const bricks::Index3 samples = array.Grid.Samples;
    const std::size_t width = array.GetSampleBytes();
    EXPECT_LE(array.Grid.CountBytesOfChunks(33, width), std::uint64_t(10) << 20);
    const bool isOfSlices = samples.z == 20;
    const auto getExpected = [&](const bricks::Index3& at)
    {
      const bool isThere = !isOfSlices || at.z == 3 || at.z == 8;
      return isThere ? (3 * at.x + 5 * at.y + 77 * at.z) % 101 : 0;
    };
    vol::ChunkCache cache(1 << 20);
    for (int round = 0; round < 60; ++round)
    {
      bricks::Box box;
      for (int axis = 0; axis < 3; ++axis)
      {
        box.Min[axis] = static_cast<std::int64_t>(random()) % samples[axis];
        box.Max[axis] = std::min<std::int64_t>(samples[axis], box.Min[axis] + 1 + random() % 40);
      }
      std::vector<std::uint8_t> read(static_cast<std::size_t>(box.GetCount()) * width);
      auto* const bytes = reinterpret_cast<std::byte*>(read.data());
      round % 2 == 0 ? cache.ReadBox({ file, 0, 0 }, box, bytes)
                     : cache.ReadScattered({ file, 0, 0 }, box, bytes);
      std::size_t next = 0;
      int wrong = 0;
      for (std::int64_t z = box.Min.z; z < box.Max.z; ++z)
      {
        for (std::int64_t y = box.Min.y; y < box.Max.y; ++y)
        {
          for (std::int64_t x = box.Min.x; x < box.Max.x; ++x)
          {
            wrong += read[next] != getExpected({ x, y, z });
            next += width; // the lowest byte is the first one
          }
        }
      }
      EXPECT_EQ(wrong, 0);
    }
  }
}

/// Of a file that is not opened with these options: why.
void ExpectRefusal(const char* name, const vol::OpenOptions& options, const std::string& words)
{
  try
  {
    vol::OpenVolumeFile((GetFolder() / name).string(), options);
    ADD_FAILURE() << name;
  }
  catch (const dsm::Error& error)
  {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

TEST(VolumeFiles, ALevelThatIsNotThereIsRefused)
{
  vol::OpenOptions options;
  options.Level = 3;
  for (const char* name : { "ball.mha", "calm_000.nhdr", "ball.h5", "ball.zarr" })
  {
    ExpectRefusal(name, options, "level 3");
  }
}

TEST(VolumeFiles, ADatasetIsChosenOnlyWhereThereAreDatasets)
{
  vol::OpenOptions options;
  options.Dataset = "f";
  for (const char* name : { "ball.mha", "calm_000.nhdr", "image.vtkhdf" })
  {
    ExpectRefusal(name, options, "choosing a dataset ('f')");
  }
  ExpectRefusal("plate.zarr", options, "no dataset 'f'. Valid datasets: 'A/1/0', 'A/1/1'.");
  ExpectRefusal("several.zarr", options, "Valid datasets: 'near', 'multiscales/1', ");
  EXPECT_EQ(
    vol::OpenVolumeFile((GetFolder() / "ball.h5").string(), options)->GetArrays().size(), 1u);
  ExpectRefusal("deflate.h5", options, "no dataset 'f'. Valid datasets: 'deep/er/f', 'other'.");
}

/// The largest one counts, not the first by name.
TEST(VolumeFiles, AxesWithoutAMeaningAreNamed)
{
  ExpectRefusal("five.h5", {}, "dims[0].label = 'time'");
  ExpectRefusal("five.h5", {}, "'data' (2 x 3 x 10 x 13 x 21) and 1 more.");
  ExpectRefusal("letters.h5", {}, "'v' (10 x 13 x 21; 'x', 'y', 'x')");
}

/// Positions that are not evenly spaced move, too.
TEST(VolumeFiles, AnOriginIsThatOfTheFirstSample)
{
  const std::string path = (GetFolder() / "uneven.nc").string();
  const std::vector<double> before = vol::OpenVolumeFile(path)->GetCoordinates()[2];
  vol::OpenOptions options;
  options.Origin = { 1.0, 2.0, 3.0 };
  const auto moved = vol::OpenVolumeFile(path, options);
  EXPECT_EQ(moved->GetGeometry().Origin[0], 1.0);
  ASSERT_EQ(moved->GetCoordinates()[2].size(), before.size());
  for (std::size_t index = 0; index < before.size(); ++index)
  {
    EXPECT_DOUBLE_EQ(moved->GetCoordinates()[2][index], 3.0 + before[index] - before.front());
  }
}

/// Unless a state has the name that it had before.
TEST(VolumeFiles, AnArrayWithoutANameIsCalledAsItsFileIs)
{
  vol::OpenOptions options;
  const auto getName = [&](const std::vector<std::string>& names)
  {
    std::vector<std::string> paths;
    for (const std::string& name : names)
    {
      paths.push_back((GetFolder() / name).string());
    }
    return vol::OpenVolumeSeries(paths, options)->GetArrays().front().Name;
  };
  EXPECT_EQ(getName({ "ball.mha" }), "ball");
  EXPECT_EQ(getName({ "play_001.nhdr" }), "play_001");
  EXPECT_EQ(getName({ "play_001.nhdr", "play_002.nhdr" }), "play");
  EXPECT_EQ(getName({ "container.zarr" }), "container");
  options.ArrayName = "values";
  EXPECT_EQ(getName({ "play_001.nhdr", "play_002.nhdr" }), "values");
}

TEST(VolumeFiles, AChunkThatManyThreadsWantIsReadOnce)
{
  const Json entry = FindEntry("deflate.h5");
  ASSERT_FALSE(entry.is_null());
  const auto file = Open(entry);
  vol::ChunkCache cache(1 << 20);
  const bricks::Box whole{ bricks::Index3(0), file->GetArrays()[0].Grid.Samples };
  std::vector<std::thread> threads;
  std::vector<int> wrong(8, -1);
  for (int& mine : wrong)
  {
    threads.emplace_back([&] { mine = CountWrong(file, entry, 0, 0, whole, cache); });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_EQ(wrong, std::vector<int>(8, 0));
  EXPECT_EQ(cache.GetBytesRead(),
    static_cast<std::uint64_t>(whole.GetCount()) * file->GetArrays()[0].GetSampleBytes());
}

TEST(VolumeFiles, RangesAreFoundAndKept)
{
  const fs::path caches = GetFolder() / "caches";
  fs::remove_all(caches);
  setenv("XDG_CACHE_HOME", caches.c_str(), 1);
  const Json entry = FindEntry("vectors.h5");
  const auto file = Open(entry);
  const bricks::Box whole{ bricks::Index3(0), file->GetArrays()[1].Grid.Samples };
  const bricks::Box corner{ bricks::Index3(0), bricks::Index3(2, 1, 1) };
  EXPECT_FALSE(vol::LoadRanges({ file, 1, 0 }, whole, true));
  const auto found = vol::FindRanges({ file, 1, 0 }, whole, 3, [](double) { return true; });
  ASSERT_TRUE(found);
  ASSERT_EQ(found->All.size(), 4u);
  EXPECT_EQ(found->All[2].Least, 0.0);
  EXPECT_EQ(found->All[2].Greatest, 100.0);
  EXPECT_GT(found->All[3].Greatest, 170.0);
  const auto part = vol::FindRanges({ file, 1, 0 }, corner, 2, [](double) { return true; });
  EXPECT_EQ(part->All[1].Least, 1.0);
  EXPECT_EQ(part->All[1].Greatest, 4.0);
  EXPECT_EQ(part->All[3].Least, std::sqrt(0.0 + 1.0 + 4.0));
  vol::KeepRanges({ file, 1, 0 }, whole, *found);
  const auto kept = vol::LoadRanges({ file, 1, 0 }, whole, true);
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->All[3].Greatest, found->All[3].Greatest);
  // A rank's share may have those of more; what is asked for itself has its own.
  EXPECT_FALSE(vol::LoadRanges({ file, 1, 0 }, corner, false));
  const auto share = vol::LoadRanges({ file, 1, 0 }, corner, true);
  ASSERT_TRUE(share);
  EXPECT_EQ(share->All[3].Greatest, found->All[3].Greatest);
  EXPECT_FALSE(vol::FindRanges({ file, 1, 0 }, whole, 1, [](double) { return false; }));
}

/// What some ranks found of their shares is known to others with other shares.
TEST(VolumeFiles, RangesOfSharesArePutTogether)
{
  const fs::path caches = GetFolder() / "shares";
  fs::remove_all(caches);
  setenv("XDG_CACHE_HOME", caches.c_str(), 1);
  const auto file = Open(FindEntry("vectors.h5"));
  const bricks::Index3 samples = file->GetArrays()[1].Grid.Samples;
  const bricks::Box whole{ bricks::Index3(0), samples };
  const auto keepShare = [&](const bricks::Box& share)
  {
    vol::KeepRanges({ file, 1, 0 }, share,
      *vol::FindRanges({ file, 1, 0 }, share, 1, [](double) { return true; }));
  };
  // Cut in x, and one half of it in y; neighbors share a plane of samples.
  const bricks::Index3 middle = samples / std::int64_t(2);
  keepShare({ bricks::Index3(0), { middle.x + 1, samples.y, samples.z } });
  EXPECT_FALSE(vol::LoadRanges({ file, 1, 0 }, whole, true));
  keepShare({ { middle.x, 0, 0 }, { samples.x, middle.y + 1, samples.z } });
  EXPECT_FALSE(vol::LoadRanges({ file, 1, 0 }, whole, true));
  keepShare({ middle * bricks::Index3(1, 1, 0), samples });
  EXPECT_FALSE(vol::LoadRanges({ file, 1, 0 }, whole, false));
  const auto known = vol::LoadRanges({ file, 1, 0 }, whole, true);
  const auto found = vol::FindRanges({ file, 1, 0 }, whole, 1, [](double) { return true; });
  ASSERT_TRUE(known);
  ASSERT_TRUE(found);
  ASSERT_FALSE(found->All.empty());
  ASSERT_EQ(known->All.size(), found->All.size());
  ASSERT_EQ(known->Finite.size(), found->Finite.size());
  for (std::size_t index = 0; index < found->All.size(); ++index)
  {
    EXPECT_EQ(known->All[index].Least, found->All[index].Least);
    EXPECT_EQ(known->All[index].Greatest, found->All[index].Greatest);
    EXPECT_EQ(known->Finite[index].Least, found->Finite[index].Least);
    EXPECT_EQ(known->Finite[index].Greatest, found->Finite[index].Greatest);
  }
  EXPECT_TRUE(vol::LoadRanges({ file, 1, 0 }, { middle, samples }, true));
  EXPECT_FALSE(vol::LoadRanges({ file, 0, 0 }, whole, true));
}

/// VTK's attribute of the points' values.
TEST(VolumeFiles, ScalarsAreThoseThatVtkTells)
{
  for (const char* const name : { "scalars.vtkhdf", "scalars_text.vtkhdf" })
  {
    const Json entry = FindEntry(name);
    if (entry.is_null())
    {
      GTEST_SKIP() << "no files";
    }
    const auto file = Open(entry);
    int active = 0;
    for (const vol::FileArray& array : file->GetArrays())
    {
      EXPECT_EQ(array.IsActive, array.Name == "g") << name;
      active += array.IsActive ? 1 : 0;
    }
    EXPECT_EQ(active, 1) << name;
  }
}

/// A file that nobody has any more is not held open by its chunks.
TEST(VolumeFiles, ThatNobodyHasAreClosed)
{
  const auto countOpen = []
  {
    const fs::directory_iterator all("/proc/self/fd");
    return std::distance(fs::begin(all), fs::end(all));
  };
  vol::ChunkCache& cache = vol::ChunkCache::GetShared();
  const auto before = countOpen();
  const std::size_t held = cache.GetBytes();
  auto file = vol::OpenCachedVolume({ (GetFolder() / "chunked.h5").string() }, {});
  const auto other = vol::OpenCachedVolume({ (GetFolder() / "deflate.h5").string() }, {});
  const bricks::Box corner{ bricks::Index3(0), bricks::Index3(2) };
  std::vector<std::byte> bytes(64);
  cache.ReadBox({ file, 0, 0 }, corner, bytes.data());
  const std::size_t one = cache.GetBytes() - held;
  EXPECT_GT(one, 0u);
  cache.ReadBox({ other, 0, 0 }, corner, bytes.data());
  const std::size_t both = cache.GetBytes() - held;
  EXPECT_GT(countOpen(), before);
  file.reset();
  EXPECT_EQ(cache.GetBytes() - held, both - one);
}

} // namespace
