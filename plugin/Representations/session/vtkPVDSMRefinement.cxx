// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMRefinement.h"

#include "vtkPVDSMImageCompressor.h"
#include "vtkPVDSMProgressGuard.h"
#include "vtkPVDSMProxyFinder.h"
#include "vtkPVDSMVersionCheck.h"

#include "vtkClientServerStream.h"
#include "vtkCommand.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPVRenderView.h"
#include "vtkProcessModule.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkSMCollaborationManager.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSession.h"
#include "vtkSMTrace.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <string>

namespace
{

/// Seconds that the application has for its events before it goes on. While something else is going on, the next
/// look at it is later.
constexpr double ShortDelay = 0.01;
constexpr double LongDelay = 0.1;

/// Seconds for which a client that traces itself hears nothing of the user.
constexpr double LocalSeconds = 0.1;
/// Seconds from one picture to the next, and the part of the time since the first that they are at least: so pictures
/// cost little of a long frame, and few bytes. After the longest time a server begins to wait for its client. And how
/// many times as long as the render of a picture they are at least, since no render hears of the mouse.
constexpr double LeastSeconds = 0.1;
constexpr double MostSeconds = 2.0;
constexpr double WaitingPart = 0.5;
constexpr double RenderTimes = 2.0;
/// A server that was asked anything else is told again to go on after so many seconds.
constexpr double ReminderSeconds = 0.25;
/// Seconds for which a server traces without its client.
constexpr double AdvanceSeconds = 10.0;

/// The status bar shows the progress of pictures that take longer.
constexpr std::chrono::seconds LongTime(1);

/// Renders of its own that begin another picture, one after the other: then something other than the user draws the
/// view with changing cameras, which would never end.
constexpr int LongestStandstill = 20;

std::map<vtkPVRenderView*, vtkWeakPointer<vtkPVDSMRefinement>>& GetRegistry()
{
  static std::map<vtkPVRenderView*, vtkWeakPointer<vtkPVDSMRefinement>> registry;
  return registry;
}

vtkSMRenderViewProxy* FindProxy(vtkPVRenderView* view)
{
  const auto type = vtkProcessModule::GetProcessType();
  return type == vtkProcessModule::PROCESS_CLIENT || type == vtkProcessModule::PROCESS_BATCH
    ? vtkSMRenderViewProxy::SafeDownCast(vtkPVDSMProxyFinder::Find(view))
    : nullptr;
}

/// Returns whether the dataset is traced.
bool IsTraced(vtkSMProxy* representation)
{
  const auto helper = [=](const char* name)
  { return vtkSMPropertyHelper(representation, name, /*quiet=*/true); };
  if (!representation || helper("Visibility").GetAsInt() == 0)
  {
    return false;
  }
  // Not every representation has a choice of what it shows (scalar bars have none).
  const char* shown = helper("Representation").GetAsString();
  // The names of all of our kinds begin so.
  return shown && std::string(shown).rfind("DSM ", 0) == 0;
}

/// Calls `visit` with each dataset that is traced.
template <class Visit>
void ForEachTraced(vtkSMProxy* view, const Visit& visit)
{
  const vtkSMPropertyHelper representations(view, "Representations", /*quiet=*/true);
  for (unsigned int index = 0; index < representations.GetNumberOfElements(); ++index)
  {
    if (IsTraced(representations.GetAsProxy(index)))
    {
      visit(representations.GetAsProxy(index));
    }
  }
}

/// Only subclasses of a proxy may ask for its parts. None of these is ever made.
struct AskedProxy : vtkSMProxy
{
  static vtkSMProxy* GetPart(vtkSMProxy* proxy, const char* name)
  {
    vtkSMProxy* (vtkSMProxy::*const get)(const char*) = &AskedProxy::GetSubProxy;
    return (proxy->*get)(name);
  }
};

/// The proxy of the way in which a traced dataset is shown.
vtkSMProxy* FindShown(vtkSMProxy* representation)
{
  const std::string shown = vtkSMPropertyHelper(representation, "Representation").GetAsString();
  const char* const name = shown == "DSM Volume" ? "DSMVolumeRepresentation"
    : shown == "DSM Slices"                      ? "DSMSliceRepresentation"
                                                 : nullptr;
  vtkSMProxy* const own = name ? AskedProxy::GetPart(representation, name) : nullptr;
  return own ? own : representation;
}

/// Calls `visit` with the frame report of each traced dataset.
template <class Visit>
void ForEachReport(vtkSMProxy* view, const Visit& visit)
{
  ForEachTraced(view,
    [&](vtkSMProxy* representation)
    {
      if (vtkSMProperty* samples = FindShown(representation)->GetProperty("DSMSamples"))
      {
        visit(samples->GetParent());
      }
    });
}

/// The frame report of a dataset that is traced; null if there is none.
vtkSMProxy* FindReport(vtkSMProxy* view)
{
  vtkSMProxy* first = nullptr;
  ForEachReport(view, [&](vtkSMProxy* report) { first = first ? first : report; });
  return first;
}

/// Calls a method of a frame report where the view is traced. A client does not wait for its server.
template <class Value>
void Tell(vtkSMProxy* report, const char* method, Value value)
{
  report->UpdateVTKObjects();
  vtkClientServerStream stream;
  stream << vtkClientServerStream::Invoke << VTKOBJECT(report) << method << value
         << vtkClientServerStream::End;
  report->GetSession()->ExecuteStream(report->GetLocation(), stream);
}

} // namespace

