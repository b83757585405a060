// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMCutCells.h"

#include "DSMBricks/base/ByteHash.h"
#include "DSMCore/base/Error.h"

#include "vtkBezierHexahedron.h"
#include "vtkBezierTetra.h"
#include "vtkBezierWedge.h"
#include "vtkCell.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkGenericCell.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

namespace
{

/// VTK_TRIQUADRATIC_PYRAMID, which VTK 9.1 does not have.
constexpr int TriquadraticPyramid = 37;

/// Weights of a cell's interpolation below this are rounded ones of 0.
constexpr double LeastWeight = 1e-12;

enum class Shape
{
  None,
  Polyhedron,
  Tetrahedron,
  Hexahedron,
  Wedge,
  Pyramid,
  PointSet
};

Shape GetShape(int type)
{
  switch (type)
  {
    case VTK_POLYHEDRON:
    case VTK_PENTAGONAL_PRISM:
    case VTK_HEXAGONAL_PRISM:
      return Shape::Polyhedron;
    case VTK_QUADRATIC_TETRA:
    case VTK_LAGRANGE_TETRAHEDRON:
    case VTK_BEZIER_TETRAHEDRON:
      return Shape::Tetrahedron;
    case VTK_QUADRATIC_HEXAHEDRON:
    case VTK_TRIQUADRATIC_HEXAHEDRON:
    case VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON:
    case VTK_LAGRANGE_HEXAHEDRON:
    case VTK_BEZIER_HEXAHEDRON:
      return Shape::Hexahedron;
    case VTK_QUADRATIC_WEDGE:
    case VTK_QUADRATIC_LINEAR_WEDGE:
    case VTK_BIQUADRATIC_QUADRATIC_WEDGE:
    case VTK_LAGRANGE_WEDGE:
    case VTK_BEZIER_WEDGE:
      return Shape::Wedge;
    case VTK_QUADRATIC_PYRAMID:
    case TriquadraticPyramid:
      return Shape::Pyramid;
    case VTK_CONVEX_POINT_SET:
      return Shape::PointSet;
    default:
      return Shape::None;
  }
}

/// Polynomial degrees of a cell along its axes; a tetrahedron has the first only, a wedge the first and the last.
std::array<int, 3> GetOrders(vtkCell* cell)
{
  if (auto* const hexahedron = vtkHigherOrderHexahedron::SafeDownCast(cell))
  {
    return { hexahedron->GetOrder(0), hexahedron->GetOrder(1), hexahedron->GetOrder(2) };
  }
  if (auto* const wedge = vtkHigherOrderWedge::SafeDownCast(cell))
  {
    return { wedge->GetOrder(0), wedge->GetOrder(1), wedge->GetOrder(2) };
  }
  if (auto* const tetrahedron = vtkHigherOrderTetra::SafeDownCast(cell))
  {
    const auto order = static_cast<int>(tetrahedron->GetOrder());
    return { order, order, order };
  }
  return { 2, 2, cell->GetCellType() == VTK_QUADRATIC_LINEAR_WEDGE ? 1 : 2 };
}

/// Returns whether the weights of the interpolation differ from cell to cell.
bool IsRational(vtkCell* cell)
{
  const auto has = [](auto* bezier)
  { return bezier && bezier->GetRationalWeights()->GetNumberOfTuples() > 0; };
  return has(vtkBezierHexahedron::SafeDownCast(cell)) || has(vtkBezierWedge::SafeDownCast(cell)) ||
    has(vtkBezierTetra::SafeDownCast(cell));
}

} // namespace

bool vtkDSMCutCells::IsCut(int type)
{
  return GetShape(type) != Shape::None;
}

vtkDSMCutCells::vtkDSMCutCells(vtkUnstructuredGrid* grid)
  : Grid(grid)
  , GridPoints(static_cast<std::uint64_t>(grid->GetNumberOfPoints()))
{
  vtkNew<vtkIdList> list;
  vtkNew<vtkGenericCell> generic;
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    const int type = grid->GetCellType(cell);
    if (IsCut(type))
    {
      this->Cells.push_back(cell);
      this->Cut(cell, type, list, generic);
    }
  }
  this->Known.clear();
  this->Patterns.clear();
  this->Grid = nullptr;
}

