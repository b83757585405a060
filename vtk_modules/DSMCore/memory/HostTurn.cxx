// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/memory/HostTurn.h"

#include <string>
#include <thread>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace dsm
{

namespace
{

/// -1 when there is no such file that other users cannot lock.
int OpenOwnFile()
{
  const uid_t user = geteuid();
  const std::string path = "/dev/shm/dsm-" + std::to_string(user) + ".lock";
  const int file = open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0600);
  struct stat status = {};
  if (file >= 0 &&
    (fstat(file, &status) != 0 || !S_ISREG(status.st_mode) || status.st_uid != user ||
      (status.st_mode & (S_IRWXG | S_IRWXO)) != 0))
  {
    close(file);
    return -1;
  }
  return file;
}

} // namespace

HostTurn::HostTurn(std::chrono::milliseconds patience)
  : File(OpenOwnFile())
{
  constexpr auto pause = std::chrono::milliseconds(1);
  const auto end = std::chrono::steady_clock::now() + patience;
  while (this->File >= 0 && flock(this->File, LOCK_EX | LOCK_NB) != 0 &&
    std::chrono::steady_clock::now() < end)
  {
    std::this_thread::sleep_for(pause);
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
