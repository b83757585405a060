// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMVolumeLook.h"

#include "vtkDSMImagePiece.h"
#include "vtkDSMLightOptions.h"
#include "vtkDSMTranslation.h"
#include "vtkDSMVolumeMapper.h"

#include "vtkCellData.h"
#include "vtkColorTransferFunction.h"
#include "vtkContourValues.h"
#include "vtkDataSet.h"
#include "vtkPlane.h"
#include "vtkPlaneCollection.h"
#include "vtkPointData.h"
#include "vtkProp3D.h"
#include "vtkProperty.h"
#include "vtkScalarsToColors.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>

#include <algorithm>
#include <cmath>
#include <set>
#include <type_traits>
#include <utility>
#include <variant>

vtkDSMVolumeLook::vtkDSMVolumeLook(vtkDSMVolumeMapper* mapper, vtkProp3D* prop)
  : Mapper(mapper)
  , Prop(prop)
{
}

bool vtkDSMVolumeLook::IsLikeRayCastMapper() const
{
  return this->Mapper->GetBlendMode() == vtkVolumeMapper::ISOSURFACE_BLEND &&
    vtkVolume::SafeDownCast(this->Prop);
}

bool vtkDSMVolumeLook::IsMedium() const
{
  return vtkVolume::SafeDownCast(this->Prop) && !this->Mapper->GetSurfacesOnly() &&
    !this->Mapper->GetAutomaticIsoValue() && this->Mapper->GetNumberOfIsoValues() == 0 &&
    this->Mapper->GetBlendMode() != vtkVolumeMapper::ISOSURFACE_BLEND &&
    !this->Mapper->GetSlicing();
}

bool vtkDSMVolumeLook::IsSlicesOnly() const
{
  return this->Mapper->GetSlicing() && !this->Mapper->GetAutomaticIsoValue() &&
    this->Mapper->GetNumberOfIsoValues() == 0 && !this->IsLikeRayCastMapper();
}

bool vtkDSMVolumeLook::HasColoredSlices() const
{
  return this->Mapper->GetScalarVisibility() &&
    (this->Mapper->GetLookupTable() || !this->Mapper->GetMapScalars());
}

std::vector<rt::SectionPlane> vtkDSMVolumeLook::GetSlices(
  const glm::dmat4& dataToWorld, const vtkDSMPartValues& values) const
{
  std::vector<rt::SectionPlane> slices;
  const glm::dmat4 toWorld = dataToWorld * values.GetIndexToData();
  const bricks::Index3 count = values.CountSlices();
  const bricks::GridPlanes* const grid = values.GetPlanes();
  const glm::dmat3 toIndex = glm::inverse(glm::dmat3(toWorld));
  std::set<std::pair<int, int>> indices; // each once
  for (int number = 0; number < this->Mapper->GetNumberOfSlices(); ++number)
  {
    const int axis = this->Mapper->GetSliceAxis(number);
    const int index = this->Mapper->GetSliceIndex(number);
    indices.emplace(axis, index < 0 ? (this->Mapper->GetSlicePoints()[axis] - 1) / 2 : index);
  }
  for (const auto& [axis, index] : indices)
  {
    if (index < count[axis])
    {
      glm::dvec4 place(0.0, 0.0, 0.0, 1.0);
      place[axis] = grid ? grid->GetPlace(axis, index) : index;
      glm::dvec3 normal(0.0);
      normal[axis] = 1.0;
      slices.push_back({ glm::normalize(normal * toIndex), glm::dvec3(toWorld * place) });
    }
  }
  vtkPlaneCollection* const planes = this->Mapper->GetSlicePlanes();
  for (int number = 0; planes && number < planes->GetNumberOfItems(); ++number)
  {
    const double* normal = planes->GetItem(number)->GetNormal();
    const double* origin = planes->GetItem(number)->GetOrigin();
    slices.push_back({ { normal[0], normal[1], normal[2] }, { origin[0], origin[1], origin[2] } });
  }
  return slices;
}

