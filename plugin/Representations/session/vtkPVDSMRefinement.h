// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMRefinement_h
#define vtkPVDSMRefinement_h

#include "vtkPVDSMColorWatch.h"
#include "vtkPVDSMInputWatch.h"
#include "vtkPVDSMIsovalueWatch.h"

#include "vtkNew.h"
#include "vtkObject.h"
#include "vtkSmartPointer.h"
#include "vtkWeakPointer.h"

#include <set>
#include <vector>

class vtkPVDSMProgressGuard;
class vtkPVRenderView;
class vtkRenderWindow;
class vtkRenderWindowInteractor;
class vtkSMProxy;
class vtkSMRenderViewProxy;

/// Refines the images of a view while the application is idle: in the ParaView application, a still render
/// takes few samples of each pixel, and each idle period adds the next samples, until all requested samples
/// are there. There is one on the client for each view with a traced dataset; its thread is the
/// application's. If no application handles events between renders (pvpython, pvbatch), or with several
/// clients, renders take all samples at once; but while the user moves the camera, as in a browser, each
/// takes one. A changed isovalue is shown at once. If the client itself traces, a render ends early when the
/// user presses anything.
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

  void OnRenderBegins(vtkObject* caller, unsigned long event, void* interactive);
  void OnRenderEnds(vtkObject* caller, unsigned long event, void* interactive);
  void OnAbortCheck(vtkObject* caller, unsigned long event, void* data);
  void OnInteractionBegins();
  void OnInteractionEnds();
  void TellInteracting();
  void OnIsovalue();
  void OnTimer(vtkObject* caller, unsigned long event, void* timer);
  void RenderLater(unsigned long milliseconds);
  void Forget();

  vtkWeakPointer<vtkSMRenderViewProxy> View;
  vtkWeakPointer<vtkRenderWindowInteractor> Interactor;
  vtkWeakPointer<vtkRenderWindow> Window;
  vtkNew<vtkPVDSMProgressGuard> ProgressGuard;
  vtkPVDSMInputWatch Input;
  vtkPVDSMColorWatch Colors;
  vtkPVDSMIsovalueWatch Isovalues{ [this] { this->OnIsovalue(); } };
  std::vector<unsigned long> ViewObservers;
  std::vector<unsigned long> InteractorObservers;
  unsigned long WindowObserver = 0;
  std::set<unsigned int> Told; ///< frame reports that know that this client goes on
  bool IsInteracting = false;
  bool IsRefined = true;   ///< the last picture, as far as this client knows
  bool IsRefining = false; ///< in a render of its own
  bool CanAbort = false;   ///< in a still render, which is to be looked at
  bool IsAborted = false;  ///< by the user, the last render
  int Samples = 0;         ///< samples of the last image
  int Standstill = 0;      ///< renders of its own that added nothing
  int Timer = 0;           ///< 0: none is set
};

#endif
