// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMVolumeMapper.h"

#include "vtkDSMVolumeData.h"

#include "vtkDSMKnownBounds.h"
#include "vtkDSMLightOptions.h"
#include "vtkDSMMemoryOptions.h"
#include "vtkDSMOriginalData.h"
#include "vtkDSMScene.h"
#include "vtkDSMSceneVolume.h"

#include "vtkBoundingBox.h"
#include "vtkCommand.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataSet.h"
#include "vtkHyperTreeGrid.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPlane.h"
#include "vtkPlaneCollection.h"
#include "vtkProperty.h"
#include "vtkScalarsToColors.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTrivialProducer.h"

#include <algorithm>

namespace
{

/// Returns the bounds of the whole image that a pipeline announces before it creates it. False if
/// it announces none.
bool GetAnnouncedBounds(vtkAlgorithm* producer, int port, double bounds[6])
{
  producer->UpdateInformation();
  vtkInformation* info = producer->GetOutputInformation(port);
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  if (!info || !info->Has(Pipeline::WHOLE_EXTENT()) || !info->Has(vtkDataObject::ORIGIN()) ||
    !info->Has(vtkDataObject::SPACING()))
  {
    return false;
  }
  vtkNew<vtkImageData> image; // takes no memory: it has no arrays
  image->SetExtent(info->Get(Pipeline::WHOLE_EXTENT()));
  image->SetOrigin(info->Get(vtkDataObject::ORIGIN()));
  image->SetSpacing(info->Get(vtkDataObject::SPACING()));
  if (info->Has(vtkDataObject::DIRECTION()))
  {
    image->SetDirectionMatrix(info->Get(vtkDataObject::DIRECTION()));
  }
  image->GetBounds(bounds);
  return vtkMath::AreBoundsInitialized(bounds);
}

/// Adds the bounds of a dataset, which may be null, or of its blocks.
void AddBounds(vtkDataObject* data, vtkBoundingBox& box)
{
  double bounds[6];
  if (auto* dataSet = vtkDataSet::SafeDownCast(data))
  {
    dataSet->GetBounds(bounds);
    box.AddBounds(bounds);
  }
  else if (auto* trees = vtkHyperTreeGrid::SafeDownCast(data))
  {
    // One without cells has a point at the origin.
    if (trees->GetNumberOfElements(vtkDataObject::CELL) > 0)
    {
      trees->GetBounds(bounds);
      box.AddBounds(bounds);
    }
  }
  else if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    vtkSmartPointer<vtkCompositeDataIterator> leaf;
    leaf.TakeReference(composite->NewIterator());
    for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
    {
      AddBounds(leaf->GetCurrentDataObject(), box);
    }
  }
}

} // namespace

vtkStandardNewMacro(vtkDSMVolumeMapper);
vtkCxxSetSmartPointerMacro(vtkDSMVolumeMapper, SlicePlanes, vtkPlaneCollection);
vtkCxxSetSmartPointerMacro(vtkDSMVolumeMapper, SliceOpacity, vtkPiecewiseFunction);
vtkCxxSetSmartPointerMacro(vtkDSMVolumeMapper, LookupTable, vtkScalarsToColors);
vtkCxxSetSmartPointerMacro(vtkDSMVolumeMapper, BackfaceProperty, vtkProperty);

vtkDSMVolumeMapper::vtkDSMVolumeMapper()
  : GlobalBounds(std::make_unique<vtkDSMKnownBounds>())
  , Original(std::make_unique<vtkDSMOriginalData>())
{
  this->SurfaceProperty = vtkSmartPointer<vtkProperty>::New();
  this->LightOptions = vtkSmartPointer<vtkDSMLightOptions>::New();
  this->MemoryOptions = vtkSmartPointer<vtkDSMMemoryOptions>::New();
  vtkDSMSceneVolume::AddKind<vtkDSMSceneVolume>();
}

vtkDSMVolumeMapper::~vtkDSMVolumeMapper() = default;

