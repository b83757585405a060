// SPDX-License-Identifier: BSD-3-Clause
// AMR and hyper tree grids: leaves of several levels.
#include "VolumeMapperTest.h"

#include "vtkAMRBox.h"
#include "vtkBitArray.h"
#include "vtkCellData.h"
#include "vtkColorTransferFunction.h"
#include "vtkCompositeDataIterator.h"
#include "vtkDataSetAttributes.h"
#include "vtkHyperTree.h"
#include "vtkHyperTreeGrid.h"
#include "vtkHyperTreeGridNonOrientedCursor.h"
#include "vtkIntArray.h"
#include "vtkLookupTable.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNonOverlappingAMR.h"
#include "vtkOverlappingAMR.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPlane.h"
#include "vtkPolyData.h"
#include "vtkProperty.h"
#include "vtkRectilinearGrid.h"
#include "vtkTestErrorObserver.h"
#include "vtkUniformGrid.h"
#include "vtkVolumeProperty.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <functional>
#include <string>

namespace
{

using glm::dvec3;
using glm::ivec3;

/// A block of cells of one level; level 0 has 16^3 cells in [-16, 16]^3.
struct Block
{
  int Level;
  ivec3 First; ///< cell of the level
  ivec3 Cells;
  int Ghosts = 0; ///< layers around
};

/// Coarse everywhere, finer by 2 in two places, and by 4 in the middle.
const std::vector<Block> Blocks{ { 0, ivec3(0), ivec3(16) }, { 1, ivec3(8), ivec3(16) },
  { 1, ivec3(0, 8, 8), ivec3(8) }, { 2, ivec3(48), ivec3(16, 8, 16) } };

double GetDistance(const dvec3& place)
{
  return glm::length(place) / Edge;
}

/// `extentAtGhosts`: the first cell that is no ghost has index 0, so extents begin below 0.
vtkSmartPointer<vtkUniformGrid> Make(const Block& block, bool extentAtGhosts = false, int ratio = 2,
  const char* name = "distance", bool asInteger = false)
{
  const double cell = 2.0 / std::pow(ratio, block.Level);
  auto grid = vtkSmartPointer<vtkUniformGrid>::New();
  const dvec3 corner = dvec3(-16.0) + cell * dvec3(block.First);
  const int ghosts = block.Ghosts;
  const int begin = extentAtGhosts ? -ghosts : 0;
  const dvec3 origin = corner - cell * (ghosts + begin);
  grid->SetOrigin(origin.x, origin.y, origin.z);
  grid->SetSpacing(cell, cell, cell);
  const ivec3 size = block.Cells + 2 * ghosts;
  grid->SetExtent(begin, begin + size.x, begin, begin + size.y, begin, begin + size.z);
  vtkSmartPointer<vtkDataArray> values;
  if (asInteger)
  {
    values = vtkSmartPointer<vtkIntArray>::New();
  }
  else
  {
    values = vtkSmartPointer<vtkDoubleArray>::New();
  }
  values->SetName(name);
  vtkNew<vtkUnsignedCharArray> flags;
  flags->SetName(vtkDataSetAttributes::GhostArrayName());
  for (int k = 0; k < size.z; ++k)
  {
    for (int j = 0; j < size.y; ++j)
    {
      for (int i = 0; i < size.x; ++i)
      {
        const ivec3 at = ivec3(i, j, k) - ghosts;
        const bool isGhost =
          glm::any(glm::lessThan(at, ivec3(0))) || glm::any(glm::greaterThanEqual(at, block.Cells));
        // What ghosts hold must not matter.
        values->InsertNextTuple1(
          isGhost ? 99.0 : GetDistance(corner + cell * (dvec3(at) + 0.5)) * (asInteger ? 100 : 1));
        flags->InsertNextValue(isGhost ? vtkDataSetAttributes::DUPLICATECELL : 0);
      }
    }
  }
  grid->GetCellData()->AddArray(values);
  if (ghosts > 0)
  {
    grid->GetCellData()->AddArray(flags);
  }
  return grid;
}

template <class Amr>
vtkSmartPointer<Amr> MakeAmr(
  const std::function<vtkSmartPointer<vtkUniformGrid>(std::size_t)>& make)
{
  auto amr = vtkSmartPointer<Amr>::New();
  int counts[3] = {};
  for (const Block& block : Blocks)
  {
    ++counts[block.Level];
  }
  amr->Initialize(3, counts);
  int next[3] = {};
  for (std::size_t number = 0; number < Blocks.size(); ++number)
  {
    const Block& block = Blocks[number];
    const auto grid = make(number);
    if constexpr (std::is_same_v<Amr, vtkOverlappingAMR>)
    {
      const double cell = 2.0 / (1 << block.Level);
      const double origin[] = { -16.0, -16.0, -16.0 };
      const double spacing[] = { cell, cell, cell };
      amr->SetOrigin(origin);
      amr->SetGridDescription(VTK_XYZ_GRID);
      amr->SetSpacing(static_cast<unsigned>(block.Level), spacing);
      const ivec3 last = block.First + block.Cells - 1;
      amr->SetAMRBox(static_cast<unsigned>(block.Level), static_cast<unsigned>(next[block.Level]),
        vtkAMRBox(&block.First.x, &last.x));
    }
    if (grid)
    {
      amr->SetDataSet(
        static_cast<unsigned>(block.Level), static_cast<unsigned>(next[block.Level]), grid);
    }
    ++next[block.Level];
  }
  return amr;
}

/// Refined near the ball's surface. `masks`: cells at x < 0 are not there. Trees for which `has` is false of the x of their
/// corner are not there either.
vtkSmartPointer<vtkHyperTreeGrid> MakeTrees(
  int branching, bool masks = false, int dimensions = 3,
  const std::function<bool(double)>& has = [](double) { return true; })
{
  auto grid = vtkSmartPointer<vtkHyperTreeGrid>::New();
  constexpr unsigned roots = 8;
  const unsigned points[3] = { roots + 1, roots + 1, dimensions == 3 ? roots + 1 : 1u };
  grid->SetDimensions(points);
  grid->SetBranchFactor(static_cast<unsigned>(branching));
  const auto makeAxis = [&](unsigned count)
  {
    vtkNew<vtkDoubleArray> axis;
    for (unsigned point = 0; point < count; ++point)
    {
      axis->InsertNextValue(count == 1 ? 0.0 : -16.0 + 4.0 * point);
    }
    return axis;
  };
  grid->SetXCoordinates(makeAxis(points[0]));
  grid->SetYCoordinates(makeAxis(points[1]));
  grid->SetZCoordinates(makeAxis(points[2]));
  vtkNew<vtkDoubleArray> values;
  values->SetName("distance");
  vtkNew<vtkBitArray> mask;
  vtkNew<vtkHyperTreeGridNonOrientedCursor> cursor;
  vtkIdType next = 0;
  const std::function<void(int, dvec3, double)> refine = [&](int level, dvec3 corner, double edge)
  {
    const vtkIdType id = cursor->GetGlobalNodeIndex();
    const dvec3 middle = corner + 0.5 * edge;
    values->InsertValue(id, GetDistance(middle));
    mask->InsertValue(id, masks && middle.x < 0.0 ? 1 : 0);
    if (level == 2 || std::abs(GetDistance(middle) - 0.4) * Edge > 1.2 * edge)
    {
      return;
    }
    cursor->SubdivideLeaf();
    const double part = edge / branching;
    unsigned char child = 0;
    for (int k = 0; k < (dimensions == 3 ? branching : 1); ++k)
    {
      for (int j = 0; j < branching; ++j)
      {
        for (int i = 0; i < branching; ++i)
        {
          cursor->ToChild(child++);
          refine(level + 1, corner + part * dvec3(i, j, k), part);
          cursor->ToParent();
        }
      }
    }
  };
  for (vtkIdType tree = 0; tree < grid->GetMaxNumberOfTrees(); ++tree)
  {
    unsigned at[3];
    grid->GetLevelZeroCoordinatesFromIndex(tree, at[0], at[1], at[2]);
    if (!has(-16.0 + 4.0 * at[0]))
    {
      continue;
    }
    grid->InitializeNonOrientedCursor(cursor, tree, true);
    cursor->SetGlobalIndexStart(next);
    refine(0, dvec3(-16.0) + 4.0 * dvec3(at[0], at[1], at[2]), 4.0);
    next += cursor->GetTree()->GetNumberOfVertices();
  }
  grid->GetCellData()->AddArray(values);
  if (masks)
  {
    grid->SetMask(mask);
  }
  return grid;
}

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

} // namespace

