// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMImageRepresentation.h"

#include "vtkDSMErrorGuard.h"
#include "vtkDSMPolyDataMapper.h"
#include "vtkDSMVolumeMapper.h"
#include "vtkPVDSMBlockPaths.h"
#include "vtkPVDSMFrameReport.h"
#include "vtkPVDSMIsosurfaceGeometry.h"
#include "vtkPVDSMLightOptions.h"
#include "vtkPVDSMMemoryOptions.h"
#include "vtkPVDSMVolumePlaces.h"

#include "vtkActor.h"
#include "vtkAlgorithmOutput.h"
#include "vtkBoundingBox.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataObjectTree.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMatrix4x4.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkObjectFactory.h"
#include "vtkPVLODActor.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkScalarsToColors.h"
#include "vtkVolume.h"

#include <algorithm>

vtkStandardNewMacro(vtkPVDSMImageRepresentation);

vtkPVDSMImageRepresentation::vtkPVDSMImageRepresentation()
{
  this->Volume->SetMapper(this->VolumeMapper);
  this->VolumeMapper->MakesSceneOff(); // on ParaView's client there shall be none
  this->VolumeMapper->AutomaticIsoValueOn();
  this->VolumeMapper->SurfacesOnlyOn();
  this->VolumeMapper->SetSurfaceProperty(this->Property);
  this->Display->PrepareSelection = [this](vtkDSMScene* scene, vtkRenderer*, bool selecting)
  { this->PrepareSelection(scene, selecting); };
  this->ShowVolume();
}

vtkPVDSMImageRepresentation::~vtkPVDSMImageRepresentation() = default;

vtkDSMVolumeDisplayMapper* vtkPVDSMImageRepresentation::GetVolumeMapper() const
{
  return this->VolumeMapper;
}

void vtkPVDSMImageRepresentation::ShowVolume()
{
  this->Display->Show(this->Volume, this->VolumeMapper, "Cutting the volume into bricks");
  this->Display->SelectionMapper->SetCompositeDataDisplayAttributes(nullptr);
}

void vtkPVDSMImageRepresentation::SetShow(int part)
{
  if (part == this->Shown)
  {
    return;
  }
  this->Shown = part;
  if (this->ShowsSurface())
  {
    this->Display->Show(this->Actor, this->GetMapper(), "Cutting the surface into bricks");
    this->Display->SelectionMapper->SetCompositeDataDisplayAttributes(
      this->GetMapper()->GetCompositeDataDisplayAttributes());
    this->TakeInput(nullptr);
  }
  else
  {
    this->ShowVolume();
    this->ReleaseSurface();
  }
  this->MarkModified();
}

void vtkPVDSMImageRepresentation::ReleaseSurface()
{
  this->GetMapper()->SetInputDataObject(nullptr);
  this->GetMapper()->SetOriginalData(nullptr);
  vtkAlgorithmOutput* const input = this->GeometryFilter->GetNumberOfInputConnections(0) > 0
    ? this->GeometryFilter->GetInputConnection(0, 0)
    : nullptr;
  if (input)
  {
    input->GetProducer()->GetOutputDataObject(input->GetIndex())->Initialize();
    this->GeometryFilter->GetOutputDataObject(0)->Initialize();
    this->MultiBlockMaker->GetOutputDataObject(0)->Initialize();
  }
}

/// Isosurfaces need no ghost cells, and get the data as they are.
int vtkPVDSMImageRepresentation::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  this->RequestGhostCellsIfNeeded = this->ShowsSurface();
  return this->Superclass::RequestUpdateExtent(request, input, output);
}

int vtkPVDSMImageRepresentation::RequestData(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  if (this->ShowsSurface())
  {
    this->RestoreSurfaceInput(vtkDataObject::GetData(input[0], 0));
    return this->Superclass::RequestData(request, input, output);
  }
  return vtkDSMErrorGuard::Run(this, "updating", this->GetLogName().c_str(),
    [&]
    {
      this->TakeInput(vtkDataObject::GetData(input[0], 0)); // null without an input
      return this->vtkPVDataRepresentation::RequestData(request, input, output);
    });
}

void vtkPVDSMImageRepresentation::RestoreSurfaceInput(vtkDataObject* data)
{
  vtkAlgorithmOutput* const port = data ? this->GetInternalOutputPort() : nullptr;
  vtkDataObject* const copy =
    port ? port->GetProducer()->GetOutputDataObject(port->GetIndex()) : nullptr;
  if (copy && copy->IsA(data->GetClassName()))
  {
    copy->ShallowCopy(data);
  }
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
    vtkPVDSMBlockPaths::NumberBlocks(data, this->BlockColorsDistinctValues);
  }
  this->VolumeMapper->SetInputData(this->ChooseVolumes(data));
  this->VolumeMapper->SetOriginalData(source);
  this->BlockLooksAreOld = true;
  this->Display->NoteUpdate();
}

