// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMProxyFinder_h
#define vtkPVDSMProxyFinder_h

class vtkObjectBase;
class vtkSMProxy;

/// From an object to the proxy that stands for it, on a process that has proxies: ParaView's client, and
/// rank 0 of pvbatch.
class vtkPVDSMProxyFinder
{
public:
  /// Also a proxy that is not registered yet: a state file's representations are in their view before
  /// it is. Null where the process has none.
  static vtkSMProxy* Find(vtkObjectBase* object);
};

#endif
