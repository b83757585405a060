// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMOpaqueDepth.h"

#include "vtkCameraPass.h"
#include "vtkOpaquePass.h"
#include "vtkOpenGLFramebufferObject.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkPixelBufferObject.h"
#include "vtkProp.h"
#include "vtkRenderState.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkTextureObject.h"

#include <algorithm>
#include <cstddef>

vtkDSMOpaqueDepth::vtkDSMOpaqueDepth() = default;
vtkDSMOpaqueDepth::~vtkDSMOpaqueDepth() = default;

std::vector<float> vtkDSMOpaqueDepth::Read(
  vtkRenderer* renderer, const std::vector<vtkProp*>& props, int width, int height, int pixelSize)
{
  auto* const window = vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow());
  if (!window || props.empty())
  {
    return {};
  }
  int size[2];
  int origin[2];
  renderer->GetTiledSizeAndOrigin(&size[0], &size[1], &origin[0], &origin[1]);
  vtkOpenGLState* const state = window->GetState();
  state->PushFramebufferBindings();
  this->Color->SetContext(window);
  this->Depth->SetContext(window);
  if (this->Color->GetHandle() == 0)
  {
    this->Color->Create2D(size[0], size[1], 4, VTK_UNSIGNED_CHAR, false);
    this->Depth->AllocateDepth(size[0], size[1], vtkTextureObject::Float32);
  }
  this->Color->Resize(size[0], size[1]);
  this->Depth->Resize(size[0], size[1]);
  this->Buffer->SetContext(window);
  this->Buffer->Bind();
  this->Buffer->AddColorAttachment(0, this->Color);
  this->Buffer->ActivateDrawBuffer(0);
  this->Buffer->AddDepthAttachment(this->Depth);
  this->Buffer->StartNonOrtho(size[0], size[1]);

  vtkNew<vtkCameraPass> pass;
  vtkNew<vtkOpaquePass> opaque;
  pass->SetDelegatePass(opaque);
  vtkRenderState toBuffer(renderer);
  std::vector<vtkProp*> drawn = props;
  toBuffer.SetPropArrayAndCount(drawn.data(), static_cast<int>(drawn.size()));
  toBuffer.SetFrameBuffer(this->Buffer);
  pass->Render(&toBuffer);
  pass->ReleaseGraphicsResources(window);
  state->PopFramebufferBindings();

  std::vector<float> all(static_cast<std::size_t>(size[0]) * size[1]);
  unsigned int dimensions[2] = { static_cast<unsigned int>(size[0]),
    static_cast<unsigned int>(size[1]) };
  vtkIdType increments[2] = { 0, 0 };
  const auto pixels = vtkSmartPointer<vtkPixelBufferObject>::Take(this->Depth->Download());
  pixels->Download2D(VTK_FLOAT, all.data(), dimensions, 1, increments);
  if (std::all_of(all.begin(), all.end(), [](float depth) { return depth >= 1.0f; }))
  {
    return {};
  }
  std::vector<float> picture(static_cast<std::size_t>(width) * height);
  for (int y = 0; y < height; ++y)
  {
    const int row = std::min(y * pixelSize + pixelSize / 2, size[1] - 1);
    for (int x = 0; x < width; ++x)
    {
      const int column = std::min(x * pixelSize + pixelSize / 2, size[0] - 1);
      picture[static_cast<std::size_t>(y) * width + x] =
        all[static_cast<std::size_t>(row) * size[0] + column];
    }
  }
  return picture;
}
