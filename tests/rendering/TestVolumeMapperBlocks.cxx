// SPDX-License-Identifier: BSD-3-Clause
// Multi-block datasets of several kinds.
#include "VolumeMapperLevelsTest.h"

#include "vtkColorTransferFunction.h"
#include "vtkCompositeDataIterator.h"
#include "vtkLookupTable.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNonOverlappingAMR.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPlane.h"
#include "vtkProperty.h"
#include "vtkRectilinearGrid.h"
#include "vtkVolumeProperty.h"

#include <array>

namespace
{

void Move(vtkHyperTreeGrid* grid, const dvec3& by)
{
  int axis = 0;
  for (vtkDataArray* planes :
    { grid->GetXCoordinates(), grid->GetYCoordinates(), grid->GetZCoordinates() })
  {
    for (vtkIdType plane = 0; plane < planes->GetNumberOfTuples(); ++plane)
    {
      planes->SetTuple1(plane, planes->GetTuple1(plane) + by[axis]);
    }
    ++axis;
  }
}

/// The ball, with planes at unequal distances.
vtkSmartPointer<vtkRectilinearGrid> MakeRectilinear(const dvec3& by)
{
  auto grid = vtkSmartPointer<vtkRectilinearGrid>::New();
  const auto image = MakeBall();
  grid->SetExtent(image->GetExtent());
  for (int axis = 0; axis < 3; ++axis)
  {
    vtkNew<vtkDoubleArray> planes;
    for (int plane = -Edge / 2; plane <= Edge / 2; ++plane)
    {
      planes->InsertNextValue(by[axis] + plane * (0.7 + 0.3 * std::abs(plane) * 2.0 / Edge));
    }
    axis == 0     ? grid->SetXCoordinates(planes)
      : axis == 1 ? grid->SetYCoordinates(planes)
                  : grid->SetZCoordinates(planes);
  }
  grid->GetPointData()->SetScalars(image->GetPointData()->GetScalars());
  return grid;
}

/// Blocks of all kinds, side by side: an image, and in a block of its own a rectilinear grid and hyper trees.
vtkSmartPointer<vtkMultiBlockDataSet> MakeAllKinds()
{
  const auto image = MakeBall();
  image->SetOrigin(-17.0, -17.0, 0.0);
  const auto trees = MakeTrees(2);
  Move(trees, dvec3(-17.0, 17.0, 0.0));
  const auto others = MakeTrees(3);
  Move(others, dvec3(17.0, 17.0, 0.0));
  vtkNew<vtkMultiBlockDataSet> inner;
  inner->SetBlock(0, MakeRectilinear(dvec3(17.0, -17.0, 0.0)));
  inner->SetBlock(2, trees);
  auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  blocks->SetBlock(0, image);
  blocks->SetBlock(1, inner);
  blocks->SetBlock(2, others);
  return blocks;
}

/// Cells of a cube of 16^3 that are 2 long: those from `first` to before `last` on x, of which
/// those before `own` and from `end` on are ghosts. They hold the distances of their centers.
struct Slab
{
  int First;
  int Last;
  int Own;
  int End;
};

template <class Grid>
void SetValues(Grid* grid, const Slab& slab)
{
  vtkNew<vtkDoubleArray> values;
  values->SetName("distance");
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  for (int k = 0; k < 16; ++k)
  {
    for (int j = 0; j < 16; ++j)
    {
      for (int i = slab.First; i < slab.Last; ++i)
      {
        values->InsertNextValue(GetDistance(dvec3(2 * i - 15, 2 * j - 15, 2 * k - 15)));
        const bool isOwn = i >= slab.Own && i < slab.End;
        ghosts->InsertNextValue(isOwn ? 0 : vtkDataSetAttributes::DUPLICATECELL);
      }
    }
  }
  grid->GetCellData()->AddArray(values);
  grid->GetCellData()->AddArray(ghosts);
}

vtkSmartPointer<vtkDataSet> MakeCells(bool isRectilinear, const Slab& slab, double shift = 0.0)
{
  const int extent[6] = { 0, slab.Last - slab.First, 0, 16, 0, 16 };
  const double corner = 2 * slab.First - 16 + shift;
  if (!isRectilinear)
  {
    auto image = vtkSmartPointer<vtkImageData>::New();
    image->SetExtent(const_cast<int*>(extent));
    image->SetOrigin(corner, -16.0, -16.0);
    image->SetSpacing(2.0, 2.0, 2.0);
    SetValues(image.Get(), slab);
    return image;
  }
  auto grid = vtkSmartPointer<vtkRectilinearGrid>::New();
  grid->SetExtent(const_cast<int*>(extent));
  for (int axis = 0; axis < 3; ++axis)
  {
    vtkNew<vtkDoubleArray> planes;
    for (int plane = 0; plane <= extent[2 * axis + 1]; ++plane)
    {
      planes->InsertNextValue((axis == 0 ? corner : -16.0) + 2.0 * plane);
    }
    axis == 0     ? grid->SetXCoordinates(planes)
      : axis == 1 ? grid->SetYCoordinates(planes)
                  : grid->SetZCoordinates(planes);
  }
  SetValues(grid.Get(), slab);
  return grid;
}

/// What cells' values are at points, as Cell Data to Point Data has them: the means of the cells
/// around. Of the points from `first` to `last` on x.
vtkSmartPointer<vtkImageData> MakeMeans(int first, int last)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(first, last, 0, 16, 0, 16);
  image->SetOrigin(-16.0, -16.0, -16.0);
  image->SetSpacing(2.0, 2.0, 2.0);
  vtkNew<vtkDoubleArray> values;
  values->SetName("distance");
  for (vtkIdType point = 0; point < image->GetNumberOfPoints(); ++point)
  {
    dvec3 place;
    image->GetPoint(point, &place.x);
    double sum = 0.0;
    int count = 0;
    for (int corner = 0; corner < 8; ++corner)
    {
      const dvec3 cell = place + 2.0 * dvec3(corner & 1, corner >> 1 & 1, corner >> 2) - 1.0;
      const bool isThere = glm::all(glm::lessThan(glm::abs(cell), dvec3(16.0)));
      sum += isThere ? GetDistance(cell) : 0.0;
      count += isThere ? 1 : 0;
    }
    values->InsertNextValue(sum / count);
  }
  image->GetPointData()->AddArray(values);
  return image;
}

} // namespace

