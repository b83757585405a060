// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_CornerTest_h
#define rt_CornerTest_h

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace rt
{

/// The eight corners of a cell in vector registers, compared all at once. A row of two corners is
/// one load.
template <class T>
class CornerTest
{
public:
  /// Returns whether some corners of a cell are `first` or above, and some are below. `corner` is
  /// the cell's first corner; `row` and `slice` are the offsets of the next corner along y and z.
  static bool IsSeparated(const T* corner, std::ptrdiff_t row, std::ptrdiff_t slice, T first)
  {
    const T* upper = corner + slice;
    if constexpr (sizeof(T) == 8)
    {
      return IsMixed(Compare(Load<Vector>(corner), first),
        Compare(Load<Vector>(corner + row), first), Compare(Load<Vector>(upper), first),
        Compare(Load<Vector>(upper + row), first));
    }
    else if constexpr (sizeof(T) == 4)
    {
      const Mask lower =
        Compare(Combine(Load<std::int64_t>(corner), Load<std::int64_t>(corner + row)), first);
      const Mask higher =
        Compare(Combine(Load<std::int64_t>(upper), Load<std::int64_t>(upper + row)), first);
      return IsMixed(lower, higher, lower, higher);
    }
    else
    {
      using Pair = std::conditional_t<sizeof(T) == 2, std::uint32_t, std::uint16_t>;
      const auto both = [&](const T* from)
      {
        constexpr int bits = 16 * sizeof(T);
        const std::uint64_t low = Load<Pair>(from);
        const std::uint64_t high = Load<Pair>(from + row);
        return static_cast<std::int64_t>(low | high << bits);
      };
      // Eight bytes of 8-bit corners fill half a register; the other half repeats them.
      const std::int64_t lower = both(corner);
      const std::int64_t higher = both(upper);
      const std::int64_t all = sizeof(T) == 2 ? lower : lower | higher << 32;
      const Mask mask = Compare(Combine(all, sizeof(T) == 2 ? higher : all), first);
      return IsMixed(mask, mask, mask, mask);
    }
  }

private:
  // The attribute of a dependent type is only taken from a typedef.
  typedef T Vector __attribute__((vector_size(16)));
  using Mask = std::int64_t __attribute__((vector_size(16)));

  template <class Value>
  static Value Load(const T* from)
  {
    Value value;
    std::memcpy(&value, from, sizeof(value));
    return value;
  }
  static Vector Combine(std::int64_t a, std::int64_t b)
  {
    return reinterpret_cast<Vector>(Mask{ a, b });
  }
  static Mask Compare(Vector corners, T first)
  {
    return reinterpret_cast<Mask>(corners >= Vector{} + first);
  }
  static bool IsMixed(Mask a, Mask b, Mask c, Mask d)
  {
    const Mask any = a | b | c | d;
    const Mask all = a & b & c & d;
    return (any[0] | any[1]) != 0 && (all[0] & all[1]) != -1;
  }
};

} // namespace rt

#endif
