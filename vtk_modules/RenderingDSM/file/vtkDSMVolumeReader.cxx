// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMVolumeReader.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/Url.h"
#include "DSMVolumeFiles/cache/ChunkCache.h"
#include "DSMVolumeFiles/open/OpenVolumeFile.h"
#include "vtkDSMErrorGuard.h"
#include "vtkDSMFileArray.h"
#include "vtkDSMScalarType.h"

#include "vtkCallbackCommand.h"
#include "vtkCellData.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkDataArraySelection.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkExecutive.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkOutputWindow.h"
#include "vtkPointData.h"
#include "vtkRectilinearGrid.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <climits>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

namespace
{

/// Nothing can be asked for. A pipeline adds up the extents that are asked of it until they have come, here and behind
/// all filters: what is refused must not be asked for again with what comes next, which may be smaller.
void OfferNothing(vtkInformation* information)
{
  const int none[6] = { 0, -1, 0, -1, 0, -1 };
  information->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), none, 6);
}

/// The executive says of each failed request that it failed, with addresses: what failed is reported already.
void Silence(vtkExecutive* executive)
{
  if (executive->HasObserver(vtkCommand::ErrorEvent))
  {
    return;
  }
  vtkNew<vtkCallbackCommand> command;
  command->SetCallback(
    [](vtkObject*, unsigned long, void*, void* text)
    {
      const auto* const message = static_cast<const char*>(text);
      if (message && !std::strstr(message, "returned failure for request"))
      {
        vtkOutputWindowDisplayErrorText(message);
      }
    });
  executive->AddObserver(vtkCommand::ErrorEvent, command);
}

/// Returns whether all of the data are requested, by this rank or by several ranks that each have a
/// part.
bool IsShare(vtkInformation* information)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  const int* const whole = information->Get(Pipeline::WHOLE_EXTENT());
  const int* const wanted = information->Has(vtkDataObject::ALL_PIECES_EXTENT())
    ? information->Get(vtkDataObject::ALL_PIECES_EXTENT())
    : information->Get(Pipeline::UPDATE_EXTENT());
  return whole && wanted && std::equal(whole, whole + 6, wanted);
}

/// Throws dsm::Error where the points' indices do not fit VTK's.
void CheckExtent(const vol::VolumeFile& file)
{
  const vol::FileGeometry& geometry = file.GetGeometry();
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::int64_t first = geometry.First[axis];
    const std::int64_t points = geometry.Points[axis];
    // The code also computes the index after the last point.
    if (first < INT_MIN || first > INT_MAX || points < 1 || points > INT_MAX ||
      first + points > INT_MAX)
    {
      throw dsm::Error("'" + file.GetPath() + "' has " + std::to_string(points) +
        " points from index " + std::to_string(first) + " along the " + "xyz"[axis] +
        " axis; VTK supports indices from " + std::to_string(INT_MIN) + " to " +
        std::to_string(INT_MAX - 1) + ".");
    }
  }
}

} // namespace

vtkStandardNewMacro(vtkDSMVolumeReader);

class vtkDSMVolumeReader::Internals
{
public:
  std::shared_ptr<const vol::VolumeFile> File;
  vol::OpenOptions Options;  ///< with which it was opened
  vtkMTimeType OpenedAt = 0; ///< the reader's time then

  std::string Told; ///< the last error
  vtkMTimeType ToldAt = 0;

  std::string LevelNames;
  vtkMTimeType LevelNamesAt = 0;

  int LastStep = vtkDSMFileValues::None; ///< that was asked for
  int Stride = 0;                        ///< from the one before

  /// Called when a step is requested. Returns the next step if time continues as before; None before the second
  /// step.
  int Advance(int step)
  {
    const bool isKnown = this->LastStep != vtkDSMFileValues::None;
    this->Stride = isKnown && step != this->LastStep ? step - this->LastStep : this->Stride;
    this->LastStep = step;
    const int next = step + this->Stride;
    return this->Stride != 0 && next >= 0 && next < this->File->GetSteps() ? next
                                                                           : vtkDSMFileValues::None;
  }

  /// The last one that has begun, but for rounding.
  int FindStep(double time) const
  {
    int step = 0;
    while (step + 1 < this->File->GetSteps())
    {
      const double next = this->File->GetTime(step + 1);
      if (next - time > 1e-6 * (next - this->File->GetTime(step)))
      {
        break;
      }
      ++step;
    }
    return step;
  }
};

