// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMMemoryOptions.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkPVDSMMemoryOptions);

vtkPVDSMMemoryOptions::vtkPVDSMMemoryOptions() = default;
vtkPVDSMMemoryOptions::~vtkPVDSMMemoryOptions() = default;

void vtkPVDSMMemoryOptions::SetMemoryOrganization(int organization)
{
  this->Superclass::SetMemoryOrganization(organization);
}

void vtkPVDSMMemoryOptions::SetHostSharing(bool shared)
{
  this->Superclass::SetHostSharing(shared);
}

void vtkPVDSMMemoryOptions::SetMemory(int mebibytes)
{
  this->Superclass::SetMemory(mebibytes);
}

void vtkPVDSMMemoryOptions::SetScratchDirectory(const char* directory)
{
  this->Superclass::SetScratchDirectory(directory);
}

void vtkPVDSMMemoryOptions::SetCoarserDataWhileMoving(bool coarser)
{
  this->Superclass::SetCoarserDataWhileMoving(coarser);
}

void vtkPVDSMMemoryOptions::SetCacheSize(int mebibytes)
{
  if (mebibytes < 1)
  {
    vtkWarningMacro(
      "A cache of " << mebibytes << " MiB (DSMCacheSize) is too small: it has 1 MiB, the least.");
  }
  this->Superclass::SetCacheSize(mebibytes);
}

void vtkPVDSMMemoryOptions::SetNumberOfThreads(int threads)
{
  this->Superclass::SetNumberOfThreads(threads);
}

void vtkPVDSMMemoryOptions::SetScheduler(int scheduler)
{
  this->Superclass::SetScheduler(scheduler);
}

void vtkPVDSMMemoryOptions::SetSilenceLimit(int seconds)
{
  this->Superclass::SetSilenceLimit(seconds);
}
