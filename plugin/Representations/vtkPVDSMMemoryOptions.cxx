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

void vtkPVDSMMemoryOptions::SetCacheSize(int mebibytes)
{
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
