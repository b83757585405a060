// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/hdf/HdfLibrary.h"

#include "DSMCore/base/ReaderThreads.h"
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/hdf/HdfHeap.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <new>

namespace vol
{

namespace
{

std::atomic<bool> Ending{ false };

// The library's information about an object, or a link, has another type in each of its releases.

/// Result of a visit of all objects of a file. In a damaged file groups may contain one another.
struct Visit
{
  std::vector<std::string> Names;
  std::uint64_t Objects = 0;
};

/// Keeps a name that is `wanted`; a positive number ends the visit. The library calls it, and lets no exception
/// through.
herr_t Note(const char* name, bool wanted, void* data)
{
  auto& visit = *static_cast<Visit*>(data);
  try
  {
    if (wanted)
    {
      visit.Names.emplace_back(name);
    }
  }
  catch (const std::bad_alloc&)
  {
    return 1;
  }
  const std::size_t bytes = std::strlen(name);
  const bool goesOn = ++visit.Objects < FileLimits::Objects && bytes <= FileLimits::NameBytes &&
    std::count(name, name + bytes, '/') < FileLimits::GroupDepth;
  return goesOn ? 0 : 1;
}

template <class Info>
herr_t NoteObject(hid_t, const char* name, const Info* info, void* visit)
{
  return Note(name, info->type == H5O_TYPE_DATASET, visit);
}

template <class Info>
herr_t NoteLink(hid_t, const char* name, const Info* info, void* visit)
{
  return Note(name, info->type == H5L_TYPE_EXTERNAL, visit);
}

} // namespace

void WatchHdfEnd()
{
  // Called before what the library has asked to be called, which it did earlier. A thread that has
  // used HDF5 2.0 must end before that, or waits for ever.
  static dsm::ReaderThreads& threads = dsm::ReaderThreads::GetShared(); // lives longer
  [[maybe_unused]] static const int noted = std::atexit(
    []
    {
      Ending = true;
      threads.Stop();
    });
}

bool IsHdfEnding()
{
  return Ending;
}

std::mutex& GetHdfLock()
{
  static std::mutex lock;
  return lock;
}

std::vector<std::string> FindHdfDatasets(hid_t file, bool* areAll)
{
  Visit visit;
  const herr_t ended =
    H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, &NoteObject, &visit, H5O_INFO_BASIC);
  if (areAll)
  {
    *areAll = ended >= 0;
  }
  visit.Objects = 0;
  H5Lvisit(file, H5_INDEX_NAME, H5_ITER_INC, &NoteLink, &visit);
  return std::move(visit.Names);
}

hid_t GetHdfType(bricks::ScalarType type)
{
  // In the order of the types.
  const hid_t types[] = { H5T_NATIVE_INT8, H5T_NATIVE_UINT8, H5T_NATIVE_INT16, H5T_NATIVE_UINT16,
    H5T_NATIVE_INT32, H5T_NATIVE_UINT32, H5T_NATIVE_INT64, H5T_NATIVE_UINT64, H5T_NATIVE_FLOAT,
    H5T_NATIVE_DOUBLE };
  return types[static_cast<std::size_t>(type)];
}

bool IsHdfNumber(hid_t type)
{
  const H5T_class_t kind = H5Tget_class(type);
  if (kind == H5T_ENUM)
  {
    return IsHdfNumber(HdfHandle(H5Tget_super(type), &H5Tclose).Get());
  }
  const std::size_t bits = 8 * H5Tget_size(type);
  const auto isWithin = [=](std::size_t first, std::size_t count)
  { return first <= bits && count <= bits - first; };
  const int first = H5Tget_offset(type);
  if ((kind != H5T_INTEGER && kind != H5T_FLOAT) || first < 0 ||
    !isWithin(static_cast<std::size_t>(first), H5Tget_precision(type)))
  {
    return false;
  }
  std::size_t sign = 0;
  std::size_t exponent = 0;
  std::size_t exponentBits = 0;
  std::size_t fraction = 0;
  std::size_t fractionBits = 0;
  return kind == H5T_INTEGER ||
    (H5Tget_fields(type, &sign, &exponent, &exponentBits, &fraction, &fractionBits) >= 0 &&
      isWithin(sign, 1) && isWithin(exponent, exponentBits) && isWithin(fraction, fractionBits));
}

