// SPDX-License-Identifier: BSD-3-Clause

#include "DSMRayTracing/base/VectorTargets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "DSMRayTracing/frame/LightKernel.cxx"
#include <hwy/foreach_target.h> // IWYU pragma: keep

#include "DSMRayTracing/frame/LightKernel.h"

#include "DSMRayTracing/base/VectorKernel.h"

#include <hwy/highway.h>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// The functions of LightKernel with vectors of D, and none of the operations contracted.
template <class D>
class LightSteps
{
public:
  static LightKernel Create(const char* name)
  {
    return { name, static_cast<int>(hn::MaxLanes(D())), &FindContrast, &Smooth };
  }

private:
  using Vector = hn::Vec<D>;
  using Planes = LightPlanes;

  static constexpr int Reach = 2;
  /// Weights of the cubic B-spline, by distance.
  static constexpr float Spline[Reach + 1] = { 0.375f, 0.25f, 0.0625f };
  /// Cosine of the angle between normals from which pixels have nothing in common.
  static constexpr float LeastCosine = 0.7f;
  /// Pixels, for each step, that a place may lie beside another's plane.
  static constexpr float Flatness = 2.0f;
  /// Standard deviations at which light counts as another's, and what is added to them.
  static constexpr float Deviations = 2.0f;
  static constexpr float LeastDifference = 0.02f;

  static HWY_INLINE Vector Set(float value) { return hn::Set(D(), value); }
  static HWY_INLINE Vector Load(const Planes& planes, int plane, int row, int x)
  {
    return hn::LoadU(D(), planes.GetRow(plane, row) + x);
  }

  /// Three numbers of a pixel.
  struct Triple
  {
    Vector X;
    Vector Y;
    Vector Z;

    Triple(const Planes& planes, int plane, int row, int x)
      : X(Load(planes, plane, row, x))
      , Y(Load(planes, plane + 1, row, x))
      , Z(Load(planes, plane + 2, row, x))
    {
    }
    Vector GetMean() const
    {
      return hn::Mul(Set(1.0f / 3.0f), hn::Add(hn::Add(this->X, this->Y), this->Z));
    }
  };

  /// Pixels in the middle of the filter.
  struct Middle
  {
    Triple Normal;
    Triple Place;
    Vector Fineness; ///< for the step

    Middle(const Planes& planes, int row, int x, int step)
      : Normal(planes, Planes::NormalX, row, x)
      , Place(planes, Planes::PlaceX, row, x)
      , Fineness(hn::Mul(Load(planes, Planes::Fineness, row, x), Set(1.0f / (Flatness * step))))
    {
    }

    /// Returns how much other pixels lie on the same surface, in [0, 1].
    HWY_INLINE Vector Compare(const Planes& planes, int row, int x) const
    {
      const Triple normal(planes, Planes::NormalX, row, x);
      const Triple place(planes, Planes::PlaceX, row, x);
      const Vector cosine =
        hn::Add(hn::Add(hn::Mul(this->Normal.X, normal.X), hn::Mul(this->Normal.Y, normal.Y)),
          hn::Mul(this->Normal.Z, normal.Z));
      const Vector aside = hn::Add(hn::Add(hn::Mul(this->Normal.X, hn::Sub(place.X, this->Place.X)),
                                     hn::Mul(this->Normal.Y, hn::Sub(place.Y, this->Place.Y))),
        hn::Mul(this->Normal.Z, hn::Sub(place.Z, this->Place.Z)));
      const Vector turned = hn::Max(hn::Zero(D()),
        hn::Mul(hn::Sub(cosine, Set(LeastCosine)), Set(1.0f / (1.0f - LeastCosine))));
      const Vector level =
        hn::Max(hn::Zero(D()), hn::Sub(Set(1.0f), hn::Mul(hn::Abs(aside), this->Fineness)));
      return hn::Mul(hn::Mul(turned, level), Load(planes, Planes::Weight, row, x));
    }
  };

  /// Calls `visit(otherRow, otherX, weight)` for the pixels of the filter, which are `step` apart.
  template <class Visit>
  static HWY_INLINE void VisitAround(
    const Planes& planes, int row, int x, int step, const Visit& visit)
  {
    for (int j = -Reach; j <= Reach; ++j)
    {
      const int otherRow = row + j * step;
      if (otherRow < planes.GetFirstRow() || otherRow >= planes.GetEndRow())
      {
        continue; // beyond the picture
      }
      for (int i = -Reach; i <= Reach; ++i)
      {
        visit(otherRow, x + i * step, Spline[i < 0 ? -i : i] * Spline[j < 0 ? -j : j]);
      }
    }
  }