vtkStandardNewMacro(vtkPVDSMRefinement);

vtkPVDSMRefinement::vtkPVDSMRefinement() = default;

vtkPVDSMRefinement::~vtkPVDSMRefinement()
{
  this->Forget();
  for (const unsigned long tag : this->ViewObservers)
  {
    if (this->View)
    {
      this->View->RemoveObserver(tag);
    }
  }
  this->LeaveInteractor();
  auto& registry = GetRegistry();
  for (auto entry = registry.begin(); entry != registry.end();)
  {
    // A weak pointer to what is being destroyed may be null already.
    entry = !entry->second || entry->second == this ? registry.erase(entry) : std::next(entry);
  }
}

vtkSmartPointer<vtkPVDSMRefinement> vtkPVDSMRefinement::Follow(vtkPVRenderView* view)
{
  vtkSMRenderViewProxy* proxy = FindProxy(view);
  if (!proxy)
  {
    return nullptr;
  }
  auto& known = GetRegistry()[view];
  // The address of a view that is gone may be another's now.
  if (known && known->View == proxy)
  {
    return known.Get();
  }
  vtkSmartPointer<vtkPVDSMRefinement> refinement;
  refinement.TakeReference(vtkPVDSMRefinement::New());
  refinement->Attach(proxy);
  known = refinement;
  return refinement;
}

void vtkPVDSMRefinement::Attach(vtkSMRenderViewProxy* view)
{
  this->View = view;
  vtkPVDSMVersionCheck::Run(view->GetSession());
  this->ProgressGuard->Watch(view->GetSession()->GetProgressHandler(), view->GetRenderWindow());
  this->ViewObservers = { view->AddObserver(
                            vtkCommand::StartEvent, this, &vtkPVDSMRefinement::OnRenderBegins),
    view->AddObserver(vtkCommand::EndEvent, this, &vtkPVDSMRefinement::OnRenderEnds) };
}

/// The application gives the view its interactor after it was made.
void vtkPVDSMRefinement::FollowInteractor()
{
  vtkRenderWindowInteractor* interactor = this->View->GetInteractor();
  if (interactor == this->Interactor)
  {
    return;
  }
  this->LeaveInteractor();
  this->Interactor = interactor;
  if (interactor)
  {
    this->InteractorObservers = { interactor->AddObserver(vtkCommand::StartInteractionEvent, this,
                                    &vtkPVDSMRefinement::OnInteractionBegins),
      // Before the view renders.
      interactor->AddObserver(
        vtkCommand::EndInteractionEvent, this, &vtkPVDSMRefinement::OnInteractionEnds, 1.0f),
      interactor->AddObserver(vtkCommand::TimerEvent, this, &vtkPVDSMRefinement::OnTimer) };
  }
}

void vtkPVDSMRefinement::LeaveInteractor()
{
  for (const unsigned long tag : this->InteractorObservers)
  {
    if (this->Interactor)
    {
      this->Interactor->RemoveObserver(tag);
    }
  }
  this->InteractorObservers.clear();
}

