// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMGeometryRepresentation.h"

#include "vtkDSMErrorGuard.h"
#include "vtkDSMPolyDataMapper.h"
#include "vtkPVDSMExportLook.h"
#include "vtkPVDSMFrameReport.h"
#include "vtkPVDSMLightOptions.h"
#include "vtkPVDSMMemoryOptions.h"

#include "vtkActor.h"
#include "vtkBoundingBox.h"
#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkMatrix4x4.h"
#include "vtkObjectFactory.h"
#include "vtkPVLODActor.h"
#include "vtkPVRenderView.h"
#include "vtkPolyData.h"
#include "vtkProperty.h"
#include "vtkScalarsToColors.h"
#include "vtkTexture.h"

#include <algorithm>
#include <string>

vtkStandardNewMacro(vtkPVDSMGeometryRepresentation);

vtkPVDSMGeometryRepresentation::vtkPVDSMGeometryRepresentation()
{
  auto* mapper = vtkDSMPolyDataMapper::New();
  vtkNew<vtkCompositeDataDisplayAttributes> attributes;
  mapper->SetCompositeDataDisplayAttributes(attributes);
  mapper->MakesSceneOff(); // on ParaView's client there shall be none
  this->Mapper->Delete();
  this->Mapper = mapper;
  this->SetupDefaults();
  // Interactive frames are traced, too.
  this->Actor->SetLODMapper(nullptr);
  this->Actor->ForceOpaqueOn();
  this->Display = std::make_unique<vtkPVDSMTracedDisplay>(
    this, this->Actor, mapper, "Cutting the surface into bricks");
  this->Display->SelectionMapper->SetCompositeDataDisplayAttributes(attributes);
  this->Display->SelectionMapper->SetSource([this] { return this->MakeSelectable(); });
  this->Display->SetLook = [this](vtkActor* actor, vtkMapper* look)
  { this->SetExportLook(actor, look); };
}

vtkPVDSMGeometryRepresentation::~vtkPVDSMGeometryRepresentation() = default;

vtkSmartPointer<vtkDataObject> vtkPVDSMGeometryRepresentation::MakeSelectable()
{
  return this->GetSurface();
}

void vtkPVDSMGeometryRepresentation::SetExportLook(vtkActor* actor, vtkMapper* mapper)
{
  this->UpdateColoringParameters();
  actor->SetProperty(this->Property);
  mapper->SetLookupTable(this->Mapper->GetLookupTable());
  mapper->UseLookupTableScalarRangeOn();
  mapper->SetScalarVisibility(this->Mapper->GetScalarVisibility());
  mapper->SetScalarMode(this->Mapper->GetScalarMode());
  mapper->SelectColorArray(this->Mapper->GetArrayName());
  mapper->SetColorMode(this->Mapper->GetColorMode());
}

vtkDSMPolyDataMapper* vtkPVDSMGeometryRepresentation::GetMapper() const
{
  return static_cast<vtkDSMPolyDataMapper*>(this->Mapper);
}

vtkDSMMeshDisplayMapper* vtkPVDSMGeometryRepresentation::GetMeshMapper() const
{
  return this->GetMapper();
}

int vtkPVDSMGeometryRepresentation::RequestData(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  return vtkDSMErrorGuard::Run(this, "updating", this->GetLogName().c_str(),
    [&]
    {
      this->Display->NoteUpdate();
      this->GetMapper()->SetOriginalData(vtkDataObject::GetData(input[0], 0));
      return this->Superclass::RequestData(request, input, output);
    });
}

int vtkPVDSMGeometryRepresentation::ProcessViewRequest(
  vtkInformationRequestKey* request, vtkInformation* inInfo, vtkInformation* outInfo)
{
  return vtkDSMErrorGuard::Run(this, "preparing", this->GetLogName().c_str(),
    [&]
    {
      if (!this->Display->Process(request, inInfo, outInfo))
      {
        return 0;
      }
      if (request == vtkPVView::REQUEST_UPDATE())
      {
        this->PrepareUpdate(inInfo, outInfo);
      }
      else if (request == vtkPVView::REQUEST_RENDER())
      {
        this->PrepareRender(inInfo);
      }
      return 1;
    });
}

vtkBoundingBox vtkPVDSMGeometryRepresentation::GetShownBounds()
{
  this->ComputeVisibleDataBounds();
  vtkBoundingBox bounds(this->VisibleDataBounds);
  if (bounds.IsValid())
  {
    bounds.Inflate(
      std::max({ this->GetMapper()->GetLineRadius(), this->GetMapper()->GetPointRadius(), 0.0 }));
  }
  return bounds;
}

void vtkPVDSMGeometryRepresentation::PrepareUpdate(vtkInformation* inInfo, vtkInformation* outInfo)
{
  vtkNew<vtkMatrix4x4> matrix;
  this->Actor->GetMatrix(matrix);
  const vtkBoundingBox bounds = this->GetShownBounds();
  vtkBoundingBox inWorld;
  for (int corner = 0; bounds.IsValid() && corner < 8; ++corner)
  {
    double point[4] = { 0.0, 0.0, 0.0, 1.0 };
    bounds.GetCorner(corner, point);
    inWorld.AddPoint(matrix->MultiplyDoublePoint(point));
  }
  double world[6];
  inWorld.GetBounds(world);
  this->Display->KeepData(
    world, this->IsTranslucent(), this->GetRenderedDataObject(0), inInfo, outInfo);
}

