// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMScene.h"

#include "DSMRayTracing/frame/FrameGather.h"
#include "vtkDSMFrameProp.h"
#include "vtkDSMRankGroup.h"
#include "vtkDSMSceneVolume.h"
#include "vtkDSMStatistics.h"
#include "vtkDSMTranslation.h"
#include "vtkDSMVolumeMapper.h"

#include "vtkBoundingBox.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkMatrix4x4.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkPropCollection.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

namespace
{

/// After vtkSynchronizedRenderers (0), which brings the camera.
constexpr float TracePriority = -1.0f;

std::map<vtkRenderer*, vtkDSMScene*>& GetRegistry()
{
  static std::map<vtkRenderer*, vtkDSMScene*> registry;
  return registry;
}

} // namespace

class vtkDSMScene::Internals : public vtkDSMRankGroup::Publisher
{
public:
  ~Internals() override;
  void GiveUpBlocks() override;

  struct Member
  {
    vtkVolume* Volume;
    vtkDSMSceneVolume* State;
  };

  void FindMembers();
  void FindGroup(vtkMultiProcessController* controller);
  void Configure();
  void Update();
  void Draw();
  void DrawLast(const rt::Scene& scene);
  void Clear();

  vtkWeakPointer<vtkRenderer> Renderer;
  unsigned long Observer = 0;
  vtkSmartPointer<vtkMultiProcessController> Controller;
  vtkNew<vtkDSMFrameProp> Prop;
  vtkNew<vtkDSMStatistics> Statistics;
  std::shared_ptr<vtkDSMRankGroup> Group;
  std::vector<std::unique_ptr<vtkDSMSceneVolume>> Volumes;
  std::vector<Member> Members;                ///< of the frame, in the renderer's order
  std::string Failure;                        ///< that was reported last
  std::function<bool(vtkCamera*)> DrawsColor; ///< set: the frame is delivered everywhere
  bool Tracing = false;
  vtkDSMMemorySettings Settings; ///< that the volumes ask for
};

vtkStandardNewMacro(vtkDSMScene);

vtkDSMScene::vtkDSMScene()
  : Self(std::make_unique<Internals>())
{
}

vtkDSMScene::~vtkDSMScene()
{
  auto& registry = GetRegistry();
  for (auto entry = registry.begin(); entry != registry.end();)
  {
    entry = entry->second == this ? registry.erase(entry) : std::next(entry);
  }
  if (vtkRenderer* renderer = this->Self->Renderer)
  {
    renderer->RemoveObserver(this->Self->Observer);
    renderer->RemoveViewProp(this->Self->Prop);
  }
}

vtkSmartPointer<vtkDSMScene> vtkDSMScene::ForRenderer(vtkRenderer* renderer)
{
  vtkDSMScene*& known = GetRegistry()[renderer];
  // The address of a renderer that is gone may be another's now.
  if (known && known->GetRenderer() == renderer)
  {
    return known;
  }
  vtkSmartPointer<vtkDSMScene> scene;
  scene.TakeReference(vtkDSMScene::New());
  known = scene;
  scene->Attach(renderer);
  return scene;
}

void vtkDSMScene::Attach(vtkRenderer* renderer)
{
  this->Self->Renderer = renderer;
  this->Self->Observer =
    renderer->AddObserver(vtkCommand::StartEvent, this, &vtkDSMScene::Trace, TracePriority);
  renderer->AddViewProp(this->Self->Prop);
}

void vtkDSMScene::SetController(vtkMultiProcessController* controller)
{
  if (this->Self->Controller != controller)
  {
    this->Self->Controller = controller;
    this->Modified();
  }
}

vtkMultiProcessController* vtkDSMScene::GetController() const
{
  return this->Self->Controller ? this->Self->Controller.Get()
                                : vtkMultiProcessController::GetGlobalController();
}

vtkRenderer* vtkDSMScene::GetRenderer() const
{
  return this->Self->Renderer;
}

