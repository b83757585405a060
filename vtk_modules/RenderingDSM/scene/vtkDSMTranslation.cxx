// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMTranslation.h"

#include "DSMRayTracing/frame/PixelRays.h"
#include "vtkDSMCompatibility.h"
#include "vtkDSMLightOptions.h"
#include "vtkDSMVolumeFunctions.h"

#include "vtkAbstractMapper.h"
#include "vtkAlgorithm.h"
#include "vtkBoundingBox.h"
#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkImageData.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPlane.h"
#include "vtkPlaneCollection.h"
#include "vtkPointData.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkScalarsToColors.h"
#include "vtkTexture.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolumeProperty.h"
#include "vtkWindow.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{

/// Entries of a sampled color map: well above the 256 of ParaView's discretised ones.
constexpr std::size_t ColorMapEntries = 4096;

/// Default length of ambient occlusion rays, over the diagonal of what is shown.
constexpr double AmbientOcclusionPart = 0.2;

/// Optical depth of a way that is as good as transparent: a sixteenth of a step of an 8-bit channel.
constexpr double LeastDepth = 1.0 / 4096.0;
/// That a unit of length of a medium has: what is behind that much of it is not seen anyway.
constexpr double MostOpacity = 1.0 - 1e-15;

glm::vec3 ToColor(const double color[3])
{
  return { color[0], color[1], color[2] };
}

glm::vec4 MapValue(vtkScalarsToColors* table, double value)
{
  double color[3];
  table->GetColor(value, color);
  return { color[0], color[1], color[2], table->GetOpacity(value) };
}

void SetCamera(
  vtkRenderer* renderer, double aspect, vtkMatrix4x4* projection, rt::FrameRequest& request)
{
  const auto set = [&](vtkCamera* camera)
  {
    projection->DeepCopy(camera->GetProjectionTransformMatrix(aspect, -1.0, 1.0));
    request.WorldToClip = vtkDSMTranslation::ToMatrix(projection) *
      vtkDSMTranslation::ToMatrix(camera->GetModelViewTransformMatrix());
  };
  vtkCamera* const camera = renderer->GetActiveCamera();
  set(camera);
  if (!rt::PixelRays::CanBeMade(request.WorldToClip))
  {
    // If everything is behind the camera, VTK's clipping range is almost empty. Nothing is visible
    // then, but rays must have a direction.
    vtkNew<vtkCamera> other;
    other->DeepCopy(camera);
    other->SetClippingRange(camera->GetDistance(), 2.0 * camera->GetDistance());
    set(other);
  }
}

} // namespace

glm::dmat4 vtkDSMTranslation::ToMatrix(vtkMatrix4x4* matrix)
{
  glm::dmat4 result;
  for (int row = 0; row < 4; ++row)
  {
    for (int column = 0; column < 4; ++column)
    {
      result[column][row] = matrix->GetElement(row, column);
    }
  }
  return result;
}

rt::Material vtkDSMTranslation::ToMaterial(vtkProperty* property)
{
  rt::Material material;
  material.Ambient = static_cast<float>(property->GetAmbient());
  material.Diffuse = static_cast<float>(property->GetDiffuse());
  material.Specular = static_cast<float>(property->GetSpecular());
  material.SpecularPower = static_cast<float>(property->GetSpecularPower());
  material.AmbientColor = ToColor(property->GetAmbientColor());
  material.DiffuseColor = ToColor(property->GetDiffuseColor());
  material.SpecularColor = ToColor(property->GetSpecularColor());
  material.Opacity = static_cast<float>(property->GetOpacity());
  material.Lighting = property->GetLighting();
  return material;
}

rt::EdgeLines vtkDSMTranslation::ToEdgeLines(vtkProperty* property)
{
  // VTK draws none that are thinner.
  constexpr float thinnest = 1.1f;
  rt::EdgeLines lines;
  lines.Color = ToColor(property->GetEdgeColor());
  lines.Width = std::max(property->GetLineWidth(), thinnest);
  lines.Opacity = static_cast<float>(vtkDSMCompatibility::GetEdgeOpacity(property));
  return lines;
}

