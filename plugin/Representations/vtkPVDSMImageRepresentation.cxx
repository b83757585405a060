// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMImageRepresentation.h"

#include "vtkDSMScene.h"
#include "vtkDSMVolumeMapper.h"
#include "vtkPVDSMClipping.h"
#include "vtkPVDSMDelivery.h"
#include "vtkPVDSMFrameReport.h"
#include "vtkPVDSMIsosurfaceGeometry.h"
#include "vtkPVDSMLightOptions.h"
#include "vtkPVDSMMemoryOptions.h"
#include "vtkPVDSMRefinement.h"
#include "vtkPVDSMSelectionMapper.h"

#include "vtkActor.h"
#include "vtkCommand.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMatrix4x4.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkObjectFactory.h"
#include "vtkPVRenderView.h"
#include "vtkPartitionedDataSet.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkScalarsToColors.h"
#include "vtkVolume.h"

#include <algorithm>

vtkStandardNewMacro(vtkPVDSMImageRepresentation);

vtkPVDSMImageRepresentation::vtkPVDSMImageRepresentation()
  : Clipping(std::make_unique<vtkPVDSMClipping>())
{
  this->Volume->SetMapper(this->Mapper);
  this->Mapper->MakesSceneOff(); // on ParaView's client there shall be none
  this->Mapper->AutomaticIsoValueOn();
  this->Mapper->AddObserver(
    vtkCommand::ProgressEvent, this, &vtkPVDSMImageRepresentation::ForwardProgress);
  this->SelectionMapper->SetSource([this]() -> vtkSmartPointer<vtkDataObject>
    { return vtkPVDSMIsosurfaceGeometry::Make(this->Mapper); });
  this->SelectionActor->SetMapper(this->SelectionMapper);
  this->SelectionActor->UseBoundsOff();
}

vtkPVDSMImageRepresentation::~vtkPVDSMImageRepresentation() = default;

int vtkPVDSMImageRepresentation::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

int vtkPVDSMImageRepresentation::RequestData(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  vtkSmartPointer<vtkDataObject> data;
  if (input[0]->GetNumberOfInformationObjects() == 1)
  {
    // A copy of the structure only: the source may go on to its next time step while this one is
    // still shown.
    if (vtkDataObject* source = vtkDataObject::GetData(input[0], 0))
    {
      data.TakeReference(source->NewInstance());
      data->ShallowCopy(source);
    }
  }
  this->Mapper->SetInputData(data);
  this->Executed = true;
  return this->Superclass::RequestData(request, input, output);
}

int vtkPVDSMImageRepresentation::ProcessViewRequest(
  vtkInformationRequestKey* request, vtkInformation* inInfo, vtkInformation* outInfo)
{
  const bool needsUpdate = request == vtkPVView::REQUEST_UPDATE() && this->GetNeedsUpdate();
  this->Executed = false;
  if (!this->Superclass::ProcessViewRequest(request, inInfo, outInfo))
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
  else if (request == vtkPVView::REQUEST_RENDER() && this->Scene)
  {
    this->Volume->ComputeMatrix();
    this->Clipping->ApplyTo(this->Mapper, this->Volume->GetMatrix());
    this->SelectionMapper->SetClippingPlanes(this->Mapper->GetClippingPlanes());
    const bool selecting = vtkPVDSMDelivery::IsSelecting(this->GetView());
    this->SelectionMapper->SetSelecting(selecting);
    this->SelectionActor->SetUseBounds(selecting); // ranks draw where there is something
    this->SelectionMapper->SetShownBounds(this->Mapper->GetBounds());
    this->SelectionActor->SetUserMatrix(this->Volume->GetMatrix());
    vtkPVDSMDelivery::Choose(this->Scene, this->GetView(), inInfo,
      this->FrameReport && this->FrameReport->GetProgressive());
  }
  return 1;
}

