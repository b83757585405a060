// SPDX-License-Identifier: BSD-3-Clause
// Polygons, lines and points as any VTK application draws them, without ParaView: against VTK's own
// mapper with the same actor.
#include "vtkDSMMemoryOptions.h"
#include "vtkDSMPolyDataMapper.h"
#include "vtkDSMScene.h"

#include "vtkActor.h"
#include "vtkAutoInit.h"
#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkElevationFilter.h"
#include "vtkFloatArray.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkLookupTable.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPlane.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"
#include "vtkTestErrorObserver.h"
#include "vtkTexture.h"
#include "vtkUnsignedCharArray.h"
#include "vtkWindowToImageFilter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <initializer_list>
#include <string>
#include <vector>

namespace
{

constexpr int Size = 200;

/// Colours of the pixels, from the lower left one, three channels each.
using Picture = std::vector<int>;

/// A fine ball, whose point array grows along z.
vtkSmartPointer<vtkPolyData> MakeBall()
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(60);
  sphere->SetPhiResolution(40);
  vtkNew<vtkElevationFilter> elevation;
  elevation->SetInputConnection(sphere->GetOutputPort());
  elevation->SetLowPoint(0.0, 0.0, -0.5);
  elevation->SetHighPoint(0.0, 0.0, 0.5);
  elevation->Update();
  auto ball = vtkSmartPointer<vtkPolyData>::New();
  ball->ShallowCopy(elevation->GetOutput());
  return ball;
}

vtkSmartPointer<vtkPolyData> MakeCells(const std::vector<std::array<double, 2>>& corners)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  for (const auto& corner : corners)
  {
    points->InsertNextPoint(corner[0], corner[1], 0.0);
  }
  data->SetPoints(points);
  return data;
}

void Connect(vtkCellArray* cells, std::initializer_list<vtkIdType> points)
{
  cells->InsertNextCell(points);
}

class PolyDataMapper : public testing::Test
{
protected:
  PolyDataMapper()
    : Scene(vtkDSMScene::ForRenderer(this->Renderer))
  {
    this->Window->SetOffScreenRendering(1);
    this->Window->SetMultiSamples(0);
    this->Window->SetSize(Size, Size);
    this->Window->AddRenderer(this->Renderer);
    this->Mapper->GetMemoryOptions()->SetNumberOfThreads(2);
    this->Actor->SetMapper(this->Mapper);
    this->Renderer->AddActor(this->Actor);
    this->Renderer->GetActiveCamera()->SetPosition(0.3, 0.4, 3.0);
    this->Renderer->GetActiveCamera()->SetFocalPoint(0.0, 0.0, 0.0);
    this->Renderer->ResetCameraClippingRange(-1.0, 1.0, -1.0, 1.0, -1.0, 1.0);
    vtkNew<vtkCallbackCommand> progress;
    progress->SetClientData(this);
    progress->SetCallback([](vtkObject*, unsigned long, void* self, void*)
      { static_cast<PolyDataMapper*>(self)->Building = true; });
    this->Mapper->AddObserver(vtkCommand::ProgressEvent, progress);
  }

  Picture Render()
  {
    this->Building = false;
    vtkNew<vtkWindowToImageFilter> shot;
    shot->SetInput(this->Window);
    shot->ReadFrontBufferOff();
    shot->Update();
    vtkDataArray* colors = shot->GetOutput()->GetPointData()->GetScalars();
    Picture picture;
    for (vtkIdType pixel = 0; pixel < colors->GetNumberOfTuples(); ++pixel)
    {
      for (int channel = 0; channel < 3; ++channel)
      {
        picture.push_back(static_cast<int>(colors->GetComponent(pixel, channel)));
      }
    }
    return picture;
  }

  /// What VTK's own mapper draws with the same settings.
  Picture RenderWithTriangles(vtkPolyData* data)
  {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->ShallowCopy(this->Mapper);
    mapper->SetInputData(data);
    this->Actor->SetMapper(mapper);
    Picture picture = this->Render();
    this->Actor->SetMapper(this->Mapper);
    return picture;
  }

