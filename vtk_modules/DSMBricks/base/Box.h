// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_Box_h
#define bricks_Box_h

#include <glm/common.hpp>
#include <glm/ext/vector_int3_sized.hpp>
#include <glm/vec3.hpp>
#include <glm/vector_relational.hpp>

#include <cstdint>

namespace bricks
{

using Index3 = glm::i64vec3;

/// A half-open box of cells or of points of a lattice: Min belongs to it, Max does not.
/// The cells [Min, Max) have their corners at the points [Min, Max + 1).
struct Box
{
  Index3 Min{ 0 };
  Index3 Max{ 0 };

  Index3 GetSize() const { return glm::max(this->Max - this->Min, Index3(0)); }
  std::int64_t GetCount() const
  {
    const Index3 size = this->GetSize();
    return size.x * size.y * size.z;
  }
  bool IsEmpty() const { return this->GetCount() == 0; }
  bool Has(const Index3& index) const
  {
    return glm::all(glm::greaterThanEqual(index, this->Min)) &&
      glm::all(glm::lessThan(index, this->Max));
  }
  bool operator==(const Box& other) const
  {
    return this->Min == other.Min && this->Max == other.Max;
  }
};

inline Box Intersect(const Box& a, const Box& b)
{
  return { glm::max(a.Min, b.Min), glm::min(a.Max, b.Max) };
}

/// Calls visit(index) for all that is in a box, x fastest.
template <class Visit>
void ForEachIndex(const Box& box, const Visit& visit)
{
  for (std::int64_t z = box.Min.z; z < box.Max.z; ++z)
  {
    for (std::int64_t y = box.Min.y; y < box.Max.y; ++y)
    {
      for (std::int64_t x = box.Min.x; x < box.Max.x; ++x)
      {
        visit(Index3(x, y, z));
      }
    }
  }
}

} // namespace bricks

#endif
