// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/build/VoxelBrickBuilder.h"

#include "DSMBricks/build/VoxelFragment.h"
#include "DSMBricks/layout/MacrocellBuilder.h"
#include "DSMCore/base/Error.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace bricks
{

namespace
{

/// Calls `function(y, z)` for the rows of a box.
template <class Function>
void ForEachRow(const Box& box, Function&& function)
{
  for (std::int64_t z = box.Min.z; z < box.Max.z; ++z)
  {
    for (std::int64_t y = box.Min.y; y < box.Max.y; ++y)
    {
      function(y, z);
    }
  }
}

VoxelFragmentHeader CreateFragmentHeader(const Box& cells, bool hasMask, bool ofCells)
{
  VoxelFragmentHeader header{};
  for (int axis = 0; axis < 3; ++axis)
  {
    header.Min[axis] = static_cast<std::int32_t>(cells.Min[axis]);
    header.Max[axis] = static_cast<std::int32_t>(cells.Max[axis]);
  }
  header.HasMask = hasMask ? 1 : 0;
  header.OfCells = ofCells ? 1 : 0;
  return header;
}

/// Reads the header of a fragment and checks that its box lies in the brick and that nothing is
/// missing or left over.
VoxelFragmentHeader DecodeFragmentHeader(const VoxelBrickHeader& brick, dsm::BlockId id,
  const std::byte* fragment, std::size_t fragmentBytes)
{
  VoxelFragmentHeader header{};
  bool fits = fragmentBytes >= sizeof(header);
  if (fits)
  {
    std::memcpy(&header, fragment, sizeof(header));
    for (int axis = 0; axis < 3; ++axis)
    {
      fits = fits && header.Min[axis] >= 0 && header.Min[axis] < header.Max[axis] &&
        header.Max[axis] <= brick.Cells[axis];
    }
  }
  if (!fits ||
    fragmentBytes != sizeof(header) + header.GetSampleBytes(brick.Type) + header.GetMaskBytes())
  {
    throw dsm::Error("A fragment of " + std::to_string(fragmentBytes) +
      " bytes does not fit voxel brick " + std::to_string(id) +
      ". Do all ranks run the same build and agree on the dataset's extent and scalar type?");
  }
  return header;
}

void CopySamples(const VoxelBrickHeader& brick, const VoxelFragmentHeader& fragment,
  const std::byte* samples, std::byte* block)
{
  const std::size_t sampleBytes = bricks::GetBytes(brick.Type);
  const Box points = fragment.GetSamples();
  const std::size_t rowBytes = static_cast<std::size_t>(points.GetSize().x) * sampleBytes;
  const std::int64_t row = brick.Cells[0] + 1;
  const std::int64_t slice = row * (brick.Cells[1] + 1);
  std::byte* out = block + brick.SampleOffset;
  ForEachRow(points,
    [&](std::int64_t y, std::int64_t z)
    {
      std::memcpy(out + static_cast<std::size_t>(points.Min.x + y * row + z * slice) * sampleBytes,
        samples, rowBytes);
      samples += rowBytes;
    });
}

/// Sets the bits of the fragment's cells; `holdsData` may be null: all of them do.
void SetMaskBits(const VoxelBrickHeader& brick, const VoxelFragmentHeader& fragment,
  const std::byte* holdsData, std::byte* block)
{
  std::byte* mask = block + brick.MaskOffset;
  const Box cells = fragment.GetCells();
  ForEachRow(cells,
    [&](std::int64_t y, std::int64_t z)
    {
      const std::int64_t first = brick.Cells[0] * (y + brick.Cells[1] * z);
      for (std::int64_t x = cells.Min.x; x < cells.Max.x; ++x)
      {
        if (holdsData == nullptr || *holdsData++ != std::byte{ 0 })
        {
          const std::int64_t cell = first + x;
          mask[cell >> 3] |= std::byte{ 1 } << (cell & 7);
        }
      }
    });
}

} // namespace

VoxelFragmentSource::VoxelFragmentSource(
  const BrickLattice& lattice, std::vector<std::shared_ptr<const VoxelSource>> pieces)
  : Lattice(lattice)
  , Pieces(std::move(pieces))
{
  for (; this->Piece < this->Pieces.size(); ++this->Piece)
  {
    if (this->Pieces[this->Piece]->HasCellMask() && !lattice.HasCellMask())
    {
      throw dsm::Error("A piece of the volume has blanked cells, but its bricks have no cell mask. "
                       "All ranks must agree on blanking in advance.");
    }
    this->CellsTotal += this->GetPieceCells().GetCount();
  }
  this->Piece = 0;
  this->BeginPiece();
}

Box VoxelFragmentSource::GetPieceCells() const
{
  return Intersect(this->Pieces[this->Piece]->GetCells(), { Index3(0), this->Lattice.GetCells() });
}

void VoxelFragmentSource::BeginPiece()
{
  const Index3 edge(this->Lattice.GetEdge());
  for (; this->Piece < this->Pieces.size(); ++this->Piece)
  {
    const Box cells = this->GetPieceCells();
    if (!cells.IsEmpty())
    {
      this->Bricks = { cells.Min / edge, (cells.Max + edge - Index3(1)) / edge };
      this->Brick = this->Bricks.Min;
      return;
    }
  }
}

void VoxelFragmentSource::AdvanceBrick()
{
  for (int axis = 0; axis < 3; ++axis)
  {
    if (++this->Brick[axis] < this->Bricks.Max[axis])
    {
      return;
    }
    this->Brick[axis] = this->Bricks.Min[axis];
  }
  ++this->Piece;
  this->BeginPiece();
}

bool VoxelFragmentSource::Next(dsm::Fragment& fragment)
{
  while (this->Only && this->Piece < this->Pieces.size() &&
    !(*this->Only)[this->Lattice.GetId(this->Brick)])
  {
    this->AdvanceBrick();
  }
  if (this->Piece >= this->Pieces.size())
  {
    return false;
  }
  fragment.Block = this->Lattice.GetId(this->Brick);
  const Box brick = this->Lattice.GetCellsOfBrick(fragment.Block);
  const Box cells = Intersect(brick, this->GetPieceCells());
  this->Fill(cells, brick.Min, fragment);
  this->CellsDone += cells.GetCount();
  this->AdvanceBrick();
  return true;
}

void VoxelFragmentSource::Fill(
  const Box& cells, const Index3& brickOrigin, dsm::Fragment& fragment) const
{
  const VoxelSource& piece = *this->Pieces[this->Piece];
  const VoxelFragmentHeader header =
    CreateFragmentHeader({ cells.Min - brickOrigin, cells.Max - brickOrigin }, piece.HasCellMask(),
      this->Lattice.IsOfCells());
  const std::size_t sampleBytes = header.GetSampleBytes(this->Lattice.GetScalarType());
  fragment.Bytes.resize(sizeof(header) + sampleBytes + header.GetMaskBytes());
  std::byte* bytes = fragment.Bytes.data();
  std::memcpy(bytes, &header, sizeof(header));
  const Box samples = header.GetSamples();
  piece.ReadSamples(
    { samples.Min + brickOrigin, samples.Max + brickOrigin }, bytes + sizeof(header));
  if (header.HasMask != 0)
  {
    piece.ReadCellMask(
      cells, reinterpret_cast<std::uint8_t*>(bytes + sizeof(header) + sampleBytes));
  }
}

double VoxelFragmentSource::GetProgress() const
{
  return this->CellsTotal > 0
    ? static_cast<double>(this->CellsDone) / static_cast<double>(this->CellsTotal)
    : 1.0;
}

VoxelBrickSink::VoxelBrickSink(const BrickLattice& lattice)
  : Lattice(lattice)
{
}

void VoxelBrickSink::Begin(dsm::BlockId id, std::byte* block, std::size_t bytes)
{
  const VoxelBrickHeader header =
    CreateVoxelBrickHeader(this->Lattice.GetCellsOfBrick(id).GetSize(),
      this->Lattice.GetScalarType(), this->Lattice.HasCellMask());
  if (bytes < header.BlockBytes)
  {
    throw dsm::Error("Voxel brick " + std::to_string(id) + " needs " +
      std::to_string(header.BlockBytes) + " bytes, but its block has " + std::to_string(bytes) +
      ". Publish with the directory of the lattice.");
  }
  std::memcpy(block, &header, sizeof(header));
}

void VoxelBrickSink::Absorb(dsm::BlockId id, std::byte* block, std::size_t,
  const std::byte* fragment, std::size_t fragmentBytes)
{
  VoxelBrickHeader brick;
  std::memcpy(&brick, block, sizeof(brick));
  const VoxelFragmentHeader header = DecodeFragmentHeader(brick, id, fragment, fragmentBytes);
  const std::byte* samples = fragment + sizeof(header);
  CopySamples(brick, header, samples, block);
  if (brick.MaskOffset != 0)
  {
    SetMaskBits(brick, header,
      header.HasMask != 0 ? samples + header.GetSampleBytes(brick.Type) : nullptr, block);
  }
}

void VoxelBrickSink::Finish(dsm::BlockId, std::byte* block, std::size_t)
{
  // Cells have no values between one another that anything could be skipped by.
  if (!this->Lattice.IsOfCells())
  {
    Dispatch(this->Lattice.GetScalarType(),
      [&](auto sample) { BuildMacrocells<decltype(sample)>(block); });
  }
}

} // namespace bricks
