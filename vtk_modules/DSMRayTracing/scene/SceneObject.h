// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SceneObject_h
#define rt_SceneObject_h

#include "DSMRayTracing/field/lattice/LatticeField.h"
#include "DSMRayTracing/field/levels/LevelField.h"
#include "DSMRayTracing/mesh/MeshObject.h"
#include "DSMRayTracing/slice/SliceOf.h"
#include "DSMRayTracing/surface/IsosurfaceOf.h"

#include <variant>

namespace rt
{

using LatticeIsosurface = IsosurfaceOf<LatticeField>;
using LevelIsosurface = IsosurfaceOf<LevelField>;
using LatticeSlice = SliceOf<LatticeField>;
using LevelSlice = SliceOf<LevelField>;

/// The table of the kinds of objects. A kind has
/// - a description, named here, with IsOpaque, AddTo and the name of
/// - its Tracer, an ObjectTracer for a store, whose header SceneTracers-inl.h includes.
/// Among surfaces that are equally near, that of the kind that comes first here is visible.
using SceneObject =
  std::variant<LatticeIsosurface, LevelIsosurface, MeshObject, LatticeSlice, LevelSlice>;

} // namespace rt

#endif
