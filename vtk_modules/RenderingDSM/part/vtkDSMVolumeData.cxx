// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMVolumeData.h"

#include "DSMBricks/base/ByteHash.h"
#include "vtkDSMCellPart.h"
#include "vtkDSMGather.h"
#include "vtkDSMGridCells.h"
#include "vtkDSMImagePiece.h"
#include "vtkDSMJoinedImages.h"
#include "vtkDSMLevelPart.h"

#include "vtkBoundingBox.h"
#include "vtkCompositeDataIterator.h"
#include "vtkDataObjectTree.h"
#include "vtkDataObjectTreeIterator.h"
#include "vtkDataSet.h"
#include "vtkHyperTreeGrid.h"
#include "vtkImageData.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPointSet.h"
#include "vtkRectilinearGrid.h"
#include "vtkUniformGridAMR.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <string>
#include <utility>

namespace
{

/// Calls `visit(leaf, index, dataset)` with the leaf's flat index, and with that of what it is a piece of.
template <class Visit>
void ForEachLeaf(vtkCompositeDataSet* data, const Visit& visit)
{
  auto* pieces = vtkPartitionedDataSet::SafeDownCast(data);
  int dataset = 0; // flat index of these
  vtkSmartPointer<vtkCompositeDataIterator> node;
  node.TakeReference(data->NewIterator());
  auto* const tree = vtkDataObjectTreeIterator::SafeDownCast(node);
  if (tree && !vtkUniformGridAMR::SafeDownCast(data))
  {
    tree->VisitOnlyLeavesOff();
  }
  for (node->InitTraversal(); !node->IsDoneWithTraversal(); node->GoToNextItem())
  {
    vtkDataObject* const object = node->GetCurrentDataObject();
    const auto index = static_cast<int>(node->GetCurrentFlatIndex());
    if (auto* some = vtkPartitionedDataSet::SafeDownCast(object))
    {
      pieces = some;
      dataset = index;
    }
    if (!vtkCompositeDataSet::SafeDownCast(object))
    {
      const bool isPiece =
        pieces && index <= dataset + static_cast<int>(pieces->GetNumberOfPartitions());
      visit(object, index, isPiece ? dataset : index);
    }
  }
}

/// Returns 0 for data that are no grid of values, and for grids of points without cells that have a volume.
int GetDimension(vtkDataObject* object)
{
  auto* const image = vtkImageData::SafeDownCast(object);
  auto* const grid = vtkRectilinearGrid::SafeDownCast(object);
  auto* const trees = vtkHyperTreeGrid::SafeDownCast(object);
  vtkPointSet* const cells = vtkDSMGridCells::FindGrid(object);
  return image                                   ? image->GetDataDimension()
    : grid                                       ? grid->GetDataDimension()
    : trees                                      ? static_cast<int>(trees->GetDimension())
    : cells && vtkDSMGridCells::HasVolume(cells) ? 3
                                                 : 0;
}

vtkDSMBlockLook FindLook(const vtkDSMBlockLooks& looks, int leaf)
{
  const auto look = looks.find(static_cast<unsigned int>(leaf));
  return look != looks.end() ? look->second : vtkDSMBlockLook();
}

/// This rank's data, by how they are joined.
struct Collected
{
  std::vector<vtkDSMJoinedImages::Image> Images;
  vtkDSMLevelPart::OwnPieces Levels;
  vtkDSMCellPart::OwnPieces Cells;
};

/// Collective. Sorts this rank's data. `hasVolumes`: there are volumes here, which may be hidden.
Collected Collect(
  dsm::Messenger& messenger, vtkDataObject* data, const vtkDSMBlockLooks& looks, bool hasVolumes)
{
  Collected all;
  bool isAnyOther = false;
  bool isAnyFlat = false; // grids of points without cells that have a volume
  const auto add = [&](vtkDataObject* object, int leaf, int dataset)
  {
    vtkPointSet* const cells = vtkDSMGridCells::FindGrid(object);
    auto* const trees = vtkHyperTreeGrid::SafeDownCast(object);
    vtkDataSet* const image = vtkDSMImagePiece::FindImage(object);
    const bool isBlock = object != data;
    if (FindLook(looks, leaf).IsHidden)
    {
      return;
    }
    if (trees && trees->GetNumberOfElements(vtkDataObject::CELL) > 0 &&
      (!isBlock || trees->GetDimension() == 3))
    {
      all.Levels.push_back({ trees, dataset, FindLook(looks, leaf) });
    }
    else if (image && image->GetNumberOfPoints() > 0)
    {
      all.Images.push_back({ image, leaf, FindLook(looks, leaf) });
    }
    else if (cells && vtkDSMGridCells::HasVolume(cells))
    {
      all.Cells.push_back({ cells, FindLook(looks, leaf) });
    }
    else if (cells)
    {
      isAnyFlat = isAnyFlat || cells->GetNumberOfCells() > 0;
    }
    isAnyOther = isAnyOther || (!trees && !image && !cells);
  };
  messenger.RunTogether("Reading the volume",
    [&]
    {
      auto* const amr = vtkUniformGridAMR::SafeDownCast(data);
      auto* const tree = amr ? nullptr : vtkDataObjectTree::SafeDownCast(data);
      if (amr)
      {
        ForEachLeaf(amr,
          [&](vtkDataObject* image, int leaf, int)
          {
            if (image->GetNumberOfElements(vtkDataObject::POINT) > 0 &&
              !FindLook(looks, leaf).IsHidden)
            {
              if (!vtkImageData::SafeDownCast(image))
              {
                throw dsm::Error(std::string("A block of the AMR dataset is of type ") +
                  image->GetClassName() +
                  "; ray tracing requires blocks of image data. Apply Resample To Image first.");
              }
              all.Levels.push_back({ image, leaf, FindLook(looks, 0) });
            }
          });
      }
      else if (tree)
      {
        ForEachLeaf(tree, add);
      }
      else if (data)
      {
        add(data, 0, 0);
      }
      if (isAnyOther && data->IsA("vtkPolyData"))
      {
        throw dsm::Error(
          "The dataset is a surface (vtkPolyData): it has no isosurfaces, volume or slices. Show "
          "it as a surface (in ParaView: DSM Ray Traced), or show the grid it was made from.");
      }
      if (isAnyOther && !tree)
      {
        throw dsm::Error(std::string("A dataset of type ") + data->GetClassName() +
          " cannot be ray traced. Image data, a rectilinear, structured or unstructured grid, AMR, "
          "a hyper tree grid, or blocks of these are required. Apply Resample To Image first.");
      }
    });
  const auto isOf = [&](bool is)
  {
    const auto flags = messenger.AllGatherValue(std::uint8_t(is ? 1 : 0));
    return *std::max_element(flags.begin(), flags.end()) != 0;
  };
  const bool isAny =
    isOf(hasVolumes || !all.Images.empty() || !all.Levels.empty() || !all.Cells.empty());
  const bool areFlat = isOf(isAnyFlat);
  if (isOf(isAnyOther) && !isAny && !areFlat)
  {
    throw dsm::Error(
      "The blocks of the dataset are neither image data nor rectilinear, structured or "
      "unstructured "
      "grids nor hyper tree grids, one of which ray tracing requires. Apply Resample To Image "
      "first.");
  }
  if (areFlat && !isAny)
  {
    throw dsm::Error(
      "The cells of the dataset have no volume, so they have no isosurfaces, volume or slices. "
      "Show them as a surface (in ParaView: DSM Ray Traced).");
  }
  return all;
}

/// Local. Adds the volumes of a dataset, which may be null, or of its blocks, hidden ones included.
void AddVolumes(vtkDataObject* data, std::vector<vtkSmartPointer<vtkDataObject>>& volumes)
{
  const auto add = [&volumes](vtkDataObject* object, int, int)
  {
    if (vtkDSMVolumeData::IsVolume(object))
    {
      volumes.emplace_back(object);
    }
  };
  if (auto* blocks = vtkCompositeDataSet::SafeDownCast(data))
  {
    ForEachLeaf(blocks, add);
  }
  else if (data)
  {
    add(data, 0, 0);
  }
}

} // namespace

