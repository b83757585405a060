// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/surface/IsosurfaceLook.h"

#include "DSMRayTracing/object/ObjectDigest.h"

#include <algorithm>

namespace rt
{

bool IsosurfaceLook::IsOpaque() const
{
  const auto isOpaque = [](const Material* side) { return side && side->Opacity >= 1.0f; };
  return isOpaque(this->GetSurface(false)) && isOpaque(this->GetSurface(true)) &&
    (!this->Blocks || this->Blocks->AreOpaque()) &&
    std::all_of(this->Opacities.begin(), this->Opacities.end(),
      [](float opacity) { return opacity >= 1.0f; });
}

bool IsosurfaceLook::HasOpaqueColors(bool hasHoles) const
{
  switch (this->ColoredBy)
  {
    case Coloring::Values:
      return this->Colors.IsOpaque();
    case Coloring::OpaqueColors:
      return !hasHoles || this->Colors.NotANumber.w >= 1.0f;
    default:
      return false;
  }
}

bool IsosurfaceLook::IsSeen() const
{
  const auto isSeen = [this](const Material* side)
  { return side && (side->Opacity > 0.0f || (this->Blocks && this->Blocks->AnyIsSeen())); };
  return isSeen(this->GetSurface(false)) || isSeen(this->GetSurface(true));
}

bool IsosurfaceLook::IsAlikeEverywhere() const
{
  return !this->CullsFront && !this->CullsBack && !this->BackSurface && !this->Blocks;
}

void IsosurfaceLook::AddTo(ObjectDigest& digest) const
{
  const auto& [opacities, colors, coloredBy, surface, backSurface, cullsFront, cullsBack, blocks,
    flat] = *this;
  digest.AddAll(opacities, colors, coloredBy, surface, backSurface, cullsFront, cullsBack,
    blocks != nullptr, flat);
  if (blocks)
  {
    blocks->AddTo(digest);
  }
}

} // namespace rt
