// SPDX-License-Identifier: BSD-3-Clause
// Messages between the ranks before a frame, and their consequences.
#include "vtkDSMSceneInternals.h"

#include "vtkMatrix4x4.h"
#include "vtkRenderWindow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <set>
#include <utility>
#include <variant>

namespace
{

/// Returns whether matrices differ by rounding only.
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

/// Data of a rank and its memory settings, sent to all ranks. A flag for each of its datasets
/// follows: whether it has new data.
struct Holdings
{
  /// To publish in step, the ranks must agree on the settings of the memory; threads may differ.
  std::array<std::uint64_t, 5> Settings;
  std::uint64_t Datasets;
  /// Something has to be taken in, or to be kept otherwise, before there can be a frame. Else a View follows.
  std::uint64_t NeedsUpdate;
};

template <class T>
T Read(const std::vector<std::byte>& bytes, std::size_t at = 0)
{
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  return value;
}

/// Depths of the surfaces of a pixel: the nearest first, then 1.
using SurfaceDepths = std::array<float, vtkDSMDepthReader::MaxSurfaces>;

/// Merges two lists; of all depths that differ, the nearest are kept.
void AddSurfaces(SurfaceDepths& depths, const SurfaceDepths& others)
{
  for (float depth : others)
  {
    for (float& place : depths)
    {
      if (depth == place)
      {
        break;
      }
      if (depth < place)
      {
        std::swap(depth, place);
      }
    }
  }
}

/// Pictures that follow one another, as vtkDSMDepthReader::ReadTranslucent returns them, as lists.
void TakeSurfaces(const std::vector<float>& pictures, std::vector<SurfaceDepths>& depths)
{
  for (std::size_t at = 0; at < pictures.size(); ++at)
  {
    depths[at % depths.size()][at / depths.size()] = pictures[at];
  }
}

/// The reverse, as FrameRequest::MediumCuts. Ranks may draw the same surface.
std::vector<float> ToCuts(const std::vector<SurfaceDepths>& depths)
{
  const std::size_t pixels = depths.size();
  std::vector<float> cuts;
  for (std::size_t pixel = 0; pixel < pixels; ++pixel)
  {
    float last = -1.0f;
    std::size_t place = pixel;
    for (const float depth : depths[pixel])
    {
      if (depth < 1.0f && depth - last > vtkDSMDepthReader::SurfaceDistance)
      {
        cuts.resize(std::max(cuts.size(), place - pixel + pixels), 1.0f);
        cuts[place] = last = depth;
        place += pixels;
      }
    }
  }
  return cuts;
}

/// Returns whether any rank's Holdings say so.
bool NeedsUpdate(const std::vector<std::vector<std::byte>>& records)
{
  return std::any_of(records.begin(), records.end(),
    [](const auto& record) { return Read<Holdings>(record).NeedsUpdate != 0; });
}

bool HasNewData(const std::vector<std::byte>& record, std::size_t dataset)
{
  return record[sizeof(Holdings) + dataset] != std::byte(0);
}

} // namespace

/// View of a rank, sent to all ranks. Its lights follow.
struct vtkDSMScene::Internals::View
{
  rt::FrameAccumulation::Offer Offer; ///< without what rank 0 decides: camera, background, lights
  rt::Resolution::Shown Shown;
  glm::dmat4 WorldToClip;
  rt::Environment Background;
  std::int32_t IsApart; ///< something of its own may be between surfaces
  std::uint64_t Levels; ///< of detail, of all that is shown: see vtkDSMSceneMembers::ChooseLevels
  std::int32_t NeedsBoxes; ///< of levels, others than are shown
  std::int32_t Coarser;    ///< levels that may stand in
  std::int32_t HasObjects;
  std::int32_t LimitsRays; ///< draws something itself that ends rays through media
  std::int32_t NeedsRanks; ///< to deliver a picture, also without edges
  std::int32_t HasNotes;
};

