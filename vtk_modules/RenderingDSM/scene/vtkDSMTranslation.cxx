// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMTranslation.h"

#include "DSMRayTracing/frame/PixelRays.h"
#include "vtkDSMCompatibility.h"
#include "vtkDSMLightOptions.h"

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

/// The next values beyond the ends of a map.
double GetBelow(const rt::ColorMap& map)
{
  return std::nextafter(map.First, -std::numeric_limits<double>::infinity());
}
double GetAbove(const rt::ColorMap& map)
{
  return std::nextafter(map.Last, std::numeric_limits<double>::infinity());
}

glm::vec4 MapValue(vtkScalarsToColors* table, double value)
{
  double color[3];
  table->GetColor(value, color);
  return { color[0], color[1], color[2], table->GetOpacity(value) };
}

/// Returns the annotations that are numbers.
std::vector<rt::ColorMap::Category> ToCategories(vtkScalarsToColors* table)
{
  std::vector<rt::ColorMap::Category> categories;
  for (vtkIdType index = 0; index < table->GetNumberOfAnnotatedValues(); ++index)
  {
    bool isNumber = false;
    const double value = table->GetAnnotatedValue(index).ToDouble(&isNumber);
    if (isNumber && !std::isnan(value))
    {
      double color[4];
      table->GetIndexedColor(index, color);
      categories.push_back({ value, { color[0], color[1], color[2], color[3] } });
    }
  }
  std::sort(categories.begin(), categories.end(),
    [](const auto& a, const auto& b) { return a.Value < b.Value; });
  return categories;
}

/// Widens a range of a single value.
void Widen(double& first, double& last)
{
  if (!(first < last))
  {
    const double half = std::max(1.0, std::abs(first)) * 1e-3;
    first -= half;
    last += half;
  }
}

/// The color and opacity functions of a volume property's component. Keeps references.
class VolumeFunctions
{
public:
  VolumeFunctions(vtkVolumeProperty* property, int component)
    : Opacity(property->GetScalarOpacity(component))
  {
    // To ask for the other one would make it the one that counts.
    if (property->GetColorChannels(component) == 1)
    {
      this->Gray = property->GetGrayTransferFunction(component);
    }
    else
    {
      this->Colors = property->GetRGBTransferFunction(component);
    }
  }

  /// If both functions are clamped, limits a range of values to that of the functions. The result
  /// is never empty.
  void Narrow(double& first, double& last) const
  {
    const bool areClamped = this->Opacity->GetClamping() != 0 &&
      (this->Gray ? this->Gray->GetClamping() : this->Colors->GetClamping()) != 0;
    if (areClamped)
    {
      const double* const ofColors = this->Gray ? this->Gray->GetRange() : this->Colors->GetRange();
      const double* const ofOpacity = this->Opacity->GetRange();
      const double low = std::max(first, std::min(ofColors[0], ofOpacity[0]));
      const double high = std::min(last, std::max(ofColors[1], ofOpacity[1]));
      first = low < high ? low : first;
      last = low < high ? high : last;
    }
    Widen(first, last);
  }

  /// Returns whether the functions are spread over the decades of values from `first` on.
  bool AreLogarithmic(double first) const
  {
    return first > 0.0 && (this->Opacity->GetUseLogScale() || this->HasLogColors());
  }

  /// How many bins of a range of values the functions need: the lowest decade gets some, too.
  int CountBins(double first, double last) const
  {
    constexpr double inLowest = 64.0;
    constexpr int most = 1 << 18;
    int bins = rt::TransferFunction::Bins;
    while (
      this->AreLogarithmic(first) && 9.0 * first * bins < inLowest * (last - first) && bins < most)
    {
      bins *= 2;
    }
    return bins;
  }

  /// Colors (not premultiplied) and opacities (w) of so many values, evenly spaced from `first` to `last`.
  std::vector<glm::dvec4> Sample(double first, double last, int count) const
  {
    const std::size_t channels = this->Gray ? 1 : 3;
    std::vector<double> opacities(static_cast<std::size_t>(count));
    std::vector<double> colors(channels * opacities.size());
    this->Opacity->GetTable(first, last, count, opacities.data());
    if (this->Gray)
    {
      this->Gray->GetTable(first, last, count, colors.data());
    }
    else if (count > 1 && first > 0.0 && this->HasLogColors())
    {
      this->SampleLogColors(first, last, colors);
    }
    else
    {
      this->Colors->GetTable(first, last, count, colors.data());
    }
    std::vector<glm::dvec4> samples;
    for (std::size_t sample = 0; sample < opacities.size(); ++sample)
    {
      const double* const own = &colors[channels * sample];
      samples.emplace_back(
        own[0], own[this->Gray ? 0 : 1], own[this->Gray ? 0 : 2], opacities[sample]);
    }
    return samples;
  }

private:
  bool HasLogColors() const
  {
    return this->Colors && this->Colors->GetScale() == VTK_CTF_LOG10 &&
      this->Colors->GetRange()[0] > 0.0;
  }