class VolumeMapperBlocks : public VolumeMapperLevels
{
protected:
  /// The picture of a multi-block, and of its blocks in mappers of their own, with the same settings.
  void ExpectSameAsApart(vtkMultiBlockDataSet* blocks, int tolerance = 0)
  {
    const auto together = this->Draw(blocks);
    EXPECT_FALSE(this->Errors->GetError()) << this->Errors->GetErrorMessage();
    this->Renderer->RemoveVolume(this->Volume);
    std::vector<vtkSmartPointer<vtkVolume>> volumes;
    const auto add = [&](vtkDataObject* block)
    {
      vtkNew<vtkDSMVolumeMapper> mapper;
      mapper->ShallowCopy(this->Mapper);
      mapper->SetInputDataObject(block);
      mapper->AddObserver(vtkCommand::ErrorEvent, this->Errors);
      const auto& volume = volumes.emplace_back(vtkSmartPointer<vtkVolume>::New());
      volume->SetMapper(mapper);
      volume->SetProperty(this->Volume->GetProperty());
      this->Renderer->AddVolume(volume);
    };
    vtkSmartPointer<vtkCompositeDataIterator> leaf;
    leaf.TakeReference(blocks->NewIterator());
    for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
    {
      add(leaf->GetCurrentDataObject());
    }
    this->Window->Render();
    const std::vector<unsigned char> apart = this->GetPixels();
    for (const auto& volume : volumes)
    {
      this->Renderer->RemoveVolume(volume);
    }
    this->Renderer->AddVolume(this->Volume);
    EXPECT_FALSE(this->Errors->GetError()) << this->Errors->GetErrorMessage();
    int greatest = 0;
    for (std::size_t byte = 0; byte < apart.size(); ++byte)
    {
      greatest = std::max(greatest, std::abs(together[byte] - apart[byte]));
    }
    EXPECT_LE(greatest, tolerance);
    EXPECT_GT(
      std::count_if(apart.begin(), apart.end(), [](unsigned char one) { return one > 50; }), 3000);
  }
};

