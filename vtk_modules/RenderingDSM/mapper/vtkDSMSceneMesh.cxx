// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMSceneMesh.h"

#include "vtkDSMCompatibility.h"
#include "vtkDSMLightOptions.h"
#include "vtkDSMTranslation.h"

#include "vtkActor.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkProperty.h"
#include "vtkScalarsToColors.h"
#include "vtkTexture.h"
#include "vtkTransform.h"

#include <algorithm>
#include <utility>

namespace
{

/// Settings of a block override those of the property.
void Apply(const vtkDSMMeshBlock::Look& look, rt::Material& material)
{
  if (look.Opacity >= 0.0f)
  {
    material.Opacity = look.Opacity;
  }
  if (look.Color[0] >= 0.0f)
  {
    material.DiffuseColor = { look.Color[0], look.Color[1], look.Color[2] };
    material.AmbientColor = material.DiffuseColor;
  }
}

rt::MeshLook::Coloring GetColoring(const vtkDSMMeshBlock::Look& look,
  const bricks::MeshAttributes& has, bool interpolateScalarsBeforeMapping)
{
  using Coloring = rt::MeshLook::Coloring;
  if (look.Color[0] >= 0.0f)
  {
    return Coloring::Material;
  }
  if (has.Colors != bricks::Attachment::None)
  {
    return Coloring::Colors;
  }
  if (has.Values == bricks::Attachment::None)
  {
    return Coloring::Material;
  }
  return interpolateScalarsBeforeMapping || has.Values == bricks::Attachment::Triangles
    ? Coloring::Values
    : Coloring::CornerValues;
}

} // namespace

bool vtkDSMSceneMesh::IsTextured() const
{
  auto* actor = vtkActor::SafeDownCast(this->Prop);
  return actor && actor->GetTexture();
}

bool vtkDSMSceneMesh::ShowsEdges() const
{
  auto* actor = vtkActor::SafeDownCast(this->Prop);
  return actor && actor->GetProperty()->GetEdgeVisibility() != 0;
}

bool vtkDSMSceneMesh::LacksEdges() const
{
  return this->Data && this->ShowsEdges() && !this->Data->GetWish().EdgeFlags;
}

vtkDSMMeshInput vtkDSMSceneMesh::GetInput() const
{
  return { this->Mapper, this->Mapper->GetCompositeDataDisplayAttributes(),
    this->Mapper->GetLineRadius(), this->Mapper->GetPointRadius(), this->Mapper->GetRadiusArray(),
    { this->IsTextured(), this->ShowsEdges() } };
}

std::vector<std::uint64_t> vtkDSMSceneMesh::GetStamp() const
{
  try
  {
    return vtkDSMMeshContent::GetStamp(this->GetInput());
  }
  catch (const dsm::Error&)
  {
    // Data that are no surfaces, like no other data; taking them in says why.
    return { 0 };
  }
}

vtkDSMMeshContent vtkDSMSceneMesh::HashContent() const
{
  try
  {
    return vtkDSMMeshContent::Hash(this->GetInput(), this->Threads);
  }
  catch (const dsm::Error&)
  {
    return { { 0 }, {} };
  }
}

bool vtkDSMSceneMesh::HasNewData()
{
  if (!this->Taken)
  {
    return true;
  }
  std::vector<std::uint64_t> stamp = this->GetStamp();
  if (stamp == this->Seen.Stamp)
  {
    return this->LacksEdges();
  }
  if (!this->Failure.empty())
  {
    return true;
  }
  this->Found = { std::move(stamp), this->HashContent() };
  if (this->Found.Content.Whole != this->Seen.Content.Whole)
  {
    return true;
  }
  this->Seen = std::move(this->Found);
  return this->LacksEdges();
}

/// Data that were refused may fit with other memory settings.
bool vtkDSMSceneMesh::NeedsRanks(const vtkDSMRankGroup& group, bool) const
{
  return !this->Failure.empty() && this->FailureVersion != group.GetRetryVersion();
}

bool vtkDSMSceneMesh::SharesBlocks(const vtkDSMSceneMember& other) const
{
  const auto* mesh = dynamic_cast<const vtkDSMSceneMesh*>(&other);
  if (!mesh || !mesh->Data || !this->Data)
  {
    return false;
  }
  const auto& others = mesh->Data->GetParts();
  return std::any_of(this->Data->GetParts().begin(), this->Data->GetParts().end(),
    [&](const vtkDSMMeshData::Part& part)
    {
      return std::any_of(others.begin(), others.end(),
        [&](const vtkDSMMeshData::Part& one) { return one.Mesh == part.Mesh; });
    });
}

void vtkDSMSceneMesh::GiveUpBlocks()
{
  this->Data.reset();
  this->Taken = false;
}

