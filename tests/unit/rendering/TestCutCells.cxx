// SPDX-License-Identifier: BSD-3-Clause
// Cells of every type as the linear cells that bricks have.
#include "vtkDSMGridCells.h"

#include "DSMCore/base/Error.h"
#include "tests/support/FixedSizeCells.h"

#include "vtkCell.h"
#include "vtkCellArray.h"
#include "vtkCellType.h"
#include "vtkGenericCell.h"
#include "vtkHigherOrderHexahedron.h"
#include "vtkHigherOrderTetra.h"
#include "vtkHigherOrderWedge.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace
{

using glm::dvec3;
using Places = std::vector<dvec3>;
using Function = std::function<dvec3(const dvec3&)>;

/// A type of cells, and the number of its points where the type does not tell.
struct Kind
{
  int Type;
  int Points = 0;
};

constexpr Kind Linear[] = { { VTK_TETRA }, { VTK_HEXAHEDRON }, { VTK_VOXEL }, { VTK_WEDGE },
  { VTK_PYRAMID } };
constexpr Kind Others[] = { { VTK_PENTAGONAL_PRISM }, { VTK_HEXAGONAL_PRISM },
  { VTK_QUADRATIC_TETRA }, { VTK_QUADRATIC_HEXAHEDRON }, { VTK_QUADRATIC_WEDGE },
  { VTK_QUADRATIC_PYRAMID }, { VTK_TRIQUADRATIC_HEXAHEDRON },
  { VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON }, { VTK_BIQUADRATIC_QUADRATIC_WEDGE },
  { VTK_QUADRATIC_LINEAR_WEDGE }, { VTK_LAGRANGE_HEXAHEDRON, 8 }, { VTK_LAGRANGE_HEXAHEDRON, 27 },
  { VTK_LAGRANGE_HEXAHEDRON, 64 }, { VTK_LAGRANGE_WEDGE, 18 }, { VTK_LAGRANGE_WEDGE, 40 },
  { VTK_LAGRANGE_TETRAHEDRON, 10 }, { VTK_LAGRANGE_TETRAHEDRON, 20 },
  { VTK_LAGRANGE_TETRAHEDRON, 35 }, { VTK_BEZIER_HEXAHEDRON, 27 }, { VTK_BEZIER_HEXAHEDRON, 64 },
  { VTK_BEZIER_WEDGE, 18 }, { VTK_BEZIER_WEDGE, 40 }, { VTK_BEZIER_TETRAHEDRON, 10 },
  { VTK_BEZIER_TETRAHEDRON, 20 } };

/// Where the points of a cell are in its parameters.
Places FindParameters(const Kind& kind)
{
  vtkNew<vtkGenericCell> generic;
  generic->SetCellType(kind.Type);
  vtkCell* const cell = generic->GetRepresentativeCell();
  if (kind.Points > 0)
  {
    cell->GetPointIds()->SetNumberOfIds(kind.Points);
    cell->GetPoints()->SetNumberOfPoints(kind.Points);
    if (auto* const hexahedron = vtkHigherOrderHexahedron::SafeDownCast(cell))
    {
      hexahedron->SetUniformOrderFromNumPoints(kind.Points);
    }
    else if (auto* const wedge = vtkHigherOrderWedge::SafeDownCast(cell))
    {
      wedge->SetUniformOrderFromNumPoints(kind.Points);
    }
    else if (vtkHigherOrderTetra::SafeDownCast(cell))
    {
      cell->Initialize();
    }
  }
  const double* const parameters = cell->GetParametricCoords();
  Places places;
  for (vtkIdType point = 0; point < cell->GetNumberOfPoints(); ++point)
  {
    places.emplace_back(
      parameters[3 * point], parameters[3 * point + 1], parameters[3 * point + 2]);
  }
  return places;
}

/// Cells of points that are found again by their places.
class CellGrid
{
public:
  CellGrid()
  {
    this->Grid->SetPoints(vtkNew<vtkPoints>());
    this->Grid->GetPoints()->SetDataTypeToDouble();
    this->Grid->AllocateEstimate(4, 64);
  }
  void Add(const Kind& kind, const Function& place = {})
  {
    const std::vector<vtkIdType> points = this->Find(FindParameters(kind), place);
    this->Grid->InsertNextCell(kind.Type, static_cast<vtkIdType>(points.size()), points.data());
  }
  void AddPolyhedron(
    const Places& places, const std::vector<std::vector<int>>& faces, const Function& place = {})
  {
    const std::vector<vtkIdType> points = this->Find(places, place);
    std::vector<vtkIdType> stream;
    for (const std::vector<int>& face : faces)
    {
      stream.push_back(static_cast<vtkIdType>(face.size()));
      for (const int corner : face)
      {
        stream.push_back(points[static_cast<std::size_t>(corner)]);
      }
    }
    this->Grid->InsertNextCell(VTK_POLYHEDRON, static_cast<vtkIdType>(points.size()), points.data(),
      static_cast<vtkIdType>(faces.size()), stream.data());
  }
  /// Moves all points.
  void Move(const Function& place)
  {
    for (vtkIdType point = 0; point < this->Grid->GetNumberOfPoints(); ++point)
    {
      dvec3 at;
      this->Grid->GetPoint(point, &at.x);
      const dvec3 moved = place(at);
      this->Grid->GetPoints()->SetPoint(point, &moved.x);
    }
  }

  vtkNew<vtkUnstructuredGrid> Grid;

private:
  std::vector<vtkIdType> Find(const Places& places, const Function& place)
  {
    std::vector<vtkIdType> points;
    for (const dvec3& at : places)
    {
      const dvec3 moved = place ? place(at) : at;
      const auto round = [](double x) { return std::llround(1e6 * x); };
      const auto [known, isNew] = this->Points.try_emplace(
        { round(moved.x), round(moved.y), round(moved.z) }, this->Grid->GetNumberOfPoints());
      if (isNew)
      {
        this->Grid->GetPoints()->InsertNextPoint(&moved.x);
      }
      points.push_back(known->second);
    }
    return points;
  }

  std::map<std::array<long long, 3>, vtkIdType> Points;
};

/// The sign tells the orientation.
double GetVolume(const std::array<dvec3, 4>& at)
{
  return glm::dot(glm::cross(at[1] - at[0], at[2] - at[0]), at[3] - at[0]) / 6.0;
}

/// The linear cells of a grid.
class LinearCells
{
public:
  explicit LinearCells(vtkUnstructuredGrid* grid)
    : Cells({ grid }, vtkDSMGridCells::Cut({ grid }, 1), 1)
  {
  }

  vtkDSMGridCells Cells;

  dvec3 GetPlace(std::uint64_t point) const
  {
    dvec3 place;
    this->Cells.GetPosition(point, &place.x);
    return place;
  }
  std::vector<std::uint64_t> GetCorners(std::uint64_t cell) const
  {
    std::vector<std::uint64_t> corners(this->Cells.HasOnlyTetrahedra() ? 4 : 8);
    this->Cells.GetCorners(cell, corners.data());
    return corners;
  }
  /// Calls `use` for the corners of the tetrahedra of a linear cell with plane faces.
  void ForEachTetrahedron(
    std::uint64_t cell, const std::function<void(const std::array<dvec3, 4>&)>& use) const
  {
    const std::vector<std::uint64_t> at = this->GetCorners(cell);
    const auto find = [&](std::size_t one, std::size_t two, std::size_t three, std::size_t four)
    {
      use({ this->GetPlace(at[one]), this->GetPlace(at[two]), this->GetPlace(at[three]),
        this->GetPlace(at[four]) });
    };
    if (at.size() == 4)
    {
      find(0, 1, 2, 3);
      return;
    }
    for (const auto& way : std::vector<std::array<std::size_t, 2>>{
           { 1, 2 }, { 2, 3 }, { 3, 7 }, { 7, 4 }, { 4, 5 }, { 5, 1 } })
    {
      find(0, way[0], way[1], 6);
    }
  }
  double AddVolumes() const
  {
    double sum = 0.0;
    for (std::uint64_t cell = 0; cell < this->Cells.GetCellCount(); ++cell)
    {
      double volume = 0.0;
      this->ForEachTetrahedron(
        cell, [&](const std::array<dvec3, 4>& at) { volume += GetVolume(at); });
      sum += this->Cells.IsShown(cell) ? std::abs(volume) : 0.0;
    }
    return sum;
  }
  /// The number of linear cells around a place.
  int CountAround(const dvec3& place) const
  {
    int count = 0;
    for (std::uint64_t cell = 0; cell < this->Cells.GetCellCount(); ++cell)
    {
      int turns = 0;
      const auto add = [&](const std::array<dvec3, 4>& at)
      {
        const double whole = GetVolume(at);
        bool isIn = whole != 0.0;
        for (std::size_t corner = 0; corner < 4; ++corner)
        {
          std::array<dvec3, 4> part = at;
          part[corner] = place;
          isIn = isIn && GetVolume(part) * whole > 0.0;
        }
        turns += isIn ? (whole > 0.0 ? 1 : -1) : 0;
      };
      if (this->Cells.IsShown(cell))
      {
        this->ForEachTetrahedron(cell, add);
      }
      count += std::abs(turns);
    }
    return count;
  }
  /// Faces of the linear cells of one cell of the grid that only one of these has, as sets of points.
  std::set<std::set<std::uint64_t>> FindSurface(vtkIdType owner) const
  {
    std::map<std::set<std::uint64_t>, int> counts;
    for (std::uint64_t cell = 0; cell < this->Cells.GetCellCount(); ++cell)
    {
      if (!this->Cells.IsShown(cell) || this->Cells.FindOwner(cell).Number != owner)
      {
        continue;
      }
      const std::vector<std::uint64_t> at = this->GetCorners(cell);
      const std::vector<std::vector<std::size_t>> faces = at.size() == 4
        ? std::vector<std::vector<std::size_t>>{ { 0, 1, 2 }, { 0, 1, 3 }, { 0, 2, 3 },
            { 1, 2, 3 } }
        : std::vector<std::vector<std::size_t>>{ { 0, 1, 2, 3 }, { 4, 5, 6, 7 }, { 0, 1, 5, 4 },
            { 1, 2, 6, 5 }, { 2, 3, 7, 6 }, { 3, 0, 4, 7 } };
      for (const std::vector<std::size_t>& face : faces)
      {
        std::set<std::uint64_t> points;
        for (const std::size_t corner : face)
        {
          points.insert(at[corner]);
        }
        counts[points] += points.size() > 2 ? 1 : 0;
      }
    }
    std::set<std::set<std::uint64_t>> surface;
    for (const auto& [face, count] : counts)
    {
      if (count == 1)
      {
        surface.insert(face);
      }
    }
    return surface;
  }
};

/// The volume within the faces of a convex cell, which are plane.
double FindVolume(vtkCell* cell)
{
  dvec3 center(0.0);
  for (vtkIdType point = 0; point < cell->GetNumberOfPoints(); ++point)
  {
    dvec3 place;
    cell->GetPoints()->GetPoint(point, &place.x);
    center += place / static_cast<double>(cell->GetNumberOfPoints());
  }
  double sum = 0.0;
  for (int face = 0; face < cell->GetNumberOfFaces(); ++face)
  {
    vtkNew<vtkIdList> corners;
    vtkNew<vtkPoints> points;
    cell->GetFace(face)->Triangulate(0, corners, points);
    for (vtkIdType first = 0; first + 2 < points->GetNumberOfPoints(); first += 3)
    {
      dvec3 at[3];
      for (vtkIdType corner = 0; corner < 3; ++corner)
      {
        points->GetPoint(first + corner, &at[corner].x);
      }
      sum += std::abs(glm::dot(glm::cross(at[0] - center, at[1] - center), at[2] - center)) / 6.0;
    }
  }
  return sum;
}

dvec3 Shear(const dvec3& at)
{
  return glm::dmat3(2.0, 0.3, -0.2, 0.4, 1.5, 0.1, -0.3, 0.2, 1.2) * at + dvec3(0.7, -0.4, 0.2);
}

dvec3 Bend(const dvec3& at)
{
  return at + 0.1 * dvec3(std::sin(2.0 * at.y), std::sin(3.0 * at.z + 1.0), std::sin(2.5 * at.x));
}

double GetLinear(const dvec3& at)
{
  return 3.0 * at.x - 2.0 * at.y + 0.5 * at.z + 1.0;
}

/// Expects that the linear cells of convex cells fill these without overlap, and have the values of a linear function.
void ExpectWhole(vtkUnstructuredGrid* grid, double volume)
{
  const LinearCells linear(grid);
  EXPECT_NEAR(
    linear.AddVolumes(), volume, 1e-6 * volume); // VTK triangulates some faces in single precision
  for (std::uint64_t point = 0; point < linear.Cells.GetPointCount(); ++point)
  {
    const double value = linear.Cells.GetValue(point,
      [&](const vtkDSMGridCells::Place& place)
      {
        dvec3 at;
        grid->GetPoint(place.Number, &at.x);
        return GetLinear(at);
      });
    EXPECT_NEAR(value, GetLinear(linear.GetPlace(point)), 1e-12);
  }
  std::mt19937 random(7);
  for (int number = 0; number < 100; ++number)
  {
    dvec3 place(0.0);
    double sum = 0.0;
    for (vtkIdType point = 0; point < grid->GetNumberOfPoints(); ++point)
    {
      dvec3 at;
      grid->GetPoint(point, &at.x);
      const double weight =
        1e-3 + std::pow(std::uniform_real_distribution<double>(0.0, 1.0)(random), 8.0);
      place += weight * at;
      sum += weight;
    }
    ASSERT_EQ(linear.CountAround(place / sum), 1) << "at random place " << number;
  }
}

/// Expects that the surfaces of two cells have faces in common, and that these are all that lie between both.
void ExpectSameFace(vtkUnstructuredGrid* grid, std::size_t most)
{
  const LinearCells linear(grid);
  vtkNew<vtkIdList> both;
  vtkNew<vtkIdList> second;
  grid->GetCellPoints(0, both);
  grid->GetCellPoints(1, second);
  both->IntersectWith(second);
  // Points of the face: of the grid, or means of these.
  std::set<std::uint64_t> between;
  for (std::uint64_t point = 0; point < linear.Cells.GetPointCount(); ++point)
  {
    bool isBetween = true;
    linear.Cells.GetValue(point,
      [&](const vtkDSMGridCells::Place& place)
      {
        isBetween = isBetween && both->IsId(place.Number) >= 0;
        return 0.0;
      });
    if (isBetween)
    {
      between.insert(point);
    }
  }
  const auto select = [&](vtkIdType owner)
  {
    std::set<std::set<std::uint64_t>> selected;
    for (const std::set<std::uint64_t>& face : linear.FindSurface(owner))
    {
      if (std::includes(between.begin(), between.end(), face.begin(), face.end()))
      {
        selected.insert(face);
      }
    }
    return selected;
  };
  const auto faces = select(0);
  EXPECT_EQ(faces, select(1));
  EXPECT_GE(faces.size(), 1u);
  EXPECT_LE(faces.size(), most);
}

std::string GetName(const Kind& kind)
{
  return "type " + std::to_string(kind.Type) + " of " + std::to_string(kind.Points) + " points";
}

} // namespace

