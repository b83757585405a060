// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMFrameImage_h
#define vtkDSMFrameImage_h

#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/light/Environment.h"

class vtkImageData;

/// A frame as image data, for who has no window. Local.
namespace vtkDSMFrameImage
{
/// Fills `image` with a whole picture of `width` x `height` pixels, row 0 the lowest, as
/// vtkDSMScene::TraceImage tells. A picture without pixels shows nothing.
void Fill(vtkImageData* image, int width, int height, const rt::Picture& picture,
  const rt::Environment& background, bool transparent);
}

#endif
