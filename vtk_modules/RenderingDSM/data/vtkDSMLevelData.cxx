// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMLevelData.h"

#include "DSMBricks/levels/PublishLevels.h"
#include "vtkDSMAmrData.h"
#include "vtkDSMContent.h"
#include "vtkDSMImagePiece.h"
#include "vtkDSMTreeData.h"

#include "vtkBoundingBox.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkHyperTreeGrid.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

namespace
{

std::vector<vtkSmartPointer<vtkDataObject>> GetData(const vtkDSMLevelData::Parts& parts)
{
  std::vector<vtkSmartPointer<vtkDataObject>> data;
  for (const vtkDSMLevelData::Part& part : parts)
  {
    data.push_back(part.Data);
  }
  return data;
}

} // namespace

vtkDSMLevelData::vtkDSMLevelData(std::shared_ptr<vtkDSMRankGroup> group, const Parts& parts)
  : Group(std::move(group))
  , Lower(std::numeric_limits<double>::infinity())
  , Upper(-std::numeric_limits<double>::infinity())
  , Own(GetData(parts))
  , Arrays(this->Group->GetMessenger(), this->Own)
{
}

vtkDSMLevelData::~vtkDSMLevelData() = default;

std::vector<std::unique_ptr<vtkDSMLevelData>> vtkDSMLevelData::Create(
  const std::shared_ptr<vtkDSMRankGroup>& group, const Parts& parts)
{
  Parts images;
  Parts trees;
  for (const Part& part : parts)
  {
    (vtkHyperTreeGrid::SafeDownCast(part.Data) ? trees : images).push_back(part);
  }
  std::vector<std::unique_ptr<vtkDSMLevelData>> all;
  const std::vector<std::uint8_t> haveAmr =
    group->GetMessenger().AllGatherValue(std::uint8_t(images.empty() ? 0 : 1));
  if (*std::max_element(haveAmr.begin(), haveAmr.end()) != 0)
  {
    all.push_back(std::make_unique<vtkDSMAmrData>(group, images));
  }
  for (const Parts& joined : vtkDSMTreeData::Join(group->GetMessenger(), trees))
  {
    all.push_back(std::make_unique<vtkDSMTreeData>(group, joined));
  }
  return all;
}

std::uint64_t vtkDSMLevelData::HashPlaces() const
{
  if (!this->PlacesHash)
  {
    bricks::ByteHash hash;
    this->AddPlaces(hash);
    this->PlacesHash = hash.Get();
  }
  return *this->PlacesHash;
}

vtkDSMLevelData::Choice vtkDSMLevelData::Find(const Choice& choice) const
{
  Choice ofCells{ choice.Name, choice.Component, true };
  ofCells.Valid = choice.Valid;
  const bool isOfCells =
    this->Arrays.CountComponents(choice) == 0 && this->Arrays.CountComponents(ofCells) > 0;
  return isOfCells ? this->Arrays.Normalize(ofCells) : choice;
}

std::vector<vtkDSMImageArrays::Info> vtkDSMLevelData::FindArrays(const Choice& choice) const
{
  std::vector<vtkDSMImageArrays::Info> infos(this->Own.size());
  for (std::size_t own = 0; own < this->Own.size(); ++own)
  {
    vtkDSMImageArrays::Find(this->Own[own], this->Find(choice), infos[own]);
  }
  return infos;
}

void vtkDSMLevelData::AddContent(const Choice& choice, int threads, bricks::ByteHash& hash) const
{
  const auto add = [&](vtkAbstractArray* array)
  {
    const std::uint64_t value = vtkDSMContent::Hash(array, threads);
    hash.Add(&value, sizeof(value));
  };
  const std::uint64_t places = this->HashPlaces();
  hash.Add(&places, sizeof(places));
  for (vtkDataObject* part : this->Own)
  {
    vtkDSMImageArrays::Info info;
    add(vtkDSMImageArrays::Find(part, this->Find(choice), info));
    add(part->GetAttributes(vtkDataObject::CELL)
          ->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
  }
}

void vtkDSMLevelData::SetPlace(
  const glm::dvec3& origin, const glm::dmat3& direction, const glm::dvec3& spacing)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    this->IndexToWorld[axis] = glm::dvec4(direction[axis] * spacing[axis], 0.0);
  }
  this->IndexToWorld[3] = glm::dvec4(origin, 1.0);
}

void vtkDSMLevelData::GetBounds(double bounds[6]) const
{
  vtkBoundingBox box;
  for (int corner = 0; corner < 8 && this->Lower.x <= this->Upper.x; ++corner)
  {
    const glm::dvec4 point = this->IndexToWorld *
      glm::dvec4(corner & 1 ? this->Upper.x : this->Lower.x,
        corner & 2 ? this->Upper.y : this->Lower.y, corner & 4 ? this->Upper.z : this->Lower.z,
        1.0);
    box.AddPoint(point.x, point.y, point.z);
  }
  box.GetBounds(bounds);
}

std::shared_ptr<const bricks::LevelVoxels> vtkDSMLevelData::Publish(const Choice& wanted,
  const std::string& purpose, const std::vector<vtkDSMImageArrays::Info>& infos,
  const std::function<void(double)>& progress) const
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  const Choice choice = this->Find(wanted);
  if (choice.Component == vtkDSMImagePiece::Color)
  {
    throw dsm::Error("The colors in the array '" + choice.Name +
      "' cannot be shown as they are on AMR and hyper tree grids. Turn on Map Scalars.");
  }
  bool isThere = false;
  bricks::ScalarType type = bricks::ScalarType::Float32;
  for (const vtkDSMImageArrays::Info& info : infos)
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
  const std::string what = "the " + purpose + " '" + choice.Name + "'";
  std::unique_ptr<vtkDSMLevelSource> source;
  messenger.RunTogether("Preparing the " + purpose, [&] { source = this->CreateSource(choice); });
  const bricks::LevelLattice lattice =
    bricks::DivideLevels(what, this->Scales, type, *source, messenger);
  const int threads = this->Group->GetStore().GetSettings().Workers;
  std::shared_ptr<bricks::LevelVoxels> voxels = this->Group->PublishWithRoom(
    [&](dsm::BlockStore::Place place)
    {
      return bricks::PublishLevels(
        what, lattice, *source, this->Group->GetStore(), messenger, place, threads, progress);
    });
  std::shared_ptr<vtkDSMRankGroup> group = this->Group;
  const bricks::LevelVoxels* const values = voxels.get();
  // Leaves the store with its last user. The group's publications hold what this captures.
  return { values,
    [group, voxels = std::move(voxels)](const bricks::LevelVoxels*) mutable
    {
      const auto last = std::move(group);
      last->GetStore().Retire(voxels->Segment);
      voxels.reset();
    } };
}
