// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_VoxelBrickBuilder_h
#define bricks_VoxelBrickBuilder_h

#include "DSMBricks/build/VoxelSource.h"
#include "DSMBricks/layout/BrickLattice.h"
#include "DSMCore/publish/Publication.h"

#include <memory>
#include <vector>

namespace bricks
{

/// Cuts this rank's pieces into fragments, one for each (piece, brick) that share a cell. Cells
/// outside of the lattice are left out.
class VoxelFragmentSource final : public dsm::FragmentSource
{
public:
  /// Throws dsm::Error when a piece has a cell mask and the lattice has none.
  VoxelFragmentSource(
    const BrickLattice& lattice, std::vector<std::shared_ptr<const VoxelSource>> pieces);
  /// Restricts the fragments to the bricks for which `bricks` is true. Call before the first fragment;
  /// `bricks` must outlive the builder.
  void Restrict(const std::vector<bool>& bricks) { this->Only = &bricks; }
  bool Next(dsm::Fragment& fragment) override;
  double GetProgress() const override;

private:
  /// Cells of the current piece that are in the lattice.
  Box GetPieceCells() const;
  /// Starts with the first brick of the current piece, or of the first one after it that has any.
  void BeginPiece();
  void AdvanceBrick();
  void Fill(const Box& cells, const Index3& brickOrigin, dsm::Fragment& fragment) const;

  BrickLattice Lattice;
  std::vector<std::shared_ptr<const VoxelSource>> Pieces;
  const std::vector<bool>* Only = nullptr; ///< null: all
  std::size_t Piece = 0;
  /// The bricks that the piece touches, and the next one of them.
  Box Bricks;
  Index3 Brick{ 0 };
  std::int64_t CellsDone = 0;
  std::int64_t CellsTotal = 0;
};

/// Assembles voxel bricks out of fragments, then computes their macrocells. A brick's bytes do not
/// depend on how the volume was cut into pieces, nor on the order of the fragments.
class VoxelBrickSink final : public dsm::FragmentSink
{
public:
  explicit VoxelBrickSink(const BrickLattice& lattice);
  void Begin(dsm::BlockId id, std::byte* block, std::size_t bytes) override;
  void Absorb(dsm::BlockId id, std::byte* block, std::size_t bytes, const std::byte* fragment,
    std::size_t fragmentBytes) override;
  void Finish(dsm::BlockId id, std::byte* block, std::size_t bytes) override;

private:
  BrickLattice Lattice;
};

} // namespace bricks

#endif
