// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/object/ObjectDigest.h"

namespace rt
{

void ObjectDigest::Add(const Material& material)
{
  for (const float value : { material.Ambient, material.Diffuse, material.Specular,
         material.SpecularPower, material.Opacity, material.Reflectivity })
  {
    this->Add(value);
  }
  this->Add(material.AmbientColor);
  this->Add(material.DiffuseColor);
  this->Add(material.SpecularColor);
  this->Add(material.Lighting);
}

void ObjectDigest::Add(const MediumLook& look)
{
  this->Add(look.Shade);
  this->Add(look.Surface);
  this->Add(look.Scattering);
  this->Add(look.Anisotropy);
  this->Add(look.Gradients != nullptr);
  if (look.Gradients)
  {
    this->Add(look.Gradients->Last);
    this->Add(look.Gradients->Factors);
  }
}

void ObjectDigest::Add(const ColorMap& map)
{
  this->Add(map.First);
  this->Add(map.Last);
  this->Add(map.Logarithmic);
  this->Add(map.Table);
  this->Add(map.Nodes);
  this->Add(map.Below);
  this->Add(map.Above);
  this->Add(map.NotANumber);
  this->Add(map.Categories);
}

void ObjectDigest::Add(const ClipRegion& region)
{
  this->Add(region.HalfSpaces);
  this->Add(region.Boxes);
}

void ObjectDigest::Add(const ClipRegion::HalfSpace& half)
{
  this->Add(half.Normal);
  this->Add(half.Point);
}

void ObjectDigest::Add(const ClipRegion::Grid& boxes)
{
  this->Add(boxes.WorldToGrid);
  this->Add(boxes.Lower);
  this->Add(boxes.Upper);
  this->Add(boxes.Kept);
}

void ObjectDigest::Add(const EdgeLines& lines)
{
  this->Add(lines.Color);
  this->Add(lines.Width);
  this->Add(lines.Opacity);
}

void ObjectDigest::Add(const Texture& picture)
{
  this->Add(picture.Width);
  this->Add(picture.Height);
  this->Bytes.Add(picture.Texels.data(), picture.Texels.size());
  this->Add(picture.Repeat);
  this->Add(picture.Interpolate);
  this->Add(picture.Transform);
}

} // namespace rt
