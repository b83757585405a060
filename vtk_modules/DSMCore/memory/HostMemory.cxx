// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/memory/HostMemory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace dsm
{

namespace
{

constexpr std::uint64_t Unknown = std::numeric_limits<std::uint64_t>::max();

std::uint64_t ReadNumber(const std::string& path)
{
  std::ifstream file(path);
  std::uint64_t value = 0;
  return file >> value ? value : Unknown; // "max" is not a number
}

/// The value behind a name in a file of lines such as "inactive_file 4096"; 0 without it.
std::uint64_t ReadNamed(const std::string& path, const std::string& wanted)
{
  std::ifstream file(path);
  std::string name;
  std::uint64_t value = 0;
  while (file >> name >> value)
  {
    if (name == wanted)
    {
      return value;
    }
  }
  return 0;
}

/// Returns the bytes left below a control group's limit. Cached files do not count, because the
/// system can drop them.
std::uint64_t GetLeft(
  const std::string& folder, const char* limitFile, const char* usageFile, const char* cacheName)
{
  const std::uint64_t limit = ReadNumber(folder + limitFile);
  const std::uint64_t usage = ReadNumber(folder + usageFile);
  if (limit == Unknown || usage == Unknown)
  {
    return Unknown;
  }
  const std::uint64_t cache = ReadNamed(folder + "/memory.stat", cacheName);
  const std::uint64_t used = usage - std::min(usage, cache);
  return limit - std::min(limit, used);
}

/// The least that the process's control group and those around it leave, of both versions.
std::uint64_t GetAvailableToGroup()
{
  std::uint64_t available = Unknown;
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);)
  {
    // number:controllers:path, without controllers in version 2
    const auto first = line.find(':');
    const auto second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos)
    {
      continue;
    }
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const bool unified = controllers.empty();
    if (!unified && ("," + controllers + ",").find(",memory,") == std::string::npos)
    {
      continue;
    }
    std::string path = line.substr(second + 1);
    while (true)
    {
      path = path == "/" ? "" : path;
      available = std::min(available,
        unified
          ? GetLeft("/sys/fs/cgroup" + path, "/memory.max", "/memory.current", "inactive_file")
          : GetLeft("/sys/fs/cgroup/memory" + path, "/memory.limit_in_bytes",
              "/memory.usage_in_bytes", "total_inactive_file"));
      if (path.empty())
      {
        break;
      }
      path = path.substr(0, path.rfind('/'));
    }
  }
  return available;
}

} // namespace

std::uint64_t GetAvailableHostMemory()
{
  std::ifstream file("/proc/meminfo");
  std::uint64_t kibibytes = 0;
  bool found = false;
  std::string name;
  std::uint64_t value = 0;
  while (file >> name >> value)
  {
    found |= name == "MemAvailable:";
    kibibytes += name == "MemAvailable:" || name == "SwapFree:" ? value : 0;
    file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return std::min(found ? kibibytes * 1024 : Unknown, GetAvailableToGroup());
}

std::string FormatMebibytes(std::uint64_t bytes)
{
  constexpr std::uint64_t mebibyte = std::uint64_t(1) << 20;
  return std::to_string(bytes / mebibyte + (bytes % mebibyte != 0 ? 1 : 0)) + " MiB";
}

} // namespace dsm
