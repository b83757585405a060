// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMVolumeData.h"

#include "DSMBricks/base/ByteHash.h"
#include "DSMBricks/build/PublishVolume.h"
#include "DSMBricks/build/ValidSource.h"
#include "vtkDSMContent.h"
#include "vtkDSMFileArray.h"
#include "vtkDSMGather.h"
#include "vtkDSMImagePiece.h"

#include "vtkBoundingBox.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkPointData.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

vtkDSMVolumeData::vtkDSMVolumeData(std::shared_ptr<vtkDSMRankGroup> group, vtkDataObject* data,
  vtkDataObject* original, const Chooser& choose, const vtkDSMBlockLooks& looks)
  : Group(std::move(group))
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  std::vector<bricks::PieceInfo> mine;
  std::vector<double> myCoordinates;
  std::vector<vtkSmartPointer<vtkDataObject>> withHidden;
  AddVolumes(data, withHidden);
  AddVolumes(original, withHidden);
  const std::vector<vtkDSMBlockLook> myLooks = this->Collect(data, looks, !withHidden.empty());
  messenger.RunTogether("Reading the volume",
    [&]
    {
      for (std::size_t index = 0; index < this->Images.size(); ++index)
      {
        mine.push_back(vtkDSMImagePiece::Describe(this->Images[index], this->Leaves[index]));
        for (const auto& planes :
          vtkDSMImagePiece::GetCoordinates(this->Images[index], mine.back()))
        {
          myCoordinates.insert(myCoordinates.end(), planes.begin(), planes.end());
        }
      }
    });
  this->Pieces = vtkDSMGather::Items(messenger, mine, this->FirstOwnPiece);
  this->SetCoordinates(vtkDSMGather::Items(messenger, myCoordinates));
  this->Looks = vtkDSMGather::Items(messenger, myLooks);
  std::vector<vtkSmartPointer<vtkDataObject>> all;
  messenger.RunTogether("Reading the volume",
    [&]
    {
      all.assign(this->Images.begin(), this->Images.end());
      for (const vtkDSMLevelData::Part& part : this->LevelParts)
      {
        all.push_back(part.Data);
      }
    });
  this->Arrays = vtkDSMImageArrays(messenger, all, withHidden);
  this->Levels = vtkDSMLevelData::Create(this->Group, this->LevelParts);
  messenger.RunTogether("Joining the volume's pieces",
    [&] { this->Plan = bricks::LatticePlan(this->Pieces, {}, this->Coordinates); });
  this->SeparateBlocks(choose(this->Arrays));
}

void vtkDSMVolumeData::SetCoordinates(const std::vector<double>& all)
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

void vtkDSMVolumeData::SeparateBlocks(const std::vector<Choice>& shown)
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  std::vector<bricks::LatticePlan::Seam> seams;
  messenger.RunTogether(
    "Finding adjacent blocks", [&] { seams = this->Plan.FindSeams(this->Pieces); });
  this->Seams = !seams.empty();
  if (!this->Seams)
  {
    return;
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
          if (this->FindOwn(member))
          {
            mine.push_back({ index, this->HashPoints(member, seams[index].Points, shown) });
          }
        }
      }
    });
  std::map<std::uint64_t, std::uint64_t> contents;
  for (const Side& side : vtkDSMGather::Items(messenger, mine))
  {
    const auto known = contents.emplace(side.Seam, side.Content).first;
    if (known->second != side.Content)
    {
      for (const auto& member : lattices[seams[side.Seam].Lattice].Members)
      {
        this->Apart.insert(this->Pieces[member.Piece].Leaf);
      }
    }
  }
  if (!this->Apart.empty())
  {
    messenger.RunTogether("Joining the volume's pieces",
      [&] { this->Plan = bricks::LatticePlan(this->Pieces, this->Apart, this->Coordinates); });
  }
}

vtkDataSet* vtkDSMVolumeData::FindOwn(const bricks::LatticePlan::Member& member) const
{
  const int own = member.Piece - this->FirstOwnPiece;
  return own >= 0 && own < static_cast<int>(this->Images.size()) ? this->Images[own].Get()
                                                                 : nullptr;
}