TEST(CutCells, HaveTheVolumeOfTheCellAndLinearFields)
{
  std::vector<Kind> kinds(std::begin(Linear), std::end(Linear));
  kinds.insert(kinds.end(), std::begin(Others), std::end(Others));
  for (const Kind& kind : kinds)
  {
    SCOPED_TRACE(GetName(kind));
    for (const double side : { 1.0, -1.0 }) // inside out, too
    {
      CellGrid cell;
      cell.Add(kind, [&](const dvec3& at) { return Shear(at * dvec3(1.0, 1.0, side)); });
      const double volume = FindVolume(cell.Grid->GetCell(0));
      EXPECT_GT(volume, 0.1);
      ExpectWhole(cell.Grid, volume);
    }
  }
}

TEST(CutCells, HaveTheFacesOfTheirNeighbors)
{
  // Each kind beside its mirror image at each plane x, y or z = 0 that has a face.
  for (const Kind& kind : Others)
  {
    SCOPED_TRACE(GetName(kind));
    int count = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const Places parameters = FindParameters(kind);
      const auto inPlane = std::count_if(parameters.begin(), parameters.end(),
        [axis](const dvec3& at) { return std::abs(at[axis]) < 1e-9; });
      if (inPlane < 3)
      {
        continue;
      }
      ++count;
      CellGrid pair;
      pair.Add(kind);
      pair.Add(kind,
        [axis](dvec3 at)
        {
          at[axis] = -at[axis];
          return at;
        });
      pair.Move(Bend);
      ExpectSameFace(pair.Grid, 16);
    }
    EXPECT_GE(count, 1);
  }
  // Kinds beside others: the face of the first at the end of an axis is that of the second at its begin.
  struct Pair
  {
    Kind First;
    Kind Second;
    dvec3 Way;
  };
  const dvec3 y(0.0, 1.0, 0.0);
  const dvec3 z(0.0, 0.0, 1.0);
  for (const Pair& kinds :
    std::vector<Pair>{ { { VTK_QUADRATIC_HEXAHEDRON }, { VTK_QUADRATIC_WEDGE }, y },
      { { VTK_QUADRATIC_HEXAHEDRON }, { VTK_QUADRATIC_PYRAMID }, z },
      { { VTK_TRIQUADRATIC_HEXAHEDRON }, { VTK_BIQUADRATIC_QUADRATIC_WEDGE }, y },
      { { VTK_TRIQUADRATIC_HEXAHEDRON }, { VTK_LAGRANGE_HEXAHEDRON, 27 }, z },
      { { VTK_QUADRATIC_WEDGE }, { VTK_QUADRATIC_TETRA }, z },
      { { VTK_LAGRANGE_WEDGE, 40 }, { VTK_LAGRANGE_TETRAHEDRON, 20 }, z },
      { { VTK_LAGRANGE_HEXAHEDRON, 64 }, { VTK_LAGRANGE_WEDGE, 40 }, y },
      { { VTK_BEZIER_HEXAHEDRON, 64 }, { VTK_BEZIER_WEDGE, 40 }, y },
      { { VTK_BEZIER_WEDGE, 18 }, { VTK_BEZIER_TETRAHEDRON, 10 }, z },
      { { VTK_HEXAGONAL_PRISM }, { VTK_HEXAGONAL_PRISM }, z } })
  {
    SCOPED_TRACE(GetName(kinds.First) + ", " + GetName(kinds.Second));
    CellGrid pair;
    pair.Add(kinds.First);
    pair.Add(kinds.Second, [&](const dvec3& at) { return at + kinds.Way; });
    pair.Move(Bend);
    ExpectSameFace(pair.Grid, 16);
  }
}

