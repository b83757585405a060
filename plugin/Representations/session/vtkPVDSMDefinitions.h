// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMDefinitions_h
#define vtkPVDSMDefinitions_h

#include "vtkRepresentationsDSMModule.h" // for the export macro

/// What the plugin adds to ParaView's own displays, and its settings: definitions of proxies of which client and server
/// need the classes. A client takes all definitions from its server, and ParaView ends with one whose class it does not
/// know, with the first dataset that is shown. So a server has these only when its client has asked for them, which a
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
