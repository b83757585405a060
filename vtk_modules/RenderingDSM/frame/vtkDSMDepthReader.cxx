// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMDepthReader.h"

#include "DSMCore/base/FirstFailure.h"

#include "vtkCameraPass.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkObjectFactory.h"
#include "vtkOpaquePass.h"
#include "vtkOpenGLActor.h"
#include "vtkOpenGLFramebufferObject.h"
#include "vtkOpenGLRenderPass.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkPixelBufferObject.h"
#include "vtkProp.h"
#include "vtkRenderState.h"
#include "vtkRenderer.h"
#include "vtkShaderProgram.h"
#include "vtkSmartPointer.h"
#include "vtkTextureObject.h"
#include "vtkTranslucentPass.h"

#include <GL/gl.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <string>

/// Draws the nearest translucent surfaces into one depth buffer, then those behind them into the other, and so on:
/// depth peeling (Everitt 2001), of depths alone.
class vtkDSMDepthReader::Peeling : public vtkOpenGLRenderPass
{
public:
  static Peeling* New();
  vtkTypeMacro(Peeling, vtkOpenGLRenderPass);

  vtkTextureObject* Depths[2] = { nullptr, nullptr };
  vtkOpenGLFramebufferObject* Buffer = nullptr;
  /// Is given the buffer of each peel; returns whether another is wanted.
  std::function<bool(vtkTextureObject*)> Take;

  void Render(const vtkRenderState* drawn) override
  {
    auto* const window =
      vtkOpenGLRenderWindow::SafeDownCast(drawn->GetRenderer()->GetRenderWindow());
    vtkOpenGLState* const state = window->GetState();
    vtkOpenGLState::ScopedglEnableDisable depthTest(state, GL_DEPTH_TEST);
    vtkOpenGLState::ScopedglDepthMask depthMask(state);
    vtkOpenGLState::ScopedglDepthFunc depthFunction(state);
    state->vtkglEnable(GL_DEPTH_TEST);
    state->vtkglDepthFunc(GL_LEQUAL);
    const auto begin = [&](vtkTextureObject* depth, float value)
    {
      this->Buffer->AddDepthAttachment(depth);
      state->vtkglDepthMask(GL_TRUE);
      state->vtkglClearDepth(value);
      state->vtkglClear(GL_DEPTH_BUFFER_BIT);
    };
    this->PreRender(drawn);
    for (int prop = 0; prop < drawn->GetPropArrayCount(); ++prop)
    {
      drawn->GetPropArray()[prop]->GetPropertyKeys()->Set(vtkOpenGLActor::GLDepthMaskOverride(), 1);
    }
    begin(this->Depths[0], 0.0f);
    state->vtkglClearDepth(1.0);
    bool goesOn = true;
    for (int peel = 0; goesOn && peel < MaxSurfaces; ++peel)
    {
      vtkTextureObject* const depths = this->Depths[(peel + 1) % 2];
      this->Nearer = this->Depths[peel % 2];
      begin(depths, 1.0f);
      this->Nearer->Activate();
      vtkNew<vtkTranslucentPass> pass;
      pass->Render(drawn);
      this->Nearer->Deactivate();
      goesOn = this->Take(depths);
    }
    for (int prop = 0; prop < drawn->GetPropArrayCount(); ++prop)
    {
      drawn->GetPropArray()[prop]->GetPropertyKeys()->Remove(vtkOpenGLActor::GLDepthMaskOverride());
    }
    this->PostRender(drawn);
  }

  bool PostReplaceShaderValues(std::string& /*vertexShader*/, std::string& /*geometryShader*/,
    std::string& fragmentShader, vtkAbstractMapper* /*mapper*/, vtkProp* /*prop*/) override
  {
    vtkShaderProgram::Substitute(
      fragmentShader, "//VTK::DepthPeeling::Dec", "uniform sampler2D dsmNearer;\n");
    // Mappers of spheres and tubes have set it.
    vtkShaderProgram::Substitute(
      fragmentShader, "//VTK::Depth::Impl", "gl_FragDepth = gl_FragCoord.z;\n");
    vtkShaderProgram::Substitute(fragmentShader, "//VTK::DepthPeeling::Impl",
      "if (gl_FragDepth <= texelFetch(dsmNearer, ivec2(gl_FragCoord.xy), 0).r + " +
        std::to_string(SurfaceDistance) + ")\n    {\n    discard;\n    }\n");
    return true;
  }

  bool SetShaderParameters(vtkShaderProgram* program, vtkAbstractMapper* /*mapper*/,
    vtkProp* /*prop*/, vtkOpenGLVertexArrayObject* /*array*/) override
  {
    program->SetUniformi("dsmNearer", this->Nearer->GetTextureUnit());
    return true;
  }

private:
  vtkTextureObject* Nearer = nullptr;
};

vtkStandardNewMacro(vtkDSMDepthReader::Peeling);

