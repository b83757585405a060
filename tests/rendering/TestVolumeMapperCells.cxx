// SPDX-License-Identifier: BSD-3-Clause
// Curvilinear and unstructured grids: cells of every shape.
#include "VolumeMapperCellsTest.h"

#include "vtkBoundingBox.h"
#include "vtkCallbackCommand.h"
#include "vtkCell.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellDataToPointData.h"
#include "vtkCellType.h"
#include "vtkColorTransferFunction.h"
#include "vtkDataSetAttributes.h"
#include "vtkIdList.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPlane.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStructuredGrid.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVolumeProperty.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <string>

namespace
{

using glm::dvec3;
using glm::ivec3;

/// Cells along an axis of the lattice that all grids here are made of.
constexpr int Cells = 20;

/// A lattice in [-16, 16]^3 whose lines are bent.
dvec3 Bend(const dvec3& place)
{
  const dvec3 at = place / double(Cells) - 0.5;
  return 32.0 *
    (at + 0.04 * dvec3(std::sin(7.0 * at.y), std::sin(6.0 * at.z + 1.0), std::sin(8.0 * at.x)));
}

/// Over the edge, without a symmetry.
double GetValue(const dvec3& place)
{
  return glm::length(place * dvec3(1.0, 1.1, 0.9) + dvec3(0.3, 0.2, 0.1)) / Edge;
}

vtkIdType GetLatticePoint(const ivec3& at)
{
  return at.x + (Cells + 1) * (at.y + (Cells + 1) * at.z);
}

vtkSmartPointer<vtkDoubleArray> MakeValues(vtkPointSet* grid)
{
  auto values = vtkSmartPointer<vtkDoubleArray>::New();
  values->SetName("distance");
  for (vtkIdType point = 0; point < grid->GetNumberOfPoints(); ++point)
  {
    dvec3 place;
    grid->GetPoint(point, &place.x);
    values->InsertNextValue(GetValue(place));
  }
  return values;
}

vtkSmartPointer<vtkPoints> MakePoints()
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  for (int k = 0; k <= Cells; ++k)
  {
    for (int j = 0; j <= Cells; ++j)
    {
      for (int i = 0; i <= Cells; ++i)
      {
        const dvec3 place = Bend(dvec3(i, j, k));
        points->InsertNextPoint(&place.x);
      }
    }
  }
  return points;
}

/// Points of a cell of the lattice; x in bit 0, y in bit 1, z in bit 2.
using Corners = std::array<vtkIdType, 8>;

/// Cells that `add(grid, corners)` makes in each cell of the lattice.
vtkSmartPointer<vtkUnstructuredGrid> MakeCells(
  const std::function<void(vtkUnstructuredGrid*, const Corners&, const ivec3&)>& add)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(MakePoints());
  grid->AllocateEstimate(6 * Cells * Cells * Cells, 8);
  for (int k = 0; k < Cells; ++k)
  {
    for (int j = 0; j < Cells; ++j)
    {
      for (int i = 0; i < Cells; ++i)
      {
        Corners corners;
        for (int corner = 0; corner < 8; ++corner)
        {
          corners[static_cast<std::size_t>(corner)] =
            GetLatticePoint({ i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2) });
        }
        add(grid, corners, { i, j, k });
      }
    }
  }
  grid->GetPointData()->SetScalars(MakeValues(grid));
  return grid;
}

void Add(vtkUnstructuredGrid* grid, int type, const std::vector<vtkIdType>& points)
{
  grid->InsertNextCell(type, static_cast<vtkIdType>(points.size()), points.data());
}

void AddHexahedron(vtkUnstructuredGrid* grid, const Corners& at)
{
  Add(grid, VTK_HEXAHEDRON, { at[0], at[1], at[3], at[2], at[4], at[5], at[7], at[6] });
}

void AddTetrahedra(vtkUnstructuredGrid* grid, const Corners& at)
{
  for (const auto& way : std::vector<ivec3>{
         { 1, 2, 4 }, { 2, 1, 4 }, { 1, 4, 2 }, { 4, 1, 2 }, { 2, 4, 1 }, { 4, 2, 1 } })
  {
    Add(grid, VTK_TETRA,
      { at[0], at[static_cast<std::size_t>(way.x)], at[static_cast<std::size_t>(way.x | way.y)],
        at[7] });
  }
}

