// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMLatticePart.h"

#include "DSMBricks/build/CellExchange.h"
#include "DSMBricks/build/PublishVolume.h"
#include "DSMBricks/build/ValidSource.h"
#include "DSMBricks/build/VoxelBrickBuilder.h"
#include "DSMCore/publish/SegmentUpdate.h"
#include "vtkDSMCellMask.h"
#include "vtkDSMCellPiece.h"
#include "vtkDSMGather.h"
#include "vtkDSMImagePiece.h"
#include "vtkDSMLatticeValues.h"
#include "vtkDSMMaskedPiece.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkPointData.h"

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

vtkDSMLatticePart::vtkDSMLatticePart(std::shared_ptr<vtkDSMRankGroup> group,
  bricks::LatticePlan::Lattice lattice, std::vector<Piece> pieces)
  : vtkDSMPart(std::move(group))
  , Lattice(std::move(lattice))
  , Pieces(std::move(pieces))
{
  this->IndexToData = this->Lattice.IndexToWorld;
  this->Lower = glm::dvec3(0.0);
  this->Upper = glm::dvec3(this->Lattice.Points - bricks::Index3(1));
  for (const bricks::LatticePlan::Member& member : this->Lattice.Members)
  {
    this->BlockLooks.push_back(
      { member.Cells, this->Pieces[static_cast<std::size_t>(member.Piece)].Look });
  }
}

vtkDSMLatticePart::~vtkDSMLatticePart() = default;

void vtkDSMLatticePart::AddContent(const Choice& choice, bricks::ByteHash& hash) const
{
  const std::uint64_t count = this->Pieces.size();
  hash.Add(&count, sizeof(count));
  for (const Piece& piece : this->Pieces)
  {
    hash.Add(&piece.Info, sizeof(piece.Info));
    if (vtkDataSet* const image = piece.Image)
    {
      Info info;
      const char* const ghosts = vtkDataSetAttributes::GhostArrayName();
      this->AddArray(vtkDSMImageArrays::Find(image, choice, info), hash);
      if (choice.HasMask())
      {
        this->AddArray(vtkDSMImageArrays::Find(image, choice.GetMaskArray(), info), hash);
      }
      this->AddArray(image->GetPointData()->GetAbstractArray(ghosts), hash);
      this->AddArray(image->GetCellData()->GetAbstractArray(ghosts), hash);
    }
  }
}

std::vector<vtkDSMPart::Info> vtkDSMLatticePart::FindArrays(const Choice& choice) const
{
  std::vector<Info> infos;
  for (const Piece& piece : this->Pieces)
  {
    if (piece.Image)
    {
      vtkDSMImageArrays::Find(piece.Image, choice, infos.emplace_back());
    }
  }
  return infos;
}

bool vtkDSMLatticePart::MayTakeOver(const vtkDSMPartValues& old) const
{
  const auto* const known = dynamic_cast<const Values*>(&old);
  if (!known || known->Field->Lattice.GetPoints() != this->Lattice.Points)
  {
    return false;
  }
  const dsm::BlockStore& store = this->Group->GetStore();
  // The values' base class has the field, too.
  return known->Field.use_count() == 2 &&
    (known->Source ? store.MayRefresh(known->Field->Segment)
                   : store.MayUpdate(known->Field->Segment));
}