TEST(CutCells, PolyhedraOfFacesOfAnyNumberOfCorners)
{
  const Places prism = FindParameters({ VTK_HEXAGONAL_PRISM });
  const std::vector<std::vector<int>> faces{ { 5, 4, 3, 2, 1, 0 }, { 6, 7, 8, 9, 10, 11 },
    { 0, 1, 7, 6 }, { 1, 2, 8, 7 }, { 2, 3, 9, 8 }, { 3, 4, 10, 9 }, { 4, 5, 11, 10 },
    { 5, 0, 6, 11 } };
  CellGrid one;
  one.AddPolyhedron(prism, faces, Shear);
  CellGrid same;
  same.Add({ VTK_HEXAGONAL_PRISM }, Shear);
  ExpectWhole(one.Grid, FindVolume(same.Grid->GetCell(0)));
  // The neighbor begins its face at another corner.
  CellGrid pair;
  pair.Add({ VTK_HEXAGONAL_PRISM });
  std::vector<std::vector<int>> turned = faces;
  std::rotate(turned[0].begin(), turned[0].begin() + 2, turned[0].end());
  pair.AddPolyhedron(prism, turned, [](const dvec3& at) { return at + dvec3(0.0, 0.0, 1.0); });
  pair.Move(Bend);
  ExpectSameFace(pair.Grid, 6);
  // A tetrahedron, and one that is flat.
  CellGrid tetrahedron;
  const Places corners = FindParameters({ VTK_TETRA });
  const std::vector<std::vector<int>> sides{ { 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 2, 0, 3 } };
  tetrahedron.AddPolyhedron(corners, sides);
  tetrahedron.AddPolyhedron(corners, sides, [](const dvec3& at) { return at * dvec3(1, 1, 0); });
  ExpectWhole(tetrahedron.Grid, 1.0 / 6.0);
}

