// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/mesh/MeshObject.h"

#include "DSMRayTracing/object/ObjectDigest.h"

namespace rt
{

bool MeshObject::IsOpaque() const
{
  return this->Surface.Opacity >= 1.0f &&
    (!this->BackSurface || this->BackSurface->Opacity >= 1.0f) && !this->Picture &&
    (this->ColoredBy == Coloring::Material ||
      (this->ColoredBy != Coloring::Colors && this->Colors->IsOpaque()));
}

void MeshObject::AddTo(ObjectDigest& digest) const
{
  digest.Add(this->Instance->GetMesh().Segment->GetNumber());
  digest.Add(this->Instance->GetMeshToWorld());
  digest.Add(this->Instance->Culling.Front);
  digest.Add(this->Instance->Culling.Back);
  digest.Add(this->ColoredBy);
  digest.AddIf(this->Colors.get());
  digest.Add(this->Flat);
  digest.Add(this->Surface);
  digest.Add(this->BackSurface);
  digest.Add(this->Edges);
  digest.AddIf(this->Picture.get());
  digest.Add(this->Clipping);
}

} // namespace rt