void vtkDSMScene::DeliverTiles()
{
  this->Self->DrawsColor = nullptr;
}

void vtkDSMScene::DeliverEverywhere(std::function<bool(vtkCamera*)> drawsColor)
{
  this->Self->DrawsColor = std::move(drawsColor);
}

vtkDSMStatistics* vtkDSMScene::GetStatistics() const
{
  return this->Self->Statistics;
}

void vtkDSMScene::Internals::FindMembers()
{
  this->Members.clear();
  std::vector<std::unique_ptr<vtkDSMSceneVolume>> kept;
  vtkCollectionSimpleIterator position;
  vtkPropCollection* props = this->Renderer->GetViewProps();
  props->InitTraversal(position);
  while (vtkProp* prop = props->GetNextProp(position))
  {
    auto* volume = vtkVolume::SafeDownCast(prop);
    auto* mapper = volume ? vtkDSMVolumeMapper::SafeDownCast(volume->GetMapper()) : nullptr;
    if (!mapper)
    {
      continue;
    }
    auto known = std::find_if(this->Volumes.begin(), this->Volumes.end(),
      [=](const auto& candidate) { return candidate && candidate->GetMapper() == mapper; });
    kept.push_back(known == this->Volumes.end() ? std::make_unique<vtkDSMSceneVolume>(mapper)
                                                : std::move(*known));
    if (volume->GetVisibility())
    {
      this->Members.push_back({ volume, kept.back().get() });
    }
  }
  // What is left belonged to volumes that were removed; their bricks leave the store.
  this->Volumes = std::move(kept);
}

void vtkDSMScene::Internals::FindGroup(vtkMultiProcessController* controller)
{
  const auto group = vtkDSMRankGroup::Get(controller);
  if (group == this->Group)
  {
    return;
  }
  if (this->Group)
  {
    this->GiveUpBlocks();
    this->Group->Leave(this);
  }
  this->Group = group;
  this->Group->Join(this);
}

vtkDSMScene::Internals::~Internals()
{
  if (this->Group)
  {
    this->Group->Leave(this);
  }
}

void vtkDSMScene::Internals::GiveUpBlocks()
{
  for (const auto& volume : this->Volumes)
  {
    volume->GiveUpBlocks();
  }
}

void vtkDSMScene::Internals::Configure()
{
  this->Settings = {};
  for (const auto& volume : this->Volumes)
  {
    this->Settings.Merge(volume->GetMemorySettings());
  }
  this->Group->Configure(this, this->Settings);
}

void vtkDSMScene::Internals::Update()
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  // To publish in step, the ranks must agree on the settings of the memory; threads may differ.
  const vtkDSMMemorySettings& settings = this->Settings;
  using Digest = std::array<std::uint64_t, 4>;
  std::vector<std::byte> mine =
    dsm::Encode(Digest{ static_cast<std::uint64_t>(settings.Organization),
      settings.HostSharing ? 1u : 0u, settings.MemoryBytes, settings.CacheBytes });
  for (const Member& member : this->Members)
  {
    member.State->GetMapper()->UpdatePiece(messenger.GetRank(), messenger.GetSize());
    mine.push_back(std::byte(member.State->HasNewData() ? 1 : 0));
  }
  // One rank's change time says nothing of another's.
  const auto all = messenger.AllGather(mine);
  for (const auto& flags : all)
  {
    if (flags.size() != all.front().size())
    {
      throw dsm::Error("The ranks do not show the same volumes; the frame was left out.");
    }
    if (!std::equal(flags.begin(), flags.begin() + sizeof(Digest), all.front().begin()))
    {
      throw dsm::Error("The ranks have different settings of the memory (DSMMemoryOrganization, "
                       "DSMHostSharing, DSMMemory, DSMCacheSize); the frame was left out. Set them "
                       "alike.");
    }
  }
  for (std::size_t index = 0; index < this->Members.size(); ++index)
  {
    const bool newData = std::any_of(all.begin(), all.end(),
      [=](const auto& flags) { return flags[sizeof(Digest) + index] != std::byte(0); });
    this->Members[index].State->Update(this->Group, newData);
  }
}

