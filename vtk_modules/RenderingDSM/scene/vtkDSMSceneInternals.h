// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMSceneInternals_h
#define vtkDSMSceneInternals_h

#include "DSMCore/base/FirstFailure.h"
#include "DSMRayTracing/frame/FrameAccumulation.h"
#include "DSMRayTracing/frame/LightFilter.h"
#include "DSMRayTracing/frame/MovingDetail.h"
#include "DSMRayTracing/frame/Resolution.h"
#include "DSMVolumeFiles/cache/ReadAhead.h"
#include "vtkDSMDepthReader.h"
#include "vtkDSMFrameDelivery.h"
#include "vtkDSMFrameProp.h"
#include "vtkDSMLightOptions.h"
#include "vtkDSMRankGroup.h"
#include "vtkDSMScene.h"
#include "vtkDSMSceneMembers.h"
#include "vtkDSMStatistics.h"
#include "vtkDSMTranslation.h"

#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkWeakPointer.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Private state of a scene. Functions of a frame are collective: on every rank, in this order,
/// Members.Find, FindGroup and MakeFrame.
class vtkDSMScene::Internals : public vtkDSMRankGroup::Publisher
{
public:
  ~Internals() override;
  void GiveUpBlocks() override;
  std::uint64_t GetOldestHidden() const override;
  void GiveUpOldestHidden() override;

  /// The ranks that trace together; joins them. Throws dsm::Error on all ranks.
  void FindGroup(vtkMultiProcessController* controller);
  /// Takes in data that changed, traces the frame, and gives it to the prop; or does nothing, because of
  /// what has failed earlier. Returns why there is no frame, the same on every rank, if there is none.
  std::string MakeFrame(const dsm::FirstFailure& earlier);
  /// Likewise: takes in data that changed, and adds the isosurfaces of a mapper in this rank's data to `surfaces`.
  /// Returns why there are none, the same on every rank, if that fails.
  std::string Extract(const dsm::FirstFailure& earlier, vtkAlgorithm* mapper,
    vtkDSMSceneMember::Purpose purpose, vtkMultiBlockDataSet* surfaces);
  /// Nothing is shown.
  void Clear();
  /// The last picture stays, though the camera may be another: until the frame ends, all of it is what the ranks
  /// exchange.
  void ShowWhole() const;
  /// Throws dsm::Error where the target is larger than what memory allows for each of so many ranks of this host.
  void CheckImage(int ranksOnHost) const;
  /// Into the target's image, where there is one; without pixels, nothing but background.
  void FillImage(const rt::Picture& picture) const;

  /// Image that is rendered for no window.
  struct Target
  {
    int Width;
    int Height;
    vtkImageData* Image; ///< may be null
    bool IsTransparent;
  };

  /// The pictures that an eye sees. On every rank the same, but after a failure.
  struct Sight
  {
    rt::FrameAccumulation Accumulation;
    rt::Resolution::Shown Shown;
    bool HasAdvanced = false;          ///< since the last render of another picture
    bool HasBegun = false;             ///< the last render, of a picture
    glm::dmat4 LastWorldToClip{ 1.0 }; ///< of the accumulation's last whole frame
  };
  /// Returns whether the window shows the scene to two eyes; the same on every rank.
  bool IsStereo() const;
  /// Takes the eye that the camera stands for.
  void ChooseEye();

  Sight Eyes[2]; ///< left or only one, right
  Sight* Eye = &this->Eyes[0];
  bool AdvancesLeft = false; ///< of two eyes, the left one first

