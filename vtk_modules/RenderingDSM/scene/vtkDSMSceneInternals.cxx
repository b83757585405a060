// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMSceneInternals.h"

#include "DSMCore/memory/HostMemory.h"
#include "vtkDSMFrameImage.h"
#include "vtkDSMFrameNotes.h"

#include "vtkBoundingBox.h"
#include "vtkCamera.h"
#include "vtkMatrix4x4.h"
#include "vtkPropCollection.h"
#include "vtkRenderWindow.h"
#include "vtkVolume.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace
{

/// Frames per second; an application that wants as many from its window is moving the camera.
constexpr double InteractiveRate = 1.0;

/// A pixel's color and depth, in a picture without a window: as tiles, as the message with them, as the messages of all
/// ranks, and as the picture or, later, the image.
constexpr std::uint64_t BytesOfImagePixel = 4 * (4 + sizeof(float));

/// Returns the text of a failure.
std::string Describe(const dsm::Status& outcome)
{
  return outcome.IsEverywhere ? outcome.Cause
                              : "Rank " + std::to_string(outcome.FailedRank) + ": " + outcome.Cause;
}

/// A camera learns whether its window is stereo when it renders, which is too late for its first frame. Only subclasses
/// can tell it before; none is ever made.
struct EyeOfCamera : vtkCamera
{
  static void SetStereo(vtkCamera* camera, bool isStereo)
  {
    camera->*& EyeOfCamera::Stereo = isStereo ? 1 : 0;
  }
};

} // namespace

vtkDSMScene::Internals::~Internals()
{
  if (this->Group)
  {
    this->Group->Leave(this);
  }
}

void vtkDSMScene::Internals::GiveUpBlocks()
{
  this->Members.GiveUpBlocks();
  for (Sight& eye : this->Eyes)
  {
    eye.Accumulation.Restart();
    eye.Shown.Content = 0;
  }
}

bool vtkDSMScene::Internals::IsStereo() const
{
  vtkRenderWindow* window = this->Image ? nullptr : this->Renderer->GetRenderWindow();
  return window && window->GetStereoRender() != 0;
}

void vtkDSMScene::Internals::ChooseEye()
{
  const bool isStereo = this->IsStereo();
  if (!this->Image)
  {
    EyeOfCamera::SetStereo(this->Renderer->GetActiveCamera(), isStereo);
  }
  this->Eye = &this->Eyes[isStereo && !this->Renderer->GetActiveCamera()->GetLeftEye() ? 1 : 0];
  if (!isStereo)
  {
    this->Eyes[1] = {};
  }
}

std::uint64_t vtkDSMScene::Internals::GetOldestHidden() const
{
  const vtkDSMSceneMember* oldest = this->Members.FindOldestHidden();
  return oldest ? oldest->GetTimeShown() : 0;
}

void vtkDSMScene::Internals::GiveUpOldestHidden()
{
  this->Members.FindOldestHidden()->GiveUpBlocks();
}

void vtkDSMScene::Internals::FindGroup(vtkMultiProcessController* controller)
{
  const auto group = vtkDSMRankGroup::Get(controller);
  if (group == this->Group)
  {
    return;
  }
  if (this->Group)
  {
    this->GiveUpBlocks();
    this->Group->Leave(this);
  }
  this->Group = group;
  this->Group->Join(this);
}

/// Collective: what fails on one rank, wherever, is everybody's failure, and the next frame begins
/// anew.
std::string vtkDSMScene::Internals::MakeFrame(const dsm::FirstFailure& earlier)
{
  bool isOver = false;
  dsm::Status outcome = this->Group->GetMessenger().RunStep(
    [&]
    {
      earlier.Throw();
      if (!this->LateFailure.empty())
      {
        throw dsm::Error(std::exchange(this->LateFailure, {}));
      }
      this->Draw(isOver);
    },
    isOver);
  this->Group->ReturnMemoryOfFiles();
  if (outcome.IsOk())
  {
    this->Group->TellOrganization();
    return {};
  }
  if (isOver && !outcome.IsEverywhere)
  {
    std::string failure = Describe(outcome);
    this->LateFailure = std::move(outcome.Cause);
    return failure;
  }
  return this->Conclude(outcome);
}

std::string vtkDSMScene::Internals::Extract(const dsm::FirstFailure& earlier, vtkAlgorithm* mapper,
  vtkDSMSceneMember::Purpose purpose, vtkMultiBlockDataSet* surfaces)
{
  const bool isOver = false;
  const dsm::Status outcome = this->Group->GetMessenger().RunStep(
    [&]
    {
      earlier.Throw();
      this->TakeIn();
      for (const auto& member : this->Members.GetShown())
      {
        if (member.State->GetAlgorithm() == mapper)
        {
          member.State->ExtractIsosurfaces(*this->Group, purpose, surfaces);
          return; // other props may show the same
        }
      }
    },
    isOver);
  this->Group->ReturnMemoryOfFiles();
  return outcome.IsOk() ? std::string() : this->Conclude(outcome);
}

