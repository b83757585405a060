// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_PackedValues_h
#define vol_PackedValues_h

#include "DSMBricks/base/ScalarType.h"
#include "DSMBricks/base/ValidValues.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace vol
{

/// The numbers that a file has for an array's values, and what the array's attributes say of them (NetCDF User's Guide,
/// attribute conventions; CF Conventions 2.5.1 and 8.1): a value is Scale times a number plus Offset.
class PackedValues
{
public:
  PackedValues() = default;
  explicit PackedValues(bricks::ScalarType stored)
    : Stored(stored)
  {
  }
  /// Numbers of 16 bits with 5 of exponent (IEEE 754 binary16).
  static PackedValues OfHalves();

  /// Numbers of an attribute; none where it does not exist, or has no numbers.
  using GetNumbers = std::function<std::vector<double>(const char* name)>;
  /// Takes scale_factor, add_offset, _FillValue and missing_value, valid_range or else valid_min and valid_max, and
  /// _Unsigned. Adds a sentence to `warnings` for each attribute that cannot be honored. `array`: its name.
  void TakeAttributes(const GetNumbers& getNumbers, bool isUnsigned, const std::string& array,
    std::vector<std::string>& warnings);

  /// Returns whether the values differ from the numbers.
  bool ArePacked() const { return this->IsHalf || this->Scale != 1.0 || this->Offset != 0.0; }
  bool AreHalves() const { return this->IsHalf; }
  /// Type of the numbers: of halves UInt16, as the machine has none.
  bricks::ScalarType GetStored() const { return this->Stored; }
  /// Type of the values. For integers it is Float32 if that distinguishes all of them, else Float64.
  bricks::ScalarType GetType() const;
  /// Which of the values are data. Where values are packed, those that are not are NaN.
  bricks::ValidValues GetValid() const;
  /// Differs where the values differ though the numbers do not; 0 where they are the numbers.
  std::uint64_t GetStamp() const;

  /// Returns a number as it is stored, before it is unpacked.
  double ToNumber(const std::byte* stored) const;
  /// Computes so many values. Missing values of floating point type are NaN. `from` and `out` do not overlap.
  void Unpack(const std::byte* from, std::size_t count, std::byte* out) const;
  /// Returns the bytes of the half nearest to a value.
  static std::vector<std::byte> ToHalf(float value);

private:
  /// Calls `visit(load)`, where `load(index)` returns a number as it is stored; halves as floats.
  template <class Visit>
  decltype(auto) WithLoad(const std::byte* from, const Visit& visit) const;

  bricks::ScalarType Stored = bricks::ScalarType::UInt8;
  bool IsHalf = false;
  double Scale = 1.0;
  double Offset = 0.0;
  bricks::ValidValues Valid; ///< of the numbers
};

} // namespace vol

#endif
