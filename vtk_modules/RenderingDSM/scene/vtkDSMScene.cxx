// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMScene.h"

#include "vtkDSMOpenGLGuard.h"
#include "vtkDSMSceneInternals.h"

#include "vtkAlgorithm.h"
#include "vtkCamera.h"
#include "vtkCameraPass.h"
#include "vtkCommand.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkObjectFactory.h"
#include "vtkRenderPass.h"
#include "vtkRenderWindow.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <new>
#include <set>
#include <utility>

namespace
{

/// After vtkSynchronizedRenderers (0), which brings the camera.
constexpr float TracePriority = -1.0f;
/// Before vtkSynchronizedRenderers, which makes it black while the ranks render.
constexpr float BackgroundPriority = 1.0f;

/// Never destroyed: renderers that are static end after what is static here.
std::map<vtkRenderer*, vtkDSMScene*>& GetRegistry()
{
  static auto* const registry = new std::map<vtkRenderer*, vtkDSMScene*>;
  return *registry;
}

/// Refuses passes that draw what VTK's own mappers have, and leave other props out.
void CheckPass(vtkRenderer* renderer)
{
  vtkRenderPass* pass = renderer->GetPass();
  while (auto* camera = vtkCameraPass::SafeDownCast(pass))
  {
    pass = camera->GetDelegatePass(); // ParaView's are behind one
  }
  if (pass && pass->IsA("vtkOSPRayPass"))
  {
    throw dsm::Error("VTK's ray tracing (OSPRay) draws this view and does not show DSM Ray Traced "
                     "datasets. Turn off Enable Ray Tracing in the view's properties.");
  }
  if (pass && pass->IsA("vtkValuePass"))
  {
    throw dsm::Error(
      "Value images (the extractor Recolorable Image) require geometry and do not show DSM Ray "
      "Traced datasets. Use the representation Surface or the filter Contour.");
  }
}

} // namespace

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
  if (!renderer)
  {
    vtkGenericWarningMacro("vtkDSMScene needs a renderer.");
    return nullptr;
  }
  if (vtkDSMScene* const known = Find(renderer))
  {
    return known;
  }
  vtkSmartPointer<vtkDSMScene> scene;
  scene.TakeReference(vtkDSMScene::New());
  GetRegistry()[renderer] = scene;
  scene->Attach(renderer);
  return scene;
}

vtkDSMScene* vtkDSMScene::NewForRenderer(vtkRenderer* renderer)
{
  const vtkSmartPointer<vtkDSMScene> scene = ForRenderer(renderer);
  if (scene)
  {
    scene->Register(nullptr);
  }
  return scene;
}

vtkDSMScene* vtkDSMScene::Find(vtkRenderer* renderer)
{
  // The address of a renderer that is gone may be another's now.
  const auto known = GetRegistry().find(renderer);
  const bool isThere = known != GetRegistry().end() && known->second->GetRenderer() == renderer;
  return isThere ? known->second : nullptr;
}

void vtkDSMScene::DrawWithoutScene(vtkRenderer* renderer, vtkObject* mapper)
{
  if (Find(renderer))
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
        << "the scene that it returns.");
    }
    return;
  }
  const vtkSmartPointer<vtkDSMScene> scene = ForRenderer(renderer);
  scene->Self->Keeper = scene;
  // Too late for this frame: what is opaque may be drawn already, and parts of assemblies are where these have put
  // them.
  scene->Self->DrawsAgain = true;
}

void vtkDSMScene::EndWithRenderer()
{
  // These may be the last references, so `this` may be gone when it returns.
  const vtkSmartPointer<vtkDSMScene> last = std::move(this->Self->Keeper);
  const vtkSmartPointer<vtkDSMScene> rendering = std::move(this->Self->Rendering);
}

void vtkDSMScene::EndFrame()
{
  Internals& self = *this->Self;
  // This may be the last reference.
  const vtkSmartPointer<vtkDSMScene> rendering = std::move(self.Rendering);
  if (std::exchange(self.DrawsAgain, false) && !self.Renderer->GetSelector())
  {
    self.Renderer->Render();
    return;
  }
  this->EndReading();
}

void vtkDSMScene::ForgetFrameBounds()
{
  this->Self->Prop->UseBoundsOff();
}

