// SPDX-License-Identifier: BSD-3-Clause
// Which pictures are traced for a frame, and when they end.
#include "vtkDSMSceneInternals.h"

#include "DSMRayTracing/frame/Stopgap.h"
#include "vtkDSMProgress.h"

#include "vtkBoundingBox.h"
#include "vtkRenderWindow.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

namespace
{

using Clock = std::chrono::steady_clock;

/// Times after which a long frame reports its progress, first and then again.
constexpr std::chrono::milliseconds FirstTold(1500);
constexpr std::chrono::milliseconds ThenTold(500);

constexpr double Unlimited = std::numeric_limits<double>::infinity();

/// A frame that ended without a tile takes so many times as long as was thought, or more.
constexpr double Surprise = 4.0;

class Raised
{
public:
  explicit Raised(bool& flag)
    : Flag(flag)
  {
    this->Flag = true;
  }
  ~Raised() { this->Flag = false; }
  Raised(const Raised&) = delete;
  Raised& operator=(const Raised&) = delete;

private:
  bool& Flag;
};

} // namespace

/// Returns whether a frame may end before its picture is whole. Nothing can take the place of a first picture, nor of a
/// step of an animation.
bool vtkDSMScene::Internals::IsLimited(const Task& task) const
{
  return !this->Image && this->SecondsPerFrame > 0.0 && task.Shown.MayDraft &&
    (this->SamplesPerFrame > 0 || this->IsInteractive()) &&
    this->Eye->Accumulation.GetFrame().Number > 0;
}

/// Returns whether the picture was traced between frames, and will be after this one, too: it is shown as it is.
bool vtkDSMScene::Internals::IsUnderWay(const Task& task) const
{
  return this->Eye->HasAdvanced && this->IsLimited(task) && this->DrawsDrafts() &&
    !this->Eye->Accumulation.IsComplete();
}

/// Returns whether a finer picture is to replace that one.
bool vtkDSMScene::Internals::IsDraft(const Try& picture) const
{
  return this->DrawsDrafts() && picture.Picture.Edge > 1;
}

/// Pictures to try, up to the first that is not abandoned.
std::vector<vtkDSMScene::Internals::Try> vtkDSMScene::Internals::GetTries(const Task& task) const
{
  std::vector<Try> tries;
  if (this->DrawsDrafts())
  {
    for (const rt::Resolution::Try& picture :
      rt::Resolution::GetTries(task.Shown, task.Content, task.Whole))
    {
      const vtkDSMMemoryOptions* const options = this->Group->GetOptions();
      const bool isCoarser =
        picture.Edge > 1 && options->GetLevelOfDetail() == vtkDSMMemoryOptions::AutomaticLevel;
      tries.push_back({ isCoarser
          ? this->Members.FindDraftLevel(task.Whole, options->GetPixelsPerSample() * picture.Edge)
          : 0,
        picture });
    }
  }
  else
  {
    for (const int level : this->Detail.GetTries(task.Coarser))
    {
      if (tries.empty() || level > this->Members.GetFinestChosen())
      {
        tries.push_back({ level, { this->GetMovingEdge(task.Whole), Unlimited } });
      }
    }
  }
  if (this->IsLimited(task) && !this->GoesOn)
  {
    tries.back().Picture.Seconds = this->SecondsPerFrame;
  }
  return tries;
}

/// Collective: the scene's objects come in again where they are shown at another level of detail. `offers`: of the
/// first try, if it is of the finest data, and no draft.
rt::FrameAccumulation::Result vtkDSMScene::Internals::TraceScene(Task task, Offers offers)
{
  using Result = rt::FrameAccumulation::Result;
  const Raised tracing(TracingTiles);
  this->Group->GetMessenger().Insist(
    [&]
    {
      task.Whole = task.Request;
      task.Content = rt::Resolution::GetContent(task.Scene, task.Whole);
      task.MediumErrors = task.Scene.Transport.MediumErrors;
    });
  const bool isKnown = task.Content == task.Shown.Content || task.Content == task.Shown.Begun;
  if (this->GoesOn && !isKnown)
  {
    return Result::Nothing; // something else is to be drawn first
  }
  this->Eye->HasBegun = !this->GoesOn && !isKnown;
  this->Eye->HasAdvanced = static_cast<bool>(this->GoesOn) || (this->Eye->HasAdvanced && isKnown);
  if (!this->GoesOn && this->IsUnderWay(task))
  {
    const std::int64_t edge =
      this->Eye->Accumulation.GetBegun().Number > 0 ? task.Shown.BegunEdge : task.Shown.Edge;
    this->Group->GetMessenger().Insist(
      [&] { task.Request = rt::Resolution::Reduce(task.Whole, static_cast<int>(edge)); });
    return Result::Aborted;
  }
  Result result = Result::Nothing;
  do
  {
    result = this->TracePicture(task, offers);
    offers.clear();
    task.Shown = this->Eye->Shown;
  } while (this->GoesOn && result == Result::Traced && !this->Eye->Accumulation.IsComplete());
  this->Group->GetFrameRenderer().SetWatch({});
  return result;
}