  /// Calls `visit(x)` for the first pixels of vectors that have anything to filter.
  template <class Visit>
  static HWY_INLINE void VisitRow(const Planes& planes, int row, const Visit& visit)
  {
    for (int x = 0; x < planes.GetWidth(); x += static_cast<int>(hn::MaxLanes(D())))
    {
      if (!hn::AllTrue(D(), hn::Eq(Load(planes, Planes::Weight, row, x), hn::Zero(D()))))
      {
        visit(x);
      }
    }
  }

  static void FindContrast(LightPlanes& planes, int row, bool usesVariance)
  {
    VisitRow(planes, row,
      [&](int x)
      {
        const Middle middle(planes, row, x, 1);
        Vector sum = hn::Zero(D());
        Vector first = hn::Zero(D());
        Vector second = hn::Zero(D());
        VisitAround(planes, row, x, 1,
          [&](int otherRow, int otherX, float)
          {
            const Vector weight = middle.Compare(planes, otherRow, otherX);
            const Vector light = Triple(planes, Planes::Red, otherRow, otherX).GetMean();
            const Vector square = usesVariance ? Load(planes, Planes::Variance, otherRow, otherX)
                                               : hn::Mul(light, light);
            sum = hn::Add(sum, weight);
            first = hn::Add(first, hn::Mul(weight, light));
            second = hn::Add(second, hn::Mul(weight, square));
          });
        // Where the middle has no light to filter, its result is not used.
        const Vector count = hn::Max(sum, Set(1e-6f));
        const Vector mean = hn::Div(first, count);
        const Vector square = hn::Div(second, count);
        const Vector variance = usesVariance ? square : hn::Sub(square, hn::Mul(mean, mean));
        const Vector deviation = hn::Sqrt(hn::Max(variance, hn::Zero(D())));
        const Vector difference =
          hn::Add(hn::Mul(Set(Deviations), deviation), Set(LeastDifference));
        hn::StoreU(hn::Div(Set(1.0f), difference), D(), planes.GetRow(Planes::Contrast, row) + x);
      });
  }

  static void Smooth(LightPlanes& planes, int row, int step, float scale, LightPlanes::Plane from)
  {
    const int to = from == Planes::Red ? Planes::OtherRed : Planes::Red;
    for (int color = 0; color < 3; ++color)
    {
      const float* const source = planes.GetRow(from + color, row);
      std::copy_n(source, planes.GetWidth(), planes.GetRow(to + color, row));
    }
    VisitRow(planes, row,
      [&](int x)
      {
        const Middle middle(planes, row, x, step);
        const Vector contrast = hn::Mul(Load(planes, Planes::Contrast, row, x), Set(scale));
        const Vector own = Triple(planes, from, row, x).GetMean();
        Vector sum = hn::Zero(D());
        Vector red = hn::Zero(D());
        Vector green = hn::Zero(D());
        Vector blue = hn::Zero(D());
        VisitAround(planes, row, x, step,
          [&](int otherRow, int otherX, float part)
          {
            const Triple light(planes, from, otherRow, otherX);
            const Vector unlike = hn::Mul(hn::Abs(hn::Sub(own, light.GetMean())), contrast);
            const Vector near = hn::Max(hn::Zero(D()), hn::Sub(Set(1.0f), unlike));
            const Vector weight =
              hn::Mul(hn::Mul(near, Set(part)), middle.Compare(planes, otherRow, otherX));
            sum = hn::Add(sum, weight);
            red = hn::Add(red, hn::Mul(weight, light.X));
            green = hn::Add(green, hn::Mul(weight, light.Y));
            blue = hn::Add(blue, hn::Mul(weight, light.Z));
          });
        const auto isFiltered = hn::Gt(sum, hn::Zero(D()));
        const Vector count = hn::IfThenElse(isFiltered, sum, Set(1.0f));
        const auto store = [&](int color, Vector total)
        {
          const Vector before = Load(planes, from + color, row, x);
          hn::StoreU(hn::IfThenElse(isFiltered, hn::Div(total, count), before), D(),
            planes.GetRow(to + color, row) + x);
        };
        store(0, red);
        store(1, green);
        store(2, blue);
      });
  }
};

RT_CREATE_KERNEL(LightKernel, LightSteps, float, 16)

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace rt
{

RT_DISPATCH_KERNEL(LightKernel)

} // namespace rt

#endif
