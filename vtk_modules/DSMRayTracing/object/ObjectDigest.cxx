// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/object/ObjectDigest.h"

namespace rt
{

void ObjectDigest::Add(const Material& material)
{
  const auto& [ambient, diffuse, specular, specularPower, ambientColor, diffuseColor, specularColor,
    opacity, reflectivity, lighting] = material;
  this->AddAll(ambient, diffuse, specular, specularPower, ambientColor, diffuseColor, specularColor,
    opacity, reflectivity, lighting);
}

void ObjectDigest::Add(const MediumLook& look)
{
  const auto& [shade, surface, scattering, anisotropy, gradients, nearest, exact] = look;
  this->AddAll(shade, surface, scattering, anisotropy, gradients, nearest, exact);
}

void ObjectDigest::Add(const GradientOpacity& gradients)
{
  const auto& [last, factors] = gradients;
  this->AddAll(last, factors);
}

void ObjectDigest::Add(const ColorMap& map)
{
  const auto& [first, last, logarithmic, table, nodes, firstNode, below, above, notANumber,
    categories] = map;
  this->AddAll(
    first, last, logarithmic, table, nodes, firstNode, below, above, notANumber, categories);
}

void ObjectDigest::Add(const ColorMap::Node& node)
{
  const auto& [value, color] = node;
  this->AddAll(value, color);
}

void ObjectDigest::Add(const ColorMap::Category& category)
{
  const auto& [value, color] = category;
  this->AddAll(value, color);
}

void ObjectDigest::Add(const ClipRegion& region)
{
  const auto& [halfSpaces, boxes] = region;
  this->AddAll(halfSpaces, boxes);
}

void ObjectDigest::Add(const ClipRegion::HalfSpace& half)
{
  const auto& [normal, point] = half;
  this->AddAll(normal, point);
}

void ObjectDigest::Add(const ClipRegion::Grid& boxes)
{
  const auto& [worldToGrid, lower, upper, kept] = boxes;
  this->AddAll(worldToGrid, lower, upper, kept);
}

void ObjectDigest::Add(const EdgeLines& lines)
{
  const auto& [color, width, opacity] = lines;
  this->AddAll(color, width, opacity);
}

void ObjectDigest::Add(const Texture& picture)
{
  const auto& [width, height, texels, repeat, interpolate, transform] = picture;
  this->AddAll(width, height, repeat, interpolate, transform);
  this->Bytes.Add(texels.data(), texels.size());
}

} // namespace rt
