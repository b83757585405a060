// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMDrawing.h"

#include "vtkPVRenderingCapabilitiesInformation.h"
#include "vtkRenderWindow.h"
#include "vtkSmartPointer.h"

#include <dlfcn.h>

bool vtkPVDSMDrawing::IsPossible()
{
  using Capabilities = vtkPVRenderingCapabilitiesInformation;
  const vtkTypeUInt32 local = Capabilities::GetLocalCapabilities();
  if (Capabilities::Supports(local, Capabilities::ONSCREEN_RENDERING) ||
    !Capabilities::Supports(local, Capabilities::RENDERING))
  {
    return Capabilities::Supports(local, Capabilities::RENDERING);
  }
  static const bool chosen = []
  {
    auto window = Capabilities::NewOffscreenRenderWindow();
    return window &&
      (!window->IsA("vtkOSOpenGLRenderWindow") || dlsym(RTLD_DEFAULT, "OSMesaCreateContext"));
  }();
  return chosen;
}
