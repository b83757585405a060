// SPDX-License-Identifier: BSD-3-Clause
// Values at points that are means of cells.
#include "vtkDSMVolumeData.h"

#include "DSMBricks/build/CellExchange.h"
#include "vtkDSMCellPiece.h"
#include "vtkDSMGather.h"

#include "vtkDataArray.h"
#include "vtkDataSet.h"

#include <map>

std::vector<std::shared_ptr<const bricks::VoxelSource>> vtkDSMVolumeData::AverageCells(
  std::size_t number, const Choice& choice, const std::vector<vtkDSMImageArrays::Info>& infos,
  const std::string& what) const
{
  struct Reach
  {
    std::int64_t Member;
    std::int64_t Rank;
    bricks::Box Cells;
  };
  dsm::Messenger& messenger = this->Group->GetMessenger();
  const bricks::LatticePlan::Lattice& lattice = this->Plan.GetLattices()[number];
  std::map<std::size_t, std::shared_ptr<bricks::CellAverages>> own;
  std::vector<Reach> mine;
  std::vector<bricks::CellExchange::Piece> pieces;
  messenger.RunTogether(what,
    [&]
    {
      for (std::size_t index = 0; index < lattice.Members.size(); ++index)
      {
        const bricks::LatticePlan::Member& member = lattice.Members[index];
        const vtkDSMImageArrays::Info& all = infos[member.Piece];
        const bool hasMask = this->Pieces[member.Piece].HasMask != 0 || all.Valid.Exclude(all.Type);
        pieces.push_back({ 0, all.IsUsable(), hasMask, member.Cells, member.Cells });
        vtkDataSet* const image = this->FindOwn(member);
        vtkDSMImageArrays::Info info;
        vtkDataArray* const array = image ? vtkDSMImageArrays::Find(image, choice, info) : nullptr;
        if (array)
        {
          const auto piece = std::make_shared<const vtkDSMCellPiece>(
            image, array, choice.Component, member, hasMask, info.Valid);
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
  std::vector<std::shared_ptr<const bricks::VoxelSource>> sources;
  for (const auto& [index, piece] : own)
  {
    sources.push_back(piece);
  }
  return sources;
}
