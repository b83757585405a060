// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMFrameProp.h"

#include "DSMRayTracing/frame/FrameGather.h"
#include "vtkDSMFrameLayers.h"
#include "vtkDSMFrameTextures.h"

#include "vtkCamera.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLQuadHelper.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkOpenGLState.h"
#include "vtkRenderer.h"
#include "vtkShaderProgram.h"

#include <GL/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace
{

/// Parts of the frame to draw.
enum Part
{
  Everything,
  Inner,   ///< pixels that are covered, and what is before all else: notes
  Edges,   ///< the others
  FarEdges ///< those again, at a depth that all but the background is before
};

const std::string ShaderHead = R"(//VTK::System::Dec
//VTK::Output::Dec
in vec2 texCoord;
uniform sampler2D frameColor;
uniform sampler2D frameDepth;
uniform int part;
vec4 color;
float depth;
bool isLeftOut()
{
  bool isInner = color.a == 1.0 || depth == 0.0;
  return color.a == 0.0 || (part == 1 && !isInner) || (part > 1 && isInner);
}
void setPixel()
{
  gl_FragData[0] = color;
  gl_FragDepth = part == 3 ? 1.0 - 1.0 / 4194304.0 : depth;
}
)";

const std::string FragmentShader = ShaderHead + R"(
void main()
{
  color = texture(frameColor, texCoord);
  depth = texture(frameDepth, texCoord).r;
  if (isLeftOut())
  {
    discard;
  }
  setPixel();
}
)";

/// With what passes that work on the picture, such as screen space ambient occlusion, know of a surface: its place
/// and normal in the camera's coordinates.
const std::string FragmentShaderWithPlaces = ShaderHead + R"(
uniform mat4 clipToView;
void main()
{
  color = texture(frameColor, texCoord);
  depth = texture(frameDepth, texCoord).r;
  vec4 place = clipToView * vec4(2.0 * vec3(texCoord, depth) - 1.0, 1.0);
  place /= place.w;
  vec3 normal = cross(dFdx(place.xyz), dFdy(place.xyz));
  if (isLeftOut())
  {
    discard;
  }
  setPixel();
  gl_FragData[1] = vec4(place.xyz, 1.0);
  gl_FragData[2] = vec4(normalize(normal), 1.0);
}
)";

/// Returns whether the current framebuffer has more than a color buffer.
bool TakesPlaces(vtkOpenGLState* state)
{
  int second = GL_NONE;
  state->vtkglGetIntegerv(GL_DRAW_BUFFER1, &second);
  return second != GL_NONE;
}

/// Returns the rectangle of the traced image in the current viewport, in pixels. The two differ
/// while IceT renders a reduced image, which it puts into the lower left corner with the
/// projection.
std::array<int, 4> GetTarget(
  vtkMatrix4x4* traced, vtkMatrix4x4* drawn, const std::array<int, 4>& viewport)
{
  vtkNew<vtkMatrix4x4> change;
  vtkMatrix4x4::Invert(traced, change);
  vtkMatrix4x4::Multiply4x4(drawn, change, change);
  std::array<int, 4> target{};
  for (int axis = 0; axis < 2; ++axis)
  {
    const double scale = change->GetElement(axis, axis) / change->GetElement(3, 3);
    const double shift = change->GetElement(axis, 3) / change->GetElement(3, 3);
    const double first = viewport[axis] + 0.5 * viewport[axis + 2] * (1.0 + shift - scale);
    target[axis] = static_cast<int>(std::lround(first));
    target[axis + 2] = static_cast<int>(std::lround(viewport[axis + 2] * scale));
  }
  return target;
}

vtkMatrix4x4* GetProjection(vtkRenderer* renderer)
{
  return renderer->GetActiveCamera()->GetProjectionTransformMatrix(
    renderer->GetTiledAspectRatio(), -1.0, 1.0);
}

} // namespace

class vtkDSMFrameProp::Internals
{
public:
  void Store(rt::Picture picture)
  {
    this->Textures.SetPixels(
      picture.Width, picture.Height, std::move(picture.Color), std::move(picture.Depth));
  }

