// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMProgressGuard_h
#define vtkPVDSMProgressGuard_h

#include "vtkDSMOpenGLGuard.h"

#include "vtkObject.h"
#include "vtkWeakPointer.h"

#include <optional>

class vtkPVProgressHandler;
class vtkRenderWindow;

/// Keeps a view's window ready to be drawn in while the application shows progress. A client that waits
/// for the server's picture, in the middle of its own render, hears of the server's progress (bricks are
/// built within a frame); the application repaints its progress bar at once, and with it leaves OpenGL to
/// another context, in which the picture would be drawn. Lives on the client, on the application's thread.
class vtkPVDSMProgressGuard : public vtkObject
{
public:
  static vtkPVDSMProgressGuard* New();
  vtkTypeMacro(vtkPVDSMProgressGuard, vtkObject);

  /// Once: guards `window` while others hear of progress from `handler`. Either may be gone first.
  void Watch(vtkPVProgressHandler* handler, vtkRenderWindow* window);

protected:
  vtkPVDSMProgressGuard() = default;
  ~vtkPVDSMProgressGuard() override;

private:
  vtkPVDSMProgressGuard(const vtkPVDSMProgressGuard&) = delete;
  void operator=(const vtkPVDSMProgressGuard&) = delete;

  void Begin();
  void End();

  vtkWeakPointer<vtkPVProgressHandler> Handler;
  vtkWeakPointer<vtkRenderWindow> Window;
  std::optional<vtkDSMOpenGLGuard> Guard;
  unsigned long First = 0; ///< observers
  unsigned long Last = 0;
};

#endif
