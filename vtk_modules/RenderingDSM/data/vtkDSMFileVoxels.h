// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMFileVoxels_h
#define vtkDSMFileVoxels_h

#include "DSMRayTracing/base/ScalarType.h"
#include "DSMRayTracing/build/VoxelSource.h"

#include <cstddef>
#include <memory>

class vtkDSMFileValues;

/// The samples of one component of a file's values, or of the magnitude of all. Any thread.
class vtkDSMFileVoxels final : public rt::VoxelSource
{
public:
  /// `component`: also vtkDSMImagePiece::Magnitude, as which `type` is Float32 or Float64. `scattered`: boxes are read
  /// here and there, rather than one beside the other.
  vtkDSMFileVoxels(std::shared_ptr<const vtkDSMFileValues> values, int component,
    rt::ScalarType type, bool scattered);

  rt::Box GetCells() const override;
  void ReadSamples(const rt::Box& points, std::byte* out) const override;

private:
  void ReadBox(const rt::Box& points, std::byte* out) const;

  std::shared_ptr<const vtkDSMFileValues> Values;
  int Component;
  rt::ScalarType Type;
  bool Scattered;
};

#endif
