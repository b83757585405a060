// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMSceneInternals.h"

#include "DSMCore/memory/HostMemory.h"
#include "vtkDSMFrameImage.h"
#include "vtkDSMFrameNotes.h"
#include "vtkDSMProgress.h"

#include "vtkBoundingBox.h"
#include "vtkMatrix4x4.h"
#include "vtkPropCollection.h"
#include "vtkRenderWindow.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace
{

/// Frames per second; an application that wants as many from its window is moving the camera.
constexpr double InteractiveRate = 1.0;

/// That an interactive frame may take, where its resolution may be lowered, and the lowest one.
constexpr double InteractiveSeconds = 0.07;
constexpr int LargestReduction = 8;

/// A pixel's colour and depth, in a picture without a window: as tiles, as the message with them, as the messages of all
/// ranks, and as the picture or, later, the image.
constexpr std::uint64_t BytesOfImagePixel = 4 * (4 + sizeof(float));

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

/// When a frame that takes long tells how far it is, first and then again.
constexpr std::chrono::milliseconds FirstTold(1500);
constexpr std::chrono::milliseconds ThenTold(500);

/// What a rank tells of its view.
struct View
{
  glm::dmat4 WorldToClip;
  rt::Environment Background;
  std::int32_t IsApart; ///< something of its own may be between surfaces
  std::int32_t Coarser; ///< levels that may stand in
};

class Raised
{
public:
  explicit Raised(bool& flag)
    : Flag(flag)
  {
    this->Flag = true;
  }
  ~Raised() { this->Flag = false; }
  Raised(const Raised&) = delete;
  Raised& operator=(const Raised&) = delete;

private:
  bool& Flag;
};

} // namespace

vtkDSMScene::Internals::~Internals()
{
  if (this->Group)
  {
    this->Group->Leave(this);
  }
}

void vtkDSMScene::Internals::GiveUpBlocks()
{
  this->Members.GiveUpBlocks();
  this->Accumulation.Restart();
}

std::uint64_t vtkDSMScene::Internals::GetOldestHidden() const
{
  const vtkDSMSceneMember* oldest = this->Members.FindOldestHidden();
  return oldest ? oldest->GetTimeShown() : 0;
}