vtkDSMVolumeLook::MediumKey vtkDSMVolumeLook::GetMediumKey(const bricks::ValueRange& range,
  double cellLength, double diagonal, const std::optional<int>& component, Sampling sampling) const
{
  vtkVolumeProperty* const property = vtkVolume::SafeDownCast(this->Prop)->GetProperty();
  const double* const averaged = this->Mapper->GetAverageIPScalarRange();
  const int mode = this->Mapper->GetBlendMode();
  const bool isComposite = mode == vtkVolumeMapper::COMPOSITE_BLEND;
  return { range.First, range.Last,
    isComposite || mode == vtkVolumeMapper::AVERAGE_INTENSITY_BLEND ? cellLength : 0.0,
    isComposite ? diagonal : 0.0, property, property->GetMTime(), mode,
    { averaged[0], averaged[1] }, component.value_or(0),
    component ? property->GetComponentWeight(*component) : 1.0, sampling };
}

vtkDSMVolumeLook::MediumMaker vtkDSMVolumeLook::GetMediumMaker(const MediumKey& key)
{
  const auto& [first, last, cellLength, diagonal, property, time, mode, averaged, component, weight,
    sampling] = key;
  switch (mode)
  {
    case vtkVolumeMapper::COMPOSITE_BLEND:
    {
      rt::MediumLook look = vtkDSMTranslation::ToMediumLook(property, component, last - first);
      look.Nearest = sampling != Sampling::Linear;
      return [function = vtkDSMTranslation::ToTransferFunction(property, component, weight, first,
                last, cellLength, diagonal, sampling == Sampling::Categories),
               look](const rt::AnyField& any, const rt::ClipRegion& clipping)
      {
        return std::visit(
          [&](const auto& field) -> rt::SceneMedium {
            return rt::MediumOf<std::decay_t<decltype(field)>>{ field, function, look, clipping };
          },
          any);
      };
    }
    case vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND:
    case vtkVolumeMapper::MINIMUM_INTENSITY_BLEND:
      return [colors = vtkDSMTranslation::ToColorMap(property, component, first, last),
               isMinimum = mode == vtkVolumeMapper::MINIMUM_INTENSITY_BLEND](
               const rt::AnyField& any, const rt::ClipRegion& clipping)
      {
        return std::visit(
          [&](const auto& field) -> rt::SceneMedium {
            return rt::ExtremumOf<std::decay_t<decltype(field)>>{ field, colors, isMinimum,
              clipping };
          },
          any);
      };
    case vtkDSMVolumeMapper::INTEGRAL_BLEND:
      return [colors = vtkDSMTranslation::ToColorMap(property, component, first, last)](
               const rt::AnyField& any, const rt::ClipRegion& clipping)
      {
        return std::visit(
          [&](const auto& field) -> rt::SceneMedium {
            return rt::IntegralOf<std::decay_t<decltype(field)>>{ field, colors, clipping };
          },
          any);
      };
    case vtkVolumeMapper::AVERAGE_INTENSITY_BLEND:
    case vtkVolumeMapper::ADDITIVE_BLEND:
    {
      const bool isMean = mode == vtkVolumeMapper::AVERAGE_INTENSITY_BLEND;
      const auto function = vtkDSMTranslation::ToSum(property, first, last,
        isMean ? averaged : std::array<double, 2>{ first, last },
        isMean ? cellLength : property->GetScalarOpacityUnitDistance(0));
      return [=](const rt::AnyField& any, const rt::ClipRegion& clipping)
      {
        return std::visit(
          [&](const auto& field) -> rt::SceneMedium {
            return rt::SumOf<std::decay_t<decltype(field)>>{ field, function, isMean, clipping };
          },
          any);
      };
    }
    default:
      return {};
  }
}

vtkDSMVolumeLook::Components vtkDSMVolumeLook::GetComponents(const vtkDSMImageArrays& arrays) const
{
  // Another component, or the magnitude, is asked for by itself.
  if (!this->IsMedium() || this->Mapper->GetBlendMode() != vtkVolumeMapper::COMPOSITE_BLEND ||
    !this->Mapper->GetOpacityArray().empty() || this->Mapper->GetIsoComponent() != 0)
  {
    return Components::One;
  }
  const int components = arrays.CountComponents(this->GetIsoChoice(arrays));
  if (components <= 1)
  {
    return Components::One;
  }
  if (vtkVolume::SafeDownCast(this->Prop)->GetProperty()->GetIndependentComponents())
  {
    return components <= VTK_MAX_VRCOMP ? Components::Independent : Components::One;
  }
  return components == 2 || components == 4 ? Components::Dependent : Components::Refused;
}