  vtkWeakPointer<vtkRenderer> Renderer;
  std::optional<Target> Image; ///< while one is traced
  unsigned long Observers[4] = { 0, 0, 0, 0 };
  vtkSmartPointer<vtkDSMScene> Keeper; ///< the scene itself, if only the renderer keeps it
  vtkSmartPointer<vtkDSMScene>
    Rendering;                ///< the scene itself, from the start of a render to its end
  bool DrawsAgain = false;    ///< it was made in the middle of a frame
  rt::Environment Background; ///< of this rank's renderer, as set by the application
  vtkSmartPointer<vtkMultiProcessController> Controller;
  vtkNew<vtkDSMFrameProp> Prop;
  double Bounds[6] = { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 }; ///< bounds of all that the prop shows
  vtkNew<vtkDSMStatistics> Statistics;
  std::shared_ptr<vtkDSMRankGroup> Group;
  vtkNew<vtkDSMLightOptions> Light;
  vtkDSMSceneMembers Members;
  rt::MovingDetail Detail;
  vtkDSMFrameDelivery Delivery;
  vtkDSMDepthReader DepthReader;
  std::string LateFailure;     ///< of the last frame, on this rank alone
  std::string Failure;         ///< that was reported last
  unsigned FailureVersion = 0; ///< the group's settings version then
  bool Tracing = false;
  /// Tiles of any scene: while they are traced, there is no other frame.
  inline static bool TracingTiles = false;
  bool IsTraced =
    false; ///< the frame, of data that were taken in: should it fail, the last picture stays
  int SamplesPerFrame = 0;      ///< of still images
  double SecondsPerFrame = 0.0; ///< 0: unlimited
  /// The picture that was drawn last gets tiles and samples, and nothing is drawn, as long as this returns true on rank
  /// 0; empty: a frame is drawn.
  std::function<bool()> GoesOn;
  int InteractiveReduction = 0;
  bool IsInteracting = false; ///< whatever rate the window wants
  bool ShowsDrafts = false;
  bool HasNextStep = false; ///< new data in place of others that were shown
  bool AlwaysFinest = false;
  vtkDSMTranslation::TileDisplay Display;
  /// Nothing is read ahead until the renderer has drawn the frame.
  std::optional<vol::ReadAhead::Pause> Busy;
  unsigned SettledVersion = 0; ///< version of the group's settings

private:
  using Records = std::vector<std::vector<std::byte>>;
  using Offers = std::vector<rt::FrameAccumulation::Offer>;
  struct View;
  void Draw(bool& isOver);
  std::string Conclude(const dsm::Status& outcome);
  void TakeIn();
  std::vector<std::byte> EncodeHoldings(bool& needsUpdate);
  static void CheckHoldings(const Records& records);
  void Update(const Records& records);
  void Update(vtkDSMSceneMember& member, bool newData);
  std::vector<std::byte> EncodeView(
    rt::Scene& scene, rt::FrameRequest& request, vtkMatrix4x4* projection);
  static void CheckViews(const std::vector<View>& views);
  static void TakeLights(const std::vector<std::byte>& record, std::size_t at, rt::Scene& scene);
  int AgreeOnView(
    const std::vector<View>& views, rt::Scene& scene, rt::FrameRequest& request) const;
  void KeepProp(const rt::Scene& scene);
  void LimitRays(rt::FrameRequest& request, bool cutsMedia);
  bool IsInteractive() const;
  bool MayFilterLight(const rt::Scene& scene) const;
  bool FiltersLight(const rt::FrameRequest& request) const;
  const rt::Frame& FilterLight(const glm::dmat4& worldToClip);
  rt::FrameAccumulation::Pace GetPace() const;
  bool HasNotes() const;
  bool IsReduced() const;
  int GetMovingEdge(const rt::FrameRequest& request) const;
  bool DrawsDrafts() const;
  int CountCoarser() const;
  bool WantsCoarser() const;
  std::uint64_t ChooseLevels(const rt::FrameRequest& request);
  /// A picture to try: `Coarser` levels of detail below the finest.
  struct Try
  {
    int Coarser;
    rt::Resolution::Try Picture;
  };
  /// A picture to trace.
  struct Task
  {
    rt::Scene& Scene;
    rt::FrameRequest Whole;      ///< of edge 1
    rt::FrameRequest& Request;   ///< that of the picture
    rt::Resolution::Shown Shown; ///< by rank 0
    int Coarser;                 ///< levels of detail that may stand in
    const std::function<void(rt::FrameRequest&)>&
      Limit; ///< collective, ends the rays of a request (LimitRays)
    /// What this rank draws, as far as it needs no other ranks, when the frame was traced.
    rt::Picture& Picture;
    std::uint64_t Content = 0;
    double MediumErrors = 1.0;
    int CoarserInScene = 0; ///< levels below the finest that are in the scene now
  };
  std::vector<Try> GetTries(const Task& task) const;
  rt::FrameAccumulation::Result TraceScene(Task task, Offers offers);
  bool IsDraft(const Try& picture) const;
  int GetLevel(const Try& picture) const;
  bool IsLimited(const Task& task) const;
  bool IsUnderWay(const Task& task) const;
  rt::FrameAccumulation::Result TracePicture(Task& task, Offers& offers);
  void NoteTraced(const Task& task, const Try& done);
  void NoteAborted(const Task& task, const Try& begun);
  rt::Picture FillGaps(const rt::FrameRequest& request, bool hasEdges);
  void TellOfTracing(double part) const;
  void DrawPicture(rt::Picture picture, const rt::FrameRequest& request, vtkMatrix4x4* projection,
    rt::DebugView view, bool hasNotes, bool hasEdges);
  bool WriteNotes(rt::DebugView view, rt::Picture& picture) const;
  void AddWholeView(const rt::FrameRequest& request, double bounds[6]) const;
};

#endif