TEST_F(VolumeMapperBlocks, BlocksOfAllKindsShowWhatTheyShowApart)
{
  const auto blocks = MakeAllKinds();
  this->Mapper->SetInputDataObject(blocks);
  ASSERT_TRUE(this->Mapper->GetBounds());
  EXPECT_EQ(this->Mapper->GetBounds()[1], 33.0); // of trees
  this->Renderer->ResetCamera(this->Mapper->GetBounds());
  this->ExpectSameAsApart(blocks);
  // Translucent, and colored.
  this->Mapper->SetIsoValue(1, 0.3);
  this->Mapper->GetSurfaceProperty()->SetOpacity(0.5);
  this->Mapper->ScalarVisibilityOn();
  vtkNew<vtkLookupTable> table;
  table->SetRange(0.0, 0.6);
  this->Mapper->SetLookupTable(table);
  this->Mapper->SetColorArray("distance");
  this->ExpectSameAsApart(blocks);
  // Planes.
  this->Mapper->SlicingOn();
  this->Mapper->AddSlice(2, 4);
  vtkNew<vtkPlane> plane;
  plane->SetNormal(0.3, 1.0, 0.2);
  this->Mapper->AddSlicePlane(plane);
  this->Mapper->SetNumberOfIsoValues(0);
  this->ExpectSameAsApart(blocks);
  this->Mapper->SlicingOff();
  // Media.
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(0.2, 0.5);
  opacity->AddPoint(0.5, 0.0);
  vtkNew<vtkColorTransferFunction> color;
  color->AddRGBPoint(0.0, 1.0, 0.2, 0.2);
  color->AddRGBPoint(0.5, 0.2, 1.0, 0.2);
  this->Volume->GetProperty()->SetScalarOpacity(opacity);
  this->Volume->GetProperty()->SetColor(color);
  this->Volume->GetProperty()->SetInterpolationTypeToLinear();
  this->ExpectSameAsApart(blocks, 1);
}

TEST_F(VolumeMapperBlocks, GhostCellsCountInTheMeansAtPoints)
{
  const auto expectSame = [&](const std::vector<double>& one, const std::vector<double>& other)
  {
    EXPECT_FALSE(this->Errors->GetError()) << this->Errors->GetErrorMessage();
    EXPECT_GT(CountCovered(other), 2000);
    int different = 0;
    for (std::size_t pixel = 0; pixel < one.size(); ++pixel)
    {
      const bool isSame = one[pixel] == other[pixel] || std::abs(one[pixel] - other[pixel]) < 0.02;
      different += isSame ? 0 : 1;
    }
    EXPECT_LE(different, 200); // at silhouettes
  };
  const std::vector<double> half = this->Render(MakeMeans(0, 8));
  const std::vector<double> whole = this->Render(MakeMeans(0, 16));
  this->Mapper->SetIsoArrayOnCells(true);
  for (const bool isRectilinear : { false, true })
  {
    SCOPED_TRACE(isRectilinear);
    expectSame(this->Render(MakeCells(isRectilinear, { 0, 9, 0, 8 })), half);
    // The second block may be a little beside the first one's place, or too far for one volume.
    for (const double shift : { 0.0, 1e-6, 3e-3 })
    {
      SCOPED_TRACE(shift);
      vtkNew<vtkMultiBlockDataSet> blocks;
      blocks->SetBlock(0, MakeCells(isRectilinear, { 0, 9, 0, 8 }));
      blocks->SetBlock(1, MakeCells(isRectilinear, { 7, 16, 8, 16 }, shift));
      expectSame(this->Render(blocks), whole);
    }
  }
  // Without ghosts, blocks whose planes differ by little have to meet.
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, MakeCells(true, { 0, 8, 0, 8 }));
  blocks->SetBlock(1, MakeCells(true, { 8, 16, 8, 16 }, 1e-6));
  expectSame(this->Render(blocks), whole);
}

TEST_F(VolumeMapperBlocks, HyperTreeGridsAreOneWhereTheirRootsAre)
{
  // Halves of one grid.
  const auto whole = this->Draw(MakeTrees(2));
  vtkNew<vtkMultiBlockDataSet> halves;
  halves->SetBlock(0, MakeTrees(2, false, 3, [](double x) { return x < 0.0; }));
  halves->SetBlock(1, MakeTrees(2, false, 3, [](double x) { return x >= 0.0; }));
  EXPECT_EQ(this->Draw(halves), whole);
  // Every second slab of roots: pieces of one dataset, and grids of their own.
  const auto isOdd = [](double x) { return static_cast<int>(x + 16.0) / 4 % 2 == 1; };
  vtkNew<vtkPartitionedDataSetCollection> pieces;
  pieces->SetPartition(0, 0, MakeTrees(2, false, 3, isOdd));
  pieces->SetPartition(0, 1, MakeTrees(2, false, 3, [&](double x) { return !isOdd(x); }));
  EXPECT_EQ(this->Draw(pieces), whole);
  // Two in the same place.
  const auto larger = MakeTrees(2);
  vtkDataArray* const values = larger->GetCellData()->GetArray("distance");
  for (vtkIdType cell = 0; cell < values->GetNumberOfTuples(); ++cell)
  {
    values->SetTuple1(cell, values->GetTuple1(cell) - 0.05);
  }
  this->Mapper->GetSurfaceProperty()->SetOpacity(0.5);
  vtkNew<vtkMultiBlockDataSet> nested;
  nested->SetBlock(0, MakeTrees(2));
  nested->SetBlock(1, larger);
  this->ExpectSameAsApart(nested);
  EXPECT_FALSE(this->Errors->GetError()) << this->Errors->GetErrorMessage();
}