vtkDSMVolumeData::vtkDSMVolumeData(std::shared_ptr<vtkDSMRankGroup> group, vtkDataObject* data,
  vtkDataObject* original, const Chooser& choose, const vtkDSMBlockLooks& looks)
  : Group(std::move(group))
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  std::vector<vtkSmartPointer<vtkDataObject>> withHidden;
  AddVolumes(data, withHidden);
  AddVolumes(original, withHidden);
  const Collected own = Collect(messenger, data, looks, !withHidden.empty());
  std::vector<vtkSmartPointer<vtkDataObject>> all;
  messenger.RunTogether("Reading the volume",
    [&]
    {
      for (const vtkDSMJoinedImages::Image& image : own.Images)
      {
        all.emplace_back(image.Data);
      }
      for (const vtkDSMLevelPart::Piece& piece : own.Levels)
      {
        all.push_back(piece.Data);
      }
      for (const vtkDSMCellPart::Piece& piece : own.Cells)
      {
        all.emplace_back(piece.Data);
      }
    });
  this->Arrays = vtkDSMImageArrays(messenger, all, withHidden);
  vtkDSMJoinedImages images(this->Group, own.Images);
  auto levels = vtkDSMLevelPart::Create(this->Group, own.Levels);
  auto cells = vtkDSMCellPart::Create(this->Group, own.Cells);
  this->Seams = images.SeparateBlocks(this->Arrays, choose(this->Arrays));
  this->Parts = images.CreateParts();
  std::move(levels.begin(), levels.end(), std::back_inserter(this->Parts));
  std::move(cells.begin(), cells.end(), std::back_inserter(this->Parts));
}