vtkSmartPointer<vtkDataObject> vtkPVDSMImageRepresentation::ChooseVolumes(vtkDataObject* shown)
{
  return shown;
}

vtkDataObject* vtkPVDSMImageRepresentation::GetRenderedDataObject(int port)
{
  return this->ShowsSurface() ? this->Superclass::GetRenderedDataObject(port)
                              : this->VolumeMapper->GetInputDataObject(0, 0);
}

void vtkPVDSMImageRepresentation::RemoveHiddenBlocks(vtkDataObject* data) const
{
  auto* tree = vtkDataObjectTree::SafeDownCast(data);
  const vtkPVDSMBlockPaths paths(this->ShownBlocks.empty() ? nullptr : tree);
  if (!paths.Any() || paths.AreOfAmr())
  {
    return; // ChooseBlockLooks hides levels of AMR
  }
  const std::vector<unsigned int> shown = paths.Find(this->ShownBlocks);
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
  this->Superclass::AddBlockSelector(selector);
  this->ShownBlocks.emplace_back(selector);
  this->MarkModified();
}

void vtkPVDSMImageRepresentation::RemoveAllBlockSelectors()
{
  this->Superclass::RemoveAllBlockSelectors();
  this->ShownBlocks.clear();
  this->MarkModified();
}

void vtkPVDSMImageRepresentation::SetBlockColor(const char* selector, double r, double g, double b)
{
  this->Superclass::SetBlockColor(selector, r, g, b);
  this->ColorsOfBlocks.push_back({ selector, { r, g, b } });
  this->BlockLooksAreOld = true;
}

void vtkPVDSMImageRepresentation::RemoveAllBlockColors()
{
  this->Superclass::RemoveAllBlockColors();
  this->ColorsOfBlocks.clear();
  this->BlockLooksAreOld = true;
}

void vtkPVDSMImageRepresentation::SetBlockOpacity(const char* selector, double opacity)
{
  this->Superclass::SetBlockOpacity(selector, opacity);
  this->OpacitiesOfBlocks.emplace_back(selector, opacity);
  this->BlockLooksAreOld = true;
}

void vtkPVDSMImageRepresentation::RemoveAllBlockOpacities()
{
  this->Superclass::RemoveAllBlockOpacities();
  this->OpacitiesOfBlocks.clear();
  this->BlockLooksAreOld = true;
}

void vtkPVDSMImageRepresentation::SetBlockColorsDistinctValues(int number)
{
  this->BlockColorsDistinctValues = std::max(number, 1);
  this->Superclass::SetBlockColorsDistinctValues(this->BlockColorsDistinctValues);
}

