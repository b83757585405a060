// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/mesh/MeshObject.h"

#include "DSMRayTracing/object/ObjectDigest.h"

namespace rt
{

bool MeshObject::IsOpaque() const
{
  const MeshLook& look = this->Look;
  return look.Surface.Opacity >= 1.0f && (!look.BackSurface || look.BackSurface->Opacity >= 1.0f) &&
    !look.Picture &&
    (look.ColoredBy == MeshLook::Coloring::Material ||
      (look.ColoredBy != MeshLook::Coloring::Colors && look.Colors->IsOpaque()));
}

void MeshObject::AddShapeTo(ObjectDigest& digest) const
{
  digest.AddAll(this->Instance->GetMesh().Segment->GetNumber(), this->Instance->GetMeshToWorld(),
    this->Instance->Culling.Front, this->Instance->Culling.Back, this->Clipping);
}

void MeshObject::AddTo(ObjectDigest& digest) const
{
  this->AddShapeTo(digest);
  const auto& [coloredBy, colors, picture, flat, surface, backSurface, edges] = this->Look;
  digest.AddAll(coloredBy, colors, picture, flat, surface, backSurface, edges);
}

} // namespace rt
