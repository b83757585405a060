// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMSceneVolume.h"

#include "vtkDSMImagePiece.h"
#include "vtkDSMProgress.h"
#include "vtkDSMTranslation.h"

#include "DSMBricks/layout/FirstIsovalue.h"
#include "DSMBricks/layout/MacrocellHierarchy.h"
#include "DSMRayTracing/frame/SampleWidth.h"

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataObject.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkProp3D.h"
#include "vtkScalarsToColors.h"
#include "vtkSmartPointer.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <limits>
#include <utility>

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

/// Returns whether two ranges have at least half of the values in common that either has.
bool AreAlike(const bricks::ValueRange& one, const bricks::ValueRange& other)
{
  const auto getWidth = [](float first, float last)
  { return static_cast<double>(last) - static_cast<double>(first); };
  return 2.0 * getWidth(std::max(one.First, other.First), std::min(one.Last, other.Last)) >=
    getWidth(std::min(one.First, other.First), std::max(one.Last, other.Last));
}

/// Returns whether the values are a part of the range only, since the others are fills.
bool HasFills(const bricks::ValueLimits& values, const bricks::ValueRange& range)
{
  constexpr double leastGap = 0.1; // of their range; FillValues.h
  const double gap = leastGap * (values.Greatest - values.Least);
  return values.Least <= values.Greatest &&
    (values.Least - static_cast<double>(range.First) > gap ||
      static_cast<double>(range.Last) - values.Greatest > gap);
}

} // namespace

bool vtkDSMSceneVolume::HasNewData()
{
  return !this->Taken || this->HasOtherData() || this->Mapper->GetBlockLooks() != this->SeenLooks ||
    (this->Data && this->Data->HasSeams() && !(this->GetShown() == this->SeenShown));
}

bool vtkDSMSceneVolume::HasOtherData() const
{
  vtkDataObject* data = this->Mapper->GetDataObjectInput();
  return data != this->SeenData || GetDataTime(data) != this->SeenTime;
}

// May be called for a member of another scene, whose prop may be gone.
bool vtkDSMSceneVolume::IsOutdated()
{
  return !this->Mapper || this->Mapper->HasOldData() || this->HasOtherData();
}

bool vtkDSMSceneVolume::SharesBlocks(const vtkDSMSceneMember& other) const
{
  const auto* volume = dynamic_cast<const vtkDSMSceneVolume*>(&other);
  const auto has = [&](const std::shared_ptr<Published>& mine)
  {
    return mine->Publication &&
      std::any_of(volume->Arrays.begin(), volume->Arrays.end(),
        [&](const auto& one) { return one->Publication == mine->Publication; });
  };
  return volume && std::any_of(this->Arrays.begin(), this->Arrays.end(), has);
}

bool vtkDSMSceneVolume::NeedsRanks(const vtkDSMRankGroup& group, bool wantsCoarser) const
{
  if (!this->Data)
  {
    return false;
  }
  const std::vector<vtkDSMVolumeData::Choice> shown = this->GetShown();
  if (shown.size() != this->Arrays.size() || this->LacksSuggestion())
  {
    return true;
  }
  for (std::size_t number = 0; number < shown.size(); ++number)
  {
    const Published& known = *this->Arrays[number];
    const vtkDSMVolumeData::Choice choice = this->Data->GetArrays().Normalize(shown[number]);
    if (!known.IsOf(choice, group.GetRetryVersion()) ||
      (known.Publication && wantsCoarser != static_cast<bool>(known.Coarser)))
    {
      return true;
    }
  }
  return false;
}

std::vector<vtkDSMVolumeData::Choice> vtkDSMSceneVolume::GetShown() const
{
  return this->GetLook().GetShown(this->Data->GetArrays());
}

/// A volume that was a medium, or had slices only, has no suggestion before.
bool vtkDSMSceneVolume::LacksSuggestion() const
{
  return this->GetIso() && this->GetLook().HasIsosurfaces() &&
    !(this->SuggestedFor == this->GetIso()->Choice);
}

bool vtkDSMSceneVolume::Published::IsOf(
  const vtkDSMVolumeData::Choice& choice, unsigned retryVersion) const
{
  return this->Choice == choice && (this->Failure.empty() || this->RetryVersion == retryVersion);
}

const vtkDSMVolumeData::Values& vtkDSMSceneVolume::Published::GetParts(int level) const
{
  static const vtkDSMVolumeData::Values none;
  return !this->Publication ? none
    : level > 0             ? (*this->Coarser)[static_cast<std::size_t>(level) - 1]
                            : this->Publication->Parts;
}