class VolumeMapperLevels : public VolumeMapper
{
protected:
  VolumeMapperLevels()
  {
    this->Mapper->AddObserver(vtkCommand::ErrorEvent, this->Errors);
    this->Mapper->SetIsoArray("distance");
    this->Renderer->AddVolume(this->Volume);
  }

  std::vector<double> Render(vtkDataObject* data)
  {
    this->Mapper->SetInputDataObject(data);
    return this->RenderDistances();
  }

  /// The whole surface of the ball.
  void ExpectBall(const std::vector<double>& distances, double tolerance = 0.35)
  {
    EXPECT_FALSE(this->Errors->GetError()) << this->Errors->GetErrorMessage();
    const dvec3 eye(20.0, 30.0, 60.0);
    const double nearest = glm::length(eye) - 0.4 * Edge;
    const auto least = *std::min_element(distances.begin(), distances.end());
    EXPECT_NEAR(least, nearest, tolerance);
    // The sphere's silhouette is a disk.
    const double sine = 0.4 * Edge / glm::length(eye);
    const double tangent = sine / std::sqrt(1.0 - sine * sine);
    const double angle = this->Renderer->GetActiveCamera()->GetViewAngle() * 3.14159265 / 360.0;
    const double radius = 0.5 * Size * tangent / std::tan(angle);
    EXPECT_NEAR(CountCovered(distances) / (3.14159265 * radius * radius), 1.0, 0.02);
  }