vtkDSMVolumeData::~vtkDSMVolumeData() = default;

bool vtkDSMVolumeData::IsVolume(vtkDataObject* data)
{
  return GetDimension(data) == 3;
}

void vtkDSMVolumeData::GetBounds(double bounds[6]) const
{
  vtkBoundingBox box;
  for (const auto& part : this->Parts)
  {
    part->AddBounds(box);
  }
  box.GetBounds(bounds);
}

std::uint64_t vtkDSMVolumeData::HashContent(const Choice& choice) const
{
  bricks::ByteHash hash;
  hash.Add(&choice.Component, sizeof(choice.Component));
  hash.Add(&choice.OnCells, sizeof(choice.OnCells));
  hash.Add(&choice.IsAveraged, sizeof(choice.IsAveraged));
  hash.Add(&choice.Valid, sizeof(choice.Valid));
  if (choice.HasMask())
  {
    const vtkDSMImageArrays::CellMask& mask = choice.Mask;
    const std::uint64_t count = mask.Values.size();
    hash.Add(mask.Name.data(), mask.Name.size());
    hash.Add(&mask.OnCells, sizeof(mask.OnCells));
    hash.Add(&mask.Lowest, sizeof(mask.Lowest));
    hash.Add(&mask.Highest, sizeof(mask.Highest));
    hash.Add(&count, sizeof(count));
    hash.Add(mask.Values.data(), mask.Values.size() * sizeof(double));
  }
  for (const auto& part : this->Parts)
  {
    part->AddContent(choice, hash);
  }
  return hash.Get();
}