void vtkDSMVolumeMapper::SetOriginalData(vtkDataObject* data)
{
  this->Original->Set(data);
}

vtkDataObject* vtkDSMVolumeMapper::GetOriginalData() const
{
  return this->Original->Get();
}

bool vtkDSMVolumeMapper::HasOldData() const
{
  return this->Original->HasChanged();
}

void vtkDSMVolumeMapper::SetInputData(vtkDataObject* data)
{
  this->GlobalBounds->Clear();
  this->SetInputDataObject(0, data);
}

void vtkDSMVolumeMapper::SetTransfer2DYAxisArray(const char* name)
{
  const std::string array = name ? name : "";
  if (array != this->Transfer2DYAxisArray)
  {
    this->Transfer2DYAxisArray = array;
    this->Modified();
  }
}

const char* vtkDSMVolumeMapper::GetTransfer2DYAxisArray() const
{
  return this->Transfer2DYAxisArray.empty() ? nullptr : this->Transfer2DYAxisArray.c_str();
}

void vtkDSMVolumeMapper::SetNumberOfIsoValues(int number)
{
  const auto size = static_cast<std::size_t>(number > 0 ? number : 0);
  if (this->IsoValues.size() != size)
  {
    this->IsoValues.resize(size, 0.0);
    this->Modified();
  }
}

int vtkDSMVolumeMapper::GetNumberOfIsoValues() const
{
  return static_cast<int>(this->IsoValues.size());
}

void vtkDSMVolumeMapper::SetIsoValue(int index, double value)
{
  if (index < 0)
  {
    return;
  }
  if (index >= this->GetNumberOfIsoValues())
  {
    this->SetNumberOfIsoValues(index + 1);
  }
  if (this->IsoValues[index] != value)
  {
    this->IsoValues[index] = value;
    this->Modified();
  }
}

double vtkDSMVolumeMapper::GetIsoValue(int index) const
{
  return index >= 0 && index < this->GetNumberOfIsoValues() ? this->IsoValues[index] : 0.0;
}

void vtkDSMVolumeMapper::AddSlice(int axis, int index)
{
  if (axis < 0 || axis > 2)
  {
    vtkErrorMacro("AddSlice: axis " << axis << " is invalid; use 0, 1 or 2. No slice is added.");
    return;
  }
  const std::pair<int, int> slice(axis, index);
  const auto place = std::lower_bound(this->Slices.begin(), this->Slices.end(), slice);
  if (place == this->Slices.end() || *place != slice)
  {
    this->Slices.insert(place, slice);
    this->Modified();
  }
}

void vtkDSMVolumeMapper::RemoveAllSlices()
{
  if (!this->Slices.empty())
  {
    this->Slices.clear();
    this->Modified();
  }
}

vtkPlaneCollection* vtkDSMVolumeMapper::GetSlicePlanes() const
{
  return this->SlicePlanes;
}

void vtkDSMVolumeMapper::AddSlicePlane(vtkPlane* plane)
{
  if (!this->SlicePlanes)
  {
    this->SlicePlanes = vtkSmartPointer<vtkPlaneCollection>::New();
  }
  this->SlicePlanes->AddItem(plane);
  this->Modified();
}

void vtkDSMVolumeMapper::RemoveAllSlicePlanes()
{
  this->SetSlicePlanes(nullptr);
}

vtkPiecewiseFunction* vtkDSMVolumeMapper::GetSliceOpacity() const
{
  return this->SliceOpacity;
}

vtkScalarsToColors* vtkDSMVolumeMapper::GetLookupTable() const
{
  return this->LookupTable;
}

void vtkDSMVolumeMapper::SetBlockColor(unsigned int block, double r, double g, double b)
{
  this->BlockLooks[block].Color = std::array<double, 3>{ r, g, b };
  this->Modified();
}

void vtkDSMVolumeMapper::SetBlockOpacity(unsigned int block, double opacity)
{
  this->BlockLooks[block].Opacity = opacity;
  this->Modified();
}

