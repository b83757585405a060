// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMTracedDisplay.h"

#include "vtkDSMMemoryOptions.h"
#include "vtkDSMScene.h"
#include "vtkPVDSMDelivery.h"
#include "vtkPVDSMExportLook.h"
#include "vtkPVDSMFrameReport.h"
#include "vtkPVDSMRefinement.h"
#include "vtkPVDSMSharedOptions.h"

#include "vtkAbstractMapper3D.h"
#include "vtkActor.h"
#include "vtkBoundingBox.h"
#include "vtkColorTransferFunction.h"
#include "vtkCommand.h"
#include "vtkMatrix4x4.h"
#include "vtkMultiProcessController.h"
#include "vtkPVDataRepresentation.h"
#include "vtkPVRenderView.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProp3D.h"
#include "vtkRenderer.h"

vtkPVDSMTracedDisplay::vtkPVDSMTracedDisplay(vtkPVDataRepresentation* representation,
  vtkProp3D* prop, vtkAbstractMapper* mapper, const char* work)
  : Representation(representation)
{
  this->Take(prop, mapper, work);
  this->SelectionActor->SetMapper(this->SelectionMapper);
  this->SelectionActor->UseBoundsOff();
  this->ExportProp->SetRepresentation(
    representation, [this](vtkPolyData* polygons) { return this->MakeExportActor(polygons); });
}

vtkPVDSMTracedDisplay::~vtkPVDSMTracedDisplay()
{
  this->Drop();
}

void vtkPVDSMTracedDisplay::Take(vtkProp3D* prop, vtkAbstractMapper* mapper, const char* work)
{
  this->Prop = prop;
  this->Mapper = mapper;
  this->Work = work;
  this->DataBounds.Reset();
  this->ProgressObserver =
    mapper->AddObserver(vtkCommand::ProgressEvent, this, &vtkPVDSMTracedDisplay::ForwardProgress);
  this->BoundsObserver =
    mapper->AddObserver(vtkCommand::UpdateDataEvent, this, &vtkPVDSMTracedDisplay::TakeBounds);
}

void vtkPVDSMTracedDisplay::Drop()
{
  this->Mapper->RemoveObserver(this->ProgressObserver);
  this->Mapper->RemoveObserver(this->BoundsObserver);
}

void vtkPVDSMTracedDisplay::Show(vtkProp3D* prop, vtkAbstractMapper* mapper, const char* work)
{
  this->Leave();
  this->Prop->VisibilityOff();
  if (this->Beside)
  {
    this->Beside->VisibilityOff();
    this->Beside = nullptr;
    this->BesideMapper = nullptr;
  }
  prop->SetPickable(this->Prop->GetPickable());
  this->Drop();
  this->Take(prop, mapper, work);
  this->SetVisibility(this->Representation->GetVisibility());
}

void vtkPVDSMTracedDisplay::ShowBeside(vtkProp3D* prop, vtkAbstractMapper* mapper)
{
  this->Leave();
  this->Beside = prop;
  this->BesideMapper = mapper;
  this->SetVisibility(this->Representation->GetVisibility());
}

bool vtkPVDSMTracedDisplay::AddToView(vtkView* view)
{
  this->View = vtkPVRenderView::SafeDownCast(view);
  this->ConnectFrameReport();
  this->SetVisibility(this->Representation->GetVisibility());
  return this->View != nullptr;
}

bool vtkPVDSMTracedDisplay::RemoveFromView(vtkView* view)
{
  this->Leave();
  vtkPVDSMSharedOptions::Leave(this->View, this->LightOptions, this->MemoryOptions);
  this->View = nullptr;
  this->ConnectFrameReport();
  return vtkPVRenderView::SafeDownCast(view) != nullptr;
}

// ParaView adds all ways to show a dataset to its view; those that the user has not chosen must cost nothing.
void vtkPVDSMTracedDisplay::SetVisibility(bool visible)
{
  this->Prop->SetVisibility(visible);
  if (this->Beside)
  {
    this->Beside->SetVisibility(visible);
  }
  this->SelectionActor->SetVisibility(visible);
  if (!visible && this->View && !vtkPVDSMDelivery::IsChosen(this->Representation, this->View))
  {
    this->Leave(); // with its bricks, which a dataset that is only hidden keeps
  }
  const bool enters = visible && this->View && !this->IsInView;
  this->IsInView = this->IsInView || enters;
  this->ShareOptions();
  if (!enters)
  {
    return;
  }
  this->Scene = vtkPVDSMDelivery::FindScene(this->Representation, this->View);
  if (this->Scene)
  {
    this->View->GetRenderer()->AddViewProp(this->Prop);
    if (this->Beside)
    {
      this->View->GetRenderer()->AddViewProp(this->Beside);
    }
    this->View->GetRenderer()->AddViewProp(this->SelectionActor);
  }
  // A mesh that is drawn here is an actor for exporters, too.
  if (!this->Scene || !vtkActor::SafeDownCast(this->Prop))
  {
    this->View->GetRenderer()->AddViewProp(this->ExportProp);
  }
  this->Refinement = vtkPVDSMRefinement::Follow(this->View);
  this->View->RegisterPropForHardwareSelection(this->Representation, this->SelectionActor);
}