void AddWedges(vtkUnstructuredGrid* grid, const Corners& at)
{
  Add(grid, VTK_WEDGE, { at[0], at[1], at[3], at[4], at[5], at[7] });
  Add(grid, VTK_WEDGE, { at[0], at[3], at[2], at[4], at[7], at[6] });
}

/// Six around the middle, which is a point of its own.
void AddPyramids(vtkUnstructuredGrid* grid, const Corners& at)
{
  dvec3 middle(0.0);
  for (const vtkIdType corner : at)
  {
    dvec3 place;
    grid->GetPoint(corner, &place.x);
    middle += 0.125 * place;
  }
  const vtkIdType top = grid->GetPoints()->InsertNextPoint(&middle.x);
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::size_t x = std::size_t(1) << (axis + 1) % 3;
    const std::size_t y = std::size_t(1) << (axis + 2) % 3;
    for (const std::size_t side : { std::size_t(0), std::size_t(1) << axis })
    {
      Add(grid, VTK_PYRAMID, { at[side], at[side | x], at[side | x | y], at[side | y], top });
    }
  }
}

void AddPolyhedron(vtkUnstructuredGrid* grid, const Corners& at)
{
  const vtkIdType faces[] = { 4, at[0], at[2], at[6], at[4], 4, at[1], at[3], at[7], at[5], 4,
    at[0], at[1], at[5], at[4], 4, at[2], at[3], at[7], at[6], 4, at[0], at[1], at[3], at[2], 4,
    at[4], at[5], at[7], at[6] };
  grid->InsertNextCell(VTK_POLYHEDRON, 8, at.data(), 6, faces);
}

/// Kinds in turn, with faces of four corners between them.
void AddMixed(vtkUnstructuredGrid* grid, const Corners& at, const ivec3& index)
{
  const int kind = (index.x + 2 * index.y + index.z) % 3;
  kind == 0 ? AddHexahedron(grid, at) : kind == 1 ? AddPyramids(grid, at) : AddPolyhedron(grid, at);
}

/// Cells with nodes on a lattice of half the spacing, of which every other point is a corner.
class NodeGrid
{
public:
  /// Makes cells of a type of two lattice cells on each axis: `corners` in units of these, and the nodes between pairs,
  /// or in the middles of lists, of corners.
  NodeGrid(int type, const std::vector<std::vector<ivec3>>& cells,
    const std::vector<std::vector<int>>& between)
  {
    this->Grid->SetPoints(vtkNew<vtkPoints>());
    this->Grid->AllocateEstimate(Cells * Cells * Cells, 27);
    for (int number = 0; number < Cells * Cells * Cells / 8; ++number)
    {
      const ivec3 first = 4 *
        ivec3(number % (Cells / 2), number / (Cells / 2) % (Cells / 2), number * 4 / Cells / Cells);
      for (const std::vector<ivec3>& corners : cells)
      {
        std::vector<vtkIdType> nodes;
        for (const ivec3& corner : corners)
        {
          nodes.push_back(this->FindNode(first + 2 * corner));
        }
        for (const std::vector<int>& some : between)
        {
          ivec3 sum(0);
          for (const int corner : some)
          {
            sum += corners[static_cast<std::size_t>(corner)];
          }
          nodes.push_back(this->FindNode(first + 2 * sum / static_cast<int>(some.size())));
        }
        this->Grid->InsertNextCell(type, static_cast<vtkIdType>(nodes.size()), nodes.data());
      }
    }
    this->Grid->GetPointData()->SetScalars(MakeValues(this->Grid));
  }

  vtkNew<vtkUnstructuredGrid> Grid;

private:
  vtkIdType FindNode(const ivec3& at)
  {
    const auto [node, isNew] =
      this->Nodes.try_emplace({ at.x, at.y, at.z }, this->Grid->GetNumberOfPoints());
    if (isNew)
    {
      const dvec3 place = Bend(dvec3(at) / 2.0);
      this->Grid->GetPoints()->InsertNextPoint(&place.x);
    }
    return node->second;
  }

  std::map<std::array<int, 3>, vtkIdType> Nodes;
};

