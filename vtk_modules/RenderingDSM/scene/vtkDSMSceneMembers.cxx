// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMSceneMembers.h"

#include "DSMBricks/base/ByteHash.h"
#include "DSMCore/memory/FreedMemory.h"
#include "vtkDSMLightOptions.h"
#include "vtkDSMMemoryOptions.h"

#include "vtkAbstractVolumeMapper.h"
#include "vtkActor.h"
#include "vtkAssembly.h"
#include "vtkAssemblyNode.h"
#include "vtkAssemblyPath.h"
#include "vtkBoundingBox.h"
#include "vtkMapper.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkPropAssembly.h"
#include "vtkPropCollection.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <algorithm>

namespace
{

/// One of the renderer's props, or a part of one that is an assembly.
struct PropPart
{
  vtkProp* Prop;
  vtkProp* Whole;      ///< that the renderer has
  vtkMatrix4x4* Place; ///< matrix of a part; null: the prop has its own

  bool IsVisible() const { return this->Prop->GetVisibility() && this->Whole->GetVisibility(); }
};

/// Calls `use` for each PropPart of what a renderer has.
template <class Use>
void ForEachPart(vtkRenderer* renderer, const Use& use)
{
  vtkCollectionSimpleIterator position;
  vtkPropCollection* props = renderer->GetViewProps();
  props->InitTraversal(position);
  while (vtkProp* prop = props->GetNextProp(position))
  {
    if (!vtkAssembly::SafeDownCast(prop) && !vtkPropAssembly::SafeDownCast(prop))
    {
      use(PropPart{ prop, prop, nullptr });
      continue;
    }
    prop->InitPathTraversal();
    while (vtkAssemblyPath* path = prop->GetNextPath())
    {
      vtkAssemblyNode* last = path->GetLastNode();
      use(PropPart{ last->GetViewProp(), prop, last->GetMatrix() });
    }
  }
}

vtkAlgorithm* GetMapper(vtkProp* prop)
{
  if (auto* volume = vtkVolume::SafeDownCast(prop))
  {
    return volume->GetMapper();
  }
  auto* actor = vtkActor::SafeDownCast(prop);
  return actor ? actor->GetMapper() : nullptr;
}

bool HasBounds(vtkProp* prop)
{
  const double* bounds = prop->GetBounds();
  return bounds && vtkMath::AreBoundsInitialized(bounds);
}

/// Brings a part of an assembly to its place for as long as it lives, as assemblies do to draw theirs.
class Placing
{
public:
  explicit Placing(const vtkDSMSceneMembers::Member& member)
    : Prop(member.Place ? member.Prop : nullptr)
  {
    if (this->Prop)
    {
      this->Prop->PokeMatrix(member.Place);
    }
  }
  ~Placing()
  {
    if (this->Prop)
    {
      this->Prop->PokeMatrix(nullptr);
    }
  }
  Placing(const Placing&) = delete;
  Placing& operator=(const Placing&) = delete;

private:
  vtkProp3D* Prop;
};

} // namespace

void vtkDSMSceneMembers::Find(vtkRenderer* renderer)
{
  this->Shown.clear();
  std::vector<std::unique_ptr<vtkDSMSceneMember>> kept;
  ForEachPart(renderer,
    [&](const PropPart& part)
    {
      vtkAlgorithm* mapper = GetMapper(part.Prop);
      const auto known = std::find_if(this->States.begin(), this->States.end(),
        [=](const auto& state) { return state && mapper && state->GetAlgorithm() == mapper; });
      auto state =
        known == this->States.end() ? vtkDSMSceneMember::Create(mapper) : std::move(*known);
      if (!state)
      {
        return;
      }
      kept.push_back(std::move(state));
      if (part.IsVisible())
      {
        auto* prop = vtkProp3D::SafeDownCast(part.Prop);
        kept.back()->SetProp(prop);
        this->Shown.push_back({ prop, kept.back().get(), part.Place });
      }
    });
  // The remaining members belonged to props that were removed; their bricks leave the store.
  std::swap(this->States, kept);
  if (std::any_of(kept.begin(), kept.end(), [](const auto& left) { return left != nullptr; }))
  {
    kept.clear();
    dsm::FreedMemory::ReturnNowAndSoon();
  }
}

void vtkDSMSceneMembers::GiveUpBlocks()
{
  for (const auto& state : this->States)
  {
    state->GiveUpBlocks();
  }
}