vtkDSMVolumeReader::vtkDSMVolumeReader()
  : RawScalarType(VTK_UNSIGNED_CHAR)
  , Self(std::make_unique<Internals>())
{
  this->SetNumberOfInputPorts(0);
  for (vtkDataArraySelection* arrays : { this->PointArrays.Get(), this->CellArrays.Get() })
  {
    arrays->AddObserver(vtkCommand::ModifiedEvent, this, &vtkDSMVolumeReader::Modified);
  }
}

vtkDSMVolumeReader::~vtkDSMVolumeReader() = default;

void vtkDSMVolumeReader::SetFileName(const char* name)
{
  const std::string wanted = name ? name : "";
  if (this->FileNames.size() != 1 || wanted != this->FileNames.front())
  {
    this->RemoveAllFileNames();
    this->AddFileName(name);
  }
}

void vtkDSMVolumeReader::AddFileName(const char* name)
{
  if (!name || !*name)
  {
    return;
  }
  this->FileNames.emplace_back(name);
  this->Modified();
}

void vtkDSMVolumeReader::RemoveAllFileNames()
{
  this->FileNames.clear();
  this->Modified();
}

int vtkDSMVolumeReader::GetNumberOfFileNames() const
{
  return static_cast<int>(this->FileNames.size());
}

const char* vtkDSMVolumeReader::GetFileName() const
{
  return this->FileNames.empty() ? "" : this->FileNames.front().c_str();
}

int vtkDSMVolumeReader::CanReadFile(const char* name)
{
  try
  {
    return name && vol::MayBeVolumeFile(name) ? 1 : 0;
  }
  catch (const std::exception&) // there may be another reader
  {
    return 0;
  }
}

bool vtkDSMVolumeReader::IsAddress(const char* name)
{
  return name && vol::IsUrl(name);
}

vtkDataArraySelection* vtkDSMVolumeReader::GetPointDataArraySelection()
{
  return this->PointArrays;
}

vtkDataArraySelection* vtkDSMVolumeReader::GetCellDataArraySelection()
{
  return this->CellArrays;
}

void vtkDSMVolumeReader::SetCacheMebibytes(int size)
{
  vol::ChunkCache::GetShared().SetLimit(static_cast<std::size_t>(std::max(0, size)) << 20);
}

int vtkDSMVolumeReader::GetCacheMebibytes()
{
  return static_cast<int>(vol::ChunkCache::GetShared().GetLimit() >> 20);
}

vtkTypeUInt64 vtkDSMVolumeReader::GetBytesRead()
{
  return vol::ChunkCache::GetShared().GetBytesRead();
}

int vtkDSMVolumeReader::Attempt(const char* doing, const std::function<void()>& work)
{
  Silence(this->GetExecutive());
  const std::string failure =
    vtkDSMErrorGuard::Try(doing, vol::HideCredentials(this->GetFileName()).c_str(), work);
  if (!failure.empty() && (failure != this->Self->Told || this->Self->ToldAt != this->GetMTime()))
  {
    vtkErrorMacro(<< failure);
    this->Self->ToldAt = this->GetMTime();
  }
  this->Self->Told = failure;
  return failure.empty() ? 1 : 0;
}

bool vtkDSMVolumeReader::GetRawFile()
{
  return vol::IsBareFile(this->GetFileName());
}

const char* vtkDSMVolumeReader::GetLevelNames()
{
  Internals& self = *this->Self;
  if (self.LevelNamesAt != this->GetMTime())
  {
    self.LevelNamesAt = this->GetMTime();
    self.LevelNames.clear();
    // A failure is reported when the level is requested.
    vtkDSMErrorGuard::Try("opening", this->GetFileName(),
      [&]
      {
        vol::OpenOptions options = this->GetOptions();
        options.Level = 0;
        options.OnlyHeader = true;
        for (int levels = 1; options.Level < levels; ++options.Level)
        {
          const auto file = self.File && self.Options.Level == options.Level
            ? self.File
            : vol::OpenVolumeFile(this->GetFileName(), options);
          levels = file->GetLevels();
          self.LevelNames += (options.Level > 0 ? "\n" : "") + std::to_string(options.Level) +
            ": " + vol::DescribeShape(file->GetGeometry().Points);
        }
      });
  }
  return self.LevelNames.c_str();
}

