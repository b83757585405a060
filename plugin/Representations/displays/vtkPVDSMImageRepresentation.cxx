// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMImageRepresentation.h"

#include "vtkDSMErrorGuard.h"
#include "vtkDSMVolumeMapper.h"
#include "vtkPVDSMFrameReport.h"
#include "vtkPVDSMIsosurfaceGeometry.h"
#include "vtkPVDSMLightOptions.h"
#include "vtkPVDSMMemoryOptions.h"
#include "vtkPVDSMVolumePlaces.h"

#include "vtkActor.h"
#include "vtkCompositeDataIterator.h"
#include "vtkDataArray.h"
#include "vtkDataAssembly.h"
#include "vtkDataAssemblyUtilities.h"
#include "vtkDataObject.h"
#include "vtkDataObjectTree.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMatrix4x4.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkObjectFactory.h"
#include "vtkPVRenderView.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkScalarsToColors.h"
#include "vtkUnsignedIntArray.h"
#include "vtkVolume.h"

#include <algorithm>

namespace
{

/// Finds a dataset's blocks by the paths that ParaView's Multiblock Inspector names them by.
class BlockPaths
{
public:
  explicit BlockPaths(vtkDataObjectTree* tree)
    : Tree(tree)
    , IsKnown(tree && vtkDataAssemblyUtilities::GenerateHierarchy(tree, this->Assembly))
  {
  }
  /// Returns whether there are blocks with paths.
  bool Any() const { return this->IsKnown; }
  std::vector<unsigned int> Find(const std::vector<std::string>& paths) const
  {
    return vtkDataAssemblyUtilities::GetSelectedCompositeIds(
      paths, this->Assembly, vtkPartitionedDataSetCollection::SafeDownCast(this->Tree), true);
  }

private:
  vtkDataObjectTree* Tree;
  vtkNew<vtkDataAssembly> Assembly;
  bool IsKnown;
};

/// Gives each block the number that a Surface gives it, in ParaView's array vtkBlockColors; so many numbers take turns.
void NumberBlocks(vtkDataObjectTree* tree, unsigned int distinctNumbers)
{
  const auto add = [distinctNumbers](vtkDataObject* image, unsigned int number)
  {
    if (!image || image->GetFieldData()->HasArray("vtkBlockColors"))
    {
      return;
    }
    vtkNew<vtkUnsignedIntArray> array;
    array->SetName("vtkBlockColors");
    array->InsertNextValue(number % distinctNumbers);
    image->GetFieldData()->AddArray(array);
  };
  // As ParaView counts: leaves, also empty ones; but all parts of a partitioned dataset in a collection are one.
  if (auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(tree))
  {
    for (unsigned int set = 0; set < collection->GetNumberOfPartitionedDataSets(); ++set)
    {
      for (unsigned int part = 0; part < collection->GetNumberOfPartitions(set); ++part)
      {
        add(collection->GetPartitionAsDataObject(set, part), set);
      }
    }
    return;
  }
  vtkSmartPointer<vtkCompositeDataIterator> leaf;
  leaf.TakeReference(tree->NewIterator());
  leaf->SkipEmptyNodesOff();
  unsigned int number = 0;
  for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
  {
    add(leaf->GetCurrentDataObject(), number++);
  }
}

} // namespace

vtkStandardNewMacro(vtkPVDSMImageRepresentation);

vtkPVDSMImageRepresentation::vtkPVDSMImageRepresentation()
  : Display(std::make_unique<vtkPVDSMTracedDisplay>(
      this, this->Volume, this->Mapper, "Cutting the volume into bricks"))
{
  this->Volume->SetMapper(this->Mapper);
  this->Mapper->MakesSceneOff(); // on ParaView's client there shall be none
  this->Mapper->AutomaticIsoValueOn();
  this->Mapper->SurfacesOnlyOn();
  this->Display->SelectionMapper->SetSource(
    [this]() -> vtkSmartPointer<vtkDataObject>
    {
      const bool hasInput = this->GetNumberOfInputConnections(0) > 0;
      return this->MakeSelectable(hasInput ? this->GetInputDataObject(0, 0) : nullptr);
    });
  this->Display->SetLook = [this](vtkActor* actor, vtkMapper* mapper)
  {
    actor->SetProperty(this->Mapper->GetSurfaceProperty());
    mapper->SetLookupTable(this->Mapper->GetLookupTable());
    mapper->UseLookupTableScalarRangeOn();
    mapper->SetScalarVisibility(this->Mapper->GetScalarVisibility());
    mapper->SetScalarMode(this->Mapper->GetColorArrayOnCells()
        ? VTK_SCALAR_MODE_USE_CELL_FIELD_DATA
        : VTK_SCALAR_MODE_USE_POINT_FIELD_DATA);
    mapper->SelectColorArray(this->Mapper->GetColorArray().c_str());
    mapper->SetColorMode(
      this->Mapper->GetMapScalars() ? VTK_COLOR_MODE_MAP_SCALARS : VTK_COLOR_MODE_DIRECT_SCALARS);
  };
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
  return vtkDSMErrorGuard::Run(this, "updating", this->GetLogName().c_str(),
    [&]
    {
      this->TakeInput(vtkDataObject::GetData(input[0], 0)); // null without an input
      return this->Superclass::RequestData(request, input, output);
    });
}

