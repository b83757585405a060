// SPDX-License-Identifier: BSD-3-Clause
#ifndef VolumeMapperLevelsTest_h
#define VolumeMapperLevelsTest_h

#include "VolumeMapperTest.h"

#include "vtkAMRBox.h"
#include "vtkBitArray.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkHyperTree.h"
#include "vtkHyperTreeGrid.h"
#include "vtkHyperTreeGridNonOrientedCursor.h"
#include "vtkIntArray.h"
#include "vtkOverlappingAMR.h"
#include "vtkTestErrorObserver.h"
#include "vtkUniformGrid.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <functional>
#include <string>
#include <vector>

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
inline const std::vector<Block> Blocks{ { 0, ivec3(0), ivec3(16) }, { 1, ivec3(8), ivec3(16) },
  { 1, ivec3(0, 8, 8), ivec3(8) }, { 2, ivec3(48), ivec3(16, 8, 16) } };

inline double GetDistance(const dvec3& place)
{
  return glm::length(place) / Edge;
}

/// `extentAtGhosts`: the first cell that is no ghost has index 0, so extents begin below 0.
inline vtkSmartPointer<vtkUniformGrid> Make(const Block& block, bool extentAtGhosts = false,
  int ratio = 2, const char* name = "distance", bool asInteger = false)
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

/// Refined near the ball's surface. `masks`: cells at x < 0 are not there. Trees for which `has` is false of the x
/// of their corner are not there either.
inline vtkSmartPointer<vtkHyperTreeGrid> MakeTrees(
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

  /// The mean difference of two pictures, of 255.
  static double Compare(
    const std::vector<unsigned char>& one, const std::vector<unsigned char>& other)
  {
    double sum = 0.0;
    for (std::size_t byte = 0; byte < one.size(); ++byte)
    {
      sum += std::abs(one[byte] - other[byte]);
    }
    return sum / static_cast<double>(one.size());
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

#endif