/// After a failure of any rank. Returns its text.
std::string vtkDSMScene::Internals::Conclude(const dsm::Status& outcome)
{
  if (!outcome.IsEverywhere)
  {
    this->IsTraced = false;
    this->GiveUpBlocks(); // the ranks may have different bricks now
    this->Group->GetPublications().Forget();
  }
  return Describe(outcome);
}

/// Returns whether data are to be there at coarser levels, too.
bool vtkDSMScene::Internals::WantsCoarser() const
{
  const vtkDSMMemoryOptions* const options = this->Group->GetOptions();
  return options->GetCoarserDataWhileMoving() ||
    options->GetLevelOfDetail() == vtkDSMMemoryOptions::AutomaticLevel;
}

/// Local: see vtkDSMSceneMembers.
std::uint64_t vtkDSMScene::Internals::ChooseLevels(const rt::FrameRequest& request)
{
  vtkDSMMemoryOptions* const options = this->Group->GetOptions();
  const bool isAutomatic = options->GetLevelOfDetail() == vtkDSMMemoryOptions::AutomaticLevel;
  return this->Members.ChooseLevels(
    request, isAutomatic ? options->GetPixelsPerSample() : 0.0, this->IsInteractive());
}

/// Levels below the finest that may stand in, as far as this rank knows.
int vtkDSMScene::Internals::CountCoarser() const
{
  const bool mayBeCoarser =
    (this->Group->GetOptions()->GetCoarserDataWhileMoving() || this->Members.HaveBoxes()) &&
    this->IsInteractive() && !this->AlwaysFinest;
  return mayBeCoarser ? this->Members.CountCoarser() : 0;
}

void vtkDSMScene::Internals::CheckImage(int ranksOnHost) const
{
  if (!this->Image)
  {
    return;
  }
  const std::uint64_t pixels = static_cast<std::uint64_t>(this->Image->Width) * this->Image->Height;
  const std::uint64_t needed = BytesOfImagePixel * pixels;
  const std::uint64_t available = dsm::GetAvailableHostMemory() / ranksOnHost;
  if (needed > available)
  {
    throw dsm::Error("A picture of " + std::to_string(this->Image->Width) + " x " +
      std::to_string(this->Image->Height) + " pixels takes " + dsm::FormatMebibytes(needed) +
      " per rank, but the host has " + dsm::FormatMebibytes(available) +
      " per rank. Use a smaller picture.");
  }
}

void vtkDSMScene::Internals::FillImage(const rt::Picture& picture) const
{
  if (this->Image && this->Image->Image)
  {
    vtkDSMFrameImage::Fill(this->Image->Image, this->Image->Width, this->Image->Height, picture,
      this->Background, this->Image->IsTransparent);
  }
}

void vtkDSMScene::Internals::DrawPicture(rt::Picture picture, const rt::FrameRequest& request,
  vtkMatrix4x4* projection, rt::DebugView view, bool hasNotes, bool hasEdges)
{
  this->Members.GetBounds(this->Bounds);
  double bounds[6];
  std::copy_n(this->Bounds, 6, bounds);
  this->Delivery.Prepare(request, picture);
  // If the ranks' images are blended, each has the notes; if the nearest is shown, only one does.
  const bool writesNotes =
    this->Delivery.AreBlended() || this->Group->GetMessenger().GetRank() == 0;
  rt::Picture unseen;
  if (hasNotes && this->WriteNotes(view, writesNotes ? picture : unseen))
  {
    this->AddWholeView(request, bounds);
  }
  const std::vector<vtkProp*> others =
    request.Layers > 1 ? this->Members.FindOthers(this->Renderer) : std::vector<vtkProp*>();
  // FXAA runs before volumes are drawn, but after ranks' images are composited: the picture would depend on the ranks.
  this->Prop->SetIsAmongTranslucent(this->Renderer->GetUseFXAA() ||
    std::any_of(others.begin(), others.end(),
      [](vtkProp* prop)
      { return vtkVolume::SafeDownCast(prop) || prop->HasTranslucentPolygonalGeometry(); }));
  this->Delivery.Show(request, std::move(picture), this->Renderer->GetActiveCamera(), projection,
    bounds, hasEdges, this->Prop);
}

bool vtkDSMScene::Internals::HasNotes() const
{
  return this->Light->GetShowStatistics() ||
    (vtkDSMTranslation::ToDebugView(this->Light) != rt::DebugView::Off &&
      this->Light->GetShowLegend());
}

/// Returns whether there is anything to write, on any rank.
bool vtkDSMScene::Internals::WriteNotes(rt::DebugView view, rt::Picture& picture) const
{
  if (!this->HasNotes())
  {
    return false;
  }
  const bool showsStatistics = this->Light->GetShowStatistics();
  const bool showsLegend = view != rt::DebugView::Off && this->Light->GetShowLegend();
  std::vector<vtkDSMFrameNotes::Entry> legend;
  if (showsLegend)
  {
    legend = vtkDSMFrameNotes::CreateLegend(view, this->Statistics);
  }
  vtkDSMFrameNotes::Draw(showsStatistics ? this->Statistics->GetSummary() : std::string(), legend,
    vtkDSMFrameNotes::FindPlace(this->Renderer, picture), picture);
  return true;
}

