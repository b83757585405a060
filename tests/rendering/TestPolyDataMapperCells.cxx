// SPDX-License-Identifier: BSD-3-Clause
// Polygons, strips, lines and vertices, and how they are drawn.
#include "PolyDataMapperTest.h"

#include "vtkDoubleArray.h"
#include "vtkUnsignedCharArray.h"

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
  EXPECT_NEAR(CountCovered(this->Render()), 1.8 * 0.2 * pixels, 0.02 * pixels);
  this->Mapper->SetLineRadius(-1.0);
  this->Mapper->SetPointRadius(0.15);
  const double disc = 3.14159 * 0.15 * 0.15 * pixels;
  EXPECT_NEAR(CountCovered(this->Render()), 2.0 * disc, 0.15 * disc);
  this->Mapper->SetRadiusArray("sizes");
  EXPECT_NEAR(CountCovered(this->Render()), 5.0 * disc, 0.35 * disc);
  this->Mapper->SetPointRadius(-1.0);
  EXPECT_EQ(CountCovered(this->Render()), 0);
  this->Mapper->SetLineRadius(0.1);
  EXPECT_NEAR(CountCovered(this->Render()), 1.8 * 0.2 * pixels, 0.02 * pixels);
}
