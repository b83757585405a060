// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMVolumeLook.h"

#include "vtkDSMTranslation.h"
#include "vtkDSMVolumeMapper.h"

#include "vtkColorTransferFunction.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkPointData.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <type_traits>
#include <variant>

vtkDSMVolumeLook::MediumKey vtkDSMVolumeLook::GetMediumKey(const bricks::ValueRange& range,
  double cellLength, double diagonal, const std::optional<int>& component, Sampling sampling,
  const std::optional<std::array<double, 2>>& seconds) const
{
  vtkVolumeProperty* const property = vtkVolume::SafeDownCast(this->Prop)->GetProperty();
  const double* const averaged = this->Mapper->GetAverageIPScalarRange();
  const int mode = this->Mapper->GetBlendMode();
  const bool isComposite = mode == vtkVolumeMapper::COMPOSITE_BLEND;
  vtkImageData* const function =
    seconds ? property->GetTransferFunction2D(component.value_or(0)) : nullptr;
  return { range.First, range.Last,
    isComposite || mode == vtkVolumeMapper::AVERAGE_INTENSITY_BLEND ? cellLength : 0.0,
    isComposite ? diagonal : 0.0, property, property->GetMTime(), mode,
    { averaged[0], averaged[1] }, component.value_or(0),
    component ? property->GetComponentWeight(*component) : 1.0, sampling, function,
    function ? function->GetMTime() : 0, seconds.value_or(std::array<double, 2>{ 0.0, 0.0 }) };
}

