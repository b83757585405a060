// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMScene.h"

#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/frame/SceneDigest.h"
#include "vtkDSMFrameLayers.h"
#include "vtkDSMFrameNotes.h"
#include "vtkDSMFrameProp.h"
#include "vtkDSMLightOptions.h"
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
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkPropCollection.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <vector>

namespace
{

/// After vtkSynchronizedRenderers (0), which brings the camera.
constexpr float TracePriority = -1.0f;
/// Before vtkSynchronizedRenderers, which makes it black while the ranks render.
constexpr float BackgroundPriority = 1.0f;

/// Frames per second; an application that wants as many from its window is moving the camera.
constexpr double InteractiveRate = 1.0;

/// Of the diagonal of what is shown: as far as ambient occlusion looks when nothing is said.
constexpr double AmbientOcclusionPart = 0.2;

/// Leaves OpenGL as it was found: an application that shows progress and messages draws windows of its
/// own meanwhile.
class OpenGLGuard
{
public:
  explicit OpenGLGuard(vtkRenderWindow* window)
    : Window(vtkOpenGLRenderWindow::SafeDownCast(window))
  {
    if (this->Window && !this->Window->IsCurrent())
    {
      this->Window = nullptr; // nothing is being drawn
    }
    if (this->Window)
    {
      this->Window->GetState()->Push();
    }
  }
  ~OpenGLGuard()
  {
    if (this->Window)
    {
      this->Window->MakeCurrent();
      this->Window->GetState()->Pop();
    }
  }
  OpenGLGuard(const OpenGLGuard&) = delete;
  OpenGLGuard& operator=(const OpenGLGuard&) = delete;

private:
  vtkOpenGLRenderWindow* Window;
};

/// Whether matrices differ by rounding only.
bool IsNearly(const glm::dmat4& a, const glm::dmat4& b)
{
  constexpr double tolerance = 1e-9;
  double difference = 0.0;
  double largest = 0.0;
  for (int element = 0; element < 16; ++element)
  {
    const double one = a[element / 4][element % 4];
    const double other = b[element / 4][element % 4];
    difference = std::max(difference, std::abs(one - other));
    largest = std::max(largest, std::abs(one));
  }
  return difference <= tolerance * largest;
}

std::map<vtkRenderer*, vtkDSMScene*>& GetRegistry()
{
  static std::map<vtkRenderer*, vtkDSMScene*> registry;
  return registry;
}

bool IsTranslucent(const rt::ColorMap& map)
{
  return std::any_of(
    map.Table.begin(), map.Table.end(), [](const glm::vec4& color) { return color.w < 1.0f; });
}

/// Whether anything may be seen through what the tracer draws.
bool IsTranslucent(const rt::Scene& scene)
{
  return std::any_of(scene.Isosurfaces.begin(), scene.Isosurfaces.end(),
           [](const rt::IsosurfaceObject& object) {
             return object.Surface.Opacity < 1.0f ||
               (object.ColorField && IsTranslucent(object.Colors));
           }) ||
    std::any_of(scene.Meshes.begin(), scene.Meshes.end(),
      [](const rt::MeshObject& object)
      {
        return object.Surface.Opacity < 1.0f ||
          object.ColoredBy == rt::MeshObject::Coloring::Colors ||
          (object.Colors && IsTranslucent(*object.Colors)) ||
          (object.BackSurface && object.BackSurface->Opacity < 1.0f);
      });
}

} // namespace

class vtkDSMScene::Internals : public vtkDSMRankGroup::Publisher
{
public:
  ~Internals() override;
  void GiveUpBlocks() override;

  struct Member
  {
    vtkProp3D* Prop;
    vtkDSMSceneMember* State;
  };

