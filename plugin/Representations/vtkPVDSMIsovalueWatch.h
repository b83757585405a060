// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMIsovalueWatch_h
#define vtkPVDSMIsovalueWatch_h

#include "vtkCommand.h"
#include "vtkSmartPointer.h"

#include <functional>

class vtkSMProperty;
class vtkSMProxy;

/// The single isovalues of a view's datasets, on the client: one that nobody has set becomes the one
/// that the data suggest and the picture shows; and while the panel's slider is dragged, the datasets
/// already have the value that it is at, which the property gets when it is let go.
class vtkPVDSMIsovalueWatch
{
public:
  /// `changed` is called when a dataset has another isovalue, other than by TakeSuggestion.
  explicit vtkPVDSMIsovalueWatch(std::function<void()> changed);
  ~vtkPVDSMIsovalueWatch();
  vtkPVDSMIsovalueWatch(const vtkPVDSMIsovalueWatch&) = delete;
  vtkPVDSMIsovalueWatch& operator=(const vtkPVDSMIsovalueWatch&) = delete;

  /// After a render of a traced dataset; meshes have no isovalue. Where the dataset came after its display, the
  /// array and the box to crop to, which are empty then, become what they would have been, too.
  void TakeSuggestion(vtkSMProxy* representation);
  /// From now on. Doing so again changes nothing.
  void Watch(vtkSMProxy* representation);

private:
  void OnChange(vtkSMProperty* single);

  std::function<void()> Changed;
  vtkSmartPointer<vtkCommand> Observer;
  bool IsTaking = false;
};

#endif
