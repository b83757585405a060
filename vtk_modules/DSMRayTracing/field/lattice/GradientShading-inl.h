// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_GradientShading_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_GradientShading_inl_h
#undef rt_GradientShading_inl_h
#else
#define rt_GradientShading_inl_h
#endif

#include "DSMRayTracing/base/Power-inl.h"
#include "DSMRayTracing/base/VectorLanes-inl.h"
#include "DSMRayTracing/field/lattice/MediumBrick.h"
#include "DSMRayTracing/ray/MediumShading.h"

#include <hwy/highway.h>

#include <glm/gtc/matrix_access.hpp>
#include <glm/vec3.hpp>

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// Shades a medium by the gradients of its values, for a vector of rays.
template <class F>
class GradientShading
{
public:
  using Vector = hn::Vec<F>;
  using Mask = hn::Mask<F>;
  using NumberTag = hn::RebindToSigned<F>;
  using Numbers = hn::Vec<NumberTag>;

  /// Finds the gradients at places in cells of a brick whose samples have a border: what CellNeighbourhood::GetGradient
  /// finds.
  static HWY_INLINE void FindGradients(
    const MediumBrick& brick, const Vector cell[3], const Vector within[3], Vector gradient[3])
  {
    const F tag;
    const int strides[3] = { 1, brick.Row, brick.Slice };
    const auto* const samples = static_cast<const float*>(brick.Samples);
    const Vector row = hn::Mul(cell[1], hn::Set(tag, static_cast<float>(strides[1])));
    const Vector slice = hn::Mul(cell[2], hn::Set(tag, static_cast<float>(strides[2])));
    const Numbers from = hn::ConvertTo(NumberTag(), hn::Add(hn::Add(cell[0], row), slice));
    const auto mix = [](Vector a, Vector b, Vector part)
    { return hn::Add(a, hn::Mul(part, hn::Sub(b, a))); };
    // Rows along x through the corners, from before the cell to behind it: y + 2 z.
    Vector rows[4][4];
    for (int number = 0; number < 4; ++number)
    {
      const float* const first =
        samples + (number & 1) * strides[1] + (number >> 1) * strides[2] - 1;
      GatherPairs<F>(first, from, rows[number][0], rows[number][1]);
      GatherPairs<F>(first + 2, from, rows[number][2], rows[number][3]);
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      const int u = axis == 0 ? 1 : 0;
      const int v = axis == 2 ? 1 : 2;
      const auto interpolate = [&](Vector a, Vector b, Vector c, Vector d)
      { return mix(mix(a, b, within[u]), mix(c, d, within[u]), within[v]); };
      // Planes from before the cell to behind it.
      Vector planes[4];
      for (int plane = 0; plane < 4; ++plane)
      {
        if (axis == 0)
        {
          planes[plane] =
            interpolate(rows[0][plane], rows[1][plane], rows[2][plane], rows[3][plane]);
          continue;
        }
        Vector edges[4];
        for (int side = 0; side < 2; ++side)
        {
          if (plane == 1 || plane == 2)
          {
            const Vector* const own = rows[(plane - 1) * axis + side * (3 - axis)];
            edges[2 * side] = own[1];
            edges[2 * side + 1] = own[2];
          }
          else
          {
            GatherPairs<F>(samples + (plane - 1) * strides[axis] + side * strides[3 - axis], from,
              edges[2 * side], edges[2 * side + 1]);
          }
        }
        planes[plane] = interpolate(edges[0], edges[1], edges[2], edges[3]);
      }
      // Next to samples that are not finite, the difference of two.
      const auto goOn = [&](Vector beyond, Vector near, Vector other)
      {
        const Mask isFinite = hn::Eq(hn::Sub(beyond, beyond), hn::Zero(tag));
        return hn::IfThenElse(isFinite, beyond, hn::Sub(hn::Add(near, near), other));
      };
      const Vector before = goOn(planes[0], planes[1], planes[2]);
      const Vector behind = goOn(planes[3], planes[2], planes[1]);
      gradient[axis] = mix(hn::Sub(planes[2], before), hn::Sub(behind, planes[1]), within[axis]);
    }
  }