/// Collective: the first of the pictures to try that is not abandoned.
rt::FrameAccumulation::Result vtkDSMScene::Internals::TracePicture(Task& task, Offers& offers)
{
  using Result = rt::FrameAccumulation::Result;
  dsm::Messenger& messenger = this->Group->GetMessenger();
  dsm::BlockStore& store = this->Group->GetStore();
  vtkRenderWindow* window = this->Image ? nullptr : this->Renderer->GetRenderWindow();
  const int wanted = this->Light->GetSamplesPerPixel();
  const rt::FrameAccumulation::Pace pace = this->GetPace();
  const bool draws = !this->Image && !this->GoesOn &&
    !task.Whole.Channels.Has(rt::ChannelSet::Light); // else it may be filtered first
  const auto report = [&](const rt::Frame& frame)
  {
    task.Picture = draws && !frame.IsAborted ? this->Delivery.Assemble(frame) : rt::Picture();
    return vtkDSMStatistics::CreateReport(store, frame, messenger.GetRank(), messenger.GetSize());
  };
  auto told = Clock::now() + FirstTold;
  std::vector<Try> tries;
  messenger.Insist([&] { tries = this->GetTries(task); });
  Result result = Result::Aborted;
  for (auto next = tries.begin(); next != tries.end() && result == Result::Aborted; ++next)
  {
    const int edge = next->Picture.Edge;
    const bool isDraft = this->IsDraft(*next);
    if (next == tries.begin() || edge != (next - 1)->Picture.Edge)
    {
      messenger.Insist([&] { task.Request = rt::Resolution::Reduce(task.Whole, edge); });
      task.Limit(task.Request);
    }
    if (next->Coarser > 0 || task.CoarserInScene > 0 || isDraft || offers.empty())
    {
      offers = messenger.GatherValueTogether("Preparing the frame",
        [&]
        {
          if (next->Coarser != task.CoarserInScene)
          {
            this->Members.AddTo(task.Scene, next->Coarser);
            task.CoarserInScene = next->Coarser;
          }
          task.Scene.Transport.MediumErrors =
            isDraft ? rt::Resolution::MediumErrors : task.MediumErrors;
          return this->Eye->Accumulation.CreateOffer(store, task.Scene, task.Request, wanted, pace);
        });
    }
    this->Detail.Begin();
    const auto start = Clock::now();
    const bool mayWaitTooLong = next + 1 != tries.end() && !this->DrawsDrafts();
    const auto watch =
      [this, window, mayWaitTooLong, &told, start, seconds = next->Picture.Seconds](double part)
    {
      if (this->GoesOn)
      {
        return !this->GoesOn();
      }
      const auto now = Clock::now();
      if (now > told)
      {
        this->TellOfTracing(part);
        told = now + ThenTold;
      }
      return (window && window->CheckAbortStatus() != 0) ||
        std::chrono::duration<double>(now - start).count() > seconds ||
        (mayWaitTooLong && this->Detail.IsTooLong(this->Group->GetStore()));
    };
    messenger.Insist([&] { this->Group->GetFrameRenderer().SetWatch(watch); });
    task.Request.KeepsHits = !isDraft && !this->IsInteractive();
    result = this->Eye->Accumulation.Trace({ messenger, this->Group->GetFrameRenderer(), store },
      offers, task.Scene, task.Request, wanted, pace, report);
    if (result == Result::Traced)
    {
      this->NoteTraced(task, *next);
    }
    if (result != Result::Aborted)
    {
      const double seconds =
        this->Eye->Accumulation.GetSecondsPerPixel(this->Statistics->GetFrameSeconds());
      this->Eye->Shown = { task.Content, edge,
        seconds > 0.0 ? seconds : this->Eye->Shown.SecondsPerPixel };
    }
    else if (next + 1 == tries.end())
    {
      this->NoteAborted(task, *next);
    }
    if (isDraft && result != Result::Aborted)
    {
      this->Eye->Accumulation.Postpone();
    }
  }
  return result;
}

