// SPDX-License-Identifier: BSD-3-Clause
// A volume in a file: what a picture reads of it, the first time and later.
#include "vtkDSMMemoryOptions.h"
#include "vtkDSMReadAhead.h"
#include "vtkDSMScene.h"
#include "vtkDSMVolumeMapper.h"
#include "vtkDSMVolumeReader.h"

#include "vtkCamera.h"
#include "vtkNew.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <fcntl.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

namespace
{

/// Pages of a file in the system's cache, which drops them first where it is asked to.
std::ptrdiff_t CountPages(const std::string& path, bool drop)
{
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const auto bytes = static_cast<std::size_t>(std::filesystem::file_size(path));
  if (drop)
  {
    fsync(file);
    posix_fadvise(file, 0, 0, POSIX_FADV_DONTNEED);
  }
  void* const memory = mmap(nullptr, bytes, PROT_READ, MAP_SHARED, file, 0);
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  std::vector<unsigned char> states((bytes + page - 1) / page);
  mincore(memory, bytes, states.data());
  munmap(memory, bytes);
  close(file);
  return std::count_if(
    states.begin(), states.end(), [](unsigned char state) { return (state & 1) != 0; });
}

constexpr int Edge = 96;
constexpr int Size = 200;
constexpr vtkTypeUInt64 FileBytes = vtkTypeUInt64(Edge) * Edge * Edge * sizeof(float);

/// A small ball in the middle of a volume, in a folder of its own.
class VolumeFile : public testing::Test
{
protected:
  VolumeFile()
    : Folder(std::filesystem::temp_directory_path() /
        ("dsm-volume-file-" + std::to_string(std::rand()) + "-" + std::to_string(getpid())))
  {
    std::filesystem::create_directories(this->Folder);
    setenv("XDG_CACHE_HOME", (this->Folder / "caches").c_str(), 1);
    std::vector<float> values;
    for (int place = 0; place < Edge * Edge * Edge; ++place)
    {
      const double at[] = { double(place % Edge), double(place / Edge % Edge),
        double(place / Edge / Edge) };
      double sum = 0.0;
      for (const double coordinate : at)
      {
        sum += std::pow(coordinate / (Edge - 1) - 0.5, 2.0);
      }
      values.push_back(static_cast<float>(std::sqrt(sum)));
    }
    std::ofstream file(this->Folder / "ball.raw", std::ios::binary);
    file.write(reinterpret_cast<const char*>(values.data()), FileBytes);
  }
  ~VolumeFile() override
  {
    vtkDSMVolumeReader::SetCacheMebibytes(128);
    std::filesystem::remove_all(this->Folder);
  }

  /// The colours of a picture of all that is new but the file.
  std::vector<unsigned char> Render()
  {
    vtkDSMVolumeReader::SetCacheMebibytes(0); // forgets what is there
    vtkDSMVolumeReader::SetCacheMebibytes(128);
    vtkNew<vtkRenderer> renderer;
    vtkNew<vtkRenderWindow> window;
    window->SetOffScreenRendering(1);
    window->SetMultiSamples(0);
    window->SetSize(Size, Size);
    window->AddRenderer(renderer);
    const auto scene = vtkDSMScene::ForRenderer(renderer);
    vtkNew<vtkDSMVolumeReader> reader;
    reader->SetFileName((this->Folder / "ball.raw").c_str());
    reader->SetRawDimensions(Edge, Edge, Edge);
    reader->SetRawScalarType(VTK_FLOAT);
    vtkNew<vtkDSMVolumeMapper> mapper;
    mapper->SetInputConnection(reader->GetOutputPort());
    mapper->SetIsoArray("values");
    mapper->SetIsoValue(0, 0.15);
    mapper->GetMemoryOptions()->SetNumberOfThreads(2);
    vtkNew<vtkVolume> volume;
    volume->SetMapper(mapper);
    renderer->AddVolume(volume);
    renderer->ResetCamera();
    window->Render();
    vtkNew<vtkUnsignedCharArray> pixels;
    window->GetPixelData(0, 0, Size - 1, Size - 1, 0, pixels);
    return { pixels->GetPointer(0), pixels->GetPointer(0) + pixels->GetNumberOfValues() };
  }