void vtkDSMSceneVolume::GiveUpBlocks()
{
  this->Arrays.clear();
  this->Stale.clear();
  this->Data.reset(); // parts of it may have blocks, too
  this->Taken = false;
}

bricks::ValueRange vtkDSMSceneVolume::Published::GetRange() const
{
  bricks::ValueRange all{ std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest() };
  for (const auto& values : this->GetParts())
  {
    if (values)
    {
      all.Add(values->GetRange());
    }
  }
  return all;
}

vtkDSMPart::Request vtkDSMSceneVolume::MakeRequest(
  const vtkDSMVolumeData::Choice& choice, const char* purpose) const
{
  vtkDSMVolumeMapper* const mapper = this->Mapper;
  vtkDSMProgress::Begin(mapper);
  return { choice, purpose, [mapper](double part) { vtkDSMProgress::Tell(mapper, part); } };
}

std::shared_ptr<vtkDSMSceneVolume::Published> vtkDSMSceneVolume::Require(
  const vtkDSMVolumeData::Choice& wanted, const char* purpose, unsigned retryVersion,
  const std::vector<std::shared_ptr<Published>>& known)
{
  const vtkDSMVolumeData::Choice choice = this->Data->GetArrays().Normalize(wanted);
  for (const auto& candidate : known)
  {
    if (candidate && candidate->IsOf(choice, retryVersion))
    {
      return candidate;
    }
  }
  auto published = std::make_shared<Published>();
  published->Choice = choice;
  published->RetryVersion = retryVersion;
  try
  {
    published->Publication =
      this->Data->Publish(this->MakeRequest(choice, purpose), this->TakeStale(choice));
  }
  catch (const vtkDSMImageArrays::Missing& missing)
  {
    published->Failure = missing.what();
    published->IsMissing = true;
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
  this->SeenLooks = mapper->GetBlockLooks();
  this->SeenShown.clear();
  this->Taken = true;
  this->Reported = this->MissingFeatures;
  try
  {
    this->Data = std::make_unique<vtkDSMVolumeData>(
      group, mapper->GetDataObjectInput(), mapper->GetOriginalData(),
      [this](const vtkDSMImageArrays& arrays)
      { return this->SeenShown = this->GetLook().GetShown(arrays); },
      this->SeenLooks);
    double bounds[6];
    this->Data->GetBounds(bounds);
    mapper->SetGlobalBounds(bounds);
    this->KeepUnchanged(group->GetMessenger());
  }
  catch (const dsm::Error& error)
  {
    this->Data.reset();
    this->DataFailure = error.what();
    this->Arrays.clear();
    this->Stale.clear();
  }
}

std::shared_ptr<const vtkDSMVolumeData::Publication> vtkDSMSceneVolume::TakeStale(
  const vtkDSMVolumeData::Choice& choice)
{
  std::shared_ptr<const vtkDSMVolumeData::Publication> found;
  for (const auto& stale : this->Stale)
  {
    if (stale->Choice == choice && stale->Publication)
    {
      found = std::move(stale->Publication);
      stale->Publication.reset();
    }
  }
  if (!found)
  {
    this->Stale.clear();
  }
  return found;
}

// Old data are released before the new ones arrive, or are taken over: memory may not suffice for
// both.
void vtkDSMSceneVolume::KeepUnchanged(dsm::Messenger& messenger)
{
  struct Flags
  {
    std::uint8_t Same[MostArrays] = {};
    std::uint8_t Free[MostArrays] = {}; ///< may be taken over
  };
  Flags mine;
  messenger.RunTogether("Looking for changes",
    [&]
    {
      for (std::size_t number = 0; number < this->Arrays.size(); ++number)
      {
        const std::shared_ptr<Published>& known = this->Arrays[number];
        const auto first = static_cast<std::size_t>(
          std::find(this->Arrays.begin(), this->Arrays.end(), known) - this->Arrays.begin());
        mine.Same[number] = first < number ? mine.Same[first]
                                           : known->Publication &&
            known->Publication->Content == this->Data->HashContent(known->Choice);
        mine.Free[number] = this->Data->MayTakeOver(known->Publication);
      }
    });
  const auto all = messenger.AllGatherValue(mine);
  std::vector<std::shared_ptr<Published>> same;
  for (std::size_t number = 0; number < this->Arrays.size(); ++number)
  {
    const auto everywhere = [&](auto Flags::*flags)
    {
      return std::all_of(
        all.begin(), all.end(), [=](const Flags& one) { return (one.*flags)[number] != 0; });
    };
    if (everywhere(&Flags::Same))
    {
      same.push_back(this->Arrays[number]);
    }
    else if (everywhere(&Flags::Free))
    {
      this->Stale.push_back(this->Arrays[number]);
    }
  }
  this->Arrays = std::move(same);
}

void vtkDSMSceneVolume::Update(const std::shared_ptr<vtkDSMRankGroup>& group, bool newData)
{
  this->Messages.clear();
  this->Warnings.clear();
  if (newData)
  {
    this->TakeData(group);
  }
  if (!this->Data)
  {
    this->Messages.push_back(this->DataFailure);
    return;
  }
  // Those that are shown no longer leave after their successors have come.
  std::vector<std::shared_ptr<Published>> known = std::move(this->Arrays);
  this->Arrays.clear();
  const std::shared_ptr<Published> oldIso = known.empty() ? nullptr : known.front();
  const bool hasIsosurfaces = this->GetLook().HasIsosurfaces();
  const char* const purpose = hasIsosurfaces ? "isosurface array"
    : this->GetLook().IsMedium()             ? "volume array"
                                             : "slice array";
  for (const vtkDSMVolumeData::Choice& choice : this->GetShown())
  {
    const char* const own = this->Arrays.empty() || this->HasSeveralMedia() ? purpose
      : this->HasSecondArray() ? "Y-axis array of the two-dimensional transfer function"
                               : "color array";
    this->Arrays.push_back(this->Require(choice, own, group->GetRetryVersion(), known));
    known.push_back(this->Arrays.back());
  }
  if (this->LacksSuggestion() || (this->GetIso() != oldIso && hasIsosurfaces))
  {
    this->SuggestIsovalue(group->GetMessenger());
  }
  this->Stale.clear();
  const bool isConfigured = this->SettingsVersion != group->GetSettingsVersion();
  this->SettingsVersion = group->GetSettingsVersion();
  for (const auto& published : this->Arrays)
  {
    if (!published->Failure.empty())
    {
      if (isConfigured && !published->IsMissing)
      {
        this->Reported.clear(); // the user sees that changed settings did not help
      }
      // Without its colors a surface is there, and ParaView's own says nothing then.
      const bool isShown = published->IsMissing && published != this->GetIso();
      (isShown ? this->Warnings : this->Messages).push_back(published->Failure);
    }
  }
}

void vtkDSMSceneVolume::TakeCoarser(const std::shared_ptr<vtkDSMRankGroup>&, bool wanted)
{
  for (const auto& published : this->Arrays)
  {
    if (!this->Data || !published->Publication)
    {
      continue;
    }
    if (!wanted)
    {
      published->Coarser.reset();
      published->CoarserFailure.clear();
    }
    else if (!published->Coarser)
    {
      try
      {
        published->Coarser = this->Data->PublishCoarser(*published->Publication,
          this->MakeRequest(
            published->Choice, published == this->GetIso() ? "isosurface array" : "color array"));
      }
      catch (const dsm::Error& error)
      {
        published->Coarser = std::make_shared<vtkDSMVolumeData::Coarser>();
        published->CoarserFailure =
          std::string("Coarser levels of detail are not available: ") + error.what();
      }
    }
    if (!published->CoarserFailure.empty())
    {
      this->Messages.push_back(published->CoarserFailure);
    }
  }
}

int vtkDSMSceneVolume::CountCoarser() const
{
  int levels = this->GetIso() ? this->GetIso()->CountCoarser() : 0;
  for (const auto& published : this->Arrays)
  {
    levels = published->HasAny() ? std::min(levels, published->CountCoarser()) : levels;
  }
  return levels;
}

int vtkDSMSceneVolume::FindLevel(const rt::FrameRequest& request, double pixels, bool moving)
{
  int level = this->CountCoarser();
  if (level == 0)
  {
    return level;
  }
  const glm::dmat4 dataToWorld = this->FindDataToWorld();
  const auto isFine = [&](const std::shared_ptr<vtkDSMPartValues>& values)
  {
    return !values ||
      rt::GetSampleWidth(request, dataToWorld * values->GetIndexToData(),
        glm::dvec3(values->CountSlices() - bricks::Index3(1))) <= pixels;
  };
  int least = moving ? this->ChosenLevel : 0;
  for (const auto& values : this->GetIso()->GetParts())
  {
    least = values ? std::max(least, values->GetLevel()) : least; // it stands in for finer ones
  }
  for (; level > least; --level)
  {
    const vtkDSMVolumeData::Values& parts = this->GetIso()->GetParts(level);
    if (std::all_of(parts.begin(), parts.end(), isFine))
    {
      break;
    }
  }
  return this->ChosenLevel = level;
}

int vtkDSMSceneVolume::FindDraftLevel(const rt::FrameRequest& request, double pixels)
{
  const vtkDSMNestedLevels* const nested = this->FindNested();
  return nested
    ? nested->FindFarLevel(request,
        this->FindDataToWorld() * this->GetIso()->GetParts().front()->GetSlicesToData(), pixels)
    : 0;
}

glm::dmat4 vtkDSMSceneVolume::FindDataToWorld() const
{
  this->Prop->ComputeMatrix();
  return vtkDSMTranslation::ToMatrix(this->Prop->GetMatrix());
}

const vtkDSMNestedLevels* vtkDSMSceneVolume::FindNested() const
{
  const vtkDSMNestedLevels* first = nullptr;
  for (const auto& published : this->Arrays)
  {
    const vtkDSMNestedLevels* const nested =
      published->Publication ? vtkDSMVolumeData::FindNested(*published->Publication) : nullptr;
    if (!nested || (first && first->GetCount() != nested->GetCount()))
    {
      return nullptr;
    }
    first = first ? first : nested;
  }
  return first;
}

std::uint64_t vtkDSMSceneVolume::ChooseBoxes(
  const rt::FrameRequest& request, double pixels, bool moving)
{
  const vtkDSMNestedLevels* const nested = this->FindNested();
  if (!nested)
  {
    this->WantedBoxes.clear();
    this->IsCoarse = false;
  }
  else if (!moving || this->ShownBoxes.empty())
  {
    const vtkDSMPartValues& values = *this->GetIso()->GetParts().front();
    // The finest level is there as a whole, if it is small enough.
    const bool isWhole = pixels <= 0.0 && values.GetLevel() == 0;
    this->IsCoarse = false;
    this->WantedBoxes = isWhole
      ? vtkDSMNestedLevels::Boxes()
      : nested->FindBoxes(
          request, this->FindDataToWorld() * values.GetSlicesToData(), pixels, this->IsCoarse);
  }
  bricks::ByteHash hash;
  for (const bricks::Box& box : this->WantedBoxes)
  {
    hash.Add(&box, sizeof(box));
  }
  return this->WantedBoxes.empty() ? 0 : hash.Get();
}

void vtkDSMSceneVolume::TakeBoxes(const std::shared_ptr<vtkDSMRankGroup>&)
{
  if (!this->NeedsBoxes())
  {
    return;
  }
  this->ShownBoxes.clear();
  try
  {
    for (const auto& published : this->Arrays)
    {
      const vtkDSMVolumeData::Values old = std::move(published->Boxed);
      published->Boxed.clear();
      if (!this->WantedBoxes.empty())
      {
        published->Boxed = this->Data->PublishBoxes(*published->Publication, this->WantedBoxes,
          this->MakeRequest(
            published->Choice, published == this->GetIso() ? "isosurface array" : "color array"),
          old);
      }
    }
    this->ShownBoxes = this->WantedBoxes;
  }
  catch (const dsm::Error& error)
  {
    for (const auto& published : this->Arrays)
    {
      published->Boxed.clear();
    }
    this->WantedBoxes.clear();
    this->Messages.push_back(
      std::string("The picture has a coarser level than it could show: ") + error.what());
  }
}

void vtkDSMSceneVolume::SuggestIsovalue(dsm::Messenger& messenger)
{
  const bricks::ValueRange range = this->GetIso()->GetRange();
  const bool isOther =
    !this->Suggested || !range.MayHold(*this->Suggested) || !AreAlike(range, this->SuggestedFrom);
  // Bricks that do not fit the memory at present tell nothing of their values.
  const bool isKnown = range.First <= range.Last;
  if (!(this->SuggestedFor == this->GetIso()->Choice) || (isKnown && isOther))
  {
    this->SuggestedFor = this->GetIso()->Choice;
    this->SuggestedFrom = range;
    std::vector<bricks::SurveyedBricks> surveyed;
    for (const auto& values : this->GetIso()->GetParts())
    {
      if (values)
      {
        surveyed.push_back(values->GetSurveyed());
      }
    }
    const bricks::FirstLook look = bricks::FindFirstLook(surveyed, messenger);
    this->Suggested = look.Isovalue;
    this->ValuesWithoutFills = HasFills(look.Values, range)
      ? std::optional(std::array<double, 2>{ look.Values.Least, look.Values.Greatest })
      : std::nullopt;
  }
  this->Mapper->SetSuggestedIsoValue(this->Suggested.value_or(vtkMath::Nan()));
  this->Mapper->SetSuggestedRange(
    this->ValuesWithoutFills.value_or(std::array<double, 2>{ vtkMath::Nan(), vtkMath::Nan() }));
}

void vtkDSMSceneVolume::SetColors(rt::IsosurfaceLook& look)
{
  using Coloring = rt::IsosurfaceLook::Coloring;
  const vtkDSMVolumeData::Choice& choice = this->GetColoring().Choice;
  if (this->Mapper->GetLookupTable())
  {
    look.Colors = *this->SampleColors(this->Mapper->GetLookupTable());
  }
  if (choice.Component == vtkDSMImagePiece::Color)
  {
    look.ColoredBy =
      this->Data->GetArrays().HasOpacity(choice) ? Coloring::Colors : Coloring::OpaqueColors;
  }
}

std::shared_ptr<const rt::BlockLooks> vtkDSMSceneVolume::CreateBlockLooks(std::size_t part) const
{
  std::vector<rt::BlockLooks::Block> blocks;
  for (const vtkDSMPart::Block& block : this->Data->GetParts()[this->GetPart(part)]->GetBlocks())
  {
    rt::BlockLooks::Look look;
    if (block.Look.Color)
    {
      const auto& color = *block.Look.Color;
      look.Color = { color[0], color[1], color[2], 1.0 };
    }
    else if (block.Look.Value && this->Mapper->GetBlockScalarVisibility() &&
      this->Mapper->GetLookupTable())
    {
      vtkScalarsToColors* table = this->Mapper->GetLookupTable();
      double color[3];
      table->Build();
      table->GetColor(*block.Look.Value, color);
      look.Color = { color[0], color[1], color[2], table->GetOpacity(*block.Look.Value) };
    }
    if (block.Look.Opacity)
    {
      look.Opacity = static_cast<float>(*block.Look.Opacity);
    }
    if (look.Color || look.Opacity)
    {
      blocks.push_back({ block.Cells, look });
    }
  }
  return blocks.empty() ? nullptr : std::make_shared<const rt::BlockLooks>(std::move(blocks));
}

void vtkDSMSceneVolume::AddTo(rt::Scene& scene)
{
  if (!this->Data || !this->GetIso())
  {
    return;
  }
  if (this->IsCoarse)
  {
    this->Warnings.push_back("The picture shows coarser levels of the array '" +
      this->GetIso()->Choice.Name +
      "' than it could, because finer ones have too many bricks in it. Show a smaller part, or "
      "raise Pixels per Sample (DSMPixelsPerSample) with the Level of Detail Automatic.");
  }
  const vtkDSMVolumeLook look = this->GetLook();
  if (look.IsMedium())
  {
    this->AddMedia(look, scene);
    return;
  }
  const glm::dmat4 dataToWorld = this->FindDataToWorld();
  if (this->Mapper->GetSlicing())
  {
    this->AddSlices(look, dataToWorld, scene);
  }
  if (!look.HasIsosurfaces())
  {
    return;
  }
  const std::vector<double> isovalues = look.GetIsovalues(this->Suggested, this->Messages);
  if (!look.IsLikeRayCastMapper() && this->Mapper->GetNumberOfIsoValues() == 0 &&
    this->Mapper->GetAutomaticIsoValue() && !this->Suggested && this->GetIso()->HasAny())
  {
    this->Messages.push_back("The isosurface array '" + this->GetIso()->Choice.Name +
      "' has the same value everywhere or no valid values, so it has no surface. Choose another "
      "array.");
  }
  if (isovalues.empty() || !this->GetIso()->HasAny())
  {
    return;
  }
  const rt::ClipRegion clipping = look.GetClipRegion(dataToWorld);
  // A property's transfer functions may give each isovalue a look of its own.
  std::vector<std::vector<double>> groups;
  if (look.IsLikeRayCastMapper())
  {
    for (const double isovalue : isovalues)
    {
      groups.push_back({ isovalue });
    }
  }
  else
  {
    groups.push_back(isovalues);
  }
  this->ForEachField(*this->GetIso(), dataToWorld,
    [&](const auto& field, std::size_t part)
    {
      using FieldType = std::decay_t<decltype(field)>;
      const auto blocks = this->CreateBlockLooks(part);
      for (const std::vector<double>& group : groups)
      {
        rt::IsosurfaceOf<FieldType> object;
        object.Look.Blocks = blocks;
        object.Field = field;
        object.Isovalues = group;
        look.SetMaterials(group.front(), object.Look);
        object.Clipping = clipping;
        if (this->GetColor())
        {
          object.ColorValues = this->FindColorValues<FieldType>(part);
        }
        if (object.ColorValues)
        {
          this->SetColors(object.Look);
        }
        scene.Objects.push_back(std::move(object));
      }
    });
  this->AddCaps(look, dataToWorld, isovalues, scene);
}