void vtkPVDSMImageRepresentation::TakeInput(vtkDataObject* source)
{
  vtkSmartPointer<vtkDataObject> data;
  if (source)
  {
    // A copy of the structure only: the source may go on to its next time step while this one is
    // still shown.
    data.TakeReference(source->NewInstance());
    data->ShallowCopy(source);
    this->RemoveHiddenBlocks(data);
    if (auto* tree = vtkDataObjectTree::SafeDownCast(data))
    {
      NumberBlocks(tree, this->BlockColorsDistinctValues);
    }
  }
  this->Mapper->SetInputData(data);
  this->Mapper->SetOriginalData(source);
  this->BlockLooksAreOld = true;
  this->Display->NoteUpdate();
}

vtkDataObject* vtkPVDSMImageRepresentation::GetRenderedDataObject(int)
{
  return this->Mapper->GetInputDataObject(0, 0);
}

void vtkPVDSMImageRepresentation::RemoveHiddenBlocks(vtkDataObject* data) const
{
  auto* tree = vtkDataObjectTree::SafeDownCast(data);
  const BlockPaths paths(this->BlockSelectors.empty() ? nullptr : tree);
  if (!paths.Any())
  {
    return;
  }
  const std::vector<unsigned int> shown = paths.Find(this->BlockSelectors);
  vtkSmartPointer<vtkCompositeDataIterator> leaf;
  leaf.TakeReference(tree->NewIterator());
  for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
  {
    if (std::find(shown.begin(), shown.end(), leaf->GetCurrentFlatIndex()) == shown.end())
    {
      tree->SetDataSet(leaf, nullptr);
    }
  }
}

void vtkPVDSMImageRepresentation::AddBlockSelector(const char* selector)
{
  this->BlockSelectors.emplace_back(selector);
  this->MarkModified();
}

void vtkPVDSMImageRepresentation::RemoveAllBlockSelectors()
{
  this->BlockSelectors.clear();
  this->MarkModified();
}

void vtkPVDSMImageRepresentation::SetBlockColor(const char* selector, double r, double g, double b)
{
  this->BlockColors.push_back({ selector, { r, g, b } });
  this->BlockLooksAreOld = true;
}

void vtkPVDSMImageRepresentation::RemoveAllBlockColors()
{
  this->BlockColors.clear();
  this->BlockLooksAreOld = true;
}

void vtkPVDSMImageRepresentation::SetBlockOpacity(const char* selector, double opacity)
{
  this->BlockOpacities.emplace_back(selector, opacity);
  this->BlockLooksAreOld = true;
}

void vtkPVDSMImageRepresentation::RemoveAllBlockOpacities()
{
  this->BlockOpacities.clear();
  this->BlockLooksAreOld = true;
}

void vtkPVDSMImageRepresentation::SetBlockColorsDistinctValues(int number)
{
  this->BlockColorsDistinctValues = std::max(number, 1);
  this->MarkModified();
}

void vtkPVDSMImageRepresentation::ChooseBlockLooks()
{
  this->BlockLooksAreOld = false;
  this->Mapper->RemoveBlockLooks();
  vtkDataObject* data = this->Mapper->GetInputDataObject(0, 0);
  if (data && !this->BlockArray.empty())
  {
    this->ColorBlocksByArray(data);
  }
  const bool areChosen = !this->BlockColors.empty() || !this->BlockOpacities.empty();
  const BlockPaths paths(areChosen ? vtkDataObjectTree::SafeDownCast(data) : nullptr);
  if (!paths.Any())
  {
    return;
  }
  for (const auto& [selector, color] : this->BlockColors)
  {
    for (const unsigned int block : paths.Find({ selector }))
    {
      this->Mapper->SetBlockColor(block, color[0], color[1], color[2]);
    }
  }
  for (const auto& [selector, opacity] : this->BlockOpacities)
  {
    for (const unsigned int block : paths.Find({ selector }))
    {
      this->Mapper->SetBlockOpacity(block, opacity);
    }
  }
}

