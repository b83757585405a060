// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMIsosurfaceGeometry.h"

#include "vtkDSMVolumeMapper.h"
#include "vtkPVDSMExportLook.h"
#include "vtkPVDSMGridPlace.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFlyingEdges3D.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkImageData.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkRectilinearGrid.h"
#include "vtkRectilinearSynchronizedTemplates.h"
#include "vtkScalarsToColors.h"
#include "vtkStructuredData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnsignedIntArray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace
{

/// Cells of an image, as a box of their places from its first one on.
struct CellBox
{
  int First[3];
  int Last[3]; ///< one behind

  bool Has(const int cell[3]) const
  {
    bool has = true;
    for (int axis = 0; axis < 3; ++axis)
    {
      has = has && this->First[axis] <= cell[axis] && cell[axis] < this->Last[axis];
    }
    return has;
  }
};

/// Cells along an edge of a box whose samples are copied at once.
constexpr int BoxEdge = 64;

/// The cells of an image of so many points.
std::vector<CellBox> CutIntoBoxes(const int points[3])
{
  std::vector<CellBox> boxes;
  for (int z = 0; z < points[2] - 1; z += BoxEdge)
  {
    for (int y = 0; y < points[1] - 1; y += BoxEdge)
    {
      for (int x = 0; x < points[0] - 1; x += BoxEdge)
      {
        boxes.push_back({ { x, y, z },
          { std::min(x + BoxEdge, points[0] - 1), std::min(y + BoxEdge, points[1] - 1),
            std::min(z + BoxEdge, points[2] - 1) } });
      }
    }
  }
  return boxes;
}

/// With the cells around it, as far as there are.
CellBox Grow(CellBox box, const int points[3])
{
  for (int axis = 0; axis < 3; ++axis)
  {
    box.First[axis] = std::max(box.First[axis] - 1, 0);
    box.Last[axis] = std::min(box.Last[axis] + 1, points[axis] - 1);
  }
  return box;
}

/// The samples of the points of some cells.
vtkSmartPointer<vtkDataSet> CutOut(vtkDataSet* image, const CellBox& cells)
{
  const int* const whole = vtkPVDSMGridPlace::GetExtent(image);
  int extent[6];
  for (int axis = 0; axis < 3; ++axis)
  {
    extent[2 * axis] = whole[2 * axis] + cells.First[axis];
    extent[2 * axis + 1] = whole[2 * axis] + cells.Last[axis];
  }
  if (auto* const grid = vtkRectilinearGrid::SafeDownCast(image))
  {
    auto box = vtkSmartPointer<vtkRectilinearGrid>::New();
    box->SetExtent(extent);
    const auto cut = [&](vtkDataArray* all, int axis)
    {
      vtkNew<vtkDoubleArray> some;
      for (int plane = cells.First[axis]; plane <= cells.Last[axis]; ++plane)
      {
        some->InsertNextValue(all->GetComponent(plane, 0));
      }
      return vtkSmartPointer<vtkDataArray>(some);
    };
    box->SetXCoordinates(cut(grid->GetXCoordinates(), 0));
    box->SetYCoordinates(cut(grid->GetYCoordinates(), 1));
    box->SetZCoordinates(cut(grid->GetZCoordinates(), 2));
    return box;
  }
  auto box = vtkSmartPointer<vtkImageData>::New();
  box->CopyStructure(image);
  box->SetExtent(extent);
  return box;
}

/// `use(number, place)`: of each sample of a box, in its order, where it is in an array of the image.
template <class Use>
void ForEachSample(vtkDataSet* image, vtkDataSet* box, const Use& use)
{
  const int* const extent = vtkPVDSMGridPlace::GetExtent(box);
  vtkIdType number = 0;
  for (int z = extent[4]; z <= extent[5]; ++z)
  {
    for (int y = extent[2]; y <= extent[3]; ++y)
    {
      int sample[3] = { extent[0], y, z };
      const vtkIdType row =
        vtkStructuredData::ComputePointIdForExtent(vtkPVDSMGridPlace::GetExtent(image), sample);
      for (int x = extent[0]; x <= extent[1]; ++x)
      {
        use(number++, row + x - extent[0]);
      }
    }
  }
}

/// The mean of the cells around a point, as vtkCellDataToPointData makes it, of those that the image has.
class CellMean
{
public:
  CellMean(vtkDataSet* image, vtkDataArray* array)
    : Image(image)
    , Array(array)
    , HasGhosts(image->GetCellGhostArray() || image->GetPointGhostArray())
  {
  }
  void MoveTo(vtkIdType point)
  {
    this->Image->GetPointCells(point, this->Cells);
    for (vtkIdType number = this->HasGhosts ? this->Cells->GetNumberOfIds() : 0; number-- > 0;)
    {
      const vtkIdType cell = this->Cells->GetId(number);
      if (!this->IsVisible(cell))
      {
        this->Cells->DeleteId(cell);
      }
    }
  }
  double Get(int component) const
  {
    const vtkIdType count = this->Cells->GetNumberOfIds();
    double sum = 0.0;
    for (vtkIdType number = 0; number < count; ++number)
    {
      sum += 1.0 / static_cast<double>(count) *
        this->Array->GetComponent(this->Cells->GetId(number), component);
    }
    const int type = this->Array->GetDataType();
    return type == VTK_DOUBLE ? sum : type == VTK_FLOAT ? static_cast<float>(sum) : std::round(sum);
  }

private:
  bool IsVisible(vtkIdType cell) const
  {
    auto* const grid = vtkRectilinearGrid::SafeDownCast(this->Image);
    return grid ? grid->IsCellVisible(cell) != 0
                : static_cast<vtkImageData*>(this->Image)->IsCellVisible(cell) != 0;
  }

  vtkDataSet* Image;
  vtkDataArray* Array;
  bool HasGhosts;
  vtkNew<vtkIdList> Cells;
};

/// The array of points or cells whose isosurfaces are shown.
struct IsoArray
{
  vtkDataArray* Values;
  bool OnCells;
};

/// One component, or the magnitude, as double: differences of unsigned integers would wrap around.
vtkSmartPointer<vtkDoubleArray> GetValues(
  vtkDataSet* image, vtkDataSet* box, const IsoArray& array, int component)
{
  auto values = vtkSmartPointer<vtkDoubleArray>::New();
  values->SetName("values");
  values->SetNumberOfTuples(box->GetNumberOfPoints());
  const int components = array.Values->GetNumberOfComponents();
  CellMean mean(image, array.Values);
  const auto get = [&](vtkIdType place, int part)
  { return array.OnCells ? mean.Get(part) : array.Values->GetComponent(place, part); };
  ForEachSample(image, box,
    [&](vtkIdType number, vtkIdType place)
    {
      if (array.OnCells)
      {
        mean.MoveTo(place);
      }
      double value = 0.0;
      if (component >= 0 && component < components)
      {
        value = get(place, component);
      }
      else
      {
        for (int part = 0; part < components; ++part)
        {
          value = std::hypot(value, get(place, part));
        }
      }
      values->SetValue(number, value);
    });
  return values;
}

IsoArray FindIsoArray(vtkDSMVolumeMapper* mapper, vtkDataSet* image)
{
  const std::string name = mapper->GetIsoArray();
  const auto find = [&](vtkDataSetAttributes* data)
  { return name.empty() ? data->GetScalars() : data->GetArray(name.c_str()); };
  vtkDataArray* const points = mapper->GetIsoArrayOnCells() ? nullptr : find(image->GetPointData());
  // Without a name: active scalars of points, or else of cells.
  const bool onCells = mapper->GetIsoArrayOnCells() || (!points && name.empty());
  return { onCells ? find(image->GetCellData()) : points, onCells };
}

/// The array of points or cells that colors the surface; null without any.
vtkDataArray* FindColors(vtkDSMVolumeMapper* mapper, vtkDataSet* image, bool onCells)
{
  if (!mapper->GetScalarVisibility() || mapper->GetColorArrayOnCells() != onCells)
  {
    return nullptr;
  }
  vtkDataSetAttributes* attributes = image->GetAttributes(
    onCells ? vtkDataObject::FIELD_ASSOCIATION_CELLS : vtkDataObject::FIELD_ASSOCIATION_POINTS);
  return attributes->GetArray(mapper->GetColorArray().c_str());
}

std::vector<double> GetIsovalues(vtkDSMVolumeMapper* mapper)
{
  std::vector<double> isovalues;
  for (int index = 0; index < mapper->GetNumberOfIsoValues(); ++index)
  {
    isovalues.push_back(mapper->GetIsoValue(index));
  }
  if (isovalues.empty())
  {
    isovalues.push_back(mapper->GetSuggestedIsoValue());
  }
  return isovalues;
}

bool MayHoldAny(vtkDoubleArray* values, const std::vector<double>& isovalues)
{
  double least = std::numeric_limits<double>::infinity();
  double greatest = -least;
  for (vtkIdType number = 0; number < values->GetNumberOfTuples(); ++number)
  {
    const double value = values->GetValue(number);
    least = value < least ? value : least;
    greatest = value > greatest ? value : greatest;
  }
  return std::any_of(isovalues.begin(), isovalues.end(),
    [&](double isovalue) { return least <= isovalue && isovalue <= greatest; });
}

/// The triangles in the cells of a box; null where there are none.
vtkSmartPointer<vtkPolyData> Extract(vtkDSMVolumeMapper* mapper, vtkDataSet* image,
  const IsoArray& array, const std::vector<double>& isovalues, const CellBox& cells, bool colored)
{
  const vtkSmartPointer<vtkDataSet> box = CutOut(image, cells);
  if (!mapper->MayHaveSurface(box->GetBounds(), isovalues))
  {
    return nullptr;
  }
  const auto values = GetValues(image, box, array, mapper->GetIsoComponent());
  if (!MayHoldAny(values, isovalues))
  {
    return nullptr;
  }
  box->GetPointData()->SetScalars(values);
  vtkDataArray* const colors = colored ? FindColors(mapper, image, false) : nullptr;
  if (colors)
  {
    vtkSmartPointer<vtkDataArray> some;
    some.TakeReference(colors->NewInstance());
    some->SetName(colors->GetName());
    some->SetNumberOfComponents(colors->GetNumberOfComponents());
    some->SetNumberOfTuples(box->GetNumberOfPoints());
    ForEachSample(image, box,
      [&](vtkIdType number, vtkIdType place) { some->SetTuple(number, place, colors); });
    box->GetPointData()->AddArray(some);
  }
  const auto extract = [&](auto* filter)
  {
    filter->SetInputData(box);
    filter->SetComputeNormals(colored);
    filter->ComputeScalarsOff();
    for (std::size_t index = 0; index < isovalues.size(); ++index)
    {
      filter->SetValue(static_cast<int>(index), isovalues[index]);
    }
    filter->Update();
    return vtkSmartPointer<vtkPolyData>(filter->GetOutput());
  };
  if (vtkRectilinearGrid::SafeDownCast(box))
  {
    vtkNew<vtkRectilinearSynchronizedTemplates> templates;
    templates->SetArrayComponent(0);
    return extract(templates.GetPointer()); // attributes are always interpolated
  }
  vtkNew<vtkFlyingEdges3D> edges;
  edges->SetInterpolateAttributes(colors != nullptr);
  return extract(edges.GetPointer());
}

/// Points along each axis.
std::array<int, 3> GetDimensions(vtkDataSet* image)
{
  const int* const extent = vtkPVDSMGridPlace::GetExtent(image);
  return { extent[1] - extent[0] + 1, extent[3] - extent[2] + 1, extent[5] - extent[4] + 1 };
}

void FindCell(vtkDataSet* image, const double point[3], int cell[3])
{
  double place[3];
  vtkPVDSMGridPlace::Find(image, point, place);
  for (int axis = 0; axis < 3; ++axis)
  {
    const int last = std::max(GetDimensions(image)[axis] - 2, 0);
    cell[axis] = std::clamp(static_cast<int>(std::floor(place[axis])), 0, last);
  }
}

vtkIdType FindCell(vtkDataSet* image, const double point[3])
{
  int cell[3];
  FindCell(image, point, cell);
  return vtkStructuredData::ComputeCellId(GetDimensions(image).data(), cell);
}

vtkIdType FindPoint(vtkDataSet* image, const double point[3])
{
  double place[3];
  vtkPVDSMGridPlace::Find(image, point, place);
  int sample[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    sample[axis] =
      std::clamp(static_cast<int>(std::lround(place[axis])), 0, GetDimensions(image)[axis] - 1);
  }
  return vtkStructuredData::ComputePointId(GetDimensions(image).data(), sample);
}

/// The triangles of an image, box by box. Each knows which cell of `counted` it is in, and each point which sample is
/// nearest.
class Collector
{
public:
  Collector(vtkDataSet* image, vtkDataSet* counted, unsigned block)
    : Image(image)
    , Counted(counted)
    , Block(block)
  {
    this->Cells->SetName("vtkOriginalCellIds");
    this->Nearest->SetName("vtkOriginalPointIds");
  }

  vtkIdType GetCount() const { return this->Triangles->GetNumberOfCells(); }

  /// Adds the triangles in the cells of a box: `triangles` may be of a larger box. Omits ghost and
  /// hidden cells.
  void Add(vtkPolyData* triangles, const CellBox& box)
  {
    if (this->Points->GetNumberOfPoints() == 0)
    {
      this->Result->GetPointData()->CopyAllOn();
      this->Result->GetPointData()->CopyAllocate(triangles->GetPointData());
      this->Points->SetDataType(triangles->GetPoints()->GetDataType());
    }
    std::vector<vtkIdType> numbers(
      static_cast<std::size_t>(triangles->GetNumberOfPoints()), vtkIdType(-1));
    vtkUnsignedCharArray* ghosts = this->Image->GetCellGhostArray();
    vtkCellArray* all = triangles->GetPolys();
    vtkIdType size;
    const vtkIdType* corners;
    for (all->InitTraversal(); all->GetNextCell(size, corners) != 0;)
    {
      double center[3] = { 0.0, 0.0, 0.0 };
      for (vtkIdType corner = 0; corner < size; ++corner)
      {
        double point[3];
        triangles->GetPoint(corners[corner], point);
        for (int axis = 0; axis < 3; ++axis)
        {
          center[axis] += point[axis] / static_cast<double>(size);
        }
      }
      int cell[3];
      FindCell(this->Image, center, cell);
      constexpr int hidden = vtkDataSetAttributes::DUPLICATECELL |
        vtkDataSetAttributes::HIDDENCELL | vtkDataSetAttributes::REFINEDCELL;
      if (!box.Has(cell) ||
        (ghosts &&
          (ghosts->GetValue(
             vtkStructuredData::ComputeCellId(GetDimensions(this->Image).data(), cell)) &
            hidden) != 0))
      {
        continue;
      }
      this->Triangles->InsertNextCell(static_cast<int>(size));
      for (vtkIdType corner = 0; corner < size; ++corner)
      {
        vtkIdType& number = numbers[static_cast<std::size_t>(corners[corner])];
        number = number >= 0 ? number : this->AddPoint(triangles, corners[corner]);
        this->Triangles->InsertCellPoint(number);
      }
      this->Cells->InsertNextValue(FindCell(this->Counted, center));
    }
  }

  vtkSmartPointer<vtkPolyData> Finish()
  {
    this->Result->SetPoints(this->Points);
    this->Result->SetPolys(this->Triangles);
    this->Result->GetCellData()->AddArray(this->Cells);
    this->Result->GetPointData()->AddArray(this->Nearest);
    if (this->Block > 0)
    {
      for (vtkDataSetAttributes* const data :
        { static_cast<vtkDataSetAttributes*>(this->Result->GetCellData()),
          static_cast<vtkDataSetAttributes*>(this->Result->GetPointData()) })
      {
        vtkNew<vtkUnsignedIntArray> blocks;
        blocks->SetName("vtkCompositeIndex");
        blocks->SetNumberOfTuples(data->GetNumberOfTuples());
        blocks->FillValue(this->Block);
        data->AddArray(blocks);
      }
    }
    return this->Result.GetPointer();
  }

private:
  vtkIdType AddPoint(vtkPolyData* triangles, vtkIdType from)
  {
    const vtkIdType number = this->Points->InsertNextPoint(triangles->GetPoint(from));
    this->Result->GetPointData()->CopyData(triangles->GetPointData(), from, number);
    this->Nearest->InsertNextValue(FindPoint(this->Counted, triangles->GetPoint(from)));
    return number;
  }

  vtkDataSet* Image;
  vtkDataSet* Counted;
  unsigned Block;
  vtkNew<vtkPolyData> Result;
  vtkNew<vtkPoints> Points;
  vtkNew<vtkCellArray> Triangles;
  vtkNew<vtkIdTypeArray> Cells;
  vtkNew<vtkIdTypeArray> Nearest;
};

/// Gives each triangle the value of its cell.
void AttachColors(vtkDataArray* colors, vtkPolyData* triangles)
{
  auto* cells =
    vtkIdTypeArray::SafeDownCast(triangles->GetCellData()->GetArray("vtkOriginalCellIds"));
  vtkSmartPointer<vtkDataArray> values;
  values.TakeReference(colors->NewInstance());
  values->SetName(colors->GetName());
  values->SetNumberOfComponents(colors->GetNumberOfComponents());
  values->SetNumberOfTuples(cells->GetNumberOfTuples());
  for (vtkIdType number = 0; number < cells->GetNumberOfTuples(); ++number)
  {
    values->SetTuple(number, cells->GetValue(number), colors);
  }
  triangles->GetCellData()->AddArray(values);
}

void AddBlock(vtkDSMVolumeMapper* mapper, vtkDataObject* part, vtkDataObject* source,
  unsigned block, bool colored, vtkMultiBlockDataSet* geometry)
{
  vtkDataSet* const image = vtkPVDSMGridPlace::FindImage(part);
  if (part && !image && colored)
  {
    vtkErrorWithObjectMacro(mapper,
      "Isosurfaces of a dataset of type "
        << part->GetClassName()
        << " are not exported. Apply Contour to the dataset and export the result.");
  }
  if (!image || image->GetNumberOfCells() == 0)
  {
    return;
  }
  const IsoArray array = FindIsoArray(mapper, image);
  if (!array.Values)
  {
    return;
  }
  if (!colored && image->GetNumberOfCells() > vtkPVDSMIsosurfaceGeometry::MostCellsOfSelection)
  {
    vtkErrorWithObjectMacro(mapper,
      "Selection is not available in a block of "
        << image->GetNumberOfCells() << " cells on one rank; the maximum is "
        << vtkPVDSMIsosurfaceGeometry::MostCellsOfSelection
        << ". Use more ranks or extract a subset.");
    return;
  }
  vtkDataSet* counted = vtkPVDSMGridPlace::FindImage(source);
  if (!counted || !vtkPVDSMGridPlace::HaveOneLattice(image, counted))
  {
    counted = image;
  }
  Collector collector(image, counted, block);
  const std::vector<double> isovalues = GetIsovalues(mapper);
  for (const CellBox& box : CutIntoBoxes(GetDimensions(image).data()))
  {
    // Normals at a box's sides depend on what is beyond, and so may in which cell a triangle is taken to be.
    const CellBox more = Grow(box, GetDimensions(image).data());
    if (const auto triangles = Extract(mapper, image, array, isovalues, more, colored))
    {
      collector.Add(triangles, box);
    }
    if (collector.GetCount() > vtkPVDSMIsosurfaceGeometry::MostTriangles)
    {
      vtkErrorWithObjectMacro(mapper,
        "Surfaces cannot be " << (colored ? "exported" : "selected") << ": they have more than "
                              << vtkPVDSMIsosurfaceGeometry::MostTriangles
                              << " triangles on one rank. Use more ranks or extract a subset.");
      return;
    }
  }
  const vtkSmartPointer<vtkPolyData> triangles = collector.Finish();
  if (vtkDataArray* colors = colored ? FindColors(mapper, image, true) : nullptr)
  {
    AttachColors(colors, triangles);
  }
  geometry->SetBlock(geometry->GetNumberOfBlocks(), triangles);
}

vtkSmartPointer<vtkMultiBlockDataSet> MakeBlocks(
  vtkDSMVolumeMapper* mapper, vtkDataObject* source, bool colored)
{
  auto geometry = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  vtkDataObject* data = mapper->GetDataObjectInput();
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    vtkSmartPointer<vtkCompositeDataIterator> leaf;
    leaf.TakeReference(composite->NewIterator());
    auto* sources = vtkCompositeDataSet::SafeDownCast(source);
    for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
    {
      AddBlock(mapper, leaf->GetCurrentDataObject(), sources ? sources->GetDataSet(leaf) : nullptr,
        leaf->GetCurrentFlatIndex(), colored, geometry);
    }
  }
  else
  {
    AddBlock(mapper, data, source, 0, colored, geometry);
  }
  return geometry;
}

