// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMMeshData.h"

#include "DSMBricks/base/ByteHash.h"
#include "DSMBricks/build/PublishMesh.h"
#include "DSMCore/base/Error.h"
#include "vtkDSMGather.h"
#include "vtkDSMProgress.h"

#include "vtkBoundingBox.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkMath.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <set>
#include <string_view>
#include <tuple>

namespace
{

/// Default thickness of lines and points, as a part of the data's diagonal.
constexpr double DefaultRadiusPart = 1.0 / 300.0;

/// Up to so many blocks have meshes of their own, so that a new look for one of them leaves all bricks
/// as they are. Every ray is tested against every mesh.
constexpr std::size_t MostOwnMeshes = 64;

/// Store in which a mesh is published.
struct PlacedStore
{
  dsm::BlockStore& Store;
  dsm::BlockStore::Place Place;

  auto Publish(std::string_view what, dsm::BlockDirectory&& directory, dsm::FragmentSource& source,
    dsm::FragmentSink& sink, dsm::FunctionRef<void(double)> progress) const
  {
    return this->Store.Publish(what, std::move(directory), source, sink, progress, this->Place);
  }
};

double ChooseRadius(double radius, double diagonal)
{
  // Data at a single point have no size; alone in a view, VTK shows about so much around them.
  return radius == 0.0 ? DefaultRadiusPart * (diagonal > 0.0 ? diagonal : 1.0) : radius;
}

} // namespace

/// Data of one rank about the color array of one surface.
struct vtkDSMMeshData::ColorReport
{
  vtkDSMMeshColors::State State;
  std::int32_t Unused;
  std::int64_t Length;
  std::int64_t ExpectedLength;
};

bool vtkDSMMeshData::Key::operator<(const Key& other) const
{
  const auto order = [](const Key& key)
  {
    return std::make_tuple(
      key.Group, key.Normals, key.Values, key.Colors, key.TextureCoordinates, key.Solid);
  };
  return order(*this) < order(other);
}

vtkDSMMeshData::vtkDSMMeshData(std::shared_ptr<vtkDSMRankGroup> group, vtkDSMMeshInput input,
  const vtkDSMMeshContent& content, std::unique_ptr<vtkDSMMeshData> old)
  : Group(std::move(group))
  , Input(std::move(input))
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  const std::string what = "Reading the surface";
  messenger.RunTogether(what,
    [&]
    {
      this->Blocks = this->Input.CollectBlocks();
      if (this->Blocks.size() != content.Blocks.size())
      {
        throw dsm::Error("The blocks of the surface changed while they were read.");
      }
    });
  this->FormGroups();
  this->FindBounds();
  this->Solids = { ChooseRadius(this->Input.LineRadius, this->Diagonal),
    ChooseRadius(this->Input.PointRadius, this->Diagonal), this->Input.RadiusArray };
  this->DescribeSources(content);
  if (old && old->Group == this->Group)
  {
    this->TakeOver(std::move(old->Parts));
  }
  std::vector<ColorReport> reports;
  messenger.RunTogether(what, [&] { this->CollectSurfaces(reports); });
  this->CheckColors(reports);
  this->Publish();
  this->AddSolidsToBounds();
  this->Blocks.clear();
  this->Groups.clear();
  this->Surfaces.clear();
  this->Sources.clear();
}

void vtkDSMMeshData::FormGroups()
{
  struct Member
  {
    std::uint32_t Number;
    vtkDSMMeshBlock::Look Appearance;
    std::int32_t Flagged;
  };
  std::vector<Member> mine;
  for (const vtkDSMMeshBlock& block : this->Blocks)
  {
    const bool flagged =
      this->Input.Wish.EdgeFlags && vtkDSMTriangleList::NeedsEdgeFlags(block.Data);
    mine.push_back({ block.Number, block.Appearance, flagged ? 1 : 0 });
  }
  std::set<std::uint32_t> numbers;
  std::map<vtkDSMMeshBlock::Look, std::uint32_t> looks;
  const auto all = vtkDSMGather::Items(this->Group->GetMessenger(), mine);
  for (const Member& member : all)
  {
    numbers.insert(member.Number);
    looks.emplace(member.Appearance, 0);
  }
  std::uint32_t count = 0;
  for (auto& look : looks)
  {
    look.second = count++;
  }
  this->OwnMeshes = numbers.size() <= MostOwnMeshes;
  const auto getGroup = [&](std::uint32_t number, const vtkDSMMeshBlock::Look& look)
  { return this->OwnMeshes ? number : looks.at(look); };
  for (const Member& member : all)
  {
    const std::uint32_t group = getGroup(member.Number, member.Appearance);
    this->Looks.emplace(group, member.Appearance);
    if (member.Flagged != 0)
    {
      this->Flagged.insert(group);
    }
  }
  for (const vtkDSMMeshBlock& block : this->Blocks)
  {
    this->Groups.push_back(getGroup(block.Number, block.Appearance));
  }
}

