// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/memory/HostTurn.h"

#include <thread>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace dsm
{

HostTurn::HostTurn(std::chrono::milliseconds patience)
  : Folder(open("/dev/shm", O_RDONLY | O_DIRECTORY | O_CLOEXEC)) // nothing has to be made there
{
  constexpr auto pause = std::chrono::milliseconds(1);
  const auto end = std::chrono::steady_clock::now() + patience;
  while (this->Folder >= 0 && flock(this->Folder, LOCK_EX | LOCK_NB) != 0 &&
    std::chrono::steady_clock::now() < end)
  {
    std::this_thread::sleep_for(pause);
  }
}

HostTurn::~HostTurn()
{
  if (this->Folder >= 0)
  {
    close(this->Folder);
  }
}

} // namespace dsm