vtkDSMVolumeLook::MediumMaker vtkDSMVolumeLook::GetMediumMaker(const MediumKey& key)
{
  const auto& [first, last, cellLength, diagonal, property, time, mode, averaged, component, weight,
    sampling, function2D, functionTime, seconds] = key;
  switch (mode)
  {
    case vtkVolumeMapper::COMPOSITE_BLEND:
    {
      rt::MediumLook look = vtkDSMTranslation::ToMediumLook(property, component, last - first);
      look.Nearest = sampling != Sampling::Linear;
      if (function2D)
      {
        return [function = vtkDSMTranslation::ToTransferFunction2D(
                  property, component, weight, first, last, seconds, cellLength, diagonal),
                 look](const rt::AnyField& any, const rt::ClipRegion& clipping)
        {
          return std::visit(
            [&](const auto& field) -> rt::SceneMedium
            {
              rt::MediumOf<std::decay_t<decltype(field)>> medium{ field, function->GetEnvelope(),
                look, clipping };
              medium.Function2D = function;
              return medium;
            },
            any);
        };
      }
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
  const bool hasCategories = !this->WantsFunction2D() &&
    property->GetColorChannels(component) == 3 &&
    property->GetRGBTransferFunction(component)->GetIndexedLookup() != 0;
  return hasCategories                                              ? Sampling::Categories
    : property->GetInterpolationType() == VTK_NEAREST_INTERPOLATION ? Sampling::Nearest
                                                                    : Sampling::Linear;
}

std::optional<vtkDSMVolumeLook::Obstacle> vtkDSMVolumeLook::FindNearestObstacle(
  const vtkDSMImageArrays& arrays, Grids grids) const
{
  if (this->Mapper->GetBlendMode() != vtkVolumeMapper::COMPOSITE_BLEND)
  {
    return Obstacle{ "in this blend mode",
      "Call SetBlendModeToComposite(). In ParaView, set Blend Mode to Composite." };
  }
  if (grids != Grids::Lattices)
  {
    return Obstacle{ "for AMR and hyper tree grids, and for curvilinear and unstructured grids",
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
  const vtkDSMImageArrays& arrays, Grids grids, int component) const
{
  return this->FindNearestObstacle(arrays, grids) ? Sampling::Linear
                                                  : this->GetRequestedSampling(component);
}

void vtkDSMVolumeLook::FindMissingFeatures(
  const vtkDSMImageArrays& arrays, Grids grids, std::vector<std::string>& warnings) const
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
  if (const auto missing = this->FindFunction2DObstacle(arrays))
  {
    warn(true, "a two-dimensional transfer function " + missing->Reason,
      missing->Remedy +
        " Or call SetTransferFunctionModeTo1D(). In ParaView, turn off Use 2D "
        "Transfer Function.");
  }
  if (property->GetShade(0) != 0 && this->Mapper->GetComputeNormalFromOpacity())
  {
    warnings.push_back("The mapper is to compute normals from the opacity, which DSM Ray Tracer "
                       "does not do. The volume is shaded by the gradient of its values. Call "
                       "ComputeNormalFromOpacityOff().");
  }
  warn(!this->Mapper->GetOpacityArray().empty() && !this->HasOpacityArray(),
    this->HasFunction2D(arrays)
      ? "opacities from another array and with a two-dimensional transfer function"
      : "opacities from another array, in this blend mode",
    "Call SetBlendModeToComposite(), and SetTransferFunctionModeTo1D() on the property, or "
    "SetOpacityArray(\"\") on the mapper. In ParaView, set Blend Mode to Composite, and turn off "
    "Use "
    "2D Transfer Function or Use Separate Opacity Array.");
  warn(this->Mapper->GetCapping() && this->HasFunction2D(arrays),
    "the colors of a two-dimensional transfer function on the faces of cuts",
    "The faces have the colors of the color function. Call CappingOff(). In ParaView, turn off "
    "Cap.");
  const Sampling requested = this->GetRequestedSampling(0);
  const auto found = this->FindNearestObstacle(arrays, grids);
  const Obstacle obstacle = found.value_or(Obstacle{});
  warn(found && requested == Sampling::Categories, "a color for each category " + obstacle.Reason,
    obstacle.Remedy +
      " Or call IndexedLookupOff() on the color function. In ParaView, turn off "
      "Interpret Values As Categories.");
  warn(found && requested == Sampling::Nearest && grids != Grids::Cells,
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
  return this->IsMedium() && !this->Mapper->GetOpacityArray().empty() && !this->WantsFunction2D() &&
    this->Mapper->GetBlendMode() == vtkVolumeMapper::COMPOSITE_BLEND;
}

bool vtkDSMVolumeLook::WantsFunction2D() const
{
  return this->IsMedium() &&
    vtkVolume::SafeDownCast(this->Prop)->GetProperty()->GetTransferFunctionMode() ==
    vtkVolumeProperty::TF_2D;
}

std::optional<vtkDSMVolumeLook::Obstacle> vtkDSMVolumeLook::FindFunction2DObstacle(
  const vtkDSMImageArrays& arrays) const
{
  if (!this->WantsFunction2D())
  {
    return std::nullopt;
  }
  if (this->Mapper->GetBlendMode() != vtkVolumeMapper::COMPOSITE_BLEND)
  {
    return Obstacle{ "in this blend mode",
      "Call SetBlendModeToComposite(). In ParaView, set Blend Mode to Composite." };
  }
  const Components kind = this->GetComponents(arrays);
  if (kind == Components::Dependent || kind == Components::Refused)
  {
    return Obstacle{ "where components of the array are the colors",
      "Call IndependentComponentsOn(). In ParaView, turn on Map Scalars and turn off Multi "
      "Components Mapping." };
  }
  const std::vector<int> components =
    kind == Components::Independent ? this->GetWeightedComponents(arrays) : std::vector<int>{ 0 };
  if (components.size() > 1 && this->Mapper->GetTransfer2DYAxisArray())
  {
    return Obstacle{ "of another array for several components at once",
      "Call SetIsoComponent() on the mapper to draw one of them, or "
      "SetTransfer2DYAxisArray(nullptr)." };
  }
  vtkVolumeProperty* const property = vtkVolume::SafeDownCast(this->Prop)->GetProperty();
  for (const int component : components)
  {
    vtkImageData* const image = property->GetTransferFunction2D(component);
    vtkDataArray* const texels = image ? image->GetPointData()->GetScalars() : nullptr;
    const vtkIdType count =
      image ? vtkIdType{ image->GetDimensions()[0] } * image->GetDimensions()[1] : 0;
    if (!texels || texels->GetNumberOfComponents() != 4 || count < 1 ||
      texels->GetNumberOfTuples() < count)
    {
      return Obstacle{ "that has no image",
        "Call SetTransferFunction2D() with an image of four components. In ParaView, add a box in "
        "the Color Map Editor." };
    }
  }
  return std::nullopt;
}

bool vtkDSMVolumeLook::HasFunction2D(const vtkDSMImageArrays& arrays) const
{
  return this->WantsFunction2D() && !this->FindFunction2DObstacle(arrays);
}

bool vtkDSMVolumeLook::HasSecondArray(const vtkDSMImageArrays& arrays) const
{
  return this->Mapper->GetTransfer2DYAxisArray() && this->HasFunction2D(arrays);
}

std::vector<int> vtkDSMVolumeLook::GetWeightedComponents(const vtkDSMImageArrays& arrays) const
{
  vtkVolumeProperty* const property = vtkVolume::SafeDownCast(this->Prop)->GetProperty();
  const int count = arrays.CountComponents(this->GetIsoChoice(arrays));
  std::vector<int> weighted;
  for (int component = 0; component < count; ++component)
  {
    if (property->GetComponentWeight(component) > 0.0)
    {
      weighted.push_back(component);
    }
  }
  return weighted.empty() ? std::vector<int>{ 0 } : weighted;
}
