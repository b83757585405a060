// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/PixelRays.h"

#include "DSMCore/base/Error.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace rt
{

bool PixelRays::CanBeMade(const glm::dmat4& worldToClip)
{
  const glm::dmat4 inverse = glm::inverse(worldToClip);
  bool isFinite = true;
  for (int column = 0; column < 4; ++column)
  {
    for (int row = 0; row < 4; ++row)
    {
      isFinite = isFinite && std::isfinite(inverse[column][row]);
    }
  }
  return isFinite;
}

PixelRays::PixelRays(const FrameRequest& request)
  : PixelWidth(2.0 / request.Width)
  , PixelHeight(2.0 / request.Height)
  , WorldToClip(request.WorldToClip)
  , ClipToWorld(glm::inverse(request.WorldToClip))
  , Width(request.Width)
  , Height(request.Height)
  , Limits(request.Limits)
  , MediumCuts(request.MediumCuts)
{
  if (!CanBeMade(this->WorldToClip))
  {
    throw dsm::Error("The camera's matrix cannot be inverted. Reset the camera.");
  }
  this->View.PixelSize = static_cast<float>(request.PixelSize);
  for (int column = 0; column < 4; ++column)
  {
    const glm::dvec4& clip = this->WorldToClip[column];
    this->View.WorldToPixels[column] = { (clip.x + clip.w) / this->PixelWidth,
      (clip.y + clip.w) / this->PixelHeight, clip.w };
  }
}

Ray PixelRays::GetRay(int x, int y, const glm::dvec2& position) const
{
  const double clipX = (x + position.x) * this->PixelWidth - 1.0;
  const double clipY = (y + position.y) * this->PixelHeight - 1.0;
  const glm::dvec4 base =
    this->ClipToWorld[0] * clipX + this->ClipToWorld[1] * clipY + this->ClipToWorld[3];
  const glm::dvec4 nearPoint = base - this->ClipToWorld[2];
  const glm::dvec4 farPoint = base + this->ClipToWorld[2];
  Ray ray;
  ray.Origin = glm::dvec3(nearPoint) * (1.0 / nearPoint.w);
  ray.Direction = glm::dvec3(farPoint) * (1.0 / farPoint.w) - ray.Origin;
  ray.Min = 0.0;
  ray.Max = Last;
  // Beams look beyond the picture's last pixels.
  if (this->Limits && x < this->Width)
  {
    const std::size_t pixel = static_cast<std::size_t>(y) * this->Width + x;
    const float depth = pixel < this->Limits->size() ? (*this->Limits)[pixel] : 1.0f;
    if (depth < 1.0f)
    {
      const glm::dvec4 end = base + this->ClipToWorld[2] * (2.0 * static_cast<double>(depth) - 1.0);
      const glm::dvec3 way = glm::dvec3(end) * (1.0 / end.w) - ray.Origin;
      ray.Max = glm::dot(way, ray.Direction) / glm::dot(ray.Direction, ray.Direction);
    }
  }
  return ray;
}

double PixelRays::FindMediumCut(const Ray& ray, const glm::ivec2& pixel) const
{
  const auto getW = [&](const glm::dvec3& point)
  {
    const glm::dmat4& matrix = this->WorldToClip;
    return matrix[0][3] * point.x + matrix[1][3] * point.y + matrix[2][3] * point.z + matrix[3][3];
  };
  const double nearW = getW(ray.Origin);
  const double farW = getW(ray.Origin + ray.Direction);
  const std::vector<float>& cuts = *this->MediumCuts;
  const std::size_t pixels = static_cast<std::size_t>(this->Width) * this->Height;
  for (std::size_t place = static_cast<std::size_t>(pixel.y) * this->Width + pixel.x;
       place < cuts.size() && cuts[place] < 1.0f; place += pixels)
  {
    const double depth = cuts[place];
    const double t = depth * nearW / ((1.0 - depth) * farW + depth * nearW);
    if (t > ray.Min)
    {
      return t;
    }
  }
  return std::numeric_limits<double>::infinity();
}

float PixelRays::GetDepth(const glm::dvec3& point) const
{
  const glm::dvec4 clip = this->WorldToClip * glm::dvec4(point, 1.0);
  return static_cast<float>(std::clamp(0.5 * clip.z / clip.w + 0.5, 0.0, 1.0));
}

} // namespace rt
