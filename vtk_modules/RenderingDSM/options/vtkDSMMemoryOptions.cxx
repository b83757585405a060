// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMMemoryOptions.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkDSMMemoryOptions);

vtkDSMMemoryOptions::vtkDSMMemoryOptions() = default;
vtkDSMMemoryOptions::~vtkDSMMemoryOptions() = default;

void vtkDSMMemoryOptions::SetScratchDirectory(const char* directory)
{
  const std::string wanted = directory ? directory : "";
  if (this->ScratchDirectory != wanted)
  {
    this->ScratchDirectory = wanted;
    this->Modified();
  }
}

void vtkDSMMemoryOptions::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MemoryOrganization: " << this->MemoryOrganization << "\n";
  os << indent << "HostSharing: " << this->HostSharing << "\n";
  os << indent << "Memory: " << this->Memory << " MiB\n";
  os << indent << "ScratchDirectory: " << this->ScratchDirectory << "\n";
  os << indent << "CoarserDataWhileMoving: " << this->CoarserDataWhileMoving << "\n";
  os << indent << "CacheSize: " << this->CacheSize << " MiB\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "Scheduler: " << this->Scheduler << "\n";
  os << indent << "SilenceLimit: " << this->SilenceLimit << "\n";
}
