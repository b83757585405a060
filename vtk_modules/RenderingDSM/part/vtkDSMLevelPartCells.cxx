// SPDX-License-Identifier: BSD-3-Clause
// The leaves of AMR and hyper tree grids.
#include "vtkDSMLevelPart.h"

#include "vtkBoundingBox.h"
#include "vtkImageData.h"
#include "vtkStructuredData.h"

#include <algorithm>
#include <functional>
#include <utility>
#include <variant>

namespace
{

using bricks::Index3;

class LeafCells final : public vtkDSMOwnCells
{
public:
  using SourceMaker = std::function<std::unique_ptr<vtkDSMLevelSource>()>;

  LeafCells(const Datasets& datasets, const vtkBoundingBox& bounds, rt::LevelField field,
    SourceMaker makeSource)
    : vtkDSMOwnCells(datasets)
    , Field(std::move(field))
    , MakeSource(std::move(makeSource))
  {
    bounds.GetBounds(this->Bounds);
    this->Segment = this->Field.Voxels->Segment;
    this->Type = this->Field.Voxels->Lattice.GetScalarType();
    this->Edge = Index3(bricks::LevelLattice::Edge);
  }

protected:
  void AddBricks(const rt::IsovaluePredicate& mayHold) override
  {
    this->Source = this->MakeSource();
    this->Read = this->Source->GetCubes().size();
    for (std::size_t number = 0; number < this->Source->GetCubes().size(); ++number)
    {
      const bricks::LevelCube& cube = this->Source->GetCubes()[number];
      const Index3 first = bricks::LevelCubes::GetFirst(cube);
      const bricks::Box cells{ first, first + this->Edge };
      this->Field.Voxels->Lattice.ForEachTouching(cube.Level, cells, cube.Level,
        [&](dsm::BlockId id, const bricks::LevelBrick& brick)
        {
          if (!bricks::Intersect(brick.Cells, cells).IsEmpty() &&
            mayHold(this->Field.Voxels->Hierarchy.GetRange(id)))
          {
            this->Ids.push_back(id);
            this->Cubes.push_back(number);
          }
        });
    }
  }

  void Begin(std::size_t number, const Index3&) override
  {
    if (this->Cubes[number] != this->Read)
    {
      this->Read = this->Cubes[number];
      this->Cells = this->Source->ReadCells(this->Read);
    }
    const bricks::LevelLattice& lattice = this->Field.Voxels->Lattice;
    const bricks::LevelBrick& brick = lattice.GetBrick(this->Ids[number]);
    this->First = brick.Cells.Min;
    this->Scale = glm::dvec3(lattice.GetScales().Get(brick.Level));
  }

  bool Complete(const Index3& in, Cell& cell) const override
  {
    const Index3 at = (this->First + in) % this->Edge;
    const vtkDSMLevelSource::Cell& own =
      this->Cells[static_cast<std::size_t>(at.x + this->Edge.x * (at.y + this->Edge.y * at.z))];
    if (own.Piece < 0)
    {
      return false;
    }
    cell.Id = own.Id;
    cell.Dataset = static_cast<std::size_t>(own.Piece);
    auto* const image = vtkImageData::SafeDownCast(this->Sets[cell.Dataset]);
    glm::ivec3 structured(0);
    if (image)
    {
      vtkStructuredData::ComputeCellStructuredCoordsForExtent(
        cell.Id, image->GetExtent(), &structured.x);
    }
    ForEachCorner(
      [&](int corner, const Index3& more)
      {
        const glm::dvec3 index(this->First + in + more);
        cell.Places[corner] =
          glm::dvec3(this->Field.IndexToWorld * glm::dvec4(index / this->Scale, 1.0));
        glm::ivec3 point(structured + glm::ivec3(more));
        cell.Points[corner] =
          image ? vtkStructuredData::ComputePointIdForExtent(image->GetExtent(), &point.x) : -1;
      });
    return true;
  }

private:
  rt::LevelField Field; ///< in the space of the data
  SourceMaker MakeSource;
  std::unique_ptr<vtkDSMLevelSource> Source;
  std::vector<std::size_t> Cubes; ///< of the bricks
  std::size_t Read = 0;           ///< the cube that Cells are of
  std::vector<vtkDSMLevelSource::Cell> Cells;
  // Of the brick:
  Index3 First{ 0 };
  glm::dvec3 Scale{ 1.0 };
};

} // namespace

vtkDSMPart::OwnCells vtkDSMLevelPart::FindOwnCells(
  const vtkDSMPartValues& values, const Choice& choice) const
{
  vtkBoundingBox bounds;
  this->AddBounds(bounds);
  OwnCells all;
  all.push_back(std::make_unique<LeafCells>(this->Own, bounds,
    std::get<rt::LevelField>(values.GetField(glm::dmat4(1.0))),
    [this, ofPieces = this->Find(choice)] { return this->CreateSource(ofPieces); }));
  return all;
}