vtkPVDSMExportLook FindLook(vtkDSMVolumeMapper* mapper, unsigned block)
{
  vtkPVDSMExportLook found;
  const auto known = mapper->GetBlockLooks().find(block);
  if (known == mapper->GetBlockLooks().end())
  {
    return found;
  }
  const vtkDSMBlockLook& look = known->second;
  found.Color = look.Color;
  found.Opacity = look.Opacity;
  if (!look.Color && look.Value && mapper->GetBlockScalarVisibility() && mapper->GetLookupTable())
  {
    std::array<double, 3> color{};
    mapper->GetLookupTable()->GetColor(*look.Value, color.data());
    found.Color = color;
  }
  return found;
}

} // namespace

vtkSmartPointer<vtkMultiBlockDataSet> vtkPVDSMIsosurfaceGeometry::Make(
  vtkDSMVolumeMapper* mapper, vtkDataObject* source)
{
  return MakeBlocks(mapper, source, false);
}

std::vector<vtkSmartPointer<vtkPolyData>> vtkPVDSMIsosurfaceGeometry::MakeColored(
  vtkDSMVolumeMapper* mapper)
{
  const vtkSmartPointer<vtkMultiBlockDataSet> blocks = MakeBlocks(mapper, nullptr, true);
  vtkPVDSMExportParts parts;
  for (unsigned number = 0; number < blocks->GetNumberOfBlocks(); ++number)
  {
    auto* triangles = vtkPolyData::SafeDownCast(blocks->GetBlock(number));
    vtkDataArray* of = triangles->GetCellData()->GetArray("vtkCompositeIndex");
    const bool isBlock = of && of->GetNumberOfTuples() > 0;
    parts.Add(triangles, FindLook(mapper, isBlock ? static_cast<unsigned>(of->GetTuple1(0)) : 0));
  }
  return parts.Finish();
}
