// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMMemoryOptions.h"

#include "vtkObjectFactory.h"

#include <algorithm>
#include <map>
#include <string>

namespace
{

/// What a setting gets that takes numbers from `least` to `most`. Where that is not `value`, it is told; once, however
/// many displays pass the same number on, until the one that told gets another. New displays have numbers of their own
/// for a moment.
int KeepWithin(
  vtkPVDSMMemoryOptions* options, const std::string& setting, int value, int least, int most)
{
  struct Telling
  {
    int Value;
    const vtkPVDSMMemoryOptions* Options;
  };
  static std::map<std::string, Telling> told;
  const auto before = told.find(setting);
  const int kept = std::clamp(value, least, most);
  if (kept == value)
  {
    if (before != told.end() && before->second.Options == options)
    {
      told.erase(before);
    }
    return kept;
  }
  if (before == told.end() || before->second.Value != value)
  {
    told[setting] = { value, options };
    vtkWarningWithObjectMacro(options, << setting << " cannot be " << value << ": it is " << kept
                                       << ", the " << (value < least ? "least." : "most."));
  }
  return kept;
}

} // namespace

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
  this->Superclass::SetMemory(KeepWithin(
    this, "Memory per rank in MiB (DSMMemory; 0: automatic)", mebibytes, 0, VTK_INT_MAX));
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
  this->Superclass::SetCacheSize(
    KeepWithin(this, "The cache in MiB (DSMCacheSize)", mebibytes, 1, VTK_INT_MAX));
}

void vtkPVDSMMemoryOptions::SetNumberOfThreads(int threads)
{
  this->Superclass::SetNumberOfThreads(
    KeepWithin(this, "The number of threads (DSMThreads; 0: automatic)", threads, 0, MostThreads));
}

void vtkPVDSMMemoryOptions::SetScheduler(int scheduler)
{
  this->Superclass::SetScheduler(scheduler);
}

void vtkPVDSMMemoryOptions::SetSilenceLimit(int seconds)
{
  this->Superclass::SetSilenceLimit(KeepWithin(
    this, "The silence limit in seconds (DSMSilenceLimit; 0: none)", seconds, 0, VTK_INT_MAX));
}
