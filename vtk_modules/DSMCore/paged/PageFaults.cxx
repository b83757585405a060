// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/paged/PageFaults.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/paged/SignalFaults.h"
#include "DSMCore/paged/UserFaultFd.h"

namespace dsm
{

std::unique_ptr<PageFaults> PageFaults::Create(FaultHandling handling)
{
  std::string refusal;
  if (handling != FaultHandling::Signal)
  {
    try
    {
      return std::make_unique<UserFaultFd>();
    }
    catch (const Error& error)
    {
      if (handling == FaultHandling::UserFaultFd)
      {
        throw;
      }
      refusal = error.what();
    }
  }
  return std::make_unique<SignalFaults>(refusal);
}

} // namespace dsm