  std::filesystem::path Folder;
};

TEST_F(VolumeFile, LaterPicturesReadWhatRaysMeet)
{
  vtkTypeUInt64 before = vtkDSMVolumeReader::GetBytesRead();
  const auto first = this->Render();
  EXPECT_GE(vtkDSMVolumeReader::GetBytesRead() - before, FileBytes) << "all is looked through once";
  before = vtkDSMVolumeReader::GetBytesRead();
  const auto second = this->Render();
  const vtkTypeUInt64 read = vtkDSMVolumeReader::GetBytesRead() - before;
  EXPECT_EQ(first, second);
  EXPECT_GT(read, 0u);
  EXPECT_LT(read, FileBytes * 2 / 3) << "the ball is in the middle";
  EXPECT_GT(
    std::count_if(first.begin(), first.end(), [](unsigned char c) { return c != 0; }), 1000);
}

/// What was kept is of no use when it is damaged.
TEST_F(VolumeFile, DamagedIndexIsMadeAgain)
{
  const auto first = this->Render();
  int damaged = 0;
  for (const auto& kept :
    std::filesystem::directory_iterator(this->Folder / "caches/dsm-ray-tracer"))
  {
    std::fstream file(kept.path(), std::ios::binary | std::ios::in | std::ios::out);
    if (kept.path().filename().string().rfind("bricks", 0) == 0)
    {
      file.seekp(100);
      file.put('x');
      ++damaged;
    }
  }
  EXPECT_EQ(damaged, 1);
  const vtkTypeUInt64 before = vtkDSMVolumeReader::GetBytesRead();
  EXPECT_EQ(this->Render(), first);
  EXPECT_GE(vtkDSMVolumeReader::GetBytesRead() - before, FileBytes);
}

/// While a step is shown, what it needs is fetched of the next one, in the direction that time has.
TEST_F(VolumeFile, PlayingFetchesTheNextStep)
{
  std::vector<std::string> paths;
  for (int step = 0; step < 4; ++step)
  {
    paths.push_back((this->Folder / ("ball" + std::to_string(step) + ".raw")).string());
    std::filesystem::copy_file(this->Folder / "ball.raw", paths.back());
  }
  if (CountPages(paths[2], true) > 0)
  {
    GTEST_SKIP() << "the system keeps all files of this folder in memory";
  }
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetSize(Size, Size);
  window->AddRenderer(renderer);
  const auto scene = vtkDSMScene::ForRenderer(renderer);
  vtkNew<vtkDSMVolumeReader> reader;
  for (const std::string& path : paths)
  {
    reader->AddFileName(path.c_str());
  }
  reader->SetRawDimensions(Edge, Edge, Edge);
  reader->SetRawScalarType(VTK_FLOAT);
  vtkNew<vtkDSMVolumeMapper> mapper;
  mapper->SetInputConnection(reader->GetOutputPort());
  mapper->SetIsoArray("values");
  mapper->SetIsoValue(0, 0.15);
  vtkNew<vtkVolume> volume;
  volume->SetMapper(mapper);
  renderer->AddVolume(volume);
  const auto play = [&](int step)
  {
    reader->UpdateTimeStep(step);
    renderer->ResetCamera();
    window->Render();
  };
  const auto isFetched = [&](int step)
  {
    std::ptrdiff_t pages = 0;
    for (int wait = 0; pages == 0 && wait < 50; ++wait)
    {
      pages = CountPages(paths[static_cast<std::size_t>(step)], false);
      usleep(pages == 0 ? 100000 : 0);
    }
    return pages > 0;
  };
  CountPages(paths[1], true);
  play(0);
  EXPECT_EQ(CountPages(paths[1], false), 0) << "nothing for who looks at one step";
  CountPages(paths[2], true);
  play(1);
  EXPECT_TRUE(isFetched(2));
  play(3);
  CountPages(paths[0], true);
  play(2);
  play(1);
  EXPECT_TRUE(isFetched(0)) << "backwards";
}

/// Chunks that are found in no part: each byte is the chunk's number, and the step's.
class CompressedFile final : public vol::VolumeFile
{
public:
  CompressedFile()
    : VolumeFile("compressed")
  {
    vol::FileArray array;
    array.Grid.Samples = rt::Index3(64);
    array.Grid.ChunkSamples = rt::Index3(16);
    this->Arrays.push_back(array);
    this->Steps = 3;
  }
  void ReadChunk(
    std::size_t array, int step, const rt::Index3& chunk, std::byte* out) const override
  {
    const vol::ChunkGrid& grid = this->Arrays[array].Grid;
    std::fill_n(out, static_cast<std::size_t>(grid.GetBox(chunk).GetCount()),
      static_cast<std::byte>(grid.GetNumber(chunk) + step));
    ++this->Reads;
  }

  mutable std::atomic<int> Reads{ 0 };
};

/// Waits until no more is read.
int WaitForReads(const CompressedFile& file)
{
  int before = -1;
  while (before != file.Reads)
  {
    before = file.Reads;
    usleep(100000);
  }
  return before;
}

TEST(ReadAhead, TakesHalfOfTheCacheAndWaitsForFrames)
{
  constexpr std::size_t chunkBytes = 16 * 16 * 16;
  vol::ChunkCache cache(20 * chunkBytes);
  vtkDSMReadAhead ahead(cache);
  const auto file = std::make_shared<CompressedFile>();
  const auto addRow = [&](int step, int row)
  {
    for (int x = 0; x < 4; ++x)
    {
      ahead.Add(file, 0, step, rt::Index3(x, row, 0));
    }
  };
  {
    const vtkDSMReadAhead::Pause pause(ahead);
    addRow(1, 0);
    addRow(1, 0); // known
    EXPECT_EQ(WaitForReads(*file), 0) << "a frame is being made";
  }
  EXPECT_EQ(WaitForReads(*file), 4);
  EXPECT_EQ((*cache.Get(file, 0, 1, rt::Index3(1, 0, 0)))[5], std::byte(2));
  EXPECT_EQ(file->Reads, 4) << "it was there";
  for (int row = 1; row < 4; ++row)
  {
    addRow(1, row);
  }
  EXPECT_EQ(WaitForReads(*file), 10) << "half of the room";
  {
    const vtkDSMReadAhead::Pause pause(ahead);
    addRow(2, 0);
    addRow(0, 0); // the user turns round
  }
  EXPECT_EQ(WaitForReads(*file), 14);
  EXPECT_EQ((*cache.Get(file, 0, 0, rt::Index3(3, 0, 0)))[0], std::byte(3));
  EXPECT_EQ(file->Reads, 14);
}

} // namespace
