// SPDX-License-Identifier: BSD-3-Clause
// Arrays whose values are in files.
#include "vtkDSMVolumeReader.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

namespace
{

namespace fs = std::filesystem;

constexpr int Edge = 4;

/// A file of bare values, for as long as it is in scope: each is its number, and `more`.
template <class T>
class BareFile
{
public:
  explicit BareFile(T more)
    : Path(fs::temp_directory_path() /
        ("TestFileArray" + std::to_string(getpid()) + "-" + std::to_string(sizeof(T)) + ".raw"))
  {
    std::ofstream file(this->Path, std::ios::binary);
    for (int number = 0; number < Edge * Edge * Edge; ++number)
    {
      const T value = static_cast<T>(number + more);
      file.write(reinterpret_cast<const char*>(&value), sizeof(value));
    }
  }
  ~BareFile() { fs::remove(this->Path); }

  const fs::path Path;
};

vtkDataArray* Open(vtkDSMVolumeReader* reader, const fs::path& path, int type)
{
  reader->SetFileName(path.c_str());
  reader->SetRawDimensions(Edge, Edge, Edge);
  reader->SetRawScalarType(type);
  reader->Update();
  return reader->GetOutput()->GetPointData()->GetScalars();
}

} // namespace

TEST(FileArray, OfSeveralTypesReadInTurn)
{
  const BareFile<float> floats(0.5f);
  const BareFile<unsigned short> shorts(1000);
  vtkNew<vtkDSMVolumeReader> readers[2];
  vtkDataArray* const first = Open(readers[0], floats.Path, VTK_FLOAT);
  vtkDataArray* const second = Open(readers[1], shorts.Path, VTK_UNSIGNED_SHORT);
  ASSERT_TRUE(first && second);
  ASSERT_EQ(first->GetNumberOfTuples(), Edge * Edge * Edge);
  ASSERT_EQ(second->GetNumberOfTuples(), Edge * Edge * Edge);
  for (int tuple = 0; tuple < Edge * Edge * Edge; ++tuple)
  {
    ASSERT_EQ(first->GetComponent(tuple, 0), tuple + 0.5) << tuple;
    ASSERT_EQ(second->GetComponent(tuple, 0), tuple + 1000) << tuple;
  }
}

TEST(FileArray, OthersThatAreMadeLikeItAreVtksOwn)
{
  const BareFile<float> floats(0.5f);
  vtkNew<vtkDSMVolumeReader> reader;
  vtkDataArray* const array = Open(reader, floats.Path, VTK_FLOAT);
  ASSERT_TRUE(array);
  const auto other = vtkSmartPointer<vtkDataArray>::Take(array->NewInstance());
  EXPECT_TRUE(other->IsA("vtkFloatArray")) << other->GetClassName();
}

TEST(FileArray, ThreadsThatWantItsMemoryGetTheSame)
{
  const BareFile<float> floats(0.5f);
  for (int attempt = 0; attempt < 50; ++attempt)
  {
    vtkNew<vtkDSMVolumeReader> reader;
    vtkDataArray* const array = Open(reader, floats.Path, VTK_FLOAT);
    ASSERT_TRUE(array);
    std::vector<void*> found(4, nullptr);
    std::atomic<int> waiting{ 4 };
    std::vector<std::thread> threads;
    for (void*& pointer : found)
    {
      threads.emplace_back(
        [&]
        {
          --waiting;
          while (waiting > 0)
          {
          }
          pointer = array->GetVoidPointer(0);
        });
    }
    for (std::thread& thread : threads)
    {
      thread.join();
    }
    for (void* const pointer : found)
    {
      ASSERT_EQ(pointer, found.front()) << attempt;
    }
    ASSERT_EQ(static_cast<const float*>(found.front())[Edge], Edge + 0.5f);
  }
}
