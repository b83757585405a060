// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_PackedColor_h
#define rt_PackedColor_h

#include <glm/vec4.hpp>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace rt
{

/// A color as a sample of a field: red, green, blue and opacity, in this order in memory, a byte each.
struct PackedColor
{
  static std::uint32_t Make(const std::uint8_t rgba[4])
  {
    std::uint32_t packed;
    std::memcpy(&packed, rgba, sizeof(packed));
    return packed;
  }
  /// The byte of a red, green, blue or opacity, which is clamped to [0, 1].
  static std::uint8_t ToByte(float value)
  {
    return static_cast<std::uint8_t>(255.0f * std::clamp(value, 0.0f, 1.0f) + 0.5f);
  }
  /// Each in [0, 1].
  static glm::vec4 Get(std::uint32_t packed)
  {
    std::uint8_t rgba[4];
    std::memcpy(rgba, &packed, sizeof(packed));
    return glm::vec4(rgba[0], rgba[1], rgba[2], rgba[3]) / 255.0f;
  }
};

} // namespace rt

#endif
