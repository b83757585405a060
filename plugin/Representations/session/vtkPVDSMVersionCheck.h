// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMVersionCheck_h
#define vtkPVDSMVersionCheck_h

class vtkSMSession;

/// Client and server have a plugin each. An older one would silently ignore properties that a newer one on the
/// other side offers.
class vtkPVDSMVersionCheck
{
public:
  /// On the client: warns, once for each pair of versions, when the session's server has another version
  /// of the plugin. Nothing to do where the server is this process.
  static void Run(vtkSMSession* session);
};

#endif
