// SPDX-License-Identifier: BSD-3-Clause
// Polygons, strips, lines and vertices, and how they are drawn.
#include "PolyDataMapperTest.h"

#include "vtkAppendPolyData.h"
#include "vtkDoubleArray.h"
#include "vtkTubeFilter.h"
#include "vtkUnsignedCharArray.h"

#include <cmath>
#include <limits>
#include <vector>

TEST_F(PolyDataMapper, EveryKindOfCell)
{
  // A concave polygon, a quad, a strip, and a triangle hidden as a ghost.
  const auto data = MakeCells({ { -0.9, 0.1 }, { -0.1, 0.1 }, { -0.1, 0.9 }, { -0.5, 0.3 },
    { -0.9, 0.9 }, { 0.1, 0.1 }, { 0.9, 0.1 }, { 0.9, 0.9 }, { 0.1, 0.9 }, { -0.9, -0.9 },
    { -0.9, -0.1 }, { -0.5, -0.9 }, { -0.5, -0.1 }, { -0.1, -0.5 } });
  vtkNew<vtkCellArray> polygons;
  Connect(polygons, { 0, 1, 2, 3, 4 });
  Connect(polygons, { 5, 6, 7, 8 });
  Connect(polygons, { 5, 6, 13 });
  vtkNew<vtkCellArray> strips;
  Connect(strips, { 9, 11, 10, 12, 13 });
  data->SetPolys(polygons);
  data->SetStrips(strips);
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  for (const int ghost : { 0, 0, 1, 0 })
  {
    ghosts->InsertNextValue(static_cast<unsigned char>(ghost));
  }
  data->GetCellData()->AddArray(ghosts);
  vtkNew<vtkDoubleArray> values;
  values->SetName("values");
  for (const double value : { 1.0, 2.0, 0.0, 3.0 })
  {
    values->InsertNextValue(value);
  }
  data->GetCellData()->AddArray(values);
  this->Mapper->SetInputData(data);
  this->Mapper->SetScalarModeToUseCellFieldData();
  this->Mapper->SelectColorArray("values");
  this->Mapper->SetScalarRange(1.0, 3.0);
  this->Renderer->GetActiveCamera()->SetPosition(0.0, 0.0, 4.0);
  this->Renderer->GetActiveCamera()->ParallelProjectionOn();
  this->Renderer->GetActiveCamera()->SetParallelScale(1.0);
  this->Actor->GetProperty()->LightingOff();
  const Picture picture = this->Render();
  const auto at = [&](double x, double y)
  {
    const auto column = static_cast<std::size_t>((x + 1.0) / 2.0 * Size);
    const auto row = static_cast<std::size_t>((y + 1.0) / 2.0 * Size);
    const int* color = &picture[3 * (row * Size + column)];
    return std::vector<int>(color, color + 3);
  };
  const std::vector<int> nothing{ 0, 0, 0 };
  const std::vector<int> red{ 255, 0, 0 };
  const std::vector<int> blue{ 0, 0, 255 };
  EXPECT_EQ(at(-0.5, 0.2), red);
  EXPECT_EQ(at(-0.8, 0.6), red);
  EXPECT_EQ(at(-0.2, 0.6), red);
  EXPECT_EQ(at(-0.5, 0.7), nothing) << "the notch of the concave polygon";
  EXPECT_NE(at(0.5, 0.5), nothing);
  EXPECT_EQ(at(0.3, -0.05), nothing) << "the ghost";
  EXPECT_EQ(at(-0.8, -0.5), blue);
  EXPECT_EQ(at(-0.3, -0.35), blue);
  EXPECT_EQ(at(0.5, -0.5), nothing);
}

