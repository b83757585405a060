// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/base/ByteDigest.h"

#define XXH_INLINE_ALL // no library to link to
#include <xxhash.h>

namespace dsm
{

std::uint64_t HashBytes(const void* data, std::size_t bytes, std::uint64_t seed)
{
  return XXH3_64bits_withSeed(data, bytes, seed);
}

void ByteDigest::Add(const std::byte* bytes, std::size_t count)
{
  const XXH128_hash_t hash = XXH3_128bits_withSeed(bytes, count, this->State[0]);
  // The second half of what was before goes into both halves of the next.
  this->State = { hash.low64 ^ this->State[1], hash.high64 + this->State[1] };
}

} // namespace dsm
