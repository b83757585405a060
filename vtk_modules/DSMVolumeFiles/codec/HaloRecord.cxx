// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/codec/HaloRecord.h"

#include "DSMVolumeFiles/codec/Checksums.h"

#include <algorithm>
#include <cstring>

namespace vol
{

namespace
{

struct Header
{
  std::uint64_t Magic;
  std::int64_t Number;
  std::uint64_t Bytes;
};

/// "DSM halo", read from the lowest byte on.
constexpr std::uint64_t Magic = 0x6f6c6168204d5344;

using Checksum = std::uint32_t;

} // namespace

std::size_t HaloRecord::GetBytes(std::size_t haloBytes)
{
  return sizeof(Header) + haloBytes + sizeof(Checksum);
}

ByteBuffer HaloRecord::Make(std::int64_t number, const ByteBuffer& halo, std::size_t bytes)
{
  const Header header{ Magic, number, halo.size() };
  ByteBuffer record(bytes, std::byte{ 0 });
  std::memcpy(record.data(), &header, sizeof(header));
  std::copy(halo.begin(), halo.end(), record.begin() + sizeof(header));
  const std::size_t before = bytes - sizeof(Checksum);
  const Checksum sum = GetFletcher32(record.data(), before);
  std::memcpy(record.data() + before, &sum, sizeof(sum));
  return record;
}

bool HaloRecord::Take(
  const std::byte* record, std::size_t bytes, std::int64_t number, ByteBuffer& halo)
{
  if (bytes < GetBytes(halo.size()))
  {
    return false;
  }
  Header header;
  std::memcpy(&header, record, sizeof(header));
  const std::size_t before = bytes - sizeof(Checksum);
  Checksum sum;
  std::memcpy(&sum, record + before, sizeof(sum));
  if (header.Magic != Magic || header.Number != number || header.Bytes != halo.size() ||
    sum != GetFletcher32(record, before))
  {
    return false;
  }
  std::copy_n(record + sizeof(header), halo.size(), halo.begin());
  return true;
}

} // namespace vol
