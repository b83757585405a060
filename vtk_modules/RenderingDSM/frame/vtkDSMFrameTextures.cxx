// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMFrameTextures.h"

#include "vtkOpenGLRenderWindow.h"

#include <utility>

void vtkDSMFrameTextures::SetPixels(
  int width, int height, std::vector<std::uint8_t> colors, std::vector<float> depths)
{
  this->Width = width;
  this->Height = height;
  this->Colors = std::move(colors);
  this->Depths = std::move(depths);
  this->Uploaded = false;
}

void vtkDSMFrameTextures::Activate(vtkOpenGLRenderWindow* window)
{
  for (vtkTextureObject* texture : { this->ColorTexture.Get(), this->DepthTexture.Get() })
  {
    texture->SetContext(window);
    texture->SetMinificationFilter(vtkTextureObject::Nearest);
    texture->SetMagnificationFilter(vtkTextureObject::Nearest);
    texture->SetWrapS(vtkTextureObject::ClampToEdge);
    texture->SetWrapT(vtkTextureObject::ClampToEdge);
  }
  if (!this->Uploaded)
  {
    this->ColorTexture->Create2DFromRaw(
      this->Width, this->Height, 4, VTK_UNSIGNED_CHAR, this->Colors.data());
    this->DepthTexture->Create2DFromRaw(
      this->Width, this->Height, 1, VTK_FLOAT, this->Depths.data());
    this->Uploaded = true;
  }
  this->ColorTexture->Activate();
  this->DepthTexture->Activate();
}

void vtkDSMFrameTextures::Deactivate()
{
  this->DepthTexture->Deactivate();
  this->ColorTexture->Deactivate();
}

void vtkDSMFrameTextures::ReleaseGraphicsResources(vtkWindow* window)
{
  this->ColorTexture->ReleaseGraphicsResources(window);
  this->DepthTexture->ReleaseGraphicsResources(window);
  this->Uploaded = false;
}
