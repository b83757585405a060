// SPDX-License-Identifier: BSD-3-Clause
/// Loaded into the ranks of a server before all else (LD_PRELOAD): notes, a few times a second, how many KiB of the
/// heap are in use, in a file that is named after the process, in the folder DSM_HEAP_NOTES. What a process holds
/// of the system is more, by what lies free between pieces in use, and differs from run to run; this does not.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include <malloc.h>
#include <unistd.h>

namespace
{

constexpr auto Pause = std::chrono::milliseconds(200);

void Note(const std::string& path)
{
  const std::string written = path + ".new";
  for (;; std::this_thread::sleep_for(Pause))
  {
    const struct mallinfo2 heap = mallinfo2();
    std::FILE* const file = std::fopen(written.c_str(), "w");
    if (!file)
    {
      return; // the test is over
    }
    std::fprintf(file, "%zu\n", (heap.uordblks + heap.hblkhd) / 1024);
    std::fclose(file);
    std::rename(written.c_str(), path.c_str());
  }
}

[[gnu::constructor]] void Start()
{
  if (const char* const folder = std::getenv("DSM_HEAP_NOTES"))
  {
    std::thread(Note, std::string(folder) + "/" + std::to_string(getpid())).detach();
  }
}

} // namespace