/// Brings the inputs up to date. `needsUpdate`: as Holdings say.
std::vector<std::byte> vtkDSMScene::Internals::EncodeHoldings(bool& needsUpdate)
{
  vtkDSMMemoryOptions* const options = this->Group->GetOptions();
  this->Members.ForwardOptions(this->Light, options);
  this->Group->Configure();
  const dsm::BlockStore::Settings& settings = this->Group->GetStore().GetSettings();
  const bool wantsCoarser = this->WantsCoarser();
  needsUpdate = this->SettledVersion != this->Group->GetSettingsVersion();
  const auto& members = this->Members.GetShown();
  std::vector<std::byte> bytes(sizeof(Holdings) + members.size());
  this->HasNextStep = false;
  for (std::size_t index = 0; index < members.size(); ++index)
  {
    vtkDSMSceneMember& member = *members[index].State;
    dsm::Messenger& messenger = this->Group->GetMessenger();
    member.UpdatePiece(messenger.GetRank(), messenger.GetSize());
    const bool hasNewData = member.HasNewData();
    this->HasNextStep = this->HasNextStep || (hasNewData && member.HasBlocks());
    bytes[sizeof(Holdings) + index] = std::byte(hasNewData ? 1 : 0);
    needsUpdate = needsUpdate || hasNewData || member.NeedsRanks(*this->Group, wantsCoarser);
  }
  const Holdings holdings{ { static_cast<std::uint64_t>(settings.Organization),
                             (settings.HostSharing ? 1u : 0u) + (wantsCoarser ? 2u : 0u),
                             settings.MemoryBytes, settings.CacheBytes,
                             settings.ScratchDirectory.empty() ? 0u : 1u },
    members.size(), needsUpdate ? 1u : 0u };
  std::memcpy(bytes.data(), &holdings, sizeof(holdings));
  return bytes;
}

/// Throws, on every rank alike, when the ranks cannot take in data together.
void vtkDSMScene::Internals::CheckHoldings(const Records& records)
{
  const auto first = Read<Holdings>(records.front());
  for (const auto& record : records)
  {
    const auto other = Read<Holdings>(record);
    if (other.Datasets != first.Datasets)
    {
      throw dsm::Error("The ranks do not show the same datasets; frame skipped.");
    }
    if (other.Settings != first.Settings)
    {
      throw dsm::Error(
        "The ranks have different memory settings; frame skipped. Use the same "
        "DSMMemoryOrganization, DSMHostSharing, DSMMemory, DSMCacheSize, "
        "DSMScratchDirectory, DSMLevelOfDetail and DSMCoarserDataWhileMoving on all ranks.");
    }
  }
}

/// Collective. Takes in what is new on any rank.
void vtkDSMScene::Internals::Update(const Records& records)
{
  bool isEmpty = false;
  if (this->SettledVersion != this->Group->GetSettingsVersion())
  {
    this->SettledVersion = this->Group->GetSettingsVersion();
    isEmpty = !this->Group->Settle();
  }
  std::set<const vtkDSMSceneMember*> freed;
  const auto& members = this->Members.GetShown();
  for (std::size_t index = 0; index < members.size(); ++index)
  {
    vtkDSMSceneMember* member = members[index].State;
    const bool newData = isEmpty || freed.count(member) > 0 ||
      std::any_of(records.begin(), records.end(),
        [=](const auto& record) { return HasNewData(record, index); });
    if (newData)
    {
      const auto outdated = member->FreeOutdated(this->Group->GetMessenger());
      freed.insert(outdated.begin(), outdated.end());
    }
    this->Update(*member, newData);
  }
}

/// Collective: the data and arrays that the mappers have and name now.
void vtkDSMScene::Internals::TakeIn()
{
  const Records records = this->Group->GetMessenger().GatherTogether("Taking in data",
    [&]
    {
      bool needsUpdate = false;
      return this->EncodeHoldings(needsUpdate);
    });
  CheckHoldings(records);
  if (NeedsUpdate(records))
  {
    this->Update(records);
  }
}

/// Collective, but where vtkDSMSceneMember::NeedsRanks is false on all ranks.
void vtkDSMScene::Internals::Update(vtkDSMSceneMember& member, bool newData)
{
  member.Update(this->Group, newData);
  member.TakeCoarser(this->Group, this->WantsCoarser());
}