  /// All but a part of the pixels must be alike.
  static void ExpectAlike(const Picture& a, const Picture& b, double share = 0.005)
  {
    ASSERT_EQ(a.size(), b.size());
    int covered = 0;
    int different = 0;
    for (std::size_t pixel = 0; pixel < a.size(); pixel += 3)
    {
      int largest = 0;
      for (int channel = 0; channel < 3; ++channel)
      {
        largest = std::max(largest, std::abs(a[pixel + channel] - b[pixel + channel]));
      }
      different += largest > 8;
      covered += b[pixel] + b[pixel + 1] + b[pixel + 2] > 0;
    }
    EXPECT_GT(covered, Size * Size / 50);
    EXPECT_LE(different, share * Size * Size);
  }

  static int CountCovered(const Picture& picture)
  {
    int covered = 0;
    for (std::size_t pixel = 0; pixel < picture.size(); pixel += 3)
    {
      covered += picture[pixel] + picture[pixel + 1] + picture[pixel + 2] > 0;
    }
    return covered;
  }

  vtkNew<vtkRenderer> Renderer;
  vtkNew<vtkRenderWindow> Window;
  vtkSmartPointer<vtkDSMScene> Scene;
  vtkNew<vtkDSMPolyDataMapper> Mapper;
  vtkNew<vtkActor> Actor;
  bool Building = false; ///< since Render began, bricks have been made
};

} // namespace

TEST_F(PolyDataMapper, DrawsWhatVtkDraws)
{
  const auto ball = MakeBall();
  this->Mapper->SetInputData(ball);
  this->Mapper->ScalarVisibilityOff();
  this->Actor->SetPosition(0.2, -0.1, 0.3);
  this->Actor->SetScale(1.2, 0.7, 1.0);
  this->Actor->RotateY(30.0);
  this->Actor->GetProperty()->SetColor(0.9, 0.4, 0.3);
  this->Actor->GetProperty()->SetAmbient(0.2);
  ExpectAlike(this->Render(), this->RenderWithTriangles(ball));
  this->Actor->GetProperty()->SetInterpolationToFlat();
  ExpectAlike(this->Render(), this->RenderWithTriangles(ball));
}

TEST_F(PolyDataMapper, NormalsOfCellsAreUsedWherePointsHaveNone)
{
  const auto ball = MakeBall();
  ball->GetPointData()->SetNormals(nullptr);
  vtkNew<vtkFloatArray> normals;
  normals->SetNumberOfComponents(3);
  for (vtkIdType cell = 0; cell < ball->GetNumberOfCells(); ++cell)
  {
    normals->InsertNextTuple3(0.2 * static_cast<double>(cell % 5), 0.3, 1.0);
  }
  this->Mapper->SetInputData(ball);
  this->Mapper->ScalarVisibilityOff();
  const Picture without = this->Render();
  ball->GetCellData()->SetNormals(normals);
  const Picture with = this->Render();
  EXPECT_TRUE(this->Building);
  EXPECT_NE(with, without);
  ExpectAlike(with, this->RenderWithTriangles(ball), 0.02);
  this->Actor->GetProperty()->SetInterpolationToFlat();
  ExpectAlike(this->Render(), this->RenderWithTriangles(ball), 0.02);
}

TEST_F(PolyDataMapper, ClipsAsVtkDoes)
{
  const auto ball = MakeBall();
  this->Mapper->SetInputData(ball);
  this->Actor->SetPosition(0.2, -0.1, 0.3);
  this->Actor->RotateY(30.0);
  const int whole = CountCovered(this->Render());
  vtkNew<vtkPlane> front;
  front->SetOrigin(0.0, 0.0, 0.35);
  front->SetNormal(0.1, 0.2, -0.5);
  vtkNew<vtkPlane> side;
  side->SetOrigin(0.15, 0.0, 0.0);
  side->SetNormal(1.0, -0.3, 0.0);
  this->Mapper->AddClippingPlane(front);
  this->Mapper->AddClippingPlane(side);
  const Picture clipped = this->Render();
  EXPECT_LT(CountCovered(clipped), 0.9 * whole);
  ExpectAlike(clipped, this->RenderWithTriangles(ball));
  this->Mapper->RemoveAllClippingPlanes();
  EXPECT_EQ(CountCovered(this->Render()), whole);
}

