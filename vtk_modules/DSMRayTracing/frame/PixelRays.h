// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_PixelRays_h
#define rt_PixelRays_h

#include "DSMRayTracing/frame/FrameRequest.h"
#include "DSMRayTracing/object/PictureView.h"
#include "DSMRayTracing/ray/Ray.h"

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include <memory>
#include <vector>

namespace rt
{

/// Makes a pixel's ray, and a hit's depth, out of the world-to-clip matrix alone; so perspective,
/// parallel and oblique cameras need no cases.
class PixelRays
{
public:
  /// Returns whether the matrix can be inverted.
  static bool CanBeMade(const glm::dmat4& worldToClip);
  /// Throws dsm::Error when it cannot.
  explicit PixelRays(const FrameRequest& request);

  /// T at the far plane.
  static constexpr double Last = 1.0;

  /// World space, from the near plane (T = 0) to the far plane (T = Last), or to where FrameRequest::Limits end it.
  /// `position` in the pixel is in [0, 1), its center being at one half.
  Ray GetRay(int x, int y, const glm::dvec2& position = glm::dvec2(0.5)) const;

  /// Max of such a ray.
  double GetEnd(int x, int y, const glm::dvec2& position) const
  {
    return this->Limits ? this->GetRay(x, y, position).Max : Last;
  }

  bool HasMediumCuts() const { return this->MediumCuts != nullptr; }
  /// T where a pixel's ray meets the next of FrameRequest::MediumCuts beyond its Min; infinite: there is none.
  double FindMediumCut(const Ray& ray, const glm::ivec2& pixel) const;

  /// OpenGL window depth in [0, 1] of a world point.
  float GetDepth(const glm::dvec3& point) const;

  /// Returns the projection of world points to the image.
  const PictureView& GetView() const { return this->View; }

private:
  double PixelWidth;
  double PixelHeight;
  glm::dmat4 WorldToClip;
  glm::dmat4 ClipToWorld;
  PictureView View;
  int Width;
  int Height;
  std::shared_ptr<const std::vector<float>> Limits;     ///< from FrameRequest
  std::shared_ptr<const std::vector<float>> MediumCuts; ///< from FrameRequest
};

} // namespace rt

#endif
