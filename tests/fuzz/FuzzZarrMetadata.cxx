// SPDX-License-Identifier: BSD-3-Clause
// The metadata of Zarr, versions 2 and 3, with OME's attributes. The input has several files: each begins with a line
// "==> NAME", where NAME is one of those below; others are passed over.
#include "InputFolder.h"
#include "VolumeCheck.h"

#include <map>
#include <string>
#include <string_view>

namespace
{

constexpr const char* Names[] = { ".zarray", ".zattrs", ".zgroup", "zarr.json", "0.0.0", "c/0/0/0",
  "0/.zarray", "0/.zattrs", "0/.zgroup", "0/zarr.json", "0/0.0.0", "0/c/0/0/0", "1/.zarray",
  "1/.zattrs", "1/zarr.json", "a/.zarray", "a/.zattrs", "a/zarr.json", "a/0.0.0" };

std::map<std::string, std::string_view> Split(std::string_view text)
{
  constexpr std::string_view mark = "==> ";
  std::map<std::string, std::string_view> files;
  for (std::size_t at = text.find(mark); at != std::string_view::npos;)
  {
    const std::size_t name = at + mark.size();
    const std::size_t end = std::min(text.find('\n', name), text.size());
    const std::size_t next = text.find("\n==> ", end);
    const std::size_t first = std::min(end + 1, text.size());
    const std::size_t last = next == std::string_view::npos ? text.size() : next;
    files[std::string(text.substr(name, end - name))] =
      text.substr(first, last > first ? last - first : 0);
    at = next == std::string_view::npos ? next : next + 1;
  }
  return files;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count)
{
  static const std::filesystem::path folder = fuzz::GetInputFolder() / "input.zarr";
  static const bool isFirst = []
  {
    for (const char* name : Names)
    {
      std::filesystem::create_directories((folder / name).parent_path());
    }
    return true;
  }();
  static_cast<void>(isFirst);
  const auto files = Split({ reinterpret_cast<const char*>(bytes), count });
  for (const char* name : Names)
  {
    const auto found = files.find(name);
    if (found == files.end())
    {
      std::filesystem::remove(folder / name);
    }
    else
    {
      fuzz::WriteInput(folder / name, reinterpret_cast<const std::uint8_t*>(found->second.data()),
        found->second.size());
    }
  }
  fuzz::CheckLevels(folder);
  return 0;
}
