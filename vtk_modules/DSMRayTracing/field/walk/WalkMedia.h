// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_WalkMedia_h
#define rt_WalkMedia_h

#include "DSMRayTracing/field/MediumTolerance.h"
#include "DSMRayTracing/field/ValuePredicates.h"
#include "DSMRayTracing/field/walk/WalkSearch.h"
#include "DSMRayTracing/look/TransferFunction.h"
#include "DSMRayTracing/ray/MediumLight.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayMask.h"

#include <algorithm>
#include <cmath>

namespace rt
{

/// Takes rays through a medium whose values are a field's by the field's Walk; see LatticeMedia.
template <class FieldType, class Store>
class WalkMedia : public WalkSearch<FieldType, Store>
{
public:
  using WalkSearch<FieldType, Store>::WalkSearch;

  static bool CanShade(const FieldType&) { return false; }

  RayMask March(const FieldType& field, const TransferFunction& function, ObjectBeam*,
    const Ray* rays, RayMask wanted, MediumLight& light) const
  {
    return this->FindEach(
      field, rays, wanted, [&](RayMask) { return TransferPredicate(function); },
      [&](int ray, const Segment& segment) { return Pass(segment, function, ray, light); });
  }

private:
  using typename WalkSearch<FieldType, Store>::Segment;
  static constexpr double MostPieces = 65536.0;

  /// Cuts a segment into pieces in which values are nearly linear, as far as the function makes a difference, and
  /// integrates each over its values. Returns whether the ray is dark then.
  static bool Pass(
    const Segment& segment, const TransferFunction& function, int ray, MediumLight& light)
  {
    const double length = (segment.Exit - segment.Enter) * light.Length[ray];
    const double count = CountPieces(segment, function, length, light.JoinedLength);
    Lanes slope;
    double place = function.GetPlace(segment.Values.Coefficients[0]);
    Lanes integral = function.Integrate(place, slope);
    for (double number = 0.0; number < count && !light.IsDark(ray); ++number)
    {
      const double begin = number / count;
      const double end = (number + 1.0) / count;
      const double next =
        function.GetPlace(end < 1.0 ? segment.Values.Evaluate(end) : segment.Last);
      const double way = next - place;
      const Lanes before = integral;
      integral = function.Integrate(next, slope);
      const Lanes amount = std::abs(way) <= MediumTolerance::ShortWay
        ? slope * Lanes(length / count)
        : (integral - before) * Lanes(length / count / way);
      MediumPiece piece{ segment.GetT(begin), segment.GetT(end), amount };
      if (light.KeepsValues)
      {
        const double middle = function.GetPlace(segment.Values.Evaluate(0.5 * (begin + end)));
        piece.Values[0] = static_cast<float>(place);
        piece.Values[1] = static_cast<float>(middle);
        piece.Values[2] = static_cast<float>(next);
      }
      light.Add(ray, piece);
      place = next;
    }
    return light.IsDark(ray);
  }

  /// `joinedLength`: MediumLight::JoinedLength.
  static double CountPieces(
    const Segment& segment, const TransferFunction& function, double length, double joinedLength)
  {
    const double scale = function.GetScale();
    const double* const cubic = segment.Values.Coefficients;
    const auto behavior = function.FindBehavior(
      function.GetPlace(segment.Range.First), function.GetPlace(segment.Range.Last));
    const double bend =
      scale * std::max(std::abs(2.0 * cubic[2]), std::abs(2.0 * cubic[2] + 6.0 * cubic[3]));
    const double range = scale * (std::abs(cubic[1]) + std::abs(cubic[2]) + std::abs(cubic[3]));
    const double curved = length * bend * behavior.Change / (8.0 * MediumTolerance::Depth);
    const double deep =
      length * behavior.Extinction * behavior.Tinge * range / (12.0 * MediumTolerance::Color);
    // Errors of a few long segments do not even out as those of many cells.
    double count = 2.0 * std::sqrt(std::max(curved, deep));
    if (joinedLength > 0.0)
    {
      // Pieces are described one by one, and light changes along the way.
      const double most =
        std::max(1.0 / joinedLength, behavior.Extinction * MediumTolerance::DescribedPieces);
      count = std::max(count, length * most);
    }
    return std::clamp(std::ceil(count), 1.0, MostPieces);
  }
};

} // namespace rt

#endif
