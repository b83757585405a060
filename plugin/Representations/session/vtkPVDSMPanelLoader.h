// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMPanelLoader_h
#define vtkPVDSMPanelLoader_h

/// Brings the panel of the application along with the plugin. It is a plugin of its own, since it needs Qt, which
/// servers and scripts do without.
class vtkPVDSMPanelLoader
{
public:
  /// Called when the plugin is loaded and when a session begins. Does nothing in processes without ParaView's user
  /// interface, where the panel was not built, and where it is loaded already.
  static void Load();
};

#endif