void vtkPVDSMImageRepresentation::ColorBlocksByArray(vtkDataObject* data)
{
  const auto add = [this](vtkDataObject* image, unsigned int block)
  {
    vtkDataArray* array = image->GetFieldData()->GetArray(this->BlockArray.c_str());
    if (array && array->GetNumberOfTuples() > 0)
    {
      this->Mapper->SetBlockValue(block, array->GetComponent(0, 0));
    }
  };
  auto* tree = vtkDataObjectTree::SafeDownCast(data);
  if (!tree)
  {
    add(data, 0);
    return;
  }
  vtkSmartPointer<vtkCompositeDataIterator> leaf;
  leaf.TakeReference(tree->NewIterator());
  for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
  {
    add(leaf->GetCurrentDataObject(), leaf->GetCurrentFlatIndex());
  }
}

int vtkPVDSMImageRepresentation::ProcessViewRequest(
  vtkInformationRequestKey* request, vtkInformation* inInfo, vtkInformation* outInfo)
{
  return vtkDSMErrorGuard::Run(this, "preparing", this->GetLogName().c_str(),
    [&] { return this->Process(request, inInfo, outInfo); });
}

int vtkPVDSMImageRepresentation::Process(
  vtkInformationRequestKey* request, vtkInformation* inInfo, vtkInformation* outInfo)
{
  if (!this->Display->Process(request, inInfo, outInfo))
  {
    return 0;
  }
  this->ChooseBackfaces();
  if (this->Mapper->GetSlicing())
  {
    this->Slicing.ApplyTo(this->Mapper);
  }
  if (request == vtkPVView::REQUEST_UPDATE())
  {
    if (this->BlockLooksAreOld)
    {
      this->ChooseBlockLooks();
    }
    this->Display->KeepData(this->Volume->GetBounds(), this->IsTranslucent(),
      this->Mapper->GetInputDataObject(0, 0), inInfo, outInfo);
  }
  else if (request == vtkPVView::REQUEST_RENDER())
  {
    this->Display->PrepareRender(this->Mapper->GetBounds(), inInfo);
  }
  return 1;
}

vtkSmartPointer<vtkDataObject> vtkPVDSMImageRepresentation::MakeSelectable(vtkDataObject* data)
{
  if (!this->Places)
  {
    return vtkPVDSMIsosurfaceGeometry::Make(this->Mapper, data);
  }
  this->Volume->ComputeMatrix();
  return this->Places->MakePoints(
    data ? data : this->Mapper->GetDataObjectInput(), this->Volume->GetMatrix());
}

void vtkPVDSMImageRepresentation::SelectByPlaces()
{
  this->Places = std::make_unique<vtkPVDSMVolumePlaces>();
  this->Display->PrepareSelection = [this](
                                      vtkDSMScene* scene, vtkRenderer* renderer, bool selecting)
  {
    if (selecting)
    {
      this->Places->Find(scene, renderer);
    }
    else
    {
      this->Places->Forget();
    }
  };
}

bool vtkPVDSMImageRepresentation::IsTranslucent() const
{
  const bool isColored = this->Mapper->GetScalarVisibility();
  const bool isMapped = isColored || this->Mapper->GetBlockScalarVisibility();
  // Colors that are taken as they are may have an opacity on another rank.
  vtkProperty* const front = this->Mapper->GetSurfaceProperty();
  vtkProperty* const back = this->Mapper->GetBackfaceProperty();
  return front->GetOpacity() < 1.0 || front->GetBackfaceCulling() || front->GetFrontfaceCulling() ||
    (back && back->GetOpacity() < 1.0) || (isColored && !this->Mapper->GetMapScalars()) ||
    (isMapped && vtkPVDSMTracedDisplay::HasOpacity(this->Mapper->GetLookupTable())) ||
    std::any_of(this->BlockOpacities.begin(), this->BlockOpacities.end(),
      [](const auto& block) { return block.second < 1.0; });
}

bool vtkPVDSMImageRepresentation::AddToView(vtkView* view)
{
  return this->Display->AddToView(view) && this->Superclass::AddToView(view);
}

bool vtkPVDSMImageRepresentation::RemoveFromView(vtkView* view)
{
  return this->Display->RemoveFromView(view) && this->Superclass::RemoveFromView(view);
}

void vtkPVDSMImageRepresentation::SetVisibility(bool visible)
{
  this->Superclass::SetVisibility(visible);
  this->Display->SetVisibility(visible);
}

