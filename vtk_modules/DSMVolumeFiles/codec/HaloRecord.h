// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HaloRecord_h
#define vol_HaloRecord_h

#include "DSMVolumeFiles/base/ByteBuffer.h"

#include <cstddef>
#include <cstdint>

namespace vol
{

/// The halo of a chunk that is not compressed, and so has no place for it (ChunkCodec::KeepsHalo): a piece of the file
/// behind the chunk, which a reader that expects it there takes along, and can tell from anything else (docs/files.md).
/// Records of all chunks of an array are equally long.
namespace HaloRecord
{

/// Returns the size in bytes of a record whose halo has at most `haloBytes` bytes.
std::size_t GetBytes(std::size_t haloBytes);
/// `number`: which chunk of its array; `bytes`: GetBytes of the largest halo.
ByteBuffer Make(std::int64_t number, const ByteBuffer& halo, std::size_t bytes);
/// Fills the halo, whose size is known, from the record of this chunk. False, and `halo` is as it was, when these bytes
/// are anything else.
bool Take(const std::byte* record, std::size_t bytes, std::int64_t number, ByteBuffer& halo);

} // namespace HaloRecord

} // namespace vol

#endif