int vtkDSMSceneMembers::CountCoarser() const
{
  int levels = 0;
  for (const Member& member : this->Shown)
  {
    levels = std::max(levels, member.State->CountCoarser());
  }
  return levels;
}

std::uint64_t vtkDSMSceneMembers::ChooseLevels(
  const rt::FrameRequest& request, double pixels, bool moving)
{
  bricks::ByteHash hash;
  for (Member& member : this->Shown)
  {
    const Placing placing(member);
    const std::uint64_t boxes = member.State->ChooseBoxes(request, pixels, moving);
    member.Level =
      pixels > 0.0 && boxes == 0 ? member.State->FindLevel(request, pixels, moving) : 0;
    hash.Add(&boxes, sizeof(boxes));
    hash.Add(&member.Level, sizeof(member.Level));
  }
  return hash.Get();
}

int vtkDSMSceneMembers::FindDraftLevel(const rt::FrameRequest& request, double pixels) const
{
  int level = 0;
  for (const Member& member : this->Shown)
  {
    const Placing placing(member);
    level = std::max(level, member.State->FindDraftLevel(request, pixels));
  }
  return level;
}

bool vtkDSMSceneMembers::HaveBoxes() const
{
  return std::any_of(this->Shown.begin(), this->Shown.end(),
    [](const Member& member) { return member.State->HasBoxes(); });
}

bool vtkDSMSceneMembers::NeedBoxes() const
{
  return std::any_of(this->Shown.begin(), this->Shown.end(),
    [](const Member& member) { return member.State->NeedsBoxes(); });
}

void vtkDSMSceneMembers::TakeBoxes(const std::shared_ptr<vtkDSMRankGroup>& group)
{
  for (const Member& member : this->Shown)
  {
    member.State->TakeBoxes(group);
  }
}

int vtkDSMSceneMembers::GetCoarsestChosen() const
{
  int level = 0;
  for (const Member& member : this->Shown)
  {
    level = std::max(level, member.Level);
  }
  return level;
}

int vtkDSMSceneMembers::GetFinestChosen() const
{
  int level = this->GetCoarsestChosen();
  for (const Member& member : this->Shown)
  {
    level = member.State->CountCoarser() > 0 ? std::min(level, member.Level) : level;
  }
  return level;
}

void vtkDSMSceneMembers::AddTo(rt::Scene& scene, int coarser) const
{
  scene.Objects.clear();
  scene.Media.clear();
  for (const Member& member : this->Shown)
  {
    const Placing placing(member);
    member.State->SetCoarser(std::max(member.Level, coarser));
    member.State->AddTo(scene);
  }
}

vtkDSMSceneMember* vtkDSMSceneMembers::FindOldestHidden() const
{
  vtkDSMSceneMember* oldest = nullptr;
  for (const auto& state : this->States)
  {
    const bool isShown = std::any_of(this->Shown.begin(), this->Shown.end(),
      [&](const Member& member) { return member.State == state.get(); });
    if (!isShown && state->HasBlocks() &&
      (!oldest || state->GetTimeShown() < oldest->GetTimeShown()))
    {
      oldest = state.get();
    }
  }
  return oldest;
}

void vtkDSMSceneMembers::GetBounds(double bounds[6]) const
{
  vtkBoundingBox box;
  for (const Member& member : this->Shown)
  {
    const Placing placing(member);
    if (HasBounds(member.Prop))
    {
      box.AddBounds(member.Prop->GetBounds());
    }
  }
  box.GetBounds(bounds);
}

std::vector<vtkProp*> vtkDSMSceneMembers::FindOthers(vtkRenderer* renderer) const
{
  std::vector<vtkProp*> others;
  ForEachPart(renderer,
    [&](const PropPart& part)
    {
      const auto isProp = [&](const Member& member) { return member.Prop == part.Prop; };
      // Props without bounds of their own are not objects.
      if (vtkProp3D::SafeDownCast(part.Prop) && part.IsVisible() && part.Prop->GetUseBounds() &&
        HasBounds(part.Prop) && std::none_of(this->Shown.begin(), this->Shown.end(), isProp) &&
        (others.empty() || others.back() != part.Whole))
      {
        others.push_back(part.Whole);
      }
    });
  return others;
}

void vtkDSMSceneMembers::ForwardOptions(
  vtkDSMLightOptions* light, vtkDSMMemoryOptions* memory) const
{
  for (const Member& member : this->Shown)
  {
    member.State->GetLightOptions()->ForwardTo(light);
    member.State->GetMemoryOptions()->ForwardTo(memory);
  }
}
