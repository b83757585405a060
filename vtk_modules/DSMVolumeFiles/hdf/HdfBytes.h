// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfBytes_h
#define vol_HdfBytes_h

#include "DSMVolumeFiles/base/PositionedFile.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace vol
{

/// An address that leads nowhere.
constexpr std::uint64_t HdfUndefined = UINT64_MAX;

/// A piece of an HDF5 file's own structures ("HDF5 File Format Specification", version 3), with little-endian
/// numbers and addresses of 8 bytes. Before getting a number, the caller has to check with Has that the piece
/// contains it.
class HdfBytes
{
public:
  static constexpr std::size_t Address = 8;  ///< bytes of one
  static constexpr std::size_t Checksum = 4; ///< likewise

  HdfBytes() = default;
  explicit HdfBytes(std::vector<std::byte> values)
    : Values(std::move(values))
  {
  }

  /// Returns nothing where the file ends before, or where no structure is as large as `count`.
  static std::optional<HdfBytes> Read(
    const PositionedFile& file, std::uint64_t offset, std::uint64_t count);

  /// Likewise, for a structure that begins with a signature of four letters and a version, and ends with a
  /// checksum. Also returns nothing if one of them is wrong.
  static std::optional<HdfBytes> ReadChecked(const PositionedFile& file, std::uint64_t offset,
    std::uint64_t count, const char* signature, std::uint64_t version = 0);

  std::size_t GetCount() const { return this->Values.size(); }
  bool Has(std::size_t place, std::size_t count) const
  {
    return place <= this->Values.size() && count <= this->Values.size() - place;
  }
  /// The number of `count` bytes, at most 8, at a place that the piece has.
  std::uint64_t Get(std::size_t place, std::size_t count) const
  {
    std::uint64_t number = 0;
    for (std::size_t byte = count; byte > 0; --byte)
    {
      number = number << 8 | static_cast<std::uint64_t>(this->Values[place + byte - 1]);
    }
    return number;
  }
  /// Bits are counted from the highest one of the first byte.
  bool GetBit(std::size_t place, std::size_t bit) const
  {
    return (this->Get(place + bit / 8, 1) >> (7 - bit % 8) & 1) != 0;
  }
  bool Begins(const char* signature) const;
  /// Returns whether the last 4 bytes are the checksum of the bytes before.
  bool HasRightChecksum() const;

private:
  std::vector<std::byte> Values;
};

} // namespace vol

#endif
