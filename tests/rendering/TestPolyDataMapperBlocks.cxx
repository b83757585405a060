// SPDX-License-Identifier: BSD-3-Clause
// Composite datasets, whose blocks have looks of their own.
#include "PolyDataMapperTest.h"

#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkMultiBlockDataSet.h"

#include <vector>

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
