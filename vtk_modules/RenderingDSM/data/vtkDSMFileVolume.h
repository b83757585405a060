// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMFileVolume_h
#define vtkDSMFileVolume_h

#include "DSMBricks/base/ValidValues.h"
#include "DSMBricks/build/LatticePlan.h"
#include "DSMBricks/build/VoxelBrickReader.h"
#include "DSMBricks/build/VoxelIndex.h"
#include "DSMBricks/build/VoxelSource.h"
#include "DSMBricks/layout/BrickLattice.h"
#include "DSMVolumeFiles/cache/ChunkCache.h"
#include "DSMVolumeFiles/cache/FileBrickReader.h"
#include "DSMVolumeFiles/range/KeptFile.h"
#include "vtkDSMFileValues.h"

#include <glm/mat4x4.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

class vtkAbstractArray;
class vtkDataSet;

/// A lattice whose samples are all in one file, so that any rank can cut any of its bricks at any time: values of
/// points, or of cells, of which bricks have the means at points. Functions that are collective are for all ranks;
/// their failures are dsm::Error, the same on every rank.
class vtkDSMFileVolume
{
public:
  /// Digests of all bricks, by id.
  using Digests = std::vector<dsm::ByteDigest>;

  /// Data about an image's values that the other ranks need; plain, for messages.
  struct Seat
  {
    std::int32_t InFile; ///< else nothing else counts
    std::int32_t Step;
    std::int32_t NextStep; ///< see vtkDSMFileValues
    std::int64_t Array;
    std::uint64_t Stamp;
    std::int64_t ToFile[3]; ///< add to the image's own index
  };

  /// Local. `array`, of the image's points or cells, may be null.
  static Seat Describe(vtkDataSet* image, vtkAbstractArray* array, bool onCells);

  /// Collective. Null, on all ranks, where the members' values are not all of one array of one file, or a rank
  /// cannot open it. `seats`: of all pieces of all ranks; `own`: the values of this rank's first member, or null;
  /// `isFirst`: it is the lattice's first member, and the others open the file by its name. `onCells`: the values are
  /// those of cells, of which none is missing. `valid`: see vtkDSMImageArrays::Info.
  static std::unique_ptr<vtkDSMFileVolume> Find(dsm::Messenger& messenger,
    const bricks::LatticePlan::Lattice& lattice, const std::vector<Seat>& seats,
    const vtkDSMFileValues* own, bool isFirst, int component, bool onCells,
    const bricks::ValidValues& valid);

  /// Levels of detail that the file has below the one that was opened; 0 where the lattice is but a part of the
  /// file's samples.
  int CountCoarser() const;
  /// Collective. The first coarser level is 1. Null, on all ranks, where a rank cannot open it, or it has no such
  /// array, or does not fill the same place.
  std::unique_ptr<vtkDSMFileVolume> FindCoarser(dsm::Messenger& messenger, int level) const;
  /// Returns the bytes that the cache of chunks needs for one brick.
  std::uint64_t CountChunkBytesOfBrick(const bricks::BrickLattice& lattice) const
  {
    return vol::ChunkCache::CountBytesTogether(
      this->Values->GetArray(), lattice.GetEdge() + (this->OnCells ? 2 : 1));
  }
  /// Returns the bytes of all samples of the file's array.
  std::uint64_t CountBytes() const
  {
    const vol::FileArray& array = this->Values->GetArray();
    return static_cast<std::uint64_t>(
             bricks::Box{ bricks::Index3(0), array.Grid.Samples }.GetCount()) *
      array.GetSampleBytes();
  }
  /// Points along each axis.
  bricks::Index3 GetPoints() const
  {
    return this->Values->GetBox().GetSize() + bricks::Index3(this->OnCells ? 1 : 0);
  }
  /// From indices of another level's samples to those of this one's.
  glm::dmat4 GetIndexOf(const vtkDSMFileVolume& other) const;

  const std::string& GetPath() const;
  /// Returns the memory in bytes that the file itself takes on each rank, without chunks.
  std::uint64_t GetTableBytes() const;

  /// Returns whether the file has several time steps, so that comparing the digests of their bricks
  /// is useful.
  bool HasSteps() const;

  /// Returns the bytes of the digests on a rank: those of a step, and of the next.
  static std::uint64_t CountDigestBytes(const bricks::BrickLattice& lattice)
  {
    return 2 * lattice.GetBrickCount() * sizeof(dsm::ByteDigest);
  }

