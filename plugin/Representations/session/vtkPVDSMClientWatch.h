// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMClientWatch_h
#define vtkPVDSMClientWatch_h

#include <vector>

/// Detects, on a server's first process, that its client has sent something which the server has not read yet. One
/// thread.
class vtkPVDSMClientWatch
{
public:
  /// Finds the connection to the active client. Without one, nothing is ever detected.
  vtkPVDSMClientWatch();

  /// Takes a microsecond.
  bool HasSent() const;

  /// Returns the number of clients that are connected to this process: 0 on a client.
  static int CountClients();
  /// Returns the sockets of their connections.
  static std::vector<int> ListConnections();

private:
  int Descriptor = -1; ///< of the connection's socket
};

#endif
