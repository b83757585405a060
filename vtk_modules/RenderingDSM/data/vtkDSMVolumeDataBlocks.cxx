// SPDX-License-Identifier: BSD-3-Clause
// The blocks of a dataset.
#include "vtkDSMVolumeData.h"

#include "vtkDSMImagePiece.h"

#include "vtkCompositeDataIterator.h"
#include "vtkDataObjectTree.h"
#include "vtkDataObjectTreeIterator.h"
#include "vtkDataSet.h"
#include "vtkHyperTreeGrid.h"
#include "vtkImageData.h"
#include "vtkPartitionedDataSet.h"
#include "vtkRectilinearGrid.h"
#include "vtkUniformGridAMR.h"

#include <algorithm>
#include <string>

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

/// Returns 0 for data that are no grid of values.
int GetDimension(vtkDataObject* object)
{
  auto* const image = vtkImageData::SafeDownCast(object);
  auto* const grid = vtkRectilinearGrid::SafeDownCast(object);
  auto* const trees = vtkHyperTreeGrid::SafeDownCast(object);
  return image ? image->GetDataDimension()
    : grid     ? grid->GetDataDimension()
    : trees    ? static_cast<int>(trees->GetDimension())
               : 0;
}

vtkDSMBlockLook FindLook(const vtkDSMBlockLooks& looks, int leaf)
{
  const auto look = looks.find(static_cast<unsigned int>(leaf));
  return look != looks.end() ? look->second : vtkDSMBlockLook();
}

} // namespace

std::vector<vtkDSMBlockLook> vtkDSMVolumeData::Collect(
  vtkDataObject* data, const vtkDSMBlockLooks& looks, bool hasVolumes)
{
  std::vector<vtkDSMBlockLook> ofImages;
  bool isAnyOther = false;
  const auto add = [&](vtkDataObject* object, int leaf, int dataset)
  {
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
      this->LevelParts.push_back({ trees, dataset, FindLook(looks, leaf) });
    }
    else if (image && image->GetNumberOfPoints() > 0)
    {
      this->Images.emplace_back(image);
      this->Leaves.push_back(leaf);
      ofImages.push_back(FindLook(looks, leaf));
    }
    isAnyOther = isAnyOther || (!trees && !image);
  };
  dsm::Messenger& messenger = this->Group->GetMessenger();
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
              this->LevelParts.push_back({ image, leaf, FindLook(looks, 0) });
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
      if (isAnyOther && !tree)
      {
        throw dsm::Error(std::string("A dataset of type ") + data->GetClassName() +
          " cannot be ray traced. Image data, a rectilinear grid, AMR, a hyper tree grid, or "
          "blocks of these are "
          "required. Apply Resample To Image first.");
      }
    });
  const auto isOf = [&](bool is)
  {
    const auto all = messenger.AllGatherValue(std::uint8_t(is ? 1 : 0));
    return *std::max_element(all.begin(), all.end()) != 0;
  };
  const bool isAny = isOf(hasVolumes || !this->Images.empty() || !this->LevelParts.empty());
  if (isOf(isAnyOther) && !isAny)
  {
    throw dsm::Error(
      "The blocks of the dataset are neither image data nor rectilinear grids nor hyper tree "
      "grids, one of which ray tracing requires. Apply Resample To Image first.");
  }
  return ofImages;
}

void vtkDSMVolumeData::AddVolumes(
  vtkDataObject* data, std::vector<vtkSmartPointer<vtkDataObject>>& volumes)
{
  const auto add = [&volumes](vtkDataObject* object, int, int)
  {
    if (GetDimension(object) == 3)
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

std::vector<vtkDSMVolumeData::Block> vtkDSMVolumeData::GetBlocks(std::size_t part) const
{
  if (part >= this->GetNumberOfLattices())
  {
    return this->GetLevels(part - this->GetNumberOfLattices()).GetBlocks();
  }
  std::vector<Block> blocks;
  for (const bricks::LatticePlan::Member& member : this->Plan.GetLattices()[part].Members)
  {
    blocks.push_back({ member.Cells, this->Looks[member.Piece] });
  }
  return blocks;
}