TEST(CutCells, ConvexPointSets)
{
  CellGrid cell;
  const std::vector<vtkIdType> points{ 0, 1, 2, 3, 4, 5, 6, 7 };
  cell.Add({ VTK_HEXAHEDRON }, Shear);
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(cell.Grid->GetPoints());
  grid->AllocateEstimate(1, 8);
  grid->InsertNextCell(VTK_CONVEX_POINT_SET, 8, points.data());
  ExpectWhole(grid, FindVolume(cell.Grid->GetCell(0)));
}

TEST(CutCells, OfRepeatedPointsAndWithoutAVolume)
{
  CellGrid lattice;
  lattice.Add({ VTK_HEXAHEDRON });
  vtkUnstructuredGrid* const grid = lattice.Grid;
  const auto add = [&](int type, const std::vector<vtkIdType>& points)
  { grid->InsertNextCell(type, static_cast<vtkIdType>(points.size()), points.data()); };
  grid->GetCells()->Initialize();
  grid->Reset();
  add(VTK_HEXAHEDRON, { 0, 1, 2, 2, 4, 5, 6, 6 }); // a wedge: a half of the cube
  add(VTK_HEXAHEDRON, { 0, 2, 3, 3, 4, 6, 7, 7 }); // the other half
  add(VTK_HEXAHEDRON, { 0, 1, 2, 3, 0, 1, 2, 3 }); // flat
  add(VTK_WEDGE, { 0, 0, 0, 4, 4, 4 });            // a line
  add(VTK_TETRA, { 5, 5, 5, 5 });                  // a point
  ExpectWhole(grid, 1.0);
  // Of second degree, with all points of the upper half in one.
  const Places places = FindParameters({ VTK_QUADRATIC_HEXAHEDRON });
  CellGrid flat;
  flat.Add({ VTK_QUADRATIC_HEXAHEDRON },
    [](const dvec3& at) { return at.z > 0.5 ? dvec3(0.5, 0.5, 1.0) : at; });
  const LinearCells linear(flat.Grid);
  EXPECT_EQ(linear.Cells.GetCellCount(), 1u + 8u);
  EXPECT_TRUE(std::isfinite(linear.AddVolumes()));
}