std::uint64_t vtkDSMVolumeData::HashPoints(const bricks::LatticePlan::Member& member,
  const bricks::Box& points, const std::vector<Choice>& shown) const
{
  vtkDataSet* image = this->FindOwn(member);
  bricks::ByteHash hash;
  for (const Choice& wanted : shown)
  {
    const Choice choice = this->Arrays.Normalize(wanted);
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

vtkDSMVolumeData::~vtkDSMVolumeData() = default;

void vtkDSMVolumeData::GetBounds(double bounds[6]) const
{
  vtkBoundingBox box;
  for (const auto& lattice : this->Plan.GetLattices())
  {
    for (int corner = 0; corner < 8; ++corner)
    {
      const bricks::Index3 end = lattice.Points - bricks::Index3(1);
      const glm::dvec4 point = lattice.IndexToWorld *
        glm::dvec4(corner & 1 ? end.x : 0, corner & 2 ? end.y : 0, corner & 4 ? end.z : 0, 1);
      box.AddPoint(point.x, point.y, point.z);
    }
  }
  for (const auto& levels : this->Levels)
  {
    double ofLevels[6];
    levels->GetBounds(ofLevels);
    box.AddBounds(ofLevels);
  }
  box.GetBounds(bounds);
}

std::uint64_t vtkDSMVolumeData::HashContent(const Choice& choice) const
{
  const int threads = this->Group->GetStore().GetSettings().Workers;
  bricks::ByteHash hash;
  hash.Add(&choice.Component, sizeof(choice.Component));
  hash.Add(&choice.OnCells, sizeof(choice.OnCells));
  hash.Add(&choice.IsAveraged, sizeof(choice.IsAveraged));
  hash.Add(&choice.Valid, sizeof(choice.Valid));
  hash.Add(this->Pieces.data(), this->Pieces.size() * sizeof(bricks::PieceInfo));
  for (const std::int32_t block : this->Apart)
  {
    hash.Add(&block, sizeof(block));
  }
  const auto add = [&](vtkAbstractArray* array)
  {
    const std::uint64_t value = vtkDSMContent::Hash(array, threads);
    hash.Add(&value, sizeof(value));
  };
  for (vtkDataSet* image : this->Images)
  {
    vtkDSMImageArrays::Info info;
    const char* const ghosts = vtkDataSetAttributes::GhostArrayName();
    add(vtkDSMImageArrays::Find(image, choice, info));
    add(image->GetPointData()->GetAbstractArray(ghosts));
    add(image->GetCellData()->GetAbstractArray(ghosts));
  }
  for (const auto& levels : this->Levels)
  {
    levels->AddContent(choice, threads, hash);
  }
  return hash.Get();
}

std::shared_ptr<const vtkDSMVolumeData::Publication> vtkDSMVolumeData::Publish(const Choice& choice,
  const std::string& purpose, const std::function<void(double)>& progress,
  std::shared_ptr<const Publication> old) const
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  std::vector<vtkDSMImageArrays::Info> mine(this->Images.size());
  const auto published = std::make_shared<Publication>();
  std::vector<vtkDSMFileVolume::Seat> mySeats(this->Images.size());
  std::vector<std::vector<vtkDSMImageArrays::Info>> ofLevels;
  messenger.RunTogether("Reading the " + purpose,
    [&]
    {
      for (std::size_t index = 0; index < this->Images.size(); ++index)
      {
        vtkDataArray* array = vtkDSMImageArrays::Find(this->Images[index], choice, mine[index]);
        mySeats[index] = vtkDSMFileVolume::Describe(this->Images[index], array, choice.OnCells);
      }
      for (const auto& levels : this->Levels)
      {
        ofLevels.push_back(levels->FindArrays(choice));
      }
      published->Content = this->HashContent(choice);
    });
  const std::vector<vtkDSMImageArrays::Info> infos = vtkDSMGather::Items(messenger, mine);
  const auto seats = vtkDSMGather::Items(messenger, mySeats);
  std::vector<vtkDSMImageArrays::Info> all = infos;
  for (auto& levels : ofLevels)
  {
    levels = vtkDSMGather::Items(messenger, levels);
    all.insert(all.end(), levels.begin(), levels.end());
  }
  const auto isUsable = [](const vtkDSMImageArrays::Info& info) { return info.IsUsable(); };
  if (!all.empty() && std::none_of(all.begin(), all.end(), isUsable))
  {
    this->Arrays.Refuse(choice, purpose, all);
  }

  dsm::Publications& publications = this->Group->GetPublications();
  if (const auto known = publications.Find<Publication>(messenger, published->Content))
  {
    return known;
  }
  for (std::size_t lattice = 0; lattice < this->GetNumberOfLattices(); ++lattice)
  {
    Publication::Part known = old ? std::move(old->Parts[lattice]) : Publication::Part();
    if (old)
    {
      old->Bricks[lattice].reset();
    }
    this->PublishLattice(
      *published, lattice, choice, purpose, infos, seats, progress, std::move(known));
  }
  for (std::size_t number = 0; number < this->Levels.size(); ++number)
  {
    published->Levels.push_back(
      this->Levels[number]->Publish(choice, purpose, ofLevels[number], progress));
  }
  publications.Add<Publication>(published->Content, published);
  return published;
}

std::shared_ptr<const vtkDSMVolumeData::Coarser> vtkDSMVolumeData::PublishCoarser(
  const Publication& finest, const Choice& choice, const std::string& purpose,
  const std::function<void(double)>& progress) const
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  dsm::Publications& publications = this->Group->GetPublications();
  if (const auto known = publications.Find<Coarser>(messenger, finest.Content))
  {
    return known;
  }
  std::optional<int> mine; // over all lattices that have bricks
  for (std::size_t lattice = 0; lattice < finest.Bricks.size(); ++lattice)
  {
    const auto& file = finest.Files[lattice];
    if (finest.Bricks[lattice])
    {
      const int coarser = file ? file->CountCoarser() : 0;
      mine = std::min(mine.value_or(coarser), coarser);
    }
  }
  const std::vector<int> all = messenger.AllGatherValue(mine.value_or(0));
  const int levels = *std::min_element(all.begin(), all.end());
  const auto coarser = std::make_shared<Coarser>();
  for (int level = 1; level <= levels; ++level)
  {
    std::vector<CoarserLattice> lattices(finest.Bricks.size());
    for (std::size_t lattice = 0; lattice < finest.Bricks.size(); ++lattice)
    {
      const std::shared_ptr<const bricks::VoxelField>& fine = finest.Bricks[lattice];
      const auto file = fine ? finest.Files[lattice]->FindCoarser(messenger, level) : nullptr;
      if (fine && !file)
      {
        publications.Add<Coarser>(finest.Content, coarser);
        return coarser;
      }
      if (!fine)
      {
        continue;
      }
      Publication::Part part;
      messenger.RunTogether("Preparing the " + purpose,
        [&]
        {
          part.Field = this->MakeField();
          part.Field->Lattice = bricks::BrickLattice(
            file->GetPoints(), fine->Lattice.GetScalarType(), fine->Lattice.HasCellMask());
          lattices[lattice] = { part.Field, finest.Files[lattice]->GetIndexOf(*file) };
        });
      this->PublishFile(*file, true, this->FindFileValues(lattice, choice),
        "level " + std::to_string(level) + " of the " + purpose + " '" + choice.Name + "'",
        progress, part, {});
    }
    coarser->Levels.push_back(std::move(lattices));
  }
  publications.Add<Coarser>(finest.Content, coarser);
  return coarser;
}