  static std::unique_ptr<vtkDSMSceneMember> CreateState(vtkAlgorithm* mapper);
  void FindMembers();
  void FindGroup(vtkMultiProcessController* controller);
  void Configure();
  void Update();
  void Draw();
  void GetBounds(double bounds[6]) const;
  void DrawLast(const rt::Scene& scene);
  void Clear();
  rt::LightTransport GetTransport() const;
  double GetEnvironmentLight() const;
  rt::DebugView GetDebugView() const;
  void AgreeOnView(rt::Scene& scene, rt::FrameRequest& request) const;
  bool ShowsOthers() const;
  void DrawPicture(rt::Picture picture, const rt::FrameRequest& request, vtkMatrix4x4* projection,
    rt::DebugView view);
  bool WriteNotes(rt::DebugView view, rt::Picture& picture) const;
  void AddWholeView(const rt::FrameRequest& request, double bounds[6]) const;
  void LeaveToOthers(const rt::FrameRequest& request, rt::Picture& picture) const;
  int CountSamplesOfFrame(int missing) const;
  void TraceSamples(const rt::Scene& scene, rt::FrameRequest& request);

  vtkWeakPointer<vtkRenderer> Renderer;
  unsigned long Observers[4] = { 0, 0, 0, 0 };
  vtkSmartPointer<vtkDSMScene> Keeper; ///< the scene itself, when nobody but the renderer has it
  /// Of this rank's renderer, as the application set them; the same when there is no gradient.
  struct Backdrop
  {
    glm::dvec3 Up{ 0.0, 1.0, 0.0 };
    glm::vec3 Lower{ 0.0f };
    glm::vec3 Upper{ 0.0f };
  } Background;
  vtkSmartPointer<vtkMultiProcessController> Controller;
  vtkNew<vtkDSMFrameProp> Prop;
  vtkNew<vtkDSMStatistics> Statistics;
  std::shared_ptr<vtkDSMRankGroup> Group;
  std::vector<std::unique_ptr<vtkDSMSceneMember>> States;
  std::vector<Member> Members;                ///< of the frame, in the renderer's order
  std::string Failure;                        ///< that was reported last
  std::function<bool(vtkCamera*)> DrawsColor; ///< set: the frame is delivered everywhere
  std::function<bool(const double[3])> DrawsPlace;
  bool Tracing = false;
  int SamplesPerFrame = 0;
  /// The last frame, and what it shows; further samples are added while that stays the same.
  rt::Frame Frame;
  double Bounds[6] = { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 }; ///< of what it shows
  std::uint64_t Digest = 0;
  int Samples = 0; ///< that the frame has; 0 when there is nothing to add to
  int SamplesWanted = 1;
  vtkDSMMemorySettings Settings; ///< that the objects ask for
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
    for (const unsigned long observer : this->Self->Observers)
    {
      renderer->RemoveObserver(observer);
    }
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

vtkDSMScene* vtkDSMScene::NewForRenderer(vtkRenderer* renderer)
{
  const vtkSmartPointer<vtkDSMScene> scene = ForRenderer(renderer);
  scene->Register(nullptr);
  return scene;
}

void vtkDSMScene::DrawWithoutScene(vtkRenderer* renderer, vtkObject* mapper)
{
  const auto known = GetRegistry().find(renderer);
  if (known != GetRegistry().end() && known->second->GetRenderer() == renderer)
  {
    return;
  }
  auto* controller = vtkMultiProcessController::GetGlobalController();
  if (controller && controller->GetNumberOfProcesses() > 1)
  {
    static std::set<vtkWeakPointer<vtkRenderer>> told;
    if (told.insert(renderer).second)
    {
      vtkErrorWithObjectMacro(mapper,
        << controller->GetNumberOfProcesses()
        << " processes render, but the renderer has no scene. "
        << "Call vtkDSMScene::ForRenderer(renderer) on every rank before the first frame, and keep "
        << "what it returns.");
    }
    return;
  }
  const vtkSmartPointer<vtkDSMScene> scene = ForRenderer(renderer);
  scene->Self->Keeper = scene;
  scene->NoteBackground();
  scene->Trace();
  scene->Self->Prop->RenderOpaqueGeometry(renderer);
}

void vtkDSMScene::EndWithRenderer()
{
  // This may be the last reference, so `this` may be gone when it returns.
  const vtkSmartPointer<vtkDSMScene> last = std::move(this->Self->Keeper);
}

/// What was added to the bounds for the frame's delivery must not be seen by who looks for all there is.
void vtkDSMScene::EndFrame()
{
  this->Self->Prop->SetBounds(this->Self->Bounds);
}

void vtkDSMScene::Attach(vtkRenderer* renderer)
{
  this->Self->Renderer = renderer;
  this->Self->Observers[0] = renderer->AddObserver(
    vtkCommand::StartEvent, this, &vtkDSMScene::NoteBackground, BackgroundPriority);
  this->Self->Observers[1] =
    renderer->AddObserver(vtkCommand::StartEvent, this, &vtkDSMScene::Trace, TracePriority);
  this->Self->Observers[3] =
    renderer->AddObserver(vtkCommand::EndEvent, this, &vtkDSMScene::EndFrame);
  this->Self->Observers[2] =
    renderer->AddObserver(vtkCommand::DeleteEvent, this, &vtkDSMScene::EndWithRenderer);
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
  this->Self->DrawsPlace = nullptr;
}

void vtkDSMScene::DeliverEverywhere()
{
  this->DeliverEverywhere([](vtkCamera*) { return true; });
}

void vtkDSMScene::DeliverEverywhere(std::function<bool(vtkCamera*)> drawsColor)
{
  this->Self->DrawsColor = std::move(drawsColor);
  this->Self->DrawsPlace = nullptr;
}

void vtkDSMScene::DeliverByPlace(
  std::function<bool(vtkCamera*)> drawsColor, std::function<bool(const double place[3])> drawsPlace)
{
  this->Self->DrawsColor = std::move(drawsColor);
  this->Self->DrawsPlace = std::move(drawsPlace);
}

void vtkDSMScene::SetHidden(bool hidden)
{
  this->Self->Prop->SetVisibility(!hidden);
}

void vtkDSMScene::SetSamplesPerFrame(int samples)
{
  this->Self->SamplesPerFrame = std::max(0, samples);
}

int vtkDSMScene::GetSamplesPerFrame() const
{
  return this->Self->SamplesPerFrame;
}

bool vtkDSMScene::IsRefined() const
{
  return this->Self->Samples == 0 || this->Self->Samples >= this->Self->SamplesWanted;
}

bool vtkDSMScene::IsTracing() const
{
  return this->Self->Tracing;
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
      kept.back()->SetProp(vtkProp3D::SafeDownCast(prop));
      this->Members.push_back({ vtkProp3D::SafeDownCast(prop), kept.back().get() });
    }
  }
  // What is left belonged to props that were removed; their bricks leave the store.
  this->States = std::move(kept);
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
  for (const auto& state : this->States)
  {
    state->GiveUpBlocks();
  }
  this->Samples = 0;
}