vtkDSMVolumeLook::Sampling vtkDSMVolumeLook::GetRequestedSampling(int component) const
{
  vtkVolumeProperty* const property = vtkVolume::SafeDownCast(this->Prop)->GetProperty();
  // To ask for the color function of a gray component would make it the one that counts.
  const bool hasCategories = property->GetColorChannels(component) == 3 &&
    property->GetRGBTransferFunction(component)->GetIndexedLookup() != 0;
  return hasCategories                                              ? Sampling::Categories
    : property->GetInterpolationType() == VTK_NEAREST_INTERPOLATION ? Sampling::Nearest
                                                                    : Sampling::Linear;
}

std::optional<vtkDSMVolumeLook::Obstacle> vtkDSMVolumeLook::FindNearestObstacle(
  const vtkDSMImageArrays& arrays, bool isOfSamples) const
{
  if (this->Mapper->GetBlendMode() != vtkVolumeMapper::COMPOSITE_BLEND)
  {
    return Obstacle{ "in this blend mode",
      "Call SetBlendModeToComposite(). In ParaView, set Blend Mode to Composite." };
  }
  if (!isOfSamples)
  {
    return Obstacle{ "for AMR and hyper tree grids",
      "Draw slices with InterpolateSlicesOff(). In ParaView, use DSM Slices without Interpolate "
      "Values, or apply Resample To Image." };
  }
  const std::vector<vtkDSMVolumeData::Choice> shown = this->GetShown(arrays);
  if (std::any_of(shown.begin(), shown.end(), [](const auto& choice) { return choice.OnCells; }))
  {
    return Obstacle{ "for values of cells",
      "Draw slices. In ParaView, use DSM Slices, or apply Resample To Image, which gives each "
      "point the value of its cell." };
  }
  return std::nullopt;
}

vtkDSMVolumeLook::Sampling vtkDSMVolumeLook::GetSampling(
  const vtkDSMImageArrays& arrays, bool isOfSamples, int component) const
{
  return this->FindNearestObstacle(arrays, isOfSamples) ? Sampling::Linear
                                                        : this->GetRequestedSampling(component);
}