std::uint32_t vtkDSMMeshData::FindGroup(const Part& part) const
{
  constexpr std::uint32_t none = ~std::uint32_t(0);
  if (this->OwnMeshes)
  {
    return this->Looks.count(part.Kind.Group) != 0 ? part.Kind.Group : none;
  }
  const auto found = std::find_if(this->Looks.begin(), this->Looks.end(),
    [&](const auto& group)
    { return !(group.second < part.Appearance) && !(part.Appearance < group.second); });
  return found != this->Looks.end() ? found->first : none;
}

void vtkDSMMeshData::DescribeSources(const vtkDSMMeshContent& content)
{
  for (std::size_t index = 0; index < this->Blocks.size(); ++index)
  {
    const vtkDSMMeshBlock& block = this->Blocks[index];
    std::vector<std::uint64_t> numbers = content.Blocks[index];
    if (block.Data->GetNumberOfVerts() > 0 || block.Data->GetNumberOfLines() > 0)
    {
      vtkDSMMeshContent::AddNumber(numbers, this->Solids.LineRadius);
      vtkDSMMeshContent::AddNumber(numbers, this->Solids.PointRadius);
    }
    std::vector<std::uint64_t>& source = this->Sources[this->Groups[index]];
    source.insert(source.end(), numbers.begin(), numbers.end());
  }
}

void vtkDSMMeshData::TakeOver(std::vector<Part>&& old)
{
  std::vector<std::byte> mine;
  for (Part& part : old)
  {
    part.Kind.Group = this->FindGroup(part);
    const auto source = this->Sources.find(part.Kind.Group);
    const bool same =
      source != this->Sources.end() ? source->second == part.Source : part.Source.empty();
    const bool usable = this->Looks.count(part.Kind.Group) != 0 &&
      (part.Mesh->Attributes.EdgeFlags || part.Kind.Solid != 0 ||
        this->Flagged.count(part.Kind.Group) == 0);
    mine.push_back(std::byte(same && usable ? 1 : 0));
  }
  std::vector<char> same(old.size(), 1);
  for (const auto& rank : this->Group->GetMessenger().AllGather(std::move(mine)))
  {
    for (std::size_t index = 0; index < same.size(); ++index)
    {
      same[index] = same[index] && rank[index] != std::byte(0);
    }
  }
  for (std::size_t index = 0; index < same.size(); ++index)
  {
    if (same[index])
    {
      old[index].Appearance = this->Looks.at(old[index].Kind.Group);
      this->Parts.push_back(old[index]);
    }
    old[index].Mesh.reset();
  }
}

void vtkDSMMeshData::FindBounds()
{
  struct Box
  {
    double Bounds[6];
  };
  vtkBoundingBox box;
  for (const vtkDSMMeshBlock& block : this->Blocks)
  {
    if (block.Appearance.Visible)
    {
      box.AddBounds(block.Data->GetBounds());
    }
  }
  Box own;
  box.GetBounds(own.Bounds);
  vtkBoundingBox whole;
  for (const Box& one : this->Group->GetMessenger().AllGatherValue(own))
  {
    if (vtkMath::AreBoundsInitialized(one.Bounds))
    {
      whole.AddBounds(one.Bounds);
    }
  }
  vtkMath::UninitializeBounds(this->Bounds);
  this->Diagonal = 0.0;
  if (whole.IsValid())
  {
    whole.GetBounds(this->Bounds);
    this->Diagonal = whole.GetDiagonalLength();
  }
}

