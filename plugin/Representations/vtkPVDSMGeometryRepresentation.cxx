// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMGeometryRepresentation.h"

#include "vtkDSMPolyDataMapper.h"
#include "vtkDSMScene.h"
#include "vtkPVDSMClipping.h"
#include "vtkPVDSMDelivery.h"
#include "vtkPVDSMFrameReport.h"
#include "vtkPVDSMLightOptions.h"
#include "vtkPVDSMMemoryOptions.h"
#include "vtkPVDSMRefinement.h"
#include "vtkPVDSMSelectionMapper.h"

#include "vtkActor.h"
#include "vtkBoundingBox.h"
#include "vtkCommand.h"
#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkInformation.h"
#include "vtkMatrix4x4.h"
#include "vtkObjectFactory.h"
#include "vtkPVLODActor.h"
#include "vtkPVRenderView.h"
#include "vtkPartitionedDataSet.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkScalarsToColors.h"
#include "vtkTexture.h"

#include <algorithm>
#include <string>

vtkStandardNewMacro(vtkPVDSMGeometryRepresentation);

vtkPVDSMGeometryRepresentation::vtkPVDSMGeometryRepresentation()
  : Clipping(std::make_unique<vtkPVDSMClipping>())
{
  auto* mapper = vtkDSMPolyDataMapper::New();
  vtkNew<vtkCompositeDataDisplayAttributes> attributes;
  mapper->SetCompositeDataDisplayAttributes(attributes);
  mapper->MakesSceneOff(); // on ParaView's client there shall be none
  mapper->AddObserver(
    vtkCommand::ProgressEvent, this, &vtkPVDSMGeometryRepresentation::ForwardProgress);
  this->Mapper->Delete();
  this->Mapper = mapper;
  this->SetupDefaults();
  // Interactive frames are traced, too.
  this->Actor->SetLODMapper(nullptr);
  this->Actor->ForceOpaqueOn();
  this->SelectionMapper->SetCompositeDataDisplayAttributes(attributes);
  this->SelectionMapper->SetSource(
    [this]() -> vtkSmartPointer<vtkDataObject> { return this->GetRenderedDataObject(0); });
  this->SelectionActor->SetMapper(this->SelectionMapper);
  this->SelectionActor->UseBoundsOff();
}

vtkPVDSMGeometryRepresentation::~vtkPVDSMGeometryRepresentation() = default;

vtkDSMPolyDataMapper* vtkPVDSMGeometryRepresentation::GetMapper() const
{
  return static_cast<vtkDSMPolyDataMapper*>(this->Mapper);
}

int vtkPVDSMGeometryRepresentation::RequestData(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  this->Executed = true;
  return this->Superclass::RequestData(request, input, output);
}

int vtkPVDSMGeometryRepresentation::ProcessViewRequest(
  vtkInformationRequestKey* request, vtkInformation* inInfo, vtkInformation* outInfo)
{
  const bool needsUpdate = request == vtkPVView::REQUEST_UPDATE() && this->GetNeedsUpdate();
  this->Executed = false;
  // Not what a Surface does: it delivers its geometry, or a coarser one.
  if (!this->vtkPVDataRepresentation::ProcessViewRequest(request, inInfo, outInfo))
  {
    return 0;
  }
  if (needsUpdate && !this->Executed)
  {
    vtkPVDSMDelivery::UpdateInSpiteOfCache(this);
  }
  if (request == vtkPVView::REQUEST_UPDATE())
  {
    this->PrepareUpdate(inInfo, outInfo);
  }
  else if (request == vtkPVView::REQUEST_UPDATE_LOD())
  {
    vtkPVRenderView::SetRequiresDistributedRenderingLOD(inInfo, this, true);
  }
  else if (request == vtkPVView::REQUEST_RENDER())
  {
    this->PrepareRender(inInfo);
  }
  return 1;
}

