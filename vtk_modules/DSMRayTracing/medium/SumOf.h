// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SumOf_h
#define rt_SumOf_h

#include "DSMRayTracing/look/TransferFunction.h"
#include "DSMRayTracing/medium/MediumSheet.h"
#include "DSMRayTracing/object/MediumTracer.h"
#include "DSMRayTracing/object/ObjectDigest.h"
#include "DSMRayTracing/ray/ClipRegion.h"

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

namespace rt
{

template <class FieldType, class Store>
class FieldSumTracer;

/// A function of a field's values, summed up along a ray, or its mean there, shown as an opaque gray where the ray
/// first meets values that count: a kind of medium for each kind of field (Field.h).
template <class FieldType>
struct SumOf
{
  template <class Store>
  using Tracer = FieldSumTracer<FieldType, Store>;

  FieldType Field;
  std::shared_ptr<const TransferFunction> Function; ///< from CreateFunction; not null
  bool IsMean = false;
  ClipRegion Clipping;
  /// From world space to that in which the function measures lengths; the linear part.
  glm::dmat3 WorldToSpace{ 1.0 };

  /// Values of which the weight is 0 do not count.
  struct Sample
  {
    double Value;
    double Weight; ///< weight in the mean: 0 or 1
  };
  /// A sample as the look of a medium; values are sums over a unit of length. A medium that
  /// takes nothing away adds up what it emits. It is one of some extinction, though, where it counts.
  static glm::dvec4 ToLook(const Sample& sample, double unit)
  {
    constexpr double depth = 1e-15;
    return { sample.Value / depth, sample.Weight / depth, 0.0, sample.Weight * depth / unit };
  }
  /// `samples`: as TransferFunction has them.
  static std::shared_ptr<const TransferFunction> CreateFunction(
    double first, double last, const std::vector<Sample>& samples, double unit)
  {
    std::vector<glm::dvec4> all;
    for (const Sample& sample : samples)
    {
      all.push_back(ToLook(sample, unit));
    }
    return std::make_shared<const TransferFunction>(first, last, all);
  }

  /// See HasLayers.
  static constexpr bool IsLayered() { return false; }

  /// All that a picture of it depends on.
  void AddTo(ObjectDigest& digest) const
  {
    this->Field.AddTo(digest);
    digest.Add(this->Function->GetDigest());
    digest.Add(this->WorldToSpace);
    digest.Add(this->IsMean);
    digest.Add(this->Clipping);
  }
};

/// Such a medium for rays.
template <class FieldType, class Store>
class FieldSumTracer final : public MediumTracer
{
public:
  /// Keeps references.
  FieldSumTracer(Store& store, typename Store::Worker& worker, const SumOf<FieldType>& medium)
    : Medium(medium)
    , Media(store, worker)
    , Cell(medium.Field.GetFinestLength())
    , ErrorFactor(1.0 /
        (LargeSum * medium.Field.GetFinestLength(medium.WorldToSpace) *
          std::max(medium.Function->GetBrightest(), std::numeric_limits<double>::min())))
  {
  }

  std::unique_ptr<ObjectBeam> FindBeam(const Ray corners[4]) const override
  {
    return this->Media.FindBeam(this->Medium.Field, *this->Medium.Function, corners);
  }

  bool Prefetch(const ObjectBeam& beam, std::size_t count) const override
  {
    return this->Media.Prefetch(this->Medium.Field, beam, count);
  }

  bool DimsLamps() const override { return false; }

  ObjectTracer::Brick FindBrick(const glm::dvec3& place) const override
  {
    return this->Medium.Field.FindBrick(place);
  }

  RayMask March(
    const Ray* rays, RayMask wanted, ObjectBeam* beam, MediumLight& light) const override
  {
    const auto sums = std::make_unique<MediumLight>();
    sums->Begin(rays, wanted);
    sums->SetSpace(rays, wanted, this->Medium.WorldToSpace);
    sums->ErrorFactor = this->ErrorFactor;
    this->Medium.Clipping.SearchParts(rays, wanted,
      [&](const Ray* parts, RayMask some)
      {
        return this->Media.March(this->Medium.Field, *this->Medium.Function, beam, parts,
          FindThickParts(parts, some, this->Cell), *sums);
      });
    const RayMask found = FindRays(wanted, [&](int ray) { return !std::isinf(sums->First[ray]); });
    ForEachRay(found,
      [&](int ray)
      {
        const glm::dvec3 sum = sums->GetColor(ray);
        const double gray = std::clamp(this->Medium.IsMean ? sum.x / sum.y : sum.x, 0.0, 1.0);
        AddSheet(light, ray, sums->First[ray], glm::dvec3(gray), 1.0);
      });
    return FindRays(found, [&](int ray) { return light.IsDark(ray); });
  }

private:
  const SumOf<FieldType>& Medium;
  typename FieldType::template Media<Store> Media;
  double Cell; ///< for FindThickParts
  /// Errors count beside the sum over so many cells with the largest value.
  static constexpr double LargeSum = 8.0;
  double ErrorFactor; ///< MediumLight::ErrorFactor
};

} // namespace rt

#endif
