// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMSharedOptions_h
#define vtkPVDSMSharedOptions_h

#include "vtkSmartPointer.h"

#include <string>
#include <vector>

class vtkCommand;
class vtkObjectBase;
class vtkPVRenderView;
class vtkSMProxy;

/// Keeps the properties of displays alike that belong to a view (its light) or to a session (its memory, which the
/// settings page has, too). A display or page that gets a value passes it on to all others at once, so every panel shows
/// the value that applies: the most recent one. On processes that have proxies: the client, and rank 0 of pvbatch.
///
/// A display that joins gets the current values. It passes on its own where they are neither the defaults nor the
/// settings page's, and, of light, where a state file is being loaded.
class vtkPVDSMSharedOptions
{
public:
  ~vtkPVDSMSharedOptions();
  vtkPVDSMSharedOptions(const vtkPVDSMSharedOptions&) = delete;
  vtkPVDSMSharedOptions& operator=(const vtkPVDSMSharedOptions&) = delete;

  /// The display with these options is traced in the view. Does nothing if it has joined already, or where there are no
  /// proxies.
  static void Join(vtkPVRenderView* view, vtkObjectBase* light, vtkObjectBase* memory);

  /// The display with these options is no longer in the view.
  static void Leave(vtkPVRenderView* view, vtkObjectBase* light, vtkObjectBase* memory);

private:
  struct Registry;

  /// `values` has the values while no display has joined. All properties of `like` are shared, except those with the
  /// hint DSMOfDataset.
  vtkPVDSMSharedOptions(vtkSMProxy* values, vtkSMProxy* like);

  void Add(vtkSMProxy* proxy, bool speaks);
  void Remove(vtkObjectBase* object);
  void OnChange(vtkSMProxy* proxy, const char* name);
  /// Copies one proxy's value to all others.
  void Spread(vtkSMProxy* from, const std::string& name);
  void UpdateObjects();

  std::vector<std::string> Names; ///< names of the properties
  /// The first keeps the values while displays join and leave.
  std::vector<vtkSmartPointer<vtkSMProxy>> Proxies;
  vtkSmartPointer<vtkCommand> Observer;
  bool IsSpreading = false;
};

#endif