void vtkDSMSceneMesh::Update(const std::shared_ptr<vtkDSMRankGroup>& group, bool newData)
{
  this->Messages.clear();
  this->Warnings.clear();
  const unsigned version = group->GetRetryVersion();
  if (newData || this->NeedsRanks(*group, false))
  {
    this->Failure.clear();
    if (newData || this->ReportedVersion != group->GetSettingsVersion())
    {
      this->ReportedVersion = group->GetSettingsVersion();
      this->Reported.clear();
    }
    this->Taken = true;
    this->Threads = group->GetStore().GetSettings().Workers;
    std::vector<std::uint64_t> stamp = this->GetStamp();
    if (stamp == this->Found.Stamp)
    {
      this->Seen = std::move(this->Found);
    }
    else if (stamp != this->Seen.Stamp)
    {
      this->Seen = { std::move(stamp), this->HashContent() };
    }
    this->Found = {};
    try
    {
      this->Data = std::make_unique<vtkDSMMeshData>(
        group, this->GetInput(), this->Seen.Content, std::move(this->Data));
      this->Mapper->SetGlobalBounds(this->Data->GetBounds());
    }
    catch (const dsm::Error& error)
    {
      this->Failure = error.what();
      this->FailureVersion = version;
    }
  }
  if (!this->Data)
  {
    this->Messages.push_back(this->Failure);
  }
  else if (!this->Data->GetMessage().empty())
  {
    this->Messages.push_back(this->Data->GetMessage());
  }
  else if (!this->Data->GetWarning().empty())
  {
    this->Warnings.push_back(this->Data->GetWarning());
  }
}

std::shared_ptr<const rt::ColorMap> vtkDSMSceneMesh::GetColorMap()
{
  vtkScalarsToColors* table = this->Mapper->GetLookupTable();
  if (!this->Mapper->GetUseLookupTableScalarRange())
  {
    table->SetRange(this->Mapper->GetScalarRange());
  }
  return this->SampleColors(table);
}

rt::MeshObject vtkDSMSceneMesh::CreateObject(const vtkDSMMeshData::Part& part, vtkActor* actor)
{
  vtkProperty* property = actor->GetProperty();
  rt::MeshObject object;
  auto instance =
    std::make_shared<rt::MeshInstance>(part.Mesh, vtkDSMTranslation::ToMatrix(actor->GetMatrix()));
  instance->Culling.Front = property->GetFrontfaceCulling() != 0;
  instance->Culling.Back = property->GetBackfaceCulling() != 0;
  object.Instance = std::move(instance);
  object.Clipping = vtkDSMTranslation::ToClipRegion(this->Mapper);
  object.Look.Flat = property->GetInterpolation() == VTK_FLAT &&
    part.Mesh->Attributes.Normals != bricks::Attachment::Triangles;
  object.Look.Surface = vtkDSMTranslation::ToMaterial(property);
  object.Look.Surface.Reflectivity = static_cast<float>(this->GetLightOptions()->GetReflectivity());
  Apply(part.Appearance, object.Look.Surface);
  if (vtkProperty* back = actor->GetBackfaceProperty())
  {
    object.Look.BackSurface = vtkDSMTranslation::ToMaterial(back);
    object.Look.BackSurface->Reflectivity = object.Look.Surface.Reflectivity;
  }
  if (this->ShowsEdges())
  {
    object.Look.Edges = vtkDSMTranslation::ToEdgeLines(property);
  }
  object.Look.ColoredBy = GetColoring(part.Appearance, part.Mesh->Attributes,
    this->Mapper->GetInterpolateScalarsBeforeMapping() != 0);
  if (object.Look.ColoredBy == rt::MeshLook::Coloring::Values ||
    object.Look.ColoredBy == rt::MeshLook::Coloring::CornerValues)
  {
    object.Look.Colors = this->GetColorMap();
  }
  if (part.Mesh->Attributes.TextureCoordinates && actor->GetTexture())
  {
    object.Look.Picture = this->GetPicture(actor);
  }
  return object;
}

const std::shared_ptr<const rt::Texture>& vtkDSMSceneMesh::GetPicture(vtkActor* actor)
{
  vtkTexture* texture = actor->GetTexture();
  vtkInformation* keys = actor->GetPropertyKeys();
  auto* placeKey = vtkDSMCompatibility::GetTextureTransformKey();
  const double* place = keys && keys->Has(placeKey) ? keys->Get(placeKey) : nullptr;
  if (texture->GetInputAlgorithm())
  {
    texture->GetInputAlgorithm()->Update();
  }
  const std::vector<std::uint64_t> source{ reinterpret_cast<std::uintptr_t>(texture),
    texture->GetMTime(), texture->GetInput() ? texture->GetInput()->GetMTime() : 0,
    texture->GetTransform() ? texture->GetTransform()->GetMTime() : 0, keys ? keys->GetMTime() : 0,
    place ? 1u : 0u };
  if (source != this->PictureSource)
  {
    vtkNew<vtkMatrix4x4> transform;
    if (texture->GetTransform())
    {
      transform->DeepCopy(texture->GetTransform()->GetMatrix());
    }
    else if (place)
    {
      transform->DeepCopy(place);
    }
    this->Picture = vtkDSMTranslation::ToTexture(texture, transform);
    this->PictureSource = source;
  }
  return this->Picture;
}

void vtkDSMSceneMesh::AddTo(rt::Scene& scene)
{
  auto* actor = vtkActor::SafeDownCast(this->Prop);
  // A surface that is squeezed flat has no inside to look into.
  actor->ComputeMatrix();
  if (!this->Data || actor->GetMatrix()->Determinant() == 0.0)
  {
    return;
  }
  for (const vtkDSMMeshData::Part& part : this->Data->GetParts())
  {
    if (!part.Appearance.Visible)
    {
      continue;
    }
    rt::MeshObject object = this->CreateObject(part, actor);
    if (object.Look.Surface.Opacity > 0.0f ||
      (object.Look.BackSurface && object.Look.BackSurface->Opacity > 0.0f))
    {
      scene.Objects.push_back(std::move(object));
    }
  }
}
