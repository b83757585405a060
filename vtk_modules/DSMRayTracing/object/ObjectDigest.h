// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_ObjectDigest_h
#define rt_ObjectDigest_h

#include "DSMBricks/base/ByteHash.h"
#include "DSMRayTracing/look/ColorMap.h"
#include "DSMRayTracing/look/EdgeLines.h"
#include "DSMRayTracing/look/Material.h"
#include "DSMRayTracing/look/MediumLook.h"
#include "DSMRayTracing/look/Texture.h"
#include "DSMRayTracing/ray/ClipRegion.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

namespace rt
{

/// A number that descriptions of objects, and what else is added, share if, for all practical purposes,
/// they are the same. Valid within one process.
///
/// A description of several members is taken apart by a structured binding: a new member does not compile until its
/// digest has it, so none can be forgotten, which would leave an old picture.
class ObjectDigest
{
public:
  std::uint64_t Get() const { return this->Bytes.Get(); }

  template <class... Values>
  void AddAll(const Values&... values)
  {
    (this->Add(values), ...);
  }

  /// Only types without padding.
  template <class T>
  void Add(const T& value)
  {
    static_assert(std::is_trivially_copyable_v<T>, "only plain values have bytes of their own");
    this->Bytes.Add(&value, sizeof(T));
  }
  template <class T>
  void Add(const std::vector<T>& values)
  {
    this->Add(values.size());
    for (const T& value : values)
    {
      this->Add(value);
    }
  }
  /// Adds what it points to, or that it is null.
  template <class T>
  void Add(const std::shared_ptr<T>& value)
  {
    this->AddIf(value.get());
  }
  template <class T>
  void Add(const std::optional<T>& value)
  {
    this->AddIf(value ? &*value : nullptr);
  }
  /// Adds the value, or that there is none.
  template <class T>
  void AddIf(const T* value)
  {
    this->Add(value != nullptr);
    if (value)
    {
      this->Add(*value);
    }
  }

  void Add(const Material& material);
  void Add(const MediumLook& look);
  void Add(const GradientOpacity& gradients);
  void Add(const ColorMap& map);
  void Add(const ColorMap::Node& node);
  void Add(const ColorMap::Category& category);
  void Add(const ClipRegion& region);
  void Add(const ClipRegion::HalfSpace& half);
  void Add(const ClipRegion::Grid& boxes);
  void Add(const EdgeLines& lines);
  void Add(const Texture& picture);

private:
  bricks::ByteHash Bytes;
};

} // namespace rt

#endif