void vtkDSMVolumeLook::FindMissingFeatures(
  const vtkDSMImageArrays& arrays, bool isOfSamples, std::vector<std::string>& warnings) const
{
  vtkVolumeProperty* const property = vtkVolume::SafeDownCast(this->Prop)->GetProperty();
  const auto warn = [&](bool isMissing, const std::string& feature, const std::string& remedy)
  {
    if (isMissing)
    {
      warnings.push_back("The volume is to be drawn with " + feature +
        ", which DSM Ray Tracer does not support for volumes. The volume is drawn without it. " +
        remedy);
    }
  };
  warn(property->GetTransferFunctionMode() == vtkVolumeProperty::TF_2D,
    "a two-dimensional transfer function", "Call SetTransferFunctionModeTo1D().");
  if (property->GetShade(0) != 0 && this->Mapper->GetComputeNormalFromOpacity())
  {
    warnings.push_back("The mapper is to compute normals from the opacity, which DSM Ray Tracer "
                       "does not do. The volume is shaded by the gradient of its values. Call "
                       "ComputeNormalFromOpacityOff().");
  }
  warn(!this->Mapper->GetOpacityArray().empty() && !this->HasOpacityArray(),
    "opacities from another array, in this blend mode",
    "Call SetBlendModeToComposite() or SetOpacityArray(\"\") on the mapper. In ParaView, set Blend "
    "Mode to Composite, or turn off Use Separate Opacity Array.");
  const Sampling requested = this->GetRequestedSampling(0);
  const auto found = this->FindNearestObstacle(arrays, isOfSamples);
  const Obstacle obstacle = found.value_or(Obstacle{});
  warn(found && requested == Sampling::Categories, "a color for each category " + obstacle.Reason,
    obstacle.Remedy +
      " Or call IndexedLookupOff() on the color function. In ParaView, turn off "
      "Interpret Values As Categories.");
  warn(found && requested == Sampling::Nearest,
    "the nearest sample (VTK's default) instead of linear interpolation " + obstacle.Reason,
    "Call SetInterpolationTypeToLinear(). In ParaView, set Interpolation Type to Linear. For "
    "labels: " +
      obstacle.Remedy);
  if (this->HasOpacityArray() || this->GetComponents(arrays) != Components::One)
  {
    return;
  }
  const int components = arrays.CountComponents(this->GetIsoChoice(arrays));
  warn(components > 1 && property->GetIndependentComponents() == 0,
    "colors or opacities from other components of the array, in this blend mode or with this "
    "component",
    "Call SetBlendModeToComposite() and SetIsoComponent(0) on the mapper, or call "
    "IndependentComponentsOn(). In ParaView, turn on Map Scalars and turn off Multi Components "
    "Mapping, or use the representation Volume.");
  const auto isWeighted = [&]
  {
    for (int component = 1; component < std::min(components, VTK_MAX_VRCOMP); ++component)
    {
      if (property->GetComponentWeight(component) != 0.0)
      {
        return true;
      }
    }
    return false;
  };
  warn(property->GetIndependentComponents() != 0 && this->Mapper->GetIsoComponent() == 0 &&
      isWeighted(),
    "all components of the array at once, in this blend mode or where there are more than four",
    "The first component is drawn. Call SetComponentWeight(COMPONENT, 0.0) for the others, or call "
    "SetIsoComponent() on the mapper to draw another component or the magnitude (-1).");
}

bool vtkDSMVolumeLook::HasOpacityArray() const
{
  return this->IsMedium() && !this->Mapper->GetOpacityArray().empty() &&
    this->Mapper->GetBlendMode() == vtkVolumeMapper::COMPOSITE_BLEND;
}

bool vtkDSMVolumeLook::HasColorArray() const
{
  return this->HasColoredSlices() && !this->Mapper->GetColorArray().empty();
}

int vtkDSMVolumeLook::GetColorComponent() const
{
  vtkScalarsToColors* table = this->Mapper->GetLookupTable();
  if (!this->Mapper->GetMapScalars())
  {
    return vtkDSMImagePiece::Color;
  }
  return table->GetVectorMode() == vtkScalarsToColors::COMPONENT ? table->GetVectorComponent()
                                                                 : vtkDSMImagePiece::Magnitude;
}

std::vector<vtkDSMVolumeData::Choice> vtkDSMVolumeLook::GetShown(
  const vtkDSMImageArrays& arrays) const
{
  vtkDSMVolumeMapper* mapper = this->Mapper;
  std::vector<vtkDSMVolumeData::Choice> shown;
  const vtkDSMVolumeData::Choice iso = this->GetIsoChoice(arrays);
  const auto ofIso = [&iso](int component)
  {
    vtkDSMVolumeData::Choice choice = iso;
    choice.Component = component;
    return choice;
  };
  if (this->HasOpacityArray())
  {
    const bool onCells = mapper->GetOpacityArrayOnCells();
    vtkDSMVolumeData::Choice opacity{ mapper->GetOpacityArray(), mapper->GetOpacityComponent(),
      onCells, onCells };
    opacity.Mask = iso.Mask;
    return { opacity, iso };
  }
  const Components kind = this->GetComponents(arrays);
  const int components = arrays.CountComponents(iso);
  if (kind == Components::Dependent)
  {
    return { ofIso(components - 1), ofIso(components == 2 ? 0 : vtkDSMImagePiece::Color) };
  }
  if (kind == Components::Independent)
  {
    vtkVolumeProperty* const property = vtkVolume::SafeDownCast(this->Prop)->GetProperty();
    for (int component = 0; component < components; ++component)
    {
      if (property->GetComponentWeight(component) > 0.0)
      {
        shown.push_back(ofIso(component));
      }
    }
    if (!shown.empty())
    {
      return shown;
    }
  }
  const bool isColored = !this->IsMedium() && this->HasColorArray();
  if (!isColored || !this->IsSlicesOnly())
  {
    shown.push_back(iso);
  }
  if (isColored)
  {
    vtkDSMVolumeData::Choice color{ mapper->GetColorArray(), this->GetColorComponent(),
      mapper->GetColorArrayOnCells() };
    const bool isIso = color.Name == iso.Name && color.OnCells == iso.OnCells;
    if (isIso || this->IsSlicesOnly())
    {
      color.Valid = iso.Valid;
      color.Mask = iso.Mask;
    }
    shown.push_back(color);
  }
  return shown;
}

