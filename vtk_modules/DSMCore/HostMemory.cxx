// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/HostMemory.h"

#include <fstream>
#include <limits>
#include <string>

namespace dsm
{

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
  return found ? kibibytes * 1024 : std::numeric_limits<std::uint64_t>::max();
}

} // namespace dsm