/// The coarsest level of detail that a picture shows, below the finest.
int vtkDSMScene::Internals::GetLevel(const Try& picture) const
{
  return std::max(picture.Coarser, this->Members.GetCoarsestChosen());
}

/// All tiles of a picture were traced.
void vtkDSMScene::Internals::NoteTraced(const Task& task, const Try& done)
{
  this->Group->GetMessenger().Insist(
    [&]
    {
      this->Statistics->Take(this->Eye->Accumulation.GetFrame(),
        this->IsDraft(done) ? 0 : this->Eye->Accumulation.GetSamples(),
        this->Eye->Accumulation.GetWanted(), this->GetLevel(done));
    });
  if (!this->DrawsDrafts() && (done.Coarser > 0 || task.Coarser > 0))
  {
    this->Detail.Note(
      done.Coarser, this->Statistics->GetNumberOfMisses(), this->Statistics->GetFrameSeconds());
  }
  this->Eye->LastWorldToClip = task.Request.WorldToClip;
}

/// A picture lacks tiles or samples. Between frames, the statistics show how far it is.
void vtkDSMScene::Internals::NoteAborted(const Task& task, const Try& begun)
{
  const bool hasBegun = this->Eye->Accumulation.GetBegun().Number > 0;
  const rt::Frame& frame =
    hasBegun ? this->Eye->Accumulation.GetBegun() : this->Eye->Accumulation.GetFrame();
  if (this->GoesOn)
  {
    this->Group->GetMessenger().Insist(
      [&]
      {
        this->Statistics->Take(frame, this->Eye->Accumulation.GetSamples(),
          this->Eye->Accumulation.GetWanted(), this->GetLevel(begun));
      });
  }
  if (!hasBegun)
  {
    return;
  }
  this->Eye->Shown.Begun = task.Content;
  this->Eye->Shown.BegunEdge = begun.Picture.Edge;
  if (this->IsInteractive() && begun.Picture.Seconds < Unlimited)
  {
    // The next moving picture has to be coarser. All ranks find the same.
    double& seconds = this->Eye->Shown.SecondsPerPixel;
    const double pixels = this->Eye->Accumulation.CountBegunPixels();
    const double whole = static_cast<double>(task.Request.Width) * task.Request.Height;
    seconds = pixels > 0.0 ? begun.Picture.Seconds / pixels
                           : std::max(Surprise * seconds, begun.Picture.Seconds / whole);
  }
}

/// Collective. Returns what a frame shows that was aborted: its tiles, and the last picture where there are none.
rt::Picture vtkDSMScene::Internals::FillGaps(const rt::FrameRequest& request, bool hasEdges)
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  const auto get = [&](const rt::Frame& frame)
  { return this->Delivery.Gather(messenger, frame, this->Delivery.Assemble(frame), hasEdges); };
  const auto isForFilter = [](const rt::Frame& frame)
  { return frame.Channels.Has(rt::ChannelSet::Light); };
  const rt::Frame& begun = this->Eye->Accumulation.GetBegun();
  const rt::Frame& last = this->Eye->Accumulation.GetFrame();
  rt::Picture picture =
    get(isForFilter(last) ? this->FilterLight(this->Eye->LastWorldToClip) : last);
  if (begun.Number > 0)
  {
    double middle[3];
    vtkBoundingBox(this->Bounds).GetCenter(middle);
    picture = rt::Stopgap::Move(
      picture, this->Eye->LastWorldToClip, request, { middle[0], middle[1], middle[2] });
    rt::Stopgap::Cover(begun,
      get(isForFilter(begun) ? this->Group->GetFrameRenderer().FilterLight(
                                 this->Group->GetStore(), request.WorldToClip, begun)
                             : begun),
      picture);
  }
  return picture;
}

void vtkDSMScene::Internals::TellOfTracing(double part) const
{
  if (vtkAlgorithm* const mapper = this->Members.GetShown().front().State->GetAlgorithm())
  {
    vtkDSMProgress::TellOfTracing(mapper, part);
  }
}
