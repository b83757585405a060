// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/PackedValues.h"

#include "DSMBricks/base/ByteHash.h"
#include "DSMVolumeFiles/base/SmallFile.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <type_traits>

namespace vol
{

namespace
{

using Type = bricks::ScalarType;

/// Exact, also for numbers below the smallest normal one, infinity and NaN.
float FromHalf(std::uint16_t half)
{
  // The exponent's bias is 15 in a half and 127 in a float.
  constexpr float rebias = 0x1p112f;
  const std::uint32_t magnitude = half & 0x7fffu;
  const std::uint32_t shifted = magnitude << 13;
  float value;
  std::memcpy(&value, &shifted, sizeof(value));
  value *= rebias;
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof(bits));
  bits |= (magnitude >= 0x7c00u ? 0x7f800000u : 0u) | (half & 0x8000u) << 16;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

/// `load(index)` returns a number, `toValue(number)` its value as a double.
template <class To, class Load, class ToValue>
void UnpackAll(std::size_t count, std::byte* out, const bricks::ValidValues& valid,
  const Load& load, const ToValue& toValue)
{
  const bricks::MissingTest<decltype(load(0))> isMissing(valid);
  for (std::size_t index = 0; index < count; ++index)
  {
    const auto number = load(index);
    const To value =
      isMissing(number) ? std::numeric_limits<To>::quiet_NaN() : static_cast<To>(toValue(number));
    std::memcpy(out + index * sizeof(To), &value, sizeof(To));
  }
}

} // namespace

PackedValues PackedValues::OfHalves()
{
  PackedValues halves(Type::UInt16);
  halves.IsHalf = true;
  return halves;
}

void PackedValues::TakeAttributes(const GetNumbers& getNumbers, bool isUnsigned,
  const std::string& array, std::vector<std::string>& warnings)
{
  const auto find = [&](const char* name) -> std::optional<double>
  {
    const std::vector<double> numbers = getNumbers(name);
    return numbers.size() == 1 ? std::optional<double>(numbers.front()) : std::nullopt;
  };
  const auto warn = [&](const char* name, const std::string& rest)
  {
    warnings.push_back(
      "has an attribute '" + std::string(name) + "' of array " + Quote(array) + " that " + rest);
  };
  double wrap = 0.0; // added to negative attributes of numbers that are unsigned
  if (isUnsigned && this->Stored <= Type::UInt64)
  {
    const std::size_t bytes = bricks::GetBytes(this->Stored);
    this->Stored = bytes == 1 ? Type::UInt8
      : bytes == 2            ? Type::UInt16
      : bytes == 4            ? Type::UInt32
                              : Type::UInt64;
    wrap = std::ldexp(1.0, static_cast<int>(8 * bytes));
  }
  const auto wrapped = [wrap](double number) { return number < 0.0 ? number + wrap : number; };
  for (const char* const name : { "_FillValue", "missing_value" })
  {
    for (const double fill : getNumbers(name))
    {
      if (!this->Valid.AddFill(wrapped(fill)))
      {
        warn(name,
          "declares more missing values than the " + std::to_string(this->Valid.Fills.size()) +
            " that are honored. The others are shown as values.");
        break;
      }
    }
  }
  const std::vector<double> range = getNumbers("valid_range");
  const auto low = range.size() == 2 ? std::optional<double>(range[0]) : find("valid_min");
  const auto high = range.size() == 2 ? std::optional<double>(range[1]) : find("valid_max");
  if (low && high && wrapped(*low) > wrapped(*high))
  {
    warn("valid_range", "has no values in it. It is ignored.");
  }
  else
  {
    this->Valid.Lowest = low && !std::isnan(*low) ? wrapped(*low) : this->Valid.Lowest;
    this->Valid.Highest = high && !std::isnan(*high) ? wrapped(*high) : this->Valid.Highest;
  }
  const double scale = find("scale_factor").value_or(1.0);
  const double offset = find("add_offset").value_or(0.0);
  if (scale == 0.0 || !std::isfinite(scale) || !std::isfinite(offset))
  {
    warn("scale_factor or add_offset", "is zero or not finite. The stored numbers are shown.");
    return;
  }
  this->Scale = scale;
  this->Offset = offset;
}

Type PackedValues::GetType() const
{
  if (!this->ArePacked())
  {
    return this->Stored;
  }
  if (this->IsHalf)
  {
    return Type::Float32;
  }
  return bricks::Dispatch(this->Stored,
    [this](auto zero)
    {
      using T = decltype(zero);
      if constexpr (std::is_floating_point_v<T>)
      {
        return this->Stored;
      }
      const auto most = static_cast<double>(std::numeric_limits<T>::max());
      const double farthest = std::abs(this->Scale) * most + std::abs(this->Offset);
      const double step = std::abs(this->Scale);
      constexpr double resolution = std::numeric_limits<float>::epsilon();
      return sizeof(T) <= 2 && 2.0 * resolution * farthest <= step &&
          farthest <= static_cast<double>(std::numeric_limits<float>::max())
        ? Type::Float32
        : Type::Float64;
    });
}

bricks::ValidValues PackedValues::GetValid() const
{
  return this->ArePacked() ? bricks::ValidValues() : this->Valid;
}

std::uint64_t PackedValues::GetStamp() const
{
  if (!this->ArePacked())
  {
    return 0;
  }
  bricks::ByteHash hash;
  const double numbers[] = { this->Scale, this->Offset, this->Valid.Lowest, this->Valid.Highest };
  hash.Add(numbers, sizeof(numbers));
  hash.Add(this->Valid.Fills.data(), sizeof(this->Valid.Fills));
  return hash.Get();
}

template <class Visit>
decltype(auto) PackedValues::WithLoad(const std::byte* from, const Visit& visit) const
{
  return bricks::Dispatch(this->Stored,
    [&](auto zero) -> decltype(auto)
    {
      const auto load = [from, zero](std::size_t index)
      {
        auto number = zero;
        std::memcpy(&number, from + index * sizeof(number), sizeof(number));
        return number;
      };
      if constexpr (std::is_same_v<decltype(zero), std::uint16_t>)
      {
        if (this->IsHalf)
        {
          return visit([&load](std::size_t index) { return FromHalf(load(index)); });
        }
      }
      return visit(load);
    });
}

double PackedValues::ToNumber(const std::byte* stored) const
{
  return this->WithLoad(stored, [](const auto& load) { return static_cast<double>(load(0)); });
}

void PackedValues::Unpack(const std::byte* from, std::size_t count, std::byte* out) const
{
  const auto toValue = [this](auto number)
  { return this->Scale * static_cast<double>(number) + this->Offset; };
  const bool isSingle = this->GetType() == Type::Float32;
  this->WithLoad(from,
    [&](const auto& load)
    {
      isSingle ? UnpackAll<float>(count, out, this->Valid, load, toValue)
               : UnpackAll<double>(count, out, this->Valid, load, toValue);
    });
}

std::vector<std::byte> PackedValues::ToHalf(float value)
{
  // Positive halves ascend with their bits.
  constexpr std::uint16_t infinity = 0x7c00;
  std::uint16_t best = infinity + 1; // NaN
  if (!std::isnan(value))
  {
    const float magnitude = std::abs(value);
    std::uint16_t above = 0;
    for (std::uint16_t step = 0x4000; step > 0; step /= 2)
    {
      const auto next = static_cast<std::uint16_t>(above + step);
      above = next <= infinity && FromHalf(next) <= magnitude ? next : above;
    }
    const auto next = static_cast<std::uint16_t>(std::min<int>(above + 1, infinity));
    best = magnitude - FromHalf(above) <= FromHalf(next) - magnitude ? above : next;
    best = static_cast<std::uint16_t>(best | (std::signbit(value) ? 0x8000 : 0));
  }
  std::vector<std::byte> bytes(sizeof(best));
  std::memcpy(bytes.data(), &best, sizeof(best));
  return bytes;
}

} // namespace vol
