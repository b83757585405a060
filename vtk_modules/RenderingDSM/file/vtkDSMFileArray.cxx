// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMFileArray.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/memory/HostMemory.h"
#include "DSMCore/memory/HostTurn.h"

#include "vtkArrayIteratorTemplate.h"
#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h"
#include "vtkTypeTraits.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <new>
#include <string>
#include <utility>

#include <sys/mman.h>

namespace
{

/// Chunks that a thread has used last: the planes around one, say.
constexpr std::size_t RecentChunks = 4;

struct Recent
{
  std::uint64_t Owner = 0; ///< array with that number; 0: none
  vtkDSMFileValues::Place Place;
};

thread_local std::array<Recent, RecentChunks> RecentPlaces;
thread_local std::size_t NextPlace = 0;

/// Another one for each array, of whatever type: threads know their recent places by it.
std::uint64_t TakeNumber()
{
  static std::atomic<std::uint64_t> last{ 0 };
  return ++last;
}

bool Contains(const bricks::Box& box, const bricks::Index3& sample)
{
  return sample.x >= box.Min.x && sample.x < box.Max.x && sample.y >= box.Min.y &&
    sample.y < box.Max.y && sample.z >= box.Min.z && sample.z < box.Max.z;
}

/// Returns the beginning of messages about an array.
std::string DescribeArray(const vtkDSMFileValues& values)
{
  return "The array '" + values.GetArray().Name + "' of the file '" + values.GetFile()->GetPath() +
    "' ";
}

std::string DescribeError(const std::exception& error)
{
  return dynamic_cast<const std::bad_alloc*>(&error) ? "out of memory." : error.what();
}

/// Memory for a copy of all: the ranks of a host ask for theirs at the same time, so each has to see what is left
/// when those before it have taken theirs. `take` also writes to the memory: the system provides it only then.
/// Throws dsm::Error, whose text continues the array's name.
template <class Take>
void TakeRoom(std::size_t bytes, const Take& take)
{
  const dsm::HostTurn turn;
  if (bytes > dsm::GetAvailableHostMemory() / 2)
  {
    throw dsm::Error("must be read entirely, but its " + dsm::FormatMebibytes(bytes) +
      " exceed half of the available memory. Extract a subset first.");
  }
  take();
}

void ReadAll(const vtkDSMFileValues& values, void* out)
{
  values.ReadBox({ bricks::Index3(0), values.GetBox().GetSize() }, static_cast<std::byte*>(out));
}

} // namespace

