// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMSceneVolume.h"

#include "vtkDSMTranslation.h"

#include "vtkProp3D.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <utility>
#include <variant>

bool vtkDSMSceneVolume::HasOwnColors(std::size_t lattice) const
{
  return this->Color && !this->Color->GetFields().empty() && this->Color->GetFields()[lattice];
}

std::shared_ptr<const rt::ColorMap> vtkDSMSceneVolume::GetMediumColors(bool hasOpacity)
{
  vtkVolumeProperty* const property = vtkVolume::SafeDownCast(this->Prop)->GetProperty();
  const bool hasOwnColors = this->Color && !this->Color->GetFields().empty();
  const bricks::ValueRange range = (hasOwnColors ? this->Color : this->Iso)->GetRange();
  return this->MediumColors.Get(
    { property, property->GetMTime(), range.First, range.Last, hasOpacity },
    [&]
    {
      auto colors =
        std::make_shared<rt::ColorMap>(vtkDSMTranslation::ToOpaqueColors(property, range));
      if (hasOpacity)
      {
        vtkDSMTranslation::SetOpacity(property->GetScalarOpacity(0), *colors);
      }
      return colors;
    });
}

void vtkDSMSceneVolume::AddMedia(const vtkDSMVolumeLook& look, rt::Scene& scene)
{
  const bricks::ValueRange range = this->Iso->GetRange();
  if (!(range.First <= range.Last))
  {
    return;
  }
  look.FindMissingFeatures(
    this->Data->CountComponents((this->Color ? this->Color : this->Iso)->Choice), this->Warnings);
  this->Prop->ComputeMatrix();
  const glm::dmat4 dataToWorld = vtkDSMTranslation::ToMatrix(this->Prop->GetMatrix());
  const rt::ClipRegion clipping = look.GetClipRegion(dataToWorld);
  double bounds[6];
  this->Data->GetBounds(bounds);
  const glm::dvec3 lower(bounds[0], bounds[2], bounds[4]);
  const glm::dvec3 upper(bounds[1], bounds[3], bounds[5]);
  const double diagonal = glm::length(glm::dmat3(dataToWorld) * (upper - lower));
  for (std::size_t lattice = 0; lattice < this->Data->GetNumberOfLattices(); ++lattice)
  {
    if (!this->Iso->GetFields()[lattice])
    {
      continue;
    }
    const rt::LatticeField field = this->GetField(lattice, dataToWorld);
    const auto key = look.GetMediumKey(range, field.GetFinestLength(), diagonal);
    const auto& make =
      this->MakeMedium.Get(key, [&] { return vtkDSMVolumeLook::GetMediumMaker(key); });
    if (!make)
    {
      this->Messages.push_back(
        "The mapper does not draw volumes in the blend mode Slice, so nothing is "
        "drawn. Call SetBlendMode() with another one, or use VTK's own mapper.");
      return;
    }
    rt::SceneMedium medium = make(field, clipping);
    if (auto* const lit = std::get_if<rt::LatticeMedium>(&medium))
    {
      lit->Look.Scattering = this->Mapper->GetScattering();
      if (this->HasOwnColors(lattice))
      {
        lit->ColorValues = this->GetColorValues(lattice);
        lit->Colors = this->GetMediumColors(false);
      }
    }
    scene.Media.push_back(std::move(medium));
  }
  this->AddCaps(look, dataToWorld, scene);
}

void vtkDSMSceneVolume::AddCaps(
  const vtkDSMVolumeLook& look, const glm::dmat4& dataToWorld, rt::Scene& scene)
{
  const auto& fields = this->Iso->GetFields();
  for (std::size_t lattice = 0; this->Mapper->GetCapping() && lattice < fields.size(); ++lattice)
  {
    if (fields[lattice])
    {
      rt::LatticeSlice face;
      face.Field = this->GetField(lattice, dataToWorld);
      face.ColorValues =
        this->HasOwnColors(lattice) ? this->GetColorValues(lattice) : face.Field.Voxels;
      face.Clipping = look.GetClipRegion(dataToWorld);
      face.Planes = vtkDSMVolumeLook::GetFaces(face.Clipping);
      face.Look.Surface.Lighting = false;
      // Slices look up colors and opacities by the same values.
      const bool hasOpacity =
        this->Mapper->GetCapOpacity() && face.ColorValues == face.Field.Voxels;
      face.Look.Colors = *this->GetMediumColors(hasOpacity);
      scene.Objects.push_back(std::move(face));
    }
  }
}
