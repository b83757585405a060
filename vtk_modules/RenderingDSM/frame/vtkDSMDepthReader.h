// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMDepthReader_h
#define vtkDSMDepthReader_h

#include "vtkNew.h"

#include <vector>

class vtkOpenGLFramebufferObject;
class vtkProp;
class vtkRenderer;
class vtkRenderPass;
class vtkTextureObject;

/// Finds how far away props of the application are: where opaque ones end rays, and where translucent ones cut
/// media into layers. The props are drawn for that, into a buffer of its own, before the renderer draws them.
///
/// Pictures hold window depths of the renderer's viewport, row by row from the bottom, of `width` x `height`
/// pixels, each `pixelSize` pixels of the screen wide and high; 1 where there is nothing. For the thread that
/// renders, while the window is current.
class vtkDSMDepthReader
{
public:
  vtkDSMDepthReader();
  ~vtkDSMDepthReader();
  vtkDSMDepthReader(const vtkDSMDepthReader&) = delete;
  vtkDSMDepthReader& operator=(const vtkDSMDepthReader&) = delete;

  /// The depth of what is opaque. Empty: there is nothing anywhere.
  std::vector<float> ReadOpaque(vtkRenderer* renderer, const std::vector<vtkProp*>& props,
    int width, int height, int pixelSize);

  /// Translucent surfaces of a pixel that count, from the front.
  static constexpr int MaxSurfaces = 4;
  /// Surfaces of a pixel that are nearer to one another count as one.
  static constexpr float SurfaceDistance = 1e-6f;

  /// The depths of what is translucent: as many pictures, one after the other, as a pixel has surfaces, at most
  /// MaxSurfaces; the nearest first.
  std::vector<float> ReadTranslucent(vtkRenderer* renderer, const std::vector<vtkProp*>& props,
    int width, int height, int pixelSize);

private:
  class Peeling;
  void Begin(vtkRenderer* renderer);
  void Draw(vtkRenderer* renderer, const std::vector<vtkProp*>& props, vtkRenderPass* pass);
  /// Adds what a texture holds; returns false when there is nothing anywhere.
  static bool Add(
    vtkTextureObject* depths, int width, int height, int pixelSize, std::vector<float>& pictures);

  vtkNew<vtkTextureObject> Color;
  vtkNew<vtkTextureObject> Depths[2];
  vtkNew<vtkOpenGLFramebufferObject> Buffer;
};

#endif
