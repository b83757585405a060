// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_FileLimit_h
#define dsm_FileLimit_h

#include <sys/resource.h>

#include <cstdint>

namespace dsm
{

/// What `ulimit -f` lets files of this process have, those in memory, too: to grow beyond it would end the process by a
/// signal. Any thread.
inline std::uint64_t GetMostFileBytes()
{
  rlimit limit{};
  return getrlimit(RLIMIT_FSIZE, &limit) == 0 ? limit.rlim_cur : RLIM_INFINITY;
}

} // namespace dsm

#endif
