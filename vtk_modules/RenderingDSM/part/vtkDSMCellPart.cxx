// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMCellPart.h"

#include "DSMBricks/base/ParallelFor.h"
#include "DSMBricks/cells/AverageCells.h"
#include "DSMBricks/cells/PointGradients.h"
#include "DSMBricks/cells/PublishCells.h"
#include "DSMBricks/cells/SharedPlaces.h"
#include "DSMBricks/layout/PlaceInBrick.h"
#include "vtkDSMGather.h"
#include "vtkDSMImagePiece.h"

#include "vtkBoundingBox.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkStructuredGrid.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <glm/ext/matrix_transform.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>

namespace
{

/// Part of the time that cells take, of that of cells and values.
constexpr double ShareOfCells = 0.65;

/// Part of the time of values until the means of cells, and the gradients, are known.
constexpr double EndOfMeans = 0.2;
constexpr double EndOfGradients = 0.75;

constexpr std::size_t ChunkOfPoints = 4096;

/// Returns the value of a tuple; NaN, if it is missing.
using Reader = std::function<double(vtkIdType)>;

/// Any thread may call what is returned.
Reader MakeReader(vtkDataArray* array, int component, const bricks::ValidValues& valid)
{
  const bool isMagnitude =
    component == vtkDSMImagePiece::Magnitude && array->GetNumberOfComponents() > 1;
  const int one = std::max(component, 0);
  Reader read;
  if (isMagnitude)
  {
    read = [array](vtkIdType tuple) { return vtkDSMImagePiece::GetMagnitude(array, tuple); };
  }
  else
  {
    read = [array, one](vtkIdType tuple) { return array->GetComponent(tuple, one); };
  }
  const bricks::ScalarType type = vtkDSMImagePiece::GetScalarType(array, component);
  if (!valid.Exclude(type))
  {
    return read;
  }
  Reader readValid;
  bricks::Dispatch(type,
    [&](auto zero)
    {
      using T = decltype(zero);
      readValid = [read, isMissing = bricks::MissingTest<T>(valid)](vtkIdType tuple)
      {
        const double value = read(tuple);
        return isMissing(static_cast<T>(value)) ? std::numeric_limits<double>::quiet_NaN() : value;
      };
    });
  return readValid;
}

/// Adds what an unstructured grid's cells are, apart from their numbers of points.
void AddKinds(vtkUnstructuredGrid* grid, int threads, bricks::ByteHash& hash)
{
  vtkNew<vtkIdList> faces;
  const std::vector<std::uint8_t> types = vtkDSMGridCells::ReadTypes(grid, threads);
  for (std::size_t cell = 0; cell < types.size(); ++cell)
  {
    if (types[cell] == VTK_POLYHEDRON)
    {
      grid->GetFaceStream(static_cast<vtkIdType>(cell), faces);
      hash.Add(faces->GetPointer(0),
        static_cast<std::size_t>(faces->GetNumberOfIds()) * sizeof(vtkIdType));
    }
  }
  hash.Add(types.data(), types.size());
}

vtkSmartPointer<vtkDoubleArray> ReadPoints(vtkPointSet* grid, const Reader& read)
{
  auto values = vtkSmartPointer<vtkDoubleArray>::New();
  values->SetNumberOfTuples(grid->GetNumberOfPoints());
  for (vtkIdType point = 0; point < grid->GetNumberOfPoints(); ++point)
  {
    values->SetValue(point, read(point));
  }
  return values;
}

/// A copy of ghost flags, or of none, of which those that the mask does not show have another flag.
vtkSmartPointer<vtkUnsignedCharArray> HideByMask(vtkDataSetAttributes* attributes, vtkIdType count,
  vtkDataArray* array, const vtkDSMImageArrays::CellMask& mask, unsigned char flag)
{
  const char* const name = vtkDataSetAttributes::GhostArrayName();
  auto* const old = vtkUnsignedCharArray::SafeDownCast(attributes->GetAbstractArray(name));
  auto ghosts = vtkSmartPointer<vtkUnsignedCharArray>::New();
  ghosts->SetName(name);
  ghosts->SetNumberOfTuples(count);
  for (vtkIdType number = 0; number < count; ++number)
  {
    const unsigned char before =
      old && number < old->GetNumberOfTuples() ? old->GetValue(number) : 0;
    const bool isShown = array && mask.Shows(array->GetComponent(number, 0));
    ghosts->SetValue(number, static_cast<unsigned char>(before | (isShown ? 0 : flag)));
  }
  return ghosts;
}

/// Copies of grids in which a mask has hidden cells, or points.
vtkDSMGridCells::Grids HideByMask(
  const vtkDSMGridCells::Grids& grids, const vtkDSMPart::Choice& choice)
{
  vtkDSMImageArrays::CellMask mask = choice.Mask;
  std::sort(mask.Values.begin(), mask.Values.end());
  vtkDSMGridCells::Grids hidden;
  for (vtkPointSet* const grid : grids)
  {
    auto copy = vtkSmartPointer<vtkPointSet>::Take(grid->NewInstance());
    copy->ShallowCopy(grid);
    vtkDSMPart::Info info;
    vtkDataArray* const array = vtkDSMImageArrays::Find(grid, choice.GetMaskArray(), info);
    vtkDataSetAttributes* const points = copy->GetPointData();
    vtkDataSetAttributes* const cells = copy->GetCellData();
    mask.OnCells ? cells->AddArray(HideByMask(cells, grid->GetNumberOfCells(), array, mask,
                     vtkDataSetAttributes::HIDDENCELL))
                 : points->AddArray(HideByMask(points, grid->GetNumberOfPoints(), array, mask,
                     vtkDataSetAttributes::HIDDENPOINT));
    hidden.push_back(copy);
  }
  return hidden;
}

/// The means of the values of cells at points; NaN where there are none.
vtkSmartPointer<vtkDoubleArray> AverageOwnCells(vtkPointSet* grid, const Reader& read)
{
  auto sums = vtkSmartPointer<vtkDoubleArray>::New();
  sums->SetNumberOfTuples(grid->GetNumberOfPoints());
  sums->FillValue(0.0);
  std::vector<int> counts(static_cast<std::size_t>(grid->GetNumberOfPoints()));
  vtkUnsignedCharArray* const ghosts = grid->GetCellGhostArray();
  vtkNew<vtkIdList> points;
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    const bool isHidden =
      ghosts && (ghosts->GetValue(cell) & vtkDataSetAttributes::HIDDENCELL) != 0;
    const double value = isHidden ? std::numeric_limits<double>::quiet_NaN() : read(cell);
    grid->GetCellPoints(cell, points);
    for (vtkIdType corner = 0; std::isfinite(value) && corner < points->GetNumberOfIds(); ++corner)
    {
      const vtkIdType point = points->GetId(corner);
      sums->SetValue(point, sums->GetValue(point) + value);
      ++counts[static_cast<std::size_t>(point)];
    }
  }
  for (vtkIdType point = 0; point < sums->GetNumberOfTuples(); ++point)
  {
    sums->SetValue(point, sums->GetValue(point) / counts[static_cast<std::size_t>(point)]);
  }
  return sums;
}