vtkSmartPointer<vtkStructuredGrid> MakeStructured()
{
  auto grid = vtkSmartPointer<vtkStructuredGrid>::New();
  grid->SetExtent(-3, Cells - 3, 5, Cells + 5, 0, Cells);
  grid->SetPoints(MakePoints());
  grid->GetPointData()->SetScalars(MakeValues(grid));
  return grid;
}

} // namespace

TEST_F(VolumeMapperCells, LinearCellsOfEveryShapeCoverWhatContourDoes)
{
  using Adder = std::function<void(vtkUnstructuredGrid*, const Corners&)>;
  const std::map<std::string, Adder> kinds{ { "tetrahedra", AddTetrahedra },
    { "hexahedra", AddHexahedron }, { "wedges", AddWedges }, { "pyramids", AddPyramids } };
  for (const auto& [name, add] : kinds)
  {
    SCOPED_TRACE(name);
    const auto grid = MakeCells([&add = add](vtkUnstructuredGrid* cells, const Corners& at,
                                  const ivec3&) { add(cells, at); });
    ExpectSame(this->Render(grid), this->RenderContour(grid));
  }
}

TEST_F(VolumeMapperCells, RepeatedPointsAndFlatCellsAndCellsInsideOut)
{
  const std::vector<double> expected = this->Render(MakeCells(
    [](vtkUnstructuredGrid* grid, const Corners& at, const ivec3&) { AddWedges(grid, at); }));
  const auto add = [](vtkUnstructuredGrid* grid, const Corners& at, const ivec3& index)
  {
    if ((index.x + index.y + index.z) % 2 == 0)
    {
      Add(grid, VTK_HEXAHEDRON, { at[0], at[1], at[3], at[3], at[4], at[5], at[7], at[7] });
      Add(grid, VTK_HEXAHEDRON, { at[4], at[7], at[6], at[6], at[0], at[3], at[2], at[2] });
    }
    else
    {
      Add(grid, VTK_WEDGE, { at[4], at[5], at[7], at[0], at[1], at[3] });
      Add(grid, VTK_WEDGE, { at[0], at[3], at[2], at[4], at[7], at[6] });
    }
    Add(grid, VTK_HEXAHEDRON, { at[0], at[1], at[3], at[2], at[0], at[1], at[3], at[2] });
    Add(grid, VTK_TETRA, { at[5], at[5], at[5], at[5] });
  };
  EXPECT_EQ(this->Render(MakeCells(add)), expected);
}

TEST_F(VolumeMapperCells, PolyhedraAndMixedCells)
{
  const auto hexahedra = MakeCells(
    [](vtkUnstructuredGrid* grid, const Corners& at, const ivec3&) { AddHexahedron(grid, at); });
  const std::vector<double> expected = this->RenderContour(hexahedra);
  const auto polyhedra = MakeCells(
    [](vtkUnstructuredGrid* grid, const Corners& at, const ivec3&) { AddPolyhedron(grid, at); });
  ExpectSame(this->Render(polyhedra), expected);
  ExpectSame(this->Render(MakeCells(AddMixed)), expected);
}

