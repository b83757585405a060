// SPDX-License-Identifier: BSD-3-Clause
#ifndef fuzz_FuzzedHeader_h
#define fuzz_FuzzedHeader_h

#include "InputFolder.h"
#include "VolumeCheck.h"

#include <cstdlib>
#include <filesystem>
#include <vector>

namespace fuzz
{

/// CheckVolume of a file with a text header, which may refer to values in the file "values.bin" beside it.
inline void CheckHeader(const char* name, const std::uint8_t* bytes, std::size_t count)
{
  static const bool isThere = []
  {
    const std::vector<std::uint8_t> values(4096, 17);
    WriteInput(GetInputFolder() / "values.bin", values.data(), values.size());
    setenv("XDG_CACHE_HOME", (GetInputFolder() / "caches").c_str(), 1);
    return true;
  }();
  const std::filesystem::path path = GetInputFolder() / name;
  WriteInput(path, bytes, count);
  CheckVolume(path);
  std::filesystem::remove_all(GetInputFolder() / "caches"); // copies of unpacked values
  static_cast<void>(isThere);
}

} // namespace fuzz

#endif
