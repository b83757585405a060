// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_RecordReader_h
#define bricks_RecordReader_h

#include "DSMBricks/accel/BoundingBox.h"
#include "DSMBricks/base/MortonCode.h"
#include "DSMBricks/base/ValueRange.h"
#include "DSMBricks/layout/BrickSpace.h"
#include "DSMBricks/sorted/PositionBounds.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace bricks
{

/// A brick of primitives, as it is made.
struct RecordBrick
{
  BoundingBox Bounds; ///< in the space of bricks; not empty
  ValueRange Range =
    ValueRange::GetEmpty(); ///< of the values in which rays look for something, if there are any
  std::vector<std::byte> Bytes;
  std::vector<std::uint32_t> Notes; ///< what its owner has to know of it, beside its bytes
};

/// Makes bricks out of the records of a cell (SortedCells). One for each thread; may keep its storage.
class RecordBrickBuilder
{
public:
  virtual ~RecordBrickBuilder() = default;

  /// Returns one brick for most cells; several, in order, for a cell with too many primitives, which happens where
  /// more than a brickful are at one place. The bytes depend on the set of records only, not on their order.
  virtual std::vector<RecordBrick> Build(const std::uint32_t* records, std::size_t count) = 0;
};

/// Facts about a kind of primitives.
struct RecordKind
{
  const char* Dataset;        ///< a noun for all primitives together, for messages
  const char* Primitives;     ///< a plural noun
  std::size_t RecordBytes;    ///< of each; a multiple of 4
  double BrickBytes;          ///< that each takes in a brick, approximately
  std::uint32_t LargestCount; ///< of a brick's primitives
};

/// One rank's primitives, numbered from 0, as SortedBrickBuilder sorts them in space and sends them to the ranks that
/// put them in bricks: each has a place, and a record. Several threads call at the same time. It is all that a kind of
/// primitives brings, beside its bricks.
class RecordReader
{
public:
  virtual ~RecordReader() = default;

  /// The same on every rank.
  virtual RecordKind GetKind() const = 0;
  virtual std::uint64_t GetCount() const = 0;

  /// The bounds of all that is to lie in the space of bricks: of the primitives that are finite, and of what else there
  /// is, in the dataset's space. `threads`: the calling one included.
  virtual PositionBounds FindBounds(int threads) const = 0;

  /// Sets the space of bricks, in which all below is. Called once, by one thread; `threads`: of this rank, while it
  /// runs.
  virtual void SetSpace(const BrickSpace& space, int threads) = 0;

  /// A primitive that no ray can hit has this code.
  static constexpr std::uint64_t NoCode = ~std::uint64_t(0);
  /// Writes the codes of the places of primitives [begin, end) in an order of space.
  virtual void FindCodes(std::uint64_t begin, std::uint64_t end, const MortonCode& order,
    std::uint64_t* codes) const = 0;

  /// Writes the records of primitives that have a code, one after the other, in their order. A record is a function of
  /// the primitive alone, not of the rank or the order in which it came.
  virtual void ReadRecords(
    const std::uint64_t* primitives, std::size_t count, std::uint32_t* records) const = 0;

  /// `largestCount`: of a brick's primitives.
  virtual std::unique_ptr<RecordBrickBuilder> CreateBuilder(
    const MortonCode& order, std::uint32_t largestCount) const = 0;
};

} // namespace bricks

#endif
