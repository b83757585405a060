// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMScene.h"

#include "DSMRayTracing/frame/FrameGather.h"
#include "vtkDSMFrameProp.h"
#include "vtkDSMPolyDataMapper.h"
#include "vtkDSMRankGroup.h"
#include "vtkDSMSceneMesh.h"
#include "vtkDSMSceneVolume.h"
#include "vtkDSMStatistics.h"
#include "vtkDSMTranslation.h"
#include "vtkDSMVolumeMapper.h"

#include "vtkActor.h"
#include "vtkBoundingBox.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkMapper.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkPropCollection.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <algorithm>
#include <map>
#include <optional>
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

class vtkDSMScene::Internals
{
public:
  struct Member
  {
    vtkProp3D* Prop;
    vtkDSMSceneMember* State;
  };

  static std::unique_ptr<vtkDSMSceneMember> CreateState(vtkAlgorithm* mapper);
  void FindMembers();
  void Configure();
  void Update();
  void Draw();
  void GetBounds(double bounds[6]) const;
  void DrawLast(const rt::Scene& scene);
  void Clear();

  vtkWeakPointer<vtkRenderer> Renderer;
  unsigned long Observer = 0;
  vtkSmartPointer<vtkMultiProcessController> Controller;
  vtkNew<vtkDSMFrameProp> Prop;
  vtkNew<vtkDSMStatistics> Statistics;
  std::shared_ptr<vtkDSMRankGroup> Group;
  std::vector<std::unique_ptr<vtkDSMSceneMember>> States;
  std::vector<Member> Members;                ///< of the frame, in the renderer's order
  std::string Failure;                        ///< that was reported last
  std::function<bool(vtkCamera*)> DrawsColor; ///< set: the frame is delivered everywhere
  bool Tracing = false;
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

/// Null for what is not traced.
std::unique_ptr<vtkDSMSceneMember> vtkDSMScene::Internals::CreateState(vtkAlgorithm* mapper)
{
  if (auto* volumeMapper = vtkDSMVolumeMapper::SafeDownCast(mapper))
  {
    return std::make_unique<vtkDSMSceneVolume>(volumeMapper);
  }
  if (auto* polyDataMapper = vtkDSMPolyDataMapper::SafeDownCast(mapper))
  {
    return std::make_unique<vtkDSMSceneMesh>(polyDataMapper);
  }
  return nullptr;
}

void vtkDSMScene::Internals::FindMembers()
{
  this->Members.clear();
  std::vector<std::unique_ptr<vtkDSMSceneMember>> kept;
  vtkCollectionSimpleIterator position;
  vtkPropCollection* props = this->Renderer->GetViewProps();
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
    auto state = known == this->States.end() ? CreateState(mapper) : std::move(*known);
    if (!state)
    {
      continue;
    }
    kept.push_back(std::move(state));
    if (prop->GetVisibility())
    {
      this->Members.push_back({ vtkProp3D::SafeDownCast(prop), kept.back().get() });
    }
  }
  // What is left belonged to props that were removed; their bricks leave the store.
  this->States = std::move(kept);
}

void vtkDSMScene::Internals::Configure()
{
  int cache = 1;
  int threads = 0;
  for (const Member& member : this->Members)
  {
    cache = std::max(cache, member.State->GetCacheSize());
    threads = std::max(threads, member.State->GetNumberOfThreads());
  }
  this->Group->Configure(static_cast<std::size_t>(cache) << 20, threads);
}

void vtkDSMScene::Internals::Update()
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  std::vector<std::byte> mine;
  messenger.RunTogether("Updating the data",
    [&]
    {
      this->Configure();
      for (const Member& member : this->Members)
      {
        member.State->UpdatePiece(messenger.GetRank(), messenger.GetSize());
        mine.push_back(std::byte(member.State->HasNewData() ? 1 : 0));
      }
    });
  // One rank's change time says nothing of another's.
  const auto all = messenger.AllGather(mine);
  for (const auto& flags : all)
  {
    if (flags.size() != all.front().size())
    {
      throw dsm::Error("The ranks do not show the same datasets; the frame was left out.");
    }
  }
  for (std::size_t index = 0; index < mine.size(); ++index)
  {
    const bool newData = std::any_of(
      all.begin(), all.end(), [=](const auto& flags) { return flags[index] != std::byte(0); });
    this->Members[index].State->Update(this->Group, newData);
  }
}

void vtkDSMScene::Internals::Draw()
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  rt::Scene scene;
  rt::FrameRequest request;
  vtkNew<vtkMatrix4x4> projection;
  messenger.RunTogether("Preparing the frame",
    [&]
    {
      for (const Member& member : this->Members)
      {
        member.State->AddTo(scene, member.Prop);
      }
      this->DrawLast(scene);
      scene.Lights = vtkDSMTranslation::ToLights(this->Renderer);
      request = vtkDSMTranslation::ToRequest(this->Renderer, projection);
    });
  if (scene.Isosurfaces.empty() && scene.Meshes.empty())
  {
    this->Clear();
    return;
  }
  const rt::Frame frame =
    this->Group->GetFrameRenderer().Render(this->Group->GetStore(), scene, request);
  this->Statistics->Gather(messenger, frame);
  std::optional<rt::Picture> whole;
  if (this->DrawsColor)
  {
    whole = rt::GatherFrame(messenger, frame);
  }
  messenger.RunTogether("Showing the frame",
    [&]
    {
      double bounds[6];
      this->GetBounds(bounds);
      const bool drawsColor = !whole || this->DrawsColor(this->Renderer->GetActiveCamera());
      this->Prop->SetFrame(
        whole ? std::move(*whole) : rt::AssembleTiles(frame), projection, bounds, drawsColor);
    });
}

/// Of what is drawn, in world space.
void vtkDSMScene::Internals::GetBounds(double bounds[6]) const
{
  vtkBoundingBox box;
  for (const Member& member : this->Members)
  {
    const double* part = member.Prop->GetBounds();
    if (part && vtkMath::AreBoundsInitialized(part))
    {
      box.AddBounds(part);
    }
  }
  box.GetBounds(bounds);
}

/// What shows through a translucent surface must have been drawn before it.
void vtkDSMScene::Internals::DrawLast(const rt::Scene& scene)
{
  const bool translucent =
    std::any_of(scene.Isosurfaces.begin(), scene.Isosurfaces.end(),
      [](const rt::IsosurfaceObject& object) { return object.Surface.Opacity < 1.0f; }) ||
    std::any_of(scene.Meshes.begin(), scene.Meshes.end(),
      [](const rt::MeshObject& object)
      {
        return object.Surface.Opacity < 1.0f ||
          object.ColoredBy == rt::MeshObject::Coloring::Colors ||
          (object.BackSurface && object.BackSurface->Opacity < 1.0f);
      });
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
    self.Group = vtkDSMRankGroup::Get(this->GetController());
    self.Update();
    self.Draw();
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
  os << indent << "Mappers: " << this->Self->States.size() << "\n";
  this->Self->Statistics->PrintSelf(os, indent.GetNextIndent());
}
