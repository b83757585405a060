// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMSceneVolume.h"

#include "vtkDSMImagePiece.h"
#include "vtkDSMTranslation.h"

#include "vtkProp3D.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>

bool vtkDSMSceneVolume::HasDirectColors() const
{
  return this->GetColoring().Choice.Component == vtkDSMImagePiece::Color;
}

vtkDSMVolumeLook::Grids vtkDSMSceneVolume::GetGrids() const
{
  using Grids = vtkDSMVolumeLook::Grids;
  const vtkDSMVolumeData::Values& parts = this->GetIso()->GetParts();
  const auto areAll = [&parts](auto is)
  {
    return std::all_of(parts.begin(), parts.end(),
      [&](const auto& values) { return !values || is(values->GetField(glm::dmat4(1.0))); });
  };
  if (areAll(
        [](const rt::AnyField& field) { return std::holds_alternative<rt::LatticeField>(field); }))
  {
    return Grids::Lattices;
  }
  const bool areCells =
    areAll([](const rt::AnyField& field) { return std::holds_alternative<rt::CellField>(field); });
  return areCells ? Grids::Cells : Grids::Others;
}

vtkDSMVolumeLook::Sampling vtkDSMSceneVolume::GetMediumSampling(int component) const
{
  return this->GetLook().GetSampling(this->Data->GetArrays(), this->GetGrids(), component);
}

std::shared_ptr<const rt::ColorMap> vtkDSMSceneVolume::GetMediumColors(bool hasOpacity)
{
  vtkVolumeProperty* const property = vtkVolume::SafeDownCast(this->Prop)->GetProperty();
  const bool isFirst =
    this->HasSeveralMedia() || this->HasSecondArray() || !this->GetColoring().HasAny();
  const Published& array = isFirst ? *this->GetIso() : this->GetColoring();
  const int component = this->IsOfComponents() ? array.Choice.Component : 0;
  const bricks::ValueRange range = array.GetRange();
  const bool hasCategories =
    this->GetMediumSampling(component) == vtkDSMVolumeLook::Sampling::Categories;
  return this->MediumColors[hasOpacity ? 1 : 0].Get(
    { property, property->GetMTime(), component, hasCategories, range.First, range.Last },
    [&]
    {
      return std::make_shared<rt::ColorMap>(
        vtkDSMTranslation::ToColorMap(property, component, range, hasOpacity, hasCategories));
    });
}

std::optional<std::array<double, 2>> vtkDSMSceneVolume::GetSecondRange(
  const bricks::ValueRange& range) const
{
  if (!this->GetLook().HasFunction2D(this->Data->GetArrays()))
  {
    return std::nullopt;
  }
  // Without the array that is asked for, VTK's mapper takes gradients, too.
  if (this->HasSecondArray() && this->GetColoring().HasAny())
  {
    const bricks::ValueRange own = this->GetColoring().GetRange();
    return std::array<double, 2>{ own.First, own.Last };
  }
  // As VTK's mapper, which takes what values do in a cell to be a quarter of their range at most.
  return std::array<double, 2>{ 0.0,
    range.First < range.Last ? 0.25 * (double{ range.Last } - double{ range.First }) : 0.25 };
}

void vtkDSMSceneVolume::AddMedia(const vtkDSMVolumeLook& look, rt::Scene& scene)
{
  this->MissingFeatures.clear();
  look.FindMissingFeatures(this->Data->GetArrays(), this->GetGrids(), this->MissingFeatures);
  this->Warnings.insert(
    this->Warnings.end(), this->MissingFeatures.begin(), this->MissingFeatures.end());
  if (look.GetComponents(this->Data->GetArrays()) == vtkDSMVolumeLook::Components::Refused)
  {
    this->Messages.push_back(
      "The volume's components are to be colors and opacities, but its array '" +
      this->GetIso()->Choice.Name + "' has " +
      std::to_string(this->Data->GetArrays().CountComponents(this->GetIso()->Choice)) +
      ", so nothing is drawn. Two (color and opacity) or four (red, green, blue and opacity) are "
      "needed. In ParaView, turn on Map Scalars and turn off Multi Components Mapping; in VTK, "
      "call "
      "IndependentComponentsOn() of the property.");
    return;
  }
  const glm::dmat4 dataToWorld = this->FindDataToWorld();
  const std::size_t count = this->HasSeveralMedia() ? this->Arrays.size() : 1;
  const std::size_t before = scene.Media.size();
  std::vector<int> groups(this->GetParts(*this->GetIso()).size());
  for (std::size_t number = 0; number < count; ++number)
  {
    this->AddMedium(look, number, dataToWorld, groups, scene);
  }
  if (scene.Media.size() > before) // else there is nothing that a plane could cut
  {
    this->AddCaps(look, dataToWorld, scene);
  }
}

