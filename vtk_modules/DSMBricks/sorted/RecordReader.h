// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_RecordReader_h
#define bricks_RecordReader_h

#include "DSMBricks/base/MortonCode.h"

#include <cstddef>
#include <cstdint>

namespace bricks
{

/// One rank's primitives, numbered from 0, as they are sorted in space and sent to the ranks that put them in
/// bricks: each has a place, and a record of the same size. Several threads call at the same time.
class RecordReader
{
public:
  virtual ~RecordReader() = default;

  /// Returns a plural noun for the primitives, for messages.
  virtual const char* GetNames() const = 0;
  virtual std::uint64_t GetCount() const = 0;
  /// A multiple of 4.
  virtual std::size_t GetRecordBytes() const = 0;

  /// The code of the primitive's place in an order of space. False for a primitive that no ray can hit.
  virtual bool FindCode(
    std::uint64_t primitive, const MortonCode& order, std::uint64_t& code) const = 0;

  /// Writes GetRecordBytes() of a primitive that has a code. A record is a function of the primitive alone, not of the
  /// rank or the order in which it came.
  virtual void ReadRecord(std::uint64_t primitive, std::uint32_t* record) const = 0;
};

} // namespace bricks

#endif
