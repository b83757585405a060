// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_FileBrickReader_h
#define vol_FileBrickReader_h

#include "DSMBricks/build/VoxelBrickReader.h"
#include "DSMCore/fetch/BlockReader.h"

#include <atomic>
#include <functional>
#include <memory>
#include <vector>

namespace vol
{

/// Cuts bricks out of a volume file. Any thread.
class FileBrickReader final : public dsm::BlockReader
{
public:
  /// Advises the system that samples in boxes will be read. Any thread; throws nothing.
  using Prefetcher = std::function<void(std::vector<bricks::Box> boxes)>;

  /// `source` reads through vol::PositionedFile. Throws as bricks::VoxelBrickReader does.
  FileBrickReader(const bricks::BrickLattice& lattice,
    std::shared_ptr<const bricks::VoxelSource> source, Prefetcher prefetch);

  void Read(dsm::BlockId id, std::byte* block, std::size_t bytes) const override;
  bool ReadWithoutWaiting(dsm::BlockId id, std::byte* block, std::size_t bytes) const override;

  /// As bricks::VoxelBrickReader.
  bool IsFiller(dsm::BlockId id) const { return this->Bricks.IsFiller(id); }

  bool MayPrefetch() const override { return this->CanTell; }
  void Prefetch(const std::vector<dsm::BlockId>& ids) const override;

private:
  bricks::BrickLattice Lattice;
  bricks::VoxelBrickReader Bricks;
  Prefetcher PrefetchBoxes;
  mutable std::atomic<bool> CanTell{ true }; ///< the file system, what is in memory
};

} // namespace vol

#endif
