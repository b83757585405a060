// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Fields_h
#define rt_Fields_h

#include "DSMRayTracing/field/lattice/LatticeField.h"
#include "DSMRayTracing/field/levels/LevelField.h"

#include <variant>

namespace rt
{

/// A field of any kind: the one list of the kinds of fields.
using AnyField = std::variant<LatticeField, LevelField>;

} // namespace rt

#endif
