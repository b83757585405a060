// SPDX-License-Identifier: BSD-3-Clause
// Isosurfaces as triangles.
#include "vtkDSMSceneVolume.h"

#include "DSMRayTracing/field/ValuePredicates.h"
#include "vtkDSMCellTriangles.h"
#include "vtkDSMImagePiece.h"
#include "vtkDSMScene.h"

#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkHyperTreeGrid.h"
#include "vtkImageData.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStructuredData.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <map>

namespace
{

using bricks::Box;
using bricks::Index3;

/// Points of a surface in so many cells of bricks that it meets, about.
constexpr vtkIdType CellsForPoint = 8;

template <class Visit>
void ForEachCorner(const Visit& visit)
{
  for (int corner = 0; corner < 8; ++corner)
  {
    visit(corner, Index3(corner & 1, corner >> 1 & 1, corner >> 2));
  }
}

/// Calls `visit(cell, corners)` for the cells of a brick that hold data. `cell`: of the brick; `corners`: their values.
template <class Visit>
void ForEachCell(const rt::FieldReader::Brick& brick, const Visit& visit)
{
  const Index3 row = brick.Cells + Index3(1);
  auto holdsData = brick.HoldsData.begin();
  bricks::ForEachIndex({ Index3(0), brick.Cells },
    [&](const Index3& cell)
    {
      if (*holdsData++ == 0)
      {
        return;
      }
      double values[8];
      ForEachCorner(
        [&](int corner, const Index3& more)
        {
          const Index3 at = cell + more;
          values[corner] =
            brick.Samples[static_cast<std::size_t>(at.x + row.x * (at.y + row.y * at.z))];
        });
      visit(cell, values);
    });
}

bool HasAny(const double values[8], const std::vector<double>& isovalues)
{
  const auto [least, greatest] = std::minmax_element(values, values + 8);
  return std::any_of(isovalues.begin(), isovalues.end(),
    [low = *least, high = *greatest](double isovalue)
    { return low < isovalue && isovalue <= high; });
}

void AddNormals(const std::vector<glm::dvec3>& normals, vtkPolyData* triangles)
{
  vtkNew<vtkFloatArray> array;
  array->SetName("Normals");
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(static_cast<vtkIdType>(normals.size()));
  for (std::size_t number = 0; number < normals.size(); ++number)
  {
    array->SetTuple(static_cast<vtkIdType>(number), &normals[number].x);
  }
  triangles->GetPointData()->SetNormals(array);
}

} // namespace

/// One dataset of this rank after the other.
class vtkDSMSceneVolume::TriangleMaker
{
public:
  TriangleMaker(const vtkDSMSceneVolume& volume, rt::FieldReader& reader,
    const std::vector<double>& isovalues, Purpose purpose, vtkMultiBlockDataSet* surfaces)
    : Volume(volume)
    , Reader(reader)
    , Isovalues(isovalues)
    , Use(purpose)
    , Surfaces(surfaces)
  {
    auto* const all = vtkCompositeDataSet::SafeDownCast(volume.Mapper->GetDataObjectInput());
    if (all)
    {
      vtkSmartPointer<vtkCompositeDataIterator> leaf;
      leaf.TakeReference(all->NewIterator());
      for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
      {
        this->Blocks[leaf->GetCurrentDataObject()] = leaf->GetCurrentFlatIndex();
      }
    }
  }

