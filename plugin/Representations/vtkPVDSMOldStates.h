// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMOldStates_h
#define vtkPVDSMOldStates_h

class vtkSMSessionProxyManager;

/// State files show what they showed: those from before there was a first look the plain one, and those from before there
/// was a switch for an automatic isovalue such an isovalue, where they had one.
class vtkPVDSMOldStates
{
public:
  /// To be called while the manager loads a state that has something of ours: at its end, what the file does not
  /// tell is set. Any number of times. On a process that has proxies.
  static void Watch(vtkSMSessionProxyManager* manager);
};

#endif