  /// Tables of such colors are spaced evenly in the logarithm of the value.
  void SampleLogColors(double first, double last, std::vector<double>& colors) const
  {
    std::vector<double> table(std::size_t{ 3 } * ColorMapEntries);
    this->Colors->GetTable(first, last, ColorMapEntries, table.data());
    const std::size_t count = colors.size() / 3;
    const double scale = (ColorMapEntries - 1) / std::log(last / first);
    for (std::size_t sample = 0; sample < count; ++sample)
    {
      const double part = static_cast<double>(sample) / static_cast<double>(count - 1);
      const double place = scale * std::log(1.0 + part * (last / first - 1.0));
      const auto entry = static_cast<std::size_t>(
        std::clamp(std::floor(place), 0.0, static_cast<double>(ColorMapEntries - 2)));
      const double rest = place - static_cast<double>(entry);
      for (std::size_t channel = 0; channel < 3; ++channel)
      {
        const double* const own = &table[3 * entry + channel];
        colors[3 * sample + channel] = own[0] + rest * (own[3] - own[0]);
      }
    }
  }

  vtkPiecewiseFunction* Opacity;
  vtkPiecewiseFunction* Gray = nullptr;
  vtkColorTransferFunction* Colors = nullptr;
};

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
  double color[3];
  if (property->GetColorChannels(0) == 1)
  {
    std::fill_n(color, 3, property->GetGrayTransferFunction(0)->GetValue(isovalue));
  }
  else
  {
    property->GetRGBTransferFunction(0)->GetColor(isovalue, color);
  }
  rt::Material material;
  material.Lighting = property->GetShade(0) != 0;
  // Without shading, the transfer function's color as it is.
  material.Ambient = material.Lighting ? static_cast<float>(property->GetAmbient(0)) : 1.0f;
  material.Diffuse = material.Lighting ? static_cast<float>(property->GetDiffuse(0)) : 0.0f;
  material.Specular = static_cast<float>(property->GetSpecular(0));
  material.SpecularPower = static_cast<float>(property->GetSpecularPower(0));
  material.AmbientColor = ToColor(color);
  material.DiffuseColor = ToColor(color);
  material.Opacity = static_cast<float>(property->GetScalarOpacity(0)->GetValue(isovalue));
  return material;
}

std::shared_ptr<const rt::TransferFunction> vtkDSMTranslation::ToTransferFunction(
  vtkVolumeProperty* property, int component, double weight, double first, double last,
  double cellLength, double diagonal)
{
  const VolumeFunctions functions(property, component);
  functions.Narrow(first, last);
  std::vector<glm::dvec4> samples =
    functions.Sample(first, last, functions.CountBins(first, last) + 1);
  const double unit = property->GetScalarOpacityUnitDistance(component);
  for (glm::dvec4& sample : samples)
  {
    // Skip values that are invisible even if the whole length of a ray has them.
    const double extinction = -weight * std::log1p(-std::clamp(sample.w, 0.0, MostOpacity)) / unit;
    sample.w = extinction * diagonal < LeastDepth ? 0.0 : extinction;
  }
  return std::make_shared<const rt::TransferFunction>(first, last, samples, cellLength);
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
  if (property->HasGradientOpacity(component) && range > 0.0)
  {
    // As VTK's mapper, which takes what values do in a cell to be a quarter of their range at most.
    constexpr int count = 1024;
    rt::GradientOpacity opacity;
    opacity.Last = 0.25 * range;
    opacity.Factors.resize(count);
    property->GetGradientOpacity(component)->GetTable(
      0.0, opacity.Last, count, opacity.Factors.data());
    look.Gradients = std::make_shared<const rt::GradientOpacity>(std::move(opacity));
  }
  return look;
}

std::shared_ptr<const rt::ColorMap> vtkDSMTranslation::ToColorMap(
  vtkVolumeProperty* property, int component, double first, double last)
{
  const VolumeFunctions functions(property, component);
  functions.Narrow(first, last);
  auto map = std::make_shared<rt::ColorMap>();
  map->First = first;
  map->Last = last;
  map->Logarithmic = functions.AreLogarithmic(first);
  map->Table.resize(ColorMapEntries);
  for (std::size_t entry = 0; entry < map->Table.size(); ++entry)
  {
    const double value = map->GetValue(entry);
    map->Table[entry] = functions.Sample(value, value, 1).front();
  }
  map->Below = map->Table.front();
  map->Above = map->Table.back();
  return map;
}