const std::uint32_t* vtkDSMCutCells::GetCorners(std::size_t cell, int& count) const
{
  const std::size_t tetrahedra = this->Owners[0].size();
  count = cell < tetrahedra ? 4 : 8;
  return cell < tetrahedra ? &this->Corners[0][4 * cell]
                           : &this->Corners[1][8 * (cell - tetrahedra)];
}

vtkIdType vtkDSMCutCells::GetOwner(std::size_t cell) const
{
  const std::size_t tetrahedra = this->Owners[0].size();
  return cell < tetrahedra ? this->Owners[0][cell] : this->Owners[1][cell - tetrahedra];
}

std::uint32_t vtkDSMCutCells::CheckPoint(vtkIdType cell, vtkIdType point) const
{
  if (point < 0 || static_cast<std::uint64_t>(point) >= this->GridPoints)
  {
    throw dsm::Error("Cell " + std::to_string(cell) + " of the unstructured grid refers to point " +
      std::to_string(point) + ", but the grid has only " + std::to_string(this->GridPoints) +
      " points. Check the dataset's cells.");
  }
  return static_cast<std::uint32_t>(point);
}

void vtkDSMCutCells::Cut(vtkIdType cell, int type, vtkIdList* list, vtkGenericCell* generic)
{
  std::vector<std::vector<std::uint32_t>> faces;
  if (type == VTK_POLYHEDRON)
  {
    this->Grid->GetFaceStream(cell, list); // count of faces; for each, count of points and points
    const vtkIdType* next = list->GetPointer(0);
    const vtkIdType count = list->GetNumberOfIds() > 0 ? *next++ : 0;
    for (vtkIdType face = 0; face < count; ++face)
    {
      std::vector<std::uint32_t>& points = faces.emplace_back();
      for (vtkIdType left = *next++; left > 0; --left)
      {
        points.push_back(this->CheckPoint(cell, *next++));
      }
    }
    this->CutPolyhedron(cell, faces);
    return;
  }
  this->Grid->GetCellPoints(cell, list);
  for (vtkIdType index = 0; index < list->GetNumberOfIds(); ++index)
  {
    this->CheckPoint(cell, list->GetId(index));
  }
  this->Grid->GetCell(cell, generic);
  vtkCell* const nodes = generic->GetRepresentativeCell();
  if (GetShape(type) == Shape::PointSet)
  {
    this->CutByVtk(cell, nodes);
    return;
  }
  if (GetShape(type) != Shape::Polyhedron)
  {
    this->CutNonlinear(cell, type, nodes);
    return;
  }
  for (int face = 0; face < nodes->GetNumberOfFaces(); ++face)
  {
    vtkIdList* const ids = nodes->GetFace(face)->GetPointIds();
    std::vector<std::uint32_t>& points = faces.emplace_back();
    for (vtkIdType index = 0; index < ids->GetNumberOfIds(); ++index)
    {
      points.push_back(static_cast<std::uint32_t>(ids->GetId(index)));
    }
  }
  this->CutPolyhedron(cell, faces);
}