/// Any number of zero bytes, which take no memory as long as they are not written to.
template <class ValueTypeT>
class vtkDSMFileArray<ValueTypeT>::Zeros
{
public:
  /// Provides fewer bytes than requested if a process cannot address so many; no loop reaches their
  /// end.
  explicit Zeros(std::size_t bytes)
    : Bytes(bytes)
  {
    do
    {
      this->First = mmap(nullptr, this->Bytes, PROT_READ | PROT_WRITE,
        MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    } while (this->First == MAP_FAILED && (this->Bytes /= 2) > 0);
    if (this->First == MAP_FAILED)
    {
      throw std::bad_alloc();
    }
  }
  ~Zeros() { munmap(this->First, this->Bytes); }
  Zeros(const Zeros&) = delete;
  Zeros& operator=(const Zeros&) = delete;

  std::size_t Bytes;
  void* First = nullptr;
};

template <class ValueTypeT>
vtkDSMFileArray<ValueTypeT>* vtkDSMFileArray<ValueTypeT>::New()
{
  VTK_STANDARD_NEW_BODY(vtkDSMFileArray<ValueTypeT>);
}

template <class ValueTypeT>
vtkDSMFileArray<ValueTypeT>::vtkDSMFileArray()
  : Number(TakeNumber())
{
}

template <class ValueTypeT>
vtkDSMFileArray<ValueTypeT>::~vtkDSMFileArray() = default;

template <class ValueTypeT>
void vtkDSMFileArray<ValueTypeT>::SetValues(std::shared_ptr<const vtkDSMFileValues> values)
{
  this->Values = std::move(values);
  this->NumberOfComponents = this->Values->GetArray().Components;
  this->Size = this->Values->GetCount() * this->NumberOfComponents;
  this->MaxId = this->Size - 1;
  this->SetName(this->Values->GetArray().Name.c_str());
}

template <class ValueTypeT>
bool vtkDSMFileArray<ValueTypeT>::RefuseToWrite()
{
  this->Report("is read-only because its values are in a file. Copy it first.");
  return false;
}

template <class ValueTypeT>
void vtkDSMFileArray<ValueTypeT>::Report(const std::string& what) const
{
  if (!this->Reported.exchange(true))
  {
    vtkErrorMacro(<< DescribeArray(*this->Values) << what);
  }
}

template <class ValueTypeT>
const ValueTypeT* vtkDSMFileArray<ValueTypeT>::Find(vtkIdType tuple) const
{
  if (tuple < 0 || tuple * this->NumberOfComponents > this->MaxId)
  {
    this->Report("has values for " + std::to_string(this->Values->GetCount()) +
      " points or cells, but the value of number " + std::to_string(tuple) +
      " was requested: a filter assigned the array to a dataset of another size.");
    return nullptr;
  }
  const bricks::Index3 sample = this->Values->GetSample(tuple);
  const auto getValues = [&](const vtkDSMFileValues::Place& place)
  {
    const bricks::Index3 size = place.Has.GetSize();
    const bricks::Index3 at = sample - place.Has.Min;
    const std::int64_t number = (at.z * size.y + at.y) * size.x + at.x;
    return reinterpret_cast<const ValueTypeT*>(place.Samples->data()) +
      number * this->NumberOfComponents;
  };
  for (const Recent& recent : RecentPlaces)
  {
    if (recent.Owner == this->Number && Contains(recent.Place.Has, sample))
    {
      return getValues(recent.Place);
    }
  }
  try
  {
    Recent& recent = RecentPlaces[NextPlace++ % RecentChunks];
    recent.Owner = 0;
    recent.Place = this->Values->Find(sample);
    recent.Owner = this->Number;
    return getValues(recent.Place);
  }
  catch (const std::exception& error)
  {
    this->Report("cannot be read: " + DescribeError(error));
    return nullptr;
  }
}

template <class ValueTypeT>
void vtkDSMFileArray<ValueTypeT>::GetTypedTuple(vtkIdType tuple, ValueType* out) const
{
  const ValueType* const values = this->Find(tuple);
  for (int component = 0; component < this->NumberOfComponents; ++component)
  {
    out[component] = values ? values[component] : std::numeric_limits<ValueType>::quiet_NaN();
  }
}

template <class ValueTypeT>
ValueTypeT vtkDSMFileArray<ValueTypeT>::GetTypedComponent(vtkIdType tuple, int component) const
{
  const ValueType* const values = this->Find(tuple);
  return values ? values[component] : std::numeric_limits<ValueType>::quiet_NaN();
}

template <class ValueTypeT>
void* vtkDSMFileArray<ValueTypeT>::GetVoidPointer(vtkIdType index)
{
  const std::lock_guard<std::mutex> lock(this->CopyLock); // filters ask in several threads
  const auto count = static_cast<std::size_t>(this->Size);
  if (this->Copy.empty() && !this->NoValues && count > 0)
  {
    const std::size_t bytes = count * sizeof(ValueType);
    try
    {
      std::vector<ValueType> copy;
      TakeRoom(bytes, [&] { copy.resize(count); });
      ReadAll(*this->Values, copy.data());
      this->Copy = std::move(copy);
    }
    catch (const std::exception& error)
    {
      this->Reported = false; // weightier than what may have been said
      this->Report(DescribeError(error));
      this->NoValues = std::make_unique<Zeros>(bytes);
    }
  }
  auto* const first =
    this->NoValues ? static_cast<ValueType*>(this->NoValues->First) : this->Copy.data();
  return first + index;
}

template <class ValueTypeT>
vtkArrayIterator* vtkDSMFileArray<ValueTypeT>::NewIterator()
{
  vtkArrayIterator* const iterator = vtkArrayIteratorTemplate<ValueType>::New();
  iterator->Initialize(this);
  return iterator;
}

template <class ValueTypeT>
void vtkDSMFileArray<ValueTypeT>::ExportToVoidPointer(void* out)
{
  if (out && this->Size > 0)
  {
    std::memcpy(
      out, this->GetVoidPointer(0), static_cast<std::size_t>(this->Size) * sizeof(ValueType));
  }
}

template <class ValueTypeT>
unsigned long vtkDSMFileArray<ValueTypeT>::GetActualMemorySize() const
{
  return static_cast<unsigned long>((this->Copy.size() * sizeof(ValueType) + 1023) / 1024);
}

template <class ValueTypeT>
const vol::ValueRanges* vtkDSMFileArray<ValueTypeT>::FindRanges() const
{
  try
  {
    return this->Values->FindRanges([](double) { return true; });
  }
  catch (const std::exception& error)
  {
    this->Report("cannot be read: " + DescribeError(error));
    return nullptr;
  }
}

namespace
{

void Take(const vol::ValueRange& range, double out[2])
{
  out[0] = range.Least;
  out[1] = range.Greatest;
}

} // namespace

template <class ValueTypeT>
bool vtkDSMFileArray<ValueTypeT>::ComputeScalarRange(double* ranges)
{
  const vol::ValueRanges* known = this->FindRanges();
  for (int component = 0; known && component < this->NumberOfComponents; ++component)
  {
    Take(known->All[static_cast<std::size_t>(component)], ranges + 2 * component);
  }
  return known != nullptr;
}

template <class ValueTypeT>
bool vtkDSMFileArray<ValueTypeT>::ComputeFiniteScalarRange(double* ranges)
{
  const vol::ValueRanges* known = this->FindRanges();
  for (int component = 0; known && component < this->NumberOfComponents; ++component)
  {
    Take(known->Finite[static_cast<std::size_t>(component)], ranges + 2 * component);
  }
  return known != nullptr;
}

template <class ValueTypeT>
bool vtkDSMFileArray<ValueTypeT>::ComputeVectorRange(double range[2])
{
  const vol::ValueRanges* known = this->FindRanges();
  if (known)
  {
    Take(known->All.back(), range);
  }
  return known != nullptr;
}

template <class ValueTypeT>
bool vtkDSMFileArray<ValueTypeT>::ComputeFiniteVectorRange(double range[2])
{
  const vol::ValueRanges* known = this->FindRanges();
  if (known)
  {
    Take(known->Finite.back(), range);
  }
  return known != nullptr;
}

namespace
{

/// Calls `use` with a null pointer to the VTK type of a scalar type.
template <class Use>
auto DispatchType(bricks::ScalarType type, const Use& use)
{
  using Type = bricks::ScalarType;
  switch (type)
  {
    case Type::Int8:
      return use(static_cast<signed char*>(nullptr));
    case Type::UInt8:
      return use(static_cast<unsigned char*>(nullptr));
    case Type::Int16:
      return use(static_cast<short*>(nullptr));
    case Type::UInt16:
      return use(static_cast<unsigned short*>(nullptr));
    case Type::Int32:
      return use(static_cast<int*>(nullptr));
    case Type::UInt32:
      return use(static_cast<unsigned int*>(nullptr));
    case Type::Int64:
      return use(static_cast<long long*>(nullptr));
    case Type::UInt64:
      return use(static_cast<unsigned long long*>(nullptr));
    case Type::Float32:
      return use(static_cast<float*>(nullptr));
    default:
      return use(static_cast<double*>(nullptr));
  }
}

/// Makes integers numbers of a floating point type that has at least as many bytes, in place, with
/// NaN for missing ones.
void WithoutMissing(
  const vol::FileArray& array, std::size_t count, bricks::ScalarType type, std::byte* samples)
{
  bricks::Dispatch(array.Type,
    [&](auto number)
    {
      const bricks::MissingTest<decltype(number)> isMissing(array.Valid);
      bricks::Dispatch(type,
        [&](auto value)
        {
          for (std::size_t left = count; left-- > 0;)
          {
            std::memcpy(&number, samples + left * sizeof(number), sizeof(number));
            value = isMissing(number) ? std::numeric_limits<decltype(value)>::quiet_NaN()
                                      : static_cast<decltype(value)>(number);
            std::memcpy(samples + left * sizeof(value), &value, sizeof(value));
          }
        });
    });
}

template <class T>
const vtkDSMFileValues* GetValuesAs(vtkAbstractArray* array)
{
  auto* found = dynamic_cast<vtkDSMFileArray<T>*>(array);
  return found ? &found->GetFileValues() : nullptr;
}

template <class... T>
const vtkDSMFileValues* GetValuesAsAny(vtkAbstractArray* array)
{
  const vtkDSMFileValues* found = nullptr;
  static_cast<void>(((found = GetValuesAs<T>(array)) || ...));
  return found;
}

} // namespace

const vtkDSMFileValues* vtkDSMGetFileValues(vtkAbstractArray* array)
{
  return GetValuesAsAny<signed char, unsigned char, short, unsigned short, int, unsigned int,
    long long, unsigned long long, float, double>(array);
}

const vtkDSMFileValues* vtkDSMGetFileValues(vtkAbstractArray* array, const bricks::Index3& size)
{
  const vtkDSMFileValues* const values = vtkDSMGetFileValues(array);
  return values && values->GetBox().GetSize() == size ? values : nullptr;
}

vtkSmartPointer<vtkDataArray> vtkDSMCreateFileArray(
  const std::shared_ptr<const vtkDSMFileValues>& values)
{
  return DispatchType(values->GetType(),
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      auto array = vtkSmartPointer<vtkDSMFileArray<T>>::New();
      array->SetValues(values);
      return vtkSmartPointer<vtkDataArray>(array);
    });
}