bool vtkPVDSMGeometryRepresentation::IsTranslucent()
{
  const char* array = this->GetColorArrayName();
  const bool isColored = array && *array != '\0';
  vtkScalarsToColors* map = this->Mapper->GetLookupTable();
  vtkTexture* texture = this->Actor->GetTexture();
  // Colors that are taken as they are may have an opacity on another rank.
  return this->Property->GetOpacity() < 1.0 ||
    std::any_of(this->BlockOpacities.begin(), this->BlockOpacities.end(),
      [](const auto& block) { return block.second < 1.0; }) ||
    (isColored &&
      (this->Mapper->GetColorMode() == VTK_COLOR_MODE_DIRECT_SCALARS ||
        vtkPVDSMTracedDisplay::HasOpacity(map))) ||
    (texture && texture->IsTranslucent());
}

void vtkPVDSMGeometryRepresentation::PrepareSurface()
{
  vtkDataObject* data = this->GetSurface();
  this->GetMapper()->SetInputDataObject(data);
  this->UpdateColoringParameters();
  if (data && (this->BlockAttributeTime < data->GetMTime() || this->BlockAttrChanged))
  {
    this->PopulateBlockAttributes(this->GetMapper()->GetCompositeDataDisplayAttributes(), data);
    this->BlockAttributeTime.Modified();
    this->BlockAttrChanged = false;
  }
}

void vtkPVDSMGeometryRepresentation::PrepareRender(vtkInformation* inInfo)
{
  this->PrepareSurface();
  this->Display->PrepareRender(this->VisibleDataBounds, inInfo);
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
  return this->Display->AddToView(view) && this->Superclass::AddToView(view);
}

bool vtkPVDSMGeometryRepresentation::RemoveFromView(vtkView* view)
{
  return this->Display->RemoveFromView(view) && this->Superclass::RemoveFromView(view);
}

// The superclass would set the names at a mapper of another class.
void vtkPVDSMGeometryRepresentation::SetArrayIdNames(const char* points, const char* cells)
{
  this->Display->SelectionMapper->SetPointIdArrayName(points ? points : "vtkOriginalPointIds");
  this->Display->SelectionMapper->SetCellIdArrayName(cells ? cells : "vtkOriginalCellIds");
}

void vtkPVDSMGeometryRepresentation::SetVisibility(bool visible)
{
  this->Superclass::SetVisibility(visible);
  this->Display->SetVisibility(visible);
}

void vtkPVDSMGeometryRepresentation::SetPickable(int pickable)
{
  this->Superclass::SetPickable(pickable);
  this->Display->SetPickable(pickable != 0);
}

void vtkPVDSMGeometryRepresentation::SetShowEdges(bool show)
{
  this->ShowEdges = show;
}

std::vector<vtkSmartPointer<vtkPolyData>> vtkPVDSMGeometryRepresentation::GetTriangles()
{
  vtkCompositeDataDisplayAttributes* attributes =
    this->GetMapper()->GetCompositeDataDisplayAttributes();
  vtkPVDSMExportParts parts;
  const auto add = [&](vtkDataObject* block)
  {
    auto* polygons = vtkPolyData::SafeDownCast(block);
    if (polygons &&
      !(attributes->HasBlockVisibility(block) && !attributes->GetBlockVisibility(block)))
    {
      vtkPVDSMExportLook look;
      if (attributes->HasBlockColor(block))
      {
        attributes->GetBlockColor(block, look.Color.emplace().data());
      }
      if (attributes->HasBlockOpacity(block))
      {
        look.Opacity = attributes->GetBlockOpacity(block);
      }
      parts.Add(polygons, look);
    }
  };
  vtkDataObject* data = this->GetSurface();
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    vtkSmartPointer<vtkCompositeDataIterator> leaf;
    leaf.TakeReference(composite->NewIterator());
    for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
    {
      add(leaf->GetCurrentDataObject());
    }
  }
  else
  {
    add(data);
  }
  return parts.Finish();
}

void vtkPVDSMGeometryRepresentation::SetLightOptions(vtkPVDSMLightOptions* options)
{
  this->GetMapper()->SetLightOptions(options);
  this->Display->SetLightOptions(options);
}

void vtkPVDSMGeometryRepresentation::SetMemoryOptions(vtkPVDSMMemoryOptions* options)
{
  this->GetMapper()->SetMemoryOptions(options);
  this->Display->SetMemoryOptions(options);
}

void vtkPVDSMGeometryRepresentation::SetFrameReport(vtkPVDSMFrameReport* report)
{
  this->Display->SetFrameReport(report);
}

void vtkPVDSMGeometryRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Mapper:\n";
  this->Mapper->PrintSelf(os, indent.GetNextIndent());
}
