// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMDelivery_h
#define vtkPVDSMDelivery_h

#include <string>

class vtkDataObject;
class vtkDSMScene;
class vtkInformation;
class vtkPVDataRepresentation;
class vtkView;

/// How what our representations show gets into ParaView's picture: the data stay on their rank, and
/// the ranks' pictures are composited.
class vtkPVDSMDelivery
{
public:
  /// ParaView's client holds every representation and hears every render, but only displays.
  static bool IsRenderingProcess();

  /// Why this rendering process cannot draw anything, and what to do; empty when it can.
  static std::string FindObstacle();

  /// For REQUEST_UPDATE: an empty placeholder is delivered, and every rank renders.
  static void KeepData(vtkPVDataRepresentation* representation, vtkDataObject* placeholder,
    vtkInformation* inInfo, vtkInformation* outInfo);

  /// For REQUEST_RENDER: the way that suits what else the view shows.
  static void Choose(vtkDSMScene* scene, vtkView* view);
};

#endif