rt::Material vtkDSMTranslation::ToMaterial(vtkVolumeProperty* property, double isovalue)
{
  const glm::dvec4 look = vtkDSMVolumeFunctions(property, 0).GetLook(isovalue);
  const glm::vec3 color(look);
  rt::Material material;
  material.Lighting = property->GetShade(0) != 0;
  // Without shading, the transfer function's color as it is.
  material.Ambient = material.Lighting ? static_cast<float>(property->GetAmbient(0)) : 1.0f;
  material.Diffuse = material.Lighting ? static_cast<float>(property->GetDiffuse(0)) : 0.0f;
  material.Specular = static_cast<float>(property->GetSpecular(0));
  material.SpecularPower = static_cast<float>(property->GetSpecularPower(0));
  material.AmbientColor = color;
  material.DiffuseColor = color;
  material.Opacity = static_cast<float>(look.w);
  return material;
}

std::shared_ptr<const rt::TransferFunction> vtkDSMTranslation::ToTransferFunction(
  vtkVolumeProperty* property, int component, double weight, double first, double last,
  double cellLength, double diagonal, bool hasCategories)
{
  const vtkDSMVolumeFunctions functions(property, component, hasCategories);
  functions.Narrow(first, last);
  const double unit = property->GetScalarOpacityUnitDistance(component);
  const auto look = [&](double value)
  {
    glm::dvec4 sample = functions.GetLook(value);
    const double extinction = -weight * std::log1p(-std::clamp(sample.w, 0.0, MostOpacity)) / unit;
    // Skip values that are invisible even if the whole length of a ray has them.
    sample.w = extinction * diagonal < LeastDepth ? 0.0 : extinction;
    return sample;
  };
  return rt::TransferFunction::Create(
    first, last, look, functions.GetNodes(), LeastDepth / diagonal, cellLength);
}

std::shared_ptr<const rt::TransferFunction2D> vtkDSMTranslation::ToTransferFunction2D(
  vtkVolumeProperty* property, int component, double weight, double first, double last,
  const std::array<double, 2>& seconds, double cellLength, double diagonal)
{
  // A single number is at the begin of the image, as VTK's mapper has it.
  const auto widen = [](double begin, double end)
  { return glm::dvec2(begin, begin < end ? end : begin + std::max(1.0, std::abs(begin)) * 1e-3); };
  vtkImageData* const function = property->GetTransferFunction2D(component);
  vtkDataArray* const texels = function->GetPointData()->GetScalars();
  rt::TransferFunction2D::Image image;
  image.Columns = function->GetDimensions()[0];
  image.Rows = function->GetDimensions()[1];
  image.Values = widen(first, last);
  image.Seconds = widen(seconds[0], seconds[1]);
  image.IsNearest = property->GetInterpolationType() == VTK_NEAREST_INTERPOLATION;
  const vtkIdType count = vtkIdType{ image.Columns } * image.Rows;
  for (vtkIdType texel = 0; texel < count; ++texel)
  {
    double look[4];
    texels->GetTuple(texel, look);
    image.Looks.emplace_back(look[0], look[1], look[2], std::clamp(look[3], 0.0, 1.0));
  }
  const double unit = property->GetScalarOpacityUnitDistance(component);
  const auto getExtinction = [&](double opacity)
  {
    const double extinction = -weight * std::log1p(-std::min(opacity, MostOpacity)) / unit;
    return extinction * diagonal < LeastDepth ? 0.0 : extinction;
  };
  return std::make_shared<const rt::TransferFunction2D>(image, getExtinction, cellLength);
}

rt::MediumLook vtkDSMTranslation::ToMediumLook(
  vtkVolumeProperty* property, int component, double range)
{
  rt::MediumLook look;
  // As VTK's mapper, which shades all components, or none, each by its own coefficients.
  look.Shade = property->GetShade(0) != 0;
  look.Surface.Ambient = static_cast<float>(property->GetAmbient(component));
  look.Surface.Diffuse = static_cast<float>(property->GetDiffuse(component));
  look.Surface.Specular = static_cast<float>(property->GetSpecular(component));
  look.Surface.SpecularPower = static_cast<float>(property->GetSpecularPower(component));
  constexpr double most = 0.99; // at 1, all light goes straight on
  look.Anisotropy = std::clamp<double>(property->GetScatteringAnisotropy(), -most, most);
  // With a two-dimensional function, VTK's mapper has no other one of gradients.
  if (property->GetTransferFunctionMode() == vtkVolumeProperty::TF_1D &&
    property->HasGradientOpacity(component) && range > 0.0)
  {
    // As VTK's mapper, which takes what values do in a cell to be a quarter of their range at most.
    constexpr int count = 1024;
    rt::GradientOpacity opacity;
    opacity.Last = 0.25 * range;
    opacity.Factors.resize(count);
    property->GetGradientOpacity(component)->GetTable(
      0.0, opacity.Last, count, opacity.Factors.data());
    // VTK makes a function of ones for whoever asks for it. Gradients would have to be found for nothing.
    if (std::any_of(opacity.Factors.begin(), opacity.Factors.end(),
          [](double factor) { return factor != 1.0; }))
    {
      look.Gradients = std::make_shared<const rt::GradientOpacity>(std::move(opacity));
    }
  }
  return look;
}

