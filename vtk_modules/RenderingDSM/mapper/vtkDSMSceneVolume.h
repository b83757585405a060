// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMSceneVolume_h
#define vtkDSMSceneVolume_h

#include "vtkDSMKept.h"
#include "vtkDSMMapperMember.h"
#include "vtkDSMVolumeData.h"
#include "vtkDSMVolumeLook.h"
#include "vtkDSMVolumeMapper.h"

#include "vtkType.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

/// A volume of a scene.
class vtkDSMSceneVolume : public vtkDSMMapperMember<vtkDSMVolumeMapper>
{
public:
  using vtkDSMMapperMember::vtkDSMMapperMember;

  bool HasNewData() override;
  bool NeedsRanks(const vtkDSMRankGroup& group, bool wantsCoarser) const override;
  bool IsOutdated() override;
  bool SharesBlocks(const vtkDSMSceneMember& other) const override;
  void GiveUpBlocks() override;
  bool HasBlocks() const override { return !this->Arrays.empty(); }
  void Update(const std::shared_ptr<vtkDSMRankGroup>& group, bool newData) override;
  void TakeCoarser(const std::shared_ptr<vtkDSMRankGroup>& group, bool wanted) override;
  int CountCoarser() const override;
  int FindLevel(const rt::FrameRequest& request, double pixels, bool moving) override;
  std::uint64_t ChooseBoxes(const rt::FrameRequest& request, double pixels, bool moving) override;
  bool NeedsBoxes() const override
  {
    return !(this->WantedBoxes == this->ShownBoxes) ||
      (!this->WantedBoxes.empty() && !this->AreBoxed());
  }
  bool HasBoxes() const override { return !this->ShownBoxes.empty() && this->AreBoxed(); }
  int FindDraftLevel(const rt::FrameRequest& request, double pixels) override;
  void TakeBoxes(const std::shared_ptr<vtkDSMRankGroup>& group) override;
  /// One object, or medium, for each of the volume's parts, and of the components that are shown at once.
  void AddTo(rt::Scene& scene) override;
  void ExtractIsosurfaces(
    vtkDSMRankGroup& group, Purpose purpose, vtkMultiBlockDataSet* surfaces) override;

private:
  class TriangleMaker;

  /// Returns whether the mapper has other data than were taken in.
  bool HasOtherData() const;

  struct Published
  {
    vtkDSMVolumeData::Choice Choice;
    std::shared_ptr<const vtkDSMVolumeData::Publication> Publication; ///< null when it failed
    std::string Failure;
    bool IsMissing = false;                                   ///< there is no such array
    unsigned RetryVersion = 0;                                ///< the group's when it was tried
    std::shared_ptr<const vtkDSMVolumeData::Coarser> Coarser; ///< null until they are wanted
    std::string CoarserFailure;
    vtkDSMVolumeData::Values Boxed; ///< of the levels' boxes that are shown
    /// Returns whether this is the result of publishing the array, and publishing it again would
    /// give the same.
    bool IsOf(const vtkDSMVolumeData::Choice& choice, unsigned retryVersion) const;
    /// The values of the parts; empty when it failed. `level`: of detail; the finest is 0.
    const vtkDSMVolumeData::Values& GetParts(int level = 0) const;
    /// Returns whether there is anything to show.
    bool HasAny() const { return !this->GetParts().empty(); }
    int CountCoarser() const { return this->Coarser ? static_cast<int>(this->Coarser->size()) : 0; }
    /// Returns the range of all values; without any, its First is greater than its Last.
    bricks::ValueRange GetRange() const;
  };

  /// The most arrays, or components of one, that can be shown together.
  static constexpr std::size_t MostArrays = 4;

