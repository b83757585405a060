// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SceneMedium_h
#define rt_SceneMedium_h

#include "DSMRayTracing/field/lattice/LatticeField.h"
#include "DSMRayTracing/field/levels/LevelField.h"
#include "DSMRayTracing/medium/ExtremumOf.h"
#include "DSMRayTracing/medium/MediumOf.h"
#include "DSMRayTracing/medium/SumOf.h"

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

} // namespace rt

#endif
