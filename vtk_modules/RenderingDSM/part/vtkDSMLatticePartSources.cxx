// SPDX-License-Identifier: BSD-3-Clause
// What this rank puts into the bricks of a lattice.
#include "vtkDSMLatticePart.h"

#include "DSMBricks/build/CellExchange.h"
#include "DSMBricks/build/ValidSource.h"
#include "DSMBricks/build/VoxelBrickBuilder.h"
#include "DSMCore/publish/SegmentUpdate.h"
#include "vtkDSMCellPiece.h"
#include "vtkDSMGather.h"
#include "vtkDSMImagePiece.h"
#include "vtkDSMLatticeValues.h"

#include "vtkDataArray.h"
#include "vtkDataSet.h"

#include <map>
#include <utility>

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
        sources.push_back(bricks::ValidSource::Make(
          std::make_shared<vtkDSMImagePiece>(
            image, array, choice.Component, member, piece.Info.HasMask != 0, choice.OnCells),
          bricks, info.Valid));
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
        const bool hasMask = this->Pieces[number].Info.HasMask != 0 || all.Valid.Exclude(all.Type);
        pieces.push_back({ 0, all.IsUsable(), hasMask, member.Cells, member.Cells });
        vtkDataSet* const image = this->FindOwn(member);
        Info info;
        vtkDataArray* const array =
          image ? vtkDSMImageArrays::Find(image, request.Array, info) : nullptr;
        if (array)
        {
          const auto piece = std::make_shared<const vtkDSMCellPiece>(
            image, array, request.Array.Component, member, hasMask, info.Valid);
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
