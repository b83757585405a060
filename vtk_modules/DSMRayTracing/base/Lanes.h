// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Lanes_h
#define rt_Lanes_h

#include <cstdint>

namespace rt
{

/// One bit pattern per lane: all ones where a comparison of Lanes holds, else zeros; also whole
/// numbers, one a lane.
struct IntegerLanes
{
  using Half = std::int64_t __attribute__((vector_size(16)));
  Half Low;  ///< x, y
  Half High; ///< z, idle

  /// Returns whether the comparison holds in any lane.
  bool IsAny() const
  {
    const Half any = this->Low | this->High;
    return (any[0] | any[1]) != 0;
  }
  std::int64_t GetSum() const
  {
    const Half sum = this->Low + this->High;
    return sum[0] + sum[1];
  }
};

/// a, or -a where the mask is set.
inline IntegerLanes NegateWhere(const IntegerLanes& a, const IntegerLanes& mask)
{
  return { (a.Low ^ mask.Low) - mask.Low, (a.High ^ mask.High) - mask.High };
}
inline IntegerLanes operator&(const IntegerLanes& a, const IntegerLanes& b)
{
  return { a.Low & b.Low, a.High & b.High };
}
inline IntegerLanes operator|(const IntegerLanes& a, const IntegerLanes& b)
{
  return { a.Low | b.Low, a.High | b.High };
}

/// A double for each axis, and an idle one, in vector registers of the size that every processor
/// has. Each operation is that of the scalars, lane by lane, bit for bit.
struct Lanes
{
  using Half = double __attribute__((vector_size(16)));
  Half Low;  ///< x, y
  Half High; ///< z, idle

  Lanes() = default;
  Lanes(Half low, Half high)
    : Low(low)
    , High(high)
  {
  }
  Lanes(double x, double y, double z, double idle)
    : Low{ x, y }
    , High{ z, idle }
  {
  }
  explicit Lanes(double all)
    : Low{ all, all }
    , High{ all, all }
  {
  }

  double operator[](int axis) const { return axis < 2 ? this->Low[axis] : this->High[axis - 2]; }
  void Set(int axis, double value)
  {
    if (axis < 2)
    {
      this->Low[axis] = value;
    }
    else
    {
      this->High[axis - 2] = value;
    }
  }

  double GetSum() const
  {
    const Half sum = this->Low + this->High;
    return sum[0] + sum[1];
  }
  double GetMin() const
  {
    const Half low = this->Low < this->High ? this->Low : this->High;
    return low[0] < low[1] ? low[0] : low[1];
  }
};

inline Lanes operator+(const Lanes& a, const Lanes& b)
{
  return { a.Low + b.Low, a.High + b.High };
}
inline Lanes operator-(const Lanes& a, const Lanes& b)
{
  return { a.Low - b.Low, a.High - b.High };
}
inline Lanes operator*(const Lanes& a, const Lanes& b)
{
  return { a.Low * b.Low, a.High * b.High };
}
inline IntegerLanes operator<=(const Lanes& a, const Lanes& b)
{
  return { a.Low <= b.Low, a.High <= b.High };
}
inline IntegerLanes operator==(const Lanes& a, const Lanes& b)
{
  return { a.Low == b.Low, a.High == b.High };
}
inline IntegerLanes operator>(const Lanes& a, const Lanes& b)
{
  return { a.Low > b.Low, a.High > b.High };
}
/// a where the mask is set, else 0.
inline Lanes operator&(const Lanes& a, const IntegerLanes& mask)
{
  using Bits = IntegerLanes::Half;
  return { reinterpret_cast<Lanes::Half>(reinterpret_cast<Bits>(a.Low) & mask.Low),
    reinterpret_cast<Lanes::Half>(reinterpret_cast<Bits>(a.High) & mask.High) };
}
/// a where the mask is set, else b.
inline Lanes Select(const IntegerLanes& mask, const Lanes& a, const Lanes& b)
{
  return { mask.Low ? a.Low : b.Low, mask.High ? a.High : b.High };
}
inline Lanes Min(const Lanes& a, const Lanes& b)
{
  return { a.Low < b.Low ? a.Low : b.Low, a.High < b.High ? a.High : b.High };
}
inline Lanes Clamp(const Lanes& a, const Lanes& low, const Lanes& high)
{
  const Lanes raised{ a.Low > low.Low ? a.Low : low.Low, a.High > low.High ? a.High : low.High };
  return { raised.Low < high.Low ? raised.Low : high.Low,
    raised.High < high.High ? raised.High : high.High };
}

/// The nearest whole number, of lanes from 0 to 2^51.
inline Lanes Round(const Lanes& a)
{
  // From 2^52 on doubles are whole.
  const Lanes large(4503599627370496.0);
  return (a + large) - large;
}

} // namespace rt

#endif
