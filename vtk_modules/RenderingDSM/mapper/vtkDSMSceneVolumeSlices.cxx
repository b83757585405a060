// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMSceneVolume.h"

#include "vtkDSMTranslation.h"

#include "vtkProp3D.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <utility>

namespace
{

/// The planes of a region's half spaces.
std::vector<rt::SectionPlane> GetFaces(const rt::ClipRegion& region)
{
  std::vector<rt::SectionPlane> planes;
  for (const rt::ClipRegion::HalfSpace& half : region.HalfSpaces)
  {
    planes.push_back({ half.Normal, half.Point });
  }
  return planes;
}

} // namespace

rt::LatticeSlice vtkDSMSceneVolume::CreateSlice(
  const vtkDSMVolumeLook& look, const glm::dmat4& dataToWorld, std::size_t lattice, bool isLit)
{
  rt::LatticeSlice slice;
  slice.Field = this->GetField(lattice, dataToWorld);
  slice.Clipping = look.GetClipRegion(dataToWorld);
  slice.Look.Blocks = this->CreateBlockLooks(lattice);
  look.SetSliceLook(isLit, slice);
  const std::shared_ptr<Published>& color = this->Color ? this->Color : this->Iso;
  if (look.HasColoredSlices() && !color->GetFields().empty() && color->GetFields()[lattice])
  {
    this->SetColors(lattice, slice.ColorValues, slice.Look);
    if (vtkPiecewiseFunction* const opacity = this->Mapper->GetSliceOpacity())
    {
      vtkDSMTranslation::SetOpacity(opacity, slice.Look.Colors);
    }
  }
  return slice;
}

void vtkDSMSceneVolume::AddSlices(
  const vtkDSMVolumeLook& look, const glm::dmat4& dataToWorld, rt::Scene& scene)
{
  const auto& fields = this->Iso->GetFields();
  for (int number = 0; number < this->Mapper->GetNumberOfSlices() && !fields.empty(); ++number)
  {
    const int axis = this->Mapper->GetSliceAxis(number);
    const int index = this->Mapper->GetSliceIndex(number);
    std::int64_t most = 0;
    for (const auto& field : fields)
    {
      most = std::max<std::int64_t>(most, field ? field->Lattice.GetPoints()[axis] : 0);
    }
    if (index < 0 || index >= most)
    {
      this->Messages.push_back("Slice " + std::to_string(index) + " along " + "xyz"[axis] +
        " is outside of the volume and is not shown. Valid slices are 0 to " +
        std::to_string(most - 1) + ".");
    }
  }
  for (std::size_t lattice = 0; lattice < fields.size(); ++lattice)
  {
    if (fields[lattice])
    {
      rt::LatticeSlice slice =
        this->CreateSlice(look, dataToWorld, lattice, this->Mapper->GetSliceLighting());
      slice.Planes = look.GetSlices(
        dataToWorld * this->Data->GetIndexToWorld(lattice), fields[lattice]->Lattice.GetPoints());
      scene.Objects.push_back(std::move(slice));
    }
  }
}

void vtkDSMSceneVolume::AddCaps(const vtkDSMVolumeLook& look, const glm::dmat4& dataToWorld,
  const std::vector<double>& isovalues, rt::Scene& scene)
{
  const auto& fields = this->Iso->GetFields();
  for (std::size_t lattice = 0; this->Mapper->GetCapping() && lattice < fields.size(); ++lattice)
  {
    if (fields[lattice])
    {
      // A face of one color shows its shape by light, colors of values are to be read.
      rt::LatticeSlice face = this->CreateSlice(
        look, dataToWorld, lattice, this->Mapper->GetSliceLighting() || !look.HasColoredSlices());
      face.Planes = GetFaces(face.Clipping);
      if (this->Mapper->GetCapSide() == vtkDSMVolumeMapper::ValuesAbove)
      {
        face.Least = isovalues.front();
      }
      else if (this->Mapper->GetCapSide() == vtkDSMVolumeMapper::ValuesBelow)
      {
        face.Most = isovalues.back();
      }
      scene.Objects.push_back(std::move(face));
    }
  }
}

void vtkDSMSceneVolume::AddCaps(
  const vtkDSMVolumeLook& look, const glm::dmat4& dataToWorld, rt::Scene& scene)
{
  const auto& fields = this->Iso->GetFields();
  vtkVolumeProperty* const property = vtkVolume::SafeDownCast(this->Prop)->GetProperty();
  for (std::size_t lattice = 0; this->Mapper->GetCapping() && lattice < fields.size(); ++lattice)
  {
    if (fields[lattice])
    {
      rt::LatticeSlice face;
      face.Field = this->GetField(lattice, dataToWorld);
      face.ColorValues = face.Field.Voxels;
      face.Clipping = look.GetClipRegion(dataToWorld);
      face.Planes = GetFaces(face.Clipping);
      face.Look.Surface.Lighting = false;
      const bricks::ValueRange range = fields[lattice]->Hierarchy.GetRange();
      face.Look.Colors = vtkDSMTranslation::ToOpaqueColors(property, range);
      if (this->Mapper->GetCapOpacity())
      {
        vtkDSMTranslation::SetOpacity(property->GetScalarOpacity(0), face.Look.Colors);
      }
      scene.Objects.push_back(std::move(face));
    }
  }
}