void vtkDSMMeshData::AddSolidsToBounds()
{
  vtkBoundingBox box;
  if (vtkMath::AreBoundsInitialized(this->Bounds))
  {
    box.AddBounds(this->Bounds);
  }
  for (const Part& part : this->Parts)
  {
    const bricks::TriangleMesh& mesh = *part.Mesh;
    if (part.Kind.Solid != 0 && part.Appearance.Visible && !mesh.Bricks.IsEmpty())
    {
      glm::dvec3 lower = mesh.Origin + mesh.Scale * mesh.Lower;
      glm::dvec3 upper = mesh.Origin + mesh.Scale * mesh.Upper;
      box.AddPoint(&lower.x);
      box.AddPoint(&upper.x);
    }
  }
  if (box.IsValid())
  {
    box.GetBounds(this->Bounds);
  }
}

void vtkDSMMeshData::CollectSurfaces(std::vector<ColorReport>& reports)
{
  for (std::size_t index = 0; index < this->Blocks.size(); ++index)
  {
    vtkPolyData* data = this->Blocks[index].Data;
    const std::uint32_t group = this->Groups[index];
    const bool isVisible = this->Blocks[index].Appearance.Visible != 0;
    if (data->GetNumberOfCells() > 0)
    {
      // An array that only hidden blocks have is not missing.
      const vtkDSMMeshColors colors(this->Input.Mapper, data);
      if (isVisible || colors.GetState() == vtkDSMMeshColors::State::Usable)
      {
        reports.push_back({ colors.GetState(), 0, colors.GetLength(), colors.GetExpectedLength() });
      }
    }
    if (!isVisible)
    {
      continue;
    }
    if (data->GetNumberOfPolys() > 0 || data->GetNumberOfStrips() > 0)
    {
      this->AddSurface(group, data, false);
    }
    if (this->Solids.HasAny(data))
    {
      this->AddSurface(group, data, true);
    }
  }
}

void vtkDSMMeshData::AddSurface(std::uint32_t group, vtkPolyData* data, bool isSolid)
{
  Surface surface;
  surface.Data = data;
  surface.Colors = vtkDSMMeshColors(this->Input.Mapper, data);
  const bricks::MeshAttributes attributes =
    vtkDSMMeshPiece::GetAttributes(data, surface.Colors, this->Input.Wish, isSolid);
  surface.Kind.Group = group;
  surface.Kind.Normals = static_cast<std::uint32_t>(attributes.Normals);
  surface.Kind.Values = static_cast<std::uint32_t>(attributes.Values);
  surface.Kind.Colors = static_cast<std::uint32_t>(attributes.Colors);
  surface.Kind.TextureCoordinates = attributes.TextureCoordinates ? 1 : 0;
  surface.Kind.Solid = attributes.Radii ? 1 : 0;
  this->Surfaces.push_back(std::move(surface));
}

void vtkDSMMeshData::CheckColors(const std::vector<ColorReport>& mine)
{
  using State = vtkDSMMeshColors::State;
  dsm::Messenger& messenger = this->Group->GetMessenger();
  const auto reports = vtkDSMGather::Items(messenger, mine);
  const char* name = this->Input.Mapper->GetArrayName();
  const std::string array = std::string("The color array '") + (name ? name : "") + "'";
  bool usable = false;
  bool missing = false;
  for (const ColorReport& report : reports)
  {
    usable = usable || report.State == State::Usable;
    missing = missing || report.State == State::Missing;
    if (report.State == State::WrongLength && this->Message.empty())
    {
      this->Message = array + " has " + std::to_string(report.Length) + " values, but " +
        std::to_string(report.ExpectedLength) +
        " are required; the surface is shown without them. Check the dataset's source.";
    }
    if (report.State == State::Text && this->Message.empty())
    {
      this->Message = array +
        " contains text, for which the color map has no colors; the surface is shown without them. "
        "Turn on Interpret Values As Categories in the color map, or choose a numeric array.";
    }
  }
  if (missing && !usable && this->Message.empty())
  {
    this->Warning = array + " does not exist in the dataset." + this->ListArrays();
  }
}