  void Draw(vtkOpenGLRenderWindow* window, const std::array<int, 4>& target)
  {
    vtkOpenGLState* state = window->GetState();
    vtkOpenGLState::ScopedglEnableDisable depthTest(state, GL_DEPTH_TEST);
    vtkOpenGLState::ScopedglEnableDisable blend(state, GL_BLEND);
    vtkOpenGLState::ScopedglDepthMask depthMask(state);
    vtkOpenGLState::ScopedglDepthFunc depthFunction(state);
    vtkOpenGLState::ScopedglBlendFuncSeparate blendFunction(state);
    vtkOpenGLState::ScopedglColorMask colorMask(state);
    vtkOpenGLState::ScopedglViewport viewport(state);
    const auto setColorMask = [state](bool isDrawn)
    {
      const unsigned char color = isDrawn ? GL_TRUE : GL_FALSE;
      state->vtkglColorMask(color, color, color, color);
    };
    state->vtkglEnable(GL_DEPTH_TEST);
    state->vtkglDepthMask(GL_TRUE);
    state->vtkglDepthFunc(GL_LEQUAL);
    state->vtkglEnable(GL_BLEND);
    state->vtkglBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    setColorMask(this->How != Drawing::DepthOnly);
    state->vtkglViewport(target[0], target[1], target[2], target[3]);

    const bool withPlaces = TakesPlaces(state);
    auto& quad = withPlaces ? this->QuadWithPlaces : this->Quad;
    if (!quad)
    {
      quad = std::make_unique<vtkOpenGLQuadHelper>(
        window, nullptr, (withPlaces ? FragmentShaderWithPlaces : FragmentShader).c_str(), nullptr);
    }
    else
    {
      window->GetShaderCache()->ReadyShaderProgram(quad->Program);
    }
    if (!quad->Program || !quad->Program->GetCompiled())
    {
      return;
    }
    this->Textures.Activate(window);
    quad->Program->SetUniformi("frameColor", this->Textures.GetColorUnit());
    quad->Program->SetUniformi("frameDepth", this->Textures.GetDepthUnit());
    if (withPlaces)
    {
      vtkNew<vtkMatrix4x4> clipToView;
      vtkMatrix4x4::Invert(this->Projection, clipToView);
      clipToView->Transpose(); // OpenGL's order
      quad->Program->SetUniformMatrix("clipToView", clipToView);
    }
    const auto draw = [&quad](Part part)
    {
      quad->Program->SetUniformi("part", part);
      quad->Render();
    };
    if (this->How == Drawing::SharedEdges)
    {
      draw(Inner);
      state->vtkglDepthMask(GL_FALSE);
      draw(Edges);
      state->vtkglDepthMask(GL_TRUE);
      setColorMask(false);
      draw(FarEdges);
    }
    else
    {
      draw(Everything);
    }
    this->Textures.Deactivate();
  }

  vtkDSMFrameTextures Textures;
  vtkDSMFrameLayers Layers;
  bool IsAmongTranslucent = false;
  Drawing How = Drawing::All;
  double Bounds[6];
  vtkNew<vtkMatrix4x4> Projection;
  std::unique_ptr<vtkOpenGLQuadHelper> Quad;
  std::unique_ptr<vtkOpenGLQuadHelper> QuadWithPlaces;
};

vtkStandardNewMacro(vtkDSMFrameProp);

vtkDSMFrameProp::vtkDSMFrameProp()
  : Self(std::make_unique<Internals>())
{
  vtkMath::UninitializeBounds(this->Self->Bounds);
  this->PickableOff();
}

vtkDSMFrameProp::~vtkDSMFrameProp() = default;

void vtkDSMFrameProp::SetFrame(
  rt::Picture frame, vtkMatrix4x4* projection, const double bounds[6], Drawing drawing)
{
  this->Self->How = drawing;
  this->Self->Store(std::move(frame));
  this->Self->Layers.SetPicture({});
  this->Self->Projection->DeepCopy(projection);
  std::copy_n(bounds, 6, this->Self->Bounds);
  this->Modified();
}

