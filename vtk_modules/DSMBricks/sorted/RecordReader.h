// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_RecordReader_h
#define bricks_RecordReader_h

#include "DSMBricks/accel/BoundingBox.h"
#include "DSMBricks/base/MortonCode.h"
#include "DSMBricks/base/ValueRange.h"
#include "DSMBricks/layout/BrickSpace.h"

#include <glm/vec3.hpp>

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

  /// Bounds of what else lies in the space of bricks; lower > upper: nothing does.
  virtual void FindOtherBounds(glm::dvec3& lower, glm::dvec3& upper) const
  {
    lower = glm::dvec3(1.0);
    upper = glm::dvec3(-1.0);
  }

  /// The bounds of a primitive in the dataset's space. False if they are not finite.
  virtual bool FindBounds(std::uint64_t primitive, glm::dvec3& lower, glm::dvec3& upper) const = 0;

  /// Sets the space of bricks, in which all below is. Called once, by one thread.
  virtual void SetSpace(const BrickSpace& space) = 0;

  /// The code of the primitive's place in an order of space. False for a primitive that no ray can hit.
  virtual bool FindCode(
    std::uint64_t primitive, const MortonCode& order, std::uint64_t& code) const = 0;

  /// Writes the record of a primitive that has a code. A record is a function of the primitive alone, not of the
  /// rank or the order in which it came.
  virtual void ReadRecord(std::uint64_t primitive, std::uint32_t* record) const = 0;

  /// `largestCount`: of a brick's primitives.
  virtual std::unique_ptr<RecordBrickBuilder> CreateBuilder(
    const MortonCode& order, std::uint32_t largestCount) const = 0;
};

} // namespace bricks

#endif
