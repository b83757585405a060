// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/memory/HostTurn.h"

#include <cerrno>
#include <string>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <unistd.h>

namespace dsm
{

HostTurn::HostTurn()
  : File(shm_open(
      ("/dsm-ray-tracer-turn-" + std::to_string(getuid())).c_str(), O_RDWR | O_CREAT, 0600))
{
  while (this->File >= 0 && flock(this->File, LOCK_EX) != 0 && errno == EINTR)
  {
  }
}

HostTurn::~HostTurn()
{
  if (this->File >= 0)
  {
    close(this->File);
  }
}

} // namespace dsm