std::shared_ptr<vtkDSMPartValues> vtkDSMLatticePart::Publish(const Request& request,
  const std::vector<Info>& infos, std::shared_ptr<vtkDSMPartValues> old) const
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  const Choice& choice = request.Array;
  std::shared_ptr<Values> known = std::dynamic_pointer_cast<Values>(old);
  old.reset();
  std::shared_ptr<Values> values;
  Sources sources;
  messenger.RunTogether("Preparing the " + request.Purpose,
    [&]
    {
      values = this->CreateValues(request, infos);
      if (values && !choice.IsAveraged)
      {
        sources = this->CreateSources(values->Field->Lattice, choice);
      }
    });
  if (!values)
  {
    return nullptr;
  }
  bricks::VoxelField& field = *values->Field;
  if (std::shared_ptr<const vtkDSMFileVolume> file = this->FindFile(request, infos, field.Lattice))
  {
    return this->PublishLevel(std::move(file), request, std::move(values), std::move(known));
  }
  messenger.RunTogether("Preparing the " + request.Purpose,
    [&] { values->Digests = dsm::FragmentDigests(field.Lattice.GetBrickCount()); });
  if (choice.IsAveraged)
  {
    sources = this->AverageCells(request, infos);
  }
  if (known && !known->Source && known->Field->Lattice == field.Lattice)
  {
    this->Renew(*values, *known, sources, request);
    field.Hierarchy = bricks::MacrocellHierarchy(field.Lattice, *field.Segment, messenger);
    return values;
  }
  known.reset();
  field = *this->Group->PublishWithRoom(
    [&](dsm::BlockStore::Place place)
    {
      return bricks::PublishVolume(request.GetName(), field.Lattice, sources,
        this->Group->GetStore(), messenger, { place, &values->Digests }, request.Progress);
    });
  field.Planes = this->Lattice.Planes;
  return values;
}

std::shared_ptr<vtkDSMLatticePart::Values> vtkDSMLatticePart::MakeValues(
  const bricks::BrickLattice& lattice, const glm::dmat4& indexToData) const
{
  std::shared_ptr<vtkDSMRankGroup> group = this->Group;
  // The group's publications hold what this captures after the last user has left, and so the group itself.
  const std::shared_ptr<bricks::VoxelField> field{ new bricks::VoxelField,
    [group](bricks::VoxelField* old) mutable
    {
      const auto last = std::move(group);
      if (old->Segment)
      {
        last->GetStore().Retire(old->Segment);
      }
      delete old;
    } };
  field->Lattice = lattice;
  return std::make_shared<Values>(field, indexToData);
}

bool vtkDSMLatticePart::HasGaps(const std::vector<Info>& infos) const
{
  std::vector<bricks::Box> parts;
  for (const auto& member : this->Lattice.Members)
  {
    const auto piece = static_cast<std::size_t>(member.Piece);
    if (infos[piece].IsUsable())
    {
      if (this->Pieces[piece].Info.HasMask != 0)
      {
        return true;
      }
      parts.push_back(member.Cells);
    }
  }
  const bricks::Box whole{ bricks::Index3(0), this->Lattice.Points - bricks::Index3(1) };
  return !bricks::LatticePlan::IsCovered(whole, parts);
}

std::shared_ptr<vtkDSMLatticePart::Values> vtkDSMLatticePart::CreateValues(
  const Request& request, const std::vector<Info>& infos) const
{
  std::set<bricks::ScalarType> types;
  bool masked = request.Array.HasMask() || this->HasGaps(infos);
  for (const Info& info : infos)
  {
    if (info.IsUsable())
    {
      types.insert(info.Type);
      masked = masked || info.Valid.Exclude(info.Type);
    }
  }
  if (types.empty())
  {
    return nullptr;
  }
  if (types.size() > 1)
  {
    throw dsm::Error("The pieces of " + request.GetName() +
      " have different scalar types. Convert them to one type, for example with Calculator.");
  }
  const bricks::BrickLattice ofPoints(this->Lattice.Points, *types.begin(), masked);
  const bool isOfCells = request.Array.OnCells && !request.Array.IsAveraged;
  std::shared_ptr<Values> values =
    this->MakeValues(isOfCells ? ofPoints.OfCells() : ofPoints, this->IndexToData);
  values->Field->Planes = this->Lattice.Planes;
  return values;
}

