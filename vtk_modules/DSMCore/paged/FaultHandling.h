// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_FaultHandling_h
#define dsm_FaultHandling_h

namespace dsm
{

/// How a page store learns that a thread reads a page which is not here.
enum class FaultHandling
{
  Automatic,   ///< UserFaultFd where the kernel allows it, Signal otherwise
  UserFaultFd, ///< the kernel stops the thread and tells us (Linux, userfaultfd(2))
  Signal       ///< the thread gets SIGSEGV and waits in our handler
};

} // namespace dsm

#endif