vol::OpenOptions vtkDSMVolumeReader::GetOptions() const
{
  vol::OpenOptions options;
  options.Level = this->Level;
  options.Dataset = this->DatasetName;
  // The name of such arrays in states of version 0.1.
  options.ArrayName = this->PointArrays->ArrayExists("values") ? "values" : "";
  const auto sample =
    vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(this->RawScalarType));
  options.Bare.Samples = { this->RawDimensions[0], this->RawDimensions[1], this->RawDimensions[2] };
  options.Bare.Type = vtkDSMScalarType::FromArray(sample);
  options.Bare.Components = this->RawComponents;
  options.Bare.BigEndian = this->RawBigEndian;
  options.Bare.HeaderBytes =
    static_cast<std::uint64_t>(std::max<vtkIdType>(0, this->RawHeaderBytes));
  const bool isRaw = vol::IsBareFile(this->GetFileName());
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const bool isGiven = this->Spacing[axis] != 0.0 || !isRaw;
    options.Spacing[axis] = isGiven ? this->Spacing[axis] : this->RawSpacing[axis];
  }
  if (this->OwnOrigin)
  {
    options.Origin = { this->Origin[0], this->Origin[1], this->Origin[2] };
  }
  return options;
}

void vtkDSMVolumeReader::Open()
{
  if (this->Self->File && this->Self->OpenedAt == this->GetMTime())
  {
    return;
  }
  this->Self->File.reset();
  const vol::OpenOptions options = this->GetOptions();
  vol::OpenOptions abortable = options;
  abortable.GoesOn = [this]
  {
    this->UpdateProgress(0.0); // observers may abort
    return this->AbortExecute == 0;
  };
  const auto file = vol::OpenCachedVolume(this->FileNames, abortable);
  CheckExtent(*file);
  // The choice for another file applies to arrays of the same names.
  for (const bool onCells : { false, true })
  {
    vtkDataArraySelection* const selection = onCells ? this->CellArrays : this->PointArrays;
    std::vector<const char*> names;
    for (const vol::FileArray& array : file->GetArrays())
    {
      if (array.OnCells == onCells)
      {
        names.push_back(array.Name.c_str());
        selection->AddArray(array.Name.c_str(), !array.IsOffered); // where it is new
      }
    }
    selection->SetArrays(names.data(), static_cast<int>(names.size()));
  }
  this->Self->File = file;
  this->Self->Options = options;
  this->Self->OpenedAt = this->GetMTime();
  auto* const controller = vtkMultiProcessController::GetGlobalController();
  if (!controller || controller->GetLocalProcessId() == 0)
  {
    this->TellOfRest();
    for (const std::string& warning : file->GetWarnings())
    {
      vtkWarningMacro("The file '" << file->GetPath() << "' " << warning);
    }
  }
}

void vtkDSMVolumeReader::TellOfRest() const
{
  const vol::VolumeFile& file = *this->Self->File;
  const vol::FileArray& array = file.GetArrays().front();
  if (!vol::IsBareFile(file.GetPath()))
  {
    return;
  }
  const std::uint64_t header = this->Self->Options.Bare.HeaderBytes;
  const std::uint64_t values =
    static_cast<std::uint64_t>(bricks::Box{ bricks::Index3(0), array.Grid.Samples }.GetCount()) *
    array.GetSampleBytes();
  std::error_code failure;
  const std::uint64_t has = std::filesystem::file_size(file.GetPath(), failure);
  if (!failure && has > header + values)
  {
    vtkWarningMacro("The file '" << file.GetPath() << "' has " << has << " bytes, but "
                                 << has - header - values << " bytes are not used after " << header
                                 << " bytes of header and " << values
                                 << " bytes of values. If the picture looks wrong, check Raw "
                                    "Dimensions, Raw Scalar Type, Components and Header Bytes.");
  }
}

bool vtkDSMVolumeReader::OpenIfDescribed()
{
  // ParaView asks before the user can enter anything.
  const bool isDescribed =
    *std::min_element(this->RawDimensions, this->RawDimensions + 3) >= 1 || !this->GetRawFile();
  if (isDescribed)
  {
    this->Open();
  }
  return isDescribed;
}

int vtkDSMVolumeReader::FillOutputPortInformation(int, vtkInformation* information)
{
  information->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkDataSet");
  return 1;
}

int vtkDSMVolumeReader::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* output)
{
  if (request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_OBJECT()))
  {
    this->CreateOutput(output->GetInformationObject(0));
    return 1;
  }
  return this->Superclass::ProcessRequest(request, inputs, output);
}

void vtkDSMVolumeReader::CreateOutput(vtkInformation* information)
{
  bool isUneven = false;
  // An error is reported by what comes next, RequestInformation.
  vtkDSMErrorGuard::Try("opening", this->GetFileName(),
    [&] { isUneven = this->OpenIfDescribed() && !this->Self->File->IsEvenlySpaced(); });
  const int type = isUneven ? VTK_RECTILINEAR_GRID : VTK_IMAGE_DATA;
  vtkDataObject* const now = information->Get(vtkDataObject::DATA_OBJECT());
  if (!now || now->GetDataObjectType() != type)
  {
    const auto grid = isUneven
      ? vtkSmartPointer<vtkDataSet>(vtkSmartPointer<vtkRectilinearGrid>::New())
      : vtkSmartPointer<vtkDataSet>(vtkSmartPointer<vtkImageData>::New());
    information->Set(vtkDataObject::DATA_OBJECT(), grid);
  }
}

