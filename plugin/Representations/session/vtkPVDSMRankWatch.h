// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMRankWatch_h
#define vtkPVDSMRankWatch_h

/// Reports to a server's clients which of its ranks has ended, where and why, before the connection ends: MPI ends all
/// ranks when one of them does. Each rank has a connection to the first one, which the system closes when the rank
/// ends; a rank that ends by a signal that it can handle sends its number before. The first rank ends by itself if MPI
/// has not ended it after some seconds, so that no client waits for it.
class vtkPVDSMRankWatch
{
public:
  /// Collective on a server; without effect in other processes. The first call begins to watch, until the process ends;
  /// each call takes note of the clients that are connected. Ranks that cannot be reached are not watched.
  static void Start();
};

#endif