/// Returns whether the application handles events, so that timers expire.
bool vtkPVDSMRefinement::CanGoOn() const
{
  return this->Interactor && this->Interactor->IsA("QVTKInteractor") &&
    !this->View->GetSession()->IsMultiClients();
}

void vtkPVDSMRefinement::OnRenderBegins(vtkObject*, unsigned long, void*)
{
  this->Forget();
  this->RenderBegan = Clock::now();
  this->FollowInteractor();
  this->CompressPictures();
  if (!this->CanGoOn())
  {
    return;
  }
  if (!this->IsRefining)
  {
    this->Begun = this->RenderBegan; // most probably, this render follows what the user did
    this->Part = 0.0;
  }
  ForEachReport(this->View,
    [this](vtkSMProxy* report)
    {
      if (this->Told.insert(report->GetGlobalID()).second)
      {
        Tell(report, "SetProgressive", 1);
      }
    });
}

/// Asks the server for pictures in fewer bytes, if this client can decompress them.
void vtkPVDSMRefinement::CompressPictures()
{
  if (!this->IsRemote() || this->View->GetSession()->IsMultiClients() ||
    !vtkPVDSMImageCompressor::IsAvailable())
  {
    return;
  }
  ForEachReport(this->View,
    [this](vtkSMProxy* report)
    {
      if (this->Compressed.insert(report->GetGlobalID()).second)
      {
        vtkPVDSMImageCompressor::Use(
          vtkPVRenderView::SafeDownCast(this->View->GetClientSideObject()));
        Tell(report, "CompressPictures", 1);
      }
    });
}

void vtkPVDSMRefinement::OnRenderEnds(vtkObject*, unsigned long, void* interactive)
{
  this->IsRefined = true;
  const bool goesOn = this->CanGoOn();
  vtkSMSession* const session = this->View->GetSession();
  const bool isStill = *static_cast<int*>(interactive) == 0;
  // Further pictures are of the same data: a server is not asked again.
  const bool isSame = this->IsRefining && this->LastShow >= this->Begun;
  // With several clients, the master decides what the others show.
  if (isStill && !isSame &&
    (!session->IsMultiClients() || session->GetCollaborationManager()->IsMaster()))
  {
    ForEachTraced(this->View,
      [&](vtkSMProxy* representation)
      {
        this->Colors.Note(representation);
        this->Isovalues.TakeSuggestion(representation);
        this->Isovalues.Watch(representation, goesOn);
      });
  }
  if (!isStill || !goesOn)
  {
    return;
  }
  const double before = this->Part;
  this->TakeState();
  this->Standstill = this->IsRefining && this->HasBegun ? this->Standstill + 1 : 0;
  this->IsRefined = this->IsRefined || this->Standstill > LongestStandstill;
  if (!this->IsRefined && !this->IsInteracting)
  {
    this->PlanNext(this->Part - before);
    this->GoOn();
  }
}

/// Asks how far the picture is.
void vtkPVDSMRefinement::TakeState()
{
  double state[4] = { 0.0, 0.0, 1.0, 0.0 };
  if (vtkSMProxy* const report = FindReport(this->View))
  {
    report->UpdatePropertyInformation(report->GetProperty("DSMRefinement"));
    vtkSMPropertyHelper(report, "DSMRefinement").Get(state, 4);
  }
  this->Part = state[2];
  this->IsRefined = this->Part >= 1.0;
  this->HasBegun = state[3] != 0.0;
  // A picture that is there soon would only flicker in the status bar.
  const bool isLong = Clock::now() - this->Begun > LongTime;
  if (!this->IsRefined ? isLong : this->IsTold)
  {
    this->IsTold = !this->IsRefined;
    this->View->InvokeEvent(vtkCommand::ProgressEvent, state);
  }
}

