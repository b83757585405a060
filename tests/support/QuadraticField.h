// SPDX-License-Identifier: BSD-3-Clause
#ifndef QuadraticField_h
#define QuadraticField_h

#include "DSMCore/table/ReplicatedStore.h"
#include "DSMRayTracing/field/Field.h"
#include "DSMRayTracing/field/FieldCheck.h"
#include "DSMRayTracing/field/walk/PlainSampler.h"
#include "DSMRayTracing/field/walk/WalkExtrema.h"
#include "DSMRayTracing/field/walk/WalkMedia.h"
#include "DSMRayTracing/field/walk/WalkSections.h"
#include "DSMRayTracing/field/walk/WalkSurfaces.h"
#include "DSMRayTracing/object/ObjectDigest.h"
#include "DSMRayTracing/ray/Ray.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

/// Constant + dot(Linear, p) + dot(Square, p * p) in [-1, 1]^3: along a ray, a polynomial.
struct Quadratic
{
  double Constant = 0.0;
  glm::dvec3 Linear{ 0.0 };
  glm::dvec3 Square{ 0.0 };

  double Evaluate(const glm::dvec3& p) const
  {
    return this->Constant + glm::dot(this->Linear, p) + glm::dot(this->Square, p * p);
  }
  glm::dvec3 GetGradient(const glm::dvec3& p) const
  {
    return this->Linear + 2.0 * this->Square * p;
  }

  /// The part of [ray.Min, ray.Max] that is in the box; false if none is.
  static bool FindWay(const rt::Ray& ray, double& first, double& last)
  {
    first = ray.Min;
    last = ray.Max;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double low = (-1.0 - ray.Origin[axis]) / ray.Direction[axis];
      const double high = (1.0 - ray.Origin[axis]) / ray.Direction[axis];
      first = std::max(first, std::min(low, high));
      last = std::min(last, std::max(low, high));
    }
    return first < last;
  }
};

/// A kind of field that no list names: a function, without bricks, that has a walk and a sampler only.
struct QuadraticField : rt::WalkedField<QuadraticField>
{
  using Values = Quadratic;
  struct Place
  {
    glm::dvec3 Point;
  };
  template <class Store>
  class Walk;
  template <class Store>
  class Sampler;

  /// Stands for the length of a cell.
  static constexpr double Detail = 1.0 / 16.0;

  std::shared_ptr<const Quadratic> Function;
  const Quadratic& GetValues() const { return *this->Function; }

  bool FindPlace(const glm::dvec3& point, Place& place) const
  {
    place.Point = glm::clamp(point, -1.0, 1.0);
    return glm::distance(point, place.Point) < 1e-9;
  }
  void MovePlace(const glm::dvec3& point, Place& place) const { place.Point = point; }
  glm::dvec3 GetNormal(const glm::dvec3& gradient, const glm::dvec3& rayDirection) const
  {
    return gradient == glm::dvec3(0.0) ? -glm::normalize(rayDirection) : -glm::normalize(gradient);
  }
  double GetFinestLength(const glm::dmat3& worldToSpace = glm::dmat3(1.0)) const
  {
    return Detail * glm::length(worldToSpace[0]);
  }
  double GetGrowth(const glm::dvec3& gradient) const { return Detail * glm::length(gradient); }
  void AddTo(rt::ObjectDigest& digest) const { AddTo(digest, *this->Function); }
  static void AddTo(rt::ObjectDigest& digest, const Quadratic& function) { digest.Add(function); }
  static bool HasHoles(const Quadratic&) { return false; }
};

/// Cuts the way of a ray into parts, as cells do.
template <class Store>
class QuadraticField::Walk
{
public:
  Walk(Store&, typename Store::Worker&) {}

  template <class Predicate, class Visit>
  bool Find(const QuadraticField& field, const rt::Ray& ray, const Predicate& mayHold,
    const Visit& visit) const
  {
    constexpr int parts = 5;
    double first;
    double last;
    bool found = false;
    const bool isMet = Quadratic::FindWay(ray, first, last);
    for (int part = 0; isMet && !found && part < parts; ++part)
    {
      const auto getT = [&](int end) { return first + (last - first) * end / parts; };
      const auto segment = Create(*field.Function, ray, getT(part), getT(part + 1));
      found = mayHold(segment.Range) && visit(segment);
    }
    return found;
  }

private:
  static rt::FieldSegment<Place> Create(
    const Quadratic& function, const rt::Ray& ray, double enter, double exit)
  {
    const auto getPoint = [&](double t) { return ray.Origin + t * ray.Direction; };
    const glm::dvec3 way = (exit - enter) * ray.Direction;
    const double begin = function.Evaluate(getPoint(enter));
    const double end = function.Evaluate(getPoint(exit));
    const double square = glm::dot(function.Square, way * way);
    const rt::Cubic cubic{ { begin, end - begin - square, square, 0.0 } };
    double parts[2];
    const bool isBent = rt::FindExtrema(cubic, parts) == 1;
    const double between = isBent ? cubic.Evaluate(parts[0]) : begin;
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const auto least = static_cast<float>(std::min({ begin, between, end }));
    const auto most = static_cast<float>(std::max({ begin, between, end }));
    return { enter, exit, cubic, end,
      { std::nextafter(least, -infinity), std::nextafter(most, infinity) }, { getPoint(enter) } };
  }
};

template <class Store>
class QuadraticField::Sampler : public rt::PlainSampler<QuadraticField, Sampler<Store>>
{
public:
  Sampler(Store&, typename Store::Worker&) {}

  rt::RayMask FindValues(
    const Quadratic& function, const Place* places, rt::RayMask wanted, double* values) const
  {
    rt::ForEachRay(
      wanted, [&](int index) { values[index] = function.Evaluate(places[index].Point); });
    return wanted;
  }
  void FindGradients(
    const Quadratic& function, const Place* places, rt::RayMask wanted, glm::dvec3* gradients) const
  {
    rt::ForEachRay(
      wanted, [&](int index) { gradients[index] = function.GetGradient(places[index].Point); });
  }
};

static_assert(
  rt::FieldCheck<QuadraticField>::HasSearches<dsm::ReplicatedStore>(), "one store stands for all");

#endif