void vtkPVDSMImageRepresentation::SetInputArrayToProcess(
  int index, int port, int connection, int association, const char* name)
{
  this->Superclass::SetInputArrayToProcess(index, port, connection, association, name);
  if (index == 0)
  {
    const bool isOfPlaces = association != vtkDataObject::FIELD_ASSOCIATION_NONE;
    this->BlockArray = isOfPlaces || !name ? "" : name;
    this->BlockLooksAreOld = true;
    this->Mapper->SetBlockScalarVisibility(!this->BlockArray.empty());
    this->Mapper->SetColorArray(isOfPlaces && name ? name : "");
    this->Mapper->SetColorArrayOnCells(association == vtkDataObject::FIELD_ASSOCIATION_CELLS);
    this->Mapper->SetScalarVisibility(isOfPlaces && name && name[0]);
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

void vtkPVDSMImageRepresentation::SetAutomaticIsoValue(bool automatic)
{
  this->AutomaticIsoValue = automatic;
  this->ChooseIsoValues();
}

void vtkPVDSMImageRepresentation::ChooseIsoValues()
{
  std::vector<double> shown = this->IsoValues;
  if (shown.empty() && !this->AutomaticIsoValue)
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

void vtkPVDSMImageRepresentation::SetCap(bool cap)
{
  this->Mapper->SetCapping(cap);
}

void vtkPVDSMImageRepresentation::SetCapSide(int side)
{
  this->Mapper->SetCapSide(side);
}

void vtkPVDSMImageRepresentation::SetCapOpacityFromMap(bool fromMap)
{
  this->Mapper->SetCapOpacity(fromMap);
}

void vtkPVDSMImageRepresentation::SetLookupTable(vtkScalarsToColors* table)
{
  this->Mapper->SetLookupTable(table);
}

void vtkPVDSMImageRepresentation::SetMapScalars(bool map)
{
  this->Mapper->SetMapScalars(map);
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

void vtkPVDSMImageRepresentation::SetInterpolation(int value)
{
  this->Mapper->GetSurfaceProperty()->SetInterpolation(value);
}

void vtkPVDSMImageRepresentation::SetBackfaceRepresentation(int representation)
{
  this->BackfaceRepresentation = representation;
}

void vtkPVDSMImageRepresentation::SetBackfaceAmbientColor(double r, double g, double b)
{
  this->BackfaceProperty->SetAmbientColor(r, g, b);
}

void vtkPVDSMImageRepresentation::SetBackfaceDiffuseColor(double r, double g, double b)
{
  this->BackfaceProperty->SetDiffuseColor(r, g, b);
}

void vtkPVDSMImageRepresentation::SetBackfaceOpacity(double value)
{
  this->BackfaceProperty->SetOpacity(value);
}

void vtkPVDSMImageRepresentation::ChooseBackfaces()
{
  using Faces = vtkGeometryRepresentationWithFaces;
  vtkProperty* const front = this->Mapper->GetSurfaceProperty();
  vtkProperty* const back = this->BackfaceProperty;
  back->SetAmbient(front->GetAmbient());
  back->SetDiffuse(front->GetDiffuse());
  back->SetSpecular(front->GetSpecular());
  back->SetSpecularColor(front->GetSpecularColor());
  back->SetSpecularPower(front->GetSpecularPower());
  front->SetBackfaceCulling(this->BackfaceRepresentation == Faces::CULL_BACKFACE);
  front->SetFrontfaceCulling(this->BackfaceRepresentation == Faces::CULL_FRONTFACE);
  const bool isOwn = this->BackfaceRepresentation >= VTK_POINTS &&
    this->BackfaceRepresentation < Faces::FOLLOW_FRONTFACE;
  this->Mapper->SetBackfaceProperty(isOwn ? back : nullptr);
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

std::vector<vtkSmartPointer<vtkPolyData>> vtkPVDSMImageRepresentation::GetTriangles()
{
  return vtkPVDSMIsosurfaceGeometry::MakeColored(this->Mapper);
}

void vtkPVDSMImageRepresentation::SetLightOptions(vtkPVDSMLightOptions* options)
{
  this->Mapper->SetLightOptions(options);
  this->Display->SetLightOptions(options);
}

void vtkPVDSMImageRepresentation::SetMemoryOptions(vtkPVDSMMemoryOptions* options)
{
  this->Mapper->SetMemoryOptions(options);
  this->Display->SetMemoryOptions(options);
}

void vtkPVDSMImageRepresentation::SetFrameReport(vtkPVDSMFrameReport* report)
{
  this->Display->SetFrameReport(report);
  if (report)
  {
    report->SetVolume(this->Mapper);
  }
}

void vtkPVDSMImageRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Mapper:\n";
  this->Mapper->PrintSelf(os, indent.GetNextIndent());
}
