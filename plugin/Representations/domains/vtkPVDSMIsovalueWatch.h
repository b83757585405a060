// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMIsovalueWatch_h
#define vtkPVDSMIsovalueWatch_h

#include "vtkCommand.h"
#include "vtkSmartPointer.h"

#include <functional>

class vtkSMProperty;
class vtkSMProxy;

/// Watches the isovalues of a view's datasets, on the client. An automatic isovalue is set to the value that
/// the data suggest and the image shows. If the data suggest none, it is the middle of their range. When
/// another array is selected, its isovalue is automatic. While the user drags the panel's slider of an
/// isovalue or of a slice index, the datasets already show its value; the property gets it on release.
class vtkPVDSMIsovalueWatch
{
public:
  /// `changed` is called when a dataset has another isovalue, other than by TakeSuggestion.
  explicit vtkPVDSMIsovalueWatch(std::function<void()> changed);
  ~vtkPVDSMIsovalueWatch();
  vtkPVDSMIsovalueWatch(const vtkPVDSMIsovalueWatch&) = delete;
  vtkPVDSMIsovalueWatch& operator=(const vtkPVDSMIsovalueWatch&) = delete;

  /// After a render of a traced dataset; meshes and outer surfaces have no isovalue. Slices get
  /// their indices. A list of isovalues that the user begins has the single one first.
  void TakeSuggestion(vtkSMProxy* representation);
  /// From now on; the slider, too, in the application. Doing so again changes nothing.
  void Watch(vtkSMProxy* representation, bool isInApplication);

private:
  void OnEvent(vtkSMProperty* property, unsigned long event);
  void OnSlider(vtkSMProperty* single);
  void OnSliceIndex(vtkSMProperty* index);
  /// Returns whether a slider is being dragged, or was until now. `differs`: its value differs from the property's.
  bool IsDragged(vtkSMProperty* property, bool differs);
  void OnList(vtkSMProperty* list, unsigned long event);
  void BeginList(vtkSMProxy* representation);
  void OnOtherArray(vtkSMProxy* representation);

  std::function<void()> Changed;
  vtkSmartPointer<vtkCommand> Observer;
  vtkSMProperty* Choice = nullptr; ///< choice of an array or component, while it is changing
  vtkSMProperty* Begun = nullptr;  ///< a list to which the panel has added a first value
  vtkSMProperty* Dragged =
    nullptr; ///< property whose slider shows a value that differs from its own
};

#endif
