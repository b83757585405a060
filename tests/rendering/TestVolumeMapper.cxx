// SPDX-License-Identifier: BSD-3-Clause
// The classes as any VTK application uses them: a renderer, a volume, and no ParaView. Draws on the
// X server, off screen.
#include "VolumeMapperTest.h"

#include "vtkAutoInit.h"
#include "vtkBoundingBox.h"
#include "vtkCell.h"
#include "vtkCellData.h"
#include "vtkCellDataToPointData.h"
#include "vtkDoubleArray.h"
#include "vtkExtractVOI.h"
#include "vtkLookupTable.h"
#include "vtkMath.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPlane.h"
#include "vtkPointDataToCellData.h"
#include "vtkPolyData.h"
#include "vtkProperty.h"
#include "vtkRectilinearGrid.h"
#include "vtkTestErrorObserver.h"
#include "vtkTransform.h"
#include "vtkTriangle.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolumeProperty.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace
{

/// The same surface at the same distances, but for a hundredth of the pixels.
void ExpectAlike(const std::vector<double>& traced, const std::vector<double>& triangles)
{
  int different = 0;
  int apart = 0;
  int both = 0;
  for (std::size_t pixel = 0; pixel < traced.size(); ++pixel)
  {
    different += std::isfinite(traced[pixel]) != std::isfinite(triangles[pixel]);
    if (std::isfinite(traced[pixel]) && std::isfinite(triangles[pixel]))
    {
      ++both;
      apart += std::abs(traced[pixel] - triangles[pixel]) > 0.25;
    }
  }
  EXPECT_GT(both, 2000);
  EXPECT_LE(different, both / 100);
  EXPECT_LE(apart, both / 100);
}

TEST_F(VolumeMapper, DrawsTheSurfaceAndDepthOfFlyingEdges)
{
  this->Place();
  ExpectAlike(this->RenderTraced(), this->RenderTriangles());
}

/// The ball by values of its cells, and what vtkCellDataToPointData makes of them.
struct BallOfCells
{
  BallOfCells()
  {
    vtkNew<vtkPointDataToCellData> toCells;
    toCells->SetInputData(MakeBall());
    toCells->Update();
    this->Cells->ShallowCopy(toCells->GetOutput());
    vtkNew<vtkCellDataToPointData> toPoints;
    toPoints->SetInputData(this->Cells);
    toPoints->Update();
    this->Points->ShallowCopy(toPoints->GetOutput());
  }
  vtkNew<vtkImageData> Cells;
  vtkNew<vtkImageData> Points;
};

TEST_F(VolumeMapper, IsosurfacesOfCellsAreThoseOfTheirMeansAtPoints)
{
  const BallOfCells ball;
  this->Mapper->SetInputData(ball.Points);
  const std::vector<double> expected = this->RenderTraced();
  EXPECT_GT(CountCovered(expected), 2000);
  this->Mapper->SetInputData(ball.Cells);
  EXPECT_EQ(CountCovered(this->RenderTraced()), 0); // there is no such array of points
  this->Mapper->SetIsoArrayOnCells(true);
  EXPECT_EQ(this->RenderTraced(), expected);
  vtkNew<vtkDSMVolumeMapper> copy;
  copy->ShallowCopy(this->Mapper);
  this->Volume->SetMapper(copy);
  EXPECT_EQ(this->RenderTraced(), expected);
  this->Volume->SetMapper(this->Mapper);

  // Without a name: active scalars of points, or else of cells.
  this->Mapper->SetIsoArrayOnCells(false);
  this->Mapper->SetIsoArray("");
  EXPECT_EQ(this->RenderTraced(), expected);

  // Values that change.
  vtkDataArray* const distances = ball.Cells->GetCellData()->GetScalars();
  for (vtkIdType cell = 0; cell < Edge * Edge * Edge; cell += Edge + 1)
  {
    distances->SetComponent(cell, 0, 0.0);
  }
  ball.Cells->Modified();
  EXPECT_NE(this->RenderTraced(), expected);
}

TEST_F(VolumeMapper, MediaOfCellsAreThoseOfTheirMeansAtPoints)
{
  const BallOfCells ball;
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(0.0, 0.5);
  opacity->AddPoint(0.6, 0.0);
  this->Volume->GetProperty()->SetScalarOpacity(opacity);
  vtkNew<vtkPiecewiseFunction> gray;
  gray->AddPoint(0.0, 1.0);
  gray->AddPoint(0.6, 0.5);
  this->Volume->GetProperty()->SetColor(gray);
  this->Volume->GetProperty()->SetInterpolationTypeToLinear();
  this->Renderer->AddVolume(this->Volume);
  vtkNew<vtkDSMVolumeMapper> mapper;
  this->Volume->SetMapper(mapper);
  const auto draw = [&](vtkImageData* data)
  {
    mapper->SetInputData(data);
    this->Window->Render();
    vtkNew<vtkUnsignedCharArray> pixels;
    this->Window->GetPixelData(0, 0, Size - 1, Size - 1, 0, pixels);
    return std::vector<unsigned char>(
      pixels->GetPointer(0), pixels->GetPointer(0) + pixels->GetNumberOfValues());
  };
  const auto expected = draw(ball.Points);
  EXPECT_EQ(draw(ball.Cells), expected); // there are no scalars of points
  ball.Cells->GetPointData()->SetScalars(MakeBall()->GetPointData()->GetScalars());
  EXPECT_NE(draw(ball.Cells), expected);
  mapper->SetScalarModeToUseCellData();
  EXPECT_EQ(draw(ball.Cells), expected);
  mapper->SetScalarModeToUseCellFieldData();
  mapper->SelectScalarArray("distance");
  EXPECT_EQ(draw(ball.Cells), expected);
  mapper->SelectScalarArray(0);
  EXPECT_EQ(draw(ball.Cells), expected);
  mapper->SetScalarModeToUsePointData();
  mapper->SetOpacityArray("distance");
  const auto ofPoints = draw(ball.Points);
  mapper->SetScalarModeToUseCellData();
  mapper->SetOpacityArrayOnCells(true);
  EXPECT_EQ(draw(ball.Cells), ofPoints);
}

TEST_F(VolumeMapper, ShowsImageDataBesideARectilinearGrid)
{
  this->Place();
  const vtkSmartPointer<vtkImageData> ball = MakeBall();
  int extent[6];
  ball->GetExtent(extent);
  const int middle = (extent[4] + extent[5]) / 2;
  vtkNew<vtkExtractVOI> lower;
  lower->SetInputData(ball);
  lower->SetVOI(extent[0], extent[1], extent[2], extent[3], extent[4], middle);
  lower->Update();
  vtkNew<vtkExtractVOI> upper;
  upper->SetInputData(ball);
  upper->SetVOI(extent[0], extent[1], extent[2], extent[3], middle, extent[5]);
  upper->Update();
  vtkNew<vtkRectilinearGrid> grid;
  grid->SetExtent(upper->GetOutput()->GetExtent());
  for (int axis = 0; axis < 3; ++axis)
  {
    vtkNew<vtkDoubleArray> coordinates;
    const int* const own = grid->GetExtent();
    for (int plane = own[2 * axis]; plane <= own[2 * axis + 1]; ++plane)
    {
      coordinates->InsertNextValue(ball->GetOrigin()[axis] + plane * ball->GetSpacing()[axis]);
    }
    void (vtkRectilinearGrid::*const set[3])(
      vtkDataArray*) = { &vtkRectilinearGrid::SetXCoordinates, &vtkRectilinearGrid::SetYCoordinates,
      &vtkRectilinearGrid::SetZCoordinates };
    (grid.GetPointer()->*set[axis])(coordinates);
  }
  grid->GetPointData()->ShallowCopy(upper->GetOutput()->GetPointData());
  vtkNew<vtkMultiBlockDataSet> both;
  both->SetBlock(0, lower->GetOutput());
  both->SetBlock(1, grid);
  this->Mapper->SetInputDataObject(both);
  ExpectAlike(this->RenderTraced(), this->RenderTriangles());
}

TEST_F(VolumeMapper, ClipsAsVtkClipsTriangles)
{
  this->Place();
  const int whole = CountCovered(this->RenderTraced());
  vtkNew<vtkPlane> front;
  front->SetOrigin(0.0, 0.0, 4.0);
  front->SetNormal(0.2, -0.1, -3.0);
  vtkNew<vtkPlane> side;
  side->SetOrigin(-2.0, 0.0, 0.0);
  side->SetNormal(1.0, 0.3, 0.0);
  this->Mapper->AddClippingPlane(front);
  this->Mapper->AddClippingPlane(side);
  const std::vector<double> clipped = this->RenderTraced();
  EXPECT_LT(CountCovered(clipped), 0.9 * whole);
  ExpectAlike(clipped, this->RenderTriangles(this->Mapper->GetClippingPlanes()));
}

TEST_F(VolumeMapper, CropsInTheCoordinatesOfTheData)
{
  this->Place();
  const int whole = CountCovered(this->RenderTraced());
  const double box[6] = { -11.0, 9.0, -20.0, 10.0, -6.0, 4.5 };
  this->Mapper->CroppingOn();
  this->Mapper->SetCroppingRegionPlanes(box);
  const std::vector<double> cropped = this->RenderTraced();
  EXPECT_LT(CountCovered(cropped), 0.9 * whole);
  // The six planes that the box has in the data's coordinates.
  vtkNew<vtkTransform> dataToWorld;
  dataToWorld->SetMatrix(this->Volume->GetMatrix());
  vtkNew<vtkPlaneCollection> planes;
  for (int side = 0; side < 6; ++side)
  {
    double point[3] = { 0.0, 0.0, 0.0 };
    double normal[3] = { 0.0, 0.0, 0.0 };
    point[side / 2] = box[side];
    normal[side / 2] = side % 2 == 0 ? 1.0 : -1.0;
    dataToWorld->TransformPoint(point, point);
    dataToWorld->TransformNormal(normal, normal);
    vtkNew<vtkPlane> plane;
    plane->SetOrigin(point);
    plane->SetNormal(normal);
    planes->AddItem(plane);
  }
  ExpectAlike(cropped, this->RenderTriangles(planes));
  this->Mapper->SetCroppingRegionFlags(0x7ffffff);
  EXPECT_EQ(CountCovered(this->RenderTraced()), whole);
  this->Mapper->SetCroppingRegionFlags(0);
  EXPECT_EQ(CountCovered(this->RenderTraced()), 0);
  this->Mapper->CroppingOff();
  EXPECT_EQ(CountCovered(this->RenderTraced()), whole);
}

TEST_F(VolumeMapper, ShowsSlicesByIndexAndByPlane)
{
  vtkNew<vtkLookupTable> table;
  table->SetRange(0.0, 1.0);
  this->Mapper->SetNumberOfIsoValues(0);
  this->Mapper->SetLookupTable(table);
  this->Mapper->ScalarVisibilityOn();
  this->Mapper->SlicingOn();
  this->Place();
  const auto liesIn = [this](const std::array<double, 3>& normal, double height)
  {
    const std::vector<double> distances = this->RenderTraced();
    EXPECT_GT(CountCovered(distances), Size * Size / 20);
    for (int pixel = 0; pixel < Size * Size; ++pixel)
    {
      double place[4];
      this->Renderer->SetDisplayPoint(
        pixel % Size + 0.5, pixel / Size + 0.5, this->GetDepth(distances[pixel]));
      this->Renderer->DisplayToWorld();
      this->Renderer->GetWorldPoint(place);
      if (std::isfinite(distances[pixel]))
      {
        ASSERT_NEAR(vtkMath::Dot(normal.data(), place) / place[3], height, 0.05)
          << "pixel " << pixel;
      }
    }
  };
  // Index 20 of the samples from -16 on, in a volume that is turned.
  this->Mapper->AddSlice(0, 20);
  this->Mapper->AddSlice(0, 20);
  EXPECT_EQ(this->Mapper->GetNumberOfSlices(), 1);
  const double* matrix = this->Volume->GetMatrix()->GetData();
  const std::array<double, 3> along{ matrix[0], matrix[4], matrix[8] };
  const double position[3] = { matrix[3], matrix[7], matrix[11] };
  liesIn(along, vtkMath::Dot(along.data(), position) + 4.0);

  this->Mapper->RemoveAllSlices();
  EXPECT_EQ(CountCovered(this->RenderTraced()), 0);
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(1.0, 2.0, 4.0);
  plane->SetNormal(0.6, 0.0, 0.8);
  this->Mapper->AddSlicePlane(plane);
  liesIn({ 0.6, 0.0, 0.8 }, 0.6 + 3.2);
  plane->SetOrigin(2.0, 2.0, 4.0);
  liesIn({ 0.6, 0.0, 0.8 }, 1.2 + 3.2);

  // Surfaces are shown with them, and a copy shows the same.
  this->Mapper->SetIsoValue(0, 0.4);
  const std::vector<double> both = this->RenderTraced();
  vtkNew<vtkDSMVolumeMapper> copy;
  copy->ShallowCopy(this->Mapper);
  this->Volume->SetMapper(copy);
  EXPECT_EQ(this->RenderTraced(), both);
  copy->SlicingOff();
  EXPECT_LT(CountCovered(this->RenderTraced()), CountCovered(both));
}

TEST_F(VolumeMapper, CapsWhatClippingCuts)
{
  vtkNew<vtkPlane> plane;
  plane->SetNormal(-0.3, -0.3, -0.9);
  this->Mapper->AddClippingPlane(plane);
  const std::vector<double> open = this->RenderTraced();
  this->Mapper->CappingOn();
  this->Mapper->SetCapSide(vtkDSMVolumeMapper::ValuesBelow);
  const std::vector<double> capped = this->RenderTraced();
  // The face is where the inside was seen, and nowhere else.
  EXPECT_EQ(CountCovered(capped), CountCovered(open));
  int nearer = 0;
  for (int pixel = 0; pixel < Size * Size; ++pixel)
  {
    EXPECT_LE(capped[pixel], open[pixel] + 1e-3);
    nearer += capped[pixel] < open[pixel] - 0.5 ? 1 : 0;
  }
  EXPECT_GT(nearer, CountCovered(open) / 2);
  this->Mapper->SetCapSide(vtkDSMVolumeMapper::WholeFace);
  EXPECT_GT(CountCovered(this->RenderTraced()), CountCovered(capped));
}

TEST_F(VolumeMapper, BackFacesHaveTheirOwnLook)
{
  const auto getMiddle = [this]
  {
    this->Window->Render();
    vtkNew<vtkUnsignedCharArray> pixel;
    this->Window->GetPixelData(Size / 2, Size / 2, Size / 2, Size / 2, 0, pixel);
    return std::array<int, 3>{ pixel->GetValue(0), pixel->GetValue(1), pixel->GetValue(2) };
  };
  const auto setColor = [](vtkProperty* property, double r, double g, double b)
  {
    property->SetColor(r, g, b);
    property->SetAmbient(1.0);
    property->SetDiffuse(0.0);
  };
  const std::array<int, 3> green{ 0, 255, 0 };
  vtkProperty* const front = this->Mapper->GetSurfaceProperty();
  setColor(front, 0.0, 1.0, 0.0);
  this->Renderer->AddVolume(this->Volume);
  EXPECT_EQ(getMiddle(), green);
  // The values are above the isovalue around the ball.
  vtkNew<vtkProperty> back;
  setColor(back, 1.0, 0.0, 0.0);
  this->Mapper->SetBackfaceProperty(back);
  EXPECT_EQ(getMiddle(), (std::array<int, 3>{ 255, 0, 0 }));
  back->SetOpacity(0.0);
  EXPECT_EQ(getMiddle(), green) << "the far wall, from within";
  back->SetOpacity(1.0);
  front->BackfaceCullingOn();
  EXPECT_EQ(getMiddle(), green);
  front->FrontfaceCullingOn();
  EXPECT_EQ(getMiddle(), (std::array<int, 3>{ 0, 0, 0 }));
  front->BackfaceCullingOff();
  this->Mapper->SetBackfaceProperty(nullptr);
  EXPECT_EQ(getMiddle(), green);
}

TEST_F(VolumeMapper, FollowsWhatChanges)
{
  this->Renderer->AddVolume(this->Volume);
  const int before = CountCovered(this->RenderDistances());
  EXPECT_GT(before, 1000);
  this->Mapper->SetIsoValue(0, 0.3);
  const int smaller = CountCovered(this->RenderDistances());
  EXPECT_LT(smaller, before);
  EXPECT_GT(smaller, 500);
  this->Mapper->SetIsoValue(0, 5.0);
  EXPECT_EQ(CountCovered(this->RenderDistances()), 0);
  this->Mapper->SetIsoValue(0, 0.4);
  this->Volume->VisibilityOff();
  EXPECT_EQ(CountCovered(this->RenderDistances()), 0);
  this->Volume->VisibilityOn();
  this->Window->SetSize(Size, Size);
  EXPECT_EQ(CountCovered(this->RenderDistances()), before);
  this->Renderer->RemoveVolume(this->Volume);
  EXPECT_EQ(CountCovered(this->RenderDistances()), 0);
}

TEST_F(VolumeMapper, WithoutIsovaluesDrawsWhatTheDataSuggest)
{
  this->Renderer->AddVolume(this->Volume);
  EXPECT_TRUE(std::isnan(this->Mapper->GetSuggestedIsoValue()));
  this->Mapper->SetNumberOfIsoValues(0);
  this->Mapper->SurfacesOnlyOn();
  EXPECT_EQ(CountCovered(this->RenderDistances()), 0);
  this->Mapper->AutomaticIsoValueOn();
  const std::vector<double> automatic = this->RenderDistances();
  EXPECT_GT(CountCovered(automatic), 1000);
  const double suggested = this->Mapper->GetSuggestedIsoValue();
  this->Mapper->SetIsoValue(0, suggested);
  EXPECT_EQ(this->RenderDistances(), automatic);
  this->Mapper->SetIsoValue(0, 0.5 * suggested);
  EXPECT_LT(CountCovered(this->RenderDistances()), CountCovered(automatic));
  EXPECT_EQ(this->Mapper->GetSuggestedIsoValue(), suggested);
}

TEST_F(VolumeMapper, IsosurfacesAreTrianglesForExports)
{
  const vtkSmartPointer<vtkImageData> image = MakeBall();
  vtkDataArray* const distances = image->GetPointData()->GetScalars();
  const vtkIdType missing = image->FindPoint(10.0, 0.0, 0.0);
  distances->SetComponent(missing, 0, vtkMath::Nan());
  this->Mapper->SetInputData(image);
  this->Mapper->SetIsoValue(0, 0.3);
  this->Renderer->AddVolume(this->Volume);
  for (const double spacing : { 1.0, -1.0 })
  {
    image->SetSpacing(spacing, 1.0, 0.5);
    vtkNew<vtkMultiBlockDataSet> surfaces;
    ASSERT_TRUE(this->Scene->ExtractIsosurfaces(this->Mapper, false, surfaces));
    ASSERT_EQ(surfaces->GetNumberOfBlocks(), 1u);
    auto* const triangles = vtkPolyData::SafeDownCast(surfaces->GetBlock(0));
    ASSERT_GT(triangles->GetNumberOfCells(), 1000);
    vtkDataArray* const cells = triangles->GetCellData()->GetArray("vtkOriginalCellIds");
    vtkDataArray* const normals = triangles->GetPointData()->GetNormals();
    for (vtkIdType number = 0; number < triangles->GetNumberOfCells(); ++number)
    {
      vtkCell* const triangle = triangles->GetCell(number);
      double center[3];
      double parameters[3];
      double normal[3];
      double weights[8];
      triangle->GetParametricCenter(parameters);
      int part = 0;
      triangle->EvaluateLocation(part, parameters, center, weights);
      vtkCell* const voxel = image->GetCell(static_cast<vtkIdType>(cells->GetTuple1(number)));
      EXPECT_FALSE(voxel->GetPointIds()->IsId(missing) >= 0) << "a corner is missing";
      EXPECT_TRUE(vtkBoundingBox(voxel->GetBounds()).ContainsPoint(center));
      double corners[3][3];
      for (int corner = 0; corner < 3; ++corner)
      {
        triangle->GetPoints()->GetPoint(corner, corners[corner]);
      }
      vtkTriangle::ComputeNormal(corners[0], corners[1], corners[2], normal);
      EXPECT_GT(vtkMath::Dot(normal, normals->GetTuple(triangle->GetPointId(0))), 0.5);
    }
    for (vtkIdType point = 0; point < triangles->GetNumberOfPoints(); ++point)
    {
      double place[3];
      triangles->GetPoint(point, place);
      const double index[3] = { place[0] / spacing, place[1], place[2] / 0.5 };
      EXPECT_NEAR(vtkMath::Norm(index), 0.3 * Edge, 0.05);
    }
  }
}

TEST_F(VolumeMapper, NamesAMissingArrayOnce)
{
  vtkNew<vtkTest::ErrorObserver> observer;
  this->Mapper->AddObserver(vtkCommand::ErrorEvent, observer);
  this->Renderer->AddVolume(this->Volume);
  this->Mapper->SetIsoArray("pressure");
  EXPECT_EQ(CountCovered(this->RenderDistances()), 0);
  ASSERT_TRUE(observer->GetError());
  const std::string message = observer->GetErrorMessage();
  EXPECT_NE(message.find("'pressure'"), std::string::npos) << message;
  EXPECT_NE(message.find("'distance'"), std::string::npos) << message;
  observer->Clear();
  this->Window->Render();
  EXPECT_FALSE(observer->GetError());
  this->Mapper->SetIsoArray("distance");
  EXPECT_GT(CountCovered(this->RenderDistances()), 0);
}

} // namespace