class CellPartValues final : public vtkDSMPartValues
{
public:
  explicit CellPartValues(const rt::CellField& field)
    : vtkDSMPartValues(field)
    , Values(field.Voxels)
  {
  }

  bricks::SurveyedBricks GetSurveyed() const override { return { &this->Values->Survey }; }
  bricks::Index3 CountSlices() const override { return bricks::Index3(0); }

private:
  std::shared_ptr<const bricks::CellValues> Values;
};

glm::dmat4 GetToData(const bricks::BrickSpace& space)
{
  return glm::scale(glm::translate(glm::dmat4(1.0), space.Origin), glm::dvec3(space.Scale));
}

} // namespace

/// What values are found from, while they are published.
struct vtkDSMCellPart::Inputs
{
  using Reader = ::Reader;

  vtkDSMGridCells::Cuts Cuts;
  std::unique_ptr<const vtkDSMGridCells> Source;
  std::vector<Reader> Readers; ///< of the grids; empty where one does not have the array

  double Read(const vtkDSMGridCells::Place& place) const
  {
    const Reader& reader = this->Readers[place.Grid];
    return reader ? reader(place.Number) : std::numeric_limits<double>::quiet_NaN();
  }
};

/// Cells in bricks, and what this rank has of them. Leaves the store with its last user.
struct vtkDSMCellPart::Cells
{
  Cells(std::shared_ptr<vtkDSMRankGroup> group, vtkDSMGridCells::Cuts cuts)
    : Group(std::move(group))
    , Cuts(std::move(cuts))
  {
  }
  ~Cells()
  {
    if (this->Bricks)
    {
      this->Group->GetStore().Retire(this->Bricks->Segment);
    }
  }
  Cells(const Cells&) = delete;
  Cells& operator=(const Cells&) = delete;

  std::shared_ptr<vtkDSMRankGroup> Group;
  std::shared_ptr<bricks::CellBricks> Bricks;
  bricks::CornerRoutes Routes;
  vtkDSMGridCells::Cuts Cuts;
  std::shared_ptr<const bricks::SharedPlaces> Shared;
};

