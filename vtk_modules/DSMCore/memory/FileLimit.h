// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_FileLimit_h
#define dsm_FileLimit_h

#include <sys/resource.h>

#include <cstdint>

namespace dsm
{

/// Returns the largest size in bytes that `ulimit -f` allows for files of this process, files in
/// memory included. A file that grows beyond it ends the process by a signal. Any thread.
inline std::uint64_t GetMostFileBytes()
{
  rlimit limit{};
  return getrlimit(RLIMIT_FSIZE, &limit) == 0 ? limit.rlim_cur : RLIM_INFINITY;
}

} // namespace dsm

#endif