TEST_F(PolyDataMapper, LinesAreTubesAndVerticesSpheres)
{
  const auto data = MakeCells({ { -0.9, 0.5 }, { 0.9, 0.5 }, { -0.5, -0.5 }, { 0.5, -0.5 } });
  vtkNew<vtkCellArray> lines;
  Connect(lines, { 0, 1 });
  vtkNew<vtkCellArray> vertices;
  Connect(vertices, { 2 });
  Connect(vertices, { 3 });
  data->SetLines(lines);
  data->SetVerts(vertices);
  vtkNew<vtkDoubleArray> sizes;
  sizes->SetName("sizes");
  for (const double size : { 1.0, 1.0, 1.0, 2.0 })
  {
    sizes->InsertNextValue(size);
  }
  data->GetPointData()->AddArray(sizes);
  this->Mapper->SetInputData(data);
  this->Renderer->GetActiveCamera()->SetPosition(0.0, 0.0, 4.0);
  this->Renderer->GetActiveCamera()->ParallelProjectionOn();
  this->Renderer->GetActiveCamera()->SetParallelScale(1.0);
  this->Actor->GetProperty()->LightingOff();
  const double pixels = Size * Size / 4.0; // of a unit area
  const int automatic = CountCovered(this->Render());
  EXPECT_GT(automatic, 100);
  EXPECT_LT(automatic, 500);
  this->Mapper->SetLineRadius(0.1);
  this->Mapper->SetPointRadius(-1.0);
  const double rod = (1.8 * 0.2 + 3.14159 * 0.1 * 0.1) * pixels; // with round ends
  EXPECT_NEAR(CountCovered(this->Render()), rod, 0.01 * pixels);
  this->Mapper->SetLineRadius(-1.0);
  this->Mapper->SetPointRadius(0.15);
  const double disc = 3.14159 * 0.15 * 0.15 * pixels;
  EXPECT_NEAR(CountCovered(this->Render()), 2.0 * disc, 0.05 * disc);
  this->Mapper->SetRadiusArray("sizes");
  EXPECT_NEAR(CountCovered(this->Render()), 5.0 * disc, 0.05 * disc);
  this->Mapper->SetPointRadius(-1.0);
  EXPECT_EQ(CountCovered(this->Render()), 0);
  this->Mapper->SetLineRadius(0.1);
  EXPECT_NEAR(CountCovered(this->Render()), rod, 0.01 * pixels);
  // What is not a radius is none.
  sizes->SetValue(0, -3.0);
  sizes->SetValue(1, 0.0);
  sizes->SetValue(2, std::numeric_limits<double>::quiet_NaN());
  sizes->Modified();
  this->Mapper->SetPointRadius(0.15);
  EXPECT_NEAR(CountCovered(this->Render()), 4.0 * disc, 0.05 * disc);
}

/// A line that winds around the y axis, thicker and thinner, and vertices beside it.
class PolyDataMapperSolids : public PolyDataMapper
{
protected:
  static constexpr int Points = 60;

  PolyDataMapperSolids()
  {
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> lines;
    vtkNew<vtkDoubleArray> values;
    values->SetName("values");
    lines->InsertNextCell(Points);
    for (int point = 0; point < Points; ++point)
    {
      const double part = static_cast<double>(point) / (Points - 1);
      points->InsertNextPoint(
        0.6 * std::cos(9.0 * part), 1.4 * part - 0.7, 0.6 * std::sin(9.0 * part));
      lines->InsertCellPoint(point);
      values->InsertNextValue(part);
    }
    vtkNew<vtkCellArray> vertices;
    for (int point = 0; point < 5; ++point)
    {
      Connect(vertices, { points->InsertNextPoint(0.1, 0.3 * point - 0.6, 0.1 * point) });
      values->InsertNextValue(0.25 * point);
    }
    this->Data->SetPoints(points);
    this->Data->SetLines(lines);
    this->Data->SetVerts(vertices);
    this->Data->GetPointData()->SetScalars(values);
    this->Mapper->SetInputData(this->Data);
    this->Mapper->SetLineRadius(0.08);
    this->Mapper->SetPointRadius(0.12);
  }

