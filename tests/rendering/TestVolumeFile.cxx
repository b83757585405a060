// SPDX-License-Identifier: BSD-3-Clause
// A volume in a file: what a picture reads of it, the first time and later.
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/cache/ReadAhead.h"
#include "vtkDSMMemoryOptions.h"
#include "vtkDSMScene.h"
#include "vtkDSMVolumeMapper.h"
#include "vtkDSMVolumeReader.h"
#ifdef DSM_HAS_HDF5
#include "vtkDSMVolumeWriter.h"
#endif

#include "vtkCamera.h"
#include "vtkCellData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
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
    this->Write("ball.raw", 0.0);
  }
  ~VolumeFile() override
  {
    vtkDSMVolumeReader::SetCacheMebibytes(128);
    std::filesystem::remove_all(this->Folder);
  }

  /// The distance from the middle, and so much more.
  void Write(const std::string& name, double more) const
  {
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
      values.push_back(static_cast<float>(std::sqrt(sum) + more));
    }
    std::ofstream file(this->Folder / name, std::ios::binary);
    file.write(reinterpret_cast<const char*>(values.data()), FileBytes);
  }

  /// The colors of a picture of all that is new but the file.
  std::vector<unsigned char> Render(const std::string& name = "ball.raw",
    const char* array = "ball", int mebibytes = 128, bool onCells = false)
  {
    vtkDSMVolumeReader::SetCacheMebibytes(0); // forgets what is there
    vtkDSMVolumeReader::SetCacheMebibytes(mebibytes);
    vtkNew<vtkRenderer> renderer;
    vtkNew<vtkRenderWindow> window;
    window->SetOffScreenRendering(1);
    window->SetMultiSamples(0);
    window->SetSize(Size, Size);
    window->AddRenderer(renderer);
    const auto scene = vtkDSMScene::ForRenderer(renderer);
    vtkNew<vtkDSMVolumeReader> reader;
    reader->SetFileName((this->Folder / name).c_str());
    reader->SetRawDimensions(Edge, Edge, Edge);
    reader->SetRawScalarType(VTK_FLOAT);
    vtkNew<vtkDSMVolumeMapper> mapper;
    mapper->SetInputConnection(reader->GetOutputPort());
    mapper->SetIsoArray(array);
    mapper->SetIsoArrayOnCells(onCells);
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

#ifdef DSM_HAS_HDF5
TEST_F(VolumeFile, OfCellsReadsWhatRaysMeet)
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(Edge + 1, Edge + 1, Edge + 1);
  vtkNew<vtkFloatArray> values;
  values->SetName("ofCells");
  values->SetNumberOfTuples(image->GetNumberOfCells());
  std::ifstream ball(this->Folder / "ball.raw", std::ios::binary);
  ball.read(reinterpret_cast<char*>(values->GetPointer(0)), FileBytes);
  image->GetCellData()->AddArray(values);
  vtkNew<vtkDSMVolumeWriter> writer;
  writer->SetFileName((this->Folder / "cells.vtkhdf").c_str());
  writer->SetInputData(image);
  ASSERT_EQ(writer->Write(), 1);
  const auto render = [this] { return this->Render("cells.vtkhdf", "ofCells", 128, true); };
  vtkTypeUInt64 before = vtkDSMVolumeReader::GetBytesRead();
  const auto first = render();
  EXPECT_GE(vtkDSMVolumeReader::GetBytesRead() - before, FileBytes) << "all is looked through once";
  before = vtkDSMVolumeReader::GetBytesRead();
  EXPECT_EQ(render(), first);
  const vtkTypeUInt64 read = vtkDSMVolumeReader::GetBytesRead() - before;
  EXPECT_GT(read, 0u);
  EXPECT_LT(read, FileBytes * 2 / 3) << "the ball is in the middle";
  EXPECT_GT(
    std::count_if(first.begin(), first.end(), [](unsigned char c) { return c != 0; }), 1000);
}
#endif

/// Planes that can only be read as a whole, as of compressed slices: a brick needs as many as it has samples along z.
TEST_F(VolumeFile, ChunksThatABrickNeedsTogetherAreReadOnce)
{
  const std::filesystem::path planes = this->Folder / "planes.zarr";
  std::filesystem::create_directories(planes);
  std::ofstream(planes / ".zarray")
    << R"({"zarr_format": 2, "shape": [96, 96, 96], "chunks": [1, 96, 96], "dtype": "<f4", "order": "F",
           "compressor": null, "filters": null, "fill_value": 0})";
  std::ifstream ball(this->Folder / "ball.raw", std::ios::binary);
  std::vector<char> plane(FileBytes / Edge); // as wide as it is high, and the same transposed
  for (int z = 0; z < Edge; ++z)
  {
    ball.read(plane.data(), static_cast<std::streamsize>(plane.size()));
    std::ofstream(planes / (std::to_string(z) + ".0.0"), std::ios::binary)
      .write(plane.data(), static_cast<std::streamsize>(plane.size()));
  }
  const vtkTypeUInt64 before = vtkDSMVolumeReader::GetBytesRead();
  const auto first = this->Render("planes.zarr", "planes", 0);
  EXPECT_LT(vtkDSMVolumeReader::GetBytesRead() - before, 3 * FileBytes)
    << "to look through, and for the picture";
  EXPECT_EQ(first, this->Render());
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
    const std::string name = "ball" + std::to_string(step) + ".raw";
    paths.push_back((this->Folder / name).string());
    this->Write(name, 0.001 * step); // what is equal in two steps is not fetched again
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
  mapper->SetIsoArray("ball");
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
  vtkDSMVolumeReader::SetCacheMebibytes(0); // has step 0, since its index was made
  vtkDSMVolumeReader::SetCacheMebibytes(128);
  CountPages(paths[0], true);
  play(2);
  play(1);
  EXPECT_TRUE(isFetched(0)) << "backwards";
}