void vtkDSMScene::Internals::Draw()
{
  rt::Scene scene;
  vtkBoundingBox box;
  for (const Member& member : this->Members)
  {
    member.State->AddTo(scene, member.Volume);
    if (const double* bounds = member.Volume->GetBounds())
    {
      box.AddBounds(bounds);
    }
  }
  if (scene.Isosurfaces.empty())
  {
    this->Clear();
    return;
  }
  this->DrawLast(scene);
  scene.Lights = vtkDSMTranslation::ToLights(this->Renderer);
  vtkNew<vtkMatrix4x4> projection;
  const rt::FrameRequest request = vtkDSMTranslation::ToRequest(this->Renderer, projection);
  const rt::Frame frame =
    this->Group->GetFrameRenderer().Render(this->Group->GetStore(), scene, request);
  this->Statistics->Gather(this->Group->GetMessenger(), frame);
  double bounds[6];
  box.GetBounds(bounds);
  if (!this->DrawsColor)
  {
    this->Prop->SetFrame(frame, projection, bounds);
    return;
  }
  const bool drawsColor = this->DrawsColor(this->Renderer->GetActiveCamera());
  rt::Picture picture = rt::GatherFrame(this->Group->GetMessenger(), frame);
  rt::Frame whole;
  whole.Width = picture.Width;
  whole.Height = picture.Height;
  whole.Tiles.resize(1);
  whole.Tiles[0].Width = picture.Width;
  whole.Tiles[0].Height = picture.Height;
  whole.Tiles[0].Color = std::move(picture.Color);
  whole.Tiles[0].Depth = std::move(picture.Depth);
  this->Prop->SetFrame(whole, projection, bounds, drawsColor);
}

/// What shows through a translucent surface must have been drawn before it.
void vtkDSMScene::Internals::DrawLast(const rt::Scene& scene)
{
  const bool translucent = std::any_of(scene.Isosurfaces.begin(), scene.Isosurfaces.end(),
    [](const rt::IsosurfaceObject& object) { return object.Surface.Opacity < 1.0f; });
  if (translucent && this->Renderer->GetViewProps()->GetLastProp() != this->Prop)
  {
    this->Renderer->RemoveViewProp(this->Prop);
    this->Renderer->AddViewProp(this->Prop);
  }
}

void vtkDSMScene::Internals::Clear()
{
  this->Prop->Clear();
  this->Statistics->Clear();
}

void vtkDSMScene::Trace()
{
  Internals& self = *this->Self;
  // A selection pass shows no traced surface; taking in data may make an application render.
  if (!self.Renderer || self.Renderer->GetSelector() || self.Tracing)
  {
    return;
  }
  self.Tracing = true;
  self.FindMembers();
  if (self.Members.empty())
  {
    self.Clear();
    self.Tracing = false;
    return;
  }
  std::string failure;
  try
  {
    self.FindGroup(this->GetController());
    self.Configure();
    self.Update();
    self.Draw();
    self.Group->TellOrganization();
  }
  catch (const std::exception& error)
  {
    failure = error.what();
    self.Clear();
  }
  for (const Internals::Member& member : self.Members)
  {
    member.State->ReportMessages();
  }
  if (!failure.empty() && failure != self.Failure)
  {
    vtkErrorMacro(<< failure);
  }
  self.Failure = failure;
  self.Tracing = false;
}

void vtkDSMScene::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Renderer: " << this->Self->Renderer.Get() << "\n";
  os << indent << "Volumes: " << this->Self->Volumes.size() << "\n";
  this->Self->Statistics->PrintSelf(os, indent.GetNextIndent());
}