TEST_F(PolyDataMapper, ColoursAreVtks)
{
  const auto ball = MakeBall();
  vtkNew<vtkDoubleArray> cells;
  cells->SetName("cells");
  vtkNew<vtkUnsignedCharArray> direct;
  direct->SetName("direct");
  direct->SetNumberOfComponents(3);
  for (vtkIdType cell = 0; cell < ball->GetNumberOfCells(); ++cell)
  {
    cells->InsertNextValue(static_cast<double>(cell % 7));
  }
  for (vtkIdType point = 0; point < ball->GetNumberOfPoints(); ++point)
  {
    direct->InsertNextTuple3(static_cast<double>(point % 255), 100.0, 20.0);
  }
  ball->GetCellData()->AddArray(cells);
  ball->GetPointData()->AddArray(direct);
  this->Mapper->SetInputData(ball);
  ExpectAlike(this->Render(), this->RenderWithTriangles(ball), 0.01); // the active scalars
  this->Mapper->InterpolateScalarsBeforeMappingOn();
  ExpectAlike(this->Render(), this->RenderWithTriangles(ball), 0.01);
  this->Mapper->SetScalarRange(0.3, 0.6);
  this->Mapper->GetLookupTable()->Modified();
  ExpectAlike(this->Render(), this->RenderWithTriangles(ball), 0.01);
  this->Mapper->SetScalarModeToUseCellFieldData();
  this->Mapper->SelectColorArray("cells");
  this->Mapper->SetScalarRange(0.0, 6.0);
  ExpectAlike(this->Render(), this->RenderWithTriangles(ball), 0.02);
  this->Mapper->SetScalarModeToUsePointFieldData();
  this->Mapper->SelectColorArray("direct");
  ExpectAlike(this->Render(), this->RenderWithTriangles(ball), 0.02);
  // Colour by component, and by the length of the vector.
  this->Mapper->SetColorModeToMapScalars();
  this->Mapper->GetLookupTable()->SetVectorModeToComponent();
  this->Mapper->SetScalarRange(0.0, 255.0);
  ExpectAlike(this->Render(), this->RenderWithTriangles(ball), 0.02);
  this->Mapper->GetLookupTable()->SetVectorModeToMagnitude();
  ExpectAlike(this->Render(), this->RenderWithTriangles(ball), 0.02);
}

