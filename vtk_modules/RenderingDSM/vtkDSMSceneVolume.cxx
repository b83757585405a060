// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMSceneVolume.h"

#include "vtkDSMImagePiece.h"
#include "vtkDSMLightOptions.h"
#include "vtkDSMProgress.h"
#include "vtkDSMTranslation.h"
#include "vtkDSMVolumeMapper.h"

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataObject.h"
#include "vtkMatrix4x4.h"
#include "vtkProp3D.h"
#include "vtkProperty.h"
#include "vtkScalarsToColors.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cmath>

namespace
{

/// The time of the last change to a dataset or to one of its blocks.
vtkMTimeType GetDataTime(vtkDataObject* data)
{
  vtkMTimeType time = data ? data->GetMTime() : 0;
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    vtkSmartPointer<vtkCompositeDataIterator> leaf;
    leaf.TakeReference(composite->NewIterator());
    for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
    {
      time = std::max(time, leaf->GetCurrentDataObject()->GetMTime());
    }
  }
  return time;
}

} // namespace

vtkDSMSceneVolume::vtkDSMSceneVolume(vtkDSMVolumeMapper* mapper)
  : Mapper(mapper)
{
}

vtkDSMSceneVolume::~vtkDSMSceneVolume() = default;

vtkAlgorithm* vtkDSMSceneVolume::GetAlgorithm() const
{
  return this->Mapper;
}

vtkDSMLightOptions* vtkDSMSceneVolume::GetLightOptions() const
{
  return this->Mapper->GetLightOptions();
}

vtkDSMMemoryOptions* vtkDSMSceneVolume::GetMemoryOptions() const
{
  return this->Mapper->GetMemoryOptions();
}

void vtkDSMSceneVolume::UpdatePiece(int piece, int numberOfPieces)
{
  this->Mapper->UpdatePiece(piece, numberOfPieces);
}

bool vtkDSMSceneVolume::HasNewData()
{
  vtkDataObject* data = this->Mapper->GetDataObjectInput();
  return !this->Taken || data != this->SeenData || GetDataTime(data) != this->SeenTime;
}

void vtkDSMSceneVolume::GiveUpBlocks()
{
  this->Color.reset();
  this->Iso.reset();
  this->Taken = false;
}

std::shared_ptr<vtkDSMSceneVolume::Published> vtkDSMSceneVolume::Require(
  const vtkDSMVolumeData::Choice& wanted, const char* purpose, unsigned settingsVersion,
  const std::vector<std::shared_ptr<Published>>& known)
{
  const vtkDSMVolumeData::Choice choice = this->Data->Normalize(wanted);
  for (const auto& candidate : known)
  {
    if (candidate && candidate->Choice == choice &&
      (candidate->Failure.empty() || candidate->SettingsVersion == settingsVersion))
    {
      return candidate;
    }
  }
  auto published = std::make_shared<Published>();
  published->Choice = choice;
  published->SettingsVersion = settingsVersion;
  try
  {
    vtkDSMVolumeMapper* mapper = this->Mapper;
    vtkDSMProgress::Begin(mapper);
    published->Fields = this->Data->Publish(
      choice, purpose, [mapper](double part) { vtkDSMProgress::Tell(mapper, part); });
    if (this->Hashes)
    {
      published->Content = this->Data->HashContent(choice);
    }
  }
  catch (const dsm::Error& error)
  {
    published->Failure = error.what();
  }
  return published;
}

void vtkDSMSceneVolume::TakeData(const std::shared_ptr<vtkDSMRankGroup>& group)
{
  vtkDSMVolumeMapper* mapper = this->Mapper;
  this->Data.reset();
  this->DataFailure.clear();
  this->SeenData = mapper->GetDataObjectInput();
  this->SeenTime = GetDataTime(mapper->GetDataObjectInput());
  this->Taken = true;
  ++this->TimesTaken;
  this->Reported.clear();
  try
  {
    this->Data = std::make_unique<vtkDSMVolumeData>(group, mapper->GetDataObjectInput());
    double bounds[6];
    this->Data->GetBounds(bounds);
    mapper->SetGlobalBounds(bounds);
    this->KeepUnchanged(group->GetMessenger());
  }
  catch (const dsm::Error& error)
  {
    this->Data.reset();
    this->DataFailure = error.what();
    this->Color.reset();
    this->Iso.reset();
  }
}

