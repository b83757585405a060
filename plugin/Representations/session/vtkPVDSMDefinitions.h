// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMDefinitions_h
#define vtkPVDSMDefinitions_h

#include "vtkRepresentationsDSMModule.h" // for the export macro

/// Proxy definitions that the plugin adds to ParaView's own displays and settings. Client and
/// server both need their classes. A client takes all definitions from its server, and ParaView
/// crashes at the first dataset shown if it does not know the class of one. So a server loads these
/// definitions only when its client has asked for them; a client with the plugin does. All other
/// clients see no change.
/// client does that has the plugin, too; on all others nothing changes.
class VTKREPRESENTATIONSDSM_EXPORT vtkPVDSMDefinitions
{
public:
  /// Called when the plugin is loaded. In clients: from now on, sessions get them, as soon as their server has loaded
  /// the plugin. In batch processes: the own session gets them.
  static void Load();

  /// In a process of a server, on all ranks: its client has the plugin.
  static void Allow();
};

#endif