vtkDSMVolumeData::Choice vtkDSMVolumeLook::GetIsoChoice(const vtkDSMImageArrays& arrays) const
{
  vtkDSMVolumeData::Choice choice = this->GetNamedIsoChoice();
  const vtkDSMVolumeData::Choice ofCells{ "", 0, true };
  if (choice.Name.empty() && !choice.OnCells &&
    this->Mapper->GetScalarMode() != VTK_SCALAR_MODE_USE_POINT_DATA &&
    arrays.CountComponents(choice) == 0 && arrays.CountComponents(ofCells) > 0)
  {
    choice.OnCells = true;
  }
  choice.IsAveraged = choice.OnCells;
  if (this->Mapper->GetIgnoreValues())
  {
    const double* const range = this->Mapper->GetValidRange();
    choice.Valid.Lowest = range[0];
    choice.Valid.Highest = range[1];
  }
  if (!this->Mapper->GetMaskArray().empty())
  {
    const double* const range = this->Mapper->GetMaskRange();
    choice.Mask = { this->Mapper->GetMaskArray(), this->Mapper->GetMaskArrayOnCells(), range[0],
      range[1], this->Mapper->GetMaskValues() };
  }
  return choice;
}

vtkDSMVolumeData::Choice vtkDSMVolumeLook::GetNamedIsoChoice() const
{
  vtkDSMVolumeMapper* mapper = this->Mapper;
  // The number that stands for colors is not a component of an isosurface array.
  constexpr int none = std::numeric_limits<int>::min();
  const int component =
    mapper->GetIsoComponent() >= vtkDSMImagePiece::Magnitude ? mapper->GetIsoComponent() : none;
  if (!mapper->GetIsoArray().empty() || !(this->IsLikeRayCastMapper() || this->IsMedium()))
  {
    return { mapper->GetIsoArray(), component, mapper->GetIsoArrayOnCells() };
  }
  const int mode = mapper->GetScalarMode();
  const bool onCells =
    mode == VTK_SCALAR_MODE_USE_CELL_DATA || mode == VTK_SCALAR_MODE_USE_CELL_FIELD_DATA;
  if (mode != VTK_SCALAR_MODE_USE_POINT_FIELD_DATA && mode != VTK_SCALAR_MODE_USE_CELL_FIELD_DATA)
  {
    return { "", component, onCells };
  }
  const char* name = mapper->GetArrayName();
  if (mapper->GetArrayAccessMode() != VTK_GET_ARRAY_BY_NAME)
  {
    auto* data = vtkDataSet::SafeDownCast(mapper->GetDataObjectInput());
    name = !data ? nullptr
      : onCells  ? data->GetCellData()->GetArrayName(mapper->GetArrayId())
                 : data->GetPointData()->GetArrayName(mapper->GetArrayId());
  }
  return { name ? name : "", component, onCells };
}

void vtkDSMVolumeLook::SetMaterials(double isovalue, rt::IsosurfaceLook& look) const
{
  const auto reflectivity = static_cast<float>(this->Mapper->GetLightOptions()->GetReflectivity());
  if (this->IsLikeRayCastMapper())
  {
    look.Surface =
      vtkDSMTranslation::ToMaterial(vtkVolume::SafeDownCast(this->Prop)->GetProperty(), isovalue);
  }
  else
  {
    vtkProperty* const property = this->Mapper->GetSurfaceProperty();
    look.Surface = vtkDSMTranslation::ToMaterial(property);
    look.CullsFront = property->GetFrontfaceCulling() != 0;
    look.CullsBack = property->GetBackfaceCulling() != 0;
    look.Flat = property->GetInterpolation() == VTK_FLAT;
    if (vtkProperty* const back = this->Mapper->GetBackfaceProperty())
    {
      look.BackSurface = vtkDSMTranslation::ToMaterial(back);
      look.BackSurface->Reflectivity = reflectivity;
    }
  }
  look.Surface.Reflectivity = reflectivity;
}