void vtkDSMCutCells::CutPolyhedron(
  vtkIdType cell, const std::vector<std::vector<std::uint32_t>>& faces)
{
  std::vector<std::uint32_t> all;
  for (const std::vector<std::uint32_t>& face : faces)
  {
    all.insert(all.end(), face.begin(), face.end());
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  if (all.size() < 4)
  {
    return;
  }
  if (all.size() == 4)
  {
    this->AddCell(cell, all);
    return;
  }
  const std::uint32_t center = this->AddMean(all, false);
  for (const std::vector<std::uint32_t>& face : faces)
  {
    if (face.size() == 3)
    {
      this->AddCell(cell, { face[0], face[1], face[2], center });
    }
    else if (face.size() == 4)
    {
      this->AddCell(cell, { face[0], face[1], face[2], face[3], center, center, center, center });
    }
    else if (face.size() > 4)
    {
      const std::uint32_t middle = this->AddMean(face, true);
      for (std::size_t corner = 0; corner < face.size(); ++corner)
      {
        this->AddCell(cell, { face[corner], face[(corner + 1) % face.size()], middle, center });
      }
    }
  }
}

void vtkDSMCutCells::CutNonlinear(vtkIdType cell, int type, vtkCell* nodes)
{
  const bool isRational = IsRational(nodes);
  const Pattern own = isRational ? MakePattern(type, nodes) : Pattern();
  const Pattern& pattern = isRational ? own : this->FindPattern(type, nodes);
  std::vector<std::uint32_t> points;
  for (const Blend& node : pattern.Nodes)
  {
    Blend blend;
    for (const Weighted& one : node)
    {
      const vtkIdType point = nodes->GetPointId(static_cast<vtkIdType>(one.Point));
      blend.push_back({ static_cast<std::uint32_t>(point), one.Weight });
    }
    points.push_back(this->AddPoint(std::move(blend), true));
  }
  for (const std::vector<std::uint32_t>& linear : pattern.Cells)
  {
    std::vector<std::uint32_t> corners;
    for (const std::uint32_t node : linear)
    {
      corners.push_back(points[node]);
    }
    this->AddCell(cell, corners);
  }
}

void vtkDSMCutCells::CutByVtk(vtkIdType cell, vtkCell* nodes)
{
  vtkNew<vtkIdList> corners;
  vtkNew<vtkPoints> points;
  nodes->Triangulate(0, corners, points);
  for (vtkIdType first = 0; first + 3 < corners->GetNumberOfIds(); first += 4)
  {
    std::vector<std::uint32_t> four;
    for (vtkIdType corner = first; corner < first + 4; ++corner)
    {
      four.push_back(this->CheckPoint(cell, corners->GetId(corner)));
    }
    this->AddCell(cell, four);
  }
}

const vtkDSMCutCells::Pattern& vtkDSMCutCells::FindPattern(int type, vtkCell* nodes)
{
  const std::array<int, 3> orders = GetOrders(nodes);
  const PatternKey key{ type, static_cast<int>(nodes->GetNumberOfPoints()), orders[0], orders[1],
    orders[2] };
  const auto known = this->Patterns.find(key);
  return known != this->Patterns.end()
    ? known->second
    : this->Patterns.emplace(key, MakePattern(type, nodes)).first->second;
}

vtkDSMCutCells::Pattern vtkDSMCutCells::MakePattern(int type, vtkCell* nodes)
{
  const std::array<int, 3> orders = GetOrders(nodes);
  const Shape shape = GetShape(type);
  if (shape == Shape::Pyramid)
  {
    return MakePyramid(nodes->GetNumberOfPoints());
  }
  Places places;
  std::vector<double> weights(static_cast<std::size_t>(nodes->GetNumberOfPoints()));
  Pattern pattern = shape == Shape::Hexahedron ? MakeHexahedron(orders.data(), places)
    : shape == Shape::Wedge                    ? MakeWedge(orders[0], orders[2], places)
                                               : MakeTetrahedron(orders[0], places);
  for (const std::array<double, 3>& place : places)
  {
    nodes->InterpolateFunctions(place.data(), weights.data());
    Blend& blend = pattern.Nodes.emplace_back();
    for (std::size_t node = 0; node < weights.size(); ++node)
    {
      if (std::abs(weights[node] - 1.0) < LeastWeight)
      {
        blend = { { static_cast<std::uint32_t>(node), 1.0 } };
        break;
      }
      if (std::abs(weights[node]) > LeastWeight)
      {
        blend.push_back({ static_cast<std::uint32_t>(node), weights[node] });
      }
    }
  }
  return pattern;
}

vtkDSMCutCells::Pattern vtkDSMCutCells::MakeHexahedron(const int orders[3], Places& places)
{
  Pattern pattern;
  const auto at = [&](int i, int j, int k)
  { return static_cast<std::uint32_t>(i + (orders[0] + 1) * (j + (orders[1] + 1) * k)); };
  for (int k = 0; k <= orders[2]; ++k)
  {
    for (int j = 0; j <= orders[1]; ++j)
    {
      for (int i = 0; i <= orders[0]; ++i)
      {
        places.push_back({ static_cast<double>(i) / orders[0], static_cast<double>(j) / orders[1],
          static_cast<double>(k) / orders[2] });
        if (i < orders[0] && j < orders[1] && k < orders[2])
        {
          pattern.Cells.push_back(
            { at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k), at(i, j, k + 1),
              at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1) });
        }
      }
    }
  }
  return pattern;
}

