// SPDX-License-Identifier: BSD-3-Clause
// AMR and hyper tree grids: leaves of several levels.
#include "VolumeMapperLevelsTest.h"

#include "vtkColorTransferFunction.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNonOverlappingAMR.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPolyData.h"
#include "vtkTrivialProducer.h"
#include "vtkVolumeProperty.h"

namespace
{

/// The ball in cells of the finest size, 0.5.
vtkSmartPointer<vtkImageData> MakeFine()
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  constexpr int points = 2 * Edge + 1;
  image->SetDimensions(points, points, points);
  image->SetOrigin(-16.0, -16.0, -16.0);
  image->SetSpacing(0.5, 0.5, 0.5);
  vtkNew<vtkDoubleArray> values;
  values->SetName("distance");
  for (vtkIdType point = 0; point < image->GetNumberOfPoints(); ++point)
  {
    dvec3 place;
    image->GetPoint(point, &place.x);
    values->InsertNextValue(GetDistance(place));
  }
  image->GetPointData()->AddArray(values);
  return image;
}

} // namespace

TEST_F(VolumeMapperLevels, AmrOfBothKindsShowsTheSame)
{
  const auto overlapping =
    MakeAmr<vtkOverlappingAMR>([](std::size_t number) { return Make(Blocks[number]); });
  const std::vector<double> expected = this->Render(overlapping);
  this->ExpectBall(expected);
  for (const bool extentAtGhosts : { false, true })
  {
    for (const int ghosts : { 0, 1, 3 })
    {
      const auto amr = MakeAmr<vtkNonOverlappingAMR>(
        [&](std::size_t number)
        {
          Block block = Blocks[number];
          block.Ghosts = ghosts;
          return Make(block, extentAtGhosts);
        });
      EXPECT_EQ(this->Render(amr), expected) << ghosts << " layers";
      EXPECT_FALSE(this->Errors->GetError()) << this->Errors->GetErrorMessage();
    }
  }
}

TEST_F(VolumeMapperLevels, HyperTreeGridsOfBothBranchings)
{
  for (const int branching : { 2, 3 })
  {
    SCOPED_TRACE(branching);
    // The camera may be placed before anything is rendered.
    const auto trees = MakeTrees(branching);
    this->Mapper->SetInputDataObject(trees);
    ASSERT_TRUE(this->Mapper->GetBounds());
    EXPECT_EQ(this->Mapper->GetBounds()[0], -16.0);
    this->ExpectBall(this->Render(trees));
    const std::vector<double> half = this->Render(MakeTrees(branching, true));
    EXPECT_FALSE(this->Errors->GetError());
    EXPECT_GT(CountCovered(half), 3000);
  }
}

TEST_F(VolumeMapperLevels, BlocksAndValuesChange)
{
  const auto all =
    MakeAmr<vtkOverlappingAMR>([](std::size_t number) { return Make(Blocks[number]); });
  const std::vector<double> expected = this->Render(all);
  // No blocks at all, then those of the coarsest level alone, then all again.
  vtkNew<vtkOverlappingAMR> none;
  EXPECT_EQ(CountCovered(this->Render(none)), 0);
  this->Errors->Clear();
  const auto coarse = MakeAmr<vtkNonOverlappingAMR>([](std::size_t number)
    { return number == 0 ? Make(Blocks[number]) : vtkSmartPointer<vtkUniformGrid>(); });
  const std::vector<double> rough = this->Render(coarse);
  this->ExpectBall(rough, 0.7);
  EXPECT_NE(rough, expected);
  EXPECT_EQ(this->Render(all), expected);
  // A value at the surface.
  auto* const grid = vtkUniformGrid::SafeDownCast(all->GetDataSet(1, 0));
  vtkDataArray* const values = grid->GetCellData()->GetArray("distance");
  vtkIdType nearest = 0;
  for (vtkIdType cell = 0; cell < values->GetNumberOfTuples(); ++cell)
  {
    const auto apart = [&](vtkIdType one) { return std::abs(values->GetTuple1(one) - 0.4); };
    double middle[3];
    double box[6];
    grid->GetCellBounds(cell, box);
    for (int axis = 0; axis < 3; ++axis)
    {
      middle[axis] = 0.5 * (box[2 * axis] + box[2 * axis + 1]);
    }
    const bool isSeen = middle[0] > 0.0 && middle[1] > 0.0 && middle[2] > 6.0;
    nearest = isSeen && (nearest == 0 || apart(cell) < apart(nearest)) ? cell : nearest;
  }
  values->SetTuple1(nearest, -5.0);
  values->Modified();
  grid->Modified();
  all->Modified();
  EXPECT_NE(this->Render(all), expected);
}

TEST_F(VolumeMapperLevels, ArraysOfSomeBlocks)
{
  const auto missing = MakeAmr<vtkNonOverlappingAMR>([](std::size_t number)
    { return Make(Blocks[number], false, 2, number == 2 ? "other" : "distance"); });
  EXPECT_GT(CountCovered(this->Render(missing)), 1000);
  this->Errors->Clear();
  this->Mapper->SetIsoArray("percent");
  this->Mapper->SetIsoValue(0, 40.0);
  const auto mixed = MakeAmr<vtkNonOverlappingAMR>(
    [](std::size_t number)
    {
      auto grid = Make(Blocks[number], false, 2, "percent", number == 1);
      if (number != 1)
      {
        vtkDataArray* const values = grid->GetCellData()->GetArray("percent");
        for (vtkIdType cell = 0; cell < values->GetNumberOfTuples(); ++cell)
        {
          values->SetTuple1(cell, 100.0 * values->GetTuple1(cell));
        }
      }
      return grid;
    });
  this->ExpectBall(this->Render(mixed), 0.7);
}