int vtkDSMVolumeReader::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  vtkInformation* information = output->GetInformationObject(0);
  const int done = this->Attempt("opening",
    [&]
    {
      if (this->OpenIfDescribed())
      {
        this->TellOfFile(information);
      }
      else
      {
        OfferNothing(information);
        this->Self->File.reset();
      }
    });
  if (done == 0)
  {
    OfferNothing(information);
  }
  return done;
}

void vtkDSMVolumeReader::TellOfFile(vtkInformation* information) const
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  const vol::VolumeFile& file = *this->Self->File;
  const vol::FileGeometry& geometry = file.GetGeometry();
  int extent[6];
  for (int axis = 0; axis < 3; ++axis)
  {
    extent[2 * axis] = static_cast<int>(geometry.First[axis]);
    extent[2 * axis + 1] = static_cast<int>(geometry.First[axis] + geometry.Points[axis] - 1);
  }
  information->Set(Pipeline::WHOLE_EXTENT(), extent, 6);
  if (file.IsEvenlySpaced())
  {
    information->Set(vtkDataObject::ORIGIN(), geometry.Origin, 3);
    information->Set(vtkDataObject::SPACING(), geometry.Spacing, 3);
    information->Set(vtkDataObject::DIRECTION(), geometry.Direction, 9);
  }
  information->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
  this->TellOfScalars(information);
  information->Remove(Pipeline::TIME_STEPS());
  information->Remove(Pipeline::TIME_RANGE());
  if (file.GetSteps() > 1)
  {
    std::vector<double> steps;
    for (int step = 0; step < file.GetSteps(); ++step)
    {
      steps.push_back(file.GetTime(step));
    }
    const double range[2] = { steps.front(), steps.back() };
    information->Set(Pipeline::TIME_STEPS(), steps.data(), file.GetSteps());
    information->Set(Pipeline::TIME_RANGE(), range, 2);
  }
}

bool vtkDSMVolumeReader::IsChosen(const vol::FileArray& array) const
{
  vtkDataArraySelection* const selection = array.OnCells ? this->CellArrays : this->PointArrays;
  return selection->ArrayIsEnabled(array.Name.c_str()) != 0;
}

const vol::FileArray* vtkDSMVolumeReader::FindScalars() const
{
  // Prefer the array that the file names; then the first with one component; then the first.
  const auto getRank = [](const vol::FileArray& array) {
    return array.IsActive ? 2 : array.Components == 1 ? 1 : 0;
  };
  const vol::FileArray* best = nullptr;
  for (const vol::FileArray& array : this->Self->File->GetArrays())
  {
    if (!array.OnCells && this->IsChosen(array) && (!best || getRank(array) > getRank(*best)))
    {
      best = &array;
    }
  }
  return best;
}

void vtkDSMVolumeReader::TellOfScalars(vtkInformation* information) const
{
  information->Remove(vtkDataObject::POINT_DATA_VECTOR());
  if (const vol::FileArray* const scalars = this->FindScalars())
  {
    vtkDataObject::SetPointDataActiveScalarInfo(
      information, vtkDSMGetFileArrayType(scalars->Type), scalars->Components);
  }
}

