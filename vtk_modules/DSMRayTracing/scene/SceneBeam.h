// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SceneBeam_h
#define rt_SceneBeam_h

#include "DSMRayTracing/object/ObjectBeam.h"

#include <algorithm>
#include <memory>
#include <vector>

namespace rt
{

/// What the objects and media of a scene know beforehand of the rays of a beam.
struct SceneBeam
{
  /// Of each of SceneTracers::GetBeamFinders; null where it has nothing to tell.
  std::vector<std::unique_ptr<ObjectBeam>> Objects;

  /// Whether the rays may meet anything.
  bool MayMeet() const
  {
    return std::any_of(this->Objects.begin(), this->Objects.end(),
      [](const auto& object) { return !object || object->MayMeet(); });
  }

  /// Whether rays gain from being traced together; else those of a smaller beam may.
  bool IsUsable() const
  {
    return std::all_of(this->Objects.begin(), this->Objects.end(),
      [](const auto& object) { return !object || object->Usable; });
  }
};

} // namespace rt

#endif
