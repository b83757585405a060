// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_HostTurn_h
#define dsm_HostTurn_h

#include <chrono>

namespace dsm
{

/// Lock that one thread of one process of this user on this host holds at a time, so that ranks query and
/// take memory one after another. Any thread. Hold it for a short time only: a process that has waited too
/// long continues without it, for example when the holder is stopped. All processes continue without it if
/// /dev/shm/dsm-UID.lock cannot be opened by this user exclusively.
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
