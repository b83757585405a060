// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMOpenGLGuard_h
#define vtkDSMOpenGLGuard_h

#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkRenderWindow.h"

/// Leaves OpenGL as it was found: an application that shows progress and messages draws windows of its
/// own meanwhile.
class vtkDSMOpenGLGuard
{
public:
  explicit vtkDSMOpenGLGuard(vtkRenderWindow* window)
    : Window(vtkOpenGLRenderWindow::SafeDownCast(window))
  {
    if (this->Window && !this->Window->IsCurrent())
    {
      this->Window = nullptr; // nothing is being drawn
    }
    if (this->Window)
    {
      this->Window->GetState()->Push();
    }
  }
  ~vtkDSMOpenGLGuard()
  {
    if (this->Window)
    {
      this->Window->MakeCurrent();
      this->Window->GetState()->Pop();
    }
  }
  vtkDSMOpenGLGuard(const vtkDSMOpenGLGuard&) = delete;
  vtkDSMOpenGLGuard& operator=(const vtkDSMOpenGLGuard&) = delete;

private:
  vtkOpenGLRenderWindow* Window;
};

#endif