void vtkDSMScene::Internals::Configure()
{
  this->Settings = {};
  this->SamplesWanted = 1;
  for (const auto& state : this->States)
  {
    this->Settings.Merge(vtkDSMTranslation::ToMemorySettings(state->GetMemoryOptions()));
  }
  for (const Member& member : this->Members)
  {
    this->SamplesWanted =
      std::max(this->SamplesWanted, member.State->GetLightOptions()->GetSamplesPerPixel());
  }
  this->Group->Configure(this, this->Settings);
}

void vtkDSMScene::Internals::Update()
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  // To publish in step, the ranks must agree on the settings of the memory; threads may differ.
  using Digest = std::array<std::uint64_t, 4>;
  std::vector<std::byte> mine;
  messenger.RunTogether("Updating the data",
    [&]
    {
      this->Configure();
      const vtkDSMMemorySettings& settings = this->Settings;
      mine = dsm::Encode(Digest{ static_cast<std::uint64_t>(settings.Organization),
        settings.HostSharing ? 1u : 0u, settings.MemoryBytes, settings.CacheBytes });
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
  dsm::Messenger& messenger = this->Group->GetMessenger();
  rt::Scene scene;
  rt::FrameRequest request;
  vtkNew<vtkMatrix4x4> projection;
  messenger.RunTogether("Preparing the frame",
    [&]
    {
      for (const Member& member : this->Members)
      {
        member.State->AddTo(scene);
      }
      this->DrawLast(scene);
      scene.Lights = vtkDSMTranslation::ToLights(this->Renderer);
      scene.Transport = this->GetTransport();
      scene.View = this->GetDebugView();
      request = vtkDSMTranslation::ToRequest(this->Renderer, projection);
      request.Scheduling = this->Settings.Scheduling;
    });
  if (scene.Isosurfaces.empty() && scene.Meshes.empty())
  {
    this->Clear();
    return;
  }
  this->AgreeOnView(scene, request);
  this->TraceSamples(scene, request);
  std::optional<rt::Picture> whole;
  if (this->DrawsColor)
  {
    whole = rt::GatherFrame(messenger, this->Frame);
  }
  messenger.RunTogether("Showing the frame",
    [&]
    {
      this->DrawPicture(whole ? std::move(*whole) : rt::AssembleTiles(this->Frame), request,
        projection, scene.View);
    });
}

void vtkDSMScene::Internals::DrawPicture(rt::Picture picture, const rt::FrameRequest& request,
  vtkMatrix4x4* projection, rt::DebugView view)
{
  this->GetBounds(this->Bounds);
  double bounds[6];
  std::copy_n(this->Bounds, 6, bounds);
  if (request.Layers > 1)
  {
    vtkDSMFrameLayers::Separate(picture);
    if (this->DrawsPlace)
    {
      this->LeaveToOthers(request, picture);
    }
  }
  // Where the ranks' pictures are blended, each has the notes; where the nearest counts, one does.
  const bool writesNotes = this->DrawsColor || this->Group->GetMessenger().GetRank() == 0;
  rt::Picture unseen;
  if (this->WriteNotes(view, writesNotes ? picture : unseen))
  {
    this->AddWholeView(request, bounds);
  }
  if (request.Layers > 1)
  {
    this->Prop->SetLayers(picture, projection, bounds);
    return;
  }
  const bool drawsColor = !this->DrawsColor || this->DrawsColor(this->Renderer->GetActiveCamera());
  this->Prop->SetFrame(std::move(picture), projection, bounds, drawsColor);
}

/// Returns whether there is anything to write, on any rank.
bool vtkDSMScene::Internals::WriteNotes(rt::DebugView view, rt::Picture& picture) const
{
  bool showsStatistics = false;
  bool showsLegend = view != rt::DebugView::Off;
  for (const Member& member : this->Members)
  {
    vtkDSMLightOptions* options = member.State->GetLightOptions();
    showsStatistics = showsStatistics || options->GetShowStatistics();
    showsLegend = showsLegend && options->GetShowLegend();
  }
  if (!showsStatistics && !showsLegend)
  {
    return false;
  }
  std::vector<vtkDSMFrameNotes::Entry> legend;
  if (showsLegend)
  {
    legend = vtkDSMFrameNotes::CreateLegend(view, this->Statistics);
  }
  vtkDSMFrameNotes::Draw(
    showsStatistics ? this->Statistics->GetSummary() : std::string(), legend, picture);
  return true;
}

/// Ranks exchange only the part of the picture where there is anything by the bounds.
void vtkDSMScene::Internals::AddWholeView(const rt::FrameRequest& request, double bounds[6]) const
{
  if (this->Group->GetMessenger().GetSize() == 1)
  {
    return;
  }
  vtkBoundingBox box(bounds);
  const glm::dmat4 clipToWorld = glm::inverse(request.WorldToClip);
  for (int corner = 0; corner < 4; ++corner)
  {
    const glm::dvec4 world =
      clipToWorld * glm::dvec4(corner % 2 == 0 ? -1.0 : 1.0, corner < 2 ? -1.0 : 1.0, 0.0, 1.0);
    box.AddPoint(world.x / world.w, world.y / world.w, world.z / world.w);
  }
  box.GetBounds(bounds);
}

/// Takes out what other ranks draw.
void vtkDSMScene::Internals::LeaveToOthers(
  const rt::FrameRequest& request, rt::Picture& picture) const
{
  const glm::dmat4 clipToWorld = glm::inverse(request.WorldToClip);
  const std::size_t pixels = static_cast<std::size_t>(picture.Width) * picture.Height;
  for (std::size_t place = 0; place < pixels * picture.Layers; ++place)
  {
    std::uint8_t& alpha = picture.Color[4 * place + 3];
    if (alpha == 0)
    {
      continue;
    }
    const std::size_t pixel = place % pixels;
    const double x = static_cast<double>(pixel % picture.Width) + 0.5;
    const double y = static_cast<double>(pixel / picture.Width) + 0.5;
    const glm::dvec4 clip(2.0 * x / picture.Width - 1.0, 2.0 * y / picture.Height - 1.0,
      2.0 * static_cast<double>(picture.Depth[place]) - 1.0, 1.0);
    const glm::dvec4 world = clipToWorld * clip;
    const double point[3] = { world.x / world.w, world.y / world.w, world.z / world.w };
    alpha = this->DrawsPlace(point) ? alpha : std::uint8_t{ 0 };
  }
}

rt::DebugView vtkDSMScene::Internals::GetDebugView() const
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
  for (const Member& member : this->Members)
  {
    if (const int view = member.State->GetLightOptions()->GetDebugView())
    {
      return static_cast<rt::DebugView>(view);
    }
  }
  return rt::DebugView::Off;
}

