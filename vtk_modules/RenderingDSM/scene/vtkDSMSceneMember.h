// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMSceneMember_h
#define vtkDSMSceneMember_h

#include "DSMRayTracing/frame/FrameRequest.h"
#include "DSMRayTracing/scene/Scene.h"
#include "vtkDSMRankGroup.h"

#include "vtkTimeStamp.h"
#include "vtkType.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkDSMLightOptions;
class vtkDSMMemoryOptions;
class vtkMultiBlockDataSet;
class vtkProp3D;
class vtkScalarsToColors;

/// State that a scene keeps for one mapper: its data in bricks, and its messages.
class vtkDSMSceneMember
{
public:
  vtkDSMSceneMember();
  virtual ~vtkDSMSceneMember();
  vtkDSMSceneMember(const vtkDSMSceneMember&) = delete;
  vtkDSMSceneMember& operator=(const vtkDSMSceneMember&) = delete;

  /// Returns null for a mapper of another kind.
  using Maker = std::unique_ptr<vtkDSMSceneMember> (*)(vtkAlgorithm* mapper);

  /// A kind of mapper says what is kept of it, before one is first drawn; again does nothing.
  static void AddKind(Maker make);

  /// Creates a member for any kind of mapper; null if the mapper is not traced.
  static std::unique_ptr<vtkDSMSceneMember> Create(vtkAlgorithm* mapper);

  /// Returns the mapper; null once it is deleted.
  virtual vtkAlgorithm* GetAlgorithm() const = 0;

  /// Options of the mapper.
  virtual vtkDSMMemoryOptions* GetMemoryOptions() const = 0;
  virtual vtkDSMLightOptions* GetLightOptions() const = 0;

  /// Local: brings the mapper's input up to date.
  virtual void UpdatePiece(int piece, int numberOfPieces) = 0;

  /// Local: whether this rank's data are other than what was taken in. True also where that would
  /// only be found out by reading all of them.
  virtual bool HasNewData() = 0;
  /// Local, without new data: returns whether Update, or TakeCoarser with the same `wantsCoarser`, has
  /// anything to do together with the other ranks, or to give up. If not, both are local, and change nothing
  /// that the ranks share.
  virtual bool NeedsRanks(const vtkDSMRankGroup& group, bool wantsCoarser) const = 0;

  /// Local, also while the scene has not looked at its props: returns whether the data that were taken in no longer
  /// exist.
  virtual bool IsOutdated() = 0;
  /// Local, the same on every rank: whether another member, of any scene, has some of this one's bricks.
  virtual bool SharesBlocks(const vtkDSMSceneMember& other) const = 0;
  /// Collective, before new data are taken in. Where the old ones' bricks are shared by members that are outdated
  /// on all ranks, these give their bricks up, so that there is room, or that the bricks can be taken over. Returns
  /// those members.
  std::vector<const vtkDSMSceneMember*> FreeOutdated(dsm::Messenger& messenger);

  /// Local, in the same order on every rank: retires the bricks; the next Update publishes them again.
  virtual void GiveUpBlocks() = 0;
  virtual bool HasBlocks() const = 0;

  /// Collective. Takes in what is missing: everything when any rank has new data, else what the mapper names and is
  /// still missing. Failures are kept as messages.
  virtual void Update(const std::shared_ptr<vtkDSMRankGroup>& group, bool newData) = 0;

  /// Collective, after Update. While they are wanted, the mapper's data are there at coarser levels, too, where
  /// their files have some.
  virtual void TakeCoarser(const std::shared_ptr<vtkDSMRankGroup>&, bool /*wanted*/) {}
  /// Local, the same on every rank: how many of them there are.
  virtual int CountCoarser() const { return 0; }
  /// Local, the same on every rank: the coarsest level of detail whose samples a picture shows so many pixels apart, or
  /// less, where they are nearest to the camera; else the finest (0). `request`: of edge 1. `moving`: the one before,
  /// rather than a finer one.
  virtual int FindLevel(const rt::FrameRequest& /*request*/, double /*pixels*/, bool /*moving*/)
  {
    return 0;
  }
  /// Local, the same on every rank: the same where they are farthest away, for a picture that is to be there soon.
  virtual int FindDraftLevel(const rt::FrameRequest& /*request*/, double /*pixels*/) { return 0; }
  ///@{
  /// Of levels of which a picture shows a box each (vtkDSMNestedLevels): ChooseBoxes finds the boxes for a picture,
  /// local, and returns a number that ranks share that find the same; 0: there are none. NeedsBoxes says whether
  /// others are shown; TakeBoxes is collective, and shows those that were chosen. 0 pixels: the finest everywhere.
  /// While a view is `moving`, the boxes stay that are shown.
  virtual std::uint64_t ChooseBoxes(
    const rt::FrameRequest& /*request*/, double /*pixels*/, bool /*moving*/)
  {
    return 0;
  }
  virtual bool NeedsBoxes() const { return false; }
  virtual bool HasBoxes() const { return false; }
  virtual void TakeBoxes(const std::shared_ptr<vtkDSMRankGroup>&) {}
  ///@}
  /// At which level AddTo shows the data: the finest (0), or so many below it, or the coarsest there is.
  void SetCoarser(int level) { this->Coarser = level; }

  /// Purpose of extracted surfaces; see vtkDSMScene::ExtractIsosurfaces.
  enum class Purpose
  {
    Selection,
    Export
  };
  /// Collective, after Update: adds the isosurfaces in this rank's data to `surfaces`. Throws the same dsm::Error
  /// on every rank.
  virtual void ExtractIsosurfaces(vtkDSMRankGroup&, Purpose, vtkMultiBlockDataSet* /*surfaces*/) {}

  /// Local: what the prop shows.
  virtual void AddTo(rt::Scene& scene) = 0;

  /// The prop of the frame that uses the mapper.
  void SetProp(vtkProp3D* prop)
  {
    this->Prop = prop;
    this->Shown.Modified();
  }
  /// When a frame last showed it; on every rank in the same order.
  vtkMTimeType GetTimeShown() const { return this->Shown.GetMTime(); }

  /// Reports the messages that are new since the last call. They are the same on every rank, so only one `tells`
  /// them; on others they reach who observes the error or warning event.
  void ReportMessages(bool tells);

protected:
  /// The table's colors; sampled again when it has changed.
  std::shared_ptr<const rt::ColorMap> SampleColors(vtkScalarsToColors* table);

  int GetCoarser() const { return this->Coarser; }

  vtkProp3D* Prop = nullptr;
  /// Messages of the last Update and AddTo: errors, and warnings about data that are shown in other
  /// colors than requested.
  std::vector<std::string> Messages;
  std::vector<std::string> Warnings;
  std::vector<std::string> Reported; ///< messages of both kinds

private:
  int Coarser = 0;
  std::shared_ptr<const rt::ColorMap> Colors;
  const void* ColorsSource = nullptr;
  vtkMTimeType ColorsTime = 0;
  vtkTimeStamp Shown;
};

#endif