std::string vtkDSMMeshData::ListArrays() const
{
  const int mode = this->Input.Mapper->GetScalarMode();
  std::vector<char> mine;
  for (const vtkDSMMeshBlock& block : this->Blocks)
  {
    vtkFieldData* fields = mode == VTK_SCALAR_MODE_USE_CELL_FIELD_DATA ? block.Data->GetCellData()
      : mode == VTK_SCALAR_MODE_USE_POINT_FIELD_DATA                   ? block.Data->GetPointData()
                                                                       : block.Data->GetFieldData();
    for (int index = 0; index < fields->GetNumberOfArrays(); ++index)
    {
      const char* name = fields->GetArrayName(index);
      if (name && std::strcmp(name, vtkDataSetAttributes::GhostArrayName()) != 0)
      {
        mine.insert(mine.end(), name, name + std::strlen(name) + 1);
      }
    }
  }
  const auto all = vtkDSMGather::Items(this->Group->GetMessenger(), mine);
  std::set<std::string> names;
  for (auto name = all.begin(); name != all.end();)
  {
    const auto end = std::find(name, all.end(), '\0');
    names.emplace(name, end);
    name = end + 1;
  }
  std::string list;
  for (const std::string& name : names)
  {
    list += (list.empty() ? " Choose one of '" : ", '") + name + "'";
  }
  return list.empty() ? std::string(" The dataset has no arrays of this kind.") : list + ".";
}

void vtkDSMMeshData::Publish()
{
  const std::shared_ptr<vtkDSMRankGroup> group = this->Group;
  dsm::Messenger& messenger = group->GetMessenger();
  std::vector<Key> mine;
  for (const Surface& surface : this->Surfaces)
  {
    mine.push_back(surface.Kind);
  }
  const auto all = vtkDSMGather::Items(messenger, mine);
  std::set<Key> kinds(all.begin(), all.end());
  for (const Part& part : this->Parts)
  {
    kinds.erase(part.Kind);
  }
  double done = 0.0;
  vtkDSMProgress::Begin(this->Input.Mapper);
  for (const Key& kind : kinds)
  {
    const double share = 1.0 / static_cast<double>(kinds.size());
    const auto mesh = this->PublishMesh(kind,
      [this, done, share](double part)
      { vtkDSMProgress::Tell(this->Input.Mapper, done + share * part); });
    done += share;
    this->Parts.push_back({ this->Looks.at(kind.Group), mesh, kind, this->Sources[kind.Group] });
  }
}

std::shared_ptr<const bricks::TriangleMesh> vtkDSMMeshData::PublishMesh(
  const Key& kind, const std::function<void(double)>& progress)
{
  std::shared_ptr<vtkDSMRankGroup> group = this->Group;
  dsm::Messenger& messenger = group->GetMessenger();
  vtkDSMMeshWish wish = this->Input.Wish;
  wish.EdgeFlags = this->Flagged.count(kind.Group) != 0;
  const std::uint64_t content = this->HashSource(kind, wish);
  if (auto known = group->GetPublications().Find<bricks::TriangleMesh>(messenger, content))
  {
    return known;
  }
  vtkDSMMeshPiece piece;
  messenger.RunTogether("Reading the surface",
    [&]
    {
      for (const Surface& surface : this->Surfaces)
      {
        if (!(surface.Kind < kind) && !(kind < surface.Kind))
        {
          piece.Add(surface.Data, surface.Colors, wish, kind.Solid != 0 ? &this->Solids : nullptr);
        }
      }
    });
  bricks::TriangleMeshSettings settings;
  settings.Threads = group->GetStore().GetSettings().Workers;
  std::shared_ptr<bricks::TriangleMesh> mesh = group->PublishWithRoom(
    [&](dsm::BlockStore::Place place)
    {
      PlacedStore store{ group->GetStore(), place };
      return bricks::PublishMesh("the surface", piece, settings, store, messenger, progress);
    });
  // The group's publications hold what this captures after the last user has left, and so the group itself.
  const std::shared_ptr<const bricks::TriangleMesh> shared(mesh.get(),
    [group, mesh](const bricks::TriangleMesh*) mutable
    {
      const auto last = std::move(group);
      last->GetStore().Retire(mesh->Segment);
      mesh.reset();
    });
  group->GetPublications().Add(content, shared);
  return shared;
}

/// Returns a digest of all data that this rank's part of a mesh depends on, apart from the number
/// of its group.
std::uint64_t vtkDSMMeshData::HashSource(const Key& kind, const vtkDSMMeshWish& wish) const
{
  bricks::ByteHash hash;
  const std::uint32_t form[] = { kind.Normals, kind.Values, kind.Colors, kind.TextureCoordinates,
    kind.Solid, wish.TextureCoordinates ? 1u : 0u, wish.EdgeFlags ? 1u : 0u };
  hash.Add(form, sizeof(form));
  const auto source = this->Sources.find(kind.Group);
  if (source != this->Sources.end())
  {
    hash.Add(source->second.data(), source->second.size() * sizeof(source->second[0]));
  }
  return hash.Get();
}