std::vector<std::unique_ptr<vtkDSMPart>> vtkDSMCellPart::Create(
  const std::shared_ptr<vtkDSMRankGroup>& group, const OwnPieces& pieces)
{
  std::vector<vtkDSMBlockLook> mine;
  for (const Piece& piece : pieces)
  {
    mine.push_back(piece.Look);
  }
  std::vector<vtkDSMBlockLook> looks;
  for (const vtkDSMBlockLook& look : vtkDSMGather::Items(group->GetMessenger(), mine))
  {
    if (std::find(looks.begin(), looks.end(), look) == looks.end())
    {
      looks.push_back(look);
    }
  }
  std::vector<std::unique_ptr<vtkDSMPart>> parts;
  for (const vtkDSMBlockLook& look : looks)
  {
    vtkDSMGridCells::Grids grids;
    for (const Piece& piece : pieces)
    {
      if (piece.Look == look)
      {
        grids.push_back(piece.Data);
      }
    }
    parts.push_back(std::unique_ptr<vtkDSMPart>(new vtkDSMCellPart(group, std::move(grids), look)));
  }
  return parts;
}

vtkDSMCellPart::vtkDSMCellPart(
  std::shared_ptr<vtkDSMRankGroup> group, vtkDSMGridCells::Grids grids, const vtkDSMBlockLook& look)
  : vtkDSMPart(std::move(group))
  , Own(std::move(grids))
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  using Bounds = std::array<double, 6>;
  const std::vector<Bounds> all = messenger.GatherValueTogether("Reading the grids",
    [&]
    {
      vtkBoundingBox box;
      for (vtkPointSet* const grid : this->Own)
      {
        box.AddBounds(grid->GetBounds());
      }
      this->PlacesHash = this->HashPlaces();
      Bounds bounds;
      box.GetBounds(bounds.data());
      return bounds;
    });
  for (const Bounds& bounds : all)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Lower[axis] = std::min(this->Lower[axis], bounds[2 * axis]);
      this->Upper[axis] = std::max(this->Upper[axis], bounds[2 * axis + 1]);
    }
  }
  // The field has one cell only, as far as looks are concerned.
  this->BlockLooks.push_back({ { bricks::Index3(0), bricks::Index3(1) }, look });
  this->Known = this->Group->GetPublications().Find<Cells>(messenger, this->PlacesHash);
}

vtkDSMCellPart::~vtkDSMCellPart() = default;

std::uint64_t vtkDSMCellPart::HashPlaces() const
{
  bricks::ByteHash hash;
  const char* const ghosts = vtkDataSetAttributes::GhostArrayName();
  for (vtkPointSet* const grid : this->Own)
  {
    this->AddArray(grid->GetPoints() ? grid->GetPoints()->GetData() : nullptr, hash);
    this->AddArray(grid->GetPointData()->GetAbstractArray(ghosts), hash);
    this->AddArray(grid->GetCellData()->GetAbstractArray(ghosts), hash);
    if (auto* const structured = vtkStructuredGrid::SafeDownCast(grid))
    {
      int size[3];
      structured->GetDimensions(size);
      hash.Add(size, sizeof(size));
      continue;
    }
    auto* const unstructured = vtkUnstructuredGrid::SafeDownCast(grid);
    vtkCellArray* const cells = unstructured->GetCells();
    this->AddArray(cells ? cells->GetOffsetsArray() : nullptr, hash);
    this->AddArray(cells ? cells->GetConnectivityArray() : nullptr, hash);
    // Degrees and weights of Lagrange and Bezier cells.
    this->AddArray(grid->GetCellData()->GetHigherOrderDegrees(), hash);
    this->AddArray(grid->GetPointData()->GetRationalWeights(), hash);
    AddKinds(unstructured, this->CountThreads(), hash);
  }
  return hash.Get();
}

void vtkDSMCellPart::AddContent(const Choice& choice, bricks::ByteHash& hash) const
{
  hash.Add(&this->PlacesHash, sizeof(this->PlacesHash));
  for (vtkPointSet* const grid : this->Own)
  {
    Info info;
    this->AddArray(vtkDSMImageArrays::Find(grid, choice, info), hash);
    if (choice.HasMask())
    {
      this->AddArray(vtkDSMImageArrays::Find(grid, choice.GetMaskArray(), info), hash);
    }
  }
}