void vtkDSMVolumeMapper::SetBlockValue(unsigned int block, double value)
{
  this->BlockLooks[block].Value = value;
  this->Modified();
}

void vtkDSMVolumeMapper::SetBlockVisibility(unsigned int block, bool visible)
{
  this->BlockLooks[block].IsHidden = !visible;
  this->Modified();
}

void vtkDSMVolumeMapper::RemoveBlockLooks()
{
  if (!this->BlockLooks.empty())
  {
    this->BlockLooks.clear();
    this->Modified();
  }
}

void vtkDSMVolumeMapper::SetSurfaceProperty(vtkProperty* property)
{
  if (property != this->SurfaceProperty)
  {
    this->SurfaceProperty =
      property ? vtkSmartPointer<vtkProperty>(property) : vtkSmartPointer<vtkProperty>::New();
    this->Modified();
  }
}

vtkProperty* vtkDSMVolumeMapper::GetSurfaceProperty() const
{
  return this->SurfaceProperty;
}

vtkProperty* vtkDSMVolumeMapper::GetBackfaceProperty() const
{
  return this->BackfaceProperty;
}

void vtkDSMVolumeMapper::SetLightOptions(vtkDSMLightOptions* options)
{
  this->LightOptions = options ? options : vtkSmartPointer<vtkDSMLightOptions>::New().Get();
  this->Modified();
}

void vtkDSMVolumeMapper::SetMemoryOptions(vtkDSMMemoryOptions* options)
{
  this->MemoryOptions = options ? options : vtkSmartPointer<vtkDSMMemoryOptions>::New().Get();
  this->Modified();
}

vtkDSMMemoryOptions* vtkDSMVolumeMapper::GetMemoryOptions() const
{
  return this->MemoryOptions;
}

vtkDSMLightOptions* vtkDSMVolumeMapper::GetLightOptions() const
{
  return this->LightOptions;
}

double* vtkDSMVolumeMapper::GetBounds()
{
  if (const double* known = this->GlobalBounds->Get(this, this->Pieces))
  {
    std::copy_n(known, 6, this->Bounds);
    return this->Bounds;
  }
  vtkDataObject* data = vtkDSMKnownBounds::IsOutOfDate(this) ? nullptr : this->GetDataObjectInput();
  vtkBoundingBox box;
  AddBounds(data, box);
  box.GetBounds(this->Bounds);
  if (!vtkMath::AreBoundsInitialized(this->Bounds) && this->GetNumberOfInputConnections(0) > 0)
  {
    int port = 0;
    vtkAlgorithm* producer = this->GetInputAlgorithm(0, 0, port);
    GetAnnouncedBounds(producer, port, this->Bounds);
  }
  // vtkVolume would make a box of uninitialized bounds.
  return vtkMath::AreBoundsInitialized(this->Bounds) ? this->Bounds : nullptr;
}

void vtkDSMVolumeMapper::SetGlobalBounds(const double bounds[6])
{
  this->GlobalBounds->Set(this, bounds);
  this->InvokeEvent(vtkCommand::UpdateDataEvent);
}

void vtkDSMVolumeMapper::SetSuggestedIsoValue(double value)
{
  this->SuggestedIsoValue = value;
}

void vtkDSMVolumeMapper::SetSuggestedRange(const std::array<double, 2>& range)
{
  std::copy(range.begin(), range.end(), this->SuggestedRange);
}

void vtkDSMVolumeMapper::SetSlicePoints(const std::array<int, 3>& points)
{
  std::copy(points.begin(), points.end(), this->SlicePoints);
}

void vtkDSMVolumeMapper::UpdatePiece(int piece, int numberOfPieces)
{
  if (this->GetNumberOfInputConnections(0) == 0)
  {
    return;
  }
  this->Pieces = numberOfPieces;
  int port = 0;
  vtkAlgorithm* producer = this->GetInputAlgorithm(0, 0, port);
  if (!vtkTrivialProducer::SafeDownCast(producer))
  {
    producer->UpdatePiece(piece, numberOfPieces, 0);
  }
}