rt::ColorMap vtkDSMTranslation::ToOpaqueColors(
  vtkVolumeProperty* property, int component, const bricks::ValueRange& range)
{
  // To ask for the other one would make it the one that counts.
  rt::ColorMap map = property->GetColorChannels(component) == 1
    ? *ToColorMap(property, component, range.First, range.Last)
    : ToColorMap(property->GetRGBTransferFunction(component));
  for (glm::vec4& color : map.Table)
  {
    color.w = 1.0f;
  }
  map.Below.w = 1.0f;
  map.Above.w = 1.0f;
  map.NotANumber = glm::vec4(0.0f);
  return map;
}

std::shared_ptr<const rt::TransferFunction> vtkDSMTranslation::ToSum(vtkVolumeProperty* property,
  double first, double last, const std::array<double, 2>& counted, double unit)
{
  Widen(first, last);
  const VolumeFunctions functions(property, 0);
  const int bins = functions.CountBins(first, last);
  const std::vector<glm::dvec4> looks = functions.Sample(first, last, bins + 1);
  std::vector<rt::LatticeSum::Sample> samples;
  for (const glm::dvec4& look : looks)
  {
    const double part = static_cast<double>(samples.size()) / bins;
    const double value = first + part * (last - first);
    const bool counts =
      std::min(counted[0], counted[1]) <= value && value <= std::max(counted[0], counted[1]);
    samples.push_back({ look.w * part, counts ? 1.0 : 0.0 });
  }
  return rt::LatticeSum::CreateFunction(first, last, samples, unit);
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

rt::ColorMap vtkDSMTranslation::ToColorMap(vtkScalarsToColors* table)
{
  table->Build();
  rt::ColorMap map;
  const double* range = table->GetRange();
  map.First = range[0];
  map.Last = range[1];
  map.Logarithmic = table->UsingLogScale() != 0 && map.First > 0.0;
  map.Below = MapValue(table, GetBelow(map));
  map.Above = MapValue(table, GetAbove(map));
  map.NotANumber = MapValue(table, vtkMath::Nan());
  // Only this way of mapping knows the opacity.
  double nan = vtkMath::Nan();
  unsigned char mapped[4];
  table->MapScalarsThroughTable2(&nan, mapped, VTK_DOUBLE, 1, 1, VTK_RGBA);
  map.NotANumber.w = static_cast<float>(mapped[3]) / 255.0f;
  if (table->GetIndexedLookup())
  {
    map.Categories = ToCategories(table);
    return map;
  }
  map.Table.resize(ColorMapEntries);
  for (std::size_t entry = 0; entry < map.Table.size(); ++entry)
  {
    map.Table[entry] = MapValue(table, map.GetValue(entry));
  }
  return map;
}

void vtkDSMTranslation::SetOpacity(vtkPiecewiseFunction* opacity, rt::ColorMap& map)
{
  const auto get = [&](double value)
  { return static_cast<float>(std::clamp(opacity->GetValue(value), 0.0, 1.0)); };
  for (std::size_t entry = 0; entry < map.Table.size(); ++entry)
  {
    map.Table[entry].w = get(map.GetValue(entry));
  }
  map.Below.w = get(GetBelow(map));
  map.Above.w = get(GetAbove(map));
  if (map.Categories)
  {
    for (rt::ColorMap::Category& category : *map.Categories)
    {
      category.Color.w = get(category.Value);
    }
  }
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
      static_cast<int>(rt::DebugView::Misses) == Options::Misses,
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
    light.Position = { from[0], from[1], from[2] };
    const glm::dvec3 way = glm::dvec3(to[0], to[1], to[2]) - light.Position;
    const double length = glm::length(way);
    light.Direction = length > 0.0 ? way / length : glm::dvec3(0.0, 0.0, -1.0);
    const auto intensity = static_cast<float>(source->GetIntensity());
    light.Color = ToColor(source->GetDiffuseColor()) * intensity;
    light.AmbientColor = ToColor(source->GetAmbientColor()) * intensity;
    if (source->GetPositional())
    {
      light.Type =
        source->GetConeAngle() < 90.0 ? rt::Light::Kind::Cone : rt::Light::Kind::Positional;
      light.ConeCosine =
        static_cast<float>(std::cos(vtkMath::RadiansFromDegrees(source->GetConeAngle())));
      light.Exponent = static_cast<float>(source->GetExponent());
      light.Attenuation = ToColor(source->GetAttenuationValues());
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
