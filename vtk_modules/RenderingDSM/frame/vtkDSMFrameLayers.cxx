// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMFrameLayers.h"

#include "vtkDSMFrameTextures.h"

#include "vtkCallbackCommand.h"
#include "vtkCellArray.h"
#include "vtkCommand.h"
#include "vtkNew.h"
#include "vtkOpenGLActor.h"
#include "vtkOpenGLPolyDataMapper.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkShaderProgram.h"
#include "vtkShaderProperty.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace
{

/// The square from -1 to 1; the shader moves it to where the frame is.
void MakeSquare(vtkPolyData* square)
{
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(-1.0, -1.0, 0.0);
  points->InsertNextPoint(1.0, -1.0, 0.0);
  points->InsertNextPoint(1.0, 1.0, 0.0);
  points->InsertNextPoint(-1.0, 1.0, 0.0);
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell({ 0, 1, 2, 3 });
  square->SetPoints(points);
  square->SetPolys(cells);
}

void ReplaceShaders(vtkShaderProperty* shaders)
{
  shaders->AddVertexShaderReplacement("//VTK::PositionVC::Dec", true,
    "//VTK::PositionVC::Dec\n"
    "uniform vec2 dsmScale;\n"
    "uniform vec2 dsmShift;\n"
    "out vec2 dsmPlace;\n",
    false);
  shaders->AddVertexShaderReplacement("//VTK::PositionVC::Impl", true,
    "gl_Position = vec4(vertexMC.xy * dsmScale + dsmShift, 0.0, 1.0);\n"
    "  dsmPlace = 0.5 * vertexMC.xy + 0.5;\n",
    false);
  shaders->AddFragmentShaderReplacement("//VTK::PositionVC::Dec", true,
    "//VTK::PositionVC::Dec\n"
    "uniform sampler2D dsmColors;\n"
    "uniform sampler2D dsmDepths;\n"
    "in vec2 dsmPlace;\n",
    false);
  shaders->AddFragmentShaderReplacement("//VTK::Depth::Impl", true,
    "vec4 dsmColor = texture(dsmColors, dsmPlace);\n"
    "  if (dsmColor.a == 0.0)\n"
    "    {\n"
    "    discard;\n"
    "    }\n"
    "  gl_FragDepth = texture(dsmDepths, dsmPlace).r;\n",
    false);
  shaders->AddFragmentShaderReplacement(
    "//VTK::Light::Impl", true, "gl_FragData[0] = dsmColor;\n", false);
}

} // namespace

class vtkDSMFrameLayers::Layer
{
public:
  Layer()
  {
    vtkNew<vtkPolyData> square;
    MakeSquare(square);
    this->Mapper->SetInputDataObject(square);
    this->Mapper->ScalarVisibilityOff();
    vtkNew<vtkCallbackCommand> update;
    update->SetClientData(this);
    update->SetCallback([](vtkObject*, unsigned long, void* self, void* program)
      { static_cast<Layer*>(self)->SetUniforms(static_cast<vtkShaderProgram*>(program)); });
    this->Mapper->AddObserver(vtkCommand::UpdateShaderEvent, update);
    this->Actor->SetMapper(this->Mapper);
    this->Actor->ForceTranslucentOn();
    this->Actor->GetProperty()->LightingOff();
    ReplaceShaders(this->Actor->GetShaderProperty());
  }

  void SetPixels(int width, int height, const std::uint8_t* colors, const float* depths)
  {
    const std::size_t pixels = static_cast<std::size_t>(width) * height;
    this->Textures.SetPixels(
      width, height, { colors, colors + 4 * pixels }, { depths, depths + pixels });
  }

  void Render(vtkViewport* viewport, vtkInformation* keys, const std::array<double, 4>& target)
  {
    auto* window =
      vtkOpenGLRenderWindow::SafeDownCast(vtkRenderer::SafeDownCast(viewport)->GetRenderWindow());
    if (!window)
    {
      return;
    }
    this->Target = target;
    this->Textures.Activate(window);
    this->Actor->SetPropertyKeys(keys);
    this->Actor->RenderTranslucentPolygonalGeometry(viewport);
    this->Textures.Deactivate();
  }

  void ReleaseGraphicsResources(vtkWindow* window)
  {
    this->Actor->ReleaseGraphicsResources(window);
    this->Textures.ReleaseGraphicsResources(window);
  }

private:
  void SetUniforms(vtkShaderProgram* program)
  {
    program->SetUniformi("dsmColors", this->Textures.GetColorUnit());
    program->SetUniformi("dsmDepths", this->Textures.GetDepthUnit());
    const float scale[2] = { static_cast<float>(0.5 * (this->Target[1] - this->Target[0])),
      static_cast<float>(0.5 * (this->Target[3] - this->Target[2])) };
    const float shift[2] = { static_cast<float>(0.5 * (this->Target[1] + this->Target[0])),
      static_cast<float>(0.5 * (this->Target[3] + this->Target[2])) };
    program->SetUniform2f("dsmScale", scale);
    program->SetUniform2f("dsmShift", shift);
  }

  std::array<double, 4> Target{};
  vtkDSMFrameTextures Textures;
  vtkNew<vtkOpenGLPolyDataMapper> Mapper;
  vtkNew<vtkOpenGLActor> Actor;
};

vtkDSMFrameLayers::vtkDSMFrameLayers() = default;
vtkDSMFrameLayers::~vtkDSMFrameLayers() = default;

void vtkDSMFrameLayers::Separate(rt::Picture& picture)
{
  const std::size_t pixels = static_cast<std::size_t>(picture.Width) * picture.Height;
  for (std::size_t pixel = 0; pixel < pixels; ++pixel)
  {
    int left = 255; // remaining light from behind
    for (int layer = 0; layer < picture.Layers; ++layer)
    {
      std::uint8_t* color = &picture.Color[4 * (pixels * layer + pixel)];
      const int part = color[3];
      if (part == 0)
      {
        continue;
      }
      for (int channel = 0; channel < 3; ++channel)
      {
        color[channel] =
          static_cast<std::uint8_t>(std::min((255 * color[channel] + part / 2) / part, 255));
      }
      color[3] =
        static_cast<std::uint8_t>(part < left ? std::max((255 * part + left / 2) / left, 1) : 255);
      left = std::max(left - part, 0);
    }
  }
}

void vtkDSMFrameLayers::SetPicture(const rt::Picture& picture)
{
  const std::size_t pixels = static_cast<std::size_t>(picture.Width) * picture.Height;
  // Those that are there keep what they have on the graphics card.
  this->Layers.resize(pixels == 0 ? 0 : picture.Layers);
  for (std::size_t layer = 0; layer < this->Layers.size(); ++layer)
  {
    if (!this->Layers[layer])
    {
      this->Layers[layer] = std::make_unique<Layer>();
    }
    this->Layers[layer]->SetPixels(picture.Width, picture.Height,
      &picture.Color[4 * pixels * layer], &picture.Depth[pixels * layer]);
  }
}

void vtkDSMFrameLayers::Render(
  vtkViewport* viewport, vtkInformation* keys, const std::array<double, 4>& target)
{
  // Back to front, for renderers that do nothing about the order.
  std::for_each(this->Layers.rbegin(), this->Layers.rend(),
    [&](const std::unique_ptr<Layer>& layer) { layer->Render(viewport, keys, target); });
}

void vtkDSMFrameLayers::ReleaseGraphicsResources(vtkWindow* window)
{
  for (const auto& layer : this->Layers)
  {
    layer->ReleaseGraphicsResources(window);
  }
}
