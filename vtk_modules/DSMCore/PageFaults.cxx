// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/PageFaults.h"

#include "DSMCore/Error.h"
#include "DSMCore/SignalFaults.h"
#include "DSMCore/UserFaultFd.h"

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