void vtkDSMVolumeData::PublishLattice(Publication& published, std::size_t number,
  const Choice& choice, const std::string& purpose,
  const std::vector<vtkDSMImageArrays::Info>& infos,
  const std::vector<vtkDSMFileVolume::Seat>& seats, const std::function<void(double)>& progress,
  Publication::Part&& old) const
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  published.Bricks.emplace_back();
  published.Files.emplace_back();
  Publication::Part& part = published.Parts.emplace_back();
  std::shared_ptr<bricks::VoxelField>& field = part.Field;
  std::vector<std::shared_ptr<const bricks::VoxelSource>> sources;
  messenger.RunTogether("Preparing the " + purpose,
    [&]
    {
      field = this->CreateField(number, choice, purpose, infos);
      if (field)
      {
        if (!choice.IsAveraged)
        {
          sources = this->CreateSources(number, field->Lattice, choice);
        }
        part.Digests = dsm::FragmentDigests(field->Lattice.GetBrickCount());
      }
    });
  if (!field)
  {
    return;
  }
  published.Bricks.back() = field;
  const std::string what = "the " + purpose + " '" + choice.Name + "'";
  // Values at points; what colors by cells or by colors themselves is cut by the ranks that have it, and so are
  // means of cells of which some are missing.
  const bricks::ValidValues& valid =
    infos[this->Plan.GetLattices()[number].Members.front().Piece].Valid;
  const bool canBeRead = !this->HasGaps(number, infos) && !field->Lattice.IsOfCells() &&
    choice.Component != vtkDSMImagePiece::Color &&
    !(choice.OnCells && valid.Exclude(field->Lattice.GetScalarType()));
  if (canBeRead)
  {
    const bricks::LatticePlan::Lattice& lattice = this->Plan.GetLattices()[number];
    const vtkDSMFileValues* const own = this->FindFileValues(number, choice);
    const bool isFirst = this->FindOwn(lattice.Members.front());
    if (std::shared_ptr<const vtkDSMFileVolume> file = vtkDSMFileVolume::Find(
          messenger, lattice, seats, own, isFirst && own, choice.Component, choice.OnCells, valid))
    {
      part.Digests = {};
      this->PublishFile(*file, false, own, what, progress, part, std::move(old));
      published.Files.back() = std::move(file);
      return;
    }
  }
  if (choice.IsAveraged)
  {
    sources = this->AverageCells(number, choice, infos, "Averaging the cells of the " + purpose);
  }
  if (old.Field && !old.Source && old.Field->Lattice == field->Lattice)
  {
    this->Renew(part, std::move(old), sources, what, progress);
    field->Hierarchy = bricks::MacrocellHierarchy(field->Lattice, *field->Segment, messenger);
    return;
  }
  old = {};
  *field = *this->Group->PublishWithRoom(
    [&](dsm::BlockStore::Place place)
    {
      return bricks::PublishVolume(what, field->Lattice, sources, this->Group->GetStore(),
        messenger, { place, &part.Digests }, progress);
    });
  field->Planes = this->Plan.GetLattices()[number].Planes;
}