  /// Fine triangles of what the mapper shows: spheres at the points, and the parts of the tube between them.
  vtkSmartPointer<vtkPolyData> MakeTriangles() const
  {
    vtkNew<vtkAppendPolyData> all;
    for (vtkIdType point = 0; point < this->Data->GetNumberOfPoints(); ++point)
    {
      vtkNew<vtkSphereSource> sphere;
      sphere->SetThetaResolution(48);
      sphere->SetPhiResolution(48);
      sphere->SetRadius(point < Points ? 0.08 : 0.12);
      sphere->SetCenter(this->Data->GetPoint(point));
      sphere->Update();
      vtkNew<vtkDoubleArray> values;
      values->SetName("values");
      values->SetNumberOfTuples(sphere->GetOutput()->GetNumberOfPoints());
      values->FillValue(this->Data->GetPointData()->GetScalars()->GetComponent(point, 0));
      sphere->GetOutput()->GetPointData()->SetScalars(values);
      all->AddInputData(sphere->GetOutput());
    }
    for (vtkIdType point = 0; point + 1 < Points; ++point)
    {
      vtkNew<vtkPolyData> part;
      part->SetPoints(this->Data->GetPoints());
      part->GetPointData()->SetScalars(this->Data->GetPointData()->GetScalars());
      vtkNew<vtkCellArray> line;
      Connect(line, { point, point + 1 });
      part->SetLines(line);
      vtkNew<vtkTubeFilter> tube;
      tube->SetInputData(part);
      tube->SetNumberOfSides(64);
      tube->SetRadius(0.08);
      tube->Update();
      all->AddInputData(tube->GetOutput());
    }
    all->Update();
    return all->GetOutput();
  }

  vtkNew<vtkPolyData> Data;
};

TEST_F(PolyDataMapperSolids, LookLikeFineTriangles)
{
  const Picture solids = this->Render();
  ExpectAlike(solids, this->RenderWithTriangles(this->MakeTriangles()), 0.02);
  this->Mapper->SetInputData(this->MakeTriangles());
  const Picture triangles = this->Render();
  ExpectAlike(solids, triangles, 0.01);
  EXPECT_GT(CountCovered(solids), Size * Size / 10);
}

TEST_F(PolyDataMapperSolids, TranslucentTubesHaveNoWallsInside)
{
  // However many points a straight line has.
  const auto render = [&](int points)
  {
    vtkNew<vtkPoints> places;
    vtkNew<vtkCellArray> lines;
    lines->InsertNextCell(points);
    for (int point = 0; point < points; ++point)
    {
      lines->InsertCellPoint(places->InsertNextPoint(1.6 * point / (points - 1.0) - 0.8, 0.1, 0.0));
    }
    vtkNew<vtkPolyData> data;
    data->SetPoints(places);
    data->SetLines(lines);
    this->Mapper->SetInputData(data);
    this->Mapper->SetLineRadius(0.2);
    return this->Render();
  };
  this->Actor->GetProperty()->SetOpacity(0.4);
  const Picture one = render(2);
  EXPECT_GT(CountCovered(one), Size * Size / 20);
  for (const int points : { 3, 9, 50 })
  {
    ExpectAlike(one, render(points), 0.0005);
  }
}

TEST_F(PolyDataMapperSolids, TakeTheColorsOfLinesAndVertices)
{
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetName("colors");
  colors->SetNumberOfComponents(3);
  for (int cell = 0; cell < 6; ++cell)
  {
    // As VTK counts: vertices before lines.
    colors->InsertNextTuple3(cell < 5 ? 255 : 0, 0, cell < 5 ? 0 : 255);
  }
  this->Data->GetPointData()->SetScalars(nullptr);
  this->Data->GetCellData()->SetScalars(colors);
  this->Mapper->SetScalarModeToUseCellData();
  this->Actor->GetProperty()->LightingOff();
  const auto countColors = [&]
  {
    const Picture picture = this->Render();
    std::array<int, 2> counts{};
    for (std::size_t pixel = 0; pixel < picture.size(); pixel += 3)
    {
      counts[0] += picture[pixel] == 255 && picture[pixel + 2] == 0 ? 1 : 0;
      counts[1] += picture[pixel] == 0 && picture[pixel + 2] == 255 ? 1 : 0;
    }
    return counts;
  };
  EXPECT_GT(countColors()[0], 200);
  EXPECT_GT(countColors()[1], 1000);
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfTuples(6);
  ghosts->FillValue(0);
  ghosts->SetValue(5, vtkDataSetAttributes::DUPLICATECELL);
  this->Data->GetCellData()->AddArray(ghosts);
  EXPECT_EQ(countColors()[1], 0) << "a ghost";
}
