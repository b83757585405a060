// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SceneObject_h
#define rt_SceneObject_h

#include "DSMRayTracing/field/Fields.h"
#include "DSMRayTracing/mesh/MeshObject.h"
#include "DSMRayTracing/scene/OtherKind.h"
#include "DSMRayTracing/slice/SliceOf.h"
#include "DSMRayTracing/surface/IsosurfaceOf.h"

#include <variant>

namespace rt
{

using LatticeIsosurface = IsosurfaceOf<LatticeField>;
using LevelIsosurface = IsosurfaceOf<LevelField>;
using LatticeSlice = SliceOf<LatticeField>;
using LevelSlice = SliceOf<LevelField>;

template <class Fields>
struct ObjectKinds;
template <class... FieldTypes>
struct ObjectKinds<std::variant<FieldTypes...>>
{
  using Any =
    std::variant<IsosurfaceOf<FieldTypes>..., MeshObject, SliceOf<FieldTypes>..., OtherObject>;
};

/// An object of any kind: surfaces and slices of each kind of field, and meshes. A kind has
/// - a description with IsOpaque, AddTo, AddShapeTo and the name of
/// - its Tracer, an ObjectTracer for a store, whose header SceneTracers-inl.h includes.
/// Among surfaces that are equally near, that of the kind that comes first here is visible.
using SceneObject = ObjectKinds<AnyField>::Any;

} // namespace rt

#endif