// What has changed goes before its successor comes: there may not be room for both.
void vtkDSMSceneVolume::KeepUnchanged(dsm::Messenger& messenger)
{
  struct Flags
  {
    std::uint8_t OfTimeStep = 0;
    std::uint8_t SameColor = 0;
    std::uint8_t SameIso = 0;
  };
  Flags mine;
  messenger.RunTogether("Looking for changes",
    [&]
    {
      const auto isSame = [this](const std::shared_ptr<Published>& known) {
        return known && known->Content && *known->Content == this->Data->HashContent(known->Choice);
      };
      mine.OfTimeStep = this->Data->IsOfTimeStep();
      mine.SameIso = isSame(this->Iso);
      mine.SameColor = this->Color == this->Iso ? mine.SameIso : isSame(this->Color);
    });
  const auto all = messenger.AllGatherValue(mine);
  const auto everywhere = [&](std::uint8_t Flags::*flag)
  { return std::all_of(all.begin(), all.end(), [=](const Flags& one) { return one.*flag != 0; }); };
  if (!everywhere(&Flags::SameColor))
  {
    this->Color.reset();
  }
  if (!everywhere(&Flags::SameIso))
  {
    this->Iso.reset();
  }
  this->Hashes = this->TimesTaken > 1 ||
    std::any_of(all.begin(), all.end(), [](const Flags& one) { return one.OfTimeStep != 0; });
}

void vtkDSMSceneVolume::Update(const std::shared_ptr<vtkDSMRankGroup>& group, bool newData)
{
  this->Messages.clear();
  vtkDSMVolumeMapper* mapper = this->Mapper;
  if (newData)
  {
    this->TakeData(group);
  }
  if (!this->Data)
  {
    this->Messages.push_back(this->DataFailure);
    return;
  }
  const std::shared_ptr<Published> oldIso = this->Iso;
  const std::shared_ptr<Published> oldColor = this->Color;
  const unsigned version = group->GetSettingsVersion();
  this->Iso = this->Require({ mapper->GetIsoArray(), mapper->GetIsoComponent() },
    "isosurface array", version, { oldIso, oldColor });
  this->Color.reset();
  if (mapper->GetScalarVisibility() && !mapper->GetColorArray().empty() && mapper->GetLookupTable())
  {
    vtkScalarsToColors* table = mapper->GetLookupTable();
    const int component = table->GetVectorMode() == vtkScalarsToColors::COMPONENT
      ? table->GetVectorComponent()
      : vtkDSMImagePiece::Magnitude;
    this->Color = this->Require({ mapper->GetColorArray(), component }, "colour array", version,
      { this->Iso, oldIso, oldColor });
  }
  for (const auto& published : { this->Iso, this->Color })
  {
    if (published && !published->Failure.empty())
    {
      this->Messages.push_back(published->Failure);
    }
  }
}

std::vector<double> vtkDSMSceneVolume::GetIsovalues()
{
  std::vector<double> values;
  for (int index = 0; index < this->Mapper->GetNumberOfIsoValues(); ++index)
  {
    const double value = this->Mapper->GetIsoValue(index);
    if (std::isfinite(value))
    {
      values.push_back(value);
    }
    else
    {
      this->Messages.push_back("Isovalue " + std::to_string(index) + " is " +
        (std::isnan(value) ? "not a number" : "infinite") +
        " and was left out. Enter a finite value.");
    }
  }
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

const rt::ColorMap& vtkDSMSceneVolume::GetColorMap()
{
  vtkScalarsToColors* table = this->Mapper->GetLookupTable();
  if (table != this->ColorsSource || table->GetMTime() != this->ColorsTime)
  {
    this->Colors = vtkDSMTranslation::ToColorMap(table);
    this->ColorsSource = table;
    this->ColorsTime = table->GetMTime();
  }
  return this->Colors;
}

void vtkDSMSceneVolume::AddTo(rt::Scene& scene)
{
  if (!this->Data || !this->Iso)
  {
    return;
  }
  const std::vector<double> isovalues = this->GetIsovalues();
  if (isovalues.empty() || this->Iso->Fields.empty())
  {
    return;
  }
  this->Prop->ComputeMatrix();
  const glm::dmat4 dataToWorld = vtkDSMTranslation::ToMatrix(this->Prop->GetMatrix());
  rt::Material material = vtkDSMTranslation::ToMaterial(this->Mapper->GetSurfaceProperty());
  material.Reflectivity = static_cast<float>(this->GetLightOptions()->GetReflectivity());
  const bool colored = this->Color && !this->Color->Fields.empty();
  for (std::size_t lattice = 0; lattice < this->Data->GetNumberOfLattices(); ++lattice)
  {
    if (!this->Iso->Fields[lattice])
    {
      continue;
    }
    rt::IsosurfaceObject object;
    object.SetIndexToWorld(dataToWorld * this->Data->GetIndexToWorld(lattice));
    object.Field = this->Iso->Fields[lattice];
    object.Isovalues = isovalues;
    object.Surface = material;
    if (colored && this->Color->Fields[lattice])
    {
      object.ColorField = this->Color->Fields[lattice];
      object.Colors = this->GetColorMap();
    }
    scene.Isosurfaces.push_back(std::move(object));
  }
}