std::vector<double> ReadHdfNumbers(hid_t object, const char* name)
{
  const hssize_t count = HdfAttribute(object, name).Count;
  const bool isShort = count > 0 && static_cast<std::uint64_t>(count) <= FileLimits::Axes;
  std::vector<double> numbers(isShort ? static_cast<std::size_t>(count) : 0);
  return isShort && ReadHdfAttribute(object, name, H5T_NATIVE_DOUBLE, numbers.data(), count)
    ? numbers
    : std::vector<double>();
}

std::string ReadHdfText(hid_t object, const char* name)
{
  const std::vector<std::string> texts = ReadHdfTexts(object, name);
  return texts.size() == 1 ? texts.front() : std::string();
}

std::vector<std::string> ReadHdfTexts(hid_t object, const char* name)
{
  std::vector<std::string> texts;
  const HdfAttribute attribute(object, name);
  const hid_t type = attribute.Type.Get();
  const std::size_t bytes = H5Tget_size(type);
  if (attribute.Count < 1 || static_cast<std::uint64_t>(attribute.Count) > FileLimits::Axes ||
    H5Tget_class(type) != H5T_STRING || bytes > FileLimits::NameBytes)
  {
    return texts;
  }
  const auto all = static_cast<std::size_t>(attribute.Count);
  if (H5Tis_variable_str(type) > 0)
  {
    CheckHdfHeap(attribute.Id.Get(), all);
    std::vector<char*> read(all, nullptr);
    const bool isRead = H5Aread(attribute.Id.Get(), type, read.data()) >= 0;
    for (char* const text : read)
    {
      texts.emplace_back(isRead && text ? text : "");
      H5free_memory(text);
    }
    return texts;
  }
  std::vector<char> read(all * bytes + 1, '\0');
  if (H5Aread(attribute.Id.Get(), type, read.data()) >= 0)
  {
    for (std::size_t index = 0; index < all; ++index)
    {
      const char* const text = read.data() + index * bytes;
      texts.emplace_back(text, strnlen(text, bytes));
    }
  }
  return texts;
}

std::vector<std::string> FindHdfScales(hid_t file, hid_t dataset, std::size_t axes)
{
  std::vector<std::string> paths;
  const HdfAttribute attribute(dataset, "DIMENSION_LIST");
  const HdfHandle references(H5Tvlen_create(H5T_STD_REF_OBJ), &H5Tclose);
  std::vector<hvl_t> lists(axes);
  if (attribute.Count != static_cast<hssize_t>(axes) ||
    H5Tequal(attribute.Type.Get(), references.Get()) <= 0)
  {
    return paths;
  }
  CheckHdfHeap(attribute.Id.Get(), axes);
  if (H5Aread(attribute.Id.Get(), references.Get(), lists.data()) < 0)
  {
    return paths;
  }
  for (const hvl_t& list : lists)
  {
    const HdfHandle scale(list.len > 0 && list.p
        ? H5Rdereference2(file, H5P_DEFAULT, H5R_OBJECT, list.p)
        : H5I_INVALID_HID,
      &H5Oclose);
    paths.push_back(GetHdfText(&H5Iget_name, scale.Get()));
  }
  H5Dvlen_reclaim(references.Get(), attribute.Space.Get(), H5P_DEFAULT, lists.data());
  return paths;
}

HdfSilence::HdfSilence()
{
  H5Eget_auto2(H5E_DEFAULT, &this->Function, &this->Data);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

HdfSilence::~HdfSilence()
{
  // Each thread has errors of its own, and where a thread that is gone has left some, the library cannot end.
  H5Eclear2(H5E_DEFAULT);
  H5Eset_auto2(H5E_DEFAULT, this->Function, this->Data);
}

} // namespace vol
