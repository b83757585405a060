// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_Double2_h
#define bricks_Double2_h

#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace bricks
{

/// Two doubles that are treated alike. With SSE2 one register; else plain numbers, with the same results.
struct Double2
{
#if defined(__SSE2__)
  __m128d Lanes;

  static Double2 Load(const double* from)
  {
    return { _mm_loadu_pd(from) };
  }
  static Double2 Fill(double value)
  {
    return { _mm_set1_pd(value) };
  }
  void Store(double* to) const
  {
    _mm_storeu_pd(to, this->Lanes);
  }

  friend Double2 operator+(Double2 a, Double2 b)
  {
    return { _mm_add_pd(a.Lanes, b.Lanes) };
  }
  friend Double2 operator-(Double2 a, Double2 b)
  {
    return { _mm_sub_pd(a.Lanes, b.Lanes) };
  }
  friend Double2 operator*(Double2 a, Double2 b)
  {
    return { _mm_mul_pd(a.Lanes, b.Lanes) };
  }
#else
  double Lanes[2];

  static Double2 Load(const double* from)
  {
    return { { from[0], from[1] } };
  }
  static Double2 Fill(double value)
  {
    return { { value, value } };
  }
  void Store(double* to) const
  {
    std::memcpy(to, this->Lanes, sizeof(this->Lanes));
  }

  friend Double2 operator+(Double2 a, Double2 b)
  {
    return { { a.Lanes[0] + b.Lanes[0], a.Lanes[1] + b.Lanes[1] } };
  }
  friend Double2 operator-(Double2 a, Double2 b)
  {
    return { { a.Lanes[0] - b.Lanes[0], a.Lanes[1] - b.Lanes[1] } };
  }
  friend Double2 operator*(Double2 a, Double2 b)
  {
    return { { a.Lanes[0] * b.Lanes[0], a.Lanes[1] * b.Lanes[1] } };
  }
#endif
};

} // namespace bricks

#endif
