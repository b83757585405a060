// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/volume/IsosurfaceObject.h"

#include "DSMRayTracing/object/ObjectDigest.h"

#include <algorithm>

namespace rt
{

bool IsosurfaceObject::IsOpaque() const
{
  return this->Surface.Opacity >= 1.0f && (!this->ColorField || this->Colors.IsOpaque()) &&
    std::all_of(this->Opacities.begin(), this->Opacities.end(),
      [](float opacity) { return opacity >= 1.0f; });
}

void IsosurfaceObject::AddTo(ObjectDigest& digest) const
{
  digest.Add(this->IndexToWorld);
  digest.Add(this->Field->Segment->GetNumber());
  digest.Add(this->Isovalues);
  digest.Add(this->Opacities);
  digest.Add(this->ColorField != nullptr);
  if (this->ColorField)
  {
    digest.Add(this->ColorField->Segment->GetNumber());
    digest.Add(this->Colors);
  }
  digest.Add(this->Surface);
  digest.Add(this->Clipping);
}

} // namespace rt
