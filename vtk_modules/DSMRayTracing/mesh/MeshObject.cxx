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

void MeshObject::AddTo(ObjectDigest& digest) const
{
  const MeshLook& look = this->Look;
  digest.Add(this->Instance->GetMesh().Segment->GetNumber());
  digest.Add(this->Instance->GetMeshToWorld());
  digest.Add(this->Instance->Culling.Front);
  digest.Add(this->Instance->Culling.Back);
  digest.Add(look.ColoredBy);
  digest.AddIf(look.Colors.get());
  digest.Add(look.Flat);
  digest.Add(look.Surface);
  digest.Add(look.BackSurface);
  digest.Add(look.Edges);
  digest.AddIf(look.Picture.get());
  digest.Add(this->Clipping);
}

} // namespace rt
