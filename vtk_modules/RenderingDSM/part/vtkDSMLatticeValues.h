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
  {
  }

  bricks::SurveyedBricks GetSurveyed() const override
  {
    return { this->Field->Survey ? &*this->Field->Survey : nullptr, this->Field.get() };
  }
  bricks::Index3 CountSlices() const override { return this->Field->Lattice.GetPoints(); }
  const bricks::GridPlanes* GetPlanes() const override { return this->Field->Planes.get(); }
  int CountCoarser() const override { return this->File ? this->File->CountCoarser() : 0; }

  /// The base class has it, too.
  std::shared_ptr<bricks::VoxelField> Field;
  dsm::FragmentDigests Digests; ///< digests of this rank's contributions
  ///@{
  /// Of a lattice in a file, instead: the file, the source of its bricks and, if there are several time steps, the
  /// digests of these bricks (else null). A coarser level has no file.
  std::shared_ptr<const vtkDSMFileVolume> File;
  std::shared_ptr<dsm::ReadingSource> Source;
  std::shared_ptr<const vtkDSMFileVolume::Digests> Bricks;
  ///@}

private:
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