std::vector<double> vtkDSMVolumeLook::GetIsovalues(
  const std::optional<double>& suggested, std::vector<std::string>& messages) const
{
  vtkDSMVolumeMapper* mapper = this->Mapper;
  std::vector<double> chosen;
  if (this->IsLikeRayCastMapper())
  {
    vtkContourValues* contours =
      vtkVolume::SafeDownCast(this->Prop)->GetProperty()->GetIsoSurfaceValues();
    for (int index = 0; index < contours->GetNumberOfContours(); ++index)
    {
      chosen.push_back(contours->GetValue(index));
    }
    if (chosen.empty())
    {
      messages.push_back("The volume's property has no isosurface value, so nothing is drawn. Call "
                         "GetIsoSurfaceValues()->SetValue(0, VALUE) on it.");
    }
  }
  else
  {
    for (int index = 0; index < mapper->GetNumberOfIsoValues(); ++index)
    {
      chosen.push_back(mapper->GetIsoValue(index));
    }
    if (chosen.empty() && mapper->GetAutomaticIsoValue() && suggested)
    {
      chosen.push_back(*suggested);
    }
    else if (chosen.empty() && !mapper->GetAutomaticIsoValue())
    {
      messages.push_back(
        "The mapper has no isovalue, so nothing is drawn. Call SetIsoValue(0, VALUE), or call "
        "AutomaticIsoValueOn() to choose an isovalue from the data.");
    }
    if (mapper->GetBlendMode() != vtkVolumeMapper::COMPOSITE_BLEND)
    {
      messages.push_back(
        "The mapper has isovalues, so it ignores the blend mode and draws isosurfaces. Call "
        "SetNumberOfIsoValues(0) and AutomaticIsoValueOff() to draw a volume.");
    }
  }
  std::vector<double> values;
  for (std::size_t index = 0; index < chosen.size(); ++index)
  {
    const double value = chosen[index];
    if (std::isfinite(value))
    {
      values.push_back(value);
    }
    else
    {
      const std::string which = chosen.size() == 1
        ? "The isovalue"
        : "Isovalue " + std::to_string(index + 1) + " of " + std::to_string(chosen.size());
      messages.push_back(which + " is " + (std::isnan(value) ? "not a number" : "infinite") +
        " and is ignored. Enter a finite value.");
    }
  }
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

rt::ClipRegion vtkDSMVolumeLook::GetClipRegion(const glm::dmat4& dataToWorld) const
{
  rt::ClipRegion region = vtkDSMTranslation::ToClipRegion(this->Mapper);
  if (this->Mapper->GetCropping())
  {
    const double* planes = this->Mapper->GetCroppingRegionPlanes();
    rt::ClipRegion::Grid boxes;
    boxes.WorldToGrid = glm::inverse(dataToWorld);
    for (int axis = 0; axis < 3; ++axis)
    {
      boxes.Lower[axis] = std::min(planes[2 * axis], planes[2 * axis + 1]);
      boxes.Upper[axis] = std::max(planes[2 * axis], planes[2 * axis + 1]);
    }
    boxes.Kept = static_cast<std::uint32_t>(this->Mapper->GetCroppingRegionFlags());
    region.Boxes = boxes;
  }
  return region;
}

std::vector<rt::SectionPlane> vtkDSMVolumeLook::GetFaces(const rt::ClipRegion& region)
{
  std::vector<rt::SectionPlane> planes;
  for (const rt::ClipRegion::HalfSpace& half : region.HalfSpaces)
  {
    planes.push_back({ half.Normal, half.Point });
  }
  return planes;
}
