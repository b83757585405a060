// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Scene_h
#define rt_Scene_h

#include "DSMCore/BlockSegment.h"
#include "DSMRayTracing/accel/MacrocellHierarchy.h"
#include "DSMRayTracing/brick/BrickLattice.h"
#include "DSMRayTracing/frame/DebugView.h"
#include "DSMRayTracing/frame/Texture.h"
#include "DSMRayTracing/kernel/ClipRegion.h"
#include "DSMRayTracing/kernel/MeshInstance.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <memory>
#include <optional>
#include <vector>

namespace rt
{

/// One array of a volume, in bricks. Shared by all that draw it.
struct VoxelField
{
  BrickLattice Lattice;
  std::shared_ptr<dsm::BlockSegment> Segment;
  MacrocellHierarchy Hierarchy;
};

/// A sampled colour map. Colours are linear in the value between First and Last, entry 0 belonging
/// to First; nearest entry. Not premultiplied.
struct ColorMap
{
  double First = 0.0;
  double Last = 1.0;
  /// The table is spaced evenly in log10 of the value.
  bool Logarithmic = false;
  std::vector<glm::vec4> Table;
  glm::vec4 Below{ 0.0f };
  glm::vec4 Above{ 0.0f };
  glm::vec4 NotANumber{ 0.0f };

  glm::vec4 Map(double value) const;
};

/// As vtkProperty: colours in [0, 1], coefficients as there.
struct Material
{
  float Ambient = 0.0f;
  float Diffuse = 1.0f;
  float Specular = 0.0f;
  float SpecularPower = 1.0f;
  glm::vec3 AmbientColor{ 1.0f };
  glm::vec3 DiffuseColor{ 1.0f };
  glm::vec3 SpecularColor{ 1.0f };
  float Opacity = 1.0f;
  /// Part of the light that is mirrored; the rest is the surface's own colour.
  float Reflectivity = 0.0f;
  /// Off: the surface shows its colour as it is.
  bool Lighting = true;
};

/// Isosurfaces of one volume.
struct IsosurfaceObject
{
  /// Point index space (sample (i,j,k) at (i,j,k) of the lattice) to world; affine, invertible.
  glm::dmat4 IndexToWorld{ 1.0 };
  /// Its inverse; SetIndexToWorld keeps the two together.
  glm::dmat4 WorldToIndex{ 1.0 };
  void SetIndexToWorld(const glm::dmat4& matrix)
  {
    this->IndexToWorld = matrix;
    this->WorldToIndex = glm::inverse(matrix);
  }
  std::shared_ptr<const VoxelField> Field;
  /// Ascending, finite, no duplicates.
  std::vector<double> Isovalues;
  /// One for each isovalue, times the material's; empty: 1.
  std::vector<float> Opacities;
  /// May be null: then the material's diffuse colour is used. Same lattice points as Field.
  std::shared_ptr<const VoxelField> ColorField;
  ColorMap Colors;
  Material Surface;
  ClipRegion Clipping;
};

/// Lines along the edges of a mesh's polygons, as VTK draws them on a surface: they take their share
/// of the triangles beside them, and are not lit.
struct EdgeLines
{
  glm::vec3 Color{ 0.0f };
  /// Pixels, of both triangles beside an edge together.
  float Width = 1.0f;
  float Opacity = 1.0f; ///< over the surface
};

/// The triangles of one mesh at one place.
struct MeshObject
{
  /// Where a point of the surface has its colour from.
  enum class Coloring
  {
    Material,     ///< the diffuse colour
    Values,       ///< the colour of the interpolated value
    CornerValues, ///< the interpolated colours of the corners' values
    Colors        ///< the mesh's own colours
  };
  std::shared_ptr<const MeshInstance> Instance;
  Coloring ColoredBy = Coloring::Material;
  /// Of the values; not null when they give the colour.
  std::shared_ptr<const ColorMap> Colors;
  /// Times the colour, where the mesh has texture coordinates; may be null.
  std::shared_ptr<const Texture> Picture;
  /// Shaded by the triangles' planes, also where points have normals.
  bool Flat = false;
  Material Surface;
  /// Of the side from which a triangle's corners are clockwise; without, both sides are alike.
  std::optional<Material> BackSurface;
  std::optional<EdgeLines> Edges;
  ClipRegion Clipping;
};

/// World space. Colour includes the intensity.
struct Light
{
  enum class Kind
  {
    Directional,
    Positional,
    Cone
  };
  Kind Type = Kind::Directional;
  /// The scene's only light, and it shines along the view: as VTK, the highlight is then a power of
  /// the light's angle, not of the mirrored light's.
  bool IsLoneHeadlight = false;
  glm::dvec3 Position{ 0.0 };
  /// Unit, from the light into the scene.
  glm::dvec3 Direction{ 0.0, 0.0, -1.0 };
  glm::vec3 Color{ 1.0f };
  /// Cosine of the cone's half angle, exponent of the fall-off within it, and constant, linear and
  /// quadratic attenuation, as in vtkLight.
  float ConeCosine = 0.0f;
  float Exponent = 1.0f;
  glm::vec3 Attenuation{ 1.0f, 0.0f, 0.0f };
};

/// Light that comes from everywhere, a gradient from below to above. World space.
struct Environment
{
  glm::dvec3 Up{ 0.0, 1.0, 0.0 }; ///< unit
  /// Of the directions straight down and straight up; in between by the cosine. Black: none.
  glm::vec3 Lower{ 0.0f };
  glm::vec3 Upper{ 0.0f };

  bool IsBlack() const { return this->Lower == glm::vec3(0.0f) && this->Upper == glm::vec3(0.0f); }
  /// From a unit direction.
  glm::dvec3 GetLight(const glm::dvec3& from) const
  {
    return glm::mix(
      glm::dvec3(this->Lower), glm::dvec3(this->Upper), 0.5 + 0.5 * glm::dot(from, this->Up));
  }
  /// That all directions over a surface with this unit normal send it, weighted by the cosine, were
  /// nothing in between.
  glm::dvec3 GetLightOnto(const glm::dvec3& normal) const
  {
    // The weighted mean of the directions is two thirds of the normal.
    return this->GetLight(2.0 / 3.0 * normal);
  }
};

/// What is done beyond the first hit of each ray.
struct LightTransport
{
  bool Shadows = false;
  /// Apparent radius of every light: the tangent of half the angle that it fills as seen from a
  /// surface; 0 gives hard shadows.
  double LightRadius = 0.0;
  /// Rays for each hit and sample of the pixel; 0 switches ambient occlusion off.
  int AmbientOcclusionSamples = 0;
  /// World units; what is farther away does not occlude.
  double AmbientOcclusionDistance = 0.0;
  /// Is occluded by what ambient occlusion's rays meet.
  Environment Surroundings;
  /// How often a ray may be mirrored.
  int MaxBounces = 1;
  /// What a mirrored ray sees where it meets nothing.
  glm::vec3 Background{ 0.0f };
};

/// All that one frame shows.
struct Scene
{
  std::vector<IsosurfaceObject> Isosurfaces;
  std::vector<MeshObject> Meshes;
  std::vector<Light> Lights;
  LightTransport Transport;
  DebugView View = DebugView::Off;
};

} // namespace rt

#endif
