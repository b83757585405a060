// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TileHits_h
#define rt_TileHits_h

#include "DSMRayTracing/object/ObjectHit.h"
#include "DSMRayTracing/object/ObjectTracer.h"
#include "DSMRayTracing/ray/Ray.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace rt
{

/// The first hits of one sample of the pixels of a tile. One thread at a time.
class TileHits
{
public:
  explicit TileHits(std::size_t pixels)
    : Pixels(pixels)
  {
  }

  /// Returns whether the ray of a pixel (row by row in the tile) meets anything.
  bool Has(std::size_t pixel) const { return !this->Places.empty() && this->Places[pixel] != 0; }

  /// Keeps a hit of an object of a scene; `ray` ends there.
  void Add(std::size_t pixel, const Ray& ray, const ObjectHit& hit)
  {
    const Head head{ ray.Max, hit.GetObject()->GetNumber(), hit.GetSize() };
    if (this->Places.empty())
    {
      this->Places.resize(this->Pixels);
      this->Bytes.reserve(this->Pixels * (sizeof(head) + head.Size));
    }
    this->Places[pixel] = static_cast<std::uint32_t>(this->Bytes.size() + 1);
    const auto* const first = reinterpret_cast<const std::byte*>(&head);
    this->Bytes.insert(this->Bytes.end(), first, first + sizeof(head));
    this->Bytes.insert(this->Bytes.end(), hit.GetBytes(), hit.GetBytes() + head.Size);
  }

  /// After the last hit.
  void GiveBackMemory()
  {
    if (this->Bytes.size() < this->Bytes.capacity() / 2)
    {
      this->Bytes.shrink_to_fit();
    }
  }

  /// Sets the hit of a pixel that has one, and ends the ray there. `objects`: by their numbers.
  void Get(std::size_t pixel, const ObjectTracer* const* objects, Ray& ray, ObjectHit& hit) const
  {
    const std::byte* const place = &this->Bytes[this->Places[pixel] - 1];
    Head head;
    std::memcpy(&head, place, sizeof(head));
    ray.Max = head.End;
    hit.Set(*objects[head.Object], place + sizeof(head), head.Size);
  }

  std::size_t CountBytes() const
  {
    return this->Bytes.capacity() + this->Places.size() * sizeof(std::uint32_t);
  }

private:
  struct Head
  {
    double End;
    std::int32_t Object;
    std::uint32_t Size;
  };

  std::size_t Pixels;
  std::vector<std::uint32_t>
    Places; ///< by pixel: one more than where in Bytes its hit is; 0: it has none
  std::vector<std::byte> Bytes;
};

} // namespace rt

#endif