void vtkPVDSMTracedDisplay::SetPickable(bool pickable)
{
  this->Prop->SetPickable(pickable);
  this->SelectionActor->SetPickable(pickable);
}

bool vtkPVDSMTracedDisplay::HasOpacity(vtkScalarsToColors* map)
{
  auto* function = vtkColorTransferFunction::SafeDownCast(map);
  return map && (map->IsOpaque() == 0 || (function && function->GetNanOpacity() < 1.0));
}

void vtkPVDSMTracedDisplay::Leave()
{
  if (this->IsInView && this->View)
  {
    this->View->GetRenderer()->RemoveViewProp(this->Prop);
    if (this->Beside)
    {
      this->View->GetRenderer()->RemoveViewProp(this->Beside);
    }
    this->View->GetRenderer()->RemoveViewProp(this->SelectionActor);
    this->View->GetRenderer()->RemoveViewProp(this->ExportProp);
    this->View->UnRegisterPropForHardwareSelection(this->Representation, this->SelectionActor);
  }
  this->IsInView = false;
  this->Scene = nullptr;
  this->Refinement = nullptr;
}

void vtkPVDSMTracedDisplay::SetLightOptions(vtkObject* options)
{
  this->LightOptions = options;
  this->ShareOptions();
}

void vtkPVDSMTracedDisplay::SetMemoryOptions(vtkObject* options)
{
  this->MemoryOptions = options;
  this->ShareOptions();
}

void vtkPVDSMTracedDisplay::ShareOptions()
{
  if (this->View && this->LightOptions && this->MemoryOptions)
  {
    vtkPVDSMSharedOptions::Join(
      this->View, this->LightOptions, this->MemoryOptions, this->IsInView);
  }
}

vtkSmartPointer<vtkActor> vtkPVDSMTracedDisplay::MakeExportActor(vtkPolyData* polygons) const
{
  vtkNew<vtkMatrix4x4> matrix;
  this->Prop->GetMatrix(matrix);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(this->Clipping.Clip(polygons, matrix));
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->SetUserMatrix(matrix);
  this->SetLook(actor, mapper);
  vtkPVDSMExportLook::Get(polygons).ApplyTo(actor);
  return actor;
}

void vtkPVDSMTracedDisplay::SetFrameReport(vtkPVDSMFrameReport* report)
{
  this->FrameReport = report;
  this->ConnectFrameReport();
}

vtkDSMScene* vtkPVDSMTracedDisplay::GetScene() const
{
  return this->Scene;
}

void vtkPVDSMTracedDisplay::ConnectFrameReport()
{
  if (this->FrameReport)
  {
    this->FrameReport->SetView(this->View);
  }
}

bool vtkPVDSMTracedDisplay::Process(
  vtkInformationRequestKey* request, vtkInformation* inInfo, vtkInformation* outInfo)
{
  const bool needsUpdate =
    request == vtkPVView::REQUEST_UPDATE() && this->Representation->GetNeedsUpdate();
  this->IsUpdated = false;
  this->ExportProp->Forget();
  if (request == vtkPVView::REQUEST_UPDATE() && this->Scene)
  {
    this->Scene->ForgetFrameBounds(); // the view finds those of the displays when all are updated
  }
  // Not what a Surface does: it delivers its geometry, or a coarser one.
  if (!this->Representation->vtkPVDataRepresentation::ProcessViewRequest(request, inInfo, outInfo))
  {
    return false;
  }
  // In a comparative view, the data of this cell's own update stay, whatever their source has become since.
  if (needsUpdate && !this->IsUpdated && !this->Representation->GetForceUseCache())
  {
    vtkPVDSMDelivery::UpdateInSpiteOfCache(this->Representation);
  }
  if (request == vtkPVView::REQUEST_UPDATE_LOD())
  {
    vtkPVRenderView::SetRequiresDistributedRenderingLOD(inInfo, this->Representation, true);
  }
  return true;
}