/// Whether the renderer has anything to show that may be behind, or between, translucent surfaces.
bool vtkDSMScene::Internals::ShowsOthers() const
{
  vtkCollectionSimpleIterator position;
  vtkPropCollection* props = this->Renderer->GetViewProps();
  props->InitTraversal(position);
  while (vtkProp* prop = props->GetNextProp(position))
  {
    const auto isProp = [=](const Member& member) { return member.Prop == prop; };
    // What cannot be picked, such as axes, is decoration; what has no bounds of its own is no object.
    if (vtkProp3D::SafeDownCast(prop) && prop->GetVisibility() && prop->GetPickable() &&
      prop->GetUseBounds() && std::none_of(this->Members.begin(), this->Members.end(), isProp))
    {
      return true;
    }
  }
  return false;
}

/// Collective. Takes rank 0's view: the camera that came from there is not always the same to the last
/// bit, ParaView's other ranks have no background, which gives light and which mirrored rays see where
/// they meet nothing, and lights may follow the camera. A camera that differs by more than rounding is left to be refused.
/// Surfaces are kept apart when any rank has something that may be between them.
void vtkDSMScene::Internals::AgreeOnView(rt::Scene& scene, rt::FrameRequest& request) const
{
  struct View
  {
    glm::dmat4 WorldToClip;
    Backdrop Background;
    std::uint64_t IsApart;
  };
  const bool canBeApart = this->Group->GetMessenger().GetSize() == 1 || this->DrawsPlace;
  const bool isApart = canBeApart && IsTranslucent(scene) && this->ShowsOthers();
  std::vector<std::byte> mine =
    dsm::Encode(View{ request.WorldToClip, this->Background, isApart ? 1u : 0u });
  for (const rt::Light& light : scene.Lights)
  {
    dsm::AttachTail(mine, light);
  }
  const auto all = this->Group->GetMessenger().AllGather(std::move(mine));
  request.Layers = 1;
  for (const std::vector<std::byte>& other : all)
  {
    View theirs;
    std::memcpy(&theirs, other.data(), sizeof(theirs));
    request.Layers = theirs.IsApart != 0 ? rt::FrameRequest::MaxLayers : request.Layers;
  }
  const std::vector<std::byte>& first = all.front();
  View view;
  std::memcpy(&view, first.data(), sizeof(view));
  scene.Transport.Background = view.Background.Lower;
  const float strength = static_cast<float>(this->GetEnvironmentLight());
  scene.Transport.Surroundings.Up = view.Background.Up;
  scene.Transport.Surroundings.Lower = strength * view.Background.Lower;
  scene.Transport.Surroundings.Upper = strength * view.Background.Upper;
  scene.Lights.resize((first.size() - sizeof(view)) / sizeof(rt::Light));
  for (std::size_t index = 0; index < scene.Lights.size(); ++index)
  {
    std::memcpy(&scene.Lights[index], first.data() + sizeof(view) + index * sizeof(rt::Light),
      sizeof(rt::Light));
  }
  if (IsNearly(view.WorldToClip, request.WorldToClip))
  {
    request.WorldToClip = view.WorldToClip;
  }
}