void vtkPVDSMImageRepresentation::ChooseBlockLooks()
{
  this->BlockLooksAreOld = false;
  this->VolumeMapper->RemoveBlockLooks();
  vtkDataObject* data = this->VolumeMapper->GetInputDataObject(0, 0);
  if (data && !this->BlockArray.empty())
  {
    this->ColorBlocksByArray(data);
  }
  const bool mayHideLevels = !this->ShownBlocks.empty() && data && data->IsA("vtkUniformGridAMR");
  const bool areChosen =
    mayHideLevels || !this->ColorsOfBlocks.empty() || !this->OpacitiesOfBlocks.empty();
  const vtkPVDSMBlockPaths paths(areChosen ? data : nullptr);
  if (!paths.Any())
  {
    return;
  }
  for (const unsigned int block : paths.FindHiddenOfAmr(this->ShownBlocks))
  {
    this->VolumeMapper->SetBlockVisibility(block, false);
  }
  for (const auto& [selector, color] : this->ColorsOfBlocks)
  {
    for (const unsigned int block : paths.Find({ selector }))
    {
      this->VolumeMapper->SetBlockColor(block, color[0], color[1], color[2]);
    }
  }
  for (const auto& [selector, opacity] : this->OpacitiesOfBlocks)
  {
    for (const unsigned int block : paths.Find({ selector }))
    {
      this->VolumeMapper->SetBlockOpacity(block, opacity);
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
      this->VolumeMapper->SetBlockValue(block, array->GetComponent(0, 0));
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

vtkBoundingBox vtkPVDSMImageRepresentation::GetShownBounds()
{
  if (this->ShowsSurface())
  {
    return this->Superclass::GetShownBounds();
  }
  const double* const bounds = this->VolumeMapper->GetBounds(); // null where nothing is known
  return bounds ? vtkBoundingBox(bounds) : vtkBoundingBox();
}

void vtkPVDSMImageRepresentation::PrepareUpdate(vtkInformation* inInfo, vtkInformation* outInfo)
{
  if (!this->ShowsSurface())
  {
    this->ChooseLook();
    if (this->BlockLooksAreOld)
    {
      this->ChooseBlockLooks();
    }
  }
  this->Superclass::PrepareUpdate(inInfo, outInfo);
}

void vtkPVDSMImageRepresentation::PrepareRender(vtkInformation* inInfo)
{
  if (this->ShowsSurface())
  {
    this->Superclass::PrepareRender(inInfo);
    return;
  }
  this->ChooseLook();
  if (this->VolumeMapper->GetSlicing())
  {
    this->Slicing.ApplyTo(this->VolumeMapper);
  }
  double bounds[6];
  this->GetShownBounds().GetBounds(bounds);
  this->Display->PrepareRender(bounds, inInfo);
}

vtkSmartPointer<vtkDataObject> vtkPVDSMImageRepresentation::MakeSelectable()
{
  if (this->ShowsSurface())
  {
    return this->Superclass::MakeSelectable();
  }
  if (!this->Places)
  {
    return this->Selectable;
  }
  vtkDataObject* const data = this->FindInput();
  this->Volume->ComputeMatrix();
  return this->Places->MakePoints(
    data ? data : this->VolumeMapper->GetDataObjectInput(), this->Volume->GetMatrix());
}

vtkDataObject* vtkPVDSMImageRepresentation::FindInput()
{
  return this->GetNumberOfInputConnections(0) > 0 ? this->GetInputDataObject(0, 0) : nullptr;
}

/// Once for all passes of a selection.
void vtkPVDSMImageRepresentation::PrepareSelection(vtkDSMScene* scene, bool selecting)
{
  if (!selecting || this->ShowsSurface())
  {
    this->Selectable = nullptr;
  }
  else if (!this->Selectable)
  {
    this->Selectable =
      vtkPVDSMIsosurfaceGeometry::Make(scene, this->VolumeMapper, this->FindInput());
  }
}

void vtkPVDSMImageRepresentation::SetExportLook(vtkActor* actor, vtkMapper* mapper)
{
  if (this->ShowsSurface())
  {
    this->Superclass::SetExportLook(actor, mapper);
    return;
  }
  actor->SetProperty(this->VolumeMapper->GetSurfaceProperty());
  mapper->SetLookupTable(this->VolumeMapper->GetLookupTable());
  mapper->UseLookupTableScalarRangeOn();
  mapper->SetScalarVisibility(this->VolumeMapper->GetScalarVisibility());
  const char* const colors = this->VolumeMapper->GetColorArray().c_str();
  auto* const triangles = vtkPolyData::SafeDownCast(mapper->GetInputDataObject(0, 0));
  const bool onCells = triangles && triangles->GetCellData()->HasArray(colors);
  mapper->SetScalarMode(
    onCells ? VTK_SCALAR_MODE_USE_CELL_FIELD_DATA : VTK_SCALAR_MODE_USE_POINT_FIELD_DATA);
  mapper->SelectColorArray(colors);
  mapper->SetColorMode(this->VolumeMapper->GetMapScalars() ? VTK_COLOR_MODE_MAP_SCALARS
                                                           : VTK_COLOR_MODE_DIRECT_SCALARS);
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

bool vtkPVDSMImageRepresentation::IsTranslucent()
{
  if (this->ShowsSurface())
  {
    return this->Superclass::IsTranslucent();
  }
  const bool isColored = this->VolumeMapper->GetScalarVisibility();
  const bool isMapped = isColored || this->VolumeMapper->GetBlockScalarVisibility();
  // Colors that are taken as they are may have an opacity on another rank.
  vtkProperty* const front = this->VolumeMapper->GetSurfaceProperty();
  vtkProperty* const back = this->VolumeMapper->GetBackfaceProperty();
  return front->GetOpacity() < 1.0 || front->GetBackfaceCulling() || front->GetFrontfaceCulling() ||
    (back && back->GetOpacity() < 1.0) || (isColored && !this->VolumeMapper->GetMapScalars()) ||
    (isMapped && vtkPVDSMTracedDisplay::HasOpacity(this->VolumeMapper->GetLookupTable())) ||
    std::any_of(this->OpacitiesOfBlocks.begin(), this->OpacitiesOfBlocks.end(),
      [](const auto& block) { return block.second < 1.0; });
}

void vtkPVDSMImageRepresentation::SetVisibility(bool visible)
{
  this->Superclass::SetVisibility(visible);
  if (!this->ShowsSurface())
  {
    this->Actor->VisibilityOff();
    this->BackfaceActor->VisibilityOff();
  }
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
    this->VolumeMapper->SetBlockScalarVisibility(!this->BlockArray.empty());
    this->VolumeMapper->SetColorArray(isOfPlaces && name ? name : "");
    this->VolumeMapper->SetColorArrayOnCells(association == vtkDataObject::FIELD_ASSOCIATION_CELLS);
    this->VolumeMapper->SetScalarVisibility(isOfPlaces && name && name[0]);
  }
}

void vtkPVDSMImageRepresentation::SelectIsoArray(int, int, int, int association, const char* name)
{
  this->VolumeMapper->SetIsoArray(name ? name : "");
  this->VolumeMapper->SetIsoArrayOnCells(association == vtkDataObject::FIELD_ASSOCIATION_CELLS);
}

void vtkPVDSMImageRepresentation::SetIsoComponent(int component)
{
  this->VolumeMapper->SetIsoComponent(component);
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
  this->VolumeMapper->SetNumberOfIsoValues(number);
  for (int index = 0; index < number; ++index)
  {
    this->VolumeMapper->SetIsoValue(index, shown[index]);
  }
}

void vtkPVDSMImageRepresentation::SetLookupTable(vtkScalarsToColors* table)
{
  this->Superclass::SetLookupTable(table);
  this->VolumeMapper->SetLookupTable(table);
}

void vtkPVDSMImageRepresentation::SetMapScalars(int map)
{
  this->Superclass::SetMapScalars(map);
  this->VolumeMapper->SetMapScalars(map != 0);
}

void vtkPVDSMImageRepresentation::ChooseLook()
{
  vtkProperty* const front = this->VolumeMapper->GetSurfaceProperty();
  vtkProperty* const back = this->BackfaceProperty;
  front->SetAmbient(this->Ambient);
  front->SetDiffuse(this->Diffuse);
  front->SetSpecular(this->Specular);
  back->SetAmbient(front->GetAmbient());
  back->SetDiffuse(front->GetDiffuse());
  back->SetSpecular(front->GetSpecular());
  back->SetSpecularColor(front->GetSpecularColor());
  back->SetSpecularPower(front->GetSpecularPower());
  front->SetBackfaceCulling(this->BackfaceRepresentation == CULL_BACKFACE);
  front->SetFrontfaceCulling(this->BackfaceRepresentation == CULL_FRONTFACE);
  const bool isOwn =
    this->BackfaceRepresentation >= VTK_POINTS && this->BackfaceRepresentation < FOLLOW_FRONTFACE;
  this->VolumeMapper->SetBackfaceProperty(isOwn ? back : nullptr);
}

void vtkPVDSMImageRepresentation::SetPosition(double x, double y, double z)
{
  this->Superclass::SetPosition(x, y, z);
  this->Volume->SetPosition(x, y, z);
}

void vtkPVDSMImageRepresentation::SetOrientation(double x, double y, double z)
{
  this->Superclass::SetOrientation(x, y, z);
  this->Volume->SetOrientation(x, y, z);
}

void vtkPVDSMImageRepresentation::SetOrigin(double x, double y, double z)
{
  this->Superclass::SetOrigin(x, y, z);
  this->Volume->SetOrigin(x, y, z);
}

void vtkPVDSMImageRepresentation::SetScale(double x, double y, double z)
{
  this->Superclass::SetScale(x, y, z);
  this->Volume->SetScale(x, y, z);
}

void vtkPVDSMImageRepresentation::SetUserTransform(const double matrix[16])
{
  this->Superclass::SetUserTransform(matrix);
  vtkNew<vtkMatrix4x4> transform;
  transform->DeepCopy(matrix);
  this->Volume->SetUserMatrix(transform);
}

std::vector<vtkSmartPointer<vtkPolyData>> vtkPVDSMImageRepresentation::GetTriangles()
{
  if (this->ShowsSurface())
  {
    return this->Superclass::GetTriangles();
  }
  vtkDSMScene* const scene = this->Display->GetScene();
  if (!scene)
  {
    return {};
  }
  return vtkPVDSMIsosurfaceGeometry::MakeColored(scene, this->VolumeMapper);
}

void vtkPVDSMImageRepresentation::SetLightOptions(vtkPVDSMLightOptions* options)
{
  this->Superclass::SetLightOptions(options);
  this->VolumeMapper->SetLightOptions(options);
}

void vtkPVDSMImageRepresentation::SetMemoryOptions(vtkPVDSMMemoryOptions* options)
{
  this->Superclass::SetMemoryOptions(options);
  this->VolumeMapper->SetMemoryOptions(options);
}

void vtkPVDSMImageRepresentation::SetFrameReport(vtkPVDSMFrameReport* report)
{
  this->Superclass::SetFrameReport(report);
  if (report)
  {
    report->SetVolume(this->VolumeMapper);
  }
}

void vtkPVDSMImageRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Shown: " << this->Shown << "\n";
  os << indent << "VolumeMapper:\n";
  this->VolumeMapper->PrintSelf(os, indent.GetNextIndent());
}
