// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMRefinement_h
#define vtkPVDSMRefinement_h

#include "vtkPVDSMColorWatch.h"
#include "vtkPVDSMIsovalueWatch.h"

#include "vtkNew.h"
#include "vtkObject.h"
#include "vtkSmartPointer.h"
#include "vtkWeakPointer.h"

#include <chrono>
#include <set>
#include <vector>

class vtkPVDSMProgressGuard;
class vtkPVRenderView;
class vtkRenderWindowInteractor;
class vtkSMProxy;
class vtkSMRenderViewProxy;

/// Refines the images of a view while the application is idle: in the ParaView application, a render ends soon,
/// whatever is missing, and the ranks continue with its picture until it has all requested samples. A server does so
/// until the client sends it anything. Where the client itself traces, it handles events in between. Now and then
/// a render shows what has come. There is one on the client for each view with a traced dataset; its thread is
/// the application's. If no application handles events between renders (pvpython, pvbatch), or with several
/// clients, renders take all samples at once; but while the user moves the camera, as in a browser, each
/// takes one. A changed isovalue is shown at once. While a picture takes long, the view's proxy invokes ProgressEvent
/// with what vtkPVDSMFrameReport::GetRefinement returns.
class vtkPVDSMRefinement : public vtkObject
{
public:
  vtkTypeMacro(vtkPVDSMRefinement, vtkObject);

  /// Returns the view's object; creates one if there is none, and keeps it as long as it is referenced. Null
  /// if this process is not a client, or if the view has no proxy.
  static vtkSmartPointer<vtkPVDSMRefinement> Follow(vtkPVRenderView* view);

protected:
  vtkPVDSMRefinement();
  ~vtkPVDSMRefinement() override;

private:
  vtkPVDSMRefinement(const vtkPVDSMRefinement&) = delete;
  void operator=(const vtkPVDSMRefinement&) = delete;

  static vtkPVDSMRefinement* New();
  void Attach(vtkSMRenderViewProxy* view);
  void FollowInteractor();
  void LeaveInteractor();
  bool CanGoOn() const;

  void CompressPictures();
  void OnRenderBegins(vtkObject* caller, unsigned long event, void* interactive);
  void OnRenderEnds(vtkObject* caller, unsigned long event, void* interactive);
  void OnInteractionBegins();
  void OnInteractionEnds();
  void TellInteracting();
  void OnIsovalue();
  void OnTimer(vtkObject* caller, unsigned long event, void* timer);
  void TakeState();
  void PlanNext(double added);
  bool IsRemote() const;
  void Advance(double seconds);
  void GoOn();
  void Show();
  void WakeLater(double seconds);
  void Forget();

  vtkWeakPointer<vtkSMRenderViewProxy> View;
  vtkWeakPointer<vtkRenderWindowInteractor> Interactor;
  vtkNew<vtkPVDSMProgressGuard> ProgressGuard;
  vtkPVDSMColorWatch Colors;
  vtkPVDSMIsovalueWatch Isovalues{ [this] { this->OnIsovalue(); } };
  std::vector<unsigned long> ViewObservers;
  std::vector<unsigned long> InteractorObservers;
  std::set<unsigned int> Told;       ///< frame reports that know that this client goes on
  std::set<unsigned int> Compressed; ///< and that it can take compressed pictures
  bool IsInteracting = false;
  bool IsRefined = true;   ///< the last picture, as far as this client knows
  bool IsRefining = false; ///< in a render of its own
  using Clock = std::chrono::steady_clock;
  Clock::time_point RenderBegan; ///< the last one
  Clock::time_point Begun;       ///< when something else was to be shown
  Clock::time_point LastShow;    ///< of a picture on its way to its samples
  Clock::time_point NextShow;
  double Part = 0.0;     ///< of the samples, that the last picture had
  bool IsTold = false;   ///< the application, of a picture on its way
  bool HasBegun = false; ///< the last render, of another picture
  int Standstill = 0;    ///< renders of its own that did so, one after the other
  int Timer = 0;         ///< 0: none is set
};

#endif