  void AddImage(const vtkDSMVolumeData::OwnImage& own)
  {
    const vtkDSMVolumeData& data = *this->Volume.Data;
    rt::LatticeField field;
    field.Voxels = this->Volume.GetIso()->GetFields()[own.Lattice];
    if (!field.Voxels)
    {
      return;
    }
    this->CheckCells(own.Image);
    field.SetIndexToWorld(data.GetIndexToWorld(own.Lattice));
    const bricks::BrickLattice& lattice = field.Voxels->Lattice;
    const rt::IsovaluePredicate mayHold(this->Isovalues);
    const auto& ranges = field.Voxels->Hierarchy.GetLevels().front().Ranges;
    std::vector<dsm::BlockId> ids;
    const Index3 edge(lattice.GetEdge());
    bricks::ForEachIndex({ own.Cells.Min / edge, (own.Cells.Max + edge - Index3(1)) / edge },
      [&](const Index3& brick)
      {
        const dsm::BlockId id = lattice.GetId(brick);
        if (mayHold(ranges[static_cast<std::size_t>(id)]))
        {
          ids.push_back(id);
        }
      });
    int extent[6];
    vtkDSMImagePiece::GetExtent(own.Image, extent);
    const unsigned int block = this->FindBlock(own.Image);
    vtkDSMCellTriangles triangles(own.Image->GetBounds(),
      static_cast<vtkIdType>(ids.size()) * (edge.x * edge.y * edge.z) / CellsForPoint,
      IsMirrored(field.IndexToWorld), !this->Blocks.empty());
    this->TakeColors(own.Image, triangles);
    this->Reader.ReadBricks(*field.Voxels->Segment, lattice.GetScalarType(), ids,
      [&](dsm::BlockId id, const rt::FieldReader::Brick& brick)
      {
        const Index3 first = lattice.GetCellsOfBrick(id).Min;
        const Box all{ first - own.IndexToLattice, first - own.IndexToLattice + brick.Cells };
        const Box some = bricks::Intersect(
          all, { own.Cells.Min - own.IndexToLattice, own.Cells.Max - own.IndexToLattice });
        const auto shown = vtkDSMImagePiece::FindShown(own.Image, some);
        const Index3 size = some.GetSize();
        ForEachCell(brick,
          [&](const Index3& in, const double values[8])
          {
            const Index3 cell = all.Min + in;
            const Index3 at = cell - some.Min;
            const bool isShown =
              bricks::Intersect({ cell, cell + Index3(1) }, some).GetCount() > 0 &&
              shown[static_cast<std::size_t>(at.x + size.x * (at.y + size.y * at.z))] != 0;
            if (!isShown || !HasAny(values, this->Isovalues))
            {
              return;
            }
            vtkDSMCellTriangles::Cell full;
            std::copy_n(values, 8, full.Values);
            ForEachCorner(
              [&](int corner, const Index3& more)
              {
                const Index3 point = cell + more;
                const glm::dvec3 index(point + own.IndexToLattice);
                const auto* const planes = field.Voxels->Planes.get();
                full.Places[corner] = glm::dvec3(
                  field.IndexToWorld * glm::dvec4(planes ? planes->ToPlace(index) : index, 1.0));
                glm::ivec3 structured(point);
                full.Points[corner] =
                  vtkStructuredData::ComputePointIdForExtent(extent, &structured.x);
              });
            glm::ivec3 structured(cell);
            full.Id = vtkStructuredData::ComputeCellIdForExtent(extent, &structured.x);
            full.Block = block;
            triangles.Add(full, this->Isovalues);
          });
        this->CheckCount(triangles);
      });
    this->Finish(field, triangles);
  }

