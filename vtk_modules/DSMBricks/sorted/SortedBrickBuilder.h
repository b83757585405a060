// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_SortedBrickBuilder_h
#define bricks_SortedBrickBuilder_h

#include "DSMBricks/accel/BoundingBox.h"
#include "DSMBricks/accel/BrickHierarchy.h"
#include "DSMBricks/base/MortonCode.h"
#include "DSMBricks/base/ValueRange.h"
#include "DSMBricks/layout/BrickSpace.h"
#include "DSMBricks/sorted/RecordExchange.h"
#include "DSMBricks/sorted/RecordReader.h"
#include "DSMBricks/sorted/SortedCells.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/publish/BlockDirectory.h"
#include "DSMCore/publish/BlockSegment.h"
#include "DSMCore/publish/Publication.h"
#include "DSMCore/transport/Messenger.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace bricks
{

struct SortedBrickSettings
{
  /// Average size of a brick in bytes, approximately.
  std::uint32_t BrickBytes = std::uint32_t(32) << 10;
  /// Threads on this rank that sort and build, the calling one included.
  int Threads = 1;
  /// Memory limit in bytes on this rank while bricks are built; 0: this rank's part of the host's
  /// memory.
  std::uint64_t MemoryBytes = 0;
};

/// Bricks of all ranks, by their numbers: their owners are the ranks in turn.
struct SortedBricks
{
  std::vector<BoundingBox> Boxes;
  std::vector<ValueRange> Ranges;
  std::vector<std::uint32_t> Bytes;
  std::vector<dsm::Fragment> Own;                ///< this rank's
  std::vector<std::vector<std::uint32_t>> Notes; ///< of these: RecordBrick::Notes
};

/// The steps from the primitives of all ranks, of any kind, to bricks and the hierarchy over them. All are collective
/// and throw the same dsm::Error on every rank. The results are bit for bit the same however the primitives were
/// distributed over ranks, in whatever order they were.
class SortedBrickBuilder
{
public:
  /// Finds the space of the bricks, and sorts the primitives. `what` and `reader` must live as long as the builder.
  /// `progress`, which may be empty here and below, receives up to 0.2; what it throws ends the work on all ranks.
  SortedBrickBuilder(std::string_view what, RecordReader& reader,
    const SortedBrickSettings& settings, dsm::Messenger& messenger,
    dsm::FunctionRef<void(double)> progress = {});

  const BrickSpace& GetSpace() const { return this->Space; }
  /// Primitives of all ranks, and how many of them rays can hit.
  std::uint64_t GetGivenCount() const { return this->GivenCount; }
  std::uint64_t GetCount() const { return this->Count; }

  /// Builds the bricks, each on the rank that owns its cell, and the hierarchy over the bricks of all, and publishes
  /// the bricks. Once. `progress` receives 0.2 to 1.
  template <class Store, bool HasRanges>
  std::shared_ptr<dsm::BlockSegment> Publish(
    Store& store, BrickHierarchy<HasRanges>& hierarchy, dsm::FunctionRef<void(double)> progress)
  {
    SortedBricks bricks = this->Build(progress);
    this->Messages.RunTogether(
      this->What, [&] { hierarchy = BrickHierarchy<HasRanges>(bricks.Boxes, bricks.Ranges); });
    BlockSource source(std::move(bricks.Own));
    BlockSink sink;
    const auto ofCopying = [&](double done) { progress(0.9 + 0.1 * done); };
    return store.Publish(this->What,
      { std::move(bricks.Bytes), dsm::RoundRobinAssigner(this->Messages.GetSize()),
        hierarchy.GetBytes() },
      source, sink,
      progress ? dsm::FunctionRef<void(double)>(ofCopying) : dsm::FunctionRef<void(double)>());
  }

  /// Builds the bricks, each on the rank that owns its cell. Once. `progress` receives 0.2 to 0.9.
  SortedBricks Build(dsm::FunctionRef<void(double)> progress);

private:
  /// In order of the own cells.
  using BricksOfCells = std::vector<std::vector<RecordBrick>>;

  void CheckMemory();
  void FindSpace();
  void SetSpace(const glm::dvec3& lower, const glm::dvec3& upper);
  std::unique_ptr<dsm::FragmentSource> CreateRecordSource() const;
  BricksOfCells BuildOwnBricks(
    const ArrivedRecords& arrived, dsm::FunctionRef<void(double)> progress) const;
  SortedBricks GatherBricks(BricksOfCells bricksOfCells);

  std::string_view What;
  RecordReader& Reader;
  RecordKind Kind;
  SortedBrickSettings Settings;
  dsm::Messenger& Messages;
  std::uint64_t GivenCount = 0;
  std::uint64_t Count = 0;
  BrickSpace Space;
  MortonCode Order;
  std::uint32_t LargestCount = 0;
  std::optional<SortedCells> Cells;
};

} // namespace bricks

#endif
