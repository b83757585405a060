// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Shading_h
#define rt_Shading_h

#include "DSMRayTracing/frame/Scene.h"

#include <glm/vec3.hpp>

#include <vector>

namespace rt
{

/// The colour, in [0, 1], that a surface sends to the viewer; the formula of VTK's OpenGL polydata
/// mapper (Phong, for any number of lights):
///
///   ambient + sum over lights of attenuation * light * (diffuse * N.L + specular * (R.V)^power)
///
/// World space. `normal` and `toViewer` are unit; the surface is lit on both sides, so the normal
/// is turned towards the viewer first. `surfaceColor` takes the place of the diffuse colour, and, as
/// in VTK, when it comes from an array (`fromArray`) also of the ambient one. Without lighting, or
/// without a light, the surface shows ambient + diffuse.
glm::vec3 Shade(const std::vector<Light>& lights, const Material& surface, const glm::dvec3& point,
  const glm::dvec3& normal, const glm::dvec3& toViewer, const glm::vec3& surfaceColor,
  bool fromArray);

} // namespace rt

#endif