void vtkPVDSMGeometryRepresentation::PrepareUpdate(vtkInformation* inInfo, vtkInformation* outInfo)
{
  this->ComputeVisibleDataBounds();
  vtkNew<vtkMatrix4x4> matrix;
  this->Actor->GetMatrix(matrix);
  vtkBoundingBox bounds(this->VisibleDataBounds);
  if (bounds.IsValid())
  {
    bounds.Inflate(
      std::max({ this->GetMapper()->GetLineRadius(), this->GetMapper()->GetPointRadius(), 0.0 }));
  }
  double inflated[6];
  bounds.GetBounds(inflated);
  vtkBoundingBox inWorld;
  for (int corner = 0; bounds.IsValid() && corner < 8; ++corner)
  {
    const double point[4] = { inflated[corner & 1], inflated[2 + (corner >> 1 & 1)],
      inflated[4 + (corner >> 2)], 1.0 };
    double world[4];
    matrix->MultiplyPoint(point, world);
    inWorld.AddPoint(world);
  }
  double worldBounds[6];
  inWorld.GetBounds(worldBounds);
  vtkPVDSMDelivery::KeepData(this, this->Placeholder,
    { inWorld.IsValid() ? worldBounds : nullptr, this->IsTranslucent(),
      this->GetRenderedDataObject(0) },
    inInfo, outInfo);
  vtkPVRenderView::SetGeometryBounds(inInfo, this, inflated, matrix);
}

bool vtkPVDSMGeometryRepresentation::IsTranslucent()
{
  const char* array = this->GetColorArrayName();
  const bool isColored = array && *array != '\0';
  vtkScalarsToColors* map = this->Mapper->GetLookupTable();
  vtkTexture* texture = this->Actor->GetTexture();
  // Colours that are taken as they are may have an opacity on another rank.
  return this->Property->GetOpacity() < 1.0 ||
    std::any_of(this->BlockOpacities.begin(), this->BlockOpacities.end(),
      [](const auto& block) { return block.second < 1.0; }) ||
    (isColored &&
      (this->Mapper->GetColorMode() == VTK_COLOR_MODE_DIRECT_SCALARS ||
        (map && map->IsOpaque() == 0))) ||
    (texture && texture->IsTranslucent());
}

void vtkPVDSMGeometryRepresentation::PrepareRender(vtkInformation* inInfo)
{
  vtkDataObject* data = this->GetRenderedDataObject(0);
  this->GetMapper()->SetInputDataObject(data);
  this->UpdateColoringParameters();
  if (data && (this->BlockAttributeTime < data->GetMTime() || this->BlockAttrChanged))
  {
    this->PopulateBlockAttributes(this->GetMapper()->GetCompositeDataDisplayAttributes(), data);
    this->BlockAttributeTime.Modified();
    this->BlockAttrChanged = false;
  }
  vtkNew<vtkMatrix4x4> matrix;
  this->Actor->GetMatrix(matrix);
  this->Clipping->ApplyTo(this->GetMapper(), matrix);
  this->SelectionMapper->SetClippingPlanes(this->GetMapper()->GetClippingPlanes());
  const bool selecting = vtkPVDSMDelivery::IsSelecting(this->GetView());
  this->SelectionMapper->SetSelecting(selecting);
  this->SelectionActor->SetUseBounds(selecting); // ranks draw where there is something
  this->SelectionMapper->SetShownBounds(this->VisibleDataBounds);
  this->SelectionActor->SetUserMatrix(matrix);
  if (this->Scene)
  {
    vtkPVDSMDelivery::Choose(this->Scene, this->GetView(), inInfo,
      this->FrameReport && this->FrameReport->GetProgressive());
  }
}

void vtkPVDSMGeometryRepresentation::UpdateColoringParameters()
{
  this->Superclass::UpdateColoringParameters();
  // A Surface draws its back with an actor of its own; the tracer knows both sides of one.
  const bool hasBack = this->BackfaceActor->GetVisibility() != 0;
  if (hasBack)
  {
    this->BackfaceActor->VisibilityOff();
    this->Property->BackfaceCullingOff();
  }
  this->Actor->SetBackfaceProperty(hasBack ? this->BackfaceProperty : nullptr);
  this->Property->SetEdgeVisibility(this->ShowEdges);
}