TEST_F(PolyDataMapper, TexturesLookAsInVtk)
{
  const auto ball = MakeBall();
  ball->GetPointData()->SetActiveScalars(nullptr);
  vtkNew<vtkFloatArray> coordinates;
  coordinates->SetName("texture");
  coordinates->SetNumberOfComponents(2);
  for (vtkIdType point = 0; point < ball->GetNumberOfPoints(); ++point)
  {
    const double* place = ball->GetPoint(point);
    coordinates->InsertNextTuple2(3.0 * place[0], 2.0 * place[1] + 0.3);
  }
  ball->GetPointData()->SetTCoords(coordinates);
  vtkNew<vtkImageData> image;
  image->SetDimensions(16, 8, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  for (int y = 0; y < 8; ++y)
  {
    for (int x = 0; x < 16; ++x)
    {
      auto* texel = static_cast<unsigned char*>(image->GetScalarPointer(x, y, 0));
      texel[0] = static_cast<unsigned char>(16 * x);
      texel[1] = static_cast<unsigned char>(32 * y);
      texel[2] = (x + y) % 2 ? 200 : 0;
    }
  }
  vtkNew<vtkTexture> texture;
  texture->SetInputData(image);
  texture->InterpolateOn();
  this->Mapper->SetInputData(ball);
  this->Actor->SetTexture(texture);
  const Picture smooth = this->Render();
  texture->InterpolateOff();
  const Picture sharp = this->Render();
  EXPECT_FALSE(this->Building) << "the texture's settings";
  EXPECT_NE(smooth, sharp);
  ExpectAlike(sharp, this->RenderWithTriangles(ball), 0.03);
  texture->InterpolateOn();
  ExpectAlike(smooth, this->RenderWithTriangles(ball), 0.02);
  this->Actor->SetTexture(nullptr);
  ExpectAlike(this->Render(), this->RenderWithTriangles(ball));
}

TEST_F(PolyDataMapper, OnlyDataThatChangeAreTakenInAgain)
{
  const auto ball = MakeBall();
  this->Mapper->SetInputData(ball);
  const Picture first = this->Render();
  EXPECT_TRUE(this->Building);
  this->Renderer->GetActiveCamera()->Azimuth(20.0);
  this->Actor->RotateX(10.0);
  this->Actor->GetProperty()->SetOpacity(0.5);
  this->Actor->GetProperty()->SetDiffuseColor(0.0, 1.0, 0.0);
  this->Mapper->SetScalarRange(0.2, 0.5);
  this->Mapper->InterpolateScalarsBeforeMappingOn();
  vtkNew<vtkLookupTable> table;
  table->SetHueRange(0.0, 0.2);
  this->Mapper->SetLookupTable(table);
  EXPECT_NE(this->Render(), first);
  EXPECT_FALSE(this->Building) << "camera, matrix, material and colour map";
  // Filters make a new dataset of the old arrays.
  vtkNew<vtkPolyData> copy;
  copy->ShallowCopy(ball);
  this->Mapper->SetInputData(copy);
  this->Render();
  EXPECT_FALSE(this->Building) << "a copy of the structure";
  ball->GetPoints()->SetPoint(0, 0.0, 0.0, 1.5);
  ball->GetPoints()->Modified();
  this->Render();
  EXPECT_TRUE(this->Building) << "points";
  this->Mapper->ScalarVisibilityOff();
  this->Render();
  EXPECT_TRUE(this->Building) << "the colour array";
  this->Render();
  EXPECT_FALSE(this->Building);
}

TEST_F(PolyDataMapper, BuildingCanBeAborted)
{
  this->Mapper->SetInputDataObject(MakeBall());
  vtkNew<vtkCallbackCommand> abort;
  abort->SetClientData(this->Mapper);
  abort->SetCallback([](vtkObject*, unsigned long, void* mapper, void*)
    { static_cast<vtkDSMPolyDataMapper*>(mapper)->SetAbortExecute(1); });
  const unsigned long observer = this->Mapper->AddObserver(vtkCommand::ProgressEvent, abort);
  vtkNew<vtkTest::ErrorObserver> errors;
  this->Mapper->AddObserver(vtkCommand::ErrorEvent, errors);
  const Picture nothing = this->Render();
  EXPECT_EQ(std::count(nothing.begin(), nothing.end(), nothing.front()), nothing.size());
  EXPECT_NE(errors->GetErrorMessage().find("aborted"), std::string::npos);

  this->Mapper->RemoveObserver(observer);
  errors->Clear();
  this->Mapper->SetInputDataObject(MakeBall());
  EXPECT_NE(this->Render(), nothing);
  EXPECT_FALSE(errors->GetError());
}

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

TEST_F(PolyDataMapper, BlocksHaveVisibilityColourAndOpacity)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  for (unsigned int block = 0; block < 3; ++block)
  {
    const double x = -0.9 + 0.6 * block;
    const auto square = MakeCells({ { x, -0.5 }, { x + 0.5, -0.5 }, { x + 0.5, 0.5 }, { x, 0.5 } });
    vtkNew<vtkCellArray> polygons;
    Connect(polygons, { 0, 1, 2, 3 });
    square->SetPolys(polygons);
    blocks->SetBlock(block, square);
  }
  this->Mapper->SetInputDataObject(blocks);
  vtkNew<vtkCompositeDataDisplayAttributes> attributes;
  this->Mapper->SetCompositeDataDisplayAttributes(attributes);
  this->Renderer->GetActiveCamera()->SetPosition(0.0, 0.0, 4.0);
  this->Renderer->GetActiveCamera()->ParallelProjectionOn();
  this->Renderer->GetActiveCamera()->SetParallelScale(1.0);
  this->Actor->GetProperty()->LightingOff();
  const auto getColor = [](const Picture& picture, unsigned int block)
  {
    const double x = -0.65 + 0.6 * block;
    const auto column = static_cast<std::size_t>((x + 1.0) / 2.0 * Size);
    const int* color = &picture[3 * (Size / 2 * static_cast<std::size_t>(Size) + column)];
    return std::vector<int>(color, color + 3);
  };
  Picture picture = this->Render();
  for (unsigned int block = 0; block < 3; ++block)
  {
    EXPECT_EQ(getColor(picture, block), (std::vector<int>{ 255, 255, 255 }));
  }
  const double green[3] = { 0.0, 1.0, 0.0 };
  attributes->SetBlockColor(blocks->GetBlock(0), green);
  attributes->SetBlockVisibility(blocks->GetBlock(1), false);
  attributes->SetBlockOpacity(blocks->GetBlock(2), 0.5);
  picture = this->Render();
  EXPECT_EQ(getColor(picture, 0), (std::vector<int>{ 0, 255, 0 }));
  EXPECT_EQ(getColor(picture, 1), (std::vector<int>{ 0, 0, 0 }));
  EXPECT_NEAR(getColor(picture, 2)[0], 128, 1);
  EXPECT_FALSE(this->Building) << "looks of blocks";
  const double red[3] = { 1.0, 0.0, 0.0 };
  attributes->SetBlockColor(blocks->GetBlock(1), red);
  attributes->RemoveBlockVisibilities();
  attributes->RemoveBlockColor(blocks->GetBlock(0));
  attributes->RemoveBlockOpacity(blocks->GetBlock(2));
  picture = this->Render();
  EXPECT_FALSE(this->Building) << "other looks of blocks";
  EXPECT_EQ(getColor(picture, 0), (std::vector<int>{ 255, 255, 255 }));
  EXPECT_EQ(getColor(picture, 1), (std::vector<int>{ 255, 0, 0 }));
  EXPECT_EQ(getColor(picture, 2), (std::vector<int>{ 255, 255, 255 }));
  attributes->SetBlockVisibility(blocks, false);
  EXPECT_EQ(CountCovered(this->Render()), 0);
  EXPECT_FALSE(this->Building);
  attributes->RemoveBlockVisibilities();
  EXPECT_EQ(this->Render(), picture);
  EXPECT_FALSE(this->Building) << "shown again";
}

