// SPDX-License-Identifier: BSD-3-Clause
// Isosurfaces as triangles.
#include "vtkDSMSceneVolume.h"

#include "vtkDSMCellTriangles.h"
#include "vtkDSMScene.h"

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkGenericCell.h"
#include "vtkIdList.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <variant>

namespace
{

/// Points of a surface in so many cells of bricks that it meets, about.
constexpr vtkIdType CellsForPoint = 8;

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

  /// Adds the surfaces in this rank's cells of a part that has values.
  void AddPart(std::size_t part)
  {
    const vtkDSMVolumeData::Values& values = this->Volume.GetIso()->GetParts();
    const rt::AnyField field = values[part]->GetField(glm::dmat4(1.0));
    const bool isMirrored = glm::determinant(glm::dmat3(values[part]->GetIndexToData())) < 0.0;
    for (const auto& cells : this->Volume.Data->GetParts()[part]->FindOwnCells(
           *values[part], this->Volume.GetIso()->Choice))
    {
      if (!this->CheckCells(cells->GetDatasets()))
      {
        continue;
      }
      std::vector<unsigned int> blocks;
      for (vtkDataObject* const dataset : cells->GetDatasets())
      {
        blocks.push_back(this->FindBlock(dataset));
      }
      const vtkIdType points = cells->FindBricks(this->Isovalues) / CellsForPoint;
      vtkDSMCellTriangles triangles(cells->GetBounds(), points, isMirrored, !this->Blocks.empty());
      this->TakeColors(cells->GetColored(), triangles);
      cells->ForEach(this->Reader,
        [&](const vtkDSMOwnCells::Cell& cell)
        {
          triangles.Add(cell, blocks[cell.Dataset], this->Isovalues);
          this->CheckCount(triangles);
        });
      this->Finish(part, field, cells->GetColored() != nullptr, triangles);
    }
    for (const vtkDSMOwnGrid& grid :
      this->Volume.Data->GetParts()[part]->FindOwnGrids(this->Volume.GetIso()->Choice))
    {
      if (this->CheckCells({ grid.Data }))
      {
        this->AddGrid(part, field, grid);
      }
    }
  }

private:
  void AddGrid(std::size_t part, const rt::AnyField& field, const vtkDSMOwnGrid& grid)
  {
    vtkDSMCellTriangles triangles(grid.Data->GetBounds(),
      grid.Data->GetNumberOfPoints() / CellsForPoint, false, !this->Blocks.empty());
    this->TakeColors(grid.Data, triangles);
    const unsigned int block = this->FindBlock(grid.Data);
    vtkNew<vtkGenericCell> cell;
    vtkNew<vtkIdList> points;
    vtkNew<vtkDoubleArray> values;
    for (vtkIdType id = 0; id < grid.Data->GetNumberOfCells(); ++id)
    {
      if (grid.IsShown[static_cast<std::size_t>(id)] == 0)
      {
        continue;
      }
      grid.Data->GetCellPoints(id, points);
      values->SetNumberOfTuples(points->GetNumberOfIds());
      grid.Values->GetTuples(points, values);
      if (this->MeetsAny(values))
      {
        grid.Data->GetCell(id, cell);
        triangles.Add(cell, values, id, block, this->Isovalues);
        this->CheckCount(triangles);
      }
    }
    this->Finish(part, field, true, triangles);
  }

  /// Returns whether all values are finite, and a surface is among them.
  bool MeetsAny(vtkDoubleArray* values) const
  {
    const double* const begin = values->GetPointer(0);
    const double* const end = begin + values->GetNumberOfTuples();
    if (!std::all_of(begin, end, [](double value) { return std::isfinite(value); }))
    {
      return false;
    }
    const auto [least, greatest] = std::minmax_element(begin, end);
    return std::any_of(this->Isovalues.begin(), this->Isovalues.end(),
      [low = *least, high = *greatest](double isovalue)
      { return low < isovalue && isovalue <= high; });
  }