void vtkDSMScene::Internals::GiveUpOldestHidden()
{
  this->Members.FindOldestHidden()->GiveUpBlocks();
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

/// Collective: what fails on one rank, wherever, is everybody's failure, and the next frame begins
/// anew.
std::string vtkDSMScene::Internals::MakeFrame(const dsm::FirstFailure& earlier)
{
  const dsm::Status outcome = this->Group->GetMessenger().RunStep(
    [&]
    {
      earlier.Throw();
      this->Update();
      this->Draw();
      this->Group->TellOrganization();
    });
  this->Group->ReturnMemoryOfFiles();
  if (outcome.IsOk() || outcome.IsEverywhere)
  {
    return outcome.Cause;
  }
  this->IsTraced = false;
  this->GiveUpBlocks(); // what the ranks have of them may differ now
  this->Group->GetPublications().Forget();
  return "Rank " + std::to_string(outcome.FailedRank) + ": " + outcome.Cause;
}

void vtkDSMScene::Internals::Update()
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  vtkDSMMemoryOptions* const options = this->Group->GetOptions();
  const auto& members = this->Members.GetShown();
  // To publish in step, the ranks must agree on the settings of the memory; threads may differ.
  using Digest = std::array<std::uint64_t, 5>;
  // One rank's change time says nothing of another's.
  const auto all = messenger.GatherTogether("Updating the data",
    [&]
    {
      this->Members.ForwardOptions(this->Light, options);
      this->Group->Configure();
      const dsm::BlockStore::Settings& settings = this->Group->GetStore().GetSettings();
      std::vector<std::byte> mine =
        dsm::Encode(Digest{ static_cast<std::uint64_t>(settings.Organization),
          (settings.HostSharing ? 1u : 0u) + (options->GetCoarserDataWhileMoving() ? 2u : 0u),
          settings.MemoryBytes, settings.CacheBytes, settings.ScratchDirectory.empty() ? 0u : 1u });
      for (const auto& member : members)
      {
        member.State->UpdatePiece(messenger.GetRank(), messenger.GetSize());
        mine.push_back(std::byte(member.State->HasNewData() ? 1 : 0));
      }
      return mine;
    });
  for (const auto& flags : all)
  {
    if (flags.size() != all.front().size())
    {
      throw dsm::Error("The ranks do not show the same datasets; the frame was left out.");
    }
    if (!std::equal(flags.begin(), flags.begin() + sizeof(Digest), all.front().begin()))
    {
      throw dsm::Error("The ranks have different settings of the memory (DSMMemoryOrganization, "
                       "DSMHostSharing, DSMMemory, DSMCacheSize, DSMScratchDirectory, "
                       "DSMCoarserDataWhileMoving); the frame was left out. Set them alike.");
    }
  }
  bool isEmpty = false;
  if (this->SettledVersion != this->Group->GetSettingsVersion())
  {
    this->SettledVersion = this->Group->GetSettingsVersion();
    isEmpty = !this->Group->Settle();
  }
  std::set<const vtkDSMSceneMember*> freed;
  for (std::size_t index = 0; index < members.size(); ++index)
  {
    vtkDSMSceneMember* member = members[index].State;
    const bool newData = isEmpty || freed.count(member) > 0 ||
      std::any_of(all.begin(), all.end(),
        [=](const auto& flags) { return flags[sizeof(Digest) + index] != std::byte(0); });
    if (newData)
    {
      const auto outdated = member->FreeOutdated(messenger);
      freed.insert(outdated.begin(), outdated.end());
    }
    member->Update(this->Group, newData);
    members[index].State->TakeCoarser(this->Group, options->GetCoarserDataWhileMoving());
  }
}

void vtkDSMScene::Internals::Draw()
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  rt::Scene scene;
  rt::FrameRequest request;
  vtkNew<vtkMatrix4x4> projection;
  const int ranksOnHost = this->Image ? messenger.GetRanksOnHost() : 1;
  const auto views = messenger.GatherTogether("Preparing the frame",
    [&]
    {
      this->CheckImage(ranksOnHost);
      this->Members.AddTo(scene, 0);
      this->KeepProp(scene);
      scene.Lights = vtkDSMTranslation::ToLights(this->Renderer);
      double bounds[6];
      this->Members.GetBounds(bounds);
      scene.Transport = vtkDSMTranslation::ToTransport(this->Light, bounds, this->IsInteractive());
      scene.View = vtkDSMTranslation::ToDebugView(this->Light);
      request = this->Image
        ? vtkDSMTranslation::ToRequest(
            this->Renderer, this->Image->Width, this->Image->Height, projection)
        : vtkDSMTranslation::ToRequest(this->Renderer, this->Display, projection);
      request.Scheduling =
        this->Group->GetOptions()->GetScheduler() == vtkDSMMemoryOptions::CentralQueue
        ? rt::TileScheduling::CentralQueue
        : rt::TileScheduling::WorkStealing;
      request.IsPreview = this->IsInteractive(); // also where a pixel gets only one sample
      return this->EncodeView(scene, request);
    });
  if (scene.Objects.empty() && scene.Media.empty())
  {
    this->FillImage({});
    this->Clear();
    return;
  }
  const int coarser = this->AgreeOnView(views, scene, request);
  request.PixelSize = this->GetReduction(request);
  request.Width = (request.Width + request.PixelSize - 1) / request.PixelSize;
  request.Height = (request.Height + request.PixelSize - 1) / request.PixelSize;
  this->LimitRays(scene, request);
  this->IsTraced = true;
  if (this->TraceScene(scene, request, coarser) == rt::FrameAccumulation::Result::Aborted)
  {
    // The renderer goes on, with the last picture: other ranks may wait for what this one draws.
    this->Renderer->GetRenderWindow()->SetAbortRender(0);
    return;
  }
  if (this->Image)
  {
    this->FillImage(rt::GatherFrame(messenger, this->Accumulation.GetFrame()));
    return;
  }
  const bool hasEdges =
    messenger.GetSize() > 1 && scene.IsOpaque() && this->Accumulation.GetSamples() > 1;
  this->DrawPicture(this->Delivery.Gather(messenger, this->Accumulation.GetFrame(), hasEdges),
    request, projection, scene.View, request.PixelSize == 1, hasEdges);
}