/// Collective. Traces the frame, or what is missing of it.
void vtkDSMScene::Internals::TraceSamples(const rt::Scene& scene, rt::FrameRequest& request)
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  std::uint64_t digest = 0;
  if (this->SamplesWanted > 1)
  {
    digest = rt::GetSceneDigest(scene, request);
    // A rank may have seen a change that the others have not.
    const std::uint8_t same = this->Samples > 0 && digest == this->Digest;
    const auto all = messenger.AllGatherValue(same);
    if (std::count(all.begin(), all.end(), 0) > 0)
    {
      this->Samples = 0;
    }
  }
  else
  {
    this->Samples = 0;
  }
  const int missing = this->SamplesWanted - this->Samples;
  if (missing <= 0)
  {
    return;
  }
  request.FirstSample = this->Samples;
  request.Samples = this->CountSamplesOfFrame(missing);
  this->Samples = 0;
  rt::FrameRenderer& renderer = this->Group->GetFrameRenderer();
  if (request.FirstSample == 0)
  {
    this->Frame = renderer.Render(this->Group->GetStore(), scene, request, &this->Frame);
  }
  else
  {
    renderer.Refine(this->Group->GetStore(), scene, request, this->Frame);
  }
  this->Statistics->Gather(messenger, this->Frame);
  this->Samples = request.FirstSample + request.Samples;
  this->Digest = digest;
}

