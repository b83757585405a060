// SPDX-License-Identifier: BSD-3-Clause
// The edges of polygons on their surfaces, against VTK's own mapper and by what must be where.
#include "PolyDataMapperTest.h"

#include "vtkPlaneSource.h"
#include "vtkUnsignedCharArray.h"

#include <cmath>
#include <vector>

namespace
{

/// Regular polygons beside one another, each a cell.
vtkSmartPointer<vtkPolyData> MakePolygons()
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> polygons;
  for (int size = 3; size < 12; ++size)
  {
    const double x = 0.6 * (size % 3 - 1);
    const double y = 0.6 * (size / 3 - 2);
    polygons->InsertNextCell(size);
    for (int corner = 0; corner < size; ++corner)
    {
      const double angle = 6.28318530718 * corner / size + 0.3;
      polygons->InsertCellPoint(
        points->InsertNextPoint(x + 0.28 * std::cos(angle), y + 0.28 * std::sin(angle), 0.0));
    }
  }
  data->SetPoints(points);
  data->SetPolys(polygons);
  return data;
}

vtkSmartPointer<vtkPolyData> MakeQuads()
{
  vtkNew<vtkPlaneSource> plane;
  plane->SetOrigin(-0.8, -0.8, 0.0);
  plane->SetPoint1(0.8, -0.8, 0.3);
  plane->SetPoint2(-0.8, 0.8, -0.2);
  plane->SetResolution(7, 5);
  plane->Update();
  return plane->GetOutput();
}

vtkSmartPointer<vtkPolyData> MakeTriangles()
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(12);
  sphere->SetPhiResolution(9);
  sphere->SetRadius(0.9);
  sphere->Update();
  return sphere->GetOutput();
}

class PolyDataMapperEdges : public PolyDataMapper
{
protected:
  PolyDataMapperEdges()
  {
    this->Mapper->ScalarVisibilityOff();
    this->Actor->GetProperty()->SetEdgeVisibility(1);
    this->Actor->GetProperty()->SetEdgeColor(0.1, 0.3, 0.9);
    this->Actor->GetProperty()->SetColor(0.9, 0.8, 0.3);
  }

  /// World coordinates from -1 to 1, flat colors.
  void LookStraightOn()
  {
    this->Renderer->GetActiveCamera()->SetPosition(0.0, 0.0, 4.0);
    this->Renderer->GetActiveCamera()->ParallelProjectionOn();
    this->Renderer->GetActiveCamera()->SetParallelScale(1.0);
    this->Actor->GetProperty()->LightingOff();
    this->Actor->GetProperty()->SetColor(1.0, 1.0, 1.0);
    this->Actor->GetProperty()->SetEdgeColor(1.0, 0.0, 0.0);
  }

  static std::vector<int> GetColor(const Picture& picture, double x, double y)
  {
    const auto column = static_cast<std::size_t>((x + 1.0) / 2.0 * Size);
    const auto row = static_cast<std::size_t>((y + 1.0) / 2.0 * Size);
    const int* color = &picture[3 * (row * Size + column)];
    return { color, color + 3 };
  }

  const std::vector<int> Nothing{ 0, 0, 0 };
  const std::vector<int> Red{ 255, 0, 0 };
  const std::vector<int> White{ 255, 255, 255 };
};

} // namespace

TEST_F(PolyDataMapperEdges, AreVtks)
{
  for (const auto& data : { MakeQuads(), MakePolygons(), MakeTriangles() })
  {
    this->Mapper->SetInputData(data);
    for (const float width : { 1.0f, 3.0f, 6.0f })
    {
      this->Actor->GetProperty()->SetLineWidth(width);
      // At a surface's border VTK's lines reach beyond it by a quarter of their width.
      const bool isMostlyBorder = data->GetNumberOfCells() == 9;
      const double share = isMostlyBorder ? 0.002 + 0.0055 * width : 0.005 + 0.001 * width;
      const Picture picture = this->Render();
      ExpectAlike(picture, this->RenderWithTriangles(data), share);
      this->Actor->GetProperty()->EdgeVisibilityOff();
      EXPECT_NE(this->Render(), picture);
      this->Actor->GetProperty()->EdgeVisibilityOn();
    }
  }
}

TEST_F(PolyDataMapperEdges, CutsThroughPolygonsAreNone)
{
  this->LookStraightOn();
  this->Actor->GetProperty()->SetLineWidth(4.0);
  // A quad, and a concave polygon.
  const auto data = MakeCells({ { -0.9, -0.8 }, { -0.1, -0.8 }, { -0.1, 0.8 }, { -0.9, 0.8 },
    { 0.1, -0.8 }, { 0.9, -0.8 }, { 0.9, 0.8 }, { 0.5, -0.2 }, { 0.1, 0.8 } });
  vtkNew<vtkCellArray> polygons;
  Connect(polygons, { 0, 1, 2, 3 });
  Connect(polygons, { 4, 5, 6, 7, 8 });
  data->SetPolys(polygons);
  this->Mapper->SetInputData(data);
  const Picture picture = this->Render();
  for (double y = -0.7; y < 0.71; y += 0.05)
  {
    EXPECT_EQ(GetColor(picture, -0.5 + 0.5 * y, y), this->White) << "diagonal at " << y;
    EXPECT_EQ(GetColor(picture, -0.5 - 0.5 * y, y), this->White) << "diagonal at " << y;
    EXPECT_EQ(GetColor(picture, -0.893, y), this->Red) << "border at " << y;
    EXPECT_EQ(GetColor(picture, 0.107, y), this->Red) << "border at " << y;
    EXPECT_EQ(GetColor(picture, 0.893, y), this->Red) << "border at " << y;
  }
  // The notch of the concave one has edges, and what is cut from it to the other corners is none.
  EXPECT_EQ(GetColor(picture, 0.7, 0.28), this->Red);
  for (double y = -0.7; y < -0.25; y += 0.05)
  {
    EXPECT_EQ(GetColor(picture, 0.5, y), this->White) << y;
    EXPECT_EQ(GetColor(picture, 0.2, y), this->White) << y;
    EXPECT_EQ(GetColor(picture, 0.8, y), this->White) << y;
  }
  EXPECT_EQ(GetColor(picture, 0.5, 0.2), this->Nothing);
}