  /// Returns the level of detail in the file; 0 is the finest.
  int GetLevel() const { return this->Values->GetOptions().Level; }
  /// Returns whether values of cells become those of points.
  bool IsOfCells() const { return this->OnCells; }
  /// Samples along each axis of one of the file's chunks.
  const bricks::Index3& GetChunk() const { return this->Values->GetArray().Grid.ChunkSamples; }
  /// Samples of points, as rays meet their bricks. `type`: the array's; of a magnitude Float32 or Float64.
  std::shared_ptr<const bricks::VoxelSource> CreateSamples(bricks::ScalarType type) const;
  /// Advises the system that samples in boxes will be read. Any thread; does not fail.
  void Prefetch(std::vector<bricks::Box> boxes) const { this->Values->Prefetch(std::move(boxes)); }

  /// Bricks of the lattice. `scattered`: they are read as rays meet them, not all in turn.
  std::shared_ptr<const vol::FileBrickReader> CreateReader(
    const bricks::BrickLattice& lattice, bool scattered) const;
  /// The same as rays meet them. Bricks that are read or kept are read ahead for the next time step, too, except
  /// those that have the same digests there; `digests` may be empty.
  std::shared_ptr<const dsm::BlockReader> CreateSteppingReader(
    const bricks::BrickLattice& lattice, std::shared_ptr<const Digests> digests) const;

  /// Creates the directory of these bricks. Bricks that are cut out of the same chunks have the
  /// same owner.
  dsm::BlockDirectory CreateDirectory(const bricks::BrickLattice& lattice, int ranks) const;

  /// Collective: kept since an earlier time, or found by reading once what the ranks' own values, `own`, have not
  /// seen of the bricks, and kept; none where that takes too long
  /// (vtkDSMFileValues::IsTooLargeToRead). `threads` of this rank read; `progress` as of vtkDSMVolumeData::Publish.
  std::optional<bricks::VoxelIndex> FindIndex(dsm::Messenger& messenger,
    const bricks::BrickLattice& lattice, const vtkDSMFileValues* own, int threads,
    const std::function<void(double)>& progress) const;

private:
  vtkDSMFileVolume(std::shared_ptr<const vtkDSMFileValues> values, int component, bool onCells,
    const bricks::ValidValues& valid);

  /// Collective. Null, on all ranks, where any has null.
  static std::unique_ptr<vtkDSMFileVolume> KeepIfEverywhere(
    dsm::Messenger& messenger, std::unique_ptr<vtkDSMFileVolume> volume);
  /// Collective: that the ranks opened the same file for the step.
  void CheckSameEverywhere(dsm::Messenger& messenger) const;
  /// Returns whether the volume has all of the array's samples.
  bool IsWhole() const;
  /// Local; null where there is no such level.
  std::unique_ptr<vtkDSMFileVolume> OpenCoarser(int level) const;
  /// From indices of samples to the world, by the file.
  glm::dmat4 GetIndexToWorld() const;

  /// Returns the index of the lattice's bricks from the file itself (vol::VolumeFile::Index), or an
  /// empty one.
  std::vector<std::byte> ReadIndex(const bricks::BrickLattice& lattice) const;
  vol::KeptFile GetKept(const bricks::BrickLattice& lattice) const;
  /// That, or what was kept since an earlier time, or empty.
  std::vector<std::byte> LoadIndex(const bricks::BrickLattice& lattice) const;
  /// Local: returns which bricks are not known to have these digests. That a step cannot be read does not count as
  /// a failure.
  std::vector<bool> FindChanges(const bricks::BrickLattice& lattice, const Digests& digests) const;
  /// Returns the key of the bricks that are read ahead for this step.
  std::uint64_t GetKey(const bricks::BrickLattice& lattice) const;

  /// Returns whether other values are missing than the file declares.
  bool HasOwnMissing() const { return !(this->Valid == this->Values->GetArray().Valid); }

  std::shared_ptr<const vtkDSMFileValues> Values; ///< values of the whole lattice
  int Component;                                  ///< vtkDSMImagePiece::Magnitude for the magnitude
  bool OnCells;
  bricks::ValidValues Valid; ///< see vtkDSMImageArrays::Info
};

#endif
