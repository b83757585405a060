// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/volume/IsosurfaceObject.h"

#include "DSMRayTracing/object/ObjectDigest.h"
#include "DSMRayTracing/surface/SheetTransmittance.h"

#include <algorithm>
#include <cstddef>

namespace rt
{

bool IsosurfaceObject::HasOpaqueColors() const
{
  switch (this->ColoredBy)
  {
    case Coloring::Values:
      return this->Colors.IsOpaque();
    case Coloring::OpaqueColors:
      return !this->ColorField->Lattice.HasCellMask() || this->Colors.NotANumber.w >= 1.0f;
    default:
      return false;
  }
}

bool IsosurfaceObject::IsOpaque() const
{
  const auto isOpaque = [](const Material* side) { return side && side->Opacity >= 1.0f; };
  return isOpaque(this->GetSurface(false)) && isOpaque(this->GetSurface(true)) &&
    (!this->ColorField || this->HasOpaqueColors()) &&
    (!this->Blocks || this->Blocks->AreOpaque()) &&
    std::all_of(this->Opacities.begin(), this->Opacities.end(),
      [](float opacity) { return opacity >= 1.0f; });
}

std::vector<glm::dvec3> IsosurfaceObject::GetSheetTransmittances() const
{
  const bool isColoredByItself = this->ColorField == this->Field &&
    this->ColoredBy == Coloring::Values && !this->Colors.Categories;
  if (this->CullsFront || this->CullsBack || this->BackSurface || this->Blocks ||
    (this->ColorField && !isColoredByItself))
  {
    return {};
  }
  std::vector<glm::dvec3> sheets;
  for (std::size_t index = 0; index < this->Isovalues.size(); ++index)
  {
    glm::vec4 color = this->ColorField ? this->Colors.Map(this->Isovalues[index])
                                       : glm::vec4(this->Surface.DiffuseColor, 1.0f);
    color.w *= this->Surface.Opacity;
    color.w *= this->Opacities.empty() ? 1.0f : this->Opacities[index];
    sheets.push_back(GetSheetTransmittance(color));
  }
  return sheets;
}

bool IsosurfaceObject::IsSeen() const
{
  const auto isSeen = [this](const Material* side)
  { return side && (side->Opacity > 0.0f || (this->Blocks && this->Blocks->AnyIsSeen())); };
  return isSeen(this->GetSurface(false)) || isSeen(this->GetSurface(true));
}

void IsosurfaceObject::AddTo(ObjectDigest& digest) const
{
  digest.Add(this->IndexToWorld);
  digest.Add(this->Field->Segment->GetNumber());
  digest.Add(this->Field->Segment->GetVersion());
  digest.Add(this->Isovalues);
  digest.Add(this->Opacities);
  digest.Add(this->ColorField != nullptr);
  if (this->ColorField)
  {
    digest.Add(this->ColorField->Segment->GetNumber());
    digest.Add(this->ColorField->Segment->GetVersion());
    digest.Add(this->Colors);
    digest.Add(this->ColoredBy);
  }
  digest.Add(this->Surface);
  digest.Add(this->BackSurface);
  digest.Add(this->CullsFront);
  digest.Add(this->CullsBack);
  digest.Add(this->Blocks != nullptr);
  if (this->Blocks)
  {
    this->Blocks->AddTo(digest);
  }
  digest.Add(this->Flat);
  digest.Add(this->Clipping);
}

} // namespace rt