/// Ranks exchange only the part of the picture where there is anything by the bounds.
void vtkDSMScene::Internals::AddWholeView(const rt::FrameRequest& request, double bounds[6]) const
{
  if (this->Group->GetMessenger().GetSize() == 1)
  {
    return;
  }
  vtkBoundingBox box(bounds);
  const glm::dmat4 clipToWorld = glm::inverse(request.WorldToClip);
  for (int corner = 0; corner < 4; ++corner)
  {
    const glm::dvec4 world =
      clipToWorld * glm::dvec4(corner % 2 == 0 ? -1.0 : 1.0, corner < 2 ? -1.0 : 1.0, 0.0, 1.0);
    box.AddPoint(world.x / world.w, world.y / world.w, world.z / world.w);
  }
  box.GetBounds(bounds);
}

void vtkDSMScene::Internals::ShowWhole() const
{
  vtkNew<vtkMatrix4x4> projection;
  const rt::FrameRequest request =
    vtkDSMTranslation::ToRequest(this->Renderer, this->Display, projection);
  double bounds[6];
  std::copy_n(this->Bounds, 6, bounds);
  this->AddWholeView(request, bounds);
  this->Prop->SetBounds(bounds);
}

bool vtkDSMScene::Internals::IsInteractive() const
{
  vtkRenderWindow* window = this->Image ? nullptr : this->Renderer->GetRenderWindow();
  return window && (this->IsInteracting || window->GetDesiredUpdateRate() >= InteractiveRate);
}

/// Returns whether any picture of what the window shows may be filtered. A saved picture has the channels of those that
/// the window shows, so that their samples need not be traced again.
bool vtkDSMScene::Internals::MayFilterLight(const rt::Scene& scene) const
{
  const int choice = this->Light->GetDenoise();
  return rt::LightFilter::IsNoisy(scene) &&
    (choice == vtkDSMLightOptions::DenoiseAlways ||
      (choice == vtkDSMLightOptions::DenoiseIncomplete && !this->Image &&
        (this->SamplesPerFrame > 0 || this->IsInteractive() ||
          this->Eye->Accumulation.GetFrame().Channels.Has(rt::ChannelSet::Light))));
}

/// Returns whether the last frame, of that request, is to be filtered; the same on every rank.
bool vtkDSMScene::Internals::FiltersLight(const rt::FrameRequest& request) const
{
  return request.Channels.Has(rt::ChannelSet::Light) &&
    (this->Light->GetDenoise() == vtkDSMLightOptions::DenoiseAlways || this->IsInteractive() ||
      !this->Eye->Accumulation.IsComplete());
}

/// Collective. Returns the last whole frame, of that camera, with filtered light.
const rt::Frame& vtkDSMScene::Internals::FilterLight(const glm::dmat4& worldToClip)
{
  return this->Eye->Accumulation.FilterLight(
    { this->Group->GetMessenger(), this->Group->GetFrameRenderer(), this->Group->GetStore() },
    worldToClip);
}

bool vtkDSMScene::Internals::IsReduced() const
{
  return this->InteractiveReduction > 0 && this->IsInteractive();
}

/// Returns the edge of a picture that is not a draft. `request`: of edge 1.
int vtkDSMScene::Internals::GetMovingEdge(const rt::FrameRequest& request) const
{
  return this->IsReduced() ? rt::Resolution::GetMovingEdge(request,
                               this->Eye->Shown.SecondsPerPixel, this->InteractiveReduction)
                           : 1;
}

/// Returns whether a still picture may be coarse, because others are to follow.
bool vtkDSMScene::Internals::DrawsDrafts() const
{
  return this->ShowsDrafts && !this->Image && this->SamplesPerFrame > 0 && !this->IsInteractive();
}

rt::FrameAccumulation::Pace vtkDSMScene::Internals::GetPace() const
{
  if (this->Image)
  {
    return {};
  }
  return this->IsInteractive()
    ? rt::FrameAccumulation::Pace{ 1, false }
    : rt::FrameAccumulation::Pace{ this->SamplesPerFrame, this->SecondsPerFrame > 0.0 };
}

/// The application may have taken the prop away with its own. And what shows through a translucent surface, or beside
/// one that covers a pixel in part, must have been drawn before it.
void vtkDSMScene::Internals::KeepProp(const rt::Scene& scene)
{
  const bool showsOthers = !scene.IsOpaque() || this->Light->GetSamplesPerPixel() > 1;
  const bool mustBeLast =
    showsOthers && this->Renderer->GetViewProps()->GetLastProp() != this->Prop;
  if (mustBeLast || !this->Renderer->HasViewProp(this->Prop))
  {
    this->Renderer->RemoveViewProp(this->Prop);
    this->Renderer->AddViewProp(this->Prop);
  }
}

void vtkDSMScene::Internals::Clear()
{
  this->Prop->Clear();
  this->Statistics->Clear();
  for (Sight& eye : this->Eyes)
  {
    eye = {};
  }
}
