// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMOpaqueDepth_h
#define vtkDSMOpaqueDepth_h

#include "vtkNew.h"

#include <vector>

class vtkOpenGLFramebufferObject;
class vtkProp;
class vtkRenderer;
class vtkTextureObject;

/// How far rays come until opaque props of the application end them. The props are drawn for that, into a buffer of their
/// own, before the renderer draws them.
class vtkDSMOpaqueDepth
{
public:
  vtkDSMOpaqueDepth();
  ~vtkDSMOpaqueDepth();
  vtkDSMOpaqueDepth(const vtkDSMOpaqueDepth&) = delete;
  vtkDSMOpaqueDepth& operator=(const vtkDSMOpaqueDepth&) = delete;

  /// Window depth of the renderer's viewport, row by row from the bottom, of `width` x `height` pixels, each `pixelSize`
  /// pixels of the screen wide and high; 1 where there is nothing. Empty: there is nothing anywhere. For the thread that
  /// renders, while the window is current.
  std::vector<float> Read(vtkRenderer* renderer, const std::vector<vtkProp*>& props, int width,
    int height, int pixelSize);

private:
  vtkNew<vtkTextureObject> Color;
  vtkNew<vtkTextureObject> Depth;
  vtkNew<vtkOpenGLFramebufferObject> Buffer;
};

#endif
