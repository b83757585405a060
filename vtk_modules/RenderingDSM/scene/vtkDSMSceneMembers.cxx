// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMSceneMembers.h"

#include "vtkDSMLightOptions.h"
#include "vtkDSMTranslation.h"

#include "vtkAbstractVolumeMapper.h"
#include "vtkActor.h"
#include "vtkBoundingBox.h"
#include "vtkMapper.h"
#include "vtkMath.h"
#include "vtkPropCollection.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <algorithm>

namespace
{

/// Of the diagonal of what is shown: as far as ambient occlusion looks when nothing is said.
constexpr double AmbientOcclusionPart = 0.2;

} // namespace

void vtkDSMSceneMembers::Find(vtkRenderer* renderer)
{
  this->Shown.clear();
  std::vector<std::unique_ptr<vtkDSMSceneMember>> kept;
  vtkCollectionSimpleIterator position;
  vtkPropCollection* props = renderer->GetViewProps();
  props->InitTraversal(position);
  while (vtkProp* prop = props->GetNextProp(position))
  {
    auto* volume = vtkVolume::SafeDownCast(prop);
    auto* actor = vtkActor::SafeDownCast(prop);
    vtkAlgorithm* mapper = nullptr;
    if (volume)
    {
      mapper = volume->GetMapper();
    }
    else if (actor)
    {
      mapper = actor->GetMapper();
    }
    const auto known = std::find_if(this->States.begin(), this->States.end(),
      [=](const auto& state) { return state && mapper && state->GetAlgorithm() == mapper; });
    auto state =
      known == this->States.end() ? vtkDSMSceneMember::Create(mapper) : std::move(*known);
    if (!state)
    {
      continue;
    }
    kept.push_back(std::move(state));
    if (prop->GetVisibility())
    {
      kept.back()->SetProp(vtkProp3D::SafeDownCast(prop));
      this->Shown.push_back({ vtkProp3D::SafeDownCast(prop), kept.back().get() });
    }
  }
  // What is left belonged to props that were removed; their bricks leave the store.
  this->States = std::move(kept);
}

void vtkDSMSceneMembers::GiveUpBlocks()
{
  for (const auto& state : this->States)
  {
    state->GiveUpBlocks();
  }
}

void vtkDSMSceneMembers::GetBounds(double bounds[6]) const
{
  vtkBoundingBox box;
  for (const Member& member : this->Shown)
  {
    const double* part = member.Prop->GetBounds();
    if (part && vtkMath::AreBoundsInitialized(part))
    {
      box.AddBounds(part);
    }
  }
  box.GetBounds(bounds);
}

bool vtkDSMSceneMembers::AreBesideOthers(vtkRenderer* renderer) const
{
  vtkCollectionSimpleIterator position;
  vtkPropCollection* props = renderer->GetViewProps();
  props->InitTraversal(position);
  while (vtkProp* prop = props->GetNextProp(position))
  {
    const auto isProp = [=](const Member& member) { return member.Prop == prop; };
    // What cannot be picked, such as axes, is decoration; what has no bounds of its own is no object.
    if (vtkProp3D::SafeDownCast(prop) && prop->GetVisibility() && prop->GetPickable() &&
      prop->GetUseBounds() && std::none_of(this->Shown.begin(), this->Shown.end(), isProp))
    {
      return true;
    }
  }
  return false;
}

rt::LightTransport vtkDSMSceneMembers::GetTransport() const
{
  rt::LightTransport transport;
  transport.MaxBounces = 0;
  for (const Member& member : this->Shown)
  {
    vtkDSMLightOptions* options = member.State->GetLightOptions();
    transport.Shadows = transport.Shadows || options->GetShadows();
    transport.LightRadius = std::max(transport.LightRadius, options->GetLightRadius());
    transport.AmbientOcclusionSamples =
      std::max(transport.AmbientOcclusionSamples, options->GetAmbientOcclusionSamples());
    transport.AmbientOcclusionDistance =
      std::max(transport.AmbientOcclusionDistance, options->GetAmbientOcclusionDistance());
    transport.MaxBounces = std::max(transport.MaxBounces, options->GetMaxBounces());
  }
  if (transport.AmbientOcclusionSamples > 0 && transport.AmbientOcclusionDistance == 0.0)
  {
    double bounds[6];
    this->GetBounds(bounds);
    const vtkBoundingBox box(bounds);
    // Without anything to show there is no diagonal.
    transport.AmbientOcclusionDistance =
      box.IsValid() ? AmbientOcclusionPart * box.GetDiagonalLength() : 0.0;
  }
  return transport;
}

double vtkDSMSceneMembers::GetEnvironmentLight() const
{
  double strength = 0.0;
  for (const Member& member : this->Shown)
  {
    strength = std::max(strength, member.State->GetLightOptions()->GetEnvironmentLight());
  }
  return strength;
}

vtkDSMMemorySettings vtkDSMSceneMembers::GetMemorySettings() const
{
  vtkDSMMemorySettings settings;
  for (const auto& state : this->States)
  {
    settings.Merge(vtkDSMTranslation::ToMemorySettings(state->GetMemoryOptions()));
  }
  return settings;
}

int vtkDSMSceneMembers::GetSamplesPerPixel() const
{
  int samples = 1;
  for (const Member& member : this->Shown)
  {
    samples = std::max(samples, member.State->GetLightOptions()->GetSamplesPerPixel());
  }
  return samples;
}

bool vtkDSMSceneMembers::ShowStatistics() const
{
  return std::any_of(this->Shown.begin(), this->Shown.end(),
    [](const Member& member) { return member.State->GetLightOptions()->GetShowStatistics(); });
}

rt::DebugView vtkDSMSceneMembers::GetDebugView() const
{
  using Options = vtkDSMLightOptions;
  static_assert(static_cast<int>(rt::DebugView::Off) == Options::Off &&
      static_cast<int>(rt::DebugView::Owner) == Options::Owner &&
      static_cast<int>(rt::DebugView::TracingRank) == Options::TracingRank &&
      static_cast<int>(rt::DebugView::Brick) == Options::Brick &&
      static_cast<int>(rt::DebugView::TileTime) == Options::TileTime &&
      static_cast<int>(rt::DebugView::Normal) == Options::Normal &&
      static_cast<int>(rt::DebugView::Depth) == Options::Depth &&
      static_cast<int>(rt::DebugView::NewTiles) == Options::NewTiles &&
      static_cast<int>(rt::DebugView::Misses) == Options::Misses,
    "the options number the views as the tracer does");
  for (const Member& member : this->Shown)
  {
    if (const int view = member.State->GetLightOptions()->GetDebugView())
    {
      return static_cast<rt::DebugView>(view);
    }
  }
  return rt::DebugView::Off;
}

bool vtkDSMSceneMembers::ShowLegend() const
{
  return std::all_of(this->Shown.begin(), this->Shown.end(),
    [](const Member& member) { return member.State->GetLightOptions()->GetShowLegend(); });
}