std::shared_ptr<const rt::ColorMap> vtkDSMTranslation::ToColorMap(
  vtkVolumeProperty* property, int component, double first, double last, bool hasCategories)
{
  const vtkDSMVolumeFunctions functions(property, component, hasCategories);
  functions.Narrow(first, last);
  auto map = std::make_shared<rt::ColorMap>();
  map->First = first;
  map->Last = last;
  map->Logarithmic = functions.AreLogarithmic(first);
  map->Sample(
    ColorMapEntries, [&](double value) { return functions.GetLook(value); }, functions.GetNodes());
  map->Below = functions.GetLook(first);
  map->Above = functions.GetLook(last);
  return map;
}

rt::ColorMap vtkDSMTranslation::ToColorMap(vtkVolumeProperty* property, int component,
  const bricks::ValueRange& range, bool hasOpacity, bool hasCategories)
{
  vtkPiecewiseFunction* const opacity =
    hasOpacity ? property->GetScalarOpacity(component) : nullptr;
  // To ask for the other one would make it the one that counts.
  rt::ColorMap map = property->GetColorChannels(component) == 1 || hasCategories
    ? *ToColorMap(property, component, range.First, range.Last, hasCategories)
    : ToColorMap(property->GetRGBTransferFunction(component), opacity);
  if (!hasOpacity)
  {
    map.SetOpaque();
  }
  if (hasCategories)
  {
    map.NotANumber =
      glm::vec4(ToColor(property->GetRGBTransferFunction(component)->GetNanColor()), 0.0f);
  }
  map.NotANumber.w = 0.0f;
  return map;
}

std::shared_ptr<const rt::TransferFunction> vtkDSMTranslation::ToSum(vtkVolumeProperty* property,
  double first, double last, const std::array<double, 2>& counted, double unit)
{
  // As VTK's mapper for floats, a value that is the only one counts as the smallest one.
  const double smallest = first;
  const double range = last > first ? last - first : 1.0;
  vtkDSMVolumeFunctions::Widen(first, last);
  const vtkDSMVolumeFunctions functions(property, 0);
  std::vector<double> nodes = functions.GetNodes();
  nodes.insert(nodes.end(), counted.begin(), counted.end());
  const auto look = [&](double value)
  {
    const bool counts =
      std::min(counted[0], counted[1]) <= value && value <= std::max(counted[0], counted[1]);
    const double part = std::max(value - smallest, 0.0) / range;
    return rt::LatticeSum::ToLook({ functions.GetLook(value).w * part, counts ? 1.0 : 0.0 }, unit);
  };
  return rt::TransferFunction::Create(first, last, look, nodes, 0.0, 0.0);
}

std::shared_ptr<const rt::Texture> vtkDSMTranslation::ToTexture(
  vtkTexture* texture, vtkMatrix4x4* transform)
{
  vtkImageData* image = texture->GetInput();
  vtkDataArray* const scalars = image ? image->GetPointData()->GetScalars() : nullptr;
  if (!scalars || scalars->GetNumberOfTuples() == 0)
  {
    return nullptr;
  }
  // Bytes are colors, unless they are to be mapped; other values are mapped, as VTK does.
  auto* const bytes = texture->GetColorMode() != VTK_COLOR_MODE_MAP_SCALARS
    ? vtkUnsignedCharArray::SafeDownCast(scalars)
    : nullptr;
  const unsigned char* const colors =
    bytes ? bytes->GetPointer(0) : texture->MapScalarsToColors(scalars);
  auto picture = std::make_shared<rt::Texture>();
  picture->Width = image->GetDimensions()[0];
  picture->Height = image->GetDimensions()[1];
  picture->Repeat = texture->GetRepeat() != 0;
  picture->Interpolate = texture->GetInterpolate() != 0;
  picture->Transform = ToMatrix(transform);
  const int components = bytes ? bytes->GetNumberOfComponents() : 4;
  picture->Texels.resize(4 * static_cast<std::size_t>(picture->Width) * picture->Height);
  for (std::size_t texel = 0; texel < picture->Texels.size() / 4; ++texel)
  {
    const unsigned char* from = colors + texel * static_cast<std::size_t>(components);
    std::uint8_t* to = &picture->Texels[4 * texel];
    // Gray, gray and alpha, color, color and alpha.
    to[0] = from[0];
    to[1] = components > 2 ? from[1] : from[0];
    to[2] = components > 2 ? from[2] : from[0];
    to[3] = components % 2 == 0 ? from[components - 1] : 255;
  }
  return picture;
}

