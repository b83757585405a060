// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_Float4_h
#define bricks_Float4_h

#include <algorithm>
#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace bricks
{

/// Four floats that are treated alike. With SSE2 one register; else plain numbers, with the same
/// results.
struct Float4
{
#if defined(__SSE2__)
  __m128 Lanes;

  static Float4 Load(const float* from)
  {
    return { _mm_loadu_ps(from) };
  }
  static Float4 Fill(float value)
  {
    return { _mm_set1_ps(value) };
  }
  void Store(float* to) const
  {
    _mm_storeu_ps(to, this->Lanes);
  }

  friend Float4 operator+(Float4 a, Float4 b)
  {
    return { _mm_add_ps(a.Lanes, b.Lanes) };
  }
  friend Float4 operator-(Float4 a, Float4 b)
  {
    return { _mm_sub_ps(a.Lanes, b.Lanes) };
  }
  friend Float4 operator*(Float4 a, Float4 b)
  {
    return { _mm_mul_ps(a.Lanes, b.Lanes) };
  }
  /// b where either is not a number.
  friend Float4 Min(Float4 a, Float4 b)
  {
    return { _mm_min_ps(a.Lanes, b.Lanes) };
  }
  friend Float4 Max(Float4 a, Float4 b)
  {
    return { _mm_max_ps(a.Lanes, b.Lanes) };
  }
  /// Bit i set where a <= b in lane i; not where either is not a number.
  friend unsigned GetLessEqual(Float4 a, Float4 b)
  {
    return static_cast<unsigned>(_mm_movemask_ps(_mm_cmple_ps(a.Lanes, b.Lanes)));
  }
  /// Bit i set where a < b and c < d in lane i.
  friend unsigned GetBothLess(Float4 a, Float4 b, Float4 c, Float4 d)
  {
    return static_cast<unsigned>(
      _mm_movemask_ps(_mm_and_ps(_mm_cmplt_ps(a.Lanes, b.Lanes), _mm_cmplt_ps(c.Lanes, d.Lanes))));
  }

  /// Eight bytes as floats.
  static void LoadBytes(const std::uint8_t* from, Float4& first, Float4& second)
  {
    const __m128i zero = _mm_setzero_si128();
    const __m128i words =
      _mm_unpacklo_epi8(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from)), zero);
    first.Lanes = _mm_cvtepi32_ps(_mm_unpacklo_epi16(words, zero));
    second.Lanes = _mm_cvtepi32_ps(_mm_unpackhi_epi16(words, zero));
  }

  /// Floats that have only an exponent, given as four bytes.
  static Float4 LoadExponents(const std::uint8_t* from)
  {
    std::uint32_t bytes;
    std::memcpy(&bytes, from, sizeof(bytes));
    const __m128i zero = _mm_setzero_si128();
    const __m128i words = _mm_unpacklo_epi8(_mm_cvtsi32_si128(static_cast<int>(bytes)), zero);
    return { _mm_castsi128_ps(_mm_slli_epi32(_mm_unpacklo_epi16(words, zero), 23)) };
  }
  /// All lanes as one of them.
  template <int Lane>
  Float4 Spread() const
  {
    return { _mm_shuffle_ps(this->Lanes, this->Lanes, _MM_SHUFFLE(Lane, Lane, Lane, Lane)) };
  }

  /// The first three floats at four places become three vectors; reads four floats at each.
  static void LoadTransposed(
    const float* a, const float* b, const float* c, const float* d, Float4& x, Float4& y, Float4& z)
  {
    const __m128 pa = _mm_loadu_ps(a);
    const __m128 pb = _mm_loadu_ps(b);
    const __m128 pc = _mm_loadu_ps(c);
    const __m128 pd = _mm_loadu_ps(d);
    const __m128 xyAB = _mm_unpacklo_ps(pa, pb);
    const __m128 xyCD = _mm_unpacklo_ps(pc, pd);
    x.Lanes = _mm_movelh_ps(xyAB, xyCD);
    y.Lanes = _mm_movehl_ps(xyCD, xyAB);
    z.Lanes = _mm_movelh_ps(_mm_unpackhi_ps(pa, pb), _mm_unpackhi_ps(pc, pd));
  }
#else
  float Lanes[4];

  static Float4 Load(const float* from)
  {
    Float4 result;
    std::copy_n(from, 4, result.Lanes);
    return result;
  }
  static Float4 Fill(float value)
  {
    return { { value, value, value, value } };
  }
  void Store(float* to) const
  {
    std::copy_n(this->Lanes, 4, to);
  }

  friend Float4 operator+(Float4 a, Float4 b)
  {
    return Combine(a, b, [](float p, float q) { return p + q; });
  }
  friend Float4 operator-(Float4 a, Float4 b)
  {
    return Combine(a, b, [](float p, float q) { return p - q; });
  }
  friend Float4 operator*(Float4 a, Float4 b)
  {
    return Combine(a, b, [](float p, float q) { return p * q; });
  }
  /// b where either is not a number.
  friend Float4 Min(Float4 a, Float4 b)
  {
    return Combine(a, b, [](float p, float q) { return p < q ? p : q; });
  }
  friend Float4 Max(Float4 a, Float4 b)
  {
    return Combine(a, b, [](float p, float q) { return p > q ? p : q; });
  }
  /// Bit i set where a <= b in lane i; not where either is not a number.
  friend unsigned GetLessEqual(Float4 a, Float4 b)
  {
    unsigned mask = 0;
    for (int lane = 0; lane < 4; ++lane)
    {
      mask |= a.Lanes[lane] <= b.Lanes[lane] ? 1u << lane : 0u;
    }
    return mask;
  }
  /// Bit i set where a < b and c < d in lane i.
  friend unsigned GetBothLess(Float4 a, Float4 b, Float4 c, Float4 d)
  {
    unsigned mask = 0;
    for (int lane = 0; lane < 4; ++lane)
    {
      mask |= a.Lanes[lane] < b.Lanes[lane] && c.Lanes[lane] < d.Lanes[lane] ? 1u << lane : 0u;
    }
    return mask;
  }

  /// Eight bytes as floats.
  static void LoadBytes(const std::uint8_t* from, Float4& first, Float4& second)
  {
    std::copy_n(from, 4, first.Lanes);
    std::copy_n(from + 4, 4, second.Lanes);
  }

  /// Floats that have only an exponent, given as four bytes.
  static Float4 LoadExponents(const std::uint8_t* from)
  {
    Float4 result;
    for (int lane = 0; lane < 4; ++lane)
    {
      const std::uint32_t bits = static_cast<std::uint32_t>(from[lane]) << 23;
      std::memcpy(&result.Lanes[lane], &bits, sizeof(bits));
    }
    return result;
  }
  /// All lanes as one of them.
  template <int Lane>
  Float4 Spread() const
  {
    return Fill(this->Lanes[Lane]);
  }

  /// The first three floats at four places become three vectors; reads four floats at each.
  static void LoadTransposed(
    const float* a, const float* b, const float* c, const float* d, Float4& x, Float4& y, Float4& z)
  {
    x = { { a[0], b[0], c[0], d[0] } };
    y = { { a[1], b[1], c[1], d[1] } };
    z = { { a[2], b[2], c[2], d[2] } };
  }

private:
  template <class Function>
  static Float4 Combine(Float4 a, Float4 b, Function&& function)
  {
    Float4 result;
    for (int lane = 0; lane < 4; ++lane)
    {
      result.Lanes[lane] = function(a.Lanes[lane], b.Lanes[lane]);
    }
    return result;
  }
#endif
};

} // namespace bricks

#endif