void vtkDSMFrameProp::SetLayers(
  const rt::Picture& frame, vtkMatrix4x4* projection, const double bounds[6])
{
  this->Self->Store({});
  this->Self->Layers.SetPicture(frame);
  this->Self->Projection->DeepCopy(projection);
  std::copy_n(bounds, 6, this->Self->Bounds);
  this->Modified();
}

void vtkDSMFrameProp::SetIsAmongTranslucent(bool isAmong)
{
  this->Self->IsAmongTranslucent = isAmong;
}

void vtkDSMFrameProp::Clear()
{
  if (!this->Self->Textures.IsEmpty() || !this->Self->Layers.IsEmpty() ||
    vtkMath::AreBoundsInitialized(this->Self->Bounds))
  {
    this->Self->Store({});
    this->Self->Layers.SetPicture({});
    vtkMath::UninitializeBounds(this->Self->Bounds);
    this->Modified();
  }
}

void vtkDSMFrameProp::SetBounds(const double bounds[6])
{
  if (vtkMath::AreBoundsInitialized(this->Self->Bounds))
  {
    std::copy_n(bounds, 6, this->Self->Bounds);
  }
}

double* vtkDSMFrameProp::GetBounds()
{
  return vtkMath::AreBoundsInitialized(this->Self->Bounds) ? this->Self->Bounds : nullptr;
}

int vtkDSMFrameProp::RenderOpaqueGeometry(vtkViewport* viewport)
{
  auto* renderer = vtkRenderer::SafeDownCast(viewport);
  auto* window =
    renderer ? vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow()) : nullptr;
  if (!window || this->Self->Textures.IsEmpty() || renderer->GetSelector())
  {
    return 0;
  }
  std::array<int, 4> rectangle{};
  window->GetState()->vtkglGetIntegerv(GL_VIEWPORT, rectangle.data());
  this->Self->Draw(window, GetTarget(this->Self->Projection, GetProjection(renderer), rectangle));
  return 1;
}

vtkTypeBool vtkDSMFrameProp::HasTranslucentPolygonalGeometry()
{
  return this->Self->IsAmongTranslucent && !this->Self->Layers.IsEmpty();
}

int vtkDSMFrameProp::RenderTranslucentPolygonalGeometry(vtkViewport* viewport)
{
  return this->Self->IsAmongTranslucent ? this->DrawLayers(viewport) : 0;
}

int vtkDSMFrameProp::RenderVolumetricGeometry(vtkViewport* viewport)
{
  return this->Self->IsAmongTranslucent ? 0 : this->DrawLayers(viewport);
}

int vtkDSMFrameProp::DrawLayers(vtkViewport* viewport)
{
  auto* renderer = vtkRenderer::SafeDownCast(viewport);
  if (!renderer || this->Self->Layers.IsEmpty() || renderer->GetSelector())
  {
    return 0;
  }
  // As pixels of the viewport, so that the frame's pixels fall on those.
  std::array<int, 4> rectangle{};
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow());
  window->GetState()->vtkglGetIntegerv(GL_VIEWPORT, rectangle.data());
  const std::array<int, 4> target =
    GetTarget(this->Self->Projection, GetProjection(renderer), rectangle);
  std::array<double, 4> place{};
  for (int axis = 0; axis < 2; ++axis)
  {
    const double first = target[axis] - rectangle[axis];
    place[2 * axis] = 2.0 * first / rectangle[axis + 2] - 1.0;
    place[2 * axis + 1] = 2.0 * (first + target[axis + 2]) / rectangle[axis + 2] - 1.0;
  }
  this->Self->Layers.Render(viewport, this->GetPropertyKeys(), place);
  return 1;
}

void vtkDSMFrameProp::ReleaseGraphicsResources(vtkWindow* window)
{
  this->Self->Layers.ReleaseGraphicsResources(window);
  this->Self->Quad.reset();
  this->Self->QuadWithPlaces.reset();
  this->Self->Textures.ReleaseGraphicsResources(window);
  this->Superclass::ReleaseGraphicsResources(window);
}

void vtkDSMFrameProp::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Frame: " << this->Self->Textures.GetWidth() << " x "
     << this->Self->Textures.GetHeight() << "\n";
}