/// Restores the prop's bounds, which were extended for the frame's delivery. Code that examines the
/// renderer's props between frames must not see the extended bounds. A single process finds the
/// objects themselves, whose data may be newer than the last image. With several processes, none
/// knows the bounds of the others' objects that are not traced; without the last image's bounds,
/// ParaView would compute the camera's clipping range from too little. And publications of the frame have taken the
/// bricks that were read ahead for it; the rest is useless.
void vtkDSMScene::EndReading()
{
  Internals& self = *this->Self;
  self.Prop->SetBounds(self.Bounds);
  self.Prop->SetUseBounds(self.Group && self.Group->GetMessenger().GetSize() > 1);
  vol::ReadAhead::GetShared().Tidy();
  this->Self->Busy.reset();
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

vtkDSMLightOptions* vtkDSMScene::GetLightOptions() const
{
  return this->Self->Light;
}

vtkRenderer* vtkDSMScene::GetRenderer() const
{
  return this->Self->Renderer;
}

void vtkDSMScene::DeliverTiles()
{
  this->Self->Delivery.UseTiles();
}

void vtkDSMScene::DeliverEverywhere()
{
  this->DeliverEverywhere([](vtkCamera*) { return true; });
}

void vtkDSMScene::DeliverEverywhere(std::function<bool(vtkCamera*)> drawsColor)
{
  this->Self->Delivery.UseWholeFrames(std::move(drawsColor));
}

void vtkDSMScene::DeliverByPlace(
  std::function<bool(vtkCamera*)> drawsColor, std::function<bool(const double place[3])> drawsPlace)
{
  this->Self->Delivery.UseWholeFrames(std::move(drawsColor), std::move(drawsPlace));
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

void vtkDSMScene::SetSecondsPerFrame(double seconds)
{
  this->Self->SecondsPerFrame = std::max(0.0, seconds);
}

double vtkDSMScene::GetSecondsPerFrame() const
{
  return this->Self->SecondsPerFrame;
}

void vtkDSMScene::SetInteractiveReduction(int edge)
{
  this->Self->InteractiveReduction = std::max(0, edge);
}

int vtkDSMScene::GetInteractiveReduction() const
{
  return this->Self->InteractiveReduction;
}

void vtkDSMScene::SetInteracting(bool interacting)
{
  this->Self->IsInteracting = interacting;
}

bool vtkDSMScene::GetInteracting() const
{
  return this->Self->IsInteracting;
}

void vtkDSMScene::SetShowsDrafts(bool drafts)
{
  this->Self->ShowsDrafts = drafts;
}

bool vtkDSMScene::GetShowsDrafts() const
{
  return this->Self->ShowsDrafts;
}

void vtkDSMScene::SetAlwaysFinest(bool finest)
{
  this->Self->AlwaysFinest = finest;
}

bool vtkDSMScene::GetAlwaysFinest() const
{
  return this->Self->AlwaysFinest;
}

void vtkDSMScene::SetTileDisplay(int columns, int rows, int gapX, int gapY)
{
  this->Self->Display = { { std::max(1, columns), std::max(1, rows) }, { gapX, gapY } };
}

bool vtkDSMScene::IsRefined() const
{
  const auto& eyes = this->Self->Eyes;
  return eyes[0].Accumulation.IsComplete() && eyes[1].Accumulation.IsComplete();
}

bool vtkDSMScene::HasBegun() const
{
  return this->Self->Eyes[0].HasBegun || this->Self->Eyes[1].HasBegun;
}

double vtkDSMScene::GetRefinedPart() const
{
  const auto& eyes = this->Self->Eyes;
  const double left = eyes[0].Accumulation.GetPart();
  return eyes[1].Accumulation.GetWanted() > 0 ? 0.5 * (left + eyes[1].Accumulation.GetPart())
                                              : left;
}

int vtkDSMScene::GetNumberOfSamples() const
{
  const auto& eyes = this->Self->Eyes;
  const int left = eyes[0].Accumulation.GetSamples();
  return eyes[1].Accumulation.GetWanted() > 0 ? std::min(left, eyes[1].Accumulation.GetSamples())
                                              : left;
}

int vtkDSMScene::GetNumberOfSamplesWanted() const
{
  return this->Self->Eyes[0].Accumulation.GetWanted();
}

bool vtkDSMScene::IsTracing() const
{
  return this->Self->Tracing;
}

vtkDSMStatistics* vtkDSMScene::GetStatistics() const
{
  return this->Self->Statistics;
}

void vtkDSMScene::NoteBackground()
{
  vtkRenderer* renderer = this->Self->Renderer;
  const double* lower = renderer->GetBackground();
  const double* upper = renderer->GetGradientBackground() ? renderer->GetBackground2() : lower;
  const double* up = renderer->GetEnvironmentUp();
  rt::Environment& background = this->Self->Background;
  background.Lower = { lower[0], lower[1], lower[2] };
  background.Upper = { upper[0], upper[1], upper[2] };
  const glm::dvec3 direction(up[0], up[1], up[2]);
  const double length = glm::length(direction);
  background.Up = length > 0.0 ? direction / length : rt::Environment().Up;
}

/// Observers of progress, of errors, and of the renderer's events may give up the last reference.
void vtkDSMScene::Trace()
{
  const vtkSmartPointer<vtkDSMScene> rendering = this;
  Internals& self = *this->Self;
  // A selection pass shows no traced surface; hearing of progress may make an application render.
  const bool traces =
    self.Renderer && !self.Renderer->GetSelector() && !self.Tracing && self.Prop->GetVisibility();
  if (traces && Internals::TracingTiles)
  {
    self.Eye->Accumulation.Postpone();
  }
  else if (traces)
  {
    this->TraceFrame();
  }
  self.Rendering = rendering;
}

bool vtkDSMScene::TraceImage(int width, int height, vtkImageData* image, bool transparent)
{
  Internals& self = *this->Self;
  if (!self.Renderer || self.Tracing || Internals::TracingTiles || width < 1 || height < 1)
  {
    vtkErrorMacro(<< "Cannot trace a picture of " << width << " x " << height
                  << " pixels: the size is invalid, or a frame is in progress.");
    return false;
  }
  const vtkSmartPointer<vtkDSMScene> tracing = this; // as Trace
  this->NoteBackground();
  self.Image = Internals::Target{ width, height, image, transparent };
  const bool traced = this->TraceFrame();
  this->EndReading();
  self.Image.reset();
  return traced;
}

bool vtkDSMScene::Advance(std::function<bool()> goesOn)
{
  Internals& self = *this->Self;
  // The application's state, the same on every rank; whether the picture is refined is for the ranks to agree on.
  if (!self.Renderer || self.Renderer->GetSelector() || self.Tracing || Internals::TracingTiles ||
    !self.Prop->GetVisibility())
  {
    return false;
  }
  const vtkSmartPointer<vtkDSMScene> tracing = this; // as Trace
  const bool wasRefined = this->IsRefined();
  self.GoesOn = std::move(goesOn);
  bool traced = true;
  if (self.IsStereo())
  {
    vtkCamera* const camera = self.Renderer->GetActiveCamera();
    const int leftEye = camera->GetLeftEye();
    self.AdvancesLeft = !self.AdvancesLeft; // each has its turn
    for (const bool isLeft : { self.AdvancesLeft, !self.AdvancesLeft })
    {
      camera->SetLeftEye(isLeft ? 1 : 0);
      traced = this->TraceFrame() && traced;
    }
    camera->SetLeftEye(leftEye);
  }
  else
  {
    traced = this->TraceFrame();
  }
  this->EndReading();
  self.GoesOn = nullptr;
  return traced && !wasRefined;
}

bool vtkDSMScene::ExtractIsosurfaces(
  vtkAlgorithm* mapper, bool forSelection, vtkMultiBlockDataSet* surfaces)
{
  Internals& self = *this->Self;
  if (!self.Renderer || self.Tracing || Internals::TracingTiles)
  {
    vtkErrorMacro(<< "Cannot extract isosurfaces while a frame is in progress.");
    return false;
  }
  const vtkSmartPointer<vtkDSMScene> extracting = this; // as Trace
  self.Tracing = true;
  dsm::FirstFailure found;
  found.Try([&] { self.Members.Find(self.Renderer); });
  std::string failure;
  try
  {
    self.FindGroup(this->GetController());
    failure = self.Extract(found, mapper,
      forSelection ? vtkDSMSceneMember::Purpose::Selection : vtkDSMSceneMember::Purpose::Export,
      surfaces);
  }
  catch (const std::exception& error)
  {
    failure = error.what();
  }
  self.Tracing = false;
  if (!failure.empty())
  {
    vtkErrorMacro(<< failure);
  }
  return failure.empty();
}

bool vtkDSMScene::FillWithBackground()
{
  try
  {
    this->Self->CheckImage(1);
    this->Self->FillImage({});
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
    return false;
  }
  return true;
}

/// Collective; returns whether all went well, the same on every rank.
bool vtkDSMScene::TraceFrame()
{
  Internals& self = *this->Self;
  self.Tracing = true;
  self.IsTraced = false;
  self.ChooseEye();
  self.Prop->UseBoundsOn();
  self.Busy.emplace(vol::ReadAhead::GetShared());
  dsm::FirstFailure found;
  found.Try([&] { self.Members.Find(self.Renderer); });
  if (found.IsEmpty() && self.Members.GetShown().empty())
  {
    self.Clear();
    self.Tracing = false;
    return this->FillWithBackground();
  }
  const vtkDSMOpenGLGuard guard(self.Renderer->GetRenderWindow());
  std::string failure;
  try
  {
    if (!self.Image)
    {
      CheckPass(self.Renderer);
    }
    self.FindGroup(this->GetController());
    failure = self.MakeFrame(found);
  }
  catch (const std::bad_alloc&)
  {
    failure = "Out of memory while rendering.";
  }
  catch (const std::exception& error)
  {
    failure = error.what();
  }
  if (!failure.empty() && self.IsTraced)
  {
    self.Statistics->Clear();
    self.Eye->Accumulation.Clear();
    self.ShowWhole();
  }
  else if (!failure.empty())
  {
    self.Clear();
  }
  for (const auto& member : self.Members.GetShown())
  {
    member.State->ReportMessages(!self.Group || self.Group->GetMessenger().GetRank() == 0);
  }
  // Report the failure again after settings have changed, so that the user sees that it remains.
  const unsigned version = self.Group ? self.Group->GetSettingsVersion() : 0;
  if (!failure.empty() && (failure != self.Failure || version != self.FailureVersion))
  {
    vtkErrorMacro(<< failure);
  }
  self.Failure = failure;
  self.FailureVersion = version;
  self.Tracing = false;
  return failure.empty();
}

void vtkDSMScene::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Renderer: " << this->Self->Renderer.Get() << "\n";
  os << indent << "Mappers: " << this->Self->Members.GetCount() << "\n";
  this->Self->Statistics->PrintSelf(os, indent.GetNextIndent());
}
