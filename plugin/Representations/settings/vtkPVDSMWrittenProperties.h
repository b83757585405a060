// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMWrittenProperties_h
#define vtkPVDSMWrittenProperties_h

class vtkSMProxy;

/// Keeps the plugin's properties out of the Python states and traces of datasets that are shown in another way, where
/// they have no effect: a state that names them needs the plugin.
class vtkPVDSMWrittenProperties
{
public:
  /// Chooses by how the display is shown now.
  static void Choose(vtkSMProxy* display);
};

#endif
