// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMContent.h"

#include "DSMBricks/base/ByteHash.h"
#include "DSMBricks/base/ParallelFor.h"
#include "DSMCore/base/ByteDigest.h"
#include "vtkDSMFileArray.h"

#include "vtkDataArray.h"
#include "vtkSOADataArrayTemplate.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <functional>
#include <vector>

namespace
{

/// Hashed one by one, so that threads can share an array and the result does not depend on them.
constexpr std::size_t ChunkBytes = std::size_t{ 4 } << 20;

struct Bytes
{
  const void* Data;
  std::size_t Size;
};

/// Finds the memory of the values; false if they are not contiguous.
bool FindBytes(vtkDataArray* array, Bytes& bytes)
{
  const auto values = static_cast<std::size_t>(array->GetNumberOfValues());
  if (values == 0)
  {
    bytes = { nullptr, 0 };
    return true;
  }
  if (array->GetDataType() == VTK_BIT)
  {
    bytes = { array->GetVoidPointer(0), (values + 7) / 8 };
    return true;
  }
  if (array->HasStandardMemoryLayout())
  {
    bytes = { array->GetVoidPointer(0),
      values * static_cast<std::size_t>(array->GetDataTypeSize()) };
    return true;
  }
  return false;
}

/// Copies tuples, and may be called by as many threads as it says.
struct TupleCopier
{
  int Threads;
  std::function<void(vtkIdType first, vtkIdType count, std::byte* out)> Copy;
};

/// Empty for an array of another class or type.
template <class T>
TupleCopier FindComponents(vtkDataArray* array, int threads)
{
  // Such arrays may hold their values together as well, and VTK did not always tell which.
  auto* components = dynamic_cast<vtkSOADataArrayTemplate<T>*>(array);
  if (!components)
  {
    return { 1, nullptr };
  }
  return { threads,
    [components](vtkIdType first, vtkIdType count, std::byte* out)
    {
      auto* values = reinterpret_cast<T*>(out);
      for (int component = 0; component < components->GetNumberOfComponents(); ++component)
      {
        for (vtkIdType tuple = first; tuple < first + count; ++tuple)
        {
          *values++ = components->GetTypedComponent(tuple, component);
        }
      }
    } };
}

/// For any array, also those that compute their values on demand: VTK's implicit arrays, among them
/// the offsets of cells of equal size.
TupleCopier FindCopier(vtkDataArray* array, int threads)
{
  TupleCopier copier{ 1, nullptr };
  switch (array->GetDataType())
  {
    vtkTemplateMacro(copier = FindComponents<VTK_TT>(array, threads));
  }
  if (!copier.Copy)
  {
    // One thread: such an array may remember what it did last.
    copier.Copy = [array](vtkIdType first, vtkIdType count, std::byte* out)
    {
      vtkSmartPointer<vtkDataArray> copy;
      copy.TakeReference(vtkDataArray::CreateDataArray(array->GetDataType()));
      copy->SetNumberOfComponents(array->GetNumberOfComponents());
      copy->SetNumberOfTuples(count);
      array->GetTuples(first, first + count - 1, copy);
      std::memcpy(out, copy->GetVoidPointer(0),
        static_cast<std::size_t>(copy->GetNumberOfValues()) * copy->GetDataTypeSize());
    };
  }
  return copier;
}

std::uint64_t HashBytes(const Bytes& bytes, int threads)
{
  std::vector<std::uint64_t> chunks((bytes.Size + ChunkBytes - 1) / ChunkBytes);
  bricks::ParallelForChunks(threads, bytes.Size, ChunkBytes,
    [&](std::size_t begin, std::size_t end, std::size_t chunk, int)
    {
      chunks[chunk] =
        dsm::HashBytes(static_cast<const std::byte*>(bytes.Data) + begin, end - begin);
    });
  bricks::ByteHash hash;
  hash.Add(chunks.data(), chunks.size() * sizeof(chunks[0]));
  return hash.Get();
}

std::uint64_t HashCopies(vtkDataArray* array, int threads)
{
  const TupleCopier copier = FindCopier(array, threads);
  const std::size_t tupleBytes =
    static_cast<std::size_t>(array->GetNumberOfComponents()) * array->GetDataTypeSize();
  const auto tuples = static_cast<std::size_t>(array->GetNumberOfTuples());
  const std::size_t step = std::max<std::size_t>(ChunkBytes / tupleBytes, 1);
  std::vector<std::uint64_t> chunks((tuples + step - 1) / step);
  bricks::ParallelForChunks(copier.Threads, tuples, step,
    [&](std::size_t begin, std::size_t end, std::size_t chunk, int)
    {
      std::vector<std::byte> copy((end - begin) * tupleBytes);
      copier.Copy(static_cast<vtkIdType>(begin), static_cast<vtkIdType>(end - begin), copy.data());
      chunks[chunk] = dsm::HashBytes(copy.data(), copy.size());
    });
  bricks::ByteHash hash;
  hash.Add(chunks.data(), chunks.size() * sizeof(chunks[0]));
  return hash.Get();
}

} // namespace

std::uint64_t vtkDSMContent::Hash(vtkAbstractArray* array, int threads)
{
  if (!array)
  {
    return 0;
  }
  if (const vtkDSMFileValues* values = vtkDSMGetFileValues(array))
  {
    return values->GetStamp();
  }
  auto* numbers = vtkDataArray::SafeDownCast(array);
  if (!numbers)
  {
    static std::uint64_t unknown = 0;
    return ++unknown;
  }
  const std::array<std::int64_t, 3> shape{ array->GetDataType(), array->GetNumberOfComponents(),
    array->GetNumberOfTuples() };
  bricks::ByteHash hash;
  hash.Add(shape.data(), sizeof(shape));
  Bytes bytes;
  const std::uint64_t values =
    FindBytes(numbers, bytes) ? HashBytes(bytes, threads) : HashCopies(numbers, threads);
  hash.Add(&values, sizeof(values));
  return hash.Get();
}
