// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfLibrary_h
#define vol_HdfLibrary_h

#include "DSMBricks/base/ScalarType.h"

#include "DSMVolumeFiles/base/FileLimits.h"

#include <hdf5.h>

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace vol
{

/// Group of coarser levels in a brick file. They are numbered from 1 on; each is like a brick file.
constexpr char HdfLevels[] = "DSM/Levels";
/// Attribute of what it has beside an array's values: samples by which a chunk's halo reaches beyond it.
constexpr char HdfHalo[] = "HaloSamples";
/// Attribute of the group that has all of that for the points, and of VTK's group of their values: the name of the
/// array that are their scalars.
constexpr char HdfScalars[] = "Scalars";
/// Dataset of the halos of chunks that are not compressed: a HaloRecord of each.
constexpr char HdfHaloRecords[] = "Halos";

/// Callers of the library must hold it: the library may have been built without a lock of its own.
std::mutex& GetHdfLock();

/// The library's name of the machine's own form of a type.
hid_t GetHdfType(bricks::ScalarType type);

/// Returns whether a type is a number whose bits, and the fields of a float, are within its bytes. The library
/// (1.10) does not check this, and converts with memory outside of the number. Under the lock.
bool IsHdfNumber(hid_t type);

/// The names of what may be datasets, in all groups of a file, and behind external links. `areAll`: set to false
/// where an object cannot be read, so that others may not be found. Under the lock.
std::vector<std::string> FindHdfDatasets(hid_t file, bool* areAll = nullptr);

/// After the library's first use: from then on the end of the process is noticed.
void WatchHdfEnd();
/// Returns whether the process is exiting, so that the library closes all open identifiers by itself or has done
/// so.
bool IsHdfEnding();

/// An identifier of the library's, closed with it. Under the lock.
class HdfHandle
{
public:
  using Closer = herr_t (*)(hid_t);
  /// An empty handle: not open.
  HdfHandle() = default;
  HdfHandle(hid_t id, Closer closer)
    : Id(id)
    , Close(closer)
  {
    WatchHdfEnd();
  }
  HdfHandle(HdfHandle&& other) noexcept
    : Id(std::exchange(other.Id, H5I_INVALID_HID))
    , Close(other.Close)
  {
  }
  ~HdfHandle() { this->Reset(); }
  HdfHandle(const HdfHandle&) = delete;
  HdfHandle& operator=(const HdfHandle&) = delete;

  bool IsOpen() const { return this->Id >= 0; }
  hid_t Get() const { return this->Id; }
  /// Closes it now.
  void Reset()
  {
    const hid_t id = std::exchange(this->Id, H5I_INVALID_HID);
    if (id >= 0 && !IsHdfEnding())
    {
      this->Close(id);
    }
  }

private:
  hid_t Id = H5I_INVALID_HID;
  Closer Close = nullptr;
};

/// All of a dataset, whose numbers become those of `type`. Returns false, and `out` is empty, where it has more
/// than `most` numbers, which are not read. Empty where there is no such dataset, too, or it has no numbers, or it
/// cannot be read. Under the lock.
template <class T>
bool ReadHdfWhole(
  hid_t group, const char* name, hid_t type, std::uint64_t most, std::vector<T>& out)
{
  out.clear();
  const HdfHandle dataset(H5Dopen2(group, name, H5P_DEFAULT), &H5Dclose);
  if (!dataset.IsOpen())
  {
    return true;
  }
  const HdfHandle space(H5Dget_space(dataset.Get()), &H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space.Get());
  if (count > 0 && static_cast<std::uint64_t>(count) > most)
  {
    return false;
  }
  out.resize(static_cast<std::size_t>(std::max<hssize_t>(0, count)));
  const HdfHandle stored(H5Dget_type(dataset.Get()), &H5Tclose);
  if (!IsHdfNumber(stored.Get()) ||
    H5Dread(dataset.Get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data()) < 0)
  {
    out.clear();
  }
  return true;
}

/// Returns a text from a function of the library that first returns the text's length: `get(arguments..., to, size)`.
/// Empty if it fails, or if the text is longer than FileLimits::NameBytes. Under the lock.
template <class Get, class... Arguments>
std::string GetHdfText(const Get& get, Arguments... arguments)
{
  const ssize_t length = get(arguments..., nullptr, 0);
  if (length < 0 || static_cast<std::size_t>(length) > FileLimits::NameBytes)
  {
    return {};
  }
  std::string text(static_cast<std::size_t>(length) + 1, '\0');
  const ssize_t got = get(arguments..., text.data(), text.size());
  text.resize(got < 0 ? 0 : static_cast<std::size_t>(length));
  return text;
}

/// An attribute of an object, with its type, its space and the number of its elements; -1: there is no such attribute.
/// Under the lock.
struct HdfAttribute
{
  HdfHandle Id;
  HdfHandle Type;
  HdfHandle Space;
  hssize_t Count;

  HdfAttribute(hid_t object, const char* name)
    : Id(H5Aexists(object, name) > 0 ? H5Aopen(object, name, H5P_DEFAULT) : H5I_INVALID_HID,
        &H5Aclose)
    , Type(H5Aget_type(this->Id.Get()), &H5Tclose)
    , Space(H5Aget_space(this->Id.Get()), &H5Sclose)
    , Count(H5Sget_simple_extent_npoints(this->Space.Get()))
  {
  }
};

/// False where there is no such attribute, or not with so many numbers. Under the lock.
template <class T>
bool ReadHdfAttribute(hid_t object, const char* name, hid_t type, T* out, hssize_t count)
{
  const HdfAttribute attribute(object, name);
  return attribute.Count == count && IsHdfNumber(attribute.Type.Get()) &&
    H5Aread(attribute.Id.Get(), type, out) >= 0;
}

/// An attribute's numbers; none where there is no such attribute, or it has more than the axes of a dataset, or
/// others than numbers. Under the lock.
std::vector<double> ReadHdfNumbers(hid_t object, const char* name);

/// An attribute's text; empty if the attribute is missing or is not a text. Under the lock.
std::string ReadHdfText(hid_t object, const char* name);
/// An attribute's texts; none where there is no such attribute, or it has more than the axes of a dataset, or no
/// texts. Under the lock.
std::vector<std::string> ReadHdfTexts(hid_t object, const char* name);

/// Paths of the dimension scales of a dataset of so many axes, the first one of each axis; empty of an axis that
/// has none. None where the dataset has no list of scales. Under the lock.
std::vector<std::string> FindHdfScales(hid_t file, hid_t dataset, std::size_t axes);

/// Suppresses the library's own error output; this code reports the errors.
class HdfSilence
{
public:
  HdfSilence();
  ~HdfSilence();
  HdfSilence(const HdfSilence&) = delete;
  HdfSilence& operator=(const HdfSilence&) = delete;

private:
  H5E_auto2_t Function = nullptr;
  void* Data = nullptr;
};

} // namespace vol

#endif