/// Puts what this rank shows into the tracer's words, without what rank 0 decides (see AgreeOnView). `request`: of
/// edge 1.
std::vector<std::byte> vtkDSMScene::Internals::EncodeView(
  rt::Scene& scene, rt::FrameRequest& request, vtkMatrix4x4* projection)
{
  scene = {};
  request = this->Image ? vtkDSMTranslation::ToRequest(
                            this->Renderer, this->Image->Width, this->Image->Height, projection)
                        : vtkDSMTranslation::ToRequest(this->Renderer, this->Display, projection);
  View view{};
  view.Levels = this->ChooseLevels(request);
  view.NeedsBoxes = this->Members.NeedBoxes();
  this->Members.AddTo(scene, 0);
  this->KeepProp(scene);
  double bounds[6];
  this->Members.GetBounds(bounds);
  scene.Transport = vtkDSMTranslation::ToTransport(this->Light, bounds, this->IsInteractive());
  scene.Transport.TwoSided = this->Renderer->GetTwoSidedLighting() != 0;
  scene.Transport.Surroundings.Lower = scene.Transport.Surroundings.Upper =
    glm::vec3(static_cast<float>(this->Light->GetEnvironmentLight()));
  scene.View = vtkDSMTranslation::ToDebugView(this->Light);
  request.Scheduling =
    this->Group->GetOptions()->GetScheduler() == vtkDSMMemoryOptions::CentralQueue
    ? rt::TileScheduling::CentralQueue
    : rt::TileScheduling::WorkStealing;
  if (this->Image &&
    std::any_of(scene.Media.begin(), scene.Media.end(),
      [](const rt::SceneMedium& medium) { return rt::HasIntegrals(medium); }))
  {
    request.Channels.Value |= rt::ChannelSet::Integral;
  }
  if (this->Light->GetSamplesPerPixel() > rt::FrameRequest::SureSamples)
  {
    request.Tolerance = static_cast<float>(this->Light->GetSampleTolerance() / 255.0);
  }
  if (this->MayFilterLight(scene))
  {
    request.Channels.Value |= rt::LightFilter::Channels;
  }
  if (this->IsReduced() && !scene.Media.empty())
  {
    scene.Transport.MediumErrors = rt::Resolution::MediumErrors;
  }

  view.WorldToClip = std::exchange(request.WorldToClip, glm::dmat4(1.0));
  const int edge = this->GetMovingEdge(request);
  view.Offer = this->Eye->Accumulation.CreateOffer(this->Group->GetStore(), scene,
    rt::Resolution::Reduce(request, edge), this->Light->GetSamplesPerPixel(), this->GetPace());
  view.Shown = this->Eye->Shown;
  view.Shown.MayDraft = !this->HasNextStep;
  view.Background = this->Background;
  const bool canBeApart = this->Delivery.CanSeparate(this->Group->GetMessenger().GetSize());
  view.IsApart = canBeApart && !this->Image && !scene.IsOpaque() &&
    this->Members.AreBesideOthers(this->Renderer);
  view.Coarser = this->CountCoarser();
  view.HasObjects = !scene.Objects.empty() || !scene.Media.empty();
  // Windows that show one image together have no complete image each.
  view.LimitsRays = !scene.Media.empty() && !this->Image &&
    this->Display.Tiles[0] * this->Display.Tiles[1] == 1 &&
    this->Members.AreBesideOthers(this->Renderer);
  view.NeedsRanks = this->Image || this->Delivery.NeedsRanks(false);
  view.HasNotes = this->HasNotes();
  std::vector<std::byte> bytes = dsm::Encode(view);
  for (const rt::Light& light : vtkDSMTranslation::ToLights(this->Renderer))
  {
    dsm::AttachTail(bytes, light);
  }
  return bytes;
}

/// Throws, on every rank alike, for a camera that differs by more than rounding, or for a picture that is to be
/// delivered in another way.
void vtkDSMScene::Internals::CheckViews(const std::vector<View>& views)
{
  for (std::size_t rank = 0; rank < views.size(); ++rank)
  {
    if (!IsNearly(views[rank].WorldToClip, views.front().WorldToClip) ||
      views[rank].NeedsRanks != views.front().NeedsRanks)
    {
      rt::FrameEntry::Refuse(rank);
    }
  }
}

/// Out of rank 0's record, which has them behind `at` bytes: lights may follow the camera.
void vtkDSMScene::Internals::TakeLights(
  const std::vector<std::byte>& record, std::size_t at, rt::Scene& scene)
{
  scene.Lights.clear();
  for (; at < record.size(); at += sizeof(rt::Light))
  {
    scene.Lights.push_back(Read<rt::Light>(record, at));
  }
}

