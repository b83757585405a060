// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMPolyDataMapper.h"

#include "vtkDSMKnownBounds.h"
#include "vtkDSMLightOptions.h"
#include "vtkDSMMemoryOptions.h"
#include "vtkDSMOriginalData.h"
#include "vtkDSMScene.h"
#include "vtkDSMSceneMesh.h"

#include "vtkCommand.h"
#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkCompositeDataSet.h"
#include "vtkInformation.h"
#include "vtkMath.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkTrivialProducer.h"

#include <algorithm>

vtkStandardNewMacro(vtkDSMPolyDataMapper);

vtkDSMPolyDataMapper::vtkDSMPolyDataMapper()
  : LightOptions(vtkSmartPointer<vtkDSMLightOptions>::New())
  , MemoryOptions(vtkSmartPointer<vtkDSMMemoryOptions>::New())
  , GlobalBounds(std::make_unique<vtkDSMKnownBounds>())
  , Original(std::make_unique<vtkDSMOriginalData>())
{
  vtkDSMSceneMesh::AddKind<vtkDSMSceneMesh>();
}

vtkDSMPolyDataMapper::~vtkDSMPolyDataMapper() = default;

void vtkDSMPolyDataMapper::SetOriginalData(vtkDataObject* data)
{
  this->Original->Set(data);
}

bool vtkDSMPolyDataMapper::HasOldData() const
{
  return this->Original->HasChanged();
}

void vtkDSMPolyDataMapper::SetCompositeDataDisplayAttributes(
  vtkCompositeDataDisplayAttributes* attributes)
{
  if (this->BlockAttributes != attributes)
  {
    this->BlockAttributes = attributes;
    this->Modified();
  }
}

vtkCompositeDataDisplayAttributes* vtkDSMPolyDataMapper::GetCompositeDataDisplayAttributes() const
{
  return this->BlockAttributes;
}

void vtkDSMPolyDataMapper::SetLightOptions(vtkDSMLightOptions* options)
{
  this->LightOptions = options ? options : vtkSmartPointer<vtkDSMLightOptions>::New().Get();
  this->Modified();
}

void vtkDSMPolyDataMapper::SetMemoryOptions(vtkDSMMemoryOptions* options)
{
  this->MemoryOptions = options ? options : vtkSmartPointer<vtkDSMMemoryOptions>::New().Get();
  this->Modified();
}

vtkDSMMemoryOptions* vtkDSMPolyDataMapper::GetMemoryOptions() const
{
  return this->MemoryOptions;
}

vtkDSMLightOptions* vtkDSMPolyDataMapper::GetLightOptions() const
{
  return this->LightOptions;
}

double* vtkDSMPolyDataMapper::GetBounds()
{
  if (const double* known = this->GlobalBounds->Get(this, this->NumberOfPieces))
  {
    std::copy_n(known, 6, this->Bounds);
    return this->Bounds;
  }
  vtkMath::UninitializeBounds(this->Bounds);
  this->UpdatePiece(this->Piece, this->NumberOfPieces);
  vtkDataObject* data =
    this->GetNumberOfInputConnections(0) > 0 ? this->GetInputDataObject(0, 0) : nullptr;
  if (auto* polyData = vtkPolyData::SafeDownCast(data))
  {
    polyData->GetBounds(this->Bounds);
  }
  else if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    composite->GetBounds(this->Bounds);
  }
  return this->Bounds;
}

void vtkDSMPolyDataMapper::SetGlobalBounds(const double bounds[6])
{
  this->GlobalBounds->Set(this, bounds);
  this->InvokeEvent(vtkCommand::UpdateDataEvent);
}

void vtkDSMPolyDataMapper::UpdatePiece(int piece, int numberOfPieces)
{
  if (this->Static || this->GetNumberOfInputConnections(0) == 0)
  {
    return;
  }
  if (this->NumberOfPieces == 1)
  {
    this->Piece = piece;
    this->NumberOfPieces = numberOfPieces;
  }
  int port = 0;
  vtkAlgorithm* producer = this->GetInputAlgorithm(0, 0, port);
  if (!vtkTrivialProducer::SafeDownCast(producer))
  {
    producer->UpdatePiece(this->Piece, this->NumberOfPieces, this->GhostLevel);
  }
}

void vtkDSMPolyDataMapper::Render(vtkRenderer* renderer, vtkActor*)
{
  if (this->MakesScene)
  {
    vtkDSMScene::DrawWithoutScene(renderer, this);
  }
}

void vtkDSMPolyDataMapper::ShallowCopy(vtkAbstractMapper* mapper)
{
  this->GlobalBounds->Clear();
  this->Superclass::ShallowCopy(mapper);
  if (auto* other = vtkDSMPolyDataMapper::SafeDownCast(mapper))
  {
    *this->Original = *other->Original;
    this->SetCompositeDataDisplayAttributes(other->BlockAttributes);
    this->SetLightOptions(other->LightOptions);
    this->SetMemoryOptions(other->MemoryOptions);
    this->SetMakesScene(other->MakesScene);
  }
}

int vtkDSMPolyDataMapper::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

void vtkDSMPolyDataMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "CompositeDataDisplayAttributes: " << this->BlockAttributes.Get() << "\n";
  os << indent << "MakesScene: " << this->MakesScene << "\n";
}
