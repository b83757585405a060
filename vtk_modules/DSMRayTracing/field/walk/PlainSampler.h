// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_PlainSampler_h
#define rt_PlainSampler_h

#include "DSMRayTracing/ray/RayMask.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace rt
{

/// Base of a field's Sampler, which brings FindValues and FindGradients (Field.h), and may replace the rest. All
/// batches have as many as MaxRays.
template <class FieldType, class SamplerType>
class PlainSampler
{
public:
  /// Finds the place of a point in world space; false where the field is not.
  bool FindPlace(
    const FieldType& field, const glm::dvec3& point, typename FieldType::Place& place) const
  {
    return field.FindPlace(point, place) &&
      this->Get().FindPlaces(field.GetValues(), &place, 1) != 0;
  }

  /// Completes places that FieldType::FindPlace has found; returns those that are in the field.
  template <class Values, class Place>
  RayMask FindPlaces(const Values&, Place*, RayMask wanted) const
  {
    return wanted;
  }

  /// FindValues, but the value of the nearest sample.
  template <class Values, class Place>
  RayMask FindNearestValues(
    const Values& values, const Place* places, RayMask wanted, double* numbers) const
  {
    return this->Get().FindValues(values, places, wanted, numbers);
  }

  /// The gradients at points in world space by which surfaces and media are shaded; untouched where the field is not.
  void FindSmoothGradients(const FieldType& field, const std::vector<glm::dvec3>& points,
    std::vector<glm::dvec3>& gradients) const
  {
    for (std::size_t first = 0; first < points.size(); first += MaxRays)
    {
      const std::size_t count = std::min<std::size_t>(MaxRays, points.size() - first);
      typename FieldType::Place places[MaxRays];
      const RayMask there = FindRays(~RayMask{ 0 } >> (MaxRays - count),
        [&](int index)
        {
          return this->Get().FindPlace(
            field, points[first + static_cast<std::size_t>(index)], places[index]);
        });
      this->Get().FindGradients(field.GetValues(), places, there, &gradients[first]);
    }
  }

  /// Values that are colors (PackedColor); returns the places that have any.
  template <class Values, class Place>
  RayMask FindColors(const Values&, const Place*, RayMask, glm::vec4*) const
  {
    return 0;
  }

private:
  const SamplerType& Get() const { return static_cast<const SamplerType&>(*this); }
};

} // namespace rt

#endif
