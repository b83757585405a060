// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_ValidValues_h
#define bricks_ValidValues_h

#include "DSMBricks/base/ScalarType.h"

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
  double Fill = std::numeric_limits<double>::quiet_NaN(); ///< is missing itself; NaN: there is none

  bool operator==(const ValidValues& other) const
  {
    return this->Lowest == other.Lowest && this->Highest == other.Highest &&
      (this->Fill == other.Fill || (std::isnan(this->Fill) && std::isnan(other.Fill)));
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
          (this->Fill >= least && this->Fill <= most);
      });
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
    if constexpr (std::is_floating_point_v<T>)
    {
      // As the array has it. What T cannot hold stays beyond all values.
      if (std::abs(valid.Fill) <= static_cast<double>(std::numeric_limits<T>::max()))
      {
        this->Valid.Fill = static_cast<double>(static_cast<T>(valid.Fill));
      }
      const bool isGiant = std::abs(valid.Fill) >= ValidValues::LeastGiant;
      this->From = isGiant && valid.Fill > 0.0 ? this->Valid.Fill : this->From;
      this->UpTo = isGiant && valid.Fill < 0.0 ? this->Valid.Fill : this->UpTo;
    }
  }

  bool operator()(T sample) const
  {
    const auto value = static_cast<double>(sample);
    return !(value >= this->Valid.Lowest && value <= this->Valid.Highest) ||
      value == this->Valid.Fill || value >= this->From || value <= this->UpTo;
  }

private:
  ValidValues Valid;
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