void vtkPVDSMTracedDisplay::KeepData(const double* bounds, bool isTranslucent, vtkDataObject* data,
  vtkInformation* inInfo, vtkInformation* outInfo)
{
  const double* known = bounds && vtkBoundingBox::IsValid(bounds) ? bounds : nullptr;
  if (this->IsUpdated)
  {
    this->DataBounds.Reset(); // the scene tells those of the new data
  }
  vtkPVDSMDelivery::KeepData(
    this->Representation, this->Placeholder, { known, isTranslucent, data }, inInfo, outInfo);
  // In world space: with a matrix, the view would transform two corners of the box only.
  if (known)
  {
    vtkPVRenderView::SetGeometryBounds(inInfo, this->Representation, known);
  }
}

void vtkPVDSMTracedDisplay::PrepareRender(const double* dataBounds, vtkInformation* inInfo)
{
  if (!this->Scene)
  {
    return;
  }
  vtkNew<vtkMatrix4x4> matrix;
  this->Prop->GetMatrix(matrix);
  this->Clipping.ApplyTo(this->Mapper, matrix);
  if (this->BesideMapper)
  {
    this->Clipping.ApplyTo(this->BesideMapper, matrix);
  }
  this->TellWhatHides();
  const bool selecting = vtkPVDSMDelivery::IsSelecting(this->Representation->GetView());
  if (this->PrepareSelection && this->View)
  {
    this->PrepareSelection(
      this->Scene, this->View->GetRenderer(), selecting && this->Prop->GetPickable() != 0);
  }
  this->SelectionMapper->SetClippingPlanes(this->Mapper->GetClippingPlanes());
  this->SelectionMapper->SetSelecting(selecting);
  this->SelectionMapper->SetShownBounds(dataBounds);
  this->SelectionActor->SetUseBounds(selecting); // ranks draw where there is something
  this->SelectionActor->SetUserMatrix(matrix);
  auto* const memory = vtkDSMMemoryOptions::SafeDownCast(this->MemoryOptions);
  vtkPVDSMDelivery::Choose(this->Scene, this->Representation->GetView(), inInfo, this->FrameReport,
    memory ? memory->GetFrameBudget() : 0.0);
}

void vtkPVDSMTracedDisplay::TakeBounds()
{
  this->DataBounds.Reset();
  for (vtkAbstractMapper* const mapper : { this->Mapper.Get(), this->BesideMapper.Get() })
  {
    auto* const inSpace = vtkAbstractMapper3D::SafeDownCast(mapper);
    if (const double* const bounds = inSpace ? inSpace->GetBounds() : nullptr)
    {
      this->DataBounds.AddBounds(bounds);
    }
  }
  this->TellWhatHides();
}

void vtkPVDSMTracedDisplay::TellWhatHides()
{
  if (!this->DataBounds.IsValid())
  {
    return;
  }
  vtkNew<vtkMatrix4x4> matrix;
  this->Prop->GetMatrix(matrix);
  vtkBoundingBox bounds;
  for (int corner = 0; corner < 8; ++corner)
  {
    double point[4] = { 0.0, 0.0, 0.0, 1.0 };
    this->DataBounds.GetCorner(corner, point);
    bounds.AddPoint(matrix->MultiplyDoublePoint(point));
  }
  auto* const ranks = vtkMultiProcessController::GetGlobalController();
  const char* const before = this->HiddenBy;
  this->HiddenBy = this->Clipping.FindWhatHides(this->Mapper, bounds);
  if (this->HiddenBy && this->HiddenBy != before && (!ranks || ranks->GetLocalProcessId() == 0))
  {
    double place[6];
    bounds.GetBounds(place);
    vtkWarningWithObjectMacro(this->Representation,
      << this->Representation->GetLogName() << ": the " << this->HiddenBy
      << " hides the whole dataset, which is at x " << place[0] << " to " << place[1] << ", y "
      << place[2] << " to " << place[3] << ", z " << place[4] << " to " << place[5]
      << ". Move it there, or reset it to the bounds of the data.");
  }
}

void vtkPVDSMTracedDisplay::ForwardProgress()
{
  // Not what the mapper says when VTK executes it while the frame is drawn.
  if (this->Scene && this->Scene->IsTracing())
  {
    const char* const tracing = this->Mapper->GetProgressText();
    this->Representation->SetProgressText(tracing ? tracing : this->Work);
    this->Representation->UpdateProgress(this->Mapper->GetProgress());
  }
}