/// Takes rank 0's view: the camera that came from there is not always the same to the last bit, and ParaView's
/// other ranks have no background, which gives light and which mirrored rays see where they meet nothing. Surfaces
/// are kept apart when any rank has something that may be between them. Returns how many levels below the finest
/// may stand in.
int vtkDSMScene::Internals::AgreeOnView(
  const std::vector<View>& views, rt::Scene& scene, rt::FrameRequest& request) const
{
  const View& view = views.front();
  int coarser = view.Coarser;
  request.Layers = 1;
  for (const View& other : views)
  {
    request.Layers = other.IsApart != 0 ? rt::FrameRequest::MaxLayers : request.Layers;
    coarser = std::min<int>(coarser, other.Coarser);
  }
  if (request.Layers > 1)
  {
    request.Channels.Value &= ~rt::LightFilter::Channels;
  }
  scene.Transport.Background = view.Background.Lower;
  const auto strength = static_cast<float>(this->Light->GetEnvironmentLight());
  scene.Transport.Surroundings = view.Background;
  scene.Transport.Surroundings.Lower *= strength;
  scene.Transport.Surroundings.Upper *= strength;
  request.WorldToClip = view.WorldToClip;
  return coarser;
}

/// Collective. Rays end at what is opaque of what this, or any other, rank draws itself; media are cut into layers
/// at what is translucent, where `cutsMedia`.
void vtkDSMScene::Internals::LimitRays(rt::FrameRequest& request, bool cutsMedia)
{
  const char* const what = "Drawing surfaces in front of volumes";
  dsm::Messenger& messenger = this->Group->GetMessenger();
  const std::size_t pixels = static_cast<std::size_t>(request.Width) * request.Height;
  std::shared_ptr<std::vector<float>> nearest;
  std::vector<float> translucent;
  struct Drawn
  {
    std::uint64_t Pixels;
    std::uint8_t IsOpaque;
    std::uint8_t IsTranslucent;
  };
  const std::vector<Drawn> all = messenger.GatherValueTogether(what,
    [&]
    {
      const std::vector<vtkProp*> others = this->Members.FindOthers(this->Renderer);
      nearest = std::make_shared<std::vector<float>>(this->DepthReader.ReadOpaque(
        this->Renderer, others, request.Width, request.Height, request.PixelSize));
      const bool isOpaque = !nearest->empty();
      nearest->resize(pixels, 1.0f);
      if (cutsMedia)
      {
        translucent = this->DepthReader.ReadTranslucent(
          this->Renderer, others, request.Width, request.Height, request.PixelSize);
      }
      return Drawn{ pixels, isOpaque, !translucent.empty() };
    });
  request.Limits = nearest;
  const auto isAny = [&](std::uint8_t Drawn::*flag)
  { return std::any_of(all.begin(), all.end(), [=](const Drawn& one) { return one.*flag != 0; }); };
  if (std::any_of(
        all.begin(), all.end(), [&](const Drawn& one) { return one.Pixels != all[0].Pixels; }))
  {
    return; // a rank whose picture has another size is refused later
  }
  if (isAny(&Drawn::IsOpaque))
  {
    messenger.Reduce(*nearest, [](float& depth, float other) { depth = std::min(depth, other); });
  }
  if (isAny(&Drawn::IsTranslucent))
  {
    std::vector<SurfaceDepths> depths;
    messenger.RunTogether(what,
      [&]
      {
        SurfaceDepths none;
        none.fill(1.0f);
        depths.assign(pixels, none);
        TakeSurfaces(translucent, depths);
      });
    messenger.Reduce(depths, AddSurfaces);
    request.MediumCuts = std::make_shared<std::vector<float>>(ToCuts(depths));
  }
}

