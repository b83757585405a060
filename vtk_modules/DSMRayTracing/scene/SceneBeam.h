// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SceneBeam_h
#define rt_SceneBeam_h

#include "DSMRayTracing/object/ObjectBeam.h"

#include <algorithm>
#include <memory>
#include <vector>

namespace rt
{

/// Data about the rays of a beam that the objects and media of a scene find beforehand.
struct SceneBeam
{
  /// Beam of each of SceneTracers::GetBeamFinders; null where there is none.
  std::vector<std::unique_ptr<ObjectBeam>> Objects;

  /// Returns whether the rays may hit anything.
  bool MayMeet() const
  {
    return std::any_of(this->Objects.begin(), this->Objects.end(),
      [](const auto& object) { return !object || object->MayMeet(); });
  }

  /// Returns whether tracing the rays together is faster. If not, it may be for the rays of a
  /// smaller beam.
  bool IsUsable() const
  {
    return std::all_of(this->Objects.begin(), this->Objects.end(),
      [](const auto& object) { return !object || object->Usable; });
  }
};

} // namespace rt

#endif
