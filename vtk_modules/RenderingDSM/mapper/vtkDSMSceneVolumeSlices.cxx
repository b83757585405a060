// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMSceneVolume.h"

#include "vtkDSMTranslation.h"

#include "vtkPiecewiseFunction.h"

#include <algorithm>
#include <array>
#include <utility>

template <class FieldType>
rt::SliceOf<FieldType> vtkDSMSceneVolume::CreateSlice(const vtkDSMVolumeLook& look,
  const glm::dmat4& dataToWorld, const FieldType& field, std::size_t part, bool isLit)
{
  rt::SliceOf<FieldType> slice;
  slice.Field = field;
  slice.Clipping = look.GetClipRegion(dataToWorld);
  slice.Look.Blocks = this->CreateBlockLooks(part);
  look.SetSliceLook(isLit, slice);
  if (look.HasColoredSlices())
  {
    slice.ColorValues = this->FindColorValues<FieldType>(part);
  }
  if (slice.ColorValues)
  {
    this->SetColors(slice.Look);
    vtkPiecewiseFunction* const opacity = this->Mapper->GetSliceOpacity();
    if (opacity && this->Mapper->GetLookupTable())
    {
      vtkScalarsToColors* const table = this->Mapper->GetLookupTable();
      slice.Look.Colors = *this->SliceColors.Get(
        { this->SampleColors(table), opacity, opacity->GetMTime() },
        [&]
        { return std::make_shared<rt::ColorMap>(vtkDSMTranslation::ToColorMap(table, opacity)); });
    }
  }
  return slice;
}

void vtkDSMSceneVolume::AddSlices(
  const vtkDSMVolumeLook& look, const glm::dmat4& dataToWorld, rt::Scene& scene)
{
  // Indices are of the finest level of detail.
  const vtkDSMVolumeData::Values& finest = this->GetIso()->GetParts();
  std::array<int, 3> most{};
  for (const auto& values : finest)
  {
    for (int axis = 0; values && axis < 3; ++axis)
    {
      most[axis] = std::max(most[axis], static_cast<int>(values->CountSlices()[axis]));
    }
  }
  this->Mapper->SetSlicePoints(most);
  for (int number = 0; number < this->Mapper->GetNumberOfSlices() && !finest.empty(); ++number)
  {
    const int axis = this->Mapper->GetSliceAxis(number);
    const int index = this->Mapper->GetSliceIndex(number);
    if (index >= most[axis])
    {
      this->Messages.push_back("Slice " + std::to_string(index) + " along " + "xyz"[axis] +
        " is outside the volume and is not shown. Valid slices are 0 to " +
        std::to_string(most[axis] - 1) + ". Choose one of them, or -1 for the middle.");
    }
  }
  this->ForEachField(*this->GetIso(), dataToWorld,
    [&](const auto& field, std::size_t part)
    {
      auto slice =
        this->CreateSlice(look, dataToWorld, field, part, this->Mapper->GetSliceLighting());
      slice.Planes = look.GetSlices(dataToWorld, *finest[this->GetPart(part)]);
      scene.Objects.push_back(std::move(slice));
    });
}

void vtkDSMSceneVolume::AddCaps(const vtkDSMVolumeLook& look, const glm::dmat4& dataToWorld,
  const std::vector<double>& isovalues, rt::Scene& scene)
{
  if (!this->Mapper->GetCapping())
  {
    return;
  }
  this->ForEachField(*this->GetIso(), dataToWorld,
    [&](const auto& field, std::size_t part)
    {
      // A face of one color shows its shape by light, colors of values are to be read.
      auto face = this->CreateSlice(look, dataToWorld, field, part,
        this->Mapper->GetSliceLighting() || !look.HasColoredSlices());
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
    });
}
