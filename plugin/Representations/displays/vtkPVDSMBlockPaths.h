// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMBlockPaths_h
#define vtkPVDSMBlockPaths_h

#include "vtkNew.h"

#include <string>
#include <vector>

class vtkDataAssembly;
class vtkDataObject;
class vtkPartitionedDataSetCollection;
class vtkUniformGridAMR;

/// Finds a dataset's blocks by the paths that ParaView's Multiblock Inspector names them by: those of multi-block
/// datasets and of collections, and levels of AMR. Local; does not keep the dataset alive.
class vtkPVDSMBlockPaths
{
public:
  /// `data` may be null.
  explicit vtkPVDSMBlockPaths(vtkDataObject* data);
  ~vtkPVDSMBlockPaths();
  vtkPVDSMBlockPaths(const vtkPVDSMBlockPaths&) = delete;
  vtkPVDSMBlockPaths& operator=(const vtkPVDSMBlockPaths&) = delete;

  /// Returns whether there are blocks with paths.
  bool Any() const { return this->IsKnown; }
  bool AreOfAmr() const { return this->Amr != nullptr; }
  /// Returns the flat indices of blocks; of AMR, 0 if the paths lead to all of it.
  std::vector<unsigned int> Find(const std::vector<std::string>& paths) const;
  /// Returns the flat indices of the blocks of AMR on levels to which no path leads; none of other datasets.
  std::vector<unsigned int> FindHiddenOfAmr(const std::vector<std::string>& paths) const;

  /// Gives each block of a multi-block dataset or of a collection the number that a Surface gives it, in ParaView's
  /// array vtkBlockColors; so many numbers take turns.
  static void NumberBlocks(vtkDataObject* data, unsigned int distinctNumbers);

private:
  std::vector<unsigned int> FindPartitions(const std::vector<unsigned int>& nodes) const;

  vtkUniformGridAMR* Amr;
  vtkPartitionedDataSetCollection* Collection; ///< null: a multi-block dataset, or AMR
  vtkNew<vtkDataAssembly> Assembly;
  bool IsKnown;
};

#endif
