// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMFileVoxels_h
#define vtkDSMFileVoxels_h

#include "DSMBricks/base/ScalarType.h"
#include "DSMBricks/build/VoxelSource.h"

#include <cstddef>
#include <memory>

class vtkDSMFileValues;

/// The samples of one component of a file's values, or of the magnitude of all. Any thread.
class vtkDSMFileVoxels final : public bricks::VoxelSource
{
public:
  /// `component`: also vtkDSMImagePiece::Magnitude, as which `type` is Float32 or Float64. `scattered`: boxes are read
  /// here and there, rather than one beside the other.
  vtkDSMFileVoxels(std::shared_ptr<const vtkDSMFileValues> values, int component,
    bricks::ScalarType type, bool scattered);

  bricks::Box GetCells() const override;
  void ReadSamples(const bricks::Box& points, std::byte* out) const override;

private:
  void ReadBox(const bricks::Box& points, std::byte* out) const;

  std::shared_ptr<const vtkDSMFileValues> Values;
  int Component;
  bricks::ScalarType Type;
  bool Scattered;
};

#endif