/// Bricks of which each byte is the brick's number, and the step's.
class StepOnDisk final : public dsm::BlockReader
{
public:
  explicit StepOnDisk(int step)
    : Step(step)
  {
  }
  void Read(dsm::BlockId id, std::byte* block, std::size_t bytes) const override
  {
    if (id == Bad)
    {
      throw dsm::Error("damaged");
    }
    std::fill_n(block, bytes, static_cast<std::byte>(static_cast<int>(id) + this->Step));
    ++this->Reads;
  }

  void Prefetch(const std::vector<dsm::BlockId>& ids) const override
  {
    this->Told += static_cast<int>(ids.size());
  }

  static constexpr dsm::BlockId Bad = 99;
  static constexpr dsm::BlockId Same = 98; ///< as in the step before
  int Step;
  mutable std::atomic<int> Reads{ 0 };
  mutable std::atomic<int> Told{ 0 };
};

TEST(ReadAhead, TakesHalfOfTheCacheAndWaitsForFrames)
{
  constexpr std::size_t bytes = 1000;
  vol::ChunkCache cache(20 * bytes);
  vol::ReadAhead ahead(cache);
  const auto open = [&](std::uint64_t key, const std::shared_ptr<StepOnDisk>& disk) {
    return ahead.Open(key, { disk, [](dsm::BlockId id) { return id == StepOnDisk::Same; } });
  };
  const auto first = std::make_shared<StepOnDisk>(1);
  const auto wait = [&](const StepOnDisk& disk)
  {
    int before = -1;
    while (before != disk.Reads + disk.Told)
    {
      before = disk.Reads + disk.Told;
      usleep(100000);
    }
    return int(disk.Reads);
  };
  auto step = open(1, first);
  {
    const vol::ReadAhead::Pause pause(ahead);
    for (const dsm::BlockId id : { 0, 1, 2, 3, 1 }) // one is known
    {
      ahead.Add(step, id, bytes);
    }
    EXPECT_EQ(wait(*first), 0) << "a frame is being made";
  }
  EXPECT_EQ(wait(*first), 4);
  EXPECT_EQ(cache.GetBytes(), 4 * bytes);
  ahead.Add(step, StepOnDisk::Bad, bytes);
  ahead.Add(step, StepOnDisk::Same, bytes);
  for (dsm::BlockId id = 4; id < 16; ++id)
  {
    ahead.Add(step, id, bytes);
  }
  EXPECT_EQ(wait(*first), 10) << "half of the room";
  EXPECT_EQ(first->Told, 6) << "the system can do the rest";

  std::vector<std::byte> block(bytes);
  EXPECT_EQ(ahead.Find(1), step);
  EXPECT_TRUE(step->Take(3, block.data(), bytes));
  EXPECT_EQ(block[5], std::byte(4));
  EXPECT_FALSE(step->Take(3, block.data(), bytes)) << "it was given away";
  EXPECT_FALSE(step->Take(4, block.data(), bytes - 1)) << "of another size";
  EXPECT_FALSE(step->Take(StepOnDisk::Bad, block.data(), bytes));
  EXPECT_FALSE(step->Take(StepOnDisk::Same, block.data(), bytes)) << "nobody will ask for it";
  EXPECT_FALSE(step->Take(15, block.data(), bytes)) << "there was no room";
  EXPECT_EQ(cache.GetBytes(), 9 * bytes);

  // The user turns round: what nobody has goes, and leaves room.
  const auto second = std::make_shared<StepOnDisk>(2);
  step = open(2, second);
  EXPECT_NE(ahead.Find(1), nullptr) << "somebody may be about to take it over";
  ahead.Tidy();
  EXPECT_EQ(ahead.Find(1), nullptr);
  EXPECT_EQ(ahead.Find(2), step);
  EXPECT_EQ(cache.GetBytes(), 0u);
  ahead.Add(step, 7, bytes);
  EXPECT_EQ(wait(*second), 1);
  EXPECT_TRUE(step->Take(7, block.data(), bytes));
  EXPECT_EQ(block[0], std::byte(9));
  EXPECT_EQ(cache.GetBytes(), 0u);
}

} // namespace
