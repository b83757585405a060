// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMStepStatistics_h
#define vtkPVDSMStepStatistics_h

class vtkSIProxyDefinitionManager;

/// Before VTK 9.4, vtkTemporalStatistics silently computes wrong sums of arrays that are not VTK's own, such as
/// those of vtkDSMVolumeReader.
class vtkPVDSMStepStatistics
{
public:
  /// From now on, ParaView's filter Temporal Statistics copies such arrays of a time step before it adds them up. On
  /// processes that have the filter. Does nothing where VTK is newer.
  static void Replace(vtkSIProxyDefinitionManager* definitions);
};

#endif
