// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_PackedNormal_h
#define rt_PackedNormal_h

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <cstdint>

namespace rt
{

/// A unit vector, or none, in four bytes: coordinates with errors of up to 1/1000.
class PackedNormal
{
public:
  PackedNormal() = default;
  explicit PackedNormal(const glm::vec3& unit)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Bits |= static_cast<std::uint32_t>(std::lround(Most * unit[axis]) + Most)
        << Width * axis;
    }
  }

  bool IsNone() const { return this->Bits == 0; }
  /// The unit vector; not for none.
  glm::vec3 Get() const
  {
    glm::vec3 unit;
    for (int axis = 0; axis < 3; ++axis)
    {
      const auto bits = static_cast<int>((this->Bits >> Width * axis) & ((1u << Width) - 1u));
      unit[axis] = static_cast<float>(bits - Most) / Most;
    }
    return glm::normalize(unit);
  }

private:
  static constexpr int Width = 10; ///< bits
  static constexpr int Most = 511;

  std::uint32_t Bits = 0;
};

} // namespace rt

#endif