int vtkDSMScene::Internals::CountSamplesOfFrame(int missing) const
{
  vtkRenderWindow* window = this->Renderer->GetRenderWindow();
  if (window && window->GetDesiredUpdateRate() >= InteractiveRate)
  {
    return 1;
  }
  return this->SamplesPerFrame > 0 ? std::min(this->SamplesPerFrame, missing) : missing;
}

/// Of each property, what the most demanding object wants.
rt::LightTransport vtkDSMScene::Internals::GetTransport() const
{
  rt::LightTransport transport;
  transport.MaxBounces = 0;
  for (const Member& member : this->Members)
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

/// What the most demanding object wants.
double vtkDSMScene::Internals::GetEnvironmentLight() const
{
  double strength = 0.0;
  for (const Member& member : this->Members)
  {
    strength = std::max(strength, member.State->GetLightOptions()->GetEnvironmentLight());
  }
  return strength;
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
  if (IsTranslucent(scene) && this->Renderer->GetViewProps()->GetLastProp() != this->Prop)
  {
    this->Renderer->RemoveViewProp(this->Prop);
    this->Renderer->AddViewProp(this->Prop);
  }
}

void vtkDSMScene::Internals::Clear()
{
  this->Prop->Clear();
  this->Statistics->Clear();
  this->Frame = {};
  this->Samples = 0;
}

void vtkDSMScene::NoteBackground()
{
  vtkRenderer* renderer = this->Self->Renderer;
  const double* lower = renderer->GetBackground();
  const double* upper = renderer->GetGradientBackground() ? renderer->GetBackground2() : lower;
  const double* up = renderer->GetEnvironmentUp();
  Internals::Backdrop& backdrop = this->Self->Background;
  backdrop.Lower = { lower[0], lower[1], lower[2] };
  backdrop.Upper = { upper[0], upper[1], upper[2] };
  const glm::dvec3 direction(up[0], up[1], up[2]);
  const double length = glm::length(direction);
  backdrop.Up = length > 0.0 ? direction / length : glm::dvec3(0.0, 1.0, 0.0);
}

void vtkDSMScene::Trace()
{
  Internals& self = *this->Self;
  // A selection pass shows no traced surface; taking in data may make an application render.
  if (!self.Renderer || self.Renderer->GetSelector() || self.Tracing || !self.Prop->GetVisibility())
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
  const OpenGLGuard guard(self.Renderer->GetRenderWindow());
  std::string failure;
  try
  {
    self.FindGroup(this->GetController());
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
  os << indent << "Mappers: " << this->Self->States.size() << "\n";
  this->Self->Statistics->PrintSelf(os, indent.GetNextIndent());
}