void vtkPVDSMImageRepresentation::PrepareUpdate(vtkInformation* inInfo, vtkInformation* outInfo)
{
  vtkScalarsToColors* colors = this->Mapper->GetLookupTable();
  const bool isTranslucent = this->Mapper->GetSurfaceProperty()->GetOpacity() < 1.0 ||
    (colors && !this->Mapper->GetColorArray().empty() && colors->IsOpaque() == 0);
  vtkPVDSMDelivery::KeepData(this, this->Placeholder,
    { this->Volume->GetBounds(), isTranslucent, this->Mapper->GetInputDataObject(0, 0) }, inInfo,
    outInfo);
  // In world space: with a matrix, the view would transform two corners of the box only.
  if (const double* bounds = this->Volume->GetBounds())
  {
    vtkPVRenderView::SetGeometryBounds(inInfo, this, bounds);
  }
}

void vtkPVDSMImageRepresentation::ForwardProgress()
{
  // Not what the mapper says when VTK executes it while the frame is drawn.
  if (this->Scene && this->Scene->IsTracing())
  {
    this->SetProgressText("Cutting the volume into bricks");
    this->UpdateProgress(this->Mapper->GetProgress());
  }
}

bool vtkPVDSMImageRepresentation::AddToView(vtkView* view)
{
  auto* renderView = vtkPVRenderView::SafeDownCast(view);
  if (!renderView)
  {
    return false;
  }
  this->Scene = vtkPVDSMDelivery::FindScene(this, renderView);
  if (this->Scene)
  {
    renderView->GetRenderer()->AddViewProp(this->Volume);
    renderView->GetRenderer()->AddViewProp(this->SelectionActor);
    this->ConnectFrameReport();
  }
  this->Refinement = vtkPVDSMRefinement::Follow(renderView);
  renderView->RegisterPropForHardwareSelection(this, this->SelectionActor);
  return this->Superclass::AddToView(view);
}

bool vtkPVDSMImageRepresentation::RemoveFromView(vtkView* view)
{
  auto* renderView = vtkPVRenderView::SafeDownCast(view);
  if (!renderView)
  {
    return false;
  }
  renderView->GetRenderer()->RemoveViewProp(this->Volume);
  renderView->GetRenderer()->RemoveViewProp(this->SelectionActor);
  renderView->UnRegisterPropForHardwareSelection(this, this->SelectionActor);
  this->Scene = nullptr;
  this->Refinement = nullptr;
  this->ConnectFrameReport();
  return this->Superclass::RemoveFromView(view);
}

void vtkPVDSMImageRepresentation::SetVisibility(bool visible)
{
  this->Volume->SetVisibility(visible);
  this->SelectionActor->SetVisibility(visible);
  this->Superclass::SetVisibility(visible);
}

void vtkPVDSMImageRepresentation::SetInputArrayToProcess(
  int index, int port, int connection, int association, const char* name)
{
  this->Superclass::SetInputArrayToProcess(index, port, connection, association, name);
  if (index == 0)
  {
    this->Mapper->SetColorArray(name ? name : "");
    this->Mapper->SetScalarVisibility(name && name[0]);
  }
}

void vtkPVDSMImageRepresentation::SelectIsoArray(int, int, int, int, const char* name)
{
  this->Mapper->SetIsoArray(name ? name : "");
}

void vtkPVDSMImageRepresentation::SetIsoComponent(int component)
{
  this->Mapper->SetIsoComponent(component);
}

void vtkPVDSMImageRepresentation::SetNumberOfIsoValues(int number)
{
  this->IsoValues.resize(std::max(number, 0), 0.0);
  this->ChooseIsoValues();
}

void vtkPVDSMImageRepresentation::SetIsoValue(int index, double value)
{
  if (index >= 0 && index < static_cast<int>(this->IsoValues.size()))
  {
    this->IsoValues[index] = value;
    this->ChooseIsoValues();
  }
}

void vtkPVDSMImageRepresentation::SetSingleIsoValue(double value)
{
  this->SingleIsoValue = value;
  this->ChooseIsoValues();
}

void vtkPVDSMImageRepresentation::ChooseIsoValues()
{
  std::vector<double> shown = this->IsoValues;
  if (shown.empty() && this->SingleIsoValue != UnsetIsoValue)
  {
    shown.push_back(this->SingleIsoValue);
  }
  const int number = static_cast<int>(shown.size());
  this->Mapper->SetNumberOfIsoValues(number);
  for (int index = 0; index < number; ++index)
  {
    this->Mapper->SetIsoValue(index, shown[index]);
  }
}