  /// Finds the factors of emission and opacity (MediumPieces::EndShaded), as MediumLighting shades. Changes the size of
  /// the gradients. `arrives(lamp, channel)`: the part of a lamp's light that does; called if there are shadows.
  template <class Arrives>
  static HWY_INLINE void Shade(const MediumShading& shading, Vector gradient[3],
    const Vector toViewer[3], const Arrives& arrives, Vector ofEmission[3], Vector ofOpacity[3])
  {
    const F tag;
    const Vector zero = hn::Zero(tag);
    const auto dot = [](const Vector a[3], const Vector b[3])
    { return hn::Add(hn::Add(hn::Mul(a[0], b[0]), hn::Mul(a[1], b[1])), hn::Mul(a[2], b[2])); };
    const auto set = [&](const glm::vec3& from, Vector to[3])
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        to[axis] = hn::Set(tag, from[axis]);
      }
    };
    // A gradient of any size, within what squares can hold.
    const Vector largest =
      hn::Max(hn::Max(hn::Abs(gradient[0]), hn::Abs(gradient[1])), hn::Abs(gradient[2]));
    const Mask isThere = hn::Gt(largest, zero);
    const Vector unit =
      hn::Div(hn::Set(tag, 1.0f), hn::IfThenElse(isThere, largest, hn::Set(tag, 1.0f)));
    for (int axis = 0; axis < 3; ++axis)
    {
      gradient[axis] = hn::Mul(gradient[axis], unit);
    }
    Vector normal[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      Vector column[3];
      set(glm::row(shading.ToNormal, axis), column);
      normal[axis] = dot(column, gradient);
    }
    const Vector square = dot(normal, normal);
    const Mask hasNormal = hn::And(isThere, hn::Gt(square, zero));
    const Vector length = hn::Sqrt(hn::IfThenElse(hasNormal, square, hn::Set(tag, 1.0f)));
    for (Vector& part : normal)
    {
      part = hn::IfThenElseZero(hasNormal, hn::Div(part, length));
    }
    const Vector towardViewer = dot(normal, toViewer);
    set(shading.Ambient, ofEmission);
    set(shading.AmbientOpacity, ofOpacity);
    for (std::size_t number = 0; number < shading.Lamps.size(); ++number)
    {
      const MediumShading::Lamp& lamp = shading.Lamps[number];
      Vector diffuse[3];
      Vector specular[3];
      set(lamp.Diffuse, diffuse);
      set(lamp.Specular, specular);
      Vector direction[3];
      set(lamp.Direction, direction);
      Vector scattered[3] = { zero, zero, zero };
      if (shading.HasScattering)
      {
        set(lamp.Scattered, scattered);
        const Vector phase = GetPhase(shading.Anisotropy, dot(direction, toViewer));
        for (Vector& channel : scattered)
        {
          channel = hn::Mul(channel, phase);
        }
      }
      if (shading.HasShadows)
      {
        for (int channel = 0; channel < 3; ++channel)
        {
          const Vector arriving = arrives(number, channel);
          diffuse[channel] = hn::Mul(diffuse[channel], arriving);
          specular[channel] = hn::Mul(specular[channel], arriving);
          scattered[channel] = hn::Mul(scattered[channel], arriving);
        }
      }
      const Vector along = hn::Neg(dot(normal, direction));
      const Vector cosine = hn::Max(shading.TwoSided ? hn::Abs(along) : along, zero);
      for (int channel = 0; channel < 3; ++channel)
      {
        ofEmission[channel] = hn::Add(ofEmission[channel], hn::Mul(cosine, diffuse[channel]));
        if (shading.HasScattering)
        {
          ofEmission[channel] = hn::Add(ofEmission[channel], scattered[channel]);
        }
      }
      if (shading.HasHighlights)
      {
        const Vector twice = hn::Mul(hn::Add(along, along), towardViewer);
        const Vector highlight = hn::Add(dot(direction, toViewer), twice);
        const Mask shines = hn::And(hn::Gt(highlight, zero), hn::Gt(cosine, zero));
        const Vector power = hn::IfThenElseZero(shines, GetPower(highlight, shading.SpecularPower));
        for (int channel = 0; channel < 3; ++channel)
        {
          ofOpacity[channel] = hn::Add(ofOpacity[channel], hn::Mul(power, specular[channel]));
        }
      }
    }
  }

private:
  /// MediumLighting's, of Henyey and Greenstein.
  static HWY_INLINE Vector GetPhase(float anisotropy, Vector cosine)
  {
    const F tag;
    const float square = anisotropy * anisotropy;
    const Vector base =
      hn::Sub(hn::Set(tag, 1.0f + square), hn::Mul(hn::Set(tag, 2.0f * anisotropy), cosine));
    return hn::Div(hn::Set(tag, 1.0f - square), hn::Mul(base, hn::Sqrt(base)));
  }
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
