// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMLevelData.h"

#include "DSMBricks/levels/PublishLevels.h"
#include "vtkDSMAmrData.h"
#include "vtkDSMImagePiece.h"
#include "vtkDSMTreeData.h"

#include "vtkBoundingBox.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkHyperTreeGrid.h"
#include "vtkImageData.h"
#include "vtkUniformGridAMR.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

vtkDSMLevelData::vtkDSMLevelData(std::shared_ptr<vtkDSMRankGroup> group)
  : Group(std::move(group))
  , Lower(std::numeric_limits<double>::infinity())
  , Upper(-std::numeric_limits<double>::infinity())
{
}

vtkDSMLevelData::~vtkDSMLevelData() = default;

bool vtkDSMLevelData::IsOfLevels(vtkDataObject* data)
{
  return vtkUniformGridAMR::SafeDownCast(data) || vtkHyperTreeGrid::SafeDownCast(data);
}

vtkDSMLevelData::Parts vtkDSMLevelData::GetParts(vtkDataObject* data)
{
  Parts parts;
  const bool isAmr = vtkUniformGridAMR::SafeDownCast(data);
  bool isMixed = false;
  const auto add = [&](vtkDataObject* object)
  {
    auto* image = vtkImageData::SafeDownCast(object);
    auto* trees = vtkHyperTreeGrid::SafeDownCast(object);
    const bool isTree = trees && trees->GetNumberOfElements(vtkDataObject::CELL) > 0;
    if (isTree || (isAmr && image && image->GetNumberOfPoints() > 0))
    {
      parts.emplace_back(object);
    }
    isMixed = isMixed || (object && !isAmr && !trees);
  };
  auto* composite = vtkCompositeDataSet::SafeDownCast(data);
  if (!composite)
  {
    add(data);
  }
  else
  {
    vtkSmartPointer<vtkCompositeDataIterator> leaf;
    leaf.TakeReference(composite->NewIterator());
    for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
    {
      add(leaf->GetCurrentDataObject());
    }
  }
  if (isMixed && !parts.empty())
  {
    throw dsm::Error("The dataset has hyper tree grids and other blocks. Show them apart, for "
                     "example with Extract Block.");
  }
  return parts;
}

std::unique_ptr<vtkDSMLevelData> vtkDSMLevelData::Create(
  const std::shared_ptr<vtkDSMRankGroup>& group, const Parts& parts)
{
  enum Kind : std::uint8_t
  {
    Nothing,
    Amr,
    Trees
  };
  Kind mine = parts.empty() ? Nothing : Amr;
  if (!parts.empty() && vtkHyperTreeGrid::SafeDownCast(parts.front()))
  {
    mine = Trees;
  }
  const std::vector<Kind> all = group->GetMessenger().AllGatherValue(mine);
  switch (*std::max_element(all.begin(), all.end()))
  {
    case Amr:
      return std::make_unique<vtkDSMAmrData>(group, parts);
    case Trees:
      return std::make_unique<vtkDSMTreeData>(group, parts);
    default:
      return nullptr;
  }
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

std::shared_ptr<const bricks::LevelVoxels> vtkDSMLevelData::Publish(const Choice& choice,
  const std::string& purpose, const std::vector<vtkDSMImageArrays::Info>& infos,
  const std::function<void(double)>& progress) const
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
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
      // Means of whole numbers are none; a float holds those of 16 bits.
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
  std::unique_ptr<bricks::LevelSource> source;
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