void vtkPVDSMImageRepresentation::SetLookupTable(vtkScalarsToColors* table)
{
  this->Mapper->SetLookupTable(table);
}

void vtkPVDSMImageRepresentation::SetAmbientColor(double r, double g, double b)
{
  this->Mapper->GetSurfaceProperty()->SetAmbientColor(r, g, b);
}

void vtkPVDSMImageRepresentation::SetDiffuseColor(double r, double g, double b)
{
  this->Mapper->GetSurfaceProperty()->SetDiffuseColor(r, g, b);
}

void vtkPVDSMImageRepresentation::SetSpecularColor(double r, double g, double b)
{
  this->Mapper->GetSurfaceProperty()->SetSpecularColor(r, g, b);
}

void vtkPVDSMImageRepresentation::SetAmbient(double value)
{
  this->Mapper->GetSurfaceProperty()->SetAmbient(value);
}

void vtkPVDSMImageRepresentation::SetDiffuse(double value)
{
  this->Mapper->GetSurfaceProperty()->SetDiffuse(value);
}

void vtkPVDSMImageRepresentation::SetSpecular(double value)
{
  this->Mapper->GetSurfaceProperty()->SetSpecular(value);
}

void vtkPVDSMImageRepresentation::SetSpecularPower(double value)
{
  this->Mapper->GetSurfaceProperty()->SetSpecularPower(value);
}

void vtkPVDSMImageRepresentation::SetOpacity(double value)
{
  this->Mapper->GetSurfaceProperty()->SetOpacity(value);
}

void vtkPVDSMImageRepresentation::SetPosition(double x, double y, double z)
{
  this->Volume->SetPosition(x, y, z);
}

void vtkPVDSMImageRepresentation::SetOrientation(double x, double y, double z)
{
  this->Volume->SetOrientation(x, y, z);
}

void vtkPVDSMImageRepresentation::SetOrigin(double x, double y, double z)
{
  this->Volume->SetOrigin(x, y, z);
}

void vtkPVDSMImageRepresentation::SetScale(double x, double y, double z)
{
  this->Volume->SetScale(x, y, z);
}

void vtkPVDSMImageRepresentation::SetUserTransform(const double matrix[16])
{
  vtkNew<vtkMatrix4x4> transform;
  transform->DeepCopy(matrix);
  this->Volume->SetUserMatrix(transform);
}

void vtkPVDSMImageRepresentation::SetClip(bool clip)
{
  this->Clipping->Clips = clip;
}

void vtkPVDSMImageRepresentation::SetClipOrigin(double x, double y, double z)
{
  const double origin[3] = { x, y, z };
  std::copy_n(origin, 3, this->Clipping->Origin);
}

void vtkPVDSMImageRepresentation::SetClipNormal(double x, double y, double z)
{
  const double normal[3] = { x, y, z };
  std::copy_n(normal, 3, this->Clipping->Normal);
}

void vtkPVDSMImageRepresentation::SetCropping(bool crop)
{
  this->Clipping->Crops = crop;
}

void vtkPVDSMImageRepresentation::SetCroppingBox(const double box[6])
{
  std::copy_n(box, 6, this->Clipping->Box);
}

void vtkPVDSMImageRepresentation::SetLightOptions(vtkPVDSMLightOptions* options)
{
  this->Mapper->SetLightOptions(options);
}

void vtkPVDSMImageRepresentation::SetMemoryOptions(vtkPVDSMMemoryOptions* options)
{
  this->Mapper->SetMemoryOptions(options);
}

void vtkPVDSMImageRepresentation::SetFrameReport(vtkPVDSMFrameReport* report)
{
  this->FrameReport = report;
  this->ConnectFrameReport();
}

void vtkPVDSMImageRepresentation::ConnectFrameReport()
{
  if (this->FrameReport)
  {
    this->FrameReport->SetSource(this->Scene);
    this->FrameReport->SetVolume(this->Mapper);
  }
}

void vtkPVDSMImageRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Mapper:\n";
  this->Mapper->PrintSelf(os, indent.GetNextIndent());
}
