// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMColorWatch_h
#define vtkPVDSMColorWatch_h

#include "vtkCommand.h"
#include "vtkSmartPointer.h"
#include "vtkWeakPointer.h"

#include <vector>

class vtkSMProxy;

/// Watches the arrays that color a view's datasets, on the client. ParaView colors a new dataset by its
/// active scalars. When the data lose that array, they are colored by their current scalars, or not at all,
/// before they are rendered. An array other than the active scalars is the user's choice, and stays.
class vtkPVDSMColorWatch
{
public:
  vtkPVDSMColorWatch();
  ~vtkPVDSMColorWatch();
  vtkPVDSMColorWatch(const vtkPVDSMColorWatch&) = delete;
  vtkPVDSMColorWatch& operator=(const vtkPVDSMColorWatch&) = delete;

  /// After a render of a traced dataset.
  void Note(vtkSMProxy* representation);

private:
  void OnData(vtkSMProxy* producer);

  vtkSmartPointer<vtkCommand> Observer;
  std::vector<vtkWeakPointer<vtkSMProxy>> Automatic; ///< datasets that the active scalars color
};

#endif