std::shared_ptr<const vtkDSMVolumeData::Publication> vtkDSMVolumeData::Publish(
  const vtkDSMPart::Request& request, std::shared_ptr<const Publication> old) const
{
  struct Found
  {
    std::uint64_t Part;
    vtkDSMPart::Info Info;
  };
  dsm::Messenger& messenger = this->Group->GetMessenger();
  const auto published = std::make_shared<Publication>();
  std::vector<Found> mine;
  messenger.RunTogether("Reading the " + request.Purpose,
    [&]
    {
      for (std::size_t part = 0; part < this->Parts.size(); ++part)
      {
        for (const vtkDSMPart::Info& info : this->Parts[part]->FindArrays(request.Array))
        {
          mine.push_back({ part, info });
        }
      }
      published->Content = this->HashContent(request.Array);
    });
  std::vector<vtkDSMPart::Info> all;
  std::vector<std::vector<vtkDSMPart::Info>> infos(this->Parts.size());
  for (const Found& found : vtkDSMGather::Items(messenger, mine))
  {
    all.push_back(found.Info);
    infos[found.Part].push_back(found.Info);
  }
  const auto isUsable = [](const vtkDSMPart::Info& info) { return info.IsUsable(); };
  if (!all.empty() && std::none_of(all.begin(), all.end(), isUsable))
  {
    this->Arrays.Refuse(request.Array, request.Purpose, all);
  }

  this->FindMask(request.Array);

  dsm::Publications& publications = this->Group->GetPublications();
  if (const auto known = publications.Find<Publication>(messenger, published->Content))
  {
    return known;
  }
  for (std::size_t part = 0; part < this->Parts.size(); ++part)
  {
    published->Parts.push_back(this->Parts[part]->Publish(
      request, infos[part], old ? std::move(old->Parts[part]) : nullptr));
  }
  publications.Add<Publication>(published->Content, published);
  return published;
}

void vtkDSMVolumeData::FindMask(const Choice& choice) const
{
  if (!choice.HasMask())
  {
    return;
  }
  dsm::Messenger& messenger = this->Group->GetMessenger();
  std::vector<vtkDSMPart::Info> mine;
  messenger.RunTogether("Reading the mask array",
    [&]
    {
      for (const auto& part : this->Parts)
      {
        const std::vector<vtkDSMPart::Info> infos = part->FindArrays(choice.GetMaskArray());
        mine.insert(mine.end(), infos.begin(), infos.end());
      }
    });
  const std::vector<vtkDSMPart::Info> all = vtkDSMGather::Items(messenger, mine);
  if (!all.empty() &&
    std::none_of(all.begin(), all.end(), [](const auto& info) { return info.IsUsable(); }))
  {
    this->Arrays.Refuse(choice.GetMaskArray(), "mask array", all);
  }
}

bool vtkDSMVolumeData::MayTakeOver(const std::shared_ptr<const Publication>& old) const
{
  if (!old || old.use_count() != 1 || old->Parts.size() != this->Parts.size())
  {
    return false;
  }
  return std::equal(this->Parts.begin(), this->Parts.end(), old->Parts.begin(),
    [](const auto& part, const auto& values) { return !values || part->MayTakeOver(*values); });
}

std::shared_ptr<const vtkDSMVolumeData::Coarser> vtkDSMVolumeData::PublishCoarser(
  const Publication& finest, const vtkDSMPart::Request& request) const
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  dsm::Publications& publications = this->Group->GetPublications();
  if (const auto known = publications.Find<Coarser>(messenger, finest.Content))
  {
    return known;
  }
  int mine = std::numeric_limits<int>::max(); // over all parts that have the array
  for (const auto& values : finest.Parts)
  {
    mine = values ? std::min(mine, values->CountCoarser()) : mine;
  }
  const std::vector<int> all = messenger.AllGatherValue(mine);
  const int levels = *std::min_element(all.begin(), all.end());
  const auto coarser = std::make_shared<Coarser>();
  bool isAny = levels < std::numeric_limits<int>::max();
  for (int level = 1; isAny && level <= levels; ++level)
  {
    Values values(finest.Parts.size());
    for (std::size_t part = 0; isAny && part < values.size(); ++part)
    {
      if (finest.Parts[part])
      {
        values[part] = level <= finest.Parts[part]->GetLevel()
          ? finest.Parts[part]
          : this->Parts[part]->PublishCoarser(*finest.Parts[part], level, request);
        isAny = values[part] != nullptr;
      }
    }
    if (isAny)
    {
      coarser->push_back(std::move(values));
    }
  }
  publications.Add<Coarser>(finest.Content, coarser);
  return coarser;
}

const vtkDSMNestedLevels* vtkDSMVolumeData::FindNested(const Publication& publication)
{
  const bool isOne = publication.Parts.size() == 1 && publication.Parts.front();
  return isOne ? publication.Parts.front()->GetNested() : nullptr;
}