  /// Collective. Takes in the mapper's dataset; bricks of arrays that hold what they held are kept.
  void TakeData(const std::shared_ptr<vtkDSMRankGroup>& group);
  /// Keeps publications that other values may take over, and releases the rest.
  void KeepUnchanged(dsm::Messenger& messenger);
  /// Returns the publication that Publish may take over. Releases all stale publications if there
  /// is none, because memory may be short.
  std::shared_ptr<const vtkDSMVolumeData::Publication> TakeStale(
    const vtkDSMVolumeData::Choice& choice);
  /// Returns what to publish; it reports progress.
  vtkDSMPart::Request MakeRequest(
    const vtkDSMVolumeData::Choice& choice, const char* purpose) const;
  std::shared_ptr<Published> Require(const vtkDSMVolumeData::Choice& choice, const char* purpose,
    unsigned retryVersion, const std::vector<std::shared_ptr<Published>>& known);
  /// Collective. Finds the isovalue for a first look at the array, unless the last one still suits its values.
  void SuggestIsovalue(dsm::Messenger& messenger);
  bool LacksSuggestion() const;
  glm::dmat4 FindDataToWorld() const;
  vtkDSMVolumeLook GetLook() const { return { this->Mapper, this->Prop }; }
  /// Returns the shown arrays among the available ones: see vtkDSMVolumeLook::GetShown.
  std::vector<vtkDSMVolumeData::Choice> GetShown() const;
  ///@{
  /// The array of the isosurfaces, slices, or of the medium's opacities; the one that colors these; null where
  /// there is none.
  std::shared_ptr<Published> GetIso() const
  {
    return this->Arrays.empty() ? nullptr : this->Arrays.front();
  }
  std::shared_ptr<Published> GetColor() const
  {
    return this->Arrays.size() > 1 ? this->Arrays[1] : nullptr;
  }
  ///@}
  /// Returns the array whose values the colors represent: slices alone, and most media, are colored
  /// by their own array.
  const Published& GetColoring() const { return *this->Arrays[this->Arrays.size() > 1 ? 1 : 0]; }
  /// Returns whether each of the levels' boxes is shown as a part.
  bool ShowsBoxes() const { return this->HasBoxes() && this->GetCoarser() == 0; }
  /// Returns whether all arrays have boxes. New data and arrays have none yet.
  bool AreBoxed() const
  {
    return std::none_of(this->Arrays.begin(), this->Arrays.end(),
      [](const auto& published) { return published->Boxed.empty(); });
  }
  /// Returns the levels of which all arrays have boxes; null: none.
  const vtkDSMNestedLevels* FindNested() const;
  /// Returns the values of the parts at the level of detail that is shown.
  const vtkDSMVolumeData::Values& GetParts(const Published& array) const
  {
    return this->ShowsBoxes() ? array.Boxed
                              : array.GetParts(std::min(this->GetCoarser(), this->CountCoarser()));
  }
  /// Returns what a part that is shown is of, among those of the dataset.
  std::size_t GetPart(std::size_t shown) const { return this->ShowsBoxes() ? 0 : shown; }
  /// Calls `visit(field, part)` for each part that is shown and has the array, in their order: those of the dataset, or
  /// the levels' boxes.
  template <class Visit>
  void ForEachField(const Published& array, const glm::dmat4& dataToWorld, const Visit& visit) const
  {
    const vtkDSMVolumeData::Values& parts = this->GetParts(array);
    for (std::size_t part = 0; part < parts.size(); ++part)
    {
      if (parts[part])
      {
        std::visit(
          [&](const auto& field) { visit(field, part); }, parts[part]->GetField(dataToWorld));
      }
    }
  }
  /// Returns the values of the color array in a part, at the current level of detail; null if it has none there.
  template <class FieldType>
  std::shared_ptr<const typename FieldType::Values> FindColorValues(std::size_t part) const
  {
    const vtkDSMVolumeData::Values& parts = this->GetParts(this->GetColoring());
    return parts.empty() || !parts[part]
      ? nullptr
      : std::get<FieldType>(parts[part]->GetField(glm::dmat4(1.0))).Voxels;
  }
  /// The same, if the array of a medium's colors differs from that of its opacities.
  template <class FieldType>
  std::shared_ptr<const typename FieldType::Values> FindOwnColors(std::size_t part) const
  {
    const bool hasOwn = !this->HasSeveralMedia() && !this->HasSecondArray() && this->GetColor();
    return hasOwn ? this->FindColorValues<FieldType>(part) : nullptr;
  }
  /// Returns whether the medium's components are independent.
  bool IsOfComponents() const
  {
    return this->GetLook().GetComponents(this->Data->GetArrays()) ==
      vtkDSMVolumeLook::Components::Independent;
  }
  /// Returns whether the second array is the second axis of the medium's two-dimensional function.
  bool HasSecondArray() const { return this->GetLook().HasSecondArray(this->Data->GetArrays()); }
  /// Returns whether each of the arrays is a medium of its own.
  bool HasSeveralMedia() const { return this->IsOfComponents() && !this->HasSecondArray(); }
  /// Returns the range of the second axis of a two-dimensional function; none, if there is no such function. `range`:
  /// of the values.
  std::optional<std::array<double, 2>> GetSecondRange(const bricks::ValueRange& range) const;
  void AddMedia(const vtkDSMVolumeLook& look, rt::Scene& scene);
  /// One medium, of one of the arrays, for each of the volume's parts. `groups`: of the parts' media; 0: none yet.
  void AddMedium(const vtkDSMVolumeLook& look, std::size_t number, const glm::dmat4& dataToWorld,
    std::vector<int>& groups, rt::Scene& scene);
  /// Returns what the medium's values are of.
  vtkDSMVolumeLook::Grids GetGrids() const;
  /// Returns how the values of a component of the medium are found.
  vtkDSMVolumeLook::Sampling GetMediumSampling(int component) const;
  /// Returns whether that array's values are colors.
  bool HasDirectColors() const;
  /// The medium's colors, with the opacities of the same values or without; of the first one of several.
  std::shared_ptr<const rt::ColorMap> GetMediumColors(bool hasOpacity);
  /// Sets the colors of a surface by the color array.
  void SetColors(rt::IsosurfaceLook& look);
  /// Slices alone, or with isosurfaces.
  void AddSlices(const vtkDSMVolumeLook& look, const glm::dmat4& dataToWorld, rt::Scene& scene);
  /// The faces that clipping planes cut out of isosurfaces of these values, which ascend.
  void AddCaps(const vtkDSMVolumeLook& look, const glm::dmat4& dataToWorld,
    const std::vector<double>& isovalues, rt::Scene& scene);
  /// The same of the medium.
  void AddCaps(const vtkDSMVolumeLook& look, const glm::dmat4& dataToWorld, rt::Scene& scene);
  /// Creates a slice with the settings that slices and faces of isosurfaces share.
  template <class FieldType>
  rt::SliceOf<FieldType> CreateSlice(const vtkDSMVolumeLook& look, const glm::dmat4& dataToWorld,
    const FieldType& field, std::size_t part, bool isLit);
  /// Creates the looks of a part's blocks that differ from the rest; null if there are none.
  std::shared_ptr<const rt::BlockLooks> CreateBlockLooks(std::size_t part) const;

