// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfLibrary_h
#define vol_HdfLibrary_h

#include "DSMRayTracing/base/ScalarType.h"

#include <hdf5.h>

#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace vol
{

/// Of a brick file: the group of coarser levels, numbered from 1 on, of which each is as a brick file.
constexpr char HdfLevels[] = "DSM/Levels";
/// Attribute of what it has beside an array's values: samples by which a chunk's halo reaches beyond it.
constexpr char HdfHalo[] = "HaloSamples";
/// Attribute of the group that has all of that for the points: the name of the array that are their scalars.
constexpr char HdfScalars[] = "Scalars";
/// And of chunks that are not compressed: HaloRecord of each.
constexpr char HdfHaloRecords[] = "Halos";

/// Registered filters (https://github.com/HDFGroup/hdf5_plugins).
constexpr H5Z_filter_t HdfBloscFilter = 32001;
constexpr H5Z_filter_t HdfZstdFilter = 32015;

/// To be held by who calls the library, which may have been built without a lock of its own.
std::mutex& GetHdfLock();

/// The library's name of the machine's own form of a type.
hid_t GetHdfType(rt::ScalarType type);

/// The names of what may be datasets, in all groups of a file, and behind external links. Under the lock.
std::vector<std::string> FindHdfDatasets(hid_t file);

/// After the library's first use: from then on the end of the process is noticed.
void WatchHdfEnd();
/// Whether the process ends, and the library closes all that is open by itself, perhaps has done so.
bool IsHdfEnding();

/// An identifier of the library's, closed with it. Under the lock.
class HdfHandle
{
public:
  using Closer = herr_t (*)(hid_t);
  /// Of nothing: not open.
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
  ~HdfHandle()
  {
    if (this->Id >= 0 && !IsHdfEnding())
    {
      this->Close(this->Id);
    }
  }
  HdfHandle(const HdfHandle&) = delete;
  HdfHandle& operator=(const HdfHandle&) = delete;

  bool IsOpen() const { return this->Id >= 0; }
  hid_t Get() const { return this->Id; }

private:
  hid_t Id = H5I_INVALID_HID;
  Closer Close = nullptr;
};

/// The library prints its errors, unless it is told not to; what went wrong is said by us.
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
