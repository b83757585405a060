// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_ValueColors_h
#define rt_ValueColors_h

#include "DSMRayTracing/ray/RayMask.h"
#include "DSMRayTracing/surface/IsosurfaceLook.h"

#include <glm/vec4.hpp>

namespace rt
{

/// Finds the colors that `values` give, by a look, to those of a batch of places that are `wanted`; where the field
/// has no data, the color of what is not a number. `sampler`: reads values of the kind of field (LatticeSampler).
/// `isNearest`: no values between samples.
template <class Sampler, class Values, class Place>
void FindValueColors(const Sampler& sampler, const Values& values, const IsosurfaceLook& look,
  bool isNearest, const Place* places, RayMask wanted, glm::vec4* colors)
{
  const ColorMap& map = look.Colors;
  if (look.ColoredBy != IsosurfaceLook::Coloring::Values)
  {
    const RayMask found = sampler.FindColors(values, places, wanted, colors);
    ForEachRay(wanted & ~found, [&](int index) { colors[index] = map.NotANumber; });
    return;
  }
  double numbers[MaxRays];
  if (isNearest || map.Categories) // between categories, there is nothing
  {
    sampler.FindNearestValues(values, places, wanted, numbers);
  }
  else
  {
    sampler.FindValues(values, places, wanted, numbers);
  }
  ForEachRay(wanted, [&](int index) { colors[index] = map.Map(numbers[index]); });
}

} // namespace rt

#endif
