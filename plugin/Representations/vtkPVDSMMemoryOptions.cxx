// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMMemoryOptions.h"

#include "vtkObjectFactory.h"

#include <algorithm>
#include <map>
#include <string>

namespace
{

/// What a setting gets that takes numbers from `least` to `most`. Where that is not `value`, `tell` is called with
/// what to say; once, however many displays pass the same number on, until another one is set.
template <class Tell>
int KeepWithin(const std::string& setting, int value, int least, int most, const Tell& tell)
{
  static std::map<std::string, int> told;
  const int kept = std::clamp(value, least, most);
  if (kept == value)
  {
    told.erase(setting);
    return kept;
  }
  const auto [entry, isNew] = told.emplace(setting, value);
  if (isNew || entry->second != value)
  {
    entry->second = value;
    tell(setting + " cannot be " + std::to_string(value) + ": it is " + std::to_string(kept) +
      ", the " + (value < least ? "least." : "most."));
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
  this->Superclass::SetMemory(KeepWithin("Memory per rank in MiB (DSMMemory; 0: automatic)",
    mebibytes, 0, VTK_INT_MAX, [this](const std::string& text) { vtkWarningMacro(<< text); }));
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
  this->Superclass::SetCacheSize(KeepWithin("The cache in MiB (DSMCacheSize)", mebibytes, 1,
    VTK_INT_MAX, [this](const std::string& text) { vtkWarningMacro(<< text); }));
}

void vtkPVDSMMemoryOptions::SetNumberOfThreads(int threads)
{
  this->Superclass::SetNumberOfThreads(
    KeepWithin("The number of threads (DSMThreads; 0: automatic)", threads, 0, MostThreads,
      [this](const std::string& text) { vtkWarningMacro(<< text); }));
}

void vtkPVDSMMemoryOptions::SetScheduler(int scheduler)
{
  this->Superclass::SetScheduler(scheduler);
}

void vtkPVDSMMemoryOptions::SetSilenceLimit(int seconds)
{
  this->Superclass::SetSilenceLimit(
    KeepWithin("The silence limit in seconds (DSMSilenceLimit; 0: none)", seconds, 0, VTK_INT_MAX,
      [this](const std::string& text) { vtkWarningMacro(<< text); }));
}
