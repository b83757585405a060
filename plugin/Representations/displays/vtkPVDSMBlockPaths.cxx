// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMBlockPaths.h"

#include "vtkCompositeDataIterator.h"
#include "vtkDataAssembly.h"
#include "vtkDataAssemblyUtilities.h"
#include "vtkDataObjectTree.h"
#include "vtkFieldData.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkSmartPointer.h"
#include "vtkUniformGridAMR.h"
#include "vtkUnsignedIntArray.h"

#include <algorithm>

#if __has_include("vtkUniformGridAMRIterator.h") // its name since VTK 9.6
#include "vtkUniformGridAMRIterator.h"
using vtkPVDSMAmrIterator = vtkUniformGridAMRIterator;
#else
#include "vtkUniformGridAMRDataIterator.h"
using vtkPVDSMAmrIterator = vtkUniformGridAMRDataIterator;
#endif

// AMR are collections since VTK 9.5, and no multi-block datasets before.
vtkPVDSMBlockPaths::vtkPVDSMBlockPaths(vtkDataObject* data)
  : Amr(vtkUniformGridAMR::SafeDownCast(data))
  , Collection(this->Amr ? nullptr : vtkPartitionedDataSetCollection::SafeDownCast(data))
  , IsKnown((this->Amr || this->Collection || vtkMultiBlockDataSet::SafeDownCast(data)) &&
      vtkDataAssemblyUtilities::GenerateHierarchy(
        vtkCompositeDataSet::SafeDownCast(data), this->Assembly))
{
}

vtkPVDSMBlockPaths::~vtkPVDSMBlockPaths() = default;

std::vector<unsigned int> vtkPVDSMBlockPaths::Find(const std::vector<std::string>& paths) const
{
  if (this->Amr)
  {
    const std::vector<int> nodes = this->Assembly->SelectNodes(paths);
    const bool hasRoot =
      std::find(nodes.begin(), nodes.end(), vtkDataAssembly::GetRootNode()) != nodes.end();
    return hasRoot ? std::vector<unsigned int>{ 0 } : std::vector<unsigned int>();
  }
  const auto found = vtkDataAssemblyUtilities::GetSelectedCompositeIds(
    paths, this->Assembly, nullptr, !this->Collection);
  return this->Collection ? this->FindPartitions(found) : found;
}

/// VTK finds the nodes of a collection only: it, or its partitioned datasets.
std::vector<unsigned int> vtkPVDSMBlockPaths::FindPartitions(
  const std::vector<unsigned int>& nodes) const
{
  const auto has = [&](unsigned int node)
  { return std::find(nodes.begin(), nodes.end(), node) != nodes.end(); };
  std::vector<unsigned int> partitions;
  for (unsigned int set = 0; set < this->Collection->GetNumberOfPartitionedDataSets(); ++set)
  {
    const bool isFound = has(0) || has(this->Collection->GetCompositeIndex(set));
    for (unsigned int part = 0; isFound && part < this->Collection->GetNumberOfPartitions(set);
         ++part)
    {
      partitions.push_back(this->Collection->GetCompositeIndex(set, part));
    }
  }
  return partitions;
}

std::vector<unsigned int> vtkPVDSMBlockPaths::FindHiddenOfAmr(
  const std::vector<std::string>& paths) const
{
  if (!this->Amr || paths.empty() || !this->Find(paths).empty())
  {
    return {};
  }
  std::vector<unsigned int> shown; // levels
  for (const int node : this->Assembly->SelectNodes(paths))
  {
    shown.push_back(this->Assembly->GetAttributeOrDefault(node, "amr_level", 0u));
  }
  std::vector<unsigned int> hidden;
  vtkSmartPointer<vtkCompositeDataIterator> leaf;
  leaf.TakeReference(this->Amr->NewIterator());
  for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
  {
    const unsigned int level = vtkPVDSMAmrIterator::SafeDownCast(leaf)->GetCurrentLevel();
    if (std::find(shown.begin(), shown.end(), level) == shown.end())
    {
      hidden.push_back(leaf->GetCurrentFlatIndex());
    }
  }
  return hidden;
}

void vtkPVDSMBlockPaths::NumberBlocks(vtkDataObject* data, unsigned int distinctNumbers)
{
  auto* const tree = vtkDataObjectTree::SafeDownCast(data);
  if (!tree || vtkUniformGridAMR::SafeDownCast(data))
  {
    return;
  }
  const auto add = [distinctNumbers](vtkDataObject* image, unsigned int number)
  {
    if (!image || image->GetFieldData()->HasArray("vtkBlockColors"))
    {
      return;
    }
    vtkNew<vtkUnsignedIntArray> array;
    array->SetName("vtkBlockColors");
    array->InsertNextValue(number % distinctNumbers);
    image->GetFieldData()->AddArray(array);
  };
  // As ParaView counts: leaves, also empty ones; but all parts of a partitioned dataset in a collection are one.
  if (auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(tree))
  {
    for (unsigned int set = 0; set < collection->GetNumberOfPartitionedDataSets(); ++set)
    {
      for (unsigned int part = 0; part < collection->GetNumberOfPartitions(set); ++part)
      {
        add(collection->GetPartitionAsDataObject(set, part), set);
      }
    }
    return;
  }
  vtkSmartPointer<vtkCompositeDataIterator> leaf;
  leaf.TakeReference(tree->NewIterator());
  leaf->SkipEmptyNodesOff();
  unsigned int number = 0;
  for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
  {
    add(leaf->GetCurrentDataObject(), number++);
  }
}
