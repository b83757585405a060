// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMStepStatistics_h
#define vtkPVDSMStepStatistics_h

#include "vtkRepresentationsDSMModule.h" // for the export macro

/// Before VTK 9.4, Temporal Statistics adds up wrongly, without a word, what is not in VTK's own arrays: readers of
/// volumes that come before such a filter are told to have their values in memory, as long as there is one.
class VTKREPRESENTATIONSDSM_EXPORT vtkPVDSMStepStatistics
{
public:
  /// Called when the plugin is loaded: from now on, in processes that have proxies.
  static void Load();
};

#endif