vtkSmartPointer<vtkDataArray> vtkDSMReadFileArray(const vtkDSMFileValues& values)
{
  const vol::FileArray& array = values.GetArray();
  const bool isInteger = array.Type <= bricks::ScalarType::UInt64;
  const bricks::ScalarType type = !isInteger || !array.Valid.Exclude(array.Type) ? array.Type
    : bricks::GetBytes(array.Type) <= 2 ? bricks::ScalarType::Float32
                                        : bricks::ScalarType::Float64;
  const auto made = vtkSmartPointer<vtkDataArray>::Take(
    vtkDataArray::CreateDataArray(vtkDSMGetFileArrayType(type)));
  made->SetName(array.Name.c_str());
  made->SetNumberOfComponents(array.Components);
  const std::size_t count = static_cast<std::size_t>(values.GetCount() * array.Components);
  const std::size_t bytes = count * bricks::GetBytes(type);
  try
  {
    TakeRoom(bytes,
      [&]
      {
        made->SetNumberOfTuples(values.GetCount());
        std::memset(made->GetVoidPointer(0), 0, bytes);
      });
  }
  catch (const dsm::Error& error)
  {
    throw dsm::Error(DescribeArray(values) + error.what());
  }
  ReadAll(values, made->GetVoidPointer(0));
  if (type != array.Type)
  {
    WithoutMissing(array, count, type, static_cast<std::byte*>(made->GetVoidPointer(0)));
  }
  return made;
}

int vtkDSMGetFileArrayType(bricks::ScalarType type)
{
  return DispatchType(type,
    [](auto* null) { return vtkTypeTraits<std::remove_pointer_t<decltype(null)>>::VTKTypeID(); });
}