bool vtkPVDSMGeometryRepresentation::AddToView(vtkView* view)
{
  auto* renderView = vtkPVRenderView::SafeDownCast(view);
  if (renderView)
  {
    this->Scene = vtkPVDSMDelivery::FindScene(this, renderView);
    this->ConnectFrameReport();
    this->Refinement = vtkPVDSMRefinement::Follow(renderView);
    renderView->GetRenderer()->AddViewProp(this->SelectionActor);
    renderView->RegisterPropForHardwareSelection(this, this->SelectionActor);
  }
  return this->Superclass::AddToView(view);
}

bool vtkPVDSMGeometryRepresentation::RemoveFromView(vtkView* view)
{
  const bool removed = this->Superclass::RemoveFromView(view);
  if (auto* renderView = vtkPVRenderView::SafeDownCast(view))
  {
    renderView->GetRenderer()->RemoveViewProp(this->SelectionActor);
    renderView->UnRegisterPropForHardwareSelection(this, this->SelectionActor);
  }
  this->Scene = nullptr;
  this->Refinement = nullptr;
  this->ConnectFrameReport();
  return removed;
}

void vtkPVDSMGeometryRepresentation::ForwardProgress()
{
  // Not what the mapper says when VTK executes it while the frame is drawn.
  if (this->Scene && this->Scene->IsTracing())
  {
    this->SetProgressText("Cutting the surface into bricks");
    this->UpdateProgress(this->Mapper->GetProgress());
  }
}

// The superclass would set the names at a mapper of another class.
void vtkPVDSMGeometryRepresentation::SetArrayIdNames(const char* points, const char* cells)
{
  this->SelectionMapper->SetPointIdArrayName(points ? points : "vtkOriginalPointIds");
  this->SelectionMapper->SetCellIdArrayName(cells ? cells : "vtkOriginalCellIds");
}

void vtkPVDSMGeometryRepresentation::SetVisibility(bool visible)
{
  this->Superclass::SetVisibility(visible);
  this->SelectionActor->SetVisibility(visible);
}

void vtkPVDSMGeometryRepresentation::SetShowEdges(bool show)
{
  this->ShowEdges = show;
}

void vtkPVDSMGeometryRepresentation::SetLineRadius(double radius)
{
  this->GetMapper()->SetLineRadius(radius);
}

void vtkPVDSMGeometryRepresentation::SetPointRadius(double radius)
{
  this->GetMapper()->SetPointRadius(radius);
}

void vtkPVDSMGeometryRepresentation::SelectRadiusArray(int, int, int, int, const char* name)
{
  const std::string array = name ? name : "";
  // The word that the panel offers beside the arrays.
  this->GetMapper()->SetRadiusArray(array == "None" ? "" : array);
}

void vtkPVDSMGeometryRepresentation::SetClip(bool clip)
{
  this->Clipping->Clips = clip;
}

void vtkPVDSMGeometryRepresentation::SetClipOrigin(double x, double y, double z)
{
  const double origin[3] = { x, y, z };
  std::copy_n(origin, 3, this->Clipping->Origin);
}

void vtkPVDSMGeometryRepresentation::SetClipNormal(double x, double y, double z)
{
  const double normal[3] = { x, y, z };
  std::copy_n(normal, 3, this->Clipping->Normal);
}

void vtkPVDSMGeometryRepresentation::SetCropping(bool crop)
{
  this->Clipping->Crops = crop;
}

void vtkPVDSMGeometryRepresentation::SetCroppingBox(const double box[6])
{
  std::copy_n(box, 6, this->Clipping->Box);
}

void vtkPVDSMGeometryRepresentation::SetLightOptions(vtkPVDSMLightOptions* options)
{
  this->GetMapper()->SetLightOptions(options);
}

void vtkPVDSMGeometryRepresentation::SetMemoryOptions(vtkPVDSMMemoryOptions* options)
{
  this->GetMapper()->SetMemoryOptions(options);
}

void vtkPVDSMGeometryRepresentation::SetFrameReport(vtkPVDSMFrameReport* report)
{
  this->FrameReport = report;
  this->ConnectFrameReport();
}

void vtkPVDSMGeometryRepresentation::ConnectFrameReport()
{
  if (this->FrameReport)
  {
    this->FrameReport->SetSource(this->Scene);
  }
}

void vtkPVDSMGeometryRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Mapper:\n";
  this->Mapper->PrintSelf(os, indent.GetNextIndent());
}