TEST_F(VolumeMapperCells, CellsOfSecondDegree)
{
  using Lists = std::vector<std::vector<int>>;
  // In units of half a cell.
  const std::vector<ivec3> cube{ { 0, 0, 0 }, { 2, 0, 0 }, { 2, 2, 0 }, { 0, 2, 0 }, { 0, 0, 2 },
    { 2, 0, 2 }, { 2, 2, 2 }, { 0, 2, 2 } };
  const Lists edges{ { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 }, { 4, 5 }, { 5, 6 }, { 6, 7 }, { 7, 4 },
    { 0, 4 }, { 1, 5 }, { 2, 6 }, { 3, 7 } };
  Lists all = edges;
  for (const std::vector<int>& face : Lists{ { 0, 3, 7, 4 }, { 1, 2, 6, 5 }, { 0, 1, 5, 4 },
         { 3, 2, 6, 7 }, { 0, 1, 2, 3 }, { 4, 5, 6, 7 }, { 0, 1, 2, 3, 4, 5, 6, 7 } })
  {
    all.push_back(face);
  }
  std::vector<std::vector<ivec3>> tetrahedra;
  for (const auto& way :
    std::vector<std::array<int, 2>>{ { 0, 1 }, { 1, 0 }, { 0, 2 }, { 2, 0 }, { 1, 2 }, { 2, 1 } })
  {
    ivec3 one(0);
    one[way[0]] = 2;
    ivec3 two = one;
    two[way[1]] = 2;
    tetrahedra.push_back({ ivec3(0), one, two, ivec3(2) });
  }
  std::vector<std::vector<ivec3>> pyramids;
  for (const std::vector<int>& face : Lists{ { 0, 3, 7, 4 }, { 1, 2, 6, 5 }, { 0, 1, 5, 4 },
         { 3, 2, 6, 7 }, { 0, 1, 2, 3 }, { 4, 5, 6, 7 } })
  {
    std::vector<ivec3>& pyramid = pyramids.emplace_back();
    for (const int corner : face)
    {
      pyramid.push_back(cube[static_cast<std::size_t>(corner)]);
    }
    pyramid.emplace_back(1);
  }
  const Lists ofTetrahedron{ { 0, 1 }, { 1, 2 }, { 2, 0 }, { 0, 3 }, { 1, 3 }, { 2, 3 } };
  const Lists ofWedge{ { 0, 1 }, { 1, 2 }, { 2, 0 }, { 3, 4 }, { 4, 5 }, { 5, 3 }, { 0, 3 },
    { 1, 4 }, { 2, 5 } };
  const Lists ofPyramid{ { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 }, { 0, 4 }, { 1, 4 }, { 2, 4 },
    { 3, 4 } };
  const std::vector<std::vector<ivec3>> wedges{ { cube[0], cube[1], cube[2], cube[4], cube[5],
                                                  cube[6] },
    { cube[0], cube[2], cube[3], cube[4], cube[6], cube[7] } };
  const NodeGrid grids[] = { { VTK_QUADRATIC_TETRA, tetrahedra, ofTetrahedron },
    { VTK_QUADRATIC_HEXAHEDRON, { cube }, edges }, { VTK_TRIQUADRATIC_HEXAHEDRON, { cube }, all },
    { VTK_QUADRATIC_WEDGE, wedges, ofWedge }, { VTK_QUADRATIC_PYRAMID, pyramids, ofPyramid },
    { VTK_LAGRANGE_TETRAHEDRON, tetrahedra, ofTetrahedron } };
  for (const NodeGrid& grid : grids)
  {
    SCOPED_TRACE(grid.Grid->GetCellType(0));
    ExpectSame(this->Render(grid.Grid), this->RenderContour(grid.Grid));
  }
}

TEST_F(VolumeMapperCells, StructuredGridsAreAsTheirHexahedra)
{
  const auto structured = MakeStructured();
  const std::vector<double> traced = this->Render(structured);
  ExpectSame(traced, this->RenderContour(structured));
  const auto hexahedra = MakeCells(
    [](vtkUnstructuredGrid* grid, const Corners& at, const ivec3&) { AddHexahedron(grid, at); });
  EXPECT_EQ(this->Render(hexahedra), traced);
}

TEST_F(VolumeMapperCells, CellsThatAreHidden)
{
  const auto structured = MakeStructured();
  const int all = CountCovered(this->Render(structured));
  // The half with the greater x.
  for (vtkIdType point = 0; point < structured->GetNumberOfPoints(); ++point)
  {
    if (point % (Cells + 1) > Cells / 2)
    {
      structured->BlankPoint(point);
    }
  }
  const std::vector<double> half = this->Render(structured);
  EXPECT_LT(CountCovered(half), 0.75 * all);
  EXPECT_GT(CountCovered(half), 0.25 * all);
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  const auto add = [&](vtkUnstructuredGrid* grid, const Corners& at, const ivec3& index)
  {
    AddHexahedron(grid, at);
    ghosts->InsertNextValue(index.x >= Cells / 2 ? vtkDataSetAttributes::DUPLICATECELL : 0);
  };
  const auto hexahedra = MakeCells(add);
  hexahedra->GetCellData()->AddArray(ghosts);
  EXPECT_EQ(this->Render(hexahedra), half);
}

TEST_F(VolumeMapperCells, ValuesOfCellsAreAveraged)
{
  const auto grid = MakeCells(AddMixed);
  vtkNew<vtkDoubleArray> values;
  values->SetName("distance");
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    double box[6];
    grid->GetCellBounds(cell, box);
    values->InsertNextValue(
      GetValue(0.5 * dvec3(box[0] + box[1], box[2] + box[3], box[4] + box[5])));
  }
  grid->GetPointData()->Initialize();
  grid->GetCellData()->SetScalars(values);
  this->Mapper->SetIsoArrayOnCells(true);
  vtkNew<vtkCellDataToPointData> points;
  points->SetInputData(grid);
  points->Update();
  ExpectSame(this->Render(grid), this->RenderContour(points->GetOutput()));
}