/// Collective. As long as no rank has anything new, the ranks agree on the frame with one record, and on how it
/// went with another. `isOver`: see dsm::Messenger::RunStep.
void vtkDSMScene::Internals::Draw(bool& isOver)
{
  const char* const what = "Preparing the frame";
  dsm::Messenger& messenger = this->Group->GetMessenger();
  rt::Scene scene;
  rt::FrameRequest request;
  vtkNew<vtkMatrix4x4> projection;
  const int ranksOnHost = this->Image ? messenger.GetRanksOnHost() : 1;
  std::size_t place =
    sizeof(Holdings) + this->Members.GetShown().size(); // offset of the View in a record
  Records records = messenger.GatherTogether(what,
    [&]
    {
      this->CheckImage(ranksOnHost);
      bool needsUpdate = false;
      std::vector<std::byte> bytes = this->EncodeHoldings(needsUpdate);
      if (!needsUpdate)
      {
        for (const auto& member : this->Members.GetShown())
        {
          this->Update(*member.State, false);
        }
        const std::vector<std::byte> view = this->EncodeView(scene, request, projection);
        bytes.insert(bytes.end(), view.begin(), view.end());
      }
      return bytes;
    });
  CheckHoldings(records);
  if (NeedsUpdate(records) && this->GoesOn)
  {
    return; // something else is to be drawn first
  }
  if (NeedsUpdate(records))
  {
    scene = {}; // bricks are given up by all ranks, or by none
    this->Update(records);
    records =
      messenger.GatherTogether(what, [&] { return this->EncodeView(scene, request, projection); });
    place = 0;
  }

  // From here until the tiles are traced, the ranks count on one another without further agreements.
  std::vector<View> views;
  std::vector<rt::FrameAccumulation::Offer> offers;
  messenger.Insist(
    [&]
    {
      views.clear();
      offers.clear();
      for (const auto& record : records)
      {
        views.push_back(Read<View>(record, place));
        offers.push_back(views.back().Offer);
      }
    });
  const auto isAny = [&](std::int32_t View::*flag)
  {
    return std::any_of(views.begin(), views.end(), [=](const View& one) { return one.*flag != 0; });
  };
  if (!isAny(&View::HasObjects))
  {
    this->FillImage({});
    this->Clear();
    return;
  }
  this->IsTraced = true;
  CheckViews(views);
  int coarser = 0;
  messenger.Insist(
    [&]
    {
      this->TakeLights(records.front(), place + sizeof(View), scene);
      coarser = this->AgreeOnView(views, scene, request);
    });
  const bool needsBoxes = isAny(&View::NeedsBoxes);
  const bool isLike = std::all_of(views.begin(), views.end(),
    [&](const View& view) { return view.Levels == views.front().Levels; });
  if (!isLike || needsBoxes)
  {
    // The cameras may differ in their last bits.
    messenger.RunTogether(what, [&] { this->ChooseLevels(request); });
    this->Members.TakeBoxes(this->Group);
    offers = messenger.GatherValueTogether(what,
      [&]
      {
        this->Members.AddTo(scene, 0);
        return this->Eye->Accumulation.CreateOffer(this->Group->GetStore(), scene,
          rt::Resolution::Reduce(request, this->GetMovingEdge(request)),
          this->Light->GetSamplesPerPixel(), this->GetPace());
      });
  }
  const auto limit = [&](rt::FrameRequest& reduced)
  {
    if (isAny(&View::LimitsRays))
    {
      this->LimitRays(reduced,
        reduced.Layers > 1 && std::any_of(scene.Media.begin(), scene.Media.end(), &rt::HasLayers));
    }
  };
  rt::Picture picture;
  const auto result = this->TraceScene(
    { scene, {}, request, views.front().Shown, coarser, limit, picture }, std::move(offers));
  if (this->GoesOn)
  {
    return;
  }
  const bool filtersLight =
    this->FiltersLight(request) && result != rt::FrameAccumulation::Result::Aborted;
  const rt::Frame& frame =
    filtersLight ? this->FilterLight(request.WorldToClip) : this->Eye->Accumulation.GetFrame();
  const bool hasEdges =
    messenger.GetSize() > 1 && scene.IsOpaque() && this->Eye->Accumulation.GetMostSamples() > 1;
  if (result == rt::FrameAccumulation::Result::Aborted)
  {
    // The renderer goes on: other ranks may wait for what this one draws.
    this->Renderer->GetRenderWindow()->SetAbortRender(0);
    if (this->SecondsPerFrame > 0.0 && frame.Number > 0)
    {
      this->DrawPicture(this->FillGaps(request, hasEdges), request, projection, scene.View,
        request.PixelSize == 1, hasEdges);
    }
    return;
  }
  if (this->Image)
  {
    rt::Picture gathered = rt::GatherFrame(messenger, this->Eye->Accumulation.GetFrame());
    if (filtersLight)
    {
      gathered.Color = rt::GatherFrame(messenger, frame).Color;
    }
    this->FillImage(gathered);
    return;
  }
  const bool isAssembled =
    result == rt::FrameAccumulation::Result::Traced && !request.Channels.Has(rt::ChannelSet::Light);
  if (!isAssembled)
  {
    picture = this->Delivery.Assemble(frame);
  }
  picture = this->Delivery.Gather(messenger, frame, std::move(picture), hasEdges);
  isOver = (isAssembled || this->Delivery.NeedsRanks(hasEdges)) && request.Layers == 1 &&
    !isAny(&View::HasNotes);
  this->DrawPicture(
    std::move(picture), request, projection, scene.View, request.PixelSize == 1, hasEdges);
}
