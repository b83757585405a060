// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMTracedDisplay_h
#define vtkPVDSMTracedDisplay_h

#include "vtkPVDSMClipping.h"
#include "vtkPVDSMExportProp.h"
#include "vtkPVDSMSelectionActor.h"
#include "vtkPVDSMSelectionMapper.h"

#include "vtkBoundingBox.h"
#include "vtkNew.h"
#include "vtkPVRenderView.h"
#include "vtkSmartPointer.h"
#include "vtkWeakPointer.h"

#include <functional>

class vtkAbstractMapper;
class vtkActor;
class vtkDSMScene;
class vtkDataObject;
class vtkInformation;
class vtkInformationRequestKey;
class vtkMapper;
class vtkObject;
class vtkPVDSMFrameReport;
class vtkPVDSMRefinement;
class vtkPVDataRepresentation;
class vtkPartitionedDataSet;
class vtkPolyData;
class vtkProp3D;
class vtkRenderer;
class vtkScalarsToColors;
class vtkView;

/// Common part of the plugin's representations. It adds the traced prop, with its scene where the
/// process renders, to a view when the prop first becomes visible there; it keeps the data on their
/// rank; it clips them, makes them selectable, and reports the view's frames.
class vtkPVDSMTracedDisplay
{
public:
  /// A part of `representation`, which gives `prop` with `mapper` its data and look. `work` is what the
  /// user reads while the mapper takes in data.
  vtkPVDSMTracedDisplay(vtkPVDataRepresentation* representation, vtkProp3D* prop,
    vtkAbstractMapper* mapper, const char* work);
  ~vtkPVDSMTracedDisplay();
  vtkPVDSMTracedDisplay(const vtkPVDSMTracedDisplay&) = delete;
  vtkPVDSMTracedDisplay& operator=(const vtkPVDSMTracedDisplay&) = delete;

  /// Shows another prop with another mapper from now on; the last one's bricks are given up.
  void Show(vtkProp3D* prop, vtkAbstractMapper* mapper, const char* work);
  /// Shows a second prop together with the one, until Show is called again. Both have the same transform.
  void ShowBeside(vtkProp3D* prop, vtkAbstractMapper* mapper);
  /// Returns whether this process has the props in its renderer.
  bool IsDrawnHere() const { return this->Scene != nullptr; }

  vtkPVDSMClipping Clipping;
  /// Gives an actor, which exporters are to have, the look of what is traced.
  std::function<void(vtkActor* actor, vtkMapper* mapper)> SetLook;
  vtkNew<vtkPVDSMSelectionMapper> SelectionMapper; ///< gets its source from the representation
  /// Called on all ranks before a render, if set; `selecting`: it is for a selection, of this display, too.
  std::function<void(vtkDSMScene* scene, vtkRenderer* renderer, bool selecting)> PrepareSelection;

  ///@{
  /// Common implementation of the representation's methods of these names.
  bool AddToView(vtkView* view);
  bool RemoveFromView(vtkView* view);
  void SetVisibility(bool visible);
  void SetPickable(bool pickable);

  /// Returns whether a color map, which may be null, lets light through anywhere.
  static bool HasOpacity(vtkScalarsToColors* map);
  void SetFrameReport(vtkPVDSMFrameReport* report);
  void SetLightOptions(vtkObject* options);
  void SetMemoryOptions(vtkObject* options);
  ///@}

  /// Returns the scene of the view; null where the process does not render, and while the display is in no view.
  vtkDSMScene* GetScene() const;

  /// Begins the representation's ProcessViewRequest: false where it ends at once. An update that the
  /// view's cache of time steps would skip takes place.
  bool Process(vtkInformationRequestKey* request, vtkInformation* inInfo, vtkInformation* outInfo);

  /// Called by RequestData.
  void NoteUpdate() { this->IsUpdated = true; }

  /// For REQUEST_UPDATE: `bounds` are in the world, null or not initialized where nothing is known;
  /// `isTranslucent` is the same on every rank; `data` this rank's.
  void KeepData(const double* bounds, bool isTranslucent, vtkDataObject* data,
    vtkInformation* inInfo, vtkInformation* outInfo);

  /// For REQUEST_RENDER: `dataBounds` are those of this rank's data, without the prop's transform.
  void PrepareRender(const double* dataBounds, vtkInformation* inInfo);

private:
  void Take(vtkProp3D* prop, vtkAbstractMapper* mapper, const char* work);
  /// Stops to listen to the mapper.
  void Drop();
  /// Takes the bounds of all ranks' data, which a scene has told the mapper.
  void TakeBounds();
  void Leave();
  void ShareOptions();
  /// Warns, on the first rank, when a plane or box begins to hide the entire dataset. Does nothing until all ranks'
  /// bounds are known.
  void TellWhatHides();
  vtkSmartPointer<vtkActor> MakeExportActor(vtkPolyData* polygons) const;
  void ConnectFrameReport();
  /// Forwards progress events while the view renders; ParaView observes the representation only.
  void ForwardProgress();

  vtkPVDataRepresentation* Representation;
  vtkSmartPointer<vtkProp3D> Prop;
  vtkSmartPointer<vtkAbstractMapper> Mapper;
  vtkSmartPointer<vtkProp3D> Beside; ///< null: one prop is shown
  vtkSmartPointer<vtkAbstractMapper> BesideMapper;
  const char* Work = nullptr;
  unsigned long ProgressObserver = 0;
  unsigned long BoundsObserver = 0;
  bool IsUpdated = false;               ///< during the view's current request
  vtkWeakPointer<vtkPVRenderView> View; ///< from AddToView to RemoveFromView
  bool IsInView = false;
  vtkBoundingBox
    DataBounds; ///< of all ranks, without the prop's transform; not valid until the scene tells them
  const char* HiddenBy = nullptr; ///< what a warning was about
  vtkNew<vtkPartitionedDataSet> Placeholder;
  vtkNew<vtkPVDSMExportProp> ExportProp;            ///< for exporters
  vtkNew<vtkPVDSMSelectionActor> SelectionActor;    ///< for selections
  vtkSmartPointer<vtkDSMScene> Scene;               ///< null where the process does not render
  vtkSmartPointer<vtkPVDSMRefinement> Refinement;   ///< on the client
  vtkSmartPointer<vtkPVDSMFrameReport> FrameReport; ///< on the servers
  vtkSmartPointer<vtkObject> LightOptions;
  vtkSmartPointer<vtkObject> MemoryOptions;
};

#endif
