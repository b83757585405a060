// SPDX-License-Identifier: BSD-3-Clause
#include "WatchedReading.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/open/OpenVolumeFile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <new>
#include <vector>

#include <malloc.h>

namespace
{

std::atomic<std::size_t> InUse{ 0 };
std::atomic<std::size_t> Most{ 0 };

void* Allocate(std::size_t bytes)
{
  void* const place = std::malloc(std::max<std::size_t>(1, bytes));
  if (!place)
  {
    throw std::bad_alloc();
  }
  const std::size_t now = InUse += malloc_usable_size(place);
  Most = std::max(Most.load(), now); // one thread reads
  return place;
}

void Free(void* place)
{
  InUse -= malloc_usable_size(place);
  std::free(place);
}

} // namespace

// All memory of the program and its libraries, also what is never touched.
void* operator new(std::size_t bytes)
{
  return Allocate(bytes);
}
void* operator new[](std::size_t bytes)
{
  return Allocate(bytes);
}
void operator delete(void* place) noexcept
{
  Free(place);
}
void operator delete[](void* place) noexcept
{
  Free(place);
}
void operator delete(void* place, std::size_t) noexcept
{
  Free(place);
}
void operator delete[](void* place, std::size_t) noexcept
{
  Free(place);
}

namespace dsm_test
{

namespace
{

void ReadFirstChunks(const fs::path& path, const vol::OpenOptions& options)
{
  const auto file = vol::OpenVolumeFile(path.string(), options);
  file->GetTableBytes();
  for (std::size_t array = 0; array < file->GetArrays().size(); ++array)
  {
    const vol::FileArray& what = file->GetArrays()[array];
    const bricks::Box box = what.Grid.GetBox(bricks::Index3(0));
    what.Grid.CountBytesOfChunks(33, what.GetSampleBytes());
    std::vector<std::byte> bytes(static_cast<std::size_t>(box.GetCount()) * what.GetSampleBytes());
    file->Prefetch(array, 0, { { bricks::Index3(0), box } });
    file->ReadChunk(array, 0, bricks::Index3(0), bytes.data());
  }
}

} // namespace

fs::path MakeFolder(const std::string& name)
{
  const fs::path folder = fs::path(DSM_TEST_FILES) / "hostile" / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

void WriteText(const fs::path& path, const std::string& text)
{
  std::ofstream(path, std::ios::binary) << text;
}

void WriteSparse(const fs::path& path, std::uintmax_t bytes)
{
  WriteText(path, "");
  fs::resize_file(path, bytes);
}

std::string ReadWatched(const fs::path& path, const vol::OpenOptions& options)
{
  constexpr std::size_t mostBytes = 100'000'000;
  // Other programs may delay this one, but not use its processor time.
  constexpr double mostOfProcessor = 1.0;
  constexpr double mostSeconds = 5.0;
  const std::clock_t startOfProcessor = std::clock();
  const auto start = std::chrono::steady_clock::now();
  const std::size_t before = InUse;
  Most = before;
  std::string wrong;
  try
  {
    ReadFirstChunks(path, options);
  }
  catch (const dsm::Error& error)
  {
    wrong = error.what();
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  const double ofProcessor =
    static_cast<double>(std::clock() - startOfProcessor) / static_cast<double>(CLOCKS_PER_SEC);
  EXPECT_LT(ofProcessor, mostOfProcessor) << path;
  EXPECT_LT(seconds.count(), mostSeconds) << path;
  EXPECT_LT(Most - before, mostBytes) << path;
  EXPECT_LT(wrong.size(), 1000u) << path;
  return wrong;
}

void ExpectRefusal(
  const fs::path& path, std::initializer_list<const char*> words, const vol::OpenOptions& options)
{
  const std::string text = ReadWatched(path, options);
  EXPECT_NE(text.find(path.string()), std::string::npos) << path << " is not named: " << text;
  for (const char* word : words)
  {
    EXPECT_NE(text.find(word), std::string::npos) << "'" << word << "' is not in: " << text;
  }
}

} // namespace dsm_test
