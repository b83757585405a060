// SPDX-License-Identifier: BSD-3-Clause
/// Differences between the versions of VTK, from 9.1 (as in Debian 12) to 9.6. No other file of
/// these modules tests the version.
#ifndef vtkDSMCompatibility_h
#define vtkDSMCompatibility_h

#include "vtkIdList.h"
#include "vtkInformationDoubleVectorKey.h"
#include "vtkPolygon.h"
#include "vtkProp.h"
#include "vtkProperty.h"
#include "vtkVersionMacros.h"

#include <type_traits>
#include <utility>

/// Override specifier of virtual methods that exist since 9.2: ranges of arrays without ghosts.
#if VTK_MAJOR_VERSION > 9 || VTK_MINOR_VERSION >= 2
#define vtkDSMOverrideSince92 override
#else
#define vtkDSMOverrideSince92
#endif

namespace vtkDSMCompatibility
{

/// Cuts a polygon into triangles, three of its corners' positions in the polygon each. False when it
/// degenerates. Since 9.4, VTK has another name for it, and since 9.6 no longer the old one.
template <class Polygon, class = void>
struct Triangulation
{
  static bool Make(Polygon* polygon, vtkIdList* corners)
  {
    return polygon->Triangulate(corners) != 0;
  }
};

template <class Polygon>
struct Triangulation<Polygon,
  std::void_t<decltype(std::declval<Polygon>().TriangulateLocalIds(0, nullptr))>>
{
  static bool Make(Polygon* polygon, vtkIdList* corners)
  {
    return polygon->TriangulateLocalIds(0, corners) != 0;
  }
};

inline bool Triangulate(vtkPolygon* polygon, vtkIdList* corners)
{
  return Triangulation<vtkPolygon>::Make(polygon, corners);
}

/// Edges have an opacity of their own since 9.3.
template <class Property, class = void>
struct EdgeOpacity
{
  static double Get(Property*) { return 1.0; }
};

template <class Property>
struct EdgeOpacity<Property, std::void_t<decltype(std::declval<Property>().GetEdgeOpacity())>>
{
  static double Get(Property* property) { return property->GetEdgeOpacity(); }
};

inline double GetEdgeOpacity(vtkProperty* property)
{
  return EdgeOpacity<vtkProperty>::Get(property);
}

/// Key of an actor's texture transform; it has another name since 9.6.
template <class Prop, class = void>
struct TextureTransform
{
  static auto* GetKey() { return Prop::GeneralTextureTransform(); }
};

template <class Prop>
struct TextureTransform<Prop, std::void_t<decltype(Prop::GENERAL_TEXTURE_TRANSFORM())>>
{
  static auto* GetKey() { return Prop::GENERAL_TEXTURE_TRANSFORM(); }
};

inline vtkInformationDoubleVectorKey* GetTextureTransformKey()
{
  return TextureTransform<vtkProp>::GetKey();
}

} // namespace vtkDSMCompatibility

#endif
