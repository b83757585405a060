// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMIsovalueWatch_h
#define vtkPVDSMIsovalueWatch_h

#include "vtkCommand.h"
#include "vtkSmartPointer.h"

#include <functional>

class vtkSMProperty;
class vtkSMProxy;

/// The isovalues of a view's datasets, on the client. An automatic isovalue becomes the one that the data suggest and the
/// picture shows. Where the data suggest none, it is the middle of their range. The isovalue of another array is automatic.
/// While the panel's slider of an isovalue or of a slice's index is dragged, the datasets already have the value that it is
/// at, which the property gets when it is let go.
class vtkPVDSMIsovalueWatch
{
public:
  /// `changed` is called when a dataset has another isovalue, other than by TakeSuggestion.
  explicit vtkPVDSMIsovalueWatch(std::function<void()> changed);
  ~vtkPVDSMIsovalueWatch();
  vtkPVDSMIsovalueWatch(const vtkPVDSMIsovalueWatch&) = delete;
  vtkPVDSMIsovalueWatch& operator=(const vtkPVDSMIsovalueWatch&) = delete;

  /// After a render of a traced dataset; meshes have no isovalue. A list of isovalues that the user begins has the single
  /// one first.
  void TakeSuggestion(vtkSMProxy* representation);
  /// From now on; the slider, too, in the application. Doing so again changes nothing.
  void Watch(vtkSMProxy* representation, bool isInApplication);

private:
  void OnEvent(vtkSMProperty* property, unsigned long event);
  void OnSlider(vtkSMProperty* single);
  void OnSliceIndex(vtkSMProperty* index);
  /// Whether a slider is dragged, or was until now. `differs`: it shows another value than is set.
  bool IsDragged(vtkSMProperty* property, bool differs);
  void OnList(vtkSMProperty* list, unsigned long event);
  void BeginList(vtkSMProxy* representation);
  void OnOtherArray(vtkSMProxy* representation);

  std::function<void()> Changed;
  vtkSmartPointer<vtkCommand> Observer;
  vtkSMProperty* Choice = nullptr;  ///< of an array or a component, while it becomes another
  vtkSMProperty* Begun = nullptr;   ///< a list to which the panel has added a first value
  vtkSMProperty* Dragged = nullptr; ///< what a slider shows another value of than is set
};

#endif