void vtkDSMVolumeReader::AddArrays(vtkDataSet* grid, const int extent[6], int step, bool isShare)
{
  const int nextStep = this->Self->Advance(step);
  const auto& file = this->Self->File;
  const bricks::Index3 first = file->GetGeometry().First;
  const auto& arrays = file->GetArrays();
  const vol::FileArray* const scalars =
    this->FindScalars(); // scalars for drawing, unless another array is selected
  std::vector<std::pair<const vol::FileArray*, vtkSmartPointer<vtkDataArray>>> found;
  for (std::size_t index = 0; index < arrays.size(); ++index)
  {
    const vol::FileArray& array = arrays[index];
    if (!this->IsChosen(array))
    {
      continue;
    }
    bricks::Box box;
    for (int axis = 0; axis < 3; ++axis)
    {
      // Along an axis of one point there is one cell.
      const int end = array.OnCells ? std::max(extent[2 * axis] + 1, extent[2 * axis + 1])
                                    : extent[2 * axis + 1] + 1;
      box.Min[axis] = extent[2 * axis] - first[axis];
      box.Max[axis] = end - first[axis];
    }
    const auto values =
      std::make_shared<vtkDSMFileValues>(file, index, step, box, nextStep, this->Self->Options);
    values->SetShare(isShare);
    values->FindRanges(
      [&](double part)
      {
        this->UpdateProgress(
          (static_cast<double>(index) + part) / static_cast<double>(arrays.size()));
        return this->AbortExecute == 0;
      },
      !this->ValuesInMemory && &array == scalars);
    found.emplace_back(
      &array, this->ValuesInMemory ? vtkDSMReadFileArray(*values) : vtkDSMCreateFileArray(values));
  }
  // A grid keeps its scalars from one execution to the next: when a file cannot be read, they stay for the last
  // picture, and else they go.
  grid->GetPointData()->Initialize();
  for (const auto& [array, shown] : found)
  {
    vtkDataSetAttributes* attributes = array->OnCells
      ? static_cast<vtkDataSetAttributes*>(grid->GetCellData())
      : grid->GetPointData();
    attributes->AddArray(shown);
    if (array->OnCells ? !attributes->GetScalars() && array->Components == 1 : array == scalars)
    {
      attributes->SetScalars(shown);
    }
  }
}

int vtkDSMVolumeReader::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return this->Attempt("reading",
    [&]
    {
      this->Open();
      this->FillGrid(vtkDataSet::GetData(output), output->GetInformationObject(0));
    });
}

void vtkDSMVolumeReader::PlaceGrid(vtkDataSet* grid, const int extent[6]) const
{
  const vol::FileGeometry& geometry = this->Self->File->GetGeometry();
  if (auto* const image = vtkImageData::SafeDownCast(grid))
  {
    image->SetExtent(const_cast<int*>(extent));
    image->SetOrigin(geometry.Origin);
    image->SetSpacing(geometry.Spacing);
    image->SetDirectionMatrix(geometry.Direction);
    return;
  }
  const vol::GridCoordinates& coordinates = this->Self->File->GetCoordinates();
  auto* const rectilinear = vtkRectilinearGrid::SafeDownCast(grid);
  rectilinear->SetExtent(const_cast<int*>(extent));
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::vector<double>& positions = coordinates[static_cast<std::size_t>(axis)];
    vtkNew<vtkDoubleArray> own;
    for (int index = extent[2 * axis]; index <= extent[2 * axis + 1]; ++index)
    {
      own->InsertNextValue(positions.empty()
          ? geometry.Origin[axis] + index * geometry.Spacing[axis]
          : positions[static_cast<std::size_t>(index - geometry.First[axis])]);
    }
    axis == 0     ? rectilinear->SetXCoordinates(own)
      : axis == 1 ? rectilinear->SetYCoordinates(own)
                  : rectilinear->SetZCoordinates(own);
  }
}

void vtkDSMVolumeReader::FillGrid(vtkDataSet* grid, vtkInformation* information)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  int extent[6];
  information->Get(Pipeline::UPDATE_EXTENT(), extent);
  this->PlaceGrid(grid, extent);
  if (grid->GetNumberOfPoints() == 0)
  {
    return;
  }
  int step = 0;
  if (this->Self->File->GetSteps() > 1)
  {
    const double time = information->Has(Pipeline::UPDATE_TIME_STEP())
      ? information->Get(Pipeline::UPDATE_TIME_STEP())
      : 0.0;
    step = this->Self->FindStep(time);
    grid->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), this->Self->File->GetTime(step));
  }
  this->AddArrays(grid, extent, step, IsShare(information));
}

void vtkDSMVolumeReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  for (const std::string& name : this->FileNames)
  {
    os << indent << "FileName: " << vol::HideCredentials(name) << "\n";
  }
  os << indent << "Level: " << this->Level << "\n";
  os << indent << "DatasetName: " << this->DatasetName << "\n";
  os << indent << "Spacing: " << this->Spacing[0] << " " << this->Spacing[1] << " "
     << this->Spacing[2] << "\n";
  os << indent << "OwnOrigin: " << this->OwnOrigin << "\n";
  os << indent << "Origin: " << this->Origin[0] << " " << this->Origin[1] << " " << this->Origin[2]
     << "\n";
  os << indent << "RawDimensions: " << this->RawDimensions[0] << " " << this->RawDimensions[1]
     << " " << this->RawDimensions[2] << "\n";
  os << indent << "RawScalarType: " << this->RawScalarType << "\n";
  os << indent << "RawComponents: " << this->RawComponents << "\n";
  os << indent << "RawBigEndian: " << this->RawBigEndian << "\n";
  os << indent << "RawHeaderBytes: " << this->RawHeaderBytes << "\n";
}
