// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMJoinedImages.h"

#include "DSMBricks/base/ByteHash.h"
#include "vtkDSMFileArray.h"
#include "vtkDSMGather.h"
#include "vtkDSMImagePiece.h"
#include "vtkDSMLatticePart.h"

#include "vtkDataArray.h"
#include "vtkDataSet.h"

#include <algorithm>
#include <map>
#include <utility>

vtkDSMJoinedImages::vtkDSMJoinedImages(
  std::shared_ptr<vtkDSMRankGroup> group, std::vector<Image> images)
  : Group(std::move(group))
  , Images(std::move(images))
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  std::vector<bricks::PieceInfo> mine;
  std::vector<double> myCoordinates;
  std::vector<vtkDSMBlockLook> myLooks;
  messenger.RunTogether("Reading the volume",
    [&]
    {
      for (const Image& image : this->Images)
      {
        mine.push_back(vtkDSMImagePiece::Describe(image.Data, image.Leaf));
        myLooks.push_back(image.Look);
        for (const auto& planes : vtkDSMImagePiece::GetCoordinates(image.Data, mine.back()))
        {
          myCoordinates.insert(myCoordinates.end(), planes.begin(), planes.end());
        }
      }
    });
  this->Pieces = vtkDSMGather::Items(messenger, mine, this->FirstOwnPiece);
  this->SetCoordinates(vtkDSMGather::Items(messenger, myCoordinates));
  this->Looks = vtkDSMGather::Items(messenger, myLooks);
  messenger.RunTogether("Joining the volume's pieces",
    [&] { this->Plan = bricks::LatticePlan(this->Pieces, {}, this->Coordinates); });
}

void vtkDSMJoinedImages::SetCoordinates(const std::vector<double>& all)
{
  auto next = all.begin();
  for (const bricks::PieceInfo& piece : this->Pieces)
  {
    bricks::GridPlanes::Coordinates& own = this->Coordinates.emplace_back();
    for (int axis = 0; piece.Coordinates != 0 && axis < 3; ++axis)
    {
      const auto end = next + (piece.Max[axis] - piece.Min[axis] + 1);
      own[axis].assign(next, end);
      next = end;
    }
  }
}

bool vtkDSMJoinedImages::SeparateBlocks(
  const vtkDSMImageArrays& arrays, const std::vector<Choice>& shown)
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  std::vector<bricks::LatticePlan::Seam> seams;
  messenger.RunTogether(
    "Finding adjacent blocks", [&] { seams = this->Plan.FindSeams(this->Pieces); });
  if (seams.empty())
  {
    return false;
  }
  struct Side
  {
    std::uint64_t Seam;
    std::uint64_t Content;
  };
  std::vector<Side> mine;
  const auto& lattices = this->Plan.GetLattices();
  messenger.RunTogether("Comparing the blocks of the volume",
    [&]
    {
      for (std::size_t index = 0; index < seams.size(); ++index)
      {
        for (const std::size_t side : seams[index].Members)
        {
          const auto& member = lattices[seams[index].Lattice].Members[side];
          if (this->FindOwn(member.Piece))
          {
            mine.push_back({ index, this->HashPoints(member, seams[index].Points, arrays, shown) });
          }
        }
      }
    });
  std::set<std::int32_t> apart; // blocks
  std::map<std::uint64_t, std::uint64_t> contents;
  for (const Side& side : vtkDSMGather::Items(messenger, mine))
  {
    const auto known = contents.emplace(side.Seam, side.Content).first;
    if (known->second != side.Content)
    {
      for (const auto& member : lattices[seams[side.Seam].Lattice].Members)
      {
        apart.insert(this->Pieces[member.Piece].Leaf);
      }
    }
  }
  if (!apart.empty())
  {
    messenger.RunTogether("Joining the volume's pieces",
      [&] { this->Plan = bricks::LatticePlan(this->Pieces, apart, this->Coordinates); });
  }
  return true;
}

vtkDataSet* vtkDSMJoinedImages::FindOwn(int piece) const
{
  const int own = piece - this->FirstOwnPiece;
  return own >= 0 && own < static_cast<int>(this->Images.size())
    ? this->Images[static_cast<std::size_t>(own)].Data.Get()
    : nullptr;
}

std::uint64_t vtkDSMJoinedImages::HashPoints(const bricks::LatticePlan::Member& member,
  const bricks::Box& points, const vtkDSMImageArrays& arrays,
  const std::vector<Choice>& shown) const
{
  vtkDataSet* image = this->FindOwn(member.Piece);
  bricks::ByteHash hash;
  for (const Choice& wanted : shown)
  {
    const Choice choice = arrays.Normalize(wanted);
    vtkDSMImageArrays::Info info;
    const bool isFlat = choice.OnCells && !choice.IsAveraged;
    vtkDataArray* array = isFlat ? nullptr : vtkDSMImageArrays::Find(image, choice, info);
    hash.Add(&info.Found, sizeof(info.Found));
    if (!array)
    {
      continue;
    }
    hash.Add(&info.Type, sizeof(info.Type));
    if (choice.OnCells)
    {
      continue; // whatever cells hold, those of one block may continue those of another
    }
    if (vtkDSMGetFileValues(array))
    {
      // One volume in one file needs not be read to be shown.
      hash.Add(&member.Piece, sizeof(member.Piece));
      continue;
    }
    std::vector<std::byte> samples(
      static_cast<std::size_t>(points.GetCount()) * bricks::GetBytes(info.Type));
    vtkDSMImagePiece(image, array, choice.Component, member, false)
      .ReadSamples(points, samples.data());
    hash.Add(samples.data(), samples.size());
  }
  return hash.Get();
}

std::vector<std::unique_ptr<vtkDSMPart>> vtkDSMJoinedImages::CreateParts() const
{
  std::vector<std::unique_ptr<vtkDSMPart>> parts;
  for (bricks::LatticePlan::Lattice lattice : this->Plan.GetLattices())
  {
    std::set<int> numbers;
    for (const bricks::LatticePlan::Member& member : lattice.Members)
    {
      numbers.insert(member.Piece);
    }
    std::vector<vtkDSMLatticePart::Piece> pieces;
    for (const int number : numbers)
    {
      const auto piece = static_cast<std::size_t>(number);
      pieces.push_back({ this->Pieces[piece], this->Looks[piece], this->FindOwn(number) });
    }
    for (bricks::LatticePlan::Member& member : lattice.Members)
    {
      member.Piece = static_cast<int>(std::distance(numbers.begin(), numbers.find(member.Piece)));
    }
    parts.push_back(
      std::make_unique<vtkDSMLatticePart>(this->Group, std::move(lattice), std::move(pieces)));
  }
  return parts;
}
