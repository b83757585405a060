// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_IsovalueLevel_h
#define rt_IsovalueLevel_h

#include "DSMRayTracing/base/Lanes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

namespace rt
{

/// An isovalue among samples of type T. A sample is inside when it is not below the isovalue; that
/// one rule, the same in all cells, is what keeps surfaces closed and single where samples are equal
/// to the isovalue.
template <class T>
class IsovalueLevel
{
public:
  explicit IsovalueLevel(double isovalue)
    : Isovalue(isovalue)
  {
    if constexpr (std::is_integral_v<T>)
    {
      const double up = std::ceil(isovalue);
      // 2^digits, which is one above the largest value, is exact.
      const double end = std::ldexp(1.0, std::numeric_limits<T>::digits);
      this->Reachable = up < end;
      const bool low = up < static_cast<double>(std::numeric_limits<T>::lowest());
      this->First = !this->Reachable ? std::numeric_limits<T>::max()
        : low                        ? std::numeric_limits<T>::lowest()
                                     : static_cast<T>(up);
      // Below 1 even when an isovalue just above a whole number rounds the difference up.
      this->Rest = std::min(up - isovalue, 1.0 - std::numeric_limits<double>::epsilon());
    }
    else if constexpr (std::is_same_v<T, float>)
    {
      constexpr double largest = std::numeric_limits<float>::max();
      this->Reachable = isovalue <= largest;
      const double clamped = std::fmin(std::fmax(isovalue, -largest), largest);
      this->First = static_cast<float>(clamped);
      if (static_cast<double>(this->First) < clamped)
      {
        this->First = std::nextafter(this->First, std::numeric_limits<float>::infinity());
      }
    }
    else
    {
      this->Reachable = true;
      this->First = isovalue;
    }
  }

  double GetIsovalue() const { return this->Isovalue; }
  /// The smallest sample that is inside. Nothing is when not IsReachable.
  T GetFirst() const { return this->First; }
  bool IsReachable() const { return this->Reachable; }
  bool IsInside(T sample) const { return sample >= this->First; }

  /// Returns whether samples from `min` to `max` are on both sides; false when the range is empty.
  bool Separates(T min, T max) const
  {
    return min < this->First && max >= this->First && this->Reachable;
  }

  /// sample - isovalue; not negative exactly when the sample is inside. No bits are lost before the
  /// subtraction, also of 64-bit integers.
  double Subtract(T sample) const
  {
    if constexpr (std::is_integral_v<T> && sizeof(T) == 8)
    {
      const auto a = static_cast<std::uint64_t>(sample);
      const auto b = static_cast<std::uint64_t>(this->First);
      const double difference =
        sample >= this->First ? static_cast<double>(a - b) : -static_cast<double>(b - a);
      return difference + this->Rest;
    }
    else
    {
      return static_cast<double>(sample) - this->Isovalue;
    }
  }

  /// The same of two samples that follow one another.
  Lanes::Half SubtractPair(const T* samples) const
  {
    if constexpr (std::is_integral_v<T> && sizeof(T) == 8)
    {
      return Lanes::Half{ this->Subtract(samples[0]), this->Subtract(samples[1]) };
    }
    else
    {
      Two two;
      std::memcpy(&two, samples, sizeof(two));
      return __builtin_convertvector(two, Lanes::Half) - this->Isovalue;
    }
  }

private:
  // The attribute of a dependent type is only taken from a typedef.
  typedef T Two __attribute__((vector_size(2 * sizeof(T))));

  double Isovalue;
  double Rest = 0.0; ///< First - isovalue, for integers
  T First;
  bool Reachable;
};

} // namespace rt

#endif
