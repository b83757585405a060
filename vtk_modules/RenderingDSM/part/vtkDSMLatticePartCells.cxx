// SPDX-License-Identifier: BSD-3-Clause
// The cells of images.
#include "vtkDSMLatticePart.h"

#include "vtkDSMImagePiece.h"

#include "vtkDataSet.h"
#include "vtkStructuredData.h"

#include <utility>
#include <variant>

namespace
{

using bricks::Box;
using bricks::Index3;

class ImageCells final : public vtkDSMOwnCells
{
public:
  ImageCells(vtkDataSet* image, const bricks::LatticePlan::Member& member, rt::LatticeField field)
    : vtkDSMOwnCells({ image })
    , Image(image)
    , Shift(member.IndexToLattice)
    , Own(member.Cells)
    , Field(std::move(field))
  {
    image->GetBounds(this->Bounds);
    vtkDSMImagePiece::GetExtent(image, this->Extent);
    const bricks::VoxelField& voxels = *this->Field.Voxels;
    this->Segment = voxels.Segment;
    this->Type = voxels.Lattice.GetScalarType();
    this->Edge = Index3(voxels.Lattice.GetEdge());
  }

  vtkDataSet* GetColored() const override { return this->Image; }

protected:
  void AddBricks(const rt::IsovaluePredicate& mayHold) override
  {
    const bricks::VoxelField& voxels = *this->Field.Voxels;
    const auto& ranges = voxels.Hierarchy.GetLevels().front().Ranges;
    bricks::ForEachIndex(
      { this->Own.Min / this->Edge, (this->Own.Max + this->Edge - Index3(1)) / this->Edge },
      [&](const Index3& brick)
      {
        const dsm::BlockId id = voxels.Lattice.GetId(brick);
        if (mayHold(ranges[static_cast<std::size_t>(id)]))
        {
          this->Ids.push_back(id);
        }
      });
  }

  void Begin(std::size_t number, const Index3& cells) override
  {
    this->First = this->Field.Voxels->Lattice.GetCellsOfBrick(this->Ids[number]).Min - this->Shift;
    this->Some = bricks::Intersect({ this->First, this->First + cells },
      { this->Own.Min - this->Shift, this->Own.Max - this->Shift });
    this->Shown = vtkDSMImagePiece::FindShown(this->Image, this->Some);
  }

  bool Complete(const Index3& in, Cell& cell) const override
  {
    const Index3 own = this->First + in;
    const Index3 at = own - this->Some.Min;
    const Index3 size = this->Some.GetSize();
    if (bricks::Intersect({ own, own + Index3(1) }, this->Some).IsEmpty() ||
      this->Shown[static_cast<std::size_t>(at.x + size.x * (at.y + size.y * at.z))] == 0)
    {
      return false;
    }
    const auto* const planes = this->Field.Voxels->Planes.get();
    ForEachCorner(
      [&](int corner, const Index3& more)
      {
        const glm::dvec3 index(own + more + this->Shift);
        cell.Places[corner] = glm::dvec3(
          this->Field.IndexToWorld * glm::dvec4(planes ? planes->ToPlace(index) : index, 1.0));
        glm::ivec3 point(own + more);
        cell.Points[corner] = vtkStructuredData::ComputePointIdForExtent(this->Extent, &point.x);
      });
    glm::ivec3 structured(own);
    cell.Id = vtkStructuredData::ComputeCellIdForExtent(this->Extent, &structured.x);
    cell.Dataset = 0;
    return true;
  }

private:
  vtkDataSet* Image;
  Index3 Shift;           ///< from the image's own indices to the lattice's
  Box Own;                ///< the image's cells, in lattice indices
  rt::LatticeField Field; ///< in the space of the data
  int Extent[6];
  // Of the brick, in the image's own indices:
  Index3 First{ 0 };
  Box Some; ///< its cells that are the image's
  std::vector<std::uint8_t> Shown;
};

} // namespace

vtkDSMPart::OwnCells vtkDSMLatticePart::FindOwnCells(
  const vtkDSMPartValues& values, const Choice&) const
{
  OwnCells all;
  for (const bricks::LatticePlan::Member& member : this->Lattice.Members)
  {
    if (vtkDataSet* const image = this->FindOwn(member))
    {
      all.push_back(std::make_unique<ImageCells>(
        image, member, std::get<rt::LatticeField>(values.GetField(glm::dmat4(1.0)))));
    }
  }
  return all;
}
