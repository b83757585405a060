// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_PackedPlaces_h
#define bricks_PackedPlaces_h

#include "DSMBricks/cells/PackedBits.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace bricks
{

/// How the places of a brick are packed, without loss. The bits of a float are a number in the order of floats. A
/// coordinate is kept as its number less the minimum of its axis, in as few bits as the maximum needs.
struct PackedPlacesHeader
{
  std::uint32_t Least[3];
  std::uint8_t Bits[3]; ///< 0 to 32
  std::uint8_t Unused;

  std::uint32_t GetBitsOfPlace() const { return this->Bits[0] + this->Bits[1] + this->Bits[2]; }
};

/// Places in packed bits, one after the other, x, y and z of each. A view: valid as long as the bytes are. Eight bytes
/// behind the last one can be read.
class PackedPlaces
{
public:
  PackedPlaces(const PackedPlacesHeader& header, const std::byte* bytes)
    : Header(header)
    , Bytes(bytes)
  {
  }

  void Get(std::uint32_t number, float place[3]) const
  {
    std::size_t bit = std::size_t(number) * this->Header.GetBitsOfPlace();
    for (int axis = 0; axis < 3; ++axis)
    {
      const std::uint64_t mask = (std::uint64_t(1) << this->Header.Bits[axis]) - 1;
      place[axis] = ToFloat(
        this->Header.Least[axis] + static_cast<std::uint32_t>(ReadBits(this->Bytes, bit) & mask));
      bit += this->Header.Bits[axis];
    }
  }

  /// Decides how `places`, three floats each, are packed.
  static PackedPlacesHeader Measure(const std::vector<float>& places)
  {
    PackedPlacesHeader header{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      std::uint32_t least = std::numeric_limits<std::uint32_t>::max();
      std::uint32_t most = 0;
      for (std::size_t number = axis; number < places.size(); number += 3)
      {
        least = std::min(least, ToNumber(places[number]));
        most = std::max(most, ToNumber(places[number]));
      }
      header.Least[axis] = least;
      header.Bits[axis] =
        static_cast<std::uint8_t>(least < most ? bricks::CountBits(most - least) : 0);
    }
    return header;
  }
  static std::size_t CountBytes(const PackedPlacesHeader& header, std::size_t places)
  {
    return (places * header.GetBitsOfPlace() + 7) / 8 + sizeof(std::uint64_t);
  }
  /// `bytes`: as many as CountBytes, all zero.
  static void Write(
    const PackedPlacesHeader& header, const std::vector<float>& places, std::byte* bytes)
  {
    std::size_t bit = 0;
    for (std::size_t number = 0; number < places.size(); ++number)
    {
      const std::size_t axis = number % 3;
      WriteBits(bytes, bit, ToNumber(places[number]) - header.Least[axis]);
      bit += header.Bits[axis];
    }
  }

private:
  static constexpr std::uint32_t Sign = 0x80000000u;

  /// In the order of floats.
  static std::uint32_t ToNumber(float value)
  {
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof(bits));
    return (bits & Sign) != 0 ? ~bits : bits | Sign;
  }
  static float ToFloat(std::uint32_t number)
  {
    const std::uint32_t bits = (number & Sign) != 0 ? number ^ Sign : ~number;
    float value;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
  }

  const PackedPlacesHeader& Header;
  const std::byte* Bytes;
};

} // namespace bricks

#endif
