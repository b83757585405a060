// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_ObjectHit_h
#define rt_ObjectHit_h

#include "DSMRayTracing/ray/Ray.h"

#include <cstddef>
#include <new>
#include <type_traits>

namespace rt
{

class ObjectTracer;

/// The nearest hit of a ray so far among the objects that were asked. What is known of it stands in a
/// slot of a fixed size, which only the object that was hit can read. Without value until Clear.
class ObjectHit
{
public:
  void Clear() { this->Tracer = nullptr; }

  /// Null where nothing was hit.
  const ObjectTracer* GetObject() const { return this->Tracer; }

  /// Takes a hit of an object, which has a T, if it is nearer than the one so far; the ray ends there
  /// then. So of hits that are equally near that of the object that was asked first counts.
  template <class Hit>
  void Take(const ObjectTracer& object, const Hit& hit, Ray& ray)
  {
    static_assert(sizeof(Hit) <= Size && std::is_trivially_destructible_v<Hit>, "fits the slot");
    if (!this->Tracer || hit.T < ray.Max)
    {
      this->Tracer = &object;
      new (this->Slot) Hit(hit);
      ray.Max = hit.T;
    }
  }

  /// What the object has given to Take.
  template <class Hit>
  const Hit& Get() const
  {
    return *std::launder(reinterpret_cast<const Hit*>(this->Slot));
  }

private:
  static constexpr std::size_t Size = 256;

  const ObjectTracer* Tracer;
  alignas(16) std::byte Slot[Size];
};

} // namespace rt

#endif
