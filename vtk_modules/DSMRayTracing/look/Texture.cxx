// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/look/Texture.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace rt
{

namespace
{

/// Returns the texel at `place` in a row of `size` texels. `place` may be far outside, or NaN.
std::size_t Wrap(double place, int size, bool repeat)
{
  const double whole = std::floor(place);
  const double inside = repeat ? whole - size * std::floor(whole / size) : whole;
  return static_cast<std::size_t>(inside > 0.0 ? std::min<double>(inside, size - 1) : 0.0);
}

} // namespace

glm::vec4 Texture::GetTexel(double x, double y) const
{
  const std::size_t column = Wrap(x, this->Width, this->Repeat);
  const std::size_t row = Wrap(y, this->Height, this->Repeat);
  const std::uint8_t* texel =
    &this->Texels[4 * (row * static_cast<std::size_t>(this->Width) + column)];
  return glm::vec4(texel[0], texel[1], texel[2], texel[3]) / 255.0f;
}

glm::vec4 Texture::Sample(const glm::dvec2& coordinate) const
{
  if (this->Texels.empty())
  {
    return glm::vec4(1.0f);
  }
  const glm::dvec4 place = this->Transform * glm::dvec4(coordinate, 0.0, 1.0);
  const double x = place.x * this->Width;
  const double y = place.y * this->Height;
  if (!this->Interpolate)
  {
    return this->GetTexel(x, y);
  }
  const double left = std::floor(x - 0.5);
  const double bottom = std::floor(y - 0.5);
  const auto right = static_cast<float>(x - 0.5 - left);
  const auto up = static_cast<float>(y - 0.5 - bottom);
  return glm::mix(glm::mix(this->GetTexel(left, bottom), this->GetTexel(left + 1.0, bottom), right),
    glm::mix(this->GetTexel(left, bottom + 1.0), this->GetTexel(left + 1.0, bottom + 1.0), right),
    up);
}

} // namespace rt
