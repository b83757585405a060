// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/SceneDigest.h"

#include "DSMRayTracing/base/ByteHash.h"
#include "DSMRayTracing/mesh/MeshInstance.h"

#include <type_traits>
#include <vector>

namespace rt
{

namespace
{

class Digest
{
public:
  std::uint64_t Get() const { return this->Bytes.Get(); }

  /// Only types without padding.
  template <class T>
  void Add(const T& value)
  {
    static_assert(std::is_trivially_copyable_v<T>, "only plain values have bytes of their own");
    this->Bytes.Add(&value, sizeof(T));
  }

  template <class T>
  void AddAll(const std::vector<T>& values)
  {
    this->Add(values.size());
    for (const T& value : values)
    {
      this->Add(value);
    }
  }

  void Add(const Material& material)
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

  void Add(const ColorMap& map)
  {
    this->Add(map.First);
    this->Add(map.Last);
    this->Add(map.Logarithmic);
    this->AddAll(map.Table);
    this->Add(map.Below);
    this->Add(map.Above);
    this->Add(map.NotANumber);
  }

  void Add(const ClipRegion& region)
  {
    this->Add(region.HalfSpaces.size());
    for (const ClipRegion::HalfSpace& half : region.HalfSpaces)
    {
      this->Add(half.Normal);
      this->Add(half.Point);
    }
    this->Add(region.Boxes.has_value());
    if (region.Boxes)
    {
      this->Add(region.Boxes->WorldToGrid);
      this->Add(region.Boxes->Lower);
      this->Add(region.Boxes->Upper);
      this->Add(region.Boxes->Kept);
    }
  }

  void Add(const IsosurfaceObject& object)
  {
    this->Add(object.IndexToWorld);
    this->Add(object.Field->Segment->GetNumber());
    this->AddAll(object.Isovalues);
    this->AddAll(object.Opacities);
    this->Add(object.ColorField != nullptr);
    if (object.ColorField)
    {
      this->Add(object.ColorField->Segment->GetNumber());
      this->Add(object.Colors);
    }
    this->Add(object.Surface);
    this->Add(object.Clipping);
  }

  void Add(const MeshObject& object)
  {
    this->Add(object.Instance->GetMesh().Segment->GetNumber());
    this->Add(object.Instance->GetMeshToWorld());
    this->Add(object.Instance->Culling.Front);
    this->Add(object.Instance->Culling.Back);
    this->Add(object.ColoredBy);
    if (object.Colors)
    {
      this->Add(*object.Colors);
    }
    this->Add(object.Flat);
    this->Add(object.Surface);
    this->Add(object.BackSurface.has_value());
    if (object.BackSurface)
    {
      this->Add(*object.BackSurface);
    }
    this->Add(object.Edges.has_value());
    if (object.Edges)
    {
      this->Add(*object.Edges);
    }
    this->Add(object.Picture != nullptr);
    if (object.Picture)
    {
      this->Add(*object.Picture);
    }
    this->Add(object.Clipping);
  }

  void Add(const EdgeLines& lines)
  {
    this->Add(lines.Color);
    this->Add(lines.Width);
    this->Add(lines.Opacity);
  }

  void Add(const Texture& picture)
  {
    this->Add(picture.Width);
    this->Add(picture.Height);
    this->Bytes.Add(picture.Texels.data(), picture.Texels.size());
    this->Add(picture.Repeat);
    this->Add(picture.Interpolate);
    this->Add(picture.Transform);
  }

  void Add(const Light& light)
  {
    this->Add(light.Type);
    this->Add(light.IsLoneHeadlight);
    this->Add(light.Position);
    this->Add(light.Direction);
    this->Add(light.Color);
    this->Add(light.ConeCosine);
    this->Add(light.Exponent);
    this->Add(light.Attenuation);
  }

  void Add(const LightTransport& transport)
  {
    this->Add(transport.Shadows);
    this->Add(transport.LightRadius);
    this->Add(transport.AmbientOcclusionSamples);
    this->Add(transport.AmbientOcclusionDistance);
    this->Add(transport.Surroundings.Up);
    this->Add(transport.Surroundings.Lower);
    this->Add(transport.Surroundings.Upper);
    this->Add(transport.MaxBounces);
    this->Add(transport.Background);
  }

private:
  ByteHash Bytes;
};

} // namespace

std::uint64_t GetSceneDigest(const Scene& scene, const FrameRequest& request)
{
  Digest digest;
  digest.Add(request.Width);
  digest.Add(request.Height);
  digest.Add(request.WorldToClip);
  digest.Add(request.TileSize);
  digest.Add(request.Layers);
  digest.Add(scene.Transport);
  digest.Add(scene.View);
  digest.AddAll(scene.Lights);
  digest.AddAll(scene.Isosurfaces);
  digest.AddAll(scene.Meshes);
  return digest.Get();
}

} // namespace rt
