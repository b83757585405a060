// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMLatticeValues_h
#define vtkDSMLatticeValues_h

#include "DSMCore/fetch/ReadingSource.h"
#include "DSMCore/publish/FragmentDigests.h"
#include "vtkDSMFileVolume.h"
#include "vtkDSMLatticePart.h"

#include <memory>

/// Values of a lattice, and what is needed to put other values into its bricks.
class vtkDSMLatticePart::Values final : public vtkDSMPartValues
{
public:
  Values(std::shared_ptr<bricks::VoxelField> field, const glm::dmat4& indexToData)
    : vtkDSMPartValues(MakeField(field, indexToData))
    , Field(std::move(field))
    , SlicesToData(indexToData)
  {
  }

  bricks::ValueRange GetRange() const override { return this->GetLooked().Hierarchy.GetRange(); }
  bricks::SurveyedBricks GetSurveyed() const override
  {
    const bricks::VoxelField& looked = this->GetLooked();
    return { looked.Survey ? &*looked.Survey : nullptr, &looked };
  }
  bricks::Index3 CountSlices() const override
  {
    return this->File ? this->File->GetPoints() : this->Field->Lattice.GetPoints();
  }
  const glm::dmat4& GetSlicesToData() const override { return this->SlicesToData; }
  const bricks::GridPlanes* GetPlanes() const override { return this->Field->Planes.get(); }
  int CountCoarser() const override { return this->File ? this->File->CountCoarser() : 0; }

  int GetLevel() const override { return this->Level; }
  const vtkDSMNestedLevels* GetNested() const override { return this->Nested.get(); }

  /// The base class has it, too.
  std::shared_ptr<bricks::VoxelField> Field;
  dsm::FragmentDigests Digests; ///< digests of this rank's contributions
  ///@{
  /// Of a lattice in a file, instead: the file, the source of its bricks and, if there are several time steps, the
  /// digests of these bricks (else null). A coarser level has no file.
  std::shared_ptr<const vtkDSMFileVolume> File;
  std::shared_ptr<dsm::ReadingSource> Source;
  std::shared_ptr<const vtkDSMFileVolume::Digests> Bricks;
  /// Hierarchy and survey of a coarser level, where the bricks have no index; else null.
  std::shared_ptr<const bricks::VoxelField> Looked;
  glm::dmat4 SlicesToData;
  int Level = 0;
  std::shared_ptr<vtkDSMNestedLevels> Nested;
  ///@{
  /// Values of a level's box have the boxes of that level and of all coarser ones, on which its bricks depend, and the
  /// field that gives the bricks back (Field shares them).
  int BoxLevel = 0;
  vtkDSMNestedLevels::Boxes Boxes;
  std::shared_ptr<bricks::VoxelField> Bricked;
  ///@}
  ///@}

private:
  const bricks::VoxelField& GetLooked() const
  {
    return this->Looked ? *this->Looked : *this->Field;
  }
  static rt::LatticeField MakeField(
    std::shared_ptr<const bricks::VoxelField> voxels, const glm::dmat4& indexToData)
  {
    rt::LatticeField field;
    field.Voxels = std::move(voxels);
    field.SetIndexToWorld(indexToData);
    return field;
  }
};

#endif