TEST_F(VolumeMapperCells, ValuesChangeAndPartsAreMissing)
{
  const auto grid = MakeCells(AddMixed);
  const std::vector<double> before = this->Render(grid);
  vtkNew<vtkUnstructuredGrid> next; // of the same cells
  next->ShallowCopy(grid);
  vtkNew<vtkDoubleArray> values;
  values->DeepCopy(grid->GetPointData()->GetScalars());
  for (vtkIdType point = 0; point < values->GetNumberOfTuples(); ++point)
  {
    values->SetValue(point, 1.3 * values->GetValue(point));
  }
  next->GetPointData()->SetScalars(values);
  const std::vector<double> after = this->Render(next);
  ExpectSame(after, this->RenderContour(next));
  EXPECT_LT(CountCovered(after), CountCovered(before));
  EXPECT_EQ(this->Render(grid), before);
  for (vtkIdType point = 0; point < values->GetNumberOfTuples(); ++point)
  {
    if (next->GetPoint(point)[0] > 0.0)
    {
      values->SetValue(point, std::nan(""));
    }
  }
  values->Modified();
  next->Modified();
  EXPECT_LT(CountCovered(this->Render(next)), 0.8 * CountCovered(after));
}

TEST_F(VolumeMapperCells, BlocksOfEveryKindHaveLooks)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  const auto structured = MakeStructured();
  blocks->SetBlock(0, structured);
  blocks->SetBlock(1, MakeBall());
  const std::vector<double> first = this->Render(structured);
  const std::vector<double> second = this->Render(MakeBall());
  std::vector<double> both = this->Render(blocks);
  for (std::size_t pixel = 0; pixel < both.size(); ++pixel)
  {
    ASSERT_EQ(both[pixel], std::min(first[pixel], second[pixel]));
  }
  this->Mapper->SetBlockVisibility(1, false);
  EXPECT_EQ(this->Render(blocks), second);
}

TEST_F(VolumeMapperCells, IsosurfacesAsTriangles)
{
  const auto grid = MakeCells(AddMixed);
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfTuples(grid->GetNumberOfCells());
  ghosts->FillValue(0);
  constexpr vtkIdType hidden = 1000; // cells, from the first on
  std::fill_n(ghosts->GetPointer(0), hidden, vtkDataSetAttributes::HIDDENCELL);
  grid->GetCellData()->AddArray(ghosts);
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(1, grid);
  this->Mapper->SetInputDataObject(blocks);
  this->Renderer->AddVolume(this->Volume);
  this->Window->Render();
  vtkNew<vtkMultiBlockDataSet> surfaces;
  ASSERT_TRUE(this->Scene->ExtractIsosurfaces(this->Mapper, false, surfaces));
  ASSERT_EQ(surfaces->GetNumberOfBlocks(), 1u);
  auto* const triangles = vtkPolyData::SafeDownCast(surfaces->GetBlock(0));
  vtkDataArray* const cells = triangles->GetCellData()->GetArray("vtkOriginalCellIds");
  vtkDataArray* const normals = triangles->GetPointData()->GetNormals();
  ASSERT_GT(triangles->GetNumberOfCells(), 1000);
  for (vtkIdType number = 0; number < triangles->GetNumberOfCells(); ++number)
  {
    const auto cell = static_cast<vtkIdType>(cells->GetTuple1(number));
    EXPECT_GE(cell, hidden);
    double box[6];
    triangles->GetCellBounds(number, box);
    const dvec3 center = 0.5 * dvec3(box[0] + box[1], box[2] + box[3], box[4] + box[5]);
    EXPECT_TRUE(vtkBoundingBox(grid->GetCell(cell)->GetBounds()).ContainsPoint(&center.x));
    dvec3 normal;
    normals->GetTuple(triangles->GetCell(number)->GetPointId(0), &normal.x);
    EXPECT_GT(std::abs(glm::dot(normal, glm::normalize(center))), 0.7);
    EXPECT_EQ(triangles->GetCellData()->GetArray("vtkCompositeIndex")->GetTuple1(number), 2);
  }
}