vtkDSMCutCells::Pattern vtkDSMCutCells::MakeWedge(int order, int layers, Places& places)
{
  Pattern pattern;
  std::map<std::array<int, 3>, std::uint32_t> nodes;
  for (int k = 0; k <= layers; ++k)
  {
    for (int j = 0; j <= order; ++j)
    {
      for (int i = 0; i + j <= order; ++i)
      {
        nodes[{ i, j, k }] = static_cast<std::uint32_t>(places.size());
        places.push_back({ static_cast<double>(i) / order, static_cast<double>(j) / order,
          static_cast<double>(k) / layers });
      }
    }
  }
  const auto add = [&](std::array<int, 3> a, std::array<int, 3> b, std::array<int, 3> c)
  {
    const auto above = [&](std::array<int, 3> node) {
      return nodes.at({ node[0], node[1], node[2] + 1 });
    };
    pattern.Cells.push_back({ nodes.at(a), nodes.at(b), nodes.at(c), nodes.at(c), above(a),
      above(b), above(c), above(c) });
  };
  for (const auto& [node, number] : nodes)
  {
    const auto [i, j, k] = node;
    if (k < layers && i + j < order)
    {
      add(node, { i + 1, j, k }, { i, j + 1, k });
    }
    if (k < layers && i + j + 1 < order)
    {
      add({ i + 1, j, k }, { i + 1, j + 1, k }, { i, j + 1, k });
    }
  }
  return pattern;
}

vtkDSMCutCells::Pattern vtkDSMCutCells::MakeTetrahedron(int order, Places& places)
{
  using Node = std::array<int, 3>;
  Pattern pattern;
  std::map<Node, std::uint32_t> nodes;
  for (int k = 0; k <= order; ++k)
  {
    for (int j = 0; j + k <= order; ++j)
    {
      for (int i = 0; i + j + k <= order; ++i)
      {
        nodes[{ i, j, k }] = static_cast<std::uint32_t>(places.size());
        places.push_back({ static_cast<double>(i) / order, static_cast<double>(j) / order,
          static_cast<double>(k) / order });
      }
    }
  }
  for (const auto& [node, number] : nodes)
  {
    const auto [i, j, k] = node;
    const int left = order - i - j - k;
    const auto at = [&, i = i, j = j, k = k](int x, int y, int z) {
      return nodes.at({ i + x, j + y, k + z });
    };
    if (left > 0)
    {
      pattern.Cells.push_back({ number, at(1, 0, 0), at(0, 1, 0), at(0, 0, 1) });
    }
    if (left > 1)
    {
      // An octahedron, around one of its diagonals.
      const std::uint32_t ring[4] = { at(0, 1, 0), at(1, 1, 0), at(1, 0, 1), at(0, 0, 1) };
      for (int side = 0; side < 4; ++side)
      {
        pattern.Cells.push_back({ at(1, 0, 0), at(0, 1, 1), ring[side], ring[(side + 1) % 4] });
      }
    }
    if (left > 2)
    {
      pattern.Cells.push_back({ at(1, 1, 0), at(1, 0, 1), at(0, 1, 1), at(1, 1, 1) });
    }
  }
  return pattern;
}