TEST_F(PolyDataMapperEdges, TurningThemOnAndOffKeepsBricksWhereItCan)
{
  this->Actor->GetProperty()->EdgeVisibilityOff();
  const auto triangles = MakeTriangles();
  this->Mapper->SetInputData(triangles);
  const Picture plain = this->Render();
  this->Actor->GetProperty()->EdgeVisibilityOn();
  EXPECT_NE(this->Render(), plain);
  EXPECT_FALSE(this->Building) << "all sides of triangles are edges";

  this->Actor->GetProperty()->EdgeVisibilityOff();
  const auto quads = MakeQuads();
  this->Mapper->SetInputData(quads);
  const Picture without = this->Render();
  this->Actor->GetProperty()->EdgeVisibilityOn();
  const Picture with = this->Render();
  EXPECT_NE(with, without);
  EXPECT_TRUE(this->Building) << "diagonals of quads are to be told from edges";
  this->Actor->GetProperty()->EdgeVisibilityOff();
  EXPECT_EQ(this->Render(), without);
  EXPECT_FALSE(this->Building);
  this->Actor->GetProperty()->EdgeVisibilityOn();
  EXPECT_EQ(this->Render(), with);
  EXPECT_FALSE(this->Building) << "known from before";
  this->Actor->GetProperty()->SetLineWidth(3.0);
  this->Actor->GetProperty()->SetEdgeColor(0.0, 1.0, 0.0);
  EXPECT_NE(this->Render(), with);
  EXPECT_FALSE(this->Building) << "width and colour";
}

TEST_F(PolyDataMapperEdges, EdgeFlagsOfPointsHideSome)
{
  // A square of two triangles, whose common side is hidden, as in ParaView's curved cells.
  this->LookStraightOn();
  this->Actor->GetProperty()->SetLineWidth(4.0);
  const auto data = MakeCells(
    { { -0.8, -0.8 }, { 0.8, -0.8 }, { 0.8, 0.8 }, { -0.8, -0.8 }, { 0.8, 0.8 }, { -0.8, 0.8 } });
  vtkNew<vtkCellArray> polygons;
  Connect(polygons, { 0, 1, 2 });
  Connect(polygons, { 3, 4, 5 });
  data->SetPolys(polygons);
  this->Mapper->SetInputData(data);
  EXPECT_EQ(GetColor(this->Render(), 0.31, 0.31), this->Red);
  vtkNew<vtkUnsignedCharArray> flags;
  for (const int flag : { 1, 1, 0, 0, 1, 1 })
  {
    flags->InsertNextValue(static_cast<unsigned char>(flag));
  }
  data->GetPointData()->SetAttribute(flags, vtkDataSetAttributes::EDGEFLAG);
  const Picture picture = this->Render();
  EXPECT_TRUE(this->Building);
  EXPECT_EQ(GetColor(picture, 0.31, 0.31), this->White);
  for (const double place : { -0.5, 0.0, 0.5 })
  {
    EXPECT_EQ(GetColor(picture, place, -0.793), this->Red);
    EXPECT_EQ(GetColor(picture, place, 0.793), this->Red);
    EXPECT_EQ(GetColor(picture, -0.793, place), this->Red);
    EXPECT_EQ(GetColor(picture, 0.793, place), this->Red);
  }
}

TEST_F(PolyDataMapperEdges, TubesAndSpheresHaveNone)
{
  this->LookStraightOn();
  const auto data = MakeCells({ { -0.9, 0.5 }, { 0.9, 0.5 }, { 0.0, -0.5 } });
  vtkNew<vtkCellArray> lines;
  Connect(lines, { 0, 1 });
  vtkNew<vtkCellArray> vertices;
  Connect(vertices, { 2 });
  data->SetLines(lines);
  data->SetVerts(vertices);
  this->Mapper->SetInputData(data);
  this->Mapper->SetLineRadius(0.2);
  this->Mapper->SetPointRadius(0.3);
  const Picture with = this->Render();
  this->Actor->GetProperty()->EdgeVisibilityOff();
  EXPECT_EQ(this->Render(), with);
  EXPECT_GT(CountCovered(with), Size * Size / 10);
}

TEST_F(PolyDataMapperEdges, AreNeitherLitNorOccluded)
{
  this->LookStraightOn();
  this->Actor->GetProperty()->LightingOn();
  this->Actor->GetProperty()->SetLineWidth(6.0);
  this->Actor->RotateY(60.0); // dim
  const auto data = MakeCells({ { -0.8, -0.8 }, { 0.8, -0.8 }, { 0.8, 0.8 }, { -0.8, 0.8 } });
  vtkNew<vtkCellArray> polygons;
  Connect(polygons, { 0, 1, 2, 3 });
  data->SetPolys(polygons);
  this->Mapper->SetInputData(data);
  const Picture picture = this->Render();
  EXPECT_EQ(GetColor(picture, 0.0, -0.79), this->Red);
  EXPECT_EQ(GetColor(picture, -0.39, 0.0), this->Red) << "as wide on a slant";
  EXPECT_LT(GetColor(picture, 0.0, 0.0)[0], 150);
}
