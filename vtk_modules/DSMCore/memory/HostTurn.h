// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_HostTurn_h
#define dsm_HostTurn_h

namespace dsm
{

/// While it lives, no other process of this user on this host has one, and no other thread of this process: ranks that ask
/// how much memory is left, and take some of it, do so one after another. Where the host has nothing to share for that,
/// nobody waits. To be held for a short time only. An empty file of shared memory stays.
class HostTurn
{
public:
  HostTurn();
  ~HostTurn();
  HostTurn(const HostTurn&) = delete;
  HostTurn& operator=(const HostTurn&) = delete;

private:
  int File; ///< locked
};

} // namespace dsm

#endif