TEST_F(PolyDataMapper, AChangedBlockIsTakenInAgain)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  for (unsigned int block = 0; block < 2; ++block)
  {
    vtkNew<vtkSphereSource> sphere;
    sphere->SetCenter(block - 0.5, 0.0, 0.0);
    sphere->SetRadius(0.3);
    sphere->Update();
    blocks->SetBlock(block, sphere->GetOutput());
  }
  this->Mapper->SetInputDataObject(blocks);
  vtkNew<vtkCompositeDataDisplayAttributes> attributes;
  this->Mapper->SetCompositeDataDisplayAttributes(attributes);
  attributes->SetBlockVisibility(blocks->GetBlock(1), false);
  const int one = CountCovered(this->Render());
  EXPECT_GT(one, 500);
  attributes->RemoveBlockVisibilities();
  EXPECT_NEAR(CountCovered(this->Render()), 2 * one, one / 5);
  EXPECT_TRUE(this->Building) << "shown for the first time";
  // While it is hidden.
  attributes->SetBlockVisibility(blocks->GetBlock(1), false);
  auto* changed = vtkPolyData::SafeDownCast(blocks->GetBlock(1));
  changed->GetPoints()->SetPoint(0, 0.5, 0.0, 1.0);
  changed->GetPoints()->Modified();
  EXPECT_EQ(CountCovered(this->Render()), one);
  EXPECT_FALSE(this->Building) << "what is hidden";
  attributes->RemoveBlockVisibilities();
  EXPECT_GT(CountCovered(this->Render()), 2 * one);
  EXPECT_TRUE(this->Building);
}

