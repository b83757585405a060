// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMVolumeLook.h"

#include "vtkDSMImagePiece.h"
#include "vtkDSMLightOptions.h"
#include "vtkDSMTranslation.h"
#include "vtkDSMVolumeMapper.h"

#include "vtkCellData.h"
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
  const glm::dmat4 toWorld = dataToWorld * values.GetSlicesToData();
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
    for (const int component : this->GetWeightedComponents(arrays))
    {
      shown.push_back(ofIso(component));
    }
  }
  if (this->HasSecondArray(arrays))
  {
    vtkDSMVolumeData::Choice second{ mapper->GetTransfer2DYAxisArray(),
      mapper->GetTransfer2DYAxisComponent() };
    second.OnCells = arrays.CountComponents(second) == 0;
    second.IsAveraged = second.OnCells;
    second.Mask = iso.Mask;
    return { shown.empty() ? iso : shown.front(), second };
  }
  if (!shown.empty())
  {
    return shown;
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
