// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMRefinement.h"

#include "vtkPVDSMDelivery.h"
#include "vtkPVDSMProgressGuard.h"
#include "vtkPVDSMProxyFinder.h"
#include "vtkPVDSMVersionCheck.h"

#include "vtkClientServerStream.h"
#include "vtkCommand.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPVRenderView.h"
#include "vtkProcessModule.h"
#include "vtkRenderWindow.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkSMCollaborationManager.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSession.h"
#include "vtkSMTrace.h"

#include <iterator>
#include <map>
#include <string>

namespace
{

/// Milliseconds that the application has for its events before the next render begins. While
/// something else is going on, the next look at it is later.
constexpr unsigned long ShortDelay = 10;
constexpr unsigned long LongDelay = 100;

/// Renders that add no sample, one after the other: then something other than the user draws the view
/// with changing cameras, which would never end.
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

/// Calls a method of a frame report where the view is traced.
void Tell(vtkSMProxy* report, const char* method, int value)
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
  this->Window = this->View->GetRenderWindow();
  if (interactor)
  {
    this->InteractorObservers = { interactor->AddObserver(vtkCommand::StartInteractionEvent, this,
                                    &vtkPVDSMRefinement::OnInteractionBegins),
      // Before the view renders.
      interactor->AddObserver(
        vtkCommand::EndInteractionEvent, this, &vtkPVDSMRefinement::OnInteractionEnds, 1.0f),
      interactor->AddObserver(vtkCommand::TimerEvent, this, &vtkPVDSMRefinement::OnTimer) };
  }
  if (this->Window)
  {
    this->WindowObserver = this->Window->AddObserver(
      vtkCommand::AbortCheckEvent, this, &vtkPVDSMRefinement::OnAbortCheck);
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
  if (this->Window)
  {
    this->Window->RemoveObserver(this->WindowObserver);
  }
}

/// Returns whether the application handles events, so that timers expire.
bool vtkPVDSMRefinement::CanGoOn() const
{
  return this->Interactor && this->Interactor->IsA("QVTKInteractor") &&
    !this->View->GetSession()->IsMultiClients();
}

void vtkPVDSMRefinement::OnRenderBegins(vtkObject*, unsigned long, void* interactive)
{
  this->Forget();
  this->FollowInteractor();
  if (!this->CanGoOn())
  {
    return;
  }
  this->CanAbort = *static_cast<int*>(interactive) == 0 &&
    !vtkPVDSMDelivery::IsCapturing(
      vtkPVRenderView::SafeDownCast(this->View->GetClientSideObject()));
  this->IsAborted = false;
  if (!this->IsRefining)
  {
    this->Input.Begin(); // most probably, this render follows what the user did
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

void vtkPVDSMRefinement::OnRenderEnds(vtkObject*, unsigned long, void* interactive)
{
  this->CanAbort = false;
  this->IsRefined = true;
  const bool goesOn = this->CanGoOn();
  vtkSMSession* const session = this->View->GetSession();
  const bool isStill = *static_cast<int*>(interactive) == 0;
  // More samples of a picture are of the same data: a server is not asked again.
  const bool isSame = this->IsRefining && this->Samples > 0;
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
  const int before = this->Samples;
  int samples[2] = { 0, 0 };
  ForEachReport(this->View,
    [&](vtkSMProxy* report)
    {
      if (samples[1] == 0)
      {
        report->UpdatePropertyInformation(report->GetProperty("DSMSamples"));
        vtkSMPropertyHelper(report, "DSMSamples").Get(samples, 2);
      }
    });
  this->Samples = samples[0];
  const bool stoodStill = this->IsRefining && !this->IsAborted && this->Samples <= before;
  this->Standstill = stoodStill ? this->Standstill + 1 : 0;
  // A picture that was ended after the tracing lacks what is drawn last, such as the orientation axes.
  this->IsRefined =
    !this->IsAborted && (samples[0] >= samples[1] || this->Standstill > LongestStandstill);
  if (!this->IsRefined && !this->IsInteracting)
  {
    this->RenderLater(ShortDelay);
  }
}

void vtkPVDSMRefinement::OnAbortCheck(vtkObject*, unsigned long, void*)
{
  if (this->CanAbort && this->Input.HasPressed())
  {
    this->IsAborted = true;
    this->Window->SetAbortRender(1);
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
    this->RenderLater(ShortDelay);
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
/// shows the last value.
void vtkPVDSMRefinement::OnIsovalue()
{
  if (this->Timer == 0 && this->View)
  {
    this->RenderLater(ShortDelay);
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
    this->RenderLater(LongDelay);
    return;
  }
  // Events that the application has not received yet come first.
  if (this->Input.HasPressed())
  {
    this->Input.Begin();
    this->RenderLater(ShortDelay);
    return;
  }
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

void vtkPVDSMRefinement::RenderLater(unsigned long milliseconds)
{
  this->Forget();
  if (this->Interactor)
  {
    this->Timer = this->Interactor->CreateOneShotTimer(milliseconds);
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
