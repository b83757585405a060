// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_ExactScale_h
#define bricks_ExactScale_h

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace bricks
{

/// Turns numbers of bounded size into integers, whose sum is the same in any order, bit for bit. The largest number
/// has 42 bits, so that 2^20 of them can be added. Numbers of one sum need the same scale; each sum has a scale of its
/// own, so small sums are as precise as large ones. Plain.
class ExactScale
{
public:
  /// For a sum without numbers. It is below all others.
  ExactScale() = default;
  /// For numbers of at most this absolute size, which is finite and not negative.
  explicit ExactScale(double largest)
  {
    std::uint64_t bits;
    std::memcpy(&bits, &largest, sizeof(bits));
    this->Power = std::max(static_cast<std::uint16_t>(bits >> 52), LeastPower);
  }

  /// Scales of larger numbers are larger. They also hold smaller numbers.
  std::uint16_t GetPower() const { return this->Power; }
  static ExactScale FromPower(std::uint16_t power)
  {
    ExactScale scale;
    scale.Power = power;
    return scale;
  }

  /// Factor of numbers: a power of two. The integer is the product without its fraction.
  double GetFactor() const { return PowerOfTwo(UnitPower - std::max(this->Power, LeastPower)); }
  std::int64_t Fix(double number) const
  {
    return static_cast<std::int64_t>(number * this->GetFactor());
  }
  /// Returns by how many bits an integer of a smaller scale is to be shifted to the right for this one; at most as many
  /// as there are behind the sign.
  int CountBitsAbove(const ExactScale& smaller) const
  {
    return std::min(this->Power - smaller.Power, 63);
  }
  /// Returns what one is as a number.
  double GetUnit() const { return PowerOfTwo(std::max(this->Power, LeastPower) - UnitPower); }

private:
  /// Numbers below 2^-958 are as coarse as this one.
  static constexpr std::uint16_t LeastPower = 64;
  static constexpr int UnitPower = 1022 + 42;

  static double PowerOfTwo(int power)
  {
    const auto bits = static_cast<std::uint64_t>(power + 1023) << 52;
    double number;
    std::memcpy(&number, &bits, sizeof(number));
    return number;
  }

  std::uint16_t Power = 0; ///< exponent of the largest number, as doubles have it
};

} // namespace bricks

#endif