TEST_F(VolumeMapperCells, DamagedGridsAreRefused)
{
  const auto grid = MakeCells(
    [](vtkUnstructuredGrid* cells, const Corners& at, const ivec3&) { AddHexahedron(cells, at); });
  const vtkIdType damaged[] = { 0, 1, 2, 1000000 };
  grid->InsertNextCell(VTK_TETRA, 4, damaged);
  grid->GetCellData()->Initialize();
  this->ExpectError(grid, "refers to point 1000000, but the grid has only 9261 points");
  vtkNew<vtkUnstructuredGrid> flat;
  flat->SetPoints(MakePoints());
  const vtkIdType corners[] = { 0, 1, 22 };
  flat->InsertNextCell(VTK_TRIANGLE, 3, corners);
  flat->GetPointData()->SetScalars(MakeValues(flat));
  this->ExpectError(flat, "have no volume");
}

TEST_F(VolumeMapperCells, TellTheProgressAndCanBeAborted)
{
  struct Watch
  {
    vtkDSMScene* Scene;
    vtkDSMVolumeMapper* Mapper;
    double End; ///< of the work; above 1: it is not aborted
    std::vector<double> Parts;
  } watch{ this->Scene, this->Mapper, 0.0, {} };
  vtkNew<vtkCallbackCommand> progress;
  progress->SetClientData(&watch);
  progress->SetCallback(
    [](vtkObject*, unsigned long, void* data, void*)
    {
      auto* const self = static_cast<Watch*>(data);
      if (self->Scene->IsTracing())
      {
        self->Parts.push_back(self->Mapper->GetProgress());
        self->Mapper->SetAbortExecute(self->Parts.back() >= self->End ? 1 : 0);
      }
    });
  this->Mapper->AddObserver(vtkCommand::ProgressEvent, progress);
  // While cells are sorted, and while values are found.
  for (const double end : { 0.0, 0.1, 0.7 })
  {
    watch.End = end;
    watch.Parts.clear();
    this->ExpectError(MakeCells(AddMixed), "aborted");
    ASSERT_FALSE(watch.Parts.empty());
    EXPECT_GE(watch.Parts.back(), end);
  }
  watch.End = 2.0;
  watch.Parts.clear();
  this->Mapper->SetInputDataObject(MakeCells(AddMixed));
  EXPECT_GT(CountCovered(this->RenderTraced()), 1000);
  EXPECT_FALSE(this->Errors->GetError());
  EXPECT_TRUE(std::is_sorted(watch.Parts.begin(), watch.Parts.end()));
  EXPECT_GT(watch.Parts.size(), 10u);
  EXPECT_EQ(watch.Parts.back(), 1.0);
}

TEST_F(VolumeMapperCells, SlicesAndVolumes)
{
  const auto grid = MakeCells(AddMixed);
  this->Mapper->SetNumberOfIsoValues(0);
  this->Mapper->SlicingOn();
  vtkNew<vtkPlane> plane;
  plane->SetNormal(0.0, 0.0, 1.0);
  vtkNew<vtkPlaneCollection> planes;
  planes->AddItem(plane);
  this->Mapper->SetSlicePlanes(planes);
  EXPECT_GT(CountCovered(this->Render(grid)), 3000);
  this->Mapper->SlicingOff();
  vtkNew<vtkColorTransferFunction> colors;
  colors->AddRGBPoint(0.0, 1.0, 0.8, 0.2);
  colors->AddRGBPoint(1.0, 0.2, 0.4, 1.0);
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(0.0, 0.2);
  opacity->AddPoint(0.4, 0.05);
  opacity->AddPoint(0.6, 0.0);
  this->Volume->GetProperty()->SetColor(colors);
  this->Volume->GetProperty()->SetScalarOpacity(opacity);
  this->Renderer->AddVolume(this->Volume);
  const auto cells = this->Draw(this->Mapper, grid);
  const auto structured = this->Draw(this->Mapper, MakeStructured());
  EXPECT_FALSE(this->Errors->GetError()) << this->Errors->GetErrorMessage();
  EXPECT_GT(*std::max_element(cells->Begin(), cells->End()), 60);
  EXPECT_LT(GetDifference(cells, structured), 0.5);
}