TEST_F(VolumeMapperBlocks, HiddenBlocksAreNotThere)
{
  const auto blocks = MakeAllKinds();
  this->Mapper->SetInputDataObject(blocks);
  this->Renderer->ResetCamera(this->Mapper->GetBounds());
  vtkSmartPointer<vtkCompositeDataIterator> leaf;
  leaf.TakeReference(blocks->NewIterator());
  for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
  {
    this->Mapper->SetBlockVisibility(leaf->GetCurrentFlatIndex(), false);
    const std::vector<unsigned char> hidden = this->Draw(blocks);
    this->Mapper->RemoveBlockLooks();
    vtkNew<vtkMultiBlockDataSet> others;
    others->ShallowCopy(blocks);
    others->SetDataSet(leaf, nullptr);
    EXPECT_EQ(this->Draw(others), hidden) << leaf->GetCurrentFlatIndex();
  }
  // Of AMR, coarser blocks are where finer ones are hidden.
  const auto amr =
    MakeAmr<vtkOverlappingAMR>([](std::size_t number) { return Make(Blocks[number]); });
  const auto coarse = MakeAmr<vtkNonOverlappingAMR>([](std::size_t number)
    { return number == 0 ? Make(Blocks[number]) : vtkSmartPointer<vtkUniformGrid>(); });
  leaf.TakeReference(amr->NewIterator());
  leaf->InitTraversal();
  for (leaf->GoToNextItem(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
  {
    this->Mapper->SetBlockVisibility(leaf->GetCurrentFlatIndex(), false);
  }
  const std::vector<unsigned char> hidden = this->Draw(amr);
  this->Mapper->RemoveBlockLooks();
  EXPECT_EQ(this->Draw(coarse), hidden);
  // An array that only hidden blocks have is not missing.
  const auto other = MakeTrees(2);
  other->GetCellData()->GetArray("distance")->SetName("other");
  vtkNew<vtkMultiBlockDataSet> both;
  both->SetBlock(0, MakeTrees(2));
  both->SetBlock(1, other);
  this->Mapper->SetIsoArrayOnCells(true);
  this->Mapper->SetBlockVisibility(1, false);
  this->Draw(both);
  EXPECT_FALSE(this->Errors->GetError()) << this->Errors->GetErrorMessage();
}

TEST_F(VolumeMapperBlocks, BlocksOfTreesHaveColorsAndOpacities)
{
  vtkNew<vtkMultiBlockDataSet> halves;
  halves->SetBlock(0, MakeTrees(2, false, 3, [](double x) { return x < 0.0; }));
  halves->SetBlock(1, MakeTrees(2, false, 3, [](double x) { return x >= 0.0; }));
  this->Mapper->GetSurfaceProperty()->LightingOff();
  this->Mapper->SetBlockColor(1, 0.0, 1.0, 0.0);
  this->Mapper->SetBlockColor(2, 0.0, 0.0, 1.0);
  this->Mapper->SetBlockOpacity(2, 0.25);
  const std::vector<unsigned char> pixels = this->Draw(halves);
  const auto count = [&](const std::array<int, 3>& color)
  {
    int found = 0;
    for (std::size_t pixel = 0; pixel < pixels.size(); pixel += 3)
    {
      found += std::equal(color.begin(), color.end(), pixels.begin() + pixel,
                 [](int a, unsigned char b) { return std::abs(a - b) <= 1; })
        ? 1
        : 0;
    }
    return found;
  };
  EXPECT_GT(count({ 0, 255, 0 }), 2000);
  EXPECT_GT(count({ 0, 0, 112 }), 2000); // a front and a back
  EXPECT_GT(count({ 0, 191, 64 }), 300); // before the other half
}