vtkDSMCutCells::Pattern vtkDSMCutCells::MakePyramid(vtkIdType nodes)
{
  constexpr std::uint32_t apex = 4;
  constexpr std::uint32_t edges = 5; // nodes in the middles of the base's edges, and of the others
  constexpr std::uint32_t sides = 9;
  constexpr std::uint32_t middle = 13; // of the base
  Pattern pattern;
  for (std::uint32_t node = 0; node < middle; ++node)
  {
    pattern.Nodes.push_back({ { node, 1.0 } });
  }
  if (nodes > middle)
  {
    pattern.Nodes.push_back({ { middle, 1.0 } });
  }
  else
  {
    Blend& blend = pattern.Nodes.emplace_back();
    for (std::uint32_t corner = 0; corner < 4; ++corner)
    {
      blend.push_back({ corner, -0.25 });
      blend.push_back({ edges + corner, 0.5 });
    }
  }
  for (std::uint32_t corner = 0; corner < 4; ++corner)
  {
    const std::uint32_t next = (corner + 1) % 4;
    const std::uint32_t before = edges + (corner + 3) % 4;
    const std::uint32_t up = sides + corner;
    pattern.Cells.push_back({ corner, edges + corner, middle, before, up, up, up, up });
    pattern.Cells.push_back({ edges + corner, up, sides + next, middle });
  }
  pattern.Cells.push_back({ sides, sides + 1, sides + 2, sides + 3, apex, apex, apex, apex });
  pattern.Cells.push_back(
    { sides, sides + 1, sides + 2, sides + 3, middle, middle, middle, middle });
  return pattern;
}

void vtkDSMCutCells::AddCell(vtkIdType cell, const std::vector<std::uint32_t>& corners)
{
  const int kind = corners.size() == 4 ? 0 : 1;
  this->Corners[kind].insert(this->Corners[kind].end(), corners.begin(), corners.end());
  this->Owners[kind].push_back(cell);
}

std::uint32_t vtkDSMCutCells::AddMean(const std::vector<std::uint32_t>& points, bool isShared)
{
  Blend blend;
  for (const std::uint32_t point : points)
  {
    blend.push_back({ point, 1.0 / static_cast<double>(points.size()) });
  }
  return this->AddPoint(std::move(blend), isShared);
}

std::uint32_t vtkDSMCutCells::AddPoint(Blend blend, bool isShared)
{
  if (blend.size() == 1)
  {
    return blend.front().Point;
  }
  vtkPoints* const points = this->Grid->GetPoints();
  const auto rank = [points](const Weighted& one)
  {
    double place[3];
    points->GetPoint(static_cast<vtkIdType>(one.Point), place);
    return std::make_tuple(one.Weight, place[0], place[1], place[2], one.Point);
  };
  // Another rank that has the face may number its points in another order.
  std::sort(blend.begin(), blend.end(),
    [&](const Weighted& one, const Weighted& other) { return rank(one) < rank(other); });
  std::vector<std::uint32_t> ids;
  std::vector<double> weights;
  for (const Weighted& one : blend)
  {
    ids.push_back(one.Point);
    weights.push_back(one.Weight);
  }
  const std::vector<double>* const kept = &*this->AllWeights.insert(std::move(weights)).first;
  bricks::ByteHash hash;
  hash.Add(ids.data(), ids.size() * sizeof(ids[0]));
  const auto [first, last] = this->Known.equal_range(hash.Get());
  for (auto known = first; isShared && known != last; ++known)
  {
    const std::uint32_t point = known->second;
    if (this->Weights[point] == kept &&
      std::equal(ids.begin(), ids.end(), &this->Ids[this->Begins[point]]))
    {
      return static_cast<std::uint32_t>(this->GridPoints + point);
    }
  }
  const std::uint64_t number = this->GridPoints + this->Begins.size();
  if (number > std::numeric_limits<std::uint32_t>::max())
  {
    throw dsm::Error("The cells of an unstructured grid have too many points on one rank. Use more "
                     "ranks.");
  }
  if (isShared)
  {
    this->Known.emplace(hash.Get(), static_cast<std::uint32_t>(this->Begins.size()));
  }
  this->Begins.push_back(this->Ids.size());
  this->Ids.insert(this->Ids.end(), ids.begin(), ids.end());
  this->Weights.push_back(kept);
  return static_cast<std::uint32_t>(number);
}