  /// `isColored`: the triangles have what colors them.
  void Finish(
    std::size_t part, const rt::AnyField& field, bool isColored, vtkDSMCellTriangles& triangles)
  {
    if (triangles.GetNumberOfTriangles() > 0)
    {
      vtkPolyData* const surface = triangles.Finish();
      this->Count += triangles.GetNumberOfTriangles();
      this->AddNormals(field, triangles.GetPlacesWithin(), surface);
      if (!isColored)
      {
        this->AddColors(part, triangles.GetPlacesWithin(), surface);
      }
      this->Surfaces->SetBlock(this->Surfaces->GetNumberOfBlocks(), surface);
    }
  }

  /// Returns the flat index of a dataset; 0 where there are no blocks.
  unsigned int FindBlock(vtkDataObject* dataset) const
  {
    const auto block = this->Blocks.find(dataset);
    return block != this->Blocks.end() ? block->second : 0;
  }

  /// Returns false for cells of which no selection can be extracted.
  bool CheckCells(const vtkDSMOwnCells::Datasets& datasets) const
  {
    for (vtkDataObject* const dataset : datasets)
    {
      if (this->Use == Purpose::Selection && !vtkDataSet::SafeDownCast(dataset))
      {
        return false;
      }
      // A selection is extracted with a table of all cells.
      const vtkIdType count = dataset->GetNumberOfElements(vtkDataObject::CELL);
      if (this->Use == Purpose::Selection && count > vtkDSMScene::MostCellsOfSelection)
      {
        throw dsm::Error("Selection is not available in a block of " + std::to_string(count) +
          " cells on one rank; the maximum is " +
          std::to_string(vtkDSMScene::MostCellsOfSelection) +
          ". Use more ranks or extract a subset.");
      }
    }
    return true;
  }

  void CheckCount(const vtkDSMCellTriangles& triangles) const
  {
    if (this->Count + triangles.GetNumberOfTriangles() > vtkDSMScene::MostTriangles)
    {
      throw dsm::Error("They have more than " + std::to_string(vtkDSMScene::MostTriangles) +
        " triangles on one rank. Use more ranks or extract a subset.");
    }
  }

  /// The array of a dataset, which may be null, that colors the surface.
  void TakeColors(vtkDataSet* dataset, vtkDSMCellTriangles& triangles) const
  {
    vtkDSMVolumeMapper* const mapper = this->Volume.Mapper;
    if (!dataset || this->Use != Purpose::Export || !mapper->GetScalarVisibility())
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

  void AddNormals(
    const rt::AnyField& any, const std::vector<glm::dvec3>& places, vtkPolyData* surface) const
  {
    if (this->Use != Purpose::Export)
    {
      return;
    }
    vtkNew<vtkFloatArray> normals;
    normals->SetName("Normals");
    normals->SetNumberOfComponents(3);
    for (const glm::dvec3& gradient : this->Reader.FindGradients(any, places))
    {
      const glm::dvec3 normal = std::visit([&](const auto& field)
        { return field.GetNormal(gradient, glm::dvec3(0.0, 0.0, -1.0)); },
        any);
      normals->InsertNextTuple(&normal.x);
    }
    surface->GetPointData()->SetNormals(normals);
  }

  /// The values that color the picture.
  void AddColors(
    std::size_t part, const std::vector<glm::dvec3>& places, vtkPolyData* surface) const
  {
    const auto color = this->Volume.GetColor();
    if (this->Use != Purpose::Export || !color || !color->HasAny() || !color->GetParts()[part])
    {
      return;
    }
    vtkNew<vtkDoubleArray> array;
    array->SetName(color->Choice.Name.c_str());
    for (const double value :
      this->Reader.FindValues(color->GetParts()[part]->GetField(glm::dmat4(1.0)), places))
    {
      array->InsertNextValue(value);
    }
    surface->GetPointData()->AddArray(array);
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
      for (std::size_t part = 0; part < this->GetIso()->GetParts().size(); ++part)
      {
        if (this->GetIso()->GetParts()[part])
        {
          maker.AddPart(part);
        }
      }
    });
}
