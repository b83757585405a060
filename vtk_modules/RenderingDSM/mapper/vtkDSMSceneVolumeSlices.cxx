// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMSceneVolume.h"

#include "vtkDSMTranslation.h"

#include "vtkPiecewiseFunction.h"

#include <algorithm>
#include <utility>

rt::LatticeSlice vtkDSMSceneVolume::CreateSlice(
  const vtkDSMVolumeLook& look, const glm::dmat4& dataToWorld, std::size_t lattice, bool isLit)
{
  rt::LatticeSlice slice;
  slice.Field = this->GetField(*this->GetIso(), lattice, dataToWorld);
  slice.Clipping = look.GetClipRegion(dataToWorld);
  slice.Look.Blocks = this->CreateBlockLooks(lattice);
  look.SetSliceLook(isLit, slice);
  const vtkDSMVolumeData::Fields& colors = this->GetColoring().GetFields();
  if (look.HasColoredSlices() && !colors.empty() && colors[lattice])
  {
    this->SetColors(lattice, slice.ColorValues, slice.Look);
    vtkPiecewiseFunction* const opacity = this->Mapper->GetSliceOpacity();
    if (opacity && this->Mapper->GetLookupTable())
    {
      const auto& colors = slice.Look.Colors;
      slice.Look.Colors = *this->SliceColors.Get(
        { this->SampleColors(this->Mapper->GetLookupTable()), opacity, opacity->GetMTime() },
        [&]
        {
          auto map = std::make_shared<rt::ColorMap>(colors);
          vtkDSMTranslation::SetOpacity(opacity, *map);
          return map;
        });
    }
  }
  return slice;
}

void vtkDSMSceneVolume::AddSlices(
  const vtkDSMVolumeLook& look, const glm::dmat4& dataToWorld, rt::Scene& scene)
{
  const auto& fields = this->GetIso()->GetFields();
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
        " is outside the volume and is not shown. Valid slices are 0 to " +
        std::to_string(most - 1) + ".");
    }
  }
  for (std::size_t lattice = 0; lattice < fields.size(); ++lattice)
  {
    if (fields[lattice])
    {
      rt::LatticeSlice slice =
        this->CreateSlice(look, dataToWorld, lattice, this->Mapper->GetSliceLighting());
      slice.Planes =
        look.GetSlices(dataToWorld * this->Data->GetIndexToWorld(lattice), *fields[lattice]);
      scene.Objects.push_back(std::move(slice));
    }
  }
}

void vtkDSMSceneVolume::AddCaps(const vtkDSMVolumeLook& look, const glm::dmat4& dataToWorld,
  const std::vector<double>& isovalues, rt::Scene& scene)
{
  const auto& fields = this->GetIso()->GetFields();
  for (std::size_t lattice = 0; this->Mapper->GetCapping() && lattice < fields.size(); ++lattice)
  {
    if (fields[lattice])
    {
      // A face of one color shows its shape by light, colors of values are to be read.
      rt::LatticeSlice face = this->CreateSlice(
        look, dataToWorld, lattice, this->Mapper->GetSliceLighting() || !look.HasColoredSlices());
      face.Planes = vtkDSMVolumeLook::GetFaces(face.Clipping);
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
