// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_ObjectHit_h
#define rt_ObjectHit_h

#include "DSMRayTracing/ray/Ray.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <type_traits>

namespace rt
{

class ObjectTracer;

/// The nearest hit of a ray so far among the objects that were asked. Its data stand in a slot of a fixed size,
/// which only the object that was hit can read. Without value until Clear.
class ObjectHit
{
public:
  void Clear() { this->Tracer = nullptr; }

  /// Null where nothing was hit.
  const ObjectTracer* GetObject() const { return this->Tracer; }

  /// Takes a hit of an object at `t` if it is nearer than the one so far; the ray ends there then. So of hits that
  /// are equally near that of the object that was asked first counts. Returns where the object has to write its
  /// data; null if it is not nearer. (Filled in place: a copy would wait for what was just written.)
  template <class Hit>
  Hit* Open(const ObjectTracer& object, double t, Ray& ray)
  {
    static_assert(sizeof(Hit) <= Most && std::is_trivially_copyable_v<Hit>, "fits the slot");
    if (this->Tracer && !(t < ray.Max))
    {
      return nullptr;
    }
    this->Tracer = &object;
    this->Size = sizeof(Hit);
    ray.Max = t;
    return new (this->Slot) Hit;
  }

  /// The same for a hit, which has a T, that stands elsewhere.
  template <class Hit>
  void Take(const ObjectTracer& object, const Hit& hit, Ray& ray)
  {
    if (Hit* const place = this->Open<Hit>(object, hit.T, ray))
    {
      *place = hit;
    }
  }

  /// Returns the hit that the object has stored.
  template <class Hit>
  const Hit& Get() const
  {
    return *std::launder(reinterpret_cast<const Hit*>(this->Slot));
  }

  ///@{
  /// The bytes of the hit that the object has stored: a copy of them is the same hit of that object, whichever worker
  /// traces it. Places in bricks are numbers.
  const std::byte* GetBytes() const { return this->Slot; }
  std::uint32_t GetSize() const { return this->Size; }
  void Set(const ObjectTracer& object, const std::byte* bytes, std::uint32_t size)
  {
    this->Tracer = &object;
    this->Size = size;
    std::memcpy(this->Slot, bytes, size);
  }
  ///@}

private:
  static constexpr std::size_t Most = 256;

  const ObjectTracer* Tracer;
  std::uint32_t Size;
  alignas(16) std::byte Slot[Most];
};

} // namespace rt

#endif