  const vtkDataObject* SeenData = nullptr;
  vtkMTimeType SeenTime = 0;
  vtkDSMBlockLooks SeenLooks;
  std::vector<vtkDSMVolumeData::Choice> SeenShown;
  bool Taken = false;
  std::unique_ptr<vtkDSMVolumeData> Data;
  /// Publications of the arrays of GetShown, in their order. Several may be the same one.
  std::vector<std::shared_ptr<Published>> Arrays;
  ///@{
  /// A picture's boxes of the levels of the dataset's file; empty: one level is shown whole.
  vtkDSMNestedLevels::Boxes WantedBoxes;
  vtkDSMNestedLevels::Boxes ShownBoxes;
  ///@}
  bool IsCoarse = false; ///< finer boxes would have too many bricks
  int ChosenLevel = 0;   ///< the last one of FindLevel
  /// Publications of the previous values, during Update.
  std::vector<std::shared_ptr<Published>> Stale;
  std::optional<double> Suggested;                         ///< isovalue
  std::optional<std::array<double, 2>> ValuesWithoutFills; ///< their range, if there are fills
  vtkDSMVolumeData::Choice SuggestedFor;
  bricks::ValueRange SuggestedFrom{}; ///< range of the values that suggested it
  /// For each of the arrays, those of the last frame's parts.
  std::map<vtkDSMVolumeLook::MediumKey, vtkDSMVolumeLook::MediumMaker> MediumMakers[MostArrays];
  using KeptColors = std::shared_ptr<const rt::ColorMap>;
  /// Without opacities, and with; by the property and its time, the component, whether it has categories, and the
  /// range of values.
  vtkDSMKept<std::tuple<vtkVolumeProperty*, vtkMTimeType, int, bool, float, float>, KeptColors>
    MediumColors[2];
  /// By the map, and the opacity function and its time.
  vtkDSMKept<std::tuple<KeptColors, vtkPiecewiseFunction*, vtkMTimeType>, KeptColors> SliceColors;
  std::vector<std::string> MissingFeatures; ///< warnings that new data do not repeat
  std::string DataFailure;
  unsigned SettingsVersion = 0; ///< the group's at the last Update
};

#endif
