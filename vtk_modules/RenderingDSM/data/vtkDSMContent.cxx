// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMContent.h"

#include "DSMRayTracing/base/ByteHash.h"
#include "DSMRayTracing/base/ParallelFor.h"
#include "vtkDSMFileArray.h"

#include "vtkDataArray.h"
#include "vtkSOADataArrayTemplate.h"

#include <array>
#include <cstddef>
#include <cstring>
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

template <class T>
bool FindComponents(vtkDataArray* array, std::vector<Bytes>& parts)
{
  auto* components = dynamic_cast<vtkSOADataArrayTemplate<T>*>(array);
  for (int index = 0; components && index < array->GetNumberOfComponents(); ++index)
  {
    parts.push_back({ components->GetComponentArrayPointer(index),
      static_cast<std::size_t>(array->GetNumberOfTuples()) * sizeof(T) });
  }
  return components != nullptr;
}

/// Where the values are; false where they are nowhere as bytes.
bool FindBytes(vtkDataArray* array, std::vector<Bytes>& parts)
{
  const auto values = static_cast<std::size_t>(array->GetNumberOfValues());
  if (values == 0)
  {
    return true;
  }
  if (array->GetDataType() == VTK_BIT)
  {
    parts.push_back({ array->GetVoidPointer(0), (values + 7) / 8 });
    return true;
  }
  if (array->HasStandardMemoryLayout())
  {
    parts.push_back(
      { array->GetVoidPointer(0), values * static_cast<std::size_t>(array->GetDataTypeSize()) });
    return true;
  }
  bool found = false;
  switch (array->GetDataType())
  {
    vtkTemplateMacro(found = FindComponents<VTK_TT>(array, parts));
  }
  return found;
}

/// Four interleaved hashes, as a processor does four multiplications at once that do not wait for one
/// another.
std::uint64_t HashChunk(const std::byte* data, std::size_t bytes)
{
  constexpr std::size_t lanes = 4;
  constexpr std::size_t step = lanes * sizeof(std::uint64_t);
  std::array<std::uint64_t, lanes> state{ 1, 2, 3, 4 };
  std::size_t at = 0;
  for (; at + step <= bytes; at += step)
  {
    std::array<std::uint64_t, lanes> words;
    std::memcpy(words.data(), data + at, step);
    for (std::size_t lane = 0; lane < lanes; ++lane)
    {
      state[lane] = rt::ByteHash::AddWord(state[lane], words[lane]);
    }
  }
  rt::ByteHash hash;
  hash.Add(state.data(), sizeof(state));
  hash.Add(data + at, bytes - at);
  return hash.Get();
}

std::uint64_t HashBytes(const Bytes& bytes, int threads)
{
  std::vector<std::uint64_t> chunks((bytes.Size + ChunkBytes - 1) / ChunkBytes);
  rt::ParallelForChunks(threads, bytes.Size, ChunkBytes,
    [&](std::size_t begin, std::size_t end, std::size_t chunk, int)
    { chunks[chunk] = HashChunk(static_cast<const std::byte*>(bytes.Data) + begin, end - begin); });
  rt::ByteHash hash;
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
  std::vector<Bytes> parts;
  auto* numbers = vtkDataArray::SafeDownCast(array);
  if (!numbers || !FindBytes(numbers, parts))
  {
    static std::uint64_t unknown = 0;
    return ++unknown;
  }
  const std::array<std::int64_t, 3> shape{ array->GetDataType(), array->GetNumberOfComponents(),
    array->GetNumberOfTuples() };
  rt::ByteHash hash;
  hash.Add(shape.data(), sizeof(shape));
  for (const Bytes& part : parts)
  {
    const std::uint64_t value = HashBytes(part, threads);
    hash.Add(&value, sizeof(value));
  }
  return hash.Get();
}
