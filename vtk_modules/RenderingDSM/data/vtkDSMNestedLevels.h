// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMNestedLevels_h
#define vtkDSMNestedLevels_h

#include "DSMBricks/base/ValueRange.h"
#include "DSMBricks/layout/BrickLattice.h"
#include "DSMCore/fetch/BlockReader.h"
#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/frame/FrameRequest.h"
#include "DSMRayTracing/frame/SampleWidth.h"
#include "vtkDSMFileVolume.h"
#include "vtkDSMNestedSource.h"

#include <glm/mat4x4.hpp>

#include <cstdint>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

/// The levels of a file, of which a picture shows each where its samples are about so many pixels wide as is asked for:
/// a box of each level, in the box of the next coarser one, whose bricks it takes the place of. Where levels meet,
/// values are continuous: see vtkDSMNestedSource. Level 0 is the finest.
class vtkDSMNestedLevels : public std::enable_shared_from_this<vtkDSMNestedLevels>
{
public:
  using Volumes = std::vector<std::shared_ptr<const vtkDSMFileVolume>>;
  /// One of each level, in cells of its lattice; empty: the picture shows none of the level.
  using Boxes = std::vector<bricks::Box>;

  /// Edge of the bricks, in cells.
  static constexpr int Edge = 32;
  /// The most bricks of a box: so many bricks' tables take tens of MiB on each rank.
  static constexpr std::int64_t MostBricks = std::int64_t(1) << 21;

  /// Null where the levels' samples are not whole numbers of the finest ones apart, or values may be missing, or are of
  /// cells. `volumes`: of all levels, the finest first. `lattice`: of the finest.
  static std::shared_ptr<vtkDSMNestedLevels> Create(
    Volumes volumes, const bricks::BrickLattice& lattice);

  /// Local. The boxes of a picture. `indexToWorld`: of the finest level's samples. `pixels`: 0: the finest level
  /// everywhere. Empty: one level does as well, of which all is published. `isCoarse`: whether a
  /// level's box has too many bricks, so that the picture is coarser than it should be.
  Boxes FindBoxes(const rt::FrameRequest& request, const glm::dmat4& indexToWorld, double pixels,
    bool& isCoarse) const;

  /// Local. The coarsest level, of the file's, whose samples are so many pixels wide, or less, where they are farthest
  /// away.
  int FindFarLevel(
    const rt::FrameRequest& request, const glm::dmat4& indexToWorld, double pixels) const;

  /// The bricks of a level's box, and where they are: from their points to the finest level's samples.
  bricks::BrickLattice GetLattice(const Boxes& boxes, int level) const;
  glm::dmat4 GetToFinest(const Boxes& boxes, int level) const;
  /// The cells of a level's box that finer levels have, in the indices of GetLattice; whole bricks.
  bricks::Box FindHole(const Boxes& boxes, int level) const;
  dsm::BlockDirectory CreateDirectory(
    const Boxes& boxes, int level, const bricks::BrickLattice& lattice, int ranks) const;
  std::shared_ptr<const dsm::BlockReader> CreateReader(
    const Boxes& boxes, int level, const bricks::BrickLattice& lattice) const;
  /// The ranges of the bricks: known of those that any rank read before the last Exchange, empty in the hole.
  std::vector<bricks::ValueRange> FindRanges(
    const Boxes& boxes, int level, const bricks::BrickLattice& lattice) const;
  /// Collective: ranks tell one another the ranges of the bricks that they have read.
  void ExchangeRanges(dsm::Messenger& messenger);

  const vtkDSMFileVolume& GetVolume(int level) const
  {
    return *this->Volume[static_cast<std::size_t>(level)];
  }
  /// Returns the number of a level in the file.
  int GetFileLevel(int level) const { return this->GetVolume(level).GetLevel(); }
  int GetCount() const { return static_cast<int>(this->Volume.size()); }

private:
  struct ReadRange
  {
    std::int64_t Level;
    std::uint64_t Brick;
    bricks::ValueRange Range;
  };
  class NotingReader;

  vtkDSMNestedLevels() = default;
  std::shared_ptr<const vtkDSMNestedSource> CreateSource(const Boxes& boxes, int level) const;
  const bricks::Index3& GetScale(int level) const
  {
    return this->Scales[static_cast<std::size_t>(level)];
  }
  /// Cells of the lattice of a level.
  bricks::Index3 GetCells(int level) const;
  bricks::Index3 GetRatio(int level) const
  {
    return this->GetScale(level + 1) / this->GetScale(level);
  }
  /// Returns whether a brick of a box has a face whose values are the coarser level's.
  bool ContinuesCoarser(const bricks::Box& box, int level, const bricks::Index3& brick) const;
  /// A number of a brick, of all bricks of the level.
  std::uint64_t GetNumber(const bricks::Box& box, int level, const bricks::Index3& brick) const;

  rt::SeenPart FindSeen(const rt::FrameRequest& request, const glm::dmat4& indexToWorld) const
  {
    return { request, indexToWorld,
      glm::dvec3(this->GetVolume(0).GetPoints() - bricks::Index3(1)) };
  }
  /// From this depth on, samples of a level are narrow enough.
  double GetDepth(const rt::SeenPart& seen, int level, double pixels) const;
  int FindLevel(const rt::SeenPart& seen, double depth, double pixels) const;

  Volumes Volume;
  std::vector<int> FileLevels;        ///< their numbers in the file, from the finest one on
  std::vector<bricks::Index3> Scales; ///< finest cells in one of a level
  bricks::ScalarType Type;            ///< of the bricks' samples
  bricks::ScalarType FileType;

  mutable std::mutex RangesLock;
  mutable std::vector<ReadRange> ReadRanges; ///< since the last Exchange
  std::vector<std::unordered_map<std::uint64_t, bricks::ValueRange>> Ranges; ///< by level
};

#endif
