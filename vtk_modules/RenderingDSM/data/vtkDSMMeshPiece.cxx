// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMMeshPiece.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>

namespace
{

/// As VTK: those of the cells where points have none.
vtkDataArray* FindNormals(vtkPolyData* data, bricks::Attachment& attachment)
{
  vtkDataArray* normals = data->GetPointData()->GetNormals();
  attachment = bricks::Attachment::Points;
  if (normals && normals->GetNumberOfTuples() == data->GetNumberOfPoints())
  {
    return normals;
  }
  normals = data->GetCellData()->GetNormals();
  attachment = bricks::Attachment::Triangles;
  if (normals && normals->GetNumberOfTuples() == data->GetNumberOfCells())
  {
    return normals;
  }
  attachment = bricks::Attachment::None;
  return nullptr;
}

vtkDataArray* FindTextureCoordinates(vtkPolyData* data)
{
  vtkDataArray* coordinates = data->GetPointData()->GetTCoords();
  return coordinates && coordinates->GetNumberOfComponents() >= 2 &&
      coordinates->GetNumberOfTuples() == data->GetNumberOfPoints()
    ? coordinates
    : nullptr;
}

} // namespace

bricks::MeshAttributes vtkDSMMeshPiece::GetAttributes(
  vtkPolyData* data, const vtkDSMMeshColors& colors, const vtkDSMMeshWish& wish, bool isSolid)
{
  bricks::MeshAttributes attributes;
  attributes.TextureCoordinates = wish.TextureCoordinates && FindTextureCoordinates(data);
  attributes.Radii = isSolid;
  if (!isSolid)
  {
    attributes.EdgeFlags = wish.EdgeFlags;
    FindNormals(data, attributes.Normals);
  }
  attributes.Values = colors.GetValues();
  attributes.Colors = colors.GetColors();
  return attributes;
}

void vtkDSMMeshPiece::Add(vtkPolyData* data, const vtkDSMMeshColors& colors,
  const vtkDSMMeshWish& wish, const vtkDSMTubesAndSpheres* solids)
{
  this->Attributes = GetAttributes(data, colors, wish, solids != nullptr);
  this->Parts.push_back(
    { data, solids ? vtkDSMTriangleList(data, *solids) : vtkDSMTriangleList(data), colors,
      data->GetPoints()->GetData(), solids ? nullptr : FindNormals(data, this->Attributes.Normals),
      FindTextureCoordinates(data), this->Triangles, this->Points });
  this->Triangles += this->Parts.back().List.GetCount();
  this->Points += static_cast<std::uint64_t>(data->GetNumberOfPoints());
}

const vtkDSMMeshPiece::Part& vtkDSMMeshPiece::FindByTriangle(std::uint64_t triangle) const
{
  return *std::prev(std::upper_bound(this->Parts.begin(), this->Parts.end(), triangle,
    [](std::uint64_t number, const Part& part) { return number < part.FirstTriangle; }));
}

const vtkDSMMeshPiece::Part& vtkDSMMeshPiece::FindByPoint(std::uint64_t point) const
{
  return *std::prev(std::upper_bound(this->Parts.begin(), this->Parts.end(), point,
    [](std::uint64_t number, const Part& part) { return number < part.FirstPoint; }));
}

void vtkDSMMeshPiece::GetTriangle(std::uint64_t triangle, std::uint64_t points[3]) const
{
  const Part& part = this->FindByTriangle(triangle);
  part.List.GetTriangle(triangle - part.FirstTriangle, points);
  const auto size = static_cast<std::uint64_t>(part.Data->GetNumberOfPoints());
  for (int corner = 0; corner < 3; ++corner)
  {
    // A point that the part does not have must not become another part's.
    points[corner] = points[corner] < size ? part.FirstPoint + points[corner]
                                           : std::max(points[corner], this->Points);
  }
}

void vtkDSMMeshPiece::GetPosition(std::uint64_t point, double position[3]) const
{
  const Part& part = this->FindByPoint(point);
  part.Positions->GetTuple(static_cast<vtkIdType>(point - part.FirstPoint), position);
}

void vtkDSMMeshPiece::GetNormal(std::uint64_t element, double normal[3]) const
{
  vtkIdType number = 0;
  const Part& part = this->FindElement(this->Attributes.Normals, element, number);
  part.Normals->GetTuple(number, normal);
}

const vtkDSMMeshPiece::Part& vtkDSMMeshPiece::FindElement(
  bricks::Attachment attachment, std::uint64_t element, vtkIdType& number) const
{
  if (attachment == bricks::Attachment::Points)
  {
    const Part& part = this->FindByPoint(element);
    number = static_cast<vtkIdType>(element - part.FirstPoint);
    return part;
  }
  const Part& part = this->FindByTriangle(element);
  number = part.List.GetCell(element - part.FirstTriangle);
  return part;
}

double vtkDSMMeshPiece::GetValue(std::uint64_t element) const
{
  vtkIdType number = 0;
  const Part& part = this->FindElement(this->Attributes.Values, element, number);
  return part.Colors.GetValue(number);
}

void vtkDSMMeshPiece::GetColor(std::uint64_t element, std::uint8_t rgba[4]) const
{
  vtkIdType number = 0;
  const Part& part = this->FindElement(this->Attributes.Colors, element, number);
  part.Colors.GetColor(number, rgba);
}

void vtkDSMMeshPiece::GetTextureCoordinate(std::uint64_t point, double coordinate[2]) const
{
  const Part& part = this->FindByPoint(point);
  const auto number = static_cast<vtkIdType>(point - part.FirstPoint);
  coordinate[0] = part.TextureCoordinates->GetComponent(number, 0);
  coordinate[1] = part.TextureCoordinates->GetComponent(number, 1);
}

unsigned vtkDSMMeshPiece::GetEdgeFlags(std::uint64_t triangle) const
{
  const Part& part = this->FindByTriangle(triangle);
  return part.List.GetEdgeFlags(triangle - part.FirstTriangle);
}

double vtkDSMMeshPiece::GetRadius(std::uint64_t triangle, int corner) const
{
  const Part& part = this->FindByTriangle(triangle);
  return part.List.GetRadius(triangle - part.FirstTriangle, corner);
}