  /// The leaves of one of the dataset's levels.
  void AddLevels(std::size_t levels)
  {
    const vtkDSMLevelData& data = this->Volume.Data->GetLevels(levels);
    const auto& parts = data.GetParts();
    if (this->Use == Purpose::Selection &&
      std::any_of(parts.begin(), parts.end(),
        [](const auto& part) { return vtkHyperTreeGrid::SafeDownCast(part); }))
    {
      return;
    }
    rt::LevelField field;
    field.Voxels = this->Volume.GetIso()->GetLevels()[levels];
    if (!field.Voxels)
    {
      return;
    }
    field.SetIndexToWorld(data.GetIndexToWorld());
    const bricks::LevelLattice& lattice = field.Voxels->Lattice;
    const std::unique_ptr<vtkDSMLevelSource> source =
      data.FindLeaves(this->Volume.GetIso()->Choice);
    std::vector<dsm::BlockId> ids;
    std::vector<std::size_t> cubes; // of the bricks
    const rt::IsovaluePredicate mayHold(this->Isovalues);
    for (std::size_t number = 0; number < source->GetCubes().size(); ++number)
    {
      const bricks::LevelCube& cube = source->GetCubes()[number];
      const Index3 first = bricks::LevelCubes::GetFirst(cube);
      const Box cells{ first, first + Index3(bricks::LevelLattice::Edge) };
      lattice.ForEachTouching(cube.Level, cells, cube.Level,
        [&](dsm::BlockId id, const bricks::LevelBrick& brick)
        {
          if (!bricks::Intersect(brick.Cells, cells).IsEmpty() &&
            mayHold(field.Voxels->Hierarchy.GetRange(id)))
          {
            ids.push_back(id);
            cubes.push_back(number);
          }
        });
    }
    std::vector<unsigned int> blocks;
    for (const auto& part : parts)
    {
      blocks.push_back(this->FindBlock(part));
    }
    double bounds[6];
    data.GetBounds(bounds);
    const Index3 edge(bricks::LevelLattice::Edge);
    vtkDSMCellTriangles triangles(bounds,
      static_cast<vtkIdType>(ids.size()) * (edge.x * edge.y * edge.z) / CellsForPoint,
      IsMirrored(field.IndexToWorld), !this->Blocks.empty());
    std::size_t place = 0;
    std::size_t read = source->GetCubes().size();
    std::vector<vtkDSMLevelSource::Cell> own; // of cube `read`
    this->Reader.ReadBricks(*field.Voxels->Segment, lattice.GetScalarType(), ids,
      [&](dsm::BlockId id, const rt::FieldReader::Brick& brick)
      {
        const std::size_t number = cubes[place++];
        if (number != read)
        {
          own = source->ReadCells(number);
          read = number;
        }
        const Index3 first = lattice.GetBrick(id).Cells.Min;
        const glm::dvec3 scale(lattice.GetScales().Get(lattice.GetBrick(id).Level));
        ForEachCell(brick,
          [&](const Index3& in, const double values[8])
          {
            const Index3 at = (first + in) % edge;
            const vtkDSMLevelSource::Cell& cell =
              own[static_cast<std::size_t>(at.x + edge.x * (at.y + edge.y * at.z))];
            if (cell.Part < 0 || !HasAny(values, this->Isovalues))
            {
              return;
            }
            vtkDSMCellTriangles::Cell full;
            std::copy_n(values, 8, full.Values);
            full.Id = cell.Id;
            full.Block = blocks[static_cast<std::size_t>(cell.Part)];
            auto* const image =
              vtkImageData::SafeDownCast(parts[static_cast<std::size_t>(cell.Part)]);
            int corners[3] = { 0, 0, 0 };
            if (image)
            {
              vtkStructuredData::ComputeCellStructuredCoordsForExtent(
                cell.Id, image->GetExtent(), corners);
            }
            ForEachCorner(
              [&](int corner, const Index3& more)
              {
                const glm::dvec3 index(first + in + more);
                full.Places[corner] =
                  glm::dvec3(field.IndexToWorld * glm::dvec4(index / scale, 1.0));
                glm::ivec3 point(glm::ivec3(corners[0], corners[1], corners[2]) + glm::ivec3(more));
                full.Points[corner] = image
                  ? vtkStructuredData::ComputePointIdForExtent(image->GetExtent(), &point.x)
                  : -1;
              });
            triangles.Add(full, this->Isovalues);
          });
        this->CheckCount(triangles);
      });
    this->Finish(field, triangles);
    this->ColorLevels(levels, triangles);
  }

private:
  static bool IsMirrored(const glm::dmat4& toWorld)
  {
    return glm::determinant(glm::dmat3(toWorld)) < 0.0;
  }

  /// Returns the flat index of a dataset; 0 where there are no blocks.
  unsigned int FindBlock(vtkDataObject* dataset) const
  {
    const auto block = this->Blocks.find(dataset);
    return block != this->Blocks.end() ? block->second : 0;
  }

  /// A selection is extracted with a table of all cells.
  void CheckCells(vtkDataSet* dataset) const
  {
    if (this->Use == Purpose::Selection &&
      dataset->GetNumberOfCells() > vtkDSMScene::MostCellsOfSelection)
    {
      throw dsm::Error("Selection is not available in a block of " +
        std::to_string(dataset->GetNumberOfCells()) + " cells on one rank; the maximum is " +
        std::to_string(vtkDSMScene::MostCellsOfSelection) +
        ". Use more ranks or extract a subset.");
    }
  }

