// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_HostTurn_h
#define dsm_HostTurn_h

#include <chrono>

namespace dsm
{

/// While it lives, no other process of this user on this host has one, and no other thread of this process: ranks that ask
/// how much memory is left, and take some of it, do so one after another. Any thread. To be held for a short time only: who
/// has waited for so long goes on without, such as for a process that is stopped; so does everybody where no file
/// /dev/shm/dsm-UID.lock can be had that only this user can open.
class HostTurn
{
public:
  explicit HostTurn(std::chrono::milliseconds patience = std::chrono::seconds(20));
  ~HostTurn();
  HostTurn(const HostTurn&) = delete;
  HostTurn& operator=(const HostTurn&) = delete;

private:
  int File; ///< locked
};

} // namespace dsm

#endif