void vtkDSMSceneVolume::AddMedium(const vtkDSMVolumeLook& look, std::size_t number,
  const glm::dmat4& dataToWorld, std::vector<int>& groups, rt::Scene& scene)
{
  const Published& array = *this->Arrays[number];
  const bricks::ValueRange range = array.GetRange();
  if (!(range.First <= range.Last))
  {
    return;
  }
  const std::optional<int> component =
    this->IsOfComponents() ? std::optional<int>(array.Choice.Component) : std::nullopt;
  using Sampling = vtkDSMVolumeLook::Sampling;
  Sampling sampling = this->GetMediumSampling(component.value_or(0));
  if (sampling == Sampling::Categories && !this->HasSeveralMedia() && this->GetColor())
  {
    sampling = Sampling::Nearest; // the categories are those of the other array
  }
  const rt::ClipRegion clipping = look.GetClipRegion(dataToWorld);
  const std::optional<std::array<double, 2>> seconds = this->GetSecondRange(range);
  double bounds[6];
  this->Data->GetBounds(bounds);
  const glm::dvec3 lower(bounds[0], bounds[2], bounds[4]);
  const glm::dvec3 upper(bounds[1], bounds[3], bounds[5]);
  // As in all of VTK's mappers, the unit distance is one of the data, whatever the prop's scale is.
  const glm::dmat3 worldToData = glm::inverse(glm::dmat3(dataToWorld));
  auto& makers = this->MediumMakers[number];
  auto known = std::move(makers);
  makers.clear();
  this->ForEachField(array, dataToWorld,
    [&](const auto& field, std::size_t part)
    {
      using FieldType = std::decay_t<decltype(field)>;
      const auto key = look.GetMediumKey(range, field.GetFinestLength(worldToData),
        glm::length(upper - lower), component, sampling, seconds);
      makers.insert(known.extract(key));
      const auto [entry, isNew] = makers.try_emplace(key);
      if (isNew)
      {
        entry->second = vtkDSMVolumeLook::GetMediumMaker(key);
      }
      const auto& make = entry->second;
      if (!make)
      {
        this->Messages.push_back(
          "The mapper does not draw volumes in the blend mode Slice, so nothing is "
          "drawn. Call SetBlendMode() with another one, or use VTK's own mapper. In ParaView, "
          "choose another Blend Mode, or the representation DSM Slices.");
        return;
      }
      rt::SceneMedium medium = make(field, clipping);
      if (auto* const sum = std::get_if<rt::SumOf<FieldType>>(&medium))
      {
        sum->WorldToSpace = worldToData;
      }
      if (auto* const integral = std::get_if<rt::IntegralOf<FieldType>>(&medium))
      {
        integral->Longest = glm::length(glm::dmat3(dataToWorld) * (upper - lower));
      }
      if (auto* const lit = std::get_if<rt::MediumOf<FieldType>>(&medium))
      {
        lit->WorldToSpace = worldToData;
        lit->Look.Scattering = this->Mapper->GetScattering();
        lit->Look.Exact = this->Mapper->GetExactIntegration();
        if (this->HasSecondArray())
        {
          lit->SecondValues = this->FindColorValues<FieldType>(part);
        }
        lit->ColorValues = this->FindOwnColors<FieldType>(part);
        if (lit->ColorValues)
        {
          lit->Colors = this->HasDirectColors() ? nullptr : this->GetMediumColors(false);
        }
        if (this->HasSeveralMedia() && this->Arrays.size() > 1)
        {
          int& group = groups[part];
          group = group == 0 ? static_cast<int>(scene.Media.size()) + 1 : group;
          lit->Group = group;
        }
      }
      scene.Media.push_back(std::move(medium));
    });
}

void vtkDSMSceneVolume::AddCaps(
  const vtkDSMVolumeLook& look, const glm::dmat4& dataToWorld, rt::Scene& scene)
{
  if (!this->Mapper->GetCapping())
  {
    return;
  }
  const int component = this->IsOfComponents() ? this->GetIso()->Choice.Component : 0;
  const bool isNearest = this->GetMediumSampling(component) != vtkDSMVolumeLook::Sampling::Linear;
  this->ForEachField(*this->GetIso(), dataToWorld,
    [&](const auto& field, std::size_t part)
    {
      using FieldType = std::decay_t<decltype(field)>;
      rt::SliceOf<FieldType> face;
      face.Field = field;
      face.NearestValues = isNearest;
      const auto own = this->FindOwnColors<FieldType>(part);
      face.ColorValues = own ? own : face.Field.Voxels;
      face.Clipping = look.GetClipRegion(dataToWorld);
      face.Planes = vtkDSMVolumeLook::GetFaces(face.Clipping);
      face.Look.Surface.Lighting = false;
      if (own && this->HasDirectColors())
      {
        face.Look.ColoredBy = rt::IsosurfaceLook::Coloring::OpaqueColors;
      }
      else
      {
        // Slices look up colors and opacities by the same values.
        const bool hasOpacity =
          this->Mapper->GetCapOpacity() && face.ColorValues == face.Field.Voxels;
        face.Look.Colors = *this->GetMediumColors(hasOpacity);
      }
      scene.Objects.push_back(std::move(face));
    });
}