void vtkDSMVolumeMapper::Render(vtkRenderer* renderer, vtkVolume*)
{
  if (this->MakesScene)
  {
    vtkDSMScene::DrawWithoutScene(renderer, this);
  }
}

vtkMTimeType vtkDSMVolumeMapper::GetMTime()
{
  vtkMTimeType time = std::max({ this->Superclass::GetMTime(), this->SurfaceProperty->GetMTime(),
    this->LightOptions->GetMTime() });
  if (this->LookupTable)
  {
    time = std::max(time, this->LookupTable->GetMTime());
  }
  if (this->BackfaceProperty)
  {
    time = std::max(time, this->BackfaceProperty->GetMTime());
  }
  if (this->SliceOpacity)
  {
    time = std::max(time, this->SliceOpacity->GetMTime());
  }
  const int planes = this->SlicePlanes ? this->SlicePlanes->GetNumberOfItems() : 0;
  for (int number = 0; number < planes; ++number)
  {
    time = std::max(time, this->SlicePlanes->GetItem(number)->GetMTime());
  }
  return time;
}

void vtkDSMVolumeMapper::ShallowCopy(vtkAbstractMapper* mapper)
{
  this->Superclass::ShallowCopy(mapper);
  if (auto* other = vtkVolumeMapper::SafeDownCast(mapper))
  {
    this->CopyVolumeMapper(other);
  }
  if (auto* other = vtkDSMVolumeMapper::SafeDownCast(mapper))
  {
    static_cast<vtkDSMVolumeSettings&>(*this) = *other;
    *this->Original = *other->Original;
    this->Modified();
  }
}

/// VTK's class does not.
void vtkDSMVolumeMapper::CopyVolumeMapper(vtkVolumeMapper* other)
{
  this->GlobalBounds->Clear();
  this->SetInputConnection(
    other->GetNumberOfInputConnections(0) > 0 ? other->GetInputConnection(0, 0) : nullptr);
  this->SetBlendMode(other->GetBlendMode());
  this->SetAverageIPScalarRange(other->GetAverageIPScalarRange());
  this->SetCropping(other->GetCropping());
  this->SetCroppingRegionPlanes(other->GetCroppingRegionPlanes());
  this->SetCroppingRegionFlags(other->GetCroppingRegionFlags());
  this->SetScalarMode(other->GetScalarMode());
  if (other->GetArrayAccessMode() == VTK_GET_ARRAY_BY_ID)
  {
    this->SelectScalarArray(other->GetArrayId());
  }
  else
  {
    this->SelectScalarArray(other->GetArrayName());
  }
}

bool vtkDSMVolumeMapper::IsVolume(vtkDataObject* data)
{
  return vtkDSMVolumeData::IsVolume(data);
}

int vtkDSMVolumeMapper::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

void vtkDSMVolumeMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
#define vtkDSMPrint(name, type, value) os << indent << #name << ": " << this->name << "\n";
  VTK_DSM_VOLUME_SETTINGS(vtkDSMPrint)
#undef vtkDSMPrint
  os << indent << "IsoValues:";
  for (const double value : this->IsoValues)
  {
    os << " " << value;
  }
  os << "\n";
  os << indent << "SuggestedIsoValue: " << this->SuggestedIsoValue << "\n";
  os << indent << "SuggestedRange: " << this->SuggestedRange[0] << " " << this->SuggestedRange[1]
     << "\n";
  os << indent << "Slices: " << this->Slices.size() << "\n";
  os << indent << "SlicePoints: " << this->SlicePoints[0] << " " << this->SlicePoints[1] << " "
     << this->SlicePoints[2] << "\n";
  os << indent << "BlockLooks: " << this->BlockLooks.size() << "\n";
}