std::vector<vtkDSMPart::Info> vtkDSMCellPart::FindArrays(const Choice& choice) const
{
  std::vector<Info> infos(this->Own.size());
  for (std::size_t own = 0; own < this->Own.size(); ++own)
  {
    vtkDSMImageArrays::Find(this->Own[own], choice, infos[own]);
  }
  return infos;
}

void vtkDSMCellPart::RequireCells(
  const Request& request, const Inputs& inputs, const std::function<void(double)>& progress) const
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  dsm::Publications& publications = this->Group->GetPublications();
  if (!this->Known)
  {
    this->Known = publications.Find<Cells>(messenger, this->PlacesHash);
  }
  if (this->Known)
  {
    return;
  }
  const auto cells = std::make_shared<Cells>(this->Group, inputs.Cuts);
  bricks::SortedBrickSettings settings;
  settings.Threads = this->CountThreads();
  const vtkDSMGridCells& source = *inputs.Source;
  const std::string what = "the cells of " + request.GetName();
  cells->Bricks = this->Group->PublishWithRoom(
    [&](dsm::BlockStore::Place place)
    {
      return bricks::PublishCells(
        what, source, settings, this->Group->GetStore(), messenger, place, cells->Routes, progress);
    });
  cells->Shared = std::make_shared<const bricks::SharedPlaces>(
    what, source.GetPointCount(),
    [&](std::uint64_t point, float place[3])
    {
      double position[3];
      source.GetPosition(point, position);
      return bricks::PlaceInBrick(*cells->Bricks, position, place);
    },
    settings.Threads, messenger);
  publications.Add<Cells>(this->PlacesHash, cells);
  this->Known = cells;
}

void vtkDSMCellPart::Refuse(const Choice& choice)
{
  if (choice.Component == vtkDSMImagePiece::Color)
  {
    throw dsm::Error("The colors in the array '" + choice.Name +
      "' cannot be shown as they are on curvilinear and unstructured grids. Turn on Map Scalars.");
  }
}

vtkDSMCellPart::Inputs vtkDSMCellPart::MakeInputs(const Choice& choice) const
{
  Inputs inputs;
  inputs.Cuts =
    this->Known ? this->Known->Cuts : vtkDSMGridCells::Cut(this->Own, this->CountThreads());
  inputs.Source =
    std::make_unique<const vtkDSMGridCells>(this->Own, inputs.Cuts, this->CountThreads());
  for (vtkPointSet* const grid : this->Own)
  {
    Info info;
    vtkDataArray* const array = vtkDSMImageArrays::Find(grid, choice, info);
    inputs.Readers.push_back(
      array ? MakeReader(array, choice.Component, info.Valid) : Inputs::Reader());
  }
  return inputs;
}

std::vector<float> vtkDSMCellPart::AverageCells(const Request& request, const Inputs& inputs,
  const Cells& cells, const std::function<void(double)>& progress) const
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  std::unique_ptr<const vtkDSMGridCells> whole;
  messenger.RunTogether("Preparing the " + request.Purpose,
    [&]
    {
      whole = std::make_unique<const vtkDSMGridCells>(
        this->Own, inputs.Cuts, this->CountThreads(), vtkDSMGridCells::Use::Means);
    });
  return bricks::AverageCells(
    request.GetName(), *whole, *cells.Shared,
    [&](std::uint64_t cell) { return inputs.Read(whole->FindOwner(cell)); }, this->CountThreads(),
    messenger, progress);
}

std::shared_ptr<bricks::CellValues> vtkDSMCellPart::PublishValues(const Request& request,
  const Inputs& inputs, const std::shared_ptr<const Cells>& cells,
  const std::function<void(double)>& progress) const
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  const std::string what = request.GetName();
  const int threads = this->CountThreads();
  const bool isOfCells = request.Array.OnCells;
  std::vector<float> averages;
  if (isOfCells)
  {
    averages = this->AverageCells(
      request, inputs, *cells, [&](double done) { progress(EndOfMeans * done); });
  }
  const vtkDSMGridCells& source = *inputs.Source;
  const auto readAverage = [&](const vtkDSMGridCells::Place& place)
  { return static_cast<double>(averages[static_cast<std::size_t>(source.GetPoint(place))]); };
  const auto read = [&](const vtkDSMGridCells::Place& place) { return inputs.Read(place); };
  const auto find = [&](std::uint64_t point)
  { return isOfCells ? source.GetValue(point, readAverage) : source.GetValue(point, read); };
  std::vector<double> found; // means of many values, which are asked for several times
  messenger.RunTogether("Reading the " + request.Purpose,
    [&]
    {
      found.resize(
        source.HasFurtherPoints() ? static_cast<std::size_t>(source.GetPointCount()) : 0);
      bricks::ParallelForChunks(threads, found.size(), ChunkOfPoints,
        [&](std::size_t first, std::size_t last, std::size_t, int)
        {
          for (std::size_t point = first; point < last; ++point)
          {
            found[point] = find(point);
          }
        });
    });
  const auto getValue = [&](std::uint64_t point)
  { return found.empty() ? find(point) : found[static_cast<std::size_t>(point)]; };
  const double begin = isOfCells ? EndOfMeans : 0.0;
  const auto ofGradients = [&](double done) { progress(begin + (EndOfGradients - begin) * done); };
  const auto ofBricks = [&](double done)
  { progress(EndOfGradients + (1.0 - EndOfGradients) * done); };
  const std::vector<bricks::PackedGradient> gradients = bricks::FindPointGradients(
    what, source, *cells->Bricks, *cells->Shared, getValue, threads, messenger, ofGradients);
  // The values keep the cells.
  const std::shared_ptr<const bricks::CellBricks> bricksOfCells(cells, cells->Bricks.get());
  return this->Group->PublishWithRoom(
    [&](dsm::BlockStore::Place place)
    {
      return bricks::PublishCellValues(what, bricksOfCells, cells->Routes, getValue, gradients,
        threads, this->Group->GetStore(), messenger, place, ofBricks);
    });
}