/// Chooses when the next picture is shown. `added`: part of the samples that the last one added.
void vtkPVDSMRefinement::PlanNext(double added)
{
  const Clock::time_point now = Clock::now();
  const auto toSeconds = [](Clock::duration time)
  { return std::chrono::duration<double>(time).count(); };
  double seconds = std::clamp(std::max(WaitingPart * toSeconds(now - this->Begun),
                                RenderTimes * toSeconds(now - this->RenderBegan)),
    LeastSeconds, MostSeconds);
  if (this->LastShow < this->Begun)
  {
    seconds = 0.0; // what is quick is whole in the next render
  }
  else if (added > 0.0)
  {
    // When it will have all.
    seconds = std::min(seconds, toSeconds(now - this->LastShow) * (1.0 - this->Part) / added);
  }
  this->LastShow = now;
  this->NextShow =
    now + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

/// A server traces from now on; a client that traces itself does so when the application has handled its events.
void vtkPVDSMRefinement::GoOn()
{
  const double left = std::chrono::duration<double>(this->NextShow - Clock::now()).count();
  if (this->IsRemote() && left > 0.0)
  {
    this->Advance(AdvanceSeconds);
    this->WakeLater(std::clamp(left, ShortDelay, ReminderSeconds));
  }
  else
  {
    this->WakeLater(ShortDelay);
  }
}

bool vtkPVDSMRefinement::IsRemote() const
{
  return this->View->GetSession()->IsA("vtkSMSessionClient");
}

void vtkPVDSMRefinement::Advance(double seconds)
{
  if (vtkSMProxy* const report = FindReport(this->View))
  {
    Tell(report, "Advance", seconds);
  }
}

void vtkPVDSMRefinement::OnInteractionBegins()
{
  this->IsInteracting = true;
  this->Forget();
  this->TellInteracting();
}

void vtkPVDSMRefinement::OnInteractionEnds()
{
  this->IsInteracting = false;
  this->TellInteracting();
  // After a movement ParaView renders, when its delay is over.
  if (!this->IsRefined)
  {
    this->WakeLater(ShortDelay);
  }
}

/// Web applications take still pictures while the user moves the camera.
void vtkPVDSMRefinement::TellInteracting()
{
  if (this->View && !this->View->GetSession()->IsMultiClients())
  {
    ForEachReport(this->View,
      [this](vtkSMProxy* report) { Tell(report, "SetInteracting", this->IsInteracting ? 1 : 0); });
  }
}

/// The panel's slider sends this event many times while it is dragged; a pending render already
/// shows the last value. A timer that only continues with the picture before gives way.
void vtkPVDSMRefinement::OnIsovalue()
{
  const Clock::time_point now = Clock::now();
  if (this->View && (this->Timer == 0 || now < this->NextShow))
  {
    this->Begun = this->NextShow = now;
    this->Part = 0.0;
    this->WakeLater(ShortDelay);
  }
}

void vtkPVDSMRefinement::OnTimer(vtkObject*, unsigned long, void* timer)
{
  if (this->Timer == 0 || *static_cast<int*>(timer) != this->Timer || !this->View)
  {
    return;
  }
  this->Timer = 0; // the interactor destroys it
  if (this->View->GetSession()->GetPendingProgress())
  {
    this->WakeLater(LongDelay);
    return;
  }
  const auto isEarly = [this] { return !this->IsRefined && Clock::now() < this->NextShow; };
  if (isEarly() && !this->IsRemote())
  {
    const double shown = this->Part;
    this->Advance(LocalSeconds);
    this->TakeState();
    this->Part = shown;
  }
  if (isEarly())
  {
    this->GoOn();
    return;
  }
  this->Show();
}

void vtkPVDSMRefinement::Show()
{
  // A trace of what the user does has no place for these renders.
  vtkSMTrace* trace = vtkSMTrace::GetActiveTracer();
  const bool tracesCameras = trace && trace->GetFullyTraceCameraAdjustments();
  if (tracesCameras)
  {
    trace->SetFullyTraceCameraAdjustments(false);
  }
  this->IsRefining = true;
  this->View->StillRender();
  this->IsRefining = false;
  if (tracesCameras && trace == vtkSMTrace::GetActiveTracer())
  {
    trace->SetFullyTraceCameraAdjustments(true);
  }
}

void vtkPVDSMRefinement::WakeLater(double seconds)
{
  this->Forget();
  if (this->Interactor)
  {
    this->Timer =
      this->Interactor->CreateOneShotTimer(static_cast<unsigned long>(1000.0 * seconds));
  }
}

void vtkPVDSMRefinement::Forget()
{
  if (this->Timer != 0 && this->Interactor)
  {
    this->Interactor->DestroyTimer(this->Timer);
  }
  this->Timer = 0;
}
