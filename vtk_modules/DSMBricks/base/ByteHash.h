// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_ByteHash_h
#define bricks_ByteHash_h

#include "DSMCore/base/ByteDigest.h"

#include <cstddef>
#include <cstdint>

namespace bricks
{

/// A hash of 64 bits (dsm::HashBytes): equal, for all practical purposes, only for equal bytes that were added in equal
/// parts.
class ByteHash
{
public:
  void Add(const void* data, std::size_t bytes)
  {
    this->Value = dsm::HashBytes(data, bytes, this->Value);
  }

  std::uint64_t Get() const { return this->Value; }

private:
  std::uint64_t Value = 0;
};

} // namespace bricks

#endif