std::shared_ptr<vtkDSMPartValues> vtkDSMCellPart::Publish(
  const Request& request, const std::vector<Info>& infos, std::shared_ptr<vtkDSMPartValues>) const
{
  Refuse(request.Array);
  if (std::none_of(infos.begin(), infos.end(), [](const Info& info) { return info.IsUsable(); }))
  {
    return nullptr;
  }
  if (request.Array.HasMask())
  {
    Request ofShown = request;
    ofShown.Array.Mask = {};
    vtkDSMGridCells::Grids grids;
    this->Group->GetMessenger().RunTogether(
      "Preparing the " + request.Purpose, [&] { grids = HideByMask(this->Own, request.Array); });
    const vtkDSMCellPart shown(this->Group, std::move(grids), this->BlockLooks.front().Look);
    return shown.Publish(ofShown, infos, nullptr);
  }
  Inputs inputs;
  this->Group->GetMessenger().RunTogether(
    "Preparing the " + request.Purpose, [&] { inputs = this->MakeInputs(request.Array); });
  const double begin = this->Known ? 0.0 : ShareOfCells;
  const auto report = [&request](double done)
  {
    if (request.Progress)
    {
      request.Progress(done);
    }
  };
  this->RequireCells(request, inputs, [&](double done) { report(begin * done); });
  const std::shared_ptr<const Cells> cells = this->Known;
  std::shared_ptr<bricks::CellValues> values;
  try
  {
    values = this->PublishValues(
      request, inputs, cells, [&](double done) { report(begin + (1.0 - begin) * done); });
  }
  catch (const dsm::Error&)
  {
    this->Known.reset(); // what has no use takes no memory
    throw;
  }
  std::shared_ptr<vtkDSMRankGroup> group = this->Group;
  const bricks::CellValues* const published = values.get();
  rt::CellField field;
  // Leaves the store with its last user. The group's publications hold what this captures.
  field.Voxels = { published,
    [group, values = std::move(values)](const bricks::CellValues*) mutable
    {
      const auto last = std::move(group);
      last->GetStore().Retire(values->Segment);
      values.reset();
    } };
  field.SetIndexToWorld(GetToData(*cells->Bricks));
  return std::make_shared<CellPartValues>(field);
}

vtkDSMPart::OwnGrids vtkDSMCellPart::FindOwnGrids(const Choice& choice) const
{
  OwnGrids found;
  const vtkDSMGridCells::Grids grids = choice.HasMask() ? HideByMask(this->Own, choice) : this->Own;
  const vtkDSMGridCells::Cuts none(grids.size());
  const vtkDSMGridCells source(grids, none, this->CountThreads());
  for (std::size_t own = 0; own < grids.size(); ++own)
  {
    Info info;
    vtkPointSet* const grid = grids[own];
    if (vtkDataArray* const array = vtkDSMImageArrays::Find(grid, choice, info))
    {
      const Reader read = MakeReader(array, choice.Component, info.Valid);
      vtkDSMOwnGrid& one = found.emplace_back();
      one.Data = this->Own[own];
      one.Values = choice.OnCells ? AverageOwnCells(grid, read) : ReadPoints(grid, read);
      for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
      {
        one.IsShown.push_back(source.IsShown(vtkDSMGridCells::Place{ own, cell }) ? 1 : 0);
      }
    }
  }
  return found;
}
