// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMTubesAndSpheres.h"

#include "DSMCore/base/Error.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSphereSource.h"
#include "vtkTubeFilter.h"

namespace
{

constexpr int TubeSides = 12;
constexpr int SphereTheta = 12;
constexpr int SpherePhi = 9;
/// Triangles of a sphere of that resolution: two fans, and rows of quads between them.
constexpr int SphereTriangles = 2 * SphereTheta * (SpherePhi - 2);

/// The data's arrays that have as many tuples as there are elements; others cannot be followed.
void CopyWhole(vtkDataSetAttributes* from, vtkIdType elements, vtkDataSetAttributes* to)
{
  for (int index = 0; index < from->GetNumberOfArrays(); ++index)
  {
    vtkAbstractArray* array = from->GetAbstractArray(index);
    if (array->GetNumberOfTuples() == elements)
    {
      to->AddArray(array);
    }
  }
}

vtkDataArray* FindRadii(vtkPolyData* data, const std::string& name)
{
  if (name.empty())
  {
    return nullptr;
  }
  vtkDataArray* radii = data->GetPointData()->GetArray(name.c_str());
  if (!radii || radii->GetNumberOfComponents() != 1 ||
    radii->GetNumberOfTuples() != data->GetNumberOfPoints())
  {
    throw dsm::Error("The radius array '" + name +
      "' must be a point array with one number per point. Choose another array or none.");
  }
  return radii;
}

} // namespace

vtkDSMTubesAndSpheres::vtkDSMTubesAndSpheres(
  double lineRadius, double pointRadius, const std::string& radiusArray)
  : LineRadius(lineRadius)
  , PointRadius(pointRadius)
  , RadiusArray(radiusArray)
{
}

std::uint64_t vtkDSMTubesAndSpheres::EstimateTriangles(vtkPolyData* data) const
{
  const vtkIdType tubes =
    this->LineRadius > 0.0 ? 2 * TubeSides * data->GetLines()->GetNumberOfConnectivityIds() : 0;
  const vtkIdType spheres =
    this->PointRadius > 0.0 ? SphereTriangles * data->GetVerts()->GetNumberOfConnectivityIds() : 0;
  return static_cast<std::uint64_t>(tubes + spheres);
}

vtkSmartPointer<vtkPolyData> vtkDSMTubesAndSpheres::MakeTubes(vtkPolyData* data) const
{
  if (!(this->LineRadius > 0.0) || data->GetNumberOfLines() == 0)
  {
    return nullptr;
  }
  vtkNew<vtkPolyData> lines;
  lines->SetPoints(data->GetPoints());
  lines->SetLines(data->GetLines());
  CopyWhole(data->GetPointData(), data->GetNumberOfPoints(), lines->GetPointData());
  vtkNew<vtkCellData> cells;
  CopyWhole(data->GetCellData(), data->GetNumberOfCells(), cells);
  lines->GetCellData()->CopyAllOn();
  lines->GetCellData()->CopyAllocate(cells, data->GetNumberOfLines());
  for (vtkIdType line = 0; line < data->GetNumberOfLines(); ++line)
  {
    lines->GetCellData()->CopyData(cells, data->GetNumberOfVerts() + line, line);
  }
  vtkNew<vtkTubeFilter> tubes;
  tubes->SetInputData(lines);
  tubes->SetRadius(this->LineRadius);
  tubes->SetNumberOfSides(TubeSides);
  tubes->CappingOn();
  if (vtkDataArray* factors = FindRadii(data, this->RadiusArray))
  {
    vtkNew<vtkDoubleArray> radii;
    radii->SetNumberOfTuples(factors->GetNumberOfTuples());
    for (vtkIdType point = 0; point < factors->GetNumberOfTuples(); ++point)
    {
      const double radius = this->LineRadius * factors->GetComponent(point, 0);
      radii->SetValue(point, radius > 0.0 ? radius : 0.0);
    }
    lines->GetPointData()->SetScalars(radii);
    tubes->SetVaryRadiusToVaryRadiusByAbsoluteScalar();
  }
  tubes->Update();
  return tubes->GetOutput();
}

vtkSmartPointer<vtkPolyData> vtkDSMTubesAndSpheres::MakeSpheres(vtkPolyData* data) const
{
  if (!(this->PointRadius > 0.0) || data->GetNumberOfVerts() == 0)
  {
    return nullptr;
  }
  vtkNew<vtkSphereSource> source;
  source->SetThetaResolution(SphereTheta);
  source->SetPhiResolution(SpherePhi);
  source->SetRadius(1.0);
  source->Update();
  vtkPolyData* sphere = source->GetOutput();
  vtkDataArray* directions = sphere->GetPointData()->GetNormals();
  vtkDataArray* radii = FindRadii(data, this->RadiusArray);

  vtkNew<vtkPointData> pointArrays;
  vtkNew<vtkCellData> cellArrays;
  CopyWhole(data->GetPointData(), data->GetNumberOfPoints(), pointArrays);
  CopyWhole(data->GetCellData(), data->GetNumberOfCells(), cellArrays);
  auto spheres = vtkSmartPointer<vtkPolyData>::New();
  const vtkIdType count = data->GetVerts()->GetNumberOfConnectivityIds();
  spheres->GetPointData()->CopyAllOn();
  spheres->GetPointData()->CopyAllocate(pointArrays, count * sphere->GetNumberOfPoints());
  spheres->GetCellData()->CopyAllOn();
  spheres->GetCellData()->CopyAllocate(cellArrays, count * sphere->GetNumberOfCells());
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkFloatArray> normals;
  normals->SetName("SphereNormals");
  normals->SetNumberOfComponents(3);
  vtkNew<vtkCellArray> triangles;

  const auto addSphere = [&](vtkIdType cell, vtkIdType point)
  {
    const double radius = this->PointRadius * (radii ? radii->GetComponent(point, 0) : 1.0);
    if (!(radius > 0.0))
    {
      return;
    }
    double center[3];
    data->GetPoint(point, center);
    const vtkIdType first = points->GetNumberOfPoints();
    for (vtkIdType vertex = 0; vertex < sphere->GetNumberOfPoints(); ++vertex)
    {
      double offset[3];
      directions->GetTuple(vertex, offset);
      normals->InsertNextTuple(offset);
      points->InsertNextPoint(center[0] + radius * offset[0], center[1] + radius * offset[1],
        center[2] + radius * offset[2]);
      spheres->GetPointData()->CopyData(pointArrays, point, first + vertex);
    }
    for (vtkIdType face = 0; face < sphere->GetNumberOfPolys(); ++face)
    {
      vtkIdType size = 0;
      const vtkIdType* corners = nullptr;
      sphere->GetPolys()->GetCellAtId(face, size, corners);
      const vtkIdType moved[3] = { first + corners[0], first + corners[1], first + corners[2] };
      spheres->GetCellData()->CopyData(cellArrays, cell, triangles->InsertNextCell(3, moved));
    }
  };
  for (vtkIdType cell = 0; cell < data->GetNumberOfVerts(); ++cell)
  {
    vtkIdType size = 0;
    const vtkIdType* members = nullptr;
    data->GetVerts()->GetCellAtId(cell, size, members);
    for (vtkIdType member = 0; member < size; ++member)
    {
      addSphere(cell, members[member]);
    }
  }
  spheres->SetPoints(points);
  spheres->SetPolys(triangles);
  spheres->GetPointData()->SetNormals(normals);
  return spheres;
}