  void ExpectError(vtkDataObject* data, const std::string& part)
  {
    this->Render(data);
    EXPECT_TRUE(this->Errors->GetError()) << part;
    const std::string message = this->Errors->GetErrorMessage();
    EXPECT_NE(message.find(part), std::string::npos) << message;
    this->Errors->Clear();
  }

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

  std::vector<unsigned char> Draw(vtkDataObject* data)
  {
    this->Mapper->SetInputDataObject(data);
    this->Window->Render();
    return this->GetPixels();
  }

  std::vector<unsigned char> GetPixels()
  {
    vtkNew<vtkUnsignedCharArray> pixels;
    this->Window->GetPixelData(0, 0, Size - 1, Size - 1, 0, pixels);
    return { pixels->GetPointer(0), pixels->GetPointer(0) + pixels->GetNumberOfValues() };
  }

  vtkNew<vtkTest::ErrorObserver> Errors;
};

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

TEST_F(VolumeMapperLevels, BlocksOfAllKindsShowWhatTheyShowApart)
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

TEST_F(VolumeMapperLevels, HyperTreeGridsAreOneWhereTheirRootsAre)
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

TEST_F(VolumeMapperLevels, BlocksOfTreesHaveColorsAndOpacities)
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
  this->ExpectError(MakeTrees(2, false, 2), "2 dimensions");
  vtkNew<vtkMultiBlockDataSet> flat;
  flat->SetBlock(0, MakeTrees(2, false, 2));
  flat->SetBlock(1, vtkSmartPointer<vtkPolyData>::New());
  this->ExpectError(flat, "nor hyper tree grids");
  this->ExpectBall(this->Render(MakeTrees(2)));
}