TEST_F(PolyDataMapper, ManyBlocksShareTheirMeshes)
{
  // More than have meshes of their own; every other one is red.
  constexpr unsigned int count = 144;
  vtkNew<vtkMultiBlockDataSet> blocks;
  vtkNew<vtkCompositeDataDisplayAttributes> attributes;
  const double red[3] = { 1.0, 0.0, 0.0 };
  for (unsigned int block = 0; block < count; ++block)
  {
    const double x = -0.9 + 0.15 * (block % 12);
    const double y = -0.9 + 0.15 * (block / 12);
    const auto square =
      MakeCells({ { x, y }, { x + 0.15, y }, { x + 0.15, y + 0.15 }, { x, y + 0.15 } });
    vtkNew<vtkCellArray> polygons;
    Connect(polygons, { 0, 1, 2, 3 });
    square->SetPolys(polygons);
    blocks->SetBlock(block, square);
    if (block % 2 == 0)
    {
      attributes->SetBlockColor(square, red);
    }
  }
  this->Actor->GetProperty()->LightingOff();
  this->Mapper->SetInputDataObject(blocks);
  this->Mapper->SetCompositeDataDisplayAttributes(attributes);
  const auto countRed = [](const Picture& picture)
  {
    int number = 0;
    for (std::size_t pixel = 0; pixel < picture.size(); pixel += 3)
    {
      number += picture[pixel] == 255 && picture[pixel + 1] == 0;
    }
    return number;
  };
  const Picture picture = this->Render();
  const int covered = CountCovered(picture);
  EXPECT_GT(covered, 5000);
  EXPECT_NEAR(countRed(picture), covered / 2, covered / 50);
  for (unsigned int block = 1; block < count; block += 2)
  {
    attributes->SetBlockVisibility(blocks->GetBlock(block), false);
  }
  const Picture half = this->Render();
  EXPECT_FALSE(this->Building) << "the red ones are as they were";
  EXPECT_EQ(CountCovered(half), countRed(half));
  EXPECT_NEAR(countRed(half), covered / 2, covered / 50);
}

TEST_F(PolyDataMapper, SaysWhatIsWrongOnceAndShowsTheRest)
{
  vtkNew<vtkTest::ErrorObserver> observer;
  this->Mapper->AddObserver(vtkCommand::ErrorEvent, observer);
  const auto ball = MakeBall();
  this->Mapper->SetInputData(ball);
  this->Render();
  this->Mapper->SetScalarModeToUsePointFieldData();
  this->Mapper->SelectColorArray("pressure");
  EXPECT_GT(CountCovered(this->Render()), 500);
  ASSERT_TRUE(observer->GetError());
  std::string message = observer->GetErrorMessage();
  EXPECT_NE(message.find("'pressure'"), std::string::npos) << message;
  EXPECT_NE(message.find("'Elevation'"), std::string::npos) << message;
  observer->Clear();
  this->Render();
  EXPECT_FALSE(observer->GetError());

  vtkNew<vtkDoubleArray> shorter;
  shorter->SetName("shorter");
  shorter->SetNumberOfTuples(17);
  shorter->Fill(0.0);
  ball->GetCellData()->AddArray(shorter);
  this->Mapper->SetScalarModeToUseCellFieldData();
  this->Mapper->SelectColorArray("shorter");
  EXPECT_GT(CountCovered(this->Render()), 500);
  message = observer->GetErrorMessage();
  EXPECT_NE(message.find("'shorter' has 17 values"), std::string::npos) << message;
  observer->Clear();

  const auto broken = MakeCells({ { 0.0, 0.0 }, { 1.0, 0.0 }, { 0.0, 1.0 } });
  vtkNew<vtkCellArray> polygons;
  Connect(polygons, { 0, 1, 99 });
  broken->SetPolys(polygons);
  this->Mapper->ScalarVisibilityOff();
  this->Mapper->SetInputData(broken);
  EXPECT_EQ(CountCovered(this->Render()), 0);
  message = observer->GetErrorMessage();
  EXPECT_NE(message.find("point 99"), std::string::npos) << message;
  observer->Clear();
  this->Render();
  EXPECT_FALSE(observer->GetError());

  this->Mapper->SetInputData(ball);
  EXPECT_GT(CountCovered(this->Render()), 500);
  vtkNew<vtkPolyData> empty;
  this->Mapper->SetInputData(empty);
  EXPECT_EQ(CountCovered(this->Render()), 0);
  EXPECT_FALSE(observer->GetError());
}