const vtkDSMFileValues* vtkDSMVolumeData::FindFileValues(
  std::size_t lattice, const Choice& choice) const
{
  for (const auto& member : this->Plan.GetLattices()[lattice].Members)
  {
    if (vtkDataSet* image = this->FindOwn(member))
    {
      vtkDSMImageArrays::Info info;
      vtkDataArray* const array = vtkDSMImageArrays::Find(image, choice, info);
      return array ? vtkDSMGetFileValues(array) : nullptr;
    }
  }
  return nullptr;
}

std::shared_ptr<bricks::VoxelField> vtkDSMVolumeData::MakeField() const
{
  std::shared_ptr<vtkDSMRankGroup> group = this->Group;
  // The group's publications hold what this captures after the last user has left, and so the group itself.
  return { new bricks::VoxelField,
    [group](bricks::VoxelField* old) mutable
    {
      const auto last = std::move(group);
      if (old->Segment)
      {
        last->GetStore().Retire(old->Segment);
      }
      delete old;
    } };
}

bool vtkDSMVolumeData::HasGaps(
  std::size_t number, const std::vector<vtkDSMImageArrays::Info>& infos) const
{
  const bricks::LatticePlan::Lattice& lattice = this->Plan.GetLattices()[number];
  std::vector<bricks::Box> parts;
  for (const auto& member : lattice.Members)
  {
    if (infos[member.Piece].IsUsable())
    {
      if (this->Pieces[member.Piece].HasMask != 0)
      {
        return true;
      }
      parts.push_back(member.Cells);
    }
  }
  const bricks::Box whole{ bricks::Index3(0), lattice.Points - bricks::Index3(1) };
  return !bricks::LatticePlan::IsCovered(whole, parts);
}

std::shared_ptr<bricks::VoxelField> vtkDSMVolumeData::CreateField(std::size_t number,
  const Choice& choice, const std::string& purpose,
  const std::vector<vtkDSMImageArrays::Info>& infos) const
{
  const bricks::LatticePlan::Lattice& lattice = this->Plan.GetLattices()[number];
  std::set<bricks::ScalarType> types;
  bool masked = this->HasGaps(number, infos);
  for (const auto& member : lattice.Members)
  {
    if (infos[member.Piece].IsUsable())
    {
      const vtkDSMImageArrays::Info& info = infos[member.Piece];
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
    throw dsm::Error("The pieces of the " + purpose + " '" + choice.Name +
      "' have different scalar types. Convert them to one type, for example with Calculator.");
  }
  std::shared_ptr<bricks::VoxelField> field = this->MakeField();
  field->Lattice = bricks::BrickLattice(lattice.Points, *types.begin(), masked);
  field->Planes = lattice.Planes;
  if (choice.OnCells && !choice.IsAveraged)
  {
    field->Lattice = field->Lattice.OfCells();
  }
  return field;
}

std::vector<std::shared_ptr<const bricks::VoxelSource>> vtkDSMVolumeData::CreateSources(
  std::size_t number, const bricks::BrickLattice& bricks, const Choice& choice) const
{
  std::vector<std::shared_ptr<const bricks::VoxelSource>> sources;
  for (const auto& member : this->Plan.GetLattices()[number].Members)
  {
    if (vtkDataSet* image = this->FindOwn(member))
    {
      vtkDSMImageArrays::Info info;
      if (vtkDataArray* array = vtkDSMImageArrays::Find(image, choice, info))
      {
        sources.push_back(bricks::ValidSource::Make(
          std::make_shared<vtkDSMImagePiece>(image, array, choice.Component, member,
            this->Pieces[member.Piece].HasMask != 0, choice.OnCells),
          bricks, info.Valid));
      }
    }
  }
  return sources;
}