rt::ColorMap vtkDSMTranslation::ToColorMap(vtkScalarsToColors* table, vtkPiecewiseFunction* opacity)
{
  table->Build();
  auto* const colors = vtkColorTransferFunction::SafeDownCast(table);
  const auto look = [&](double value)
  {
    glm::vec4 color =
      MapValue(table, colors ? vtkDSMVolumeFunctions::ToKnown(colors, value) : value);
    if (opacity)
    {
      color.w =
        static_cast<float>(std::clamp(vtkDSMVolumeFunctions::GetValue(opacity, value), 0.0, 1.0));
    }
    return color;
  };
  rt::ColorMap map;
  const double* range = table->GetRange();
  map.First = range[0];
  map.Last = range[1];
  std::vector<double> nodes(range, range + 2);
  if (colors)
  {
    vtkDSMVolumeFunctions::AddNodes(colors, nodes);
  }
  if (opacity && opacity->GetSize() > 0)
  {
    vtkDSMVolumeFunctions::AddNodes(opacity, nodes);
    map.First = std::min(map.First, opacity->GetRange()[0]);
    map.Last = std::max(map.Last, opacity->GetRange()[1]);
  }
  map.Logarithmic = table->UsingLogScale() != 0 && map.First > 0.0;
  map.Below = look(std::nextafter(map.First, -std::numeric_limits<double>::infinity()));
  map.Above = look(std::nextafter(map.Last, std::numeric_limits<double>::infinity()));
  map.NotANumber = MapValue(table, vtkMath::Nan());
  // Only this way of mapping knows the opacity.
  double nan = vtkMath::Nan();
  unsigned char mapped[4];
  table->MapScalarsThroughTable2(&nan, mapped, VTK_DOUBLE, 1, 1, VTK_RGBA);
  map.NotANumber.w = static_cast<float>(mapped[3]) / 255.0f;
  if (table->GetIndexedLookup())
  {
    map.Categories = vtkDSMVolumeFunctions::FindCategories(table);
    for (rt::ColorMap::Category& category : *map.Categories)
    {
      category.Color.w *= opacity ? look(category.Value).w : 1.0f;
    }
    return map;
  }
  map.Sample(ColorMapEntries, look, nodes);
  return map;
}

rt::ClipRegion vtkDSMTranslation::ToClipRegion(vtkAbstractMapper* mapper)
{
  rt::ClipRegion region;
  vtkPlaneCollection* planes = mapper->GetClippingPlanes();
  for (int number = 0; planes && number < planes->GetNumberOfItems(); ++number)
  {
    // As VTK's mappers, without regard to a transform that a plane may have as a function.
    const double* normal = planes->GetItem(number)->GetNormal();
    const double* origin = planes->GetItem(number)->GetOrigin();
    region.HalfSpaces.push_back(
      { { normal[0], normal[1], normal[2] }, { origin[0], origin[1], origin[2] } });
  }
  return region;
}

rt::LightTransport vtkDSMTranslation::ToTransport(
  vtkDSMLightOptions* options, const double bounds[6], bool isPassing)
{
  rt::LightTransport transport;
  transport.Shadows = options->GetShadows();
  transport.LightRadius = options->GetLightRadius();
  transport.AmbientOcclusionSamples = options->GetAmbientOcclusionSamples();
  transport.AmbientOcclusionDistance = options->GetAmbientOcclusionDistance();
  transport.MaxBounces = options->GetMaxBounces();
  transport.FaintShadows = options->GetLook() == vtkDSMLightOptions::DepthLook && !isPassing &&
    !transport.Shadows && transport.AmbientOcclusionSamples == 0 &&
    options->GetEnvironmentLight() == 0.0;
  if (transport.AmbientOcclusionSamples > 0 && transport.AmbientOcclusionDistance == 0.0)
  {
    const vtkBoundingBox box(bounds);
    // Without anything to show there is no diagonal.
    transport.AmbientOcclusionDistance =
      box.IsValid() ? AmbientOcclusionPart * box.GetDiagonalLength() : 0.0;
  }
  return transport;
}