/// Collective: the scene's objects come in again where they are shown at another level of detail.
rt::FrameAccumulation::Result vtkDSMScene::Internals::TraceScene(
  rt::Scene& scene, const rt::FrameRequest& request, int coarser)
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  vtkRenderWindow* window = this->Image ? nullptr : this->Renderer->GetRenderWindow();
  const std::vector<int> tries = this->Detail.GetTries(coarser);
  using Result = rt::FrameAccumulation::Result;
  Result result = Result::Aborted;
  const Raised tracing(TracingTiles);
  using Clock = std::chrono::steady_clock;
  auto told = Clock::now() + FirstTold;
  for (auto level = tries.begin(); level != tries.end() && result == Result::Aborted; ++level)
  {
    if (*level > 0)
    {
      messenger.RunTogether("Preparing the frame", [&] { this->Members.AddTo(scene, *level); });
    }
    const bool isLast = level + 1 == tries.end();
    this->Detail.Begin();
    this->Group->GetFrameRenderer().SetWatch(
      [this, window, isLast, &told](double part)
      {
        if (Clock::now() > told)
        {
          this->TellOfTracing(part);
          told = Clock::now() + ThenTold;
        }
        return (window && window->CheckAbortStatus() != 0) ||
          (!isLast && this->Detail.IsTooLong(this->Group->GetStore()));
      });
    result = this->Accumulation.Trace(
      { messenger, this->Group->GetFrameRenderer(), this->Group->GetStore() }, scene, request,
      this->Light->GetSamplesPerPixel(), this->GetPace(), this->Statistics->GetFrameSeconds());
    if (result == Result::Traced)
    {
      this->Statistics->Gather(messenger, this->Accumulation.GetFrame(),
        this->Accumulation.GetSamples(), this->Accumulation.GetWanted(), *level);
      if (tries.size() > 1)
      {
        this->Detail.Note(
          *level, this->Statistics->GetNumberOfMisses(), this->Statistics->GetFrameSeconds());
      }
    }
  }
  this->Group->GetFrameRenderer().SetWatch({});
  return result;
}

void vtkDSMScene::Internals::TellOfTracing(double part) const
{
  if (vtkAlgorithm* const mapper = this->Members.GetShown().front().State->GetAlgorithm())
  {
    vtkDSMProgress::TellOfTracing(mapper, part);
  }
}

/// Levels below the finest that may stand in, as far as this rank knows.
int vtkDSMScene::Internals::CountCoarser() const
{
  const bool mayBeCoarser = this->Group->GetOptions()->GetCoarserDataWhileMoving() &&
    this->IsInteractive() && !this->AlwaysFinest;
  return mayBeCoarser ? this->Members.CountCoarser() : 0;
}

void vtkDSMScene::Internals::CheckImage(int ranksOnHost) const
{
  if (!this->Image)
  {
    return;
  }
  const std::uint64_t pixels = static_cast<std::uint64_t>(this->Image->Width) * this->Image->Height;
  const std::uint64_t needed = BytesOfImagePixel * pixels;
  const std::uint64_t available = dsm::GetAvailableHostMemory() / ranksOnHost;
  if (needed > available)
  {
    throw dsm::Error("A picture of " + std::to_string(this->Image->Width) + " x " +
      std::to_string(this->Image->Height) + " pixels takes " + dsm::FormatMebibytes(needed) +
      " of each rank, and the host has " + dsm::FormatMebibytes(available) +
      " for it. Make a smaller one.");
  }
}

