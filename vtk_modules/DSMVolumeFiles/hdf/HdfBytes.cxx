// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/hdf/HdfBytes.h"

#include "DSMVolumeFiles/codec/Checksums.h"

#include <cstring>

namespace vol
{

namespace
{

/// No object header, node or block of an index is as large.
constexpr std::uint64_t LargestPart = std::uint64_t(1) << 26;

} // namespace

std::optional<HdfBytes> HdfBytes::Read(
  const PositionedFile& file, std::uint64_t offset, std::uint64_t count)
{
  if (count > LargestPart || offset > file.GetBytes() || count > file.GetBytes() - offset)
  {
    return std::nullopt;
  }
  HdfBytes bytes;
  bytes.Values.resize(count);
  file.Read(offset, bytes.Values.data(), bytes.Values.size());
  return bytes;
}

std::optional<HdfBytes> HdfBytes::ReadChecked(const PositionedFile& file, std::uint64_t offset,
  std::uint64_t count, const char* signature, std::uint64_t version)
{
  std::optional<HdfBytes> bytes = Read(file, offset, count);
  return bytes && bytes->Has(0, 5 + Checksum) && bytes->Begins(signature) &&
      bytes->Get(4, 1) == version && bytes->HasRightChecksum()
    ? std::move(bytes)
    : std::nullopt;
}

bool HdfBytes::Begins(const char* signature) const
{
  return this->Has(0, 4) && std::memcmp(this->Values.data(), signature, 4) == 0;
}

bool HdfBytes::HasRightChecksum() const
{
  if (!this->Has(0, Checksum))
  {
    return false;
  }
  const std::size_t before = this->Values.size() - Checksum;
  return GetLookup3(this->Values.data(), before) == this->Get(before, Checksum);
}

} // namespace vol
