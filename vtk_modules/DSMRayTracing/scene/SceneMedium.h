// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SceneMedium_h
#define rt_SceneMedium_h

#include "DSMRayTracing/field/lattice/LatticeField.h"
#include "DSMRayTracing/field/levels/LevelField.h"
#include "DSMRayTracing/medium/ExtremumOf.h"
#include "DSMRayTracing/medium/MediumOf.h"
#include "DSMRayTracing/medium/SumOf.h"

#include <type_traits>
#include <variant>

namespace rt
{

using LatticeMedium = MediumOf<LatticeField>;
using LatticeExtremum = ExtremumOf<LatticeField>;
using LatticeSum = SumOf<LatticeField>;
using LevelMedium = MediumOf<LevelField>;
using LevelExtremum = ExtremumOf<LevelField>;
using LevelSum = SumOf<LevelField>;

/// The table of the kinds of media. A kind has
/// - a description, named here, with AddTo and the name of
/// - its Tracer, a MediumTracer for a store, whose header SceneTracers-inl.h includes.
using SceneMedium =
  std::variant<LatticeMedium, LatticeExtremum, LatticeSum, LevelMedium, LevelExtremum, LevelSum>;

/// True for a kind of medium that lies in layers along a ray, with other objects between them. The others show a
/// single value for each ray.
template <class Kind>
struct IsLayered : std::false_type
{
};
template <class FieldType>
struct IsLayered<MediumOf<FieldType>> : std::true_type
{
};
inline bool HasLayers(const SceneMedium& medium)
{
  return std::visit(
    [](const auto& kind) { return IsLayered<std::decay_t<decltype(kind)>>::value; }, medium);
}

} // namespace rt

#endif