void vtkDSMScene::Internals::FillImage(const rt::Picture& picture) const
{
  if (this->Image && this->Image->Image)
  {
    vtkDSMFrameImage::Fill(this->Image->Image, this->Image->Width, this->Image->Height, picture,
      this->Background, this->Image->IsTransparent);
  }
}

void vtkDSMScene::Internals::DrawPicture(rt::Picture picture, const rt::FrameRequest& request,
  vtkMatrix4x4* projection, rt::DebugView view, bool hasNotes, bool hasEdges)
{
  this->Members.GetBounds(this->Bounds);
  double bounds[6];
  std::copy_n(this->Bounds, 6, bounds);
  this->Delivery.Prepare(request, picture);
  // Where the ranks' pictures are blended, each has the notes; where the nearest counts, one does.
  const bool writesNotes =
    this->Delivery.AreBlended() || this->Group->GetMessenger().GetRank() == 0;
  rt::Picture unseen;
  if (hasNotes && this->WriteNotes(view, writesNotes ? picture : unseen))
  {
    this->AddWholeView(request, bounds);
  }
  this->Delivery.Show(request, std::move(picture), this->Renderer->GetActiveCamera(), projection,
    bounds, hasEdges, this->Prop);
}

/// Returns whether there is anything to write, on any rank.
bool vtkDSMScene::Internals::WriteNotes(rt::DebugView view, rt::Picture& picture) const
{
  const bool showsStatistics = this->Light->GetShowStatistics();
  const bool showsLegend = view != rt::DebugView::Off && this->Light->GetShowLegend();
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

void vtkDSMScene::Internals::ShowWhole() const
{
  vtkNew<vtkMatrix4x4> projection;
  const rt::FrameRequest request =
    vtkDSMTranslation::ToRequest(this->Renderer, this->Display, projection);
  double bounds[6];
  std::copy_n(this->Bounds, 6, bounds);
  this->AddWholeView(request, bounds);
  this->Prop->SetBounds(bounds);
}

/// What AgreeOnView is told of a rank: a View, and its lights.
std::vector<std::byte> vtkDSMScene::Internals::EncodeView(
  const rt::Scene& scene, const rt::FrameRequest& request) const
{
  const bool canBeApart = this->Delivery.CanSeparate(this->Group->GetMessenger().GetSize());
  const bool isApart = canBeApart && !this->Image && !scene.IsOpaque() &&
    this->Members.AreBesideOthers(this->Renderer);
  std::vector<std::byte> bytes = dsm::Encode(
    View{ request.WorldToClip, this->Background, isApart ? 1 : 0, this->CountCoarser() });
  for (const rt::Light& light : scene.Lights)
  {
    dsm::AttachTail(bytes, light);
  }
  return bytes;
}

/// Takes rank 0's view: the camera that came from there is not always the same to the last
/// bit, ParaView's other ranks have no background, which gives light and which mirrored rays see where
/// they meet nothing, and lights may follow the camera. A camera that differs by more than rounding is left to be refused.
/// Surfaces are kept apart when any rank has something that may be between them. Returns how many levels below the finest
/// may stand in.
int vtkDSMScene::Internals::AgreeOnView(const std::vector<std::vector<std::byte>>& views,
  rt::Scene& scene, rt::FrameRequest& request) const
{
  const auto decode = [](const std::vector<std::byte>& bytes)
  {
    View view;
    std::memcpy(&view, bytes.data(), sizeof(view));
    return view;
  };
  const std::vector<std::byte>& first = views.front();
  const View view = decode(first);
  int coarser = view.Coarser;
  request.Layers = 1;
  for (const std::vector<std::byte>& other : views)
  {
    const View theirs = decode(other);
    request.Layers = theirs.IsApart != 0 ? rt::FrameRequest::MaxLayers : request.Layers;
    coarser = std::min<int>(coarser, theirs.Coarser);
  }
  scene.Transport.Background = view.Background.Lower;
  const auto strength = static_cast<float>(this->Light->GetEnvironmentLight());
  scene.Transport.Surroundings = view.Background;
  scene.Transport.Surroundings.Lower *= strength;
  scene.Transport.Surroundings.Upper *= strength;
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
  return coarser;
}

void vtkDSMScene::Internals::LimitRays(const rt::Scene& scene, rt::FrameRequest& request)
{
  // Of windows that show one picture together, none has all of it.
  if (scene.Media.empty() || this->Image || this->Display.Tiles[0] * this->Display.Tiles[1] > 1)
  {
    return;
  }
  const auto all = this->Group->GetMessenger().GatherTogether("Drawing what is in front of volumes",
    [&]
    {
      const std::vector<float> own = this->OpaqueDepth.Read(this->Renderer,
        this->Members.FindOthers(this->Renderer), request.Width, request.Height, request.PixelSize);
      const auto* const bytes = reinterpret_cast<const std::byte*>(own.data());
      return std::vector<std::byte>(bytes, bytes + own.size() * sizeof(float));
    });
  std::vector<float> nearest;
  for (const std::vector<std::byte>& bytes : all)
  {
    std::vector<float> one(bytes.size() / sizeof(float));
    std::memcpy(one.data(), bytes.data(), one.size() * sizeof(float));
    if (nearest.empty())
    {
      nearest = std::move(one);
      continue;
    }
    for (std::size_t pixel = 0; pixel < one.size(); ++pixel)
    {
      nearest[pixel] = std::min(nearest[pixel], one[pixel]);
    }
  }
  if (!nearest.empty())
  {
    request.Limits = std::make_shared<const std::vector<float>>(std::move(nearest));
  }
}

bool vtkDSMScene::Internals::IsInteractive() const
{
  vtkRenderWindow* window = this->Image ? nullptr : this->Renderer->GetRenderWindow();
  return window && window->GetDesiredUpdateRate() >= InteractiveRate;
}

/// The edge of the squares of which one pixel is traced; the same on every rank.
int vtkDSMScene::Internals::GetReduction(const rt::FrameRequest& request) const
{
  if (this->InteractiveReduction == 0 || !this->IsInteractive())
  {
    return 1;
  }
  const double pixels = static_cast<double>(request.Width) * request.Height;
  const double seconds =
    pixels * this->Accumulation.GetSecondsPerPixel(this->Statistics->GetFrameSeconds());
  const int least = this->InteractiveReduction;
  return std::clamp(static_cast<int>(std::lround(std::sqrt(seconds / InteractiveSeconds))), least,
    std::max(least, LargestReduction));
}

rt::FrameAccumulation::Pace vtkDSMScene::Internals::GetPace() const
{
  if (this->Image)
  {
    return {};
  }
  return this->IsInteractive() ? rt::FrameAccumulation::Pace{ 1, 0.0 } : this->Pace;
}

/// The application may have taken the prop away with its own. And what shows through a translucent surface, or beside
/// one that covers a pixel in part, must have been drawn before it.
void vtkDSMScene::Internals::KeepProp(const rt::Scene& scene)
{
  const bool showsOthers = !scene.IsOpaque() || this->Light->GetSamplesPerPixel() > 1;
  const bool mustBeLast =
    showsOthers && this->Renderer->GetViewProps()->GetLastProp() != this->Prop;
  if (mustBeLast || !this->Renderer->HasViewProp(this->Prop))
  {
    this->Renderer->RemoveViewProp(this->Prop);
    this->Renderer->AddViewProp(this->Prop);
  }
}

void vtkDSMScene::Internals::Clear()
{
  this->Prop->Clear();
  this->Statistics->Clear();
  this->Accumulation.Clear();
}
