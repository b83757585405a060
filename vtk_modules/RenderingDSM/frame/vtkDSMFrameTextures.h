// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMFrameTextures_h
#define vtkDSMFrameTextures_h

#include "vtkNew.h"
#include "vtkTextureObject.h"

#include <cstdint>
#include <vector>

class vtkOpenGLRenderWindow;
class vtkWindow;

/// The pixels of a traced picture, or of one of its layers, and their textures: color and depth. Local;
/// rendering thread only.
class vtkDSMFrameTextures
{
public:
  /// Four bytes of color, and an OpenGL window depth, for each pixel; row by row from the bottom.
  /// Without pixels there is nothing to draw.
  void SetPixels(
    int width, int height, std::vector<std::uint8_t> colors, std::vector<float> depths);

  bool IsEmpty() const { return this->Depths.empty(); }
  int GetWidth() const { return this->Width; }
  int GetHeight() const { return this->Height; }

  /// Uploads the pixels to the window's graphics card, unless it has them already, and takes two texture units
  /// until Deactivate.
  void Activate(vtkOpenGLRenderWindow* window);
  void Deactivate();

  /// The texture units, while active.
  int GetColorUnit() { return this->ColorTexture->GetTextureUnit(); }
  int GetDepthUnit() { return this->DepthTexture->GetTextureUnit(); }

  void ReleaseGraphicsResources(vtkWindow* window);

private:
  int Width = 0;
  int Height = 0;
  std::vector<std::uint8_t> Colors;
  std::vector<float> Depths;
  bool Uploaded = false;
  vtkNew<vtkTextureObject> ColorTexture;
  vtkNew<vtkTextureObject> DepthTexture;
};

#endif