vtkDSMLatticePart::Sources vtkDSMLatticePart::CreateSources(
  const bricks::BrickLattice& bricks, const Choice& choice) const
{
  Sources sources;
  for (const auto& member : this->Lattice.Members)
  {
    if (vtkDataSet* image = this->FindOwn(member))
    {
      Info info;
      if (vtkDataArray* array = vtkDSMImageArrays::Find(image, choice, info))
      {
        const Piece& piece = this->Pieces[static_cast<std::size_t>(member.Piece)];
        auto source = bricks::ValidSource::Make(
          std::make_shared<vtkDSMImagePiece>(
            image, array, choice.Component, member, piece.Info.HasMask != 0, choice.OnCells),
          bricks, info.Valid);
        if (choice.HasMask())
        {
          source = std::make_shared<vtkDSMMaskedPiece>(
            std::move(source), vtkDSMCellMask(image, choice, member));
        }
        sources.push_back(std::move(source));
      }
    }
  }
  return sources;
}

vtkDSMLatticePart::Sources vtkDSMLatticePart::AverageCells(
  const Request& request, const std::vector<Info>& infos) const
{
  struct Reach
  {
    std::int64_t Member;
    std::int64_t Rank;
    bricks::Box Cells;
  };
  dsm::Messenger& messenger = this->Group->GetMessenger();
  const std::string what = "Averaging the cells of the " + request.Purpose;
  const auto& members = this->Lattice.Members;
  std::map<std::size_t, std::shared_ptr<bricks::CellAverages>> own;
  std::vector<Reach> mine;
  std::vector<bricks::CellExchange::Piece> pieces;
  messenger.RunTogether(what,
    [&]
    {
      for (std::size_t index = 0; index < members.size(); ++index)
      {
        const bricks::LatticePlan::Member& member = members[index];
        const auto number = static_cast<std::size_t>(member.Piece);
        const Info& all = infos[number];
        const bool hasMask = request.Array.HasMask() || this->Pieces[number].Info.HasMask != 0 ||
          all.Valid.Exclude(all.Type);
        pieces.push_back({ 0, all.IsUsable(), hasMask, member.Cells, member.Cells });
        vtkDataSet* const image = this->FindOwn(member);
        Info info;
        vtkDataArray* const array =
          image ? vtkDSMImageArrays::Find(image, request.Array, info) : nullptr;
        if (array)
        {
          std::optional<vtkDSMCellMask> mask;
          if (request.Array.HasMask())
          {
            mask.emplace(image, request.Array, member);
          }
          const auto piece = std::make_shared<const vtkDSMCellPiece>(
            image, array, request.Array.Component, member, hasMask, info.Valid, std::move(mask));
          mine.push_back(
            { static_cast<std::int64_t>(index), messenger.GetRank(), piece->GetReach() });
          own[index] = std::make_shared<bricks::CellAverages>(piece);
        }
      }
    });
  for (const Reach& reach : vtkDSMGather::Items(messenger, mine))
  {
    bricks::CellExchange::Piece& piece = pieces[static_cast<std::size_t>(reach.Member)];
    piece.Rank = static_cast<int>(reach.Rank);
    piece.Reach = reach.Cells;
  }
  bricks::CellExchange::Run(messenger, what, pieces, own);
  Sources sources;
  for (const auto& [index, piece] : own)
  {
    sources.push_back(piece);
  }
  return sources;
}

void vtkDSMLatticePart::Renew(
  Values& values, Values& old, const Sources& pieces, const Request& request) const
{
  bricks::VoxelField& field = *values.Field;
  field.Segment = std::move(old.Field->Segment); // retired with the field, should anything fail
  const std::vector<bool> chosen =
    dsm::SegmentUpdate::GatherAny(this->Group->GetMessenger(), "Looking for changes",
      [&]
      {
        bricks::VoxelFragmentSource source(field.Lattice, pieces);
        dsm::NotingFragmentSource noting(source, values.Digests);
        for (dsm::Fragment fragment; noting.Next(fragment);)
        {
        }
        std::vector<bool> differ(values.Digests.GetCount());
        for (dsm::BlockId id = 0; id < differ.size(); ++id)
        {
          differ[id] = !values.Digests.IsSame(old.Digests, id);
        }
        return differ;
      });
  bricks::VoxelFragmentSource source(field.Lattice, pieces);
  source.Restrict(chosen);
  bricks::VoxelBrickSink sink(field.Lattice);
  this->Group->GetStore().Update(
    request.GetName(), field.Segment, chosen, source, sink, request.Progress);
}
