// SPDX-License-Identifier: BSD-3-Clause
#ifndef fuzz_FuzzedHdf_h
#define fuzz_FuzzedHdf_h

#include "CrashNotes.h"
#include "InputFolder.h"
#include "VolumeCheck.h"

#include <hdf5.h>

#include <vector>

namespace fuzz
{

/// CheckLevels of an HDF5 file, which may have values in the file "values.bin" beside it.
inline void CheckHdf(const char* name, const std::uint8_t* bytes, std::size_t count)
{
  static const bool isThere = []
  {
    const std::vector<std::uint8_t> values(4096, 17);
    WriteInput(GetInputFolder() / "values.bin", values.data(), values.size());
    return true;
  }();
  const std::filesystem::path path = GetInputFolder() / name;
  WriteInput(path, bytes, count);
  LimitTime(5); // libFuzzer cannot tell what takes so long
  CheckLevels(path);
  LimitTime(0);
  static_cast<void>(isThere);
  // The readers close what they open; functions of the library that fail do not always, such as H5Ovisit. The next
  // input must not find this one's file.
  if (H5Fget_obj_count(static_cast<hid_t>(H5F_OBJ_ALL), H5F_OBJ_ALL) > 0)
  {
    BlameLibrary("objects of the file are still open\n");
  }
}

} // namespace fuzz

#endif
