// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_ValidValues_h
#define bricks_ValidValues_h

#include "DSMBricks/base/ScalarType.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

namespace bricks
{

/// Which values of a field are data. The others are missing, as NaN is. Plain; all values are data by default.
struct ValidValues
{
  /// Floating point fill values of at least this size also stand for what is beyond them: a file's 1e20 and its
  /// array's may be rounded differently.
  static constexpr double LeastGiant = 1e10;

  double Lowest = -std::numeric_limits<double>::infinity(); ///< values below are missing
  double Highest = std::numeric_limits<double>::infinity(); ///< values above are missing
  /// These are missing themselves; NaN: there is none.
  std::array<double, 4> Fills = MakeNoFills();

  bool operator==(const ValidValues& other) const
  {
    return this->Lowest == other.Lowest && this->Highest == other.Highest &&
      std::equal(this->Fills.begin(), this->Fills.end(), other.Fills.begin(),
        [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); });
  }

  /// Returns false if it already holds as many as it can.
  bool AddFill(double fill)
  {
    const auto place = std::find_if(this->Fills.begin(), this->Fills.end(),
      [=](double known) { return std::isnan(known) || known == fill; });
    if (place != this->Fills.end() && !std::isnan(fill))
    {
      *place = fill;
    }
    return place != this->Fills.end() || std::isnan(fill);
  }

  /// Returns whether any finite value of a type is missing.
  bool Exclude(ScalarType type) const
  {
    return Dispatch(type,
      [this](auto zero)
      {
        using Limits = std::numeric_limits<decltype(zero)>;
        const auto least = static_cast<double>(Limits::lowest());
        const auto most = static_cast<double>(Limits::max());
        return this->Lowest > least || this->Highest < most ||
          std::any_of(this->Fills.begin(), this->Fills.end(),
            [=](double fill) { return fill >= least && fill <= most; });
      });
  }

private:
  static std::array<double, 4> MakeNoFills()
  {
    std::array<double, 4> none{};
    none.fill(std::numeric_limits<double>::quiet_NaN());
    return none;
  }
};

/// Tests values of type T, NaN included.
template <class T>
class MissingTest
{
public:
  explicit MissingTest(const ValidValues& valid)
    : Valid(valid)
  {
    for (double& fill : this->Valid.Fills)
    {
      if constexpr (std::is_floating_point_v<T>)
      {
        const bool isGiant = std::abs(fill) >= ValidValues::LeastGiant;
        // The number as the array has it. A number that T cannot hold stays beyond all values.
        if (std::abs(fill) <= static_cast<double>(std::numeric_limits<T>::max()))
        {
          fill = static_cast<double>(static_cast<T>(fill));
        }
        this->From = isGiant && fill > 0.0 ? std::min(this->From, fill) : this->From;
        this->UpTo = isGiant && fill < 0.0 ? std::max(this->UpTo, fill) : this->UpTo;
      }
      this->Count += std::isnan(fill) ? 0 : 1;
    }
  }

  bool operator()(T sample) const
  {
    const auto value = static_cast<double>(sample);
    const auto last = this->Valid.Fills.begin() + this->Count;
    return !(value >= this->Valid.Lowest && value <= this->Valid.Highest) || value >= this->From ||
      value <= this->UpTo || std::find(this->Valid.Fills.begin(), last, value) != last;
  }

private:
  ValidValues Valid;
  std::ptrdiff_t Count = 0; ///< of its fills
  double From = std::numeric_limits<double>::infinity();
  double UpTo = -std::numeric_limits<double>::infinity();
};

/// Makes missing samples NaN; integers stay as they are. `samples`: so many of that type.
inline void ReplaceMissing(
  const ValidValues& valid, ScalarType type, std::byte* samples, std::size_t count)
{
  Dispatch(type,
    [&](auto zero)
    {
      using T = decltype(zero);
      if constexpr (std::is_floating_point_v<T>)
      {
        const MissingTest<T> isMissing(valid);
        auto* const values = reinterpret_cast<T*>(samples);
        for (std::size_t index = 0; index < count; ++index)
        {
          values[index] =
            isMissing(values[index]) ? std::numeric_limits<T>::quiet_NaN() : values[index];
        }
      }
    });
}

} // namespace bricks

#endif