// Calls of VTK's programs, with another name of the class.
TEST_F(VolumeMapperLevels, StandsInForAmrVolumeMapper)
{
  vtkNew<vtkTrivialProducer> source;
  source->SetOutput(
    MakeAmr<vtkOverlappingAMR>([](std::size_t number) { return Make(Blocks[number]); }));
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(0.1, 0.8);
  opacity->AddPoint(0.2, 0.0);
  opacity->AddPoint(0.3, 0.0);
  opacity->AddPoint(0.45, 0.3);
  opacity->AddPoint(0.46, 0.0);
  vtkColorTransferFunction* const colors = this->Volume->GetProperty()->GetRGBTransferFunction(0);
  colors->RemoveAllPoints();
  colors->AddRGBPoint(0.1, 0.0, 0.0, 1.0);
  colors->AddRGBPoint(0.3, 1.0, 1.0, 1.0);
  colors->AddRGBPoint(0.45, 1.0, 0.0, 0.0);
  this->Volume->GetProperty()->SetScalarOpacity(opacity);
  this->Volume->GetProperty()->SetInterpolationType(VTK_LINEAR_INTERPOLATION);
  this->Volume->GetProperty()->ShadeOff();
  vtkNew<vtkDSMVolumeMapper> mapper;
  mapper->AddObserver(vtkCommand::ErrorEvent, this->Errors);
  mapper->SetInputConnection(source->GetOutputPort());
  mapper->SelectScalarArray("distance");
  mapper->SetScalarMode(VTK_SCALAR_MODE_USE_POINT_FIELD_DATA);
  mapper->SetBlendMode(vtkVolumeMapper::COMPOSITE_BLEND);
  mapper->SetRequestedRenderModeToGPU();
  mapper->SetInterpolationModeToLinear();
  mapper->SetNumberOfSamples(256, 256, 256);
  mapper->SetRequestedResamplingMode(1);
  mapper->SetFreezeFocalPoint(true);
  mapper->SetResamplerUpdateTolerance(1e-6);
  mapper->SetUseDefaultThreading(true);
  this->Volume->SetMapper(mapper);
  this->Window->Render();
  const std::vector<unsigned char> levels = this->GetPixels();
  EXPECT_FALSE(this->Errors->GetError()) << this->Errors->GetErrorMessage();
  // The arrays are of cells.
  mapper->SetScalarMode(VTK_SCALAR_MODE_USE_CELL_FIELD_DATA);
  this->Window->Render();
  EXPECT_EQ(this->GetPixels(), levels);
  mapper->SetScalarMode(VTK_SCALAR_MODE_USE_POINT_FIELD_DATA);
  mapper->SetInputData(MakeFine());
  this->Window->Render();
  const std::vector<unsigned char> fine = this->GetPixels();
  EXPECT_LT(Compare(levels, fine), 1.5);
  EXPECT_GT(Compare(levels, std::vector<unsigned char>(levels.size())), 20.0);
  vtkNew<vtkDSMVolumeMapper> copy;
  copy->ShallowCopy(mapper);
  EXPECT_EQ(copy->GetRequestedRenderMode(), vtkDSMVolumeMapper::GPURenderMode);
  EXPECT_EQ(copy->GetNumberOfSamples()[2], 256);
}

TEST_F(VolumeMapperLevels, VolumesAreInterpolatedWithAWarning)
{
  this->Mapper->AddObserver(vtkCommand::WarningEvent, this->Errors);
  this->Mapper->SetNumberOfIsoValues(0);
  this->Volume->GetProperty()->SetInterpolationTypeToNearest();
  this->Render(MakeTrees(2));
  const std::string message = this->Errors->GetWarningMessage();
  EXPECT_NE(message.find("AMR and hyper tree grids"), std::string::npos) << message;
  this->Errors->Clear();
  this->Volume->GetProperty()->SetInterpolationTypeToLinear();
  this->Render(MakeTrees(2));
  EXPECT_FALSE(this->Errors->GetWarning()) << this->Errors->GetWarningMessage();
}

TEST_F(VolumeMapperLevels, WhatCannotBeShownIsExplained)
{
  this->ExpectError(MakeAmr<vtkNonOverlappingAMR>(
                      [](std::size_t number)
                      {
                        auto grid = Make(Blocks[number]);
                        if (number == 3)
                        {
                          grid->SetSpacing(0.7, 0.7, 0.7);
                        }
                        return grid;
                      }),
    "not a whole number of times smaller");
  this->ExpectError(MakeAmr<vtkNonOverlappingAMR>(
                      [](std::size_t number)
                      {
                        auto grid = Make(Blocks[number]);
                        if (number == 1)
                        {
                          grid->SetOrigin(0.3, 0.0, 0.0);
                        }
                        return grid;
                      }),
    "is not on the lattice of its level");
  this->Mapper->SetMaskArray("distance");
  this->Mapper->SetMaskArrayOnCells(true);
  this->ExpectError(MakeTrees(2), "cannot hide cells of AMR or hyper tree grids");
  this->Mapper->SetMaskArray("");
  this->ExpectError(MakeTrees(2, false, 2), "2 dimensions");
  vtkNew<vtkMultiBlockDataSet> flat;
  flat->SetBlock(0, MakeTrees(2, false, 2));
  flat->SetBlock(1, vtkSmartPointer<vtkPolyData>::New());
  this->ExpectError(flat, "nor hyper tree grids");
  this->ExpectBall(this->Render(MakeTrees(2)));
}
