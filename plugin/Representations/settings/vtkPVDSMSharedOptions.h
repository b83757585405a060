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

/// Options of which there is one value for many proxies: the light of a view, which each display of the
/// view has among its properties, and the memory of a session, which each display and the settings page
/// have. Whichever is set, all of them have the value at once: the last word counts, and every panel
/// shows what holds. Lives where proxies do, the client and rank 0 of pvbatch; its thread is theirs.
///
/// A proxy that joins takes the values that hold. But where it has been given others than its
/// defaults, or (of the light) comes from a state file, these are the last word.
class vtkPVDSMSharedOptions
{
public:
  ~vtkPVDSMSharedOptions();
  vtkPVDSMSharedOptions(const vtkPVDSMSharedOptions&) = delete;
  vtkPVDSMSharedOptions& operator=(const vtkPVDSMSharedOptions&) = delete;

  /// The display whose options of light and memory these objects are on this process is traced in the
  /// view. Again does nothing; nor does it where there are no proxies.
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
  /// All others get the value of one.
  void Spread(vtkSMProxy* from, const std::string& name);
  void UpdateObjects();

  std::vector<std::string> Names; ///< of the properties
  /// The first has the values, whoever joins and leaves.
  std::vector<vtkSmartPointer<vtkSMProxy>> Proxies;
  vtkSmartPointer<vtkCommand> Observer;
  bool IsSpreading = false;
};

#endif
