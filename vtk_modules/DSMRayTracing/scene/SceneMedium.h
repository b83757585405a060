// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SceneMedium_h
#define rt_SceneMedium_h

#include "DSMRayTracing/field/Fields.h"
#include "DSMRayTracing/medium/ExtremumOf.h"
#include "DSMRayTracing/medium/IntegralOf.h"
#include "DSMRayTracing/medium/MediumOf.h"
#include "DSMRayTracing/medium/SumOf.h"
#include "DSMRayTracing/scene/OtherKind.h"

#include <variant>

namespace rt
{

using LatticeMedium = MediumOf<LatticeField>;
using LatticeExtremum = ExtremumOf<LatticeField>;
using LatticeSum = SumOf<LatticeField>;
using LatticeIntegral = IntegralOf<LatticeField>;
using LevelMedium = MediumOf<LevelField>;
using LevelExtremum = ExtremumOf<LevelField>;
using LevelSum = SumOf<LevelField>;
using LevelIntegral = IntegralOf<LevelField>;

template <class Fields>
struct MediumKinds;
template <class... FieldTypes>
struct MediumKinds<std::variant<FieldTypes...>>
{
  using Any = std::variant<MediumOf<FieldTypes>..., ExtremumOf<FieldTypes>..., SumOf<FieldTypes>...,
    IntegralOf<FieldTypes>..., OtherMedium>;
};

/// A medium of any kind, for each kind of field. A kind has
/// - a description with AddTo, IsLayered and the name of
/// - its Tracer, a MediumTracer for a store, in the same header.
using SceneMedium = MediumKinds<AnyField>::Any;

/// Returns whether a medium lies in layers along a ray, between which other things may be. The others show a single
/// value of each ray.
inline bool HasLayers(const SceneMedium& medium)
{
  return std::visit([](const auto& kind) { return kind.IsLayered(); }, medium);
}

/// Returns whether a medium has integrals of values, for ChannelSet::Integral.
inline bool HasIntegrals(const SceneMedium& medium)
{
  return std::visit([](const auto& kind) { return HasIntegrals(kind); }, medium);
}

} // namespace rt

#endif