TEST(CutCells, AreTheSameOfAllStoragesOfCells)
{
  CellGrid lattice;
  for (int cell = 0; cell < 3; ++cell)
  {
    lattice.Add({ VTK_HEXAHEDRON }, [cell](const dvec3& at) { return at + dvec3(cell, 0.0, 0.0); });
  }
  const LinearCells expected(lattice.Grid);
  for (const int storage : { 0, 1, 2, 3 })
  {
    SCOPED_TRACE(storage);
    vtkNew<vtkCellArray> cells;
    const bool isWide = storage % 2 == 1;
    isWide ? cells->Use64BitStorage() : cells->Use32BitStorage();
    if (storage > 1 && !FixedSizeCells::Use(cells, 8, isWide))
    {
      continue;
    }
    vtkNew<vtkIdList> points;
    for (vtkIdType cell = 0; cell < 3; ++cell)
    {
      lattice.Grid->GetCellPoints(cell, points);
      cells->InsertNextCell(points);
    }
    vtkNew<vtkUnstructuredGrid> grid;
    grid->SetPoints(lattice.Grid->GetPoints());
    grid->SetCells(VTK_HEXAHEDRON, cells);
    const LinearCells found(grid);
    for (std::uint64_t cell = 0; cell < 3; ++cell)
    {
      EXPECT_EQ(found.GetCorners(cell), expected.GetCorners(cell));
    }
    EXPECT_NEAR(found.AddVolumes(), 3.0, 1e-12);
  }
}