vtkDSMDepthReader::vtkDSMDepthReader() = default;
vtkDSMDepthReader::~vtkDSMDepthReader() = default;

std::vector<float> vtkDSMDepthReader::ReadOpaque(
  vtkRenderer* renderer, const std::vector<vtkProp*>& props, int width, int height, int pixelSize)
{
  if (props.empty() || !vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow()))
  {
    return {};
  }
  vtkNew<vtkOpaquePass> opaque;
  this->Draw(renderer, props, opaque);
  std::vector<float> picture;
  return Add(this->Depths[0], width, height, pixelSize, picture) ? picture : std::vector<float>();
}

std::vector<float> vtkDSMDepthReader::ReadTranslucent(
  vtkRenderer* renderer, const std::vector<vtkProp*>& props, int width, int height, int pixelSize)
{
  std::vector<vtkProp*> translucent;
  std::copy_if(props.begin(), props.end(), std::back_inserter(translucent),
    [](vtkProp* prop) { return prop->HasTranslucentPolygonalGeometry() != 0; });
  std::vector<float> pictures;
  if (translucent.empty() || !vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow()))
  {
    return pictures;
  }
  vtkNew<Peeling> peeling;
  peeling->Depths[0] = this->Depths[0];
  peeling->Depths[1] = this->Depths[1];
  peeling->Buffer = this->Buffer;
  dsm::FirstFailure failure; // not thrown through passes, which would leave their traces
  peeling->Take = [&](vtkTextureObject* depths)
  {
    bool isAny = false;
    failure.Try([&] { isAny = Add(depths, width, height, pixelSize, pictures); });
    return isAny;
  };
  this->Draw(renderer, translucent, peeling);
  failure.Throw();
  return pictures;
}

void vtkDSMDepthReader::Begin(vtkRenderer* renderer)
{
  auto* const window = vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow());
  int size[2];
  int origin[2];
  renderer->GetTiledSizeAndOrigin(&size[0], &size[1], &origin[0], &origin[1]);
  this->Color->SetContext(window);
  if (this->Color->GetHandle() == 0)
  {
    this->Color->Create2D(size[0], size[1], 4, VTK_UNSIGNED_CHAR, false);
  }
  this->Color->Resize(size[0], size[1]);
  for (const auto& depth : this->Depths)
  {
    depth->SetContext(window);
    if (depth->GetHandle() == 0)
    {
      depth->AllocateDepth(size[0], size[1], vtkTextureObject::Float32);
    }
    depth->Resize(size[0], size[1]);
  }
  this->Buffer->SetContext(window);
  this->Buffer->Bind();
  this->Buffer->AddColorAttachment(0, this->Color);
  this->Buffer->ActivateDrawBuffer(0);
  this->Buffer->AddDepthAttachment(this->Depths[0]);
  this->Buffer->StartNonOrtho(size[0], size[1]);
}

void vtkDSMDepthReader::Draw(
  vtkRenderer* renderer, const std::vector<vtkProp*>& props, vtkRenderPass* pass)
{
  auto* const window = vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow());
  vtkOpenGLState* const state = window->GetState();
  state->PushFramebufferBindings();
  this->Begin(renderer);
  vtkNew<vtkCameraPass> camera;
  camera->SetDelegatePass(pass);
  vtkRenderState toBuffer(renderer);
  std::vector<vtkProp*> drawn = props;
  toBuffer.SetPropArrayAndCount(drawn.data(), static_cast<int>(drawn.size()));
  toBuffer.SetFrameBuffer(this->Buffer);
  camera->Render(&toBuffer);
  camera->ReleaseGraphicsResources(window);
  state->PopFramebufferBindings();
}

bool vtkDSMDepthReader::Add(
  vtkTextureObject* depths, int width, int height, int pixelSize, std::vector<float>& pictures)
{
  unsigned int size[2] = { depths->GetWidth(), depths->GetHeight() };
  std::vector<float> all(static_cast<std::size_t>(size[0]) * size[1]);
  vtkIdType increments[2] = { 0, 0 };
  const auto pixels = vtkSmartPointer<vtkPixelBufferObject>::Take(depths->Download());
  pixels->Download2D(VTK_FLOAT, all.data(), size, 1, increments);
  if (std::all_of(all.begin(), all.end(), [](float depth) { return depth >= 1.0f; }))
  {
    return false;
  }
  pictures.reserve(pictures.size() + static_cast<std::size_t>(width) * height);
  for (int y = 0; y < height; ++y)
  {
    const std::size_t row =
      std::min<std::size_t>(y * pixelSize + pixelSize / 2, size[1] - 1) * size[0];
    for (int x = 0; x < width; ++x)
    {
      pictures.push_back(
        all[row + std::min<std::size_t>(x * pixelSize + pixelSize / 2, size[0] - 1)]);
    }
  }
  return true;
}