  void CheckCount(const vtkDSMCellTriangles& triangles) const
  {
    if (this->Count + triangles.GetNumberOfTriangles() > vtkDSMScene::MostTriangles)
    {
      throw dsm::Error("They have more than " + std::to_string(vtkDSMScene::MostTriangles) +
        " triangles on one rank. Use more ranks or extract a subset.");
    }
  }

  /// The array of a dataset that colors the surface.
  void TakeColors(vtkDataSet* dataset, vtkDSMCellTriangles& triangles) const
  {
    vtkDSMVolumeMapper* const mapper = this->Volume.Mapper;
    if (this->Use != Purpose::Export || !mapper->GetScalarVisibility())
    {
      return;
    }
    const bool onCells = mapper->GetColorArrayOnCells();
    vtkDataSetAttributes* const attributes =
      dataset->GetAttributes(onCells ? vtkDataObject::CELL : vtkDataObject::POINT);
    vtkDataArray* const colors = attributes->GetArray(mapper->GetColorArray().c_str());
    if (colors && onCells)
    {
      triangles.TakeCellArray(colors);
    }
    else if (colors)
    {
      triangles.TakePointArray(colors);
    }
  }

  template <class FieldType>
  void Finish(const FieldType& field, vtkDSMCellTriangles& triangles)
  {
    if (triangles.GetNumberOfTriangles() == 0)
    {
      return;
    }
    vtkPolyData* const surface = triangles.Finish();
    this->Count += triangles.GetNumberOfTriangles();
    if (this->Use == Purpose::Export)
    {
      std::vector<glm::dvec3> normals =
        this->Reader.FindGradients(field, triangles.GetPlacesWithin());
      for (glm::dvec3& normal : normals)
      {
        normal = field.GetNormal(normal, glm::dvec3(0.0, 0.0, -1.0));
      }
      AddNormals(normals, surface);
    }
    this->Surfaces->SetBlock(this->Surfaces->GetNumberOfBlocks(), surface);
  }

  /// With the values that color the picture.
  void ColorLevels(std::size_t levels, vtkDSMCellTriangles& triangles)
  {
    const auto color = this->Volume.GetColor();
    if (this->Use != Purpose::Export || !color || color->GetLevels().empty() ||
      !color->GetLevels()[levels])
    {
      return;
    }
    rt::LevelField field;
    field.Voxels = color->GetLevels()[levels];
    field.SetIndexToWorld(this->Volume.Data->GetLevels(levels).GetIndexToWorld());
    vtkNew<vtkDoubleArray> array;
    array->SetName(color->Choice.Name.c_str());
    for (const double value : this->Reader.FindValues(field, triangles.GetPlacesWithin()))
    {
      array->InsertNextValue(value);
    }
    triangles.Finish()->GetPointData()->AddArray(array);
  }

  const vtkDSMSceneVolume& Volume;
  rt::FieldReader& Reader;
  const std::vector<double>& Isovalues;
  Purpose Use;
  vtkMultiBlockDataSet* Surfaces;
  std::map<vtkDataObject*, unsigned int> Blocks; ///< flat indices of a composite dataset's leaves
  vtkIdType Count = 0;                           ///< triangles of the datasets so far
};

void vtkDSMSceneVolume::ExtractIsosurfaces(
  vtkDSMRankGroup& group, Purpose purpose, vtkMultiBlockDataSet* surfaces)
{
  const vtkDSMVolumeLook look = this->GetLook();
  std::vector<double> isovalues;
  if (this->Data && this->GetIso() && this->GetIso()->HasAny() && look.HasIsosurfaces())
  {
    isovalues = look.GetIsovalues(this->Suggested, this->Messages);
  }
  if (isovalues.empty())
  {
    return;
  }
  const char* const what = purpose == Purpose::Export ? "Isosurfaces cannot be exported."
                                                      : "Isosurfaces cannot be selected.";
  group.GetFrameRenderer().Read(what, group.GetStore(),
    [&](rt::FieldReader& reader)
    {
      TriangleMaker maker(*this, reader, isovalues, purpose, surfaces);
      for (const vtkDSMVolumeData::OwnImage& own : this->Data->GetOwnImages())
      {
        maker.AddImage(own);
      }
      for (std::size_t number = 0; number < this->GetIso()->GetLevels().size(); ++number)
      {
        maker.AddLevels(number);
      }
    });
}
