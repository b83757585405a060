// SPDX-License-Identifier: BSD-3-Clause
// A volume in a file: what a picture reads of it, the first time and later.
#include "vtkDSMMemoryOptions.h"
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
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <stdlib.h>
#include <unistd.h>

namespace
{

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

} // namespace