rt::DebugView vtkDSMTranslation::ToDebugView(vtkDSMLightOptions* options)
{
  using Options = vtkDSMLightOptions;
  static_assert(static_cast<int>(rt::DebugView::Off) == Options::Off &&
      static_cast<int>(rt::DebugView::Owner) == Options::Owner &&
      static_cast<int>(rt::DebugView::TracingRank) == Options::TracingRank &&
      static_cast<int>(rt::DebugView::Brick) == Options::Brick &&
      static_cast<int>(rt::DebugView::TileTime) == Options::TileTime &&
      static_cast<int>(rt::DebugView::Normal) == Options::Normal &&
      static_cast<int>(rt::DebugView::Depth) == Options::Depth &&
      static_cast<int>(rt::DebugView::NewTiles) == Options::NewTiles &&
      static_cast<int>(rt::DebugView::Misses) == Options::Misses &&
      static_cast<int>(rt::DebugView::Level) == Options::Level,
    "the options number the views as the tracer does");
  return static_cast<rt::DebugView>(options->GetDebugView());
}

std::vector<rt::Light> vtkDSMTranslation::ToLights(vtkRenderer* renderer)
{
  if (renderer->GetLights()->GetNumberOfItems() == 0 && renderer->GetAutomaticLightCreation())
  {
    renderer->CreateLight();
  }
  if (renderer->GetLightFollowCamera())
  {
    renderer->UpdateLightsGeometryToFollowCamera();
  }
  std::vector<rt::Light> lights;
  vtkCollectionSimpleIterator position;
  renderer->GetLights()->InitTraversal(position);
  while (vtkLight* source = renderer->GetLights()->GetNextLight(position))
  {
    if (!source->GetSwitch())
    {
      continue;
    }
    rt::Light light;
    double from[3];
    double to[3];
    source->GetTransformedPosition(from);
    source->GetTransformedFocalPoint(to);
    const glm::dvec3 position(from[0], from[1], from[2]);
    const glm::dvec3 way = glm::dvec3(to[0], to[1], to[2]) - position;
    const double length = glm::length(way);
    light.Direction = length > 0.0 ? way / length : glm::dvec3(0.0, 0.0, -1.0);
    const auto intensity = static_cast<float>(source->GetIntensity());
    light.Color = ToColor(source->GetDiffuseColor()) * intensity;
    light.AmbientColor = ToColor(source->GetAmbientColor()) * intensity;
    if (source->GetPositional())
    {
      const rt::PositionalLight lamp{ position, ToColor(source->GetAttenuationValues()) };
      const double angle = source->GetConeAngle();
      light.Kind = lamp;
      if (angle < 90.0)
      {
        light.Kind =
          rt::ConeLight{ lamp, static_cast<float>(std::cos(vtkMath::RadiansFromDegrees(angle))),
            static_cast<float>(source->GetExponent()) };
      }
    }
    light.IsLoneHeadlight = source->LightTypeIsHeadlight() && !source->GetPositional();
    lights.push_back(light);
  }
  if (lights.size() > 1)
  {
    std::for_each(
      lights.begin(), lights.end(), [](rt::Light& light) { light.IsLoneHeadlight = false; });
  }
  return lights;
}

rt::FrameRequest vtkDSMTranslation::ToRequest(
  vtkRenderer* renderer, const TileDisplay& display, vtkMatrix4x4* projection)
{
  rt::FrameRequest request;
  int* const size[2] = { &request.Width, &request.Height };
  int origin[2];
  renderer->GetTiledSizeAndOrigin(size[0], size[1], &origin[0], &origin[1]);
  double aspect = renderer->GetTiledAspectRatio();
  if (display.Tiles[0] * display.Tiles[1] > 1)
  {
    // IceT's places of the renderer in the display, and its aspect.
    const int* window = renderer->GetVTKWindow()->GetActualSize();
    const double* viewport = renderer->GetViewport();
    for (int axis = 0; axis < 2; ++axis)
    {
      const int whole =
        display.Tiles[axis] * (window[axis] + display.Gap[axis]) - display.Gap[axis];
      *size[axis] = static_cast<int>(viewport[axis + 2] * whole + 0.5) -
        static_cast<int>(viewport[axis] * whole + 0.5);
    }
    aspect = static_cast<double>(request.Width) / std::max(request.Height, 1);
  }
  SetCamera(renderer, aspect, projection, request);
  return request;
}

rt::FrameRequest vtkDSMTranslation::ToRequest(
  vtkRenderer* renderer, int width, int height, vtkMatrix4x4* projection)
{
  rt::FrameRequest request;
  request.Width = width;
  request.Height = height;
  SetCamera(renderer, static_cast<double>(width) / height, projection, request);
  return request;
}
