// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMDelivery_h
#define vtkPVDSMDelivery_h

#include "vtkSmartPointer.h"

class vtkDataObject;
class vtkDSMScene;
class vtkInformation;
class vtkPartitionedDataSet;
class vtkPVDSMFrameReport;
class vtkPVDataRepresentation;
class vtkPVRenderView;
class vtkView;

/// How what our representations show gets into ParaView's picture: the data stay on their rank, and
/// the ranks' pictures are composited.
class vtkPVDSMDelivery
{
public:
  /// For AddToView: the view's scene; null on ParaView's client, which holds every representation and
  /// hears every render, but only displays. Reports why nothing can be drawn, if so.
  static vtkSmartPointer<vtkDSMScene> FindScene(
    vtkPVDataRepresentation* representation, vtkPVRenderView* view);

  /// For REQUEST_UPDATE, where the representation needed an update but its RequestData did not come:
  /// the view relies on its cache of time steps, but that holds our placeholder, not the data.
  static void UpdateInSpiteOfCache(vtkPVDataRepresentation* representation);

  /// Returns whether this delivery is used for the dataset in a view, or will be once it is
  /// visible.
  static bool IsChosen(vtkPVDataRepresentation* representation, vtkView* view);

  /// Data that a representation shows.
  struct Shown
  {
    const double* Bounds;          ///< world; null where nothing is known
    bool IsTranslucent = false;    ///< the same on every rank
    vtkDataObject* Data = nullptr; ///< this rank's data; their size is that of the shown data
  };

  /// For REQUEST_UPDATE: a placeholder is delivered, and every rank renders. When other objects of the
  /// view can be seen through what is shown, the ranks draw a part of space each, and their pictures
  /// are blended in order.
  static void KeepData(vtkPVDataRepresentation* representation, vtkPartitionedDataSet* placeholder,
    const Shown& shown, vtkInformation* inInfo, vtkInformation* outInfo);

  /// For REQUEST_RENDER: whether the view is going to draw for a selection, until the next request.
  static bool IsSelecting(vtkView* view);

  /// For REQUEST_RENDER: chooses the way that suits the view's other contents, and the purpose of the render.
  /// `report` knows the state of the client; may be null. `seconds`: that a render may take if others are to follow.
  static void Choose(vtkDSMScene* scene, vtkView* view, vtkInformation* inInfo,
    vtkPVDSMFrameReport* report, double seconds);

private:
  /// Returns whether the view renders an image that is kept, such as a screenshot.
  static bool IsCapturing(vtkView* view);
  static void SelectTheNearest(vtkView* view);
};

#endif
