// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMLevelPart.h"

#include "DSMBricks/levels/PublishLevels.h"
#include "vtkDSMAmrPart.h"
#include "vtkDSMImagePiece.h"
#include "vtkDSMTreePart.h"

#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkHyperTreeGrid.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

namespace
{

vtkDSMOwnCells::Datasets GetData(const vtkDSMLevelPart::OwnPieces& pieces)
{
  vtkDSMOwnCells::Datasets data;
  for (const vtkDSMLevelPart::Piece& piece : pieces)
  {
    data.push_back(piece.Data);
  }
  return data;
}

class LevelValues final : public vtkDSMPartValues
{
public:
  explicit LevelValues(const rt::LevelField& field)
    : vtkDSMPartValues(field)
    , Voxels(field.Voxels)
  {
  }

  bricks::SurveyedBricks GetSurveyed() const override { return { &this->Voxels->Survey }; }
  bricks::Index3 CountSlices() const override
  {
    return bricks::Index3(glm::ceil(this->Voxels->Lattice.GetBounds()[1])) + bricks::Index3(1);
  }

private:
  std::shared_ptr<const bricks::LevelVoxels> Voxels;
};

} // namespace

vtkDSMLevelPart::vtkDSMLevelPart(std::shared_ptr<vtkDSMRankGroup> group, const OwnPieces& pieces)
  : vtkDSMPart(std::move(group))
  , Own(GetData(pieces))
  , Arrays(this->Group->GetMessenger(), this->Own)
{
}

vtkDSMLevelPart::~vtkDSMLevelPart() = default;

std::vector<std::unique_ptr<vtkDSMPart>> vtkDSMLevelPart::Create(
  const std::shared_ptr<vtkDSMRankGroup>& group, const OwnPieces& pieces)
{
  OwnPieces images;
  OwnPieces trees;
  for (const Piece& piece : pieces)
  {
    (vtkHyperTreeGrid::SafeDownCast(piece.Data) ? trees : images).push_back(piece);
  }
  std::vector<std::unique_ptr<vtkDSMPart>> all;
  const std::vector<std::uint8_t> haveAmr =
    group->GetMessenger().AllGatherValue(std::uint8_t(images.empty() ? 0 : 1));
  if (*std::max_element(haveAmr.begin(), haveAmr.end()) != 0)
  {
    all.push_back(std::make_unique<vtkDSMAmrPart>(group, images));
  }
  for (const OwnPieces& joined : vtkDSMTreePart::Join(group->GetMessenger(), trees))
  {
    all.push_back(std::make_unique<vtkDSMTreePart>(group, joined));
  }
  return all;
}

std::uint64_t vtkDSMLevelPart::HashPlaces() const
{
  if (!this->PlacesHash)
  {
    bricks::ByteHash hash;
    this->AddPlaces(hash);
    this->PlacesHash = hash.Get();
  }
  return *this->PlacesHash;
}

vtkDSMPart::Choice vtkDSMLevelPart::Find(const Choice& choice) const
{
  Choice ofCells{ choice.Name, choice.Component, true };
  ofCells.Valid = choice.Valid;
  const bool isOfCells =
    this->Arrays.CountComponents(choice) == 0 && this->Arrays.CountComponents(ofCells) > 0;
  return isOfCells ? this->Arrays.Normalize(ofCells) : choice;
}

std::vector<vtkDSMPart::Info> vtkDSMLevelPart::FindArrays(const Choice& choice) const
{
  std::vector<Info> infos(this->Own.size());
  for (std::size_t own = 0; own < this->Own.size(); ++own)
  {
    vtkDSMImageArrays::Find(this->Own[own], this->Find(choice), infos[own]);
  }
  return infos;
}

void vtkDSMLevelPart::AddContent(const Choice& choice, bricks::ByteHash& hash) const
{
  const std::uint64_t places = this->HashPlaces();
  hash.Add(&places, sizeof(places));
  for (vtkDataObject* const own : this->Own)
  {
    Info info;
    this->AddArray(vtkDSMImageArrays::Find(own, this->Find(choice), info), hash);
    this->AddArray(own->GetAttributes(vtkDataObject::CELL)
                     ->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()),
      hash);
  }
}

void vtkDSMLevelPart::SetPlace(
  const glm::dvec3& origin, const glm::dmat3& direction, const glm::dvec3& spacing)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    this->IndexToData[axis] = glm::dvec4(direction[axis] * spacing[axis], 0.0);
  }
  this->IndexToData[3] = glm::dvec4(origin, 1.0);
}

std::shared_ptr<vtkDSMPartValues> vtkDSMLevelPart::Publish(
  const Request& request, const std::vector<Info>& infos, std::shared_ptr<vtkDSMPartValues>) const
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  const Choice choice = this->Find(request.Array);
  if (request.Array.HasMask())
  {
    throw dsm::Error("The mask array '" + request.Array.Mask.Name +
      "' cannot hide cells of AMR or hyper tree grids. Set Mask Array to None, or apply Threshold "
      "or Resample To Image first.");
  }
  if (choice.Component == vtkDSMImagePiece::Color)
  {
    throw dsm::Error("The colors in the array '" + choice.Name +
      "' cannot be shown as they are on AMR and hyper tree grids. Turn on Map Scalars.");
  }
  bool isThere = false;
  bricks::ScalarType type = bricks::ScalarType::Float32;
  for (const Info& info : infos)
  {
    if (info.IsUsable())
    {
      isThere = true;
      // Averages of integers are not integers; a float holds those of 16 bits.
      const bool fits =
        info.Type == bricks::ScalarType::Float32 || bricks::GetBytes(info.Type) <= 2;
      type = fits ? type : bricks::ScalarType::Float64;
    }
  }
  if (!isThere)
  {
    return nullptr;
  }
  const std::string what = request.GetName();
  std::unique_ptr<vtkDSMLevelSource> source;
  messenger.RunTogether(
    "Preparing the " + request.Purpose, [&] { source = this->CreateSource(choice); });
  const bricks::LevelLattice lattice =
    bricks::DivideLevels(what, this->Scales, type, *source, messenger);
  const int threads = this->Group->GetStore().GetSettings().Workers;
  std::shared_ptr<bricks::LevelVoxels> voxels = this->Group->PublishWithRoom(
    [&](dsm::BlockStore::Place place)
    {
      return bricks::PublishLevels(what, lattice, *source, this->Group->GetStore(), messenger,
        place, threads, request.Progress);
    });
  std::shared_ptr<vtkDSMRankGroup> group = this->Group;
  const bricks::LevelVoxels* const values = voxels.get();
  rt::LevelField field;
  // Leaves the store with its last user. The group's publications hold what this captures.
  field.Voxels = { values,
    [group, voxels = std::move(voxels)](const bricks::LevelVoxels*) mutable
    {
      const auto last = std::move(group);
      last->GetStore().Retire(voxels->Segment);
      voxels.reset();
    } };
  field.SetIndexToWorld(this->IndexToData);
  return std::make_shared<LevelValues>(field);
}
